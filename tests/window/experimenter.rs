//! The experimenter's window at the desk: notes, answers and Stop, with real keys and clicks; what is typed never reaches the game.

use std::fs::{self, File};
use std::io::Read;
use std::path::PathBuf;
use std::process::{Command, ExitStatus, Stdio};

use serde_json::Value;

use super::{SCREEN, wait_for};
use crate::shared::process::Process;
use crate::shared::screen::{Screen, colours};
use crate::support::{NEW_STUDY, bowling, fresh_folder};

const TITLE: &str = "^Bowling: the experimenter$";

/// A session of a study at the desk, and the experimenter's window in front.
struct Session {
    screen: Screen,
    program: Process,
    study: PathBuf,
}

impl Session {
    /// One whose consent is typed in the terminal.
    fn begin(name: &str) -> Self {
        let folder = fresh_folder(name);
        let ticks = folder.join("ticks");
        fs::write(&ticks, "y\ny\ny\nn\n").expect("writable");
        let typed = File::open(&ticks).expect("just written").into();
        let session = Self::begin_in(folder, SCREEN, typed);
        session.to_front(TITLE);
        session
    }

    /// One that is about to ask for consent.
    fn begin_in(folder: PathBuf, screen: [u32; 2], typed: Stdio) -> Self {
        let study = folder.join("study");
        let new = ["study", "new", study.to_str().expect("a plain path")];
        let made = bowling(&[&new[..], &["--subjects", "1"], &NEW_STUDY].concat());
        assert!(made.status.success());
        let screen = Screen::open(screen);
        let mut command = Command::new(env!("CARGO_BIN_EXE_bowling"));
        command
            .args(["study", "run", "--device", "desk"])
            .arg(&study)
            .env("DISPLAY", screen.display())
            .env_remove("WAYLAND_DISPLAY")
            .current_dir(env!("CARGO_MANIFEST_DIR"))
            .stdin(typed)
            .stdout(Stdio::piped())
            .stderr(Stdio::piped());
        Self {
            program: Process::start("bowling", &mut command),
            screen,
            study,
        }
    }

    /// Brings a window to the upper left corner, and the keys to it.
    fn to_front(&self, title: &str) {
        let window = self.screen.act(&["search", "--sync", "--name", title]);
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

    fn click(&self, [x, y]: [u32; 2]) {
        let (x, y) = (x.to_string(), y.to_string());
        self.screen.act(&["mousemove", &x, &y, "click", "1"]);
    }

    /// Waits for the end, which has to be a success, and returns what was printed.
    fn ended(self) -> String {
        let (status, said) = self.outcome();
        assert!(status.success(), "{said}");
        said
    }

    /// Waits for the end.
    fn outcome(mut self) -> (ExitStatus, String) {
        let status = wait_for("the program to end", || self.program.ended());
        let mut said = String::new();
        let program = self.program.child();
        let (output, errors) = (&mut program.stdout, &mut program.stderr);
        let output = output.as_mut().expect("piped");
        output.read_to_string(&mut said).expect("text");
        let errors = errors.as_mut().expect("piped");
        errors.read_to_string(&mut said).expect("text");
        (status, said)
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

const CONSENT: &str = "^Bowling: consent$";
/// Room for all of the form's window, and where its first box is: its words are clicked.
const LARGE: [u32; 2] = [700, 740];
const TAKE_PART: [u32; 2] = [150, 466];

/// Where the button that begins is once it may be pressed: its ends and its middle height.
fn begin_button(screen: &Screen) -> Option<[u32; 3]> {
    let picture = screen.shot();
    let is_green = |pixel: &image::Rgb<u8>| {
        let [r, g, b] = pixel.0.map(u32::from);
        g > 190 && g > r + 60 && g > b + 30
    };
    let greens = picture.enumerate_pixels();
    let greens: Vec<[u32; 2]> = greens
        .filter(|(.., pixel)| is_green(pixel))
        .map(|(x, y, _)| [x, y])
        .collect();
    let least = |axis: usize| greens.iter().map(|at| at[axis]).min();
    let most = |axis: usize| greens.iter().map(|at| at[axis]).max();
    let middle = (least(1)? + most(1)?) / 2;
    (greens.len() > 1500).then_some([least(0)?, most(0)?, middle])
}

/// Nobody types: the form is ticked in its window, and no session begins without the tick that it needs.
#[test]
fn consent_is_ticked_in_a_window() {
    let folder = fresh_folder("window-consent");
    let session = Session::begin_in(folder, LARGE, Stdio::null());
    session.to_front(CONSENT);
    let screen = &session.screen;
    wait_for("the form", || (colours(&screen.shot()) > 15).then_some(()));
    assert_eq!(begin_button(screen), None, "nothing is ticked yet");
    session.click(TAKE_PART);
    let [left, right, height] = wait_for("the tick", || begin_button(screen));
    let begin = [(left + right) / 2, height];
    let picture = screen.shot();
    let kept = session.study.with_file_name("consent.png");
    picture.save(kept).expect("the picture can be kept");
    // The tick taken back, the button begins nothing.
    session.click(TAKE_PART);
    wait_for("no tick", || begin_button(screen).is_none().then_some(()));
    session.click(begin);
    session.click(TAKE_PART);
    wait_for("the tick", || begin_button(screen));
    assert!(!session.study.join("data/sourcedata").exists());
    assert!(!session.study.join("plan/assignments.csv").exists());
    session.click(begin);
    session.to_front(TITLE);
    wait_for("the Stop button", || (reds(screen) > 3000).then_some(()));
    let consent = wait_for("the consent", || session.notes("consent").pop());
    let form = fs::read(session.study.join("plan/consent.md")).expect("the form");
    assert_eq!(consent["form_sha256"], experiment::digest::sha256(&form));
    assert_eq!(consent["form_version"], "template-1");
    let ticks = serde_json::json!({
        "take_part": true, "share_data": false, "share_motion": false, "contact": false
    });
    assert_eq!(consent["ticks"], ticks);
    screen.act(&["key", "Escape"]);
    let said = session.ended();
    assert!(said.contains("Tables in"), "{said}");
}

#[test]
fn a_form_that_is_left_begins_no_session() {
    let folder = fresh_folder("window-consent-left");
    let session = Session::begin_in(folder, LARGE, Stdio::null());
    session.to_front(CONSENT);
    let screen = &session.screen;
    wait_for("the form", || (colours(&screen.shot()) > 15).then_some(()));
    session.click(TAKE_PART);
    let [_, right, height] = wait_for("the tick", || begin_button(screen));
    // The button beside it.
    session.click([right + 40, height]);
    let study = session.study.clone();
    let (status, said) = session.outcome();
    assert_eq!(status.code(), Some(1), "{said}");
    assert!(said.contains("nothing has been recorded"), "{said}");
    assert!(!study.join("data/sourcedata").exists());
    assert!(!study.join("plan/consents.csv").exists());
}
