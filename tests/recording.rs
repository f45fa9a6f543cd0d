use std::fs;
use std::path::{Path, PathBuf};
use std::process::Output;
use std::sync::OnceLock;

use bowling_app::devices::script::Velocities;
use bowling_app::journal::{self, Journal, Recording};
use bowling_app::pictures::Wanted;
use bowling_app::rehearsal::rehearse;
use bowling_app::session::{Keep, Session, Setup};
use game::{Button, Conditions, Event, Input, Tracked};
use glam::{DQuat, DVec3};
use physics::Pose;

use crate::support::{bowling, fresh_folder};

/// One short recording by the real program, made once for all tests that read it.
pub fn recording() -> &'static (PathBuf, String) {
    static RECORDING: OnceLock<(PathBuf, String)> = OnceLock::new();
    RECORDING.get_or_init(|| {
        let folder = fresh_folder("recording").join("session");
        let path = folder.display().to_string();
        let output = bowling(&[
            "play",
            "--offscreen",
            "--frames",
            "1",
            "--seed",
            "5",
            "--out",
            &path,
        ]);
        assert!(output.status.success(), "{}", stderr(&output));
        (folder, String::from_utf8(output.stdout).expect("UTF-8"))
    })
}

/// A copy of the recording that a test may damage.
fn copy(name: &str) -> PathBuf {
    let folder = fresh_folder(name);
    for file in ["journal.jsonl", "motion.tsv"] {
        fs::copy(recording().0.join(file), folder.join(file)).expect("a file of the recording");
    }
    folder
}

fn replay(folder: &Path) -> Output {
    bowling(&["replay", &folder.display().to_string()])
}

fn stderr(output: &Output) -> String {
    String::from_utf8_lossy(&output.stderr).into_owned()
}

/// The replay must fail with exit code 1 and one line that holds every one of `words`.
fn assert_refused(output: &Output, words: &[&str]) {
    let text = stderr(output);
    assert_eq!(output.status.code(), Some(1), "{text}");
    let error = text
        .lines()
        .find(|line| line.starts_with("error:"))
        .unwrap_or_default();
    for word in words {
        assert!(error.contains(word), "no `{word}` in: {text}");
    }
    assert!(
        !text.contains("panicked") && !text.contains("backtrace"),
        "{text}"
    );
}

fn hash_line(text: &str) -> &str {
    text.lines()
        .find(|line| line.starts_with("State hash "))
        .expect("a hash is printed")
}

fn conditions() -> Conditions {
    let config = Path::new(env!("CARGO_MANIFEST_DIR")).join("config");
    Conditions::load(&config, "alley", &[]).expect("the project's configuration")
}

#[test]
fn play_leaves_exactly_the_promised_files() {
    let mut names: Vec<String> = fs::read_dir(&recording().0)
        .expect("the recording")
        .map(|entry| {
            entry
                .expect("readable")
                .file_name()
                .to_string_lossy()
                .into_owned()
        })
        .collect();
    names.sort();
    let promised = [
        "blue-contact-sheet.png",
        "blue-highlights.avi",
        "blue-score.tsv",
        "blue-score.txt",
        "journal.jsonl",
        "motion.tsv",
        "red-contact-sheet.png",
        "red-highlights.avi",
        "red-score.tsv",
        "red-score.txt",
    ];
    assert_eq!(names, promised);
}

#[test]
fn contact_sheets_show_something_in_every_tile_row() {
    for name in ["red-contact-sheet.png", "blue-contact-sheet.png"] {
        let sheet = image::open(recording().0.join(name))
            .expect("a PNG")
            .to_rgb8();
        let bright = sheet
            .pixels()
            .filter(|pixel| pixel.0.iter().any(|part| *part > 60))
            .count();
        let share = bright as f64 / f64::from(sheet.width() * sheet.height());
        assert!(share > 0.1, "{name}: only {share:.3} of it is not dark");
    }
}

