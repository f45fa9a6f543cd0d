//! What a session survives: focus, tracking, and the runtime itself come and go; the game and its journal stay.

use std::ffi::OsStr;
use std::path::Path;
use std::time::Instant;

use game::Model;
use glam::DVec3;

use crate::client::Client;
use crate::machine::runtime;
use crate::play::{start, start_with};
use crate::room::{Hand, PATIENCE, Room};
use crate::service::{Compositor, Service};

/// A program that plays, and somebody in its room.
pub struct Played {
    service: Service,
    client: Client,
    pub room: Room,
    out: tempfile::TempDir,
}

/// Plays against a service of its own; `None` where there is no runtime.
pub fn play() -> Option<Played> {
    play_in(&[])
}

/// As [`play`], with more in the program's environment.
pub fn play_in(environment: &[(&str, &OsStr)]) -> Option<Played> {
    let runtime = runtime()?;
    let service = Service::start(&runtime, Compositor::Null);
    let out = tempfile::tempdir().expect("a temporary folder");
    let folder = out.path().join("session");
    let mut client = start_with(&service, &folder, "test", environment, &[]);
    let room = Room::enter(&service, &mut client, &folder);
    Some(Played {
        service,
        client,
        room,
        out,
    })
}

impl Played {
    /// Ends the program, and has it replay its own journal: every input, event and the last state must be there.
    pub fn end(self) {
        let (status, said) = self.client.finish();
        assert!(status.success(), "{said}");
        replays(&self.out.path().join("session"));
    }
}

/// Starts the runtime again, and waits until the program has found it. The hands come first: until then the driver has them open.
fn bring_back(service: &mut Service, room: &mut Room, client: &mut Client) {
    service.restart();
    room.reconnect(service);
    client.wait_for("Connected to the headset again", PATIENCE);
}

pub fn replays(session: &Path) {
    let output = std::process::Command::new(env!("CARGO_BIN_EXE_bowling"))
        .args(["--root", env!("CARGO_MANIFEST_DIR"), "replay"])
        .arg(session)
        .output()
        .expect("the program starts");
    let said = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{said}");
}

/// The runtime dies with a ball in the hand. The program says so, waits, connects to the next one, and the same game goes on:
/// the ball is still in the hand, and no time has passed in the alley.
#[test]
fn a_killed_runtime_is_waited_for() {
    let Some(mut played) = play() else { return };
    let room = &mut played.room;
    room.take_ball(Hand::Right);
    let steps = room.game.steps();
    played.service.kill();
    played.client.wait_for("waits for the headset", PATIENCE);
    room.wait_until("the loss in the journal", |room| {
        room.said
            .iter()
            .any(|line| line["device"]["lost"].is_string())
    });
    assert!(room.game.steps() < steps + 720, "the alley stood still");
    assert_eq!(room.game.held(), Some(Model::Ball(0)));
    bring_back(&mut played.service, room, &mut played.client);
    let focused = |room: &Room| {
        let lines = room
            .said
            .iter()
            .filter(|line| line["device"]["focus"] == "focused");
        lines.count()
    };
    room.wait_until("the focus again", |room| focused(room) == 2);
    let held_before = room.input;
    room.wait_until("time goes on", |room| {
        room.input != held_before && room.input.steps > 0
    });
    assert_eq!(room.game.held(), Some(Model::Ball(0)));
    played.end();
}

/// As above, asked to end instead of killed.
#[test]
fn a_runtime_that_is_asked_to_end_is_waited_for() {
    let Some(mut played) = play() else { return };
    played.service.terminate();
    played.client.wait_for("waits for the headset", PATIENCE);
    bring_back(&mut played.service, &mut played.room, &mut played.client);
    played.end();
}

/// A runtime that hangs blocks its caller for ever; the program notices, says so, and can be ended with all its data.
#[test]
fn a_runtime_that_hangs_is_noticed() {
    let Some(mut played) = play() else { return };
    played.service.stop();
    played.client.wait_for("does not answer", PATIENCE);
    played.service.cont();
    played.client.wait_for("answers again", PATIENCE);
    played.service.stop();
    played.client.wait_for("does not answer", PATIENCE);
    let Played {
        mut service,
        client,
        out,
        ..
    } = played;
    let (status, said) = client.finish();
    assert!(status.success(), "{said}");
    replays(&out.path().join("session"));
    service.cont();
}

