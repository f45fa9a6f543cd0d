//! A study in the headset: a question in the room is answered by pointing and pulling the trigger.

use std::ffi::OsStr;
use std::fs::{self, File};
use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use bowling_app::panel::{Choice, Panel};
use bowling_app::session::Session;
use bowling_app::study::seat::{self, Guest};
use bowling_app::words::Words;
use experiment::protocol::AnsweredIn;
use experiment::questionnaire::{Act, Answer};
use experiment::study::Study;
use game::{Input, Tracked};
use glam::DVec3;
use serde_json::Value;

use crate::client::Client;
use crate::machine::runtime;
use crate::room::{Hand, PATIENCE, Room};
use crate::service::{Compositor, Service};

/// A study for one participant, with more arguments.
pub fn new_study(folder: &Path, more: &[&str]) -> PathBuf {
    let made = Command::new(env!("CARGO_BIN_EXE_bowling"))
        .args(["study", "new"])
        .arg(folder)
        .args(["--subjects", "1", "--frames", "1"])
        .args(more)
        .args(["--laboratory", "a test", "--contact", "nobody"])
        .args(["--withdrawal-until", "2099-12-31"])
        .args(["--retention-until", "2099-12-31"])
        .env("BOWLING_ROOT", env!("CARGO_MANIFEST_DIR"))
        .output()
        .expect("the program starts");
    assert!(made.status.success(), "{made:?}");
    folder.to_owned()
}

/// What is typed in the terminal to begin a session.
const TICKS: &[u8] = b"y\ny\ny\nn\n";

/// A session whose consent is typed in the terminal, with more arguments and more in the program's environment.
fn run(service: &Service, study: &Path, more: &[&str], environment: &[(&str, &OsStr)]) -> Client {
    let ticks = study.with_file_name("ticks");
    fs::write(&ticks, TICKS).expect("writable");
    let typed = File::open(&ticks).expect("just written").into();
    run_told(service, study, more, environment, typed)
}

fn run_told(
    service: &Service,
    study: &Path,
    more: &[&str],
    environment: &[(&str, &OsStr)],
    typed: Stdio,
) -> Client {
    let folder = study.to_str().expect("a plain path");
    let arguments = [&["study", "run", folder, "--device", "headset"], more].concat();
    Client::start_told(service, &arguments, environment, typed)
}

/// Enters the room of a session that begins, with more in the program's environment.
pub fn sit_down(service: &Service, study: &Path, environment: &[(&str, &OsStr)]) -> (Client, Room) {
    let mut client = run(service, study, &[], environment);
    let room = enter(service, &mut client, study);
    (client, room)
}

fn enter(service: &Service, client: &mut Client, study: &Path) -> Room {
    client.wait_for("Recording into", PATIENCE);
    let journal = experiment::files::list(&study.join("data/sourcedata")).expect("readable");
    Room::follow_from(service, &journal[0])
}

/// The same session without a headset, which knows where the panel hangs for a head.
struct Twin {
    session: Session,
    panel: Panel,
}

impl Twin {
    fn new(folder: &Path, head: Tracked) -> Self {
        let study = Study::open(&new_study(folder, &[])).expect("just made");
        let lock = study.lock().expect("nobody else has it");
        let participant = study.admit(&lock, 1).expect("a free slot").participant;
        let guest = Guest {
            participant: &participant,
            slot: 1,
            device: "desk",
            seed: 1,
            notes: Vec::new(),
            before: None,
        };
        let root = Path::new(env!("CARGO_MANIFEST_DIR"));
        let setup = seat::setup(&study, &lock, guest, root).expect("the shipped settings");
        let mut twin = Self {
            session: Session::start(setup).expect("a session"),
            panel: Panel::new(AnsweredIn::Headset, Words::shipped()),
        };
        let input = Input {
            head: Some(head),
            steps: 8,
            ..Input::default()
        };
        twin.session.frame(input).expect("writable");
        twin.panel.attend(&mut twin.session).expect("writable");
        twin
    }

    /// Where a choice lies, world frame [m].
    fn place(&self, choice: &Choice) -> DVec3 {
        self.panel.place_of(choice).expect("it is asked")
    }

    fn answer(&mut self, answer: Answer) {
        let act = Act::Answer(answer);
        let answered = self.session.answer(act, AnsweredIn::Headset);
        answered.expect("it fits");
        self.panel.attend(&mut self.session).expect("writable");
    }
}

/// Points at a place with the right hand, pulls the trigger, and lets it go.
fn choose(room: &mut Room, at: DVec3, answers: usize) {
    let eye = room.game.head_pose_world().expect("it is tracked").position;
    room.reach(Hand::Right, eye.lerp(at, 0.25));
    assert_eq!(forms(room).len(), answers, "pointing alone chooses nothing");
    room.hand(Hand::Right).trigger = 1.0;
    room.send();
    room.wait_until("the answer", |room| forms(room).len() > answers);
    room.hand(Hand::Right).trigger = 0.0;
    room.send();
    room.wait_until("an open hand", |room| room.input.trigger == 0.0);
    assert_eq!(forms(room).len(), answers + 1, "one pull, one answer");
}