#[test]
fn videos_hold_at_most_twenty_seconds_of_decodable_pictures() {
    for name in ["red-highlights.avi", "blue-highlights.avi"] {
        let bytes = fs::read(recording().0.join(name)).expect("a video");
        let number = |at: usize| {
            u32::from_le_bytes(bytes[at..at + 4].try_into().expect("four bytes")) as usize
        };
        assert_eq!((&bytes[..4], &bytes[8..12]), (&b"RIFF"[..], &b"AVI "[..]));
        assert_eq!(number(4) + 8, bytes.len());
        let (microseconds, frames) = (number(32), number(48));
        assert!(frames > 20, "{name} has {frames} frames");
        assert!(microseconds * frames <= 20_100_000, "{name} lasts too long");
        // Walk through `movi`: every chunk is a whole JPEG of both eyes side by side, or the sound of a thirtieth second.
        let movi = bytes.windows(4).position(|word| word == b"movi");
        let (mut at, mut found, mut loudest) = (movi.expect("pictures") + 4, 0, 0);
        while &bytes[at..at + 4] != b"idx1" {
            let length = number(at + 4);
            if &bytes[at..at + 4] == b"01wb" {
                assert_eq!(length, 48_000 / 30 * 4);
                let samples = bytes[at + 8..at + 8 + length].chunks_exact(2);
                let sizes = samples.map(|s| i16::from_le_bytes([s[0], s[1]]).unsigned_abs());
                loudest = loudest.max(sizes.max().unwrap_or(0));
                at += 8 + length;
                continue;
            }
            assert_eq!(&bytes[at..at + 4], b"00dc");
            if found % 40 == 0 {
                let picture =
                    image::load_from_memory(&bytes[at + 8..at + 8 + length]).expect("a JPEG");
                assert_eq!(
                    (picture.width() as usize, picture.height() as usize),
                    (number(64), number(68))
                );
            }
            at += 8 + length + length % 2;
            found += 1;
        }
        assert_eq!(found, frames);
        // A throw is heard: its loudest sample lies 20 dB below full scale or higher.
        assert!(loudest > 3277, "{name}: {loudest}");
    }
}

#[test]
fn motion_table_has_a_row_for_every_input() {
    let folder = &recording().0;
    let rows = fs::read_to_string(folder.join("motion.tsv"))
        .expect("a table")
        .lines()
        .count()
        - 1;
    let journal = journal::read(&folder.join("journal.jsonl")).expect("a journal");
    assert_eq!(rows, journal.inputs.len());
    assert!(journal.end.complete);
    assert_eq!(journal.header.rate_hz, 90.0);
}

#[test]
fn replay_agrees_and_prints_the_same_sheets_and_hash() {
    let (folder, played) = recording();
    let output = replay(folder);
    assert!(output.status.success(), "{}", stderr(&output));
    let replayed = String::from_utf8(output.stdout).expect("UTF-8");
    assert_eq!(hash_line(&replayed), hash_line(played));
    for sheet in ["red-score.txt", "blue-score.txt"] {
        let sheet = fs::read_to_string(folder.join(sheet)).expect("a sheet");
        assert!(
            replayed.contains(sheet.trim()) && played.contains(sheet.trim()),
            "{sheet}"
        );
    }
}

/// A recording of schema 2 by commit 27ef4f2, seconds in a headset runtime: before scenes listed what they show and let be heard.
#[test]
fn a_recording_from_before_some_settings_is_still_replayed() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data/before-shows");
    let header = fs::read_to_string(folder.join("journal.jsonl")).expect("it is kept here");
    let header = header.lines().next().expect("a header");
    for table in ["shows", "markings", "sound", "guidance"] {
        assert!(!header.contains(&format!("\"{table}\"")), "{table}");
    }
    let output = replay(&folder);
    assert!(output.status.success(), "{}", stderr(&output));
    let replayed = String::from_utf8(output.stdout).expect("UTF-8");
    assert_eq!(hash_line(&replayed), "State hash 8fa329b28075602a");
}

#[test]
fn the_same_seed_gives_the_same_hash_and_another_seed_another() {
    let play = |seed| {
        let games = [Button::Red];
        rehearse(&conditions(), 1, seed, Velocities::Measured, &games, |_| ())
            .expect("a game")
            .hash()
    };
    let first = play(11);
    assert_eq!(play(11), first);
    assert_ne!(play(12), first);
}