/// Another program takes the hands: time stands still and the hand is gone, until they come back.
#[test]
fn a_lost_focus_pauses_the_game() {
    let Some(mut played) = play() else { return };
    let room = &mut played.room;
    let elsewhere = tempfile::tempdir().expect("a temporary folder");
    let mut other = start(&played.service, &elsewhere.path().join("session"));
    other.wait_for("Recording into", PATIENCE);
    room.wait_until("the loss of focus", |room| room.input.hand.is_none());
    let steps = room.game.steps();
    let frames = room.said.len();
    room.wait_until("frames that go on", |room| room.said.len() > frames + 20);
    assert_eq!(room.game.steps(), steps);
    let (status, said) = other.finish();
    assert!(status.success(), "{said}");
    room.wait_until("the focus", |room| {
        room.input.hand.is_some() && room.input.steps > 0
    });
    played.end();
}

/// The runtime gives the hands to one program and to another, both of which go on: whoever has none stands still.
#[test]
fn focus_that_goes_and_comes_pauses_and_goes_on() {
    let Some(mut played) = play() else { return };
    let id = played
        .service
        .client_id("bowling")
        .expect("it is connected");
    let elsewhere = tempfile::tempdir().expect("a temporary folder");
    let mut other = start(&played.service, &elsewhere.path().join("session"));
    other.wait_for("Recording into", PATIENCE);
    let room = &mut played.room;
    room.wait_until("the loss of focus", |room| room.input.hand.is_none());
    let (steps, begun) = (room.game.steps(), Instant::now());
    played.service.ctl(&["-p", &id.to_string()]);
    room.wait_until("the focus again", |room| {
        room.input.hand.is_some() && room.input.steps > 0
    });
    // The pause was as long as the other program took to start.
    let passed = (room.game.steps() - steps) as f64 / 720.0;
    let most = begun.elapsed().as_secs_f64() + 0.05;
    assert!(passed < most, "{passed} s in {most} s: time is made up for");
    let (status, said) = other.finish();
    assert!(status.success(), "{said}");
    played.end();
}

/// The runtime cuts off what the hands do: the ball in the hand falls, and when they are back it can be taken again.
#[test]
fn hands_that_are_cut_off_are_lost_and_come_back() {
    let Some(mut played) = play() else { return };
    let id = played
        .service
        .client_id("bowling")
        .expect("it is connected");
    let id = id.to_string();
    let room = &mut played.room;
    room.take_ball(Hand::Right);
    played.service.ctl(&["-i", &id]);
    room.wait_until("the fall", |room| room.count("dropped") == 1);
    assert!(room.input.hand.is_none() && room.count("released") == 0);
    room.hand(Hand::Right).trigger = 0.0;
    room.send();
    played.service.ctl(&["-i", &id]);
    room.wait_until("the hand again", |room| room.input.hand.is_some());
    room.take_ball(Hand::Right);
    played.end();
}

/// The participant recentres with a ball in the hand: head and hand are elsewhere at once, and nothing else happens.
#[test]
fn recentring_neither_throws_nor_strikes_nor_walks() {
    let Some(mut played) = play() else { return };
    let room = &mut played.room;
    room.take_ball(Hand::Right);
    // Half a metre to the side, so that the middle of the new space is not that of the old one.
    let aside = DVec3::new(0.3, 0.0, 0.4);
    room.packet.head.position += aside;
    let world = room.game.hand_pose_world().expect("it is tracked").position;
    room.reach(Hand::Right, world + aside);
    let hand = room.input.hand.expect("it is tracked").pose.position;
    let rig = room.game.world_from_tracking();
    let events = ["impact", "touched", "released", "dropped", "tracking"];
    let before = events.map(|kind| room.count(kind));
    played.service.ctl(&["-c"]);
    room.wait_until("the new space", |room| room.recentred == 1);
    assert_eq!(room.device("recentred").len(), 1);
    let moved = room.input.hand.expect("it is tracked").pose.position - hand;
    assert!(
        moved.distance(-aside) < 0.01,
        "the hand is elsewhere: {moved}"
    );
    let steps = room.game.steps();
    room.wait_until("some time", |room| room.game.steps() > steps + 360);
    assert_eq!(room.game.held(), Some(Model::Ball(0)));
    assert_eq!(events.map(|kind| room.count(kind)), before, "{events:?}");
    assert_eq!(room.game.world_from_tracking(), rig);
    assert_eq!(room.recentred, 1, "told once");
    played.end();
}

/// The hand is lost with a ball in it: the ball is held for 300 ms, and then it falls.
#[test]
fn a_lost_hand_drops_the_ball_after_a_while() {
    let Some(mut played) = play() else { return };
    let room = &mut played.room;
    room.take_ball(Hand::Right);
    room.hand(Hand::Right).is_tracked = false;
    room.send();
    room.wait_until("the fall", |room| room.count("dropped") == 1);
    let step = |kind: &str| {
        let event = room.event(kind).expect("it happened");
        event["step"].as_f64().expect("a number")
    };
    let after = (step("dropped") - step("tracking")) / 720.0;
    // In whole frames: 50 ms without a compositor, and at most 250 ms of a busy machine's.
    assert!((0.25..0.56).contains(&after), "dropped after {after} s");
    played.end();
}

