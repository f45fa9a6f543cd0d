//! The live backend with ALSA told what card there is: none, or one that writes a file.
//!
//! ALSA reads its configuration once in a process, so that each case is a process of its own: this binary again, with
//! one test.

use std::path::Path;
use std::process::{Command, Output};
use std::time::{Duration, Instant};

use glam::DVec3;
use sound::Settings;
use sound::live::{Live, NoSound};

use crate::support::{at, ball_on_pin};

/// Set in the process of its own: the file that the card writes, or nothing where there is no card.
const CASE: &str = "SOUND_TEST_CARD_FILE";
/// Longest wait for the card [s].
const PATIENCE: Duration = Duration::from_secs(20);

fn play_alone(test: &str, configuration: &str, file: &Path) -> Output {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("asound.conf");
    std::fs::write(&path, configuration).expect("a file");
    Command::new(std::env::current_exe().expect("this binary"))
        .args(["--exact", test, "--nocapture", "--test-threads=1"])
        .env("ALSA_CONFIG_PATH", &path)
        .env(CASE, file)
        .output()
        .expect("a process")
}

#[test]
fn without_a_card_nothing_is_written_to_the_terminal() {
    if std::env::var_os(CASE).is_some() {
        let opened = Live::open(Settings::default(), 0.015);
        assert!(matches!(opened, Err(NoSound::NoCard)));
        return;
    }
    // As Debian's own configuration leads to the first card, which is missing.
    let configuration = "pcm.!default { type hw\n card 31 }\nctl.!default { type hw\n card 31 }\n";
    let name = "card::without_a_card_nothing_is_written_to_the_terminal";
    let output = play_alone(name, configuration, Path::new(""));
    let said = String::from_utf8_lossy(&output.stdout).into_owned();
    assert!(output.status.success(), "{said}");
    assert!(
        said.contains("1 passed") && !said.contains("ALSA"),
        "{said}"
    );
    assert_eq!(String::from_utf8_lossy(&output.stderr), "");
}

#[test]
fn a_card_is_given_what_the_mixer_renders() {
    let folder = tempfile::tempdir().expect("a folder");
    if let Some(file) = std::env::var_os(CASE) {
        let mut live = Live::open(Settings::default(), 0.015).expect("a card");
        assert!(
            (20.0..60.0).contains(&live.latency_ms()),
            "{}",
            live.latency_ms()
        );
        let begun = Instant::now();
        // A blow a frame, until one has come out.
        while !has_sound(Path::new(&file)) {
            let now = begun.elapsed();
            assert!(now < PATIENCE, "the card stays silent");
            let now = now.as_secs_f64();
            live.frame(now, [at(now, ball_on_pin(DVec3::new(0.0, 0.0, -2.0)))]);
            std::thread::park_timeout(Duration::from_millis(10));
        }
        return;
    }
    let file = folder.path().join("card.raw");
    let configuration = format!(
        "pcm.!default {{ type file\n file \"{}\"\n format \"raw\"\n slave.pcm {{ type null }} }}\n",
        file.display()
    );
    let output = play_alone(
        "card::a_card_is_given_what_the_mixer_renders",
        &configuration,
        &file,
    );
    assert!(
        output.status.success(),
        "{}{}",
        String::from_utf8_lossy(&output.stdout),
        String::from_utf8_lossy(&output.stderr)
    );
    assert!(has_sound(&file));
}

/// Whether a file of 32-bit samples holds one that is not zero.
fn has_sound(file: &Path) -> bool {
    std::fs::read(file).is_ok_and(|bytes| bytes.iter().any(|byte| *byte != 0))
}