#[test]
fn replay_refuses_a_journal_cut_in_half() {
    let folder = copy("cut");
    let journal = folder.join("journal.jsonl");
    let bytes = fs::read(&journal).expect("a journal");
    fs::write(&journal, &bytes[..bytes.len() / 2]).expect("writable");
    assert_refused(&replay(&folder), &["journal.jsonl line ", "cut short"]);
}

#[test]
fn replay_refuses_a_number_that_was_changed() {
    let folder = copy("number");
    let journal = folder.join("journal.jsonl");
    let text = fs::read_to_string(&journal).expect("a journal");
    let mut lines: Vec<String> = text.lines().map(str::to_owned).collect();
    let line = &mut lines[299];
    let digit = line.rfind(|c: char| c.is_ascii_digit()).expect("a number");
    let other = if &line[digit..=digit] == "1" {
        "2"
    } else {
        "1"
    };
    line.replace_range(digit..=digit, other);
    fs::write(&journal, lines.join("\n") + "\n").expect("writable");
    assert_refused(&replay(&folder), &["journal.jsonl line 300", "was changed"]);
}

#[test]
fn replay_refuses_lines_in_another_order() {
    let folder = copy("order");
    let journal = folder.join("journal.jsonl");
    let text = fs::read_to_string(&journal).expect("a journal");
    let mut lines: Vec<&str> = text.lines().collect();
    lines.swap(100, 101);
    fs::write(&journal, lines.join("\n") + "\n").expect("writable");
    assert_refused(
        &replay(&folder),
        &["journal.jsonl line 101", "another order"],
    );
}

#[test]
fn replay_refuses_a_journal_without_header_and_a_foreign_file() {
    let folder = copy("header");
    let journal = folder.join("journal.jsonl");
    let text = fs::read_to_string(&journal).expect("a journal");
    let (_, rest) = text.split_once('\n').expect("many lines");
    for content in [rest, "{\"name\": \"something else\"}\n", "hello", "\n"] {
        fs::write(&journal, content).expect("writable");
        assert_refused(&replay(&folder), &["journal.jsonl line 1"]);
    }
    fs::write(&journal, [0xff, 0xfe, 0x00]).expect("writable");
    assert_refused(&replay(&folder), &["journal.jsonl line 1", "not text"]);
}

#[test]
fn replay_shows_both_hashes_when_the_state_differs() {
    let folder = copy("hash");
    let path = folder.join("journal.jsonl");
    let recorded = journal::read(&path).expect("a journal");
    fs::remove_file(&path).expect("writable");
    // Written anew, so that every line's check is right and only the end lies.
    let mut journal = Journal::create(&path, recorded.header).expect("writable");
    for input in &recorded.inputs {
        journal.input(input).expect("writable");
    }
    let end = journal::End {
        hash: "0123456789abcdef".to_owned(),
        ..recorded.end.clone()
    };
    journal.end(end).expect("writable");
    assert_refused(&replay(&folder), &["0123456789abcdef", &recorded.end.hash]);
}

#[test]
fn replay_names_the_first_event_that_was_changed() {
    let whole = journal::read(&recording().0.join("journal.jsonl")).expect("a journal");
    let (index, (at, _)) = whole
        .events
        .iter()
        .enumerate()
        .find(|(_, (_, event))| event["event"] == "impact")
        .expect("a ball hits something");
    let number = format!("event {} ", index + 1);
    let input = format!("after input {}", at + 1);
    let mut faster = whole.events.clone();
    faster[index].1["approach_speed"] = 99.5.into();
    let mut late = whole.events.clone();
    late[index].0 += 1;
    let mut fewer = whole.events.clone();
    fewer.truncate(index);
    for (name, events, words) in [
        (
            "faster",
            faster,
            [number.as_str(), "approach_speed 99.5", &input],
        ),
        ("late", late, [number.as_str(), "\"impact\"", &input]),
        (
            "fewer",
            fewer,
            [number.as_str(), "no further event", &input],
        ),
    ] {
        let folder = copy(&format!("event-{name}"));
        write_journal(&folder, &whole, &events);
        assert_refused(&replay(&folder), &words);
    }
}

