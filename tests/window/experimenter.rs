//! The experimenter's window at the desk: notes, answers and Stop, with real keys and clicks; what is typed never reaches the game.

use std::fs::{self, File};
use std::io::Read;
use std::path::PathBuf;
use std::process::{Command, Stdio};

use serde_json::Value;

use super::{SCREEN, wait_for};
use crate::shared::process::Process;
use crate::shared::screen::{Screen, colours};
use crate::support::{bowling, fresh_folder};

const TITLE: &str = "^Bowling: the experimenter$";

/// A session of a study at the desk, and the experimenter's window in front.
struct Session {
    screen: Screen,
    program: Process,
    study: PathBuf,
}

impl Session {
    fn begin(name: &str) -> Self {
        let folder = fresh_folder(name);
        let study = folder.join("study");
        let made = bowling(&[
            "study",
            "new",
            study.to_str().expect("a plain path"),
            "--subjects",
            "1",
            "--laboratory",
            "a test",
            "--contact",
            "nobody",
            "--withdrawal-until",
            "2099-12-31",
            "--retention-until",
            "2099-12-31",
        ]);
        assert!(made.status.success());
        let ticks = folder.join("ticks");
        fs::write(&ticks, "y\ny\ny\nn\n").expect("writable");
        let screen = Screen::open(SCREEN);
        let mut command = Command::new(env!("CARGO_BIN_EXE_bowling"));
        command
            .args(["study", "run", "--device", "desk"])
            .arg(&study)
            .env("DISPLAY", screen.display())
            .env_remove("WAYLAND_DISPLAY")
            .current_dir(env!("CARGO_MANIFEST_DIR"))
            .stdin(File::open(&ticks).expect("just written"))
            .stdout(Stdio::piped())
            .stderr(Stdio::piped());
        let session = Self {
            program: Process::start("bowling", &mut command),
            screen,
            study,
        };
        session.to_front();
        session
    }

    /// Brings the experimenter's window to the upper left corner, and the keys to it.
    fn to_front(&self) {
        let window = self.screen.act(&["search", "--sync", "--name", TITLE]);
        self.screen
            .act(&["windowmove", "--sync", &window, "0", "0"]);
        self.screen.act(&["windowraise", &window]);
        self.screen.act(&["windowfocus", "--sync", &window]);
    }

    /// What the journal has of a kind of note.
    fn notes(&self, kind: &str) -> Vec<Value> {
        let lines = |path: PathBuf| fs::read_to_string(path).unwrap_or_default();
        let sources = self.study.join("data/sourcedata");
        let journals = if sources.exists() {
            experiment::files::list(&sources).expect("readable")
        } else {
            Vec::new()
        };
        let text: String = journals.into_iter().map(lines).collect();
        let whole = text.lines().filter(|line| line.ends_with('}'));
        let study = whole
            .map(|line| serde_json::from_str::<Value>(line).expect("JSON"))
            .map(|entry| entry["study"].clone());
        study.filter(|note| note["note"] == kind).collect()
    }

    fn typed(&self, words: &str) {
        self.screen.act(&["type", "--delay", "15", words]);
    }

    /// Waits for the end, and returns what was printed.
    fn ended(mut self) -> String {
        let status = wait_for("the program to end", || self.program.ended());
        let mut said = String::new();
        let program = self.program.child();
        let (output, errors) = (&mut program.stdout, &mut program.stderr);
        let output = output.as_mut().expect("piped");
        output.read_to_string(&mut said).expect("text");
        let errors = errors.as_mut().expect("piped");
        errors.read_to_string(&mut said).expect("text");
        assert!(status.success(), "{said}");
        said
    }
}

/// Pixels of the Stop button's red.
fn reds(screen: &Screen) -> usize {
    let picture = screen.shot();
    let top = picture.enumerate_pixels().filter(|(_, y, _)| *y < 70);
    let is_red = |pixel: &image::Rgb<u8>| {
        let [r, g, b] = pixel.0.map(u32::from);
        r > 100 && r > 2 * g && r > 2 * b
    };
    top.filter(|(_, _, pixel)| is_red(pixel)).count()
}

#[test]
fn notes_and_answers_are_typed_into_the_experimenters_window_and_a_click_stops() {
    let session = Session::begin("window-experimenter");
    let screen = &session.screen;
    // Stop is as wide as the window and 44 pixels high.
    wait_for("the Stop button", || (reds(screen) > 6000).then_some(()));
    // Digits and letters that are keys of the game: 1, 2, w, Esc is Stop's.
    session.typed("/note lamp 12 went dim");
    screen.act(&["key", "Return"]);
    let remark = wait_for("the remark", || session.notes("remark").pop());
    assert_eq!(remark["text"], "lamp 12 went dim");
    // The first question has numbered answers.
    session.typed("2");
    screen.act(&["key", "Return"]);
    let answer = wait_for("the answer", || session.notes("form").pop());
    assert_eq!(answer["act"]["item"], "age_band", "{answer}");
    assert_eq!(answer["answered_in"], "desk");
    let picture = screen.shot();
    picture
        .save(session.study.with_file_name("experimenter.png"))
        .expect("the picture can be kept");
    assert!(colours(&picture) > 20, "{}", colours(&picture));
    session.typed("feels unwell");
    screen.act(&["mousemove", "190", "36", "click", "1"]);
    let stopped = wait_for("the stop", || session.notes("stopped").pop());
    assert_eq!(stopped["by"], "experimenter");
    assert_eq!(stopped["reason"], "feels unwell");
    let presses = session.notes("reached");
    assert!(presses.is_empty(), "nothing reached the game: {presses:?}");
    let study = session.study.clone();
    let said = session.ended();
    assert!(said.contains("Tables in"), "{said}");
    assert!(!said.contains("No experimenter's window"), "{said}");
    let table = fs::read_to_string(study.join("data/participants.tsv")).expect("a table");
    assert!(table.contains("partial"), "{table}");
}

#[test]
fn escape_in_the_experimenters_window_stops() {
    let session = Session::begin("window-experimenter-escape");
    wait_for("the Stop button", || {
        (reds(&session.screen) > 6000).then_some(())
    });
    session.screen.act(&["key", "Escape"]);
    let stopped = wait_for("the stop", || session.notes("stopped").pop());
    assert_eq!(stopped["by"], "experimenter");
    assert_eq!(stopped["reason"], "");
    let said = session.ended();
    assert!(said.contains("Tables in"), "{said}");
}