/// The head alone is lost, with a ball in the hand: the runtime gives numbers for it that are none, since its driver cannot say that it
/// knows nothing. Game and journal have it, no picture is made from nowhere, and the hand plays on.
#[test]
fn a_lost_head_keeps_no_hand_from_playing() {
    let Some(mut played) = play() else { return };
    let room = &mut played.room;
    room.take_ball(Hand::Right);
    let head = room.packet.head;
    let tracking = |room: &Room, part: &str, found: bool| {
        let events = room.said.iter().map(|line| &line["event"]);
        let such = events.filter(|event| event["event"] == "tracking" && event["found"] == found);
        such.filter(|event| event["part"] == part).count()
    };
    let found = tracking(room, "head", true);
    room.packet.head.position = DVec3::splat(f64::NAN);
    room.send();
    room.wait_until("the loss", |room| tracking(room, "head", false) == 1);
    assert!(room.input.head.is_none() && room.input.hand.is_some());
    let pictures = room.device("frame").len();
    room.wait_until("frames that go on", |room| {
        room.device("frame").len() > pictures + 10
    });
    let frames = room.device("frame").split_off(pictures + 1);
    assert!(frames.iter().all(|frame| frame["shown"] == false));
    assert_eq!(room.game.held(), Some(Model::Ball(0)));
    room.hand(Hand::Right).trigger = 0.0;
    room.send();
    room.wait_until("the release", |room| room.count("released") == 1);
    room.packet.head = head;
    room.send();
    room.wait_until("the head again", |room| {
        tracking(room, "head", true) > found
            && room
                .device("frame")
                .last()
                .is_some_and(|frame| frame["shown"] == true)
    });
    assert_eq!(tracking(room, "hand", false), 0, "the hand was there");
    assert!(room.device("lost").is_empty(), "the session went on");
    played.end();
}

/// A runtime that hangs before anything has begun: one sentence, and on to whoever can play without a headset.
#[test]
fn a_runtime_that_hangs_at_the_start_is_done_without() {
    let Some(runtime) = runtime() else { return };
    let mut service = Service::start(&runtime, Compositor::Null);
    service.stop();
    let out = tempfile::tempdir().expect("a temporary folder");
    let folder = out.path().join("session");
    let folder = folder.to_str().expect("a plain path");
    let arguments = ["play", "--frames", "1", "--no-video", "--out", folder];
    let (status, said) = Client::start(&service, &arguments).wait();
    assert!(status.success(), "{said}");
    assert!(
        said.contains("no headset (the OpenXR runtime does not answer: end it"),
        "{said}"
    );
    service.cont();
}

/// A loader without a runtime: the sentence says how to get one.
#[test]
fn a_missing_runtime_is_named() {
    let Some(runtime) = runtime() else { return };
    let started = std::fs::read_to_string(runtime.join("ld")).expect("the script made it");
    let elsewhere = started.replace("monado.json", "nothing.json");
    assert_ne!(started, elsewhere, "it names the runtime");
    let output = std::process::Command::new("sh")
        .args(["-c", &elsewhere, "ld", env!("CARGO_BIN_EXE_bowling")])
        .args(["play", "--device", "headset", "--no-video"])
        .env("BOWLING_ROOT", env!("CARGO_MANIFEST_DIR"))
        .output()
        .expect("a shell");
    let said = String::from_utf8_lossy(&output.stderr);
    assert!(!output.status.success());
    assert!(said.contains("no OpenXR runtime is active"), "{said}");
}

/// Without a service: one sentence, and on to whoever can play without a headset.
#[test]
fn a_missing_service_is_named_and_done_without() {
    let Some(runtime) = runtime() else { return };
    let mut service = Service::start(&runtime, Compositor::Null);
    service.kill();
    let out = tempfile::tempdir().expect("a temporary folder");
    let folder = out.path().join("session");
    let arguments = |device: &'static [&'static str]| {
        let mut arguments = vec!["play", "--frames", "1", "--no-video", "--out"];
        arguments.push(folder.to_str().expect("a plain path"));
        arguments.extend(device);
        arguments
    };
    let client = Client::start(&service, &arguments(&["--device", "headset"]));
    let (status, said) = client.wait();
    assert!(!status.success());
    assert!(
        said.contains("does not answer: start its service"),
        "{said}"
    );
    let client = Client::start(&service, &arguments(&[]));
    let (status, said) = client.wait();
    assert!(status.success(), "{said}");
    assert!(said.contains("because there is no headset"), "{said}");
}