/// Writes a journal anew with other events, so that every line's check is right.
fn write_journal(folder: &Path, recorded: &Recording, events: &[(usize, serde_json::Value)]) {
    let path = folder.join("journal.jsonl");
    fs::remove_file(&path).expect("writable");
    let mut journal = Journal::create(&path, recorded.header.clone()).expect("writable");
    for (index, input) in recorded.inputs.iter().enumerate() {
        journal.input(input).expect("writable");
        for (_, event) in events.iter().filter(|(at, _)| *at == index) {
            let event: Event = serde_json::from_value(event.clone()).expect("an event");
            journal.event(&event).expect("writable");
        }
    }
    journal.end(recorded.end.clone()).expect("writable");
}

#[test]
fn replay_names_the_line_of_a_changed_motion_table() {
    let folder = copy("motion");
    let table = folder.join("motion.tsv");
    let text = fs::read_to_string(&table).expect("a table");
    let mut lines: Vec<String> = text.lines().map(str::to_owned).collect();
    lines[41] = lines[41].replacen('.', ",", 1);
    fs::write(&table, lines.join("\n") + "\n").expect("writable");
    assert_refused(&replay(&folder), &["motion.tsv line 42", "does not agree"]);
}

#[test]
fn poses_that_are_no_numbers_are_refused_and_counted_in_the_journal() {
    let folder = fresh_folder("nan");
    let setup = Setup {
        conditions: conditions(),
        scene: "alley".to_owned(),
        frames: 1,
        seed: 1,
        device: "script",
        rate_hz: 90.0,
        keep: Keep::Recording(folder.clone()),
    };
    let mut session = Session::start(setup).expect("a session");
    let good = Tracked::at(Pose {
        position: DVec3::new(0.0, 1.6, 0.0),
        rotation: DQuat::IDENTITY,
    });
    let nan = Tracked::at(Pose {
        position: DVec3::NAN,
        rotation: DQuat::IDENTITY,
    });
    for hand in [good, nan, nan] {
        let input = Input {
            head: Some(good),
            hand: Some(hand),
            steps: 8,
            ..Input::default()
        };
        session.frame(input).expect("recorded");
    }
    let summary = session
        .finish(None, Wanted { video: false }, &mut |_| ())
        .expect("in order");
    assert_eq!((summary.refused.hand, summary.refused.head), (2, 0));
    let recorded = journal::read(&folder.join("journal.jsonl")).expect("a journal");
    assert_eq!(recorded.end.refused, summary.refused);
    assert!(recorded.inputs[1].hand.is_none() && recorded.inputs[0].hand.is_some());
    assert!(replay(&folder).status.success());
}

/// Ctrl-C loses nothing: what was played until then is a whole recording.
#[cfg(unix)]
#[test]
fn an_interrupted_session_is_in_order_up_to_there() {
    use std::process::{Command, Stdio};

    let folder = fresh_folder("interrupted").join("session");
    let mut child = Command::new(env!("CARGO_BIN_EXE_bowling"))
        .args(["play", "--offscreen", "--no-video", "--out"])
        .arg(&folder)
        .stdout(Stdio::null())
        .stderr(Stdio::piped())
        .spawn()
        .expect("the program starts");
    // The first progress line comes from a game under way.
    let mut lines = std::io::BufRead::lines(std::io::BufReader::new(
        child.stderr.take().expect("it was piped"),
    ));
    let begun = lines.find(|line| line.as_ref().is_ok_and(|line| line.contains("frame 2")));
    assert!(begun.is_some(), "no progress was shown");
    let killed = Command::new("kill")
        .args(["-INT", &child.id().to_string()])
        .status();
    assert!(killed.expect("kill is everywhere").success());
    lines.for_each(drop);
    assert!(child.wait().expect("it ends").success());
    assert!(replay(&folder).status.success());
    let recorded = journal::read(&folder.join("journal.jsonl")).expect("a journal");
    assert!(!recorded.end.complete && recorded.end.red.is_some() && recorded.end.blue.is_none());
    let hidden = fs::read_dir(&folder)
        .expect("the recording")
        .filter(|entry| {
            let name = entry.as_ref().expect("readable").file_name();
            name.to_string_lossy().starts_with('.')
        });
    assert_eq!(hidden.count(), 0, "a temporary file was left");
}
