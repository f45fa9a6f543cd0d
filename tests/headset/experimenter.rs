//! The experimenter's window beside the headset: the board and what the participant sees in one picture, notes, answers and Stop by
//! real keys and clicks, and nothing of a condition.

use std::ffi::OsStr;
use std::fs;
use std::path::PathBuf;

use glam::DQuat;
use image::RgbImage;
use serde_json::Value;
use tempfile::TempDir;

use crate::client::Client;
use crate::machine::runtime;
use crate::room::{PATIENCE, Room};
use crate::service::{Compositor, Service};
use crate::shared::ask_until;
use crate::shared::screen::{Screen, colours};
use crate::study::{new_study, sit_down};

/// Room for the window, whose left part is the mirror's.
const SCREEN: [u32; 2] = [1020, 640];
const MIRROR: u32 = 640;
/// Of the board with the first question, from where to where [px]: Stop and the question; help and the session's parts. Between them
/// is the line, whose cursor blinks, and below how the machine fares.
const TOLD: [[u32; 2]; 2] = [[0, 238], [264, 480]];

/// A study's session in the headset, and the window before the experimenter.
struct Desk {
    // Before what they need.
    client: Client,
    room: Room,
    screen: Screen,
    _service: Service,
    study: PathBuf,
    _out: TempDir,
}

impl Desk {
    /// One of a study that is made with these arguments too; `None` where there is no runtime.
    fn begin(more: &[&str]) -> Option<Self> {
        let runtime = runtime()?;
        let service = Service::start(&runtime, Compositor::Null);
        let screen = Screen::open(SCREEN);
        let out = tempfile::tempdir().expect("a temporary folder");
        let study = new_study(&out.path().join("study"), more);
        let display = [("DISPLAY", OsStr::new(screen.display()))];
        let (client, room) = sit_down(&service, &study, &display);
        let name = "^Bowling: what the participant sees$";
        let window = screen.act(&["search", "--sync", "--name", name]);
        screen.act(&["windowmove", "--sync", &window, "0", "0"]);
        screen.act(&["windowfocus", "--sync", &window]);
        let desk = Self {
            client,
            room,
            screen,
            _service: service,
            study,
            _out: out,
        };
        desk.wait_for_picture("the board and the room", |picture| {
            reds(&board(picture)) > 6000 && colours(&mirror(picture)) > 12
        });
        Some(desk)
    }

    fn wait_for_picture(&self, what: &str, holds: impl Fn(&RgbImage) -> bool) -> RgbImage {
        let seen = ask_until(PATIENCE, || Some(self.screen.shot()).filter(&holds));
        seen.unwrap_or_else(|| panic!("{what} is not seen"))
    }

    fn types(&self, words: &str) {
        self.screen.act(&["type", "--delay", "15", words]);
    }

    /// The first note of a kind in the study's journal.
    fn wait_for_note(&mut self, kind: &str) -> Value {
        let find = |room: &Room| {
            let notes = room.said.iter().map(|line| &line["study"]);
            notes.into_iter().find(|note| note["note"] == kind).cloned()
        };
        self.room.wait_until(kind, |room| find(room).is_some());
        find(&self.room).expect("just seen")
    }
}

fn part(picture: &RgbImage, [x, y]: [u32; 2], [width, height]: [u32; 2]) -> RgbImage {
    image::imageops::crop_imm(picture, x, y, width, height).to_image()
}

fn mirror(picture: &RgbImage) -> RgbImage {
    part(picture, [0, 0], [MIRROR, SCREEN[1]])
}

fn board(picture: &RgbImage) -> RgbImage {
    part(picture, [MIRROR, 0], [SCREEN[0] - MIRROR, SCREEN[1]])
}

/// Pixels of the Stop button's red.
fn reds(picture: &RgbImage) -> usize {
    let is_red = |pixel: &image::Rgb<u8>| {
        let [r, g, b] = pixel.0.map(u32::from);
        r > 100 && r > 2 * g && r > 2 * b
    };
    picture.pixels().filter(|pixel| is_red(pixel)).count()
}