/// The acts at forms so far.
fn forms(room: &Room) -> Vec<Value> {
    let notes = room.said.iter().map(|line| line["study"].clone());
    notes.filter(|note| note["note"] == "form").collect()
}

#[test]
fn a_question_in_the_room_is_answered_by_pointing_and_the_trigger() {
    let Some(runtime) = runtime() else { return };
    let service = Service::start(&runtime, Compositor::Null);
    let out = tempfile::tempdir().expect("a temporary folder");
    let study = new_study(&out.path().join("study"), &[]);
    let (client, mut room) = sit_down(&service, &study, &[]);
    let head = room.input.head.expect("it is tracked");
    let mut twin = Twin::new(&out.path().join("twin"), head);
    let age = Answer::Choice {
        chosen: vec!["35-44".to_owned()],
        other: String::new(),
    };
    let place = twin.place(&Choice::Answer(age.clone()));
    choose(&mut room, place, 0);
    twin.answer(age);
    let place = twin.place(&Choice::Answer(Answer::YesNo(false)));
    choose(&mut room, place, 1);
    let answered = forms(&room);
    let said: Vec<(&Value, &Value)> = answered
        .iter()
        .map(|note| (&note["act"]["item"], &note["answered_in"]))
        .collect();
    assert_eq!(said[0], (&"age_band".into(), &"headset".into()));
    assert_eq!(said[1], (&"vr_before".into(), &"headset".into()));
    let chosen = answered[0]["act"].to_string();
    assert!(chosen.contains("35-44"), "{chosen}");
    let (status, said) = client.finish();
    assert!(status.success(), "{said}");
    // The tables name the device that the runtime named.
    let sessions = experiment::files::list(&study.join("data")).expect("readable");
    let table = sessions
        .iter()
        .find(|path| path.to_string_lossy().ends_with("_sessions.tsv"))
        .expect("a table of sessions");
    let table = fs::read_to_string(table).expect("text");
    let mut lines = table.lines().map(|line| line.split('\t'));
    let (names, cells) = (lines.next().expect("names"), lines.next().expect("a row"));
    let cell = |name: &str| {
        let mut pairs = names.clone().zip(cells.clone());
        pairs.find(|(key, _)| *key == name).map(|(_, cell)| cell)
    };
    assert!(
        cell("runtime").is_some_and(|runtime| runtime.contains("Monado")),
        "{table}"
    );
    assert!(cell("model").is_some_and(|model| model != "n/a"), "{table}");
    // The null compositor shows 20 pictures a second.
    assert_eq!(cell("refresh_rate"), Some("20.000000"), "{table}");
}

/// The rate that the experimenter asks for reaches the runtime, which offers another one.
#[test]
fn a_study_asks_the_headset_for_a_refresh_rate() {
    let Some(runtime) = runtime() else { return };
    let service = Service::start(&runtime, Compositor::Null);
    let out = tempfile::tempdir().expect("a temporary folder");
    let study = new_study(&out.path().join("study"), &[]);
    let client = run(&service, &study, &["--refresh-rate", "90"], &[]);
    let (status, said) = client.wait();
    assert!(!status.success(), "{said}");
    assert!(said.contains("90 Hz") && said.contains("20"), "{said}");
}

/// The experimenter is told how tracking fares: a head that is lost alone is one loss, and the hand's none.
#[test]
fn a_lost_head_is_counted_for_the_experimenter() {
    let Some(runtime) = runtime() else { return };
    let service = Service::start(&runtime, Compositor::Null);
    let out = tempfile::tempdir().expect("a temporary folder");
    let study = new_study(&out.path().join("study"), &[]);
    let (typed, mut terminal) = std::io::pipe().expect("a pipe");
    let mut client = run_told(&service, &study, &[], &[], typed.into());
    terminal.write_all(TICKS).expect("the program reads");
    let mut room = enter(&service, &mut client, &study);
    let head = room.packet.head;
    room.packet.head.position = DVec3::splat(f64::NAN);
    room.send();
    room.wait_until("the loss", |room| room.input.head.is_none());
    terminal.write_all(b"/status\n").expect("the program reads");
    client.wait_for("Head LOST for", PATIENCE);
    client.wait_for("Hand tracked.", PATIENCE);
    room.packet.head = head;
    room.send();
    room.wait_until("the head", |room| room.input.head.is_some());
    terminal.write_all(b"/status\n").expect("the program reads");
    client.wait_for("Head tracked (lost once, ", PATIENCE);
    let (status, said) = client.finish();
    assert!(status.success(), "{said}");
}
