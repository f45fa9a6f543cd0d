//! Buttons and triggers, of the controllers that the runtime has: Valve's Index by the remote driver, those of Windows Mixed Reality
//! by keys and mouse, simple ones that move by themselves.

use std::path::Path;
use std::time::Instant;

use bowling_app::journal::InputLine;
use game::{Button, Input};
use glam::DVec3;
use serde_json::Value;

use crate::client::{Client, JournalLines, journal_lines};
use crate::loss::play;
use crate::machine::runtime;
use crate::play::{start, start_with};
use crate::room::{Hand, PATIENCE, Room};
use crate::service::{Compositor, Driver, Service};

/// Hands that have felt a pulse of this strength.
fn felt(room: &Room, amplitude: f64) -> Vec<&str> {
    let pulses = room.device("pulse");
    let such = pulses.into_iter().filter(|pulse| {
        let given = pulse["amplitude"].as_f64().expect("a number");
        (given - amplitude).abs() < 1e-6
    });
    such.map(|pulse| pulse["hand"].as_str().expect("a name"))
        .collect()
}

/// In practice no game can be begun: a press by the thumb is felt by its hand, one in the room by the hand that pushed.
#[test]
fn a_refused_press_is_felt_by_the_hand_that_pressed() {
    const REFUSED: f64 = 0.25;
    let Some(runtime) = runtime() else { return };
    let service = Service::start(&runtime, Compositor::Null);
    let out = tempfile::tempdir().expect("a temporary folder");
    let folder = out.path().join("session");
    let practice = ["practice.only=true"];
    let mut client = start_with(&service, &folder, "test", &[], &practice);
    let mut room = Room::enter(&service, &mut client, &folder);
    room.packet.left.b = true;
    room.send();
    room.wait_until("a pulse", |room| !felt(room, REFUSED).is_empty());
    assert_eq!(felt(&room, REFUSED), ["left"]);
    assert_eq!(room.count("refused"), 1);
    // The thumb stays where it is.
    room.walk_to(Hand::Right, -1.1, 2.55);
    let buttons = room.game.observe().buttons;
    let red = buttons.iter().find(|seen| seen.button == Button::Red);
    let top = red.expect("it is there").top;
    for height in [0.25, 0.02, 0.25] {
        room.reach(Hand::Right, top + DVec3::Y * height);
    }
    room.wait_until("another pulse", |room| felt(room, REFUSED).len() > 1);
    assert_eq!(felt(&room, REFUSED), ["left", "right"]);
    assert_eq!((room.count("refused"), room.count("pressed")), (2, 0));
    let (status, said) = client.finish();
    assert!(status.success(), "{said}");
}

/// A trigger that moves through several readings: the ball is taken above the one threshold and let go below the other, whatever the
/// value does between them.
#[test]
fn an_analogue_trigger_takes_and_lets_go_at_its_thresholds() {
    let Some(mut played) = play() else { return };
    let room = &mut played.room;
    let hand = room.game.config().hand.clone();
    let (open, close) = (hand.trigger_open, hand.trigger_close);
    room.reach_ball(Hand::Right);
    let pull = |room: &mut Room, value: f64| {
        room.hand(Hand::Right).trigger = value;
        room.send();
        // The driver has single precision.
        room.wait_until("the reading", |room| {
            (room.input.trigger - value).abs() < 1e-6
        });
        room.game.held().is_some()
    };
    let between = (open + close) / 2.0;
    for value in [0.2, open + 0.02, between, close - 0.02] {
        assert!(!pull(room, value), "taken at {value}");
    }
    for value in [close + 0.02, close - 0.02, between, open + 0.02, 0.9] {
        assert!(pull(room, value), "let go at {value}");
    }
    for value in [between, open + 0.02] {
        assert!(pull(room, value), "let go at {value}");
    }
    assert_eq!((room.count("grabbed"), room.count("released")), (1, 0));
    assert!(!pull(room, open - 0.02), "held at less than {open}");
    assert!(!pull(room, open + 0.02), "taken again");
    let let_go = [room.count("released"), room.count("dropped")];
    assert_eq!(let_go, [1, 0]);
    let age = room.released_age.expect("the runtime knows when it opened");
    assert!(
        age > 0.0,
        "a picture is prepared ahead of its time: {age} s"
    );
    played.end();
}

/// The journal of a program whose hands the test does not move by packets.
struct Story {
    journal: JournalLines,
    said: Vec<Value>,
}

impl Story {
    fn follow(client: &mut Client, folder: &Path) -> Self {
        client.wait_for("Recording into", PATIENCE);
        Self {
            journal: journal_lines(folder, PATIENCE),
            said: Vec::new(),
        }
    }

    /// Reads on until a line holds something; whatever comes is kept.
    fn wait_until(&mut self, what: &str, holds: impl Fn(&Value) -> bool) {
        let begun = Instant::now();
        loop {
            let left = PATIENCE.saturating_sub(begun.elapsed());
            let line = self.journal.next_within(left).filter(|_| !left.is_zero());
            let line = line.unwrap_or_else(|| panic!("{what} did not come about"));
            let line: Value = serde_json::from_str(&line).expect("a line of JSON");
            self.said.push(line);
            if holds(&self.said[self.said.len() - 1]) {
                return;
            }
        }
    }