/// Pixels in which two pictures differ visibly.
fn differing(a: &RgbImage, b: &RgbImage) -> usize {
    let far = |(a, b): &(u8, u8)| a.abs_diff(*b) > 30;
    let pixels = a.pixels().zip(b.pixels());
    pixels
        .filter(|(a, b)| a.0.into_iter().zip(b.0).any(|pair| far(&pair)))
        .count()
}

#[test]
fn the_experimenter_watches_notes_answers_and_stops_beside_the_headset() {
    let Some(mut desk) = Desk::begin(&[]) else {
        return;
    };
    // Digits are keys of the mirror elsewhere: in a study they are letters of a note.
    desk.types("/note lamp 12 went dim");
    desk.screen.act(&["key", "Return"]);
    let remark = desk.wait_for_note("remark");
    assert_eq!(remark["text"], "lamp 12 went dim");
    desk.types("2");
    desk.screen.act(&["key", "Return"]);
    let answer = desk.wait_for_note("form");
    assert_eq!(answer["act"]["item"], "age_band", "{answer}");
    assert_eq!(answer["answered_in"], "desk");

    // The participant looks round: the mirror shows it, the board stays.
    let ahead = mirror(&desk.screen.shot());
    desk.room.packet.head.rotation = DQuat::from_rotation_y(1.2);
    desk.room.send();
    let turned = desk.wait_for_picture("the look to the left", |picture| {
        differing(&mirror(picture), &ahead) > 40_000
    });
    assert!(reds(&board(&turned)) > 6000, "Stop is gone");
    if let Some(folder) = std::env::var_os("BOWLING_KEEP_PICTURES") {
        let kept = PathBuf::from(folder).join("experimenter-beside.png");
        turned.save(kept).expect("the picture can be kept");
    }

    desk.types("feels unwell");
    let stop = (MIRROR + 190).to_string();
    desk.screen.act(&["mousemove", &stop, "36", "click", "1"]);
    let stopped = desk.wait_for_note("stopped");
    assert_eq!(stopped["by"], "experimenter");
    assert_eq!(stopped["reason"], "feels unwell");
    let events = ["pressed", "refused", "game_started"];
    assert_eq!(events.map(|kind| desk.room.count(kind)), [0; 3]);
    let (status, said) = desk.client.wait();
    assert!(status.success(), "{said}");
    assert!(said.contains("Tables in"), "{said}");
    assert!(!said.contains("No mirror window"), "{said}");
    let table = fs::read_to_string(desk.study.join("data/participants.tsv")).expect("a table");
    assert!(table.contains("partial"), "{table}");
}

/// Two sessions that are alike but for what is compared in them, and how: the board is the same to the last pixel, and nothing that is
/// said names what differs.
#[test]
fn the_board_and_the_terminal_tell_nothing_of_a_condition() {
    let told = |parameter: &str, standard: &str, furthest: &str| {
        let scheme = ["--scheme", "staircase", "--parameter", parameter];
        let values = ["--standard", standard, "--furthest", furthest];
        let desk = Desk::begin(&[scheme, values].concat())?;
        let picture = board(&desk.screen.shot());
        let (status, said) = desk.client.finish();
        assert!(status.success(), "{said}");
        let parts = TOLD.map(|[from, to]| part(&picture, [0, from], [picture.width(), to - from]));
        Some((parts, said))
    };
    let Some((bouncing, said)) = told("objects.elasticity", "1.0", "0.4") else {
        return;
    };
    let Some((rubbing, also)) = told("objects.friction_rate", "0.05", "0.83") else {
        return;
    };
    for (part, other) in bouncing.iter().zip(&rubbing) {
        assert!(colours(part) > 12, "an empty board");
        assert_eq!(differing(part, other), 0, "pixels of the boards");
    }
    for word in ["elastic", "friction", "0.4", "0.83", "standard", "furthest"] {
        assert!(
            !said.contains(word) && !also.contains(word),
            "{word}: {said}\n{also}"
        );
    }
}