    /// Reads on until the game was given such an input.
    fn wait_for_input(&mut self, what: &str, holds: impl Fn(&Input) -> bool) {
        self.wait_until(what, |line| {
            let line = serde_json::from_value::<InputLine>(line["input"].clone());
            line.is_ok_and(|line| holds(&Input::from(&line)))
        });
    }

    fn wait_for_event(&mut self, kind: &str) {
        self.wait_until(kind, |line| line["event"]["event"] == kind);
    }

    /// Reads on until the runtime has chosen a profile for both hands; which it has said first of each.
    fn wait_for_profiles(&mut self) -> [Value; 2] {
        let profile = |side: &str, line: &Value| -> Option<Value> {
            let device = &line["device"];
            let is_told = device["hand"] == side && !device["profile"].is_null();
            is_told.then(|| device["profile"].clone())
        };
        ["left", "right"].map(|side| {
            let told = self.said.iter().find_map(|line| profile(side, line));
            told.unwrap_or_else(|| {
                self.wait_until("a profile", |line| profile(side, line).is_some());
                profile(side, &self.said[self.said.len() - 1]).expect("just seen")
            })
        })
    }
}

/// Everything that a controller of Windows Mixed Reality has: trigger by value, a squeeze that is pressed, a pad and a stick whose
/// press walks or chooses by the thumb's place, and a menu button.
#[test]
fn the_controllers_of_another_profile_play_by_their_pad_and_pause_by_their_menu_button() {
    let Some(runtime) = runtime() else { return };
    let service = Service::start_with(&runtime, Compositor::Null, Driver::Keys);
    let out = tempfile::tempdir().expect("a temporary folder");
    let folder = out.path().join("session");
    let mut client = start(&service, &folder);
    let mut story = Story::follow(&mut client, &folder);
    story.wait_for_input("a hand", |input| input.hand.is_some());
    let profile = "/interaction_profiles/microsoft/motion_controller";
    assert_eq!(story.wait_for_profiles(), [profile; 2]);
    let keys = service.keys();
    let window = keys.act(&["search", "--sync", "--name", "Monado"]);
    keys.act(&["windowfocus", "--sync", &window]);
    keys.act(&["mousemove", "--sync", "400", "300"]);

    // The right hand's: pad and stick walk only while they are pressed.
    for [pad, press] in [["i", "m"], ["t", "v"]] {
        keys.act(&["keydown", pad, "keydown", press]);
        story.wait_for_input("a walk", |input| input.walk_forward);
        keys.act(&["keyup", press]);
        story.wait_for_input("a resting thumb", |input| !input.walk_forward);
        keys.act(&["keyup", pad]);
    }
    keys.act(&["keydown", "k", "keydown", "m"]);
    story.wait_for_input("a walk back", |input| input.walk_back);
    keys.act(&["keyup", "m", "keyup", "k"]);
    story.wait_for_input("no walk", |input| !input.walk_back);

    // The trigger, and the squeeze.
    for button in ["1", "2"] {
        keys.act(&["mousedown", button]);
        story.wait_for_input("a closed hand", |input| input.trigger == 1.0);
        keys.act(&["mouseup", button]);
        story.wait_for_input("an open hand", |input| input.trigger == 0.0);
    }

    // Menu pauses, and goes on.
    keys.act(&["keydown", "n"]);
    story.wait_for_event("paused");
    keys.act(&["keyup", "n"]);
    story.wait_for_input("time that stands still", |input| {
        input.paused && input.steps == 0
    });
    keys.act(&["keydown", "n"]);
    story.wait_for_event("resumed");
    keys.act(&["keyup", "n"]);
    story.wait_for_input("time that goes on", |input| input.steps > 0);

    // The left hand's pad: its lower half is Blue.
    keys.act(&["keydown", "Control_L", "keydown", "k", "keydown", "m"]);
    story.wait_for_event("game_started");
    let started = story.said[story.said.len() - 1]["event"].clone();
    assert_eq!(started["button"], "blue");
    keys.act(&["keyup", "m", "keyup", "k", "keyup", "Control_L"]);
    let (status, said) = client.finish();
    assert!(status.success(), "{said}");
}

/// Controllers that have select and menu only: hands are there, and nothing that such a one lacks is waited for.
#[test]
fn simple_controllers_are_played_with() {
    let Some(runtime) = runtime() else { return };
    let service = Service::start_with(&runtime, Compositor::Null, Driver::Simulated);
    let out = tempfile::tempdir().expect("a temporary folder");
    let folder = out.path().join("session");
    let mut client = start(&service, &folder);
    let mut story = Story::follow(&mut client, &folder);
    story.wait_for_input("a hand", |input| {
        input.hand.is_some() && input.head.is_some() && input.steps > 0
    });
    let profile = "/interaction_profiles/khr/simple_controller";
    assert_eq!(story.wait_for_profiles(), [profile; 2]);
    let (status, said) = client.finish();
    assert!(status.success(), "{said}");
    assert!(said.contains("hand: /interaction_profiles/khr"), "{said}");
}
