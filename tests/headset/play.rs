//! Playing through the runtime: walking, grabbing, swinging, releasing, scoring.

use std::ffi::OsStr;
use std::path::Path;
use std::time::Duration;

use game::{Button, Phase};
use glam::DVec3;
use serde_json::{Value, json};

use crate::client::Client;
use crate::loss::replays;
use crate::machine::runtime;
use crate::room::{Hand, PATIENCE, Released, Room, Swing};
use crate::service::{Compositor, Service};
use crate::shared::ask_until;
use crate::shared::screen::{Screen, colours};

/// Beside the rack, so that a ball is within reach of either hand.
const BESIDE_RACK: [&str; 4] = ["--set", "start.x_m=0.75", "--set", "start.z_m=2.25"];

/// Starts the program beside the rack, in a game of one frame that is recorded into `folder`. The scene is the one that is
/// quickly drawn, so that a busy machine without a graphics card makes enough pictures of a swing.
pub fn start(service: &Service, folder: &Path) -> Client {
    start_with(service, folder, "test", &[], &[])
}

/// As [`start`], in the alley with all that it shows, and with more in the program's environment.
pub fn start_alley(service: &Service, folder: &Path, environment: &[(&str, &OsStr)]) -> Client {
    start_with(service, folder, "alley", environment, &[])
}

/// As [`start`], in another scene, with more in the program's environment and other settings.
pub fn start_with(
    service: &Service,
    folder: &Path,
    scene: &str,
    environment: &[(&str, &OsStr)],
    settings: &[&str],
) -> Client {
    start_game(service, folder, (scene, "1"), environment, settings)
}

/// As [`start_with`], in a game of so many frames.
fn start_game(
    service: &Service,
    folder: &Path,
    (scene, frames): (&str, &str),
    environment: &[(&str, &OsStr)],
    settings: &[&str],
) -> Client {
    let folder = folder.to_str().expect("a plain path");
    let mut arguments = vec!["play", "--device", "headset", "--no-video"];
    arguments.extend(["--frames", frames, "--scene", scene, "--out", folder]);
    arguments.extend(BESIDE_RACK);
    for setting in settings {
        arguments.extend(["--set", setting]);
    }
    Client::start_in(service, &arguments, environment)
}

fn vector(value: &Value) -> DVec3 {
    let number = |index: usize| value[index].as_f64().expect("three numbers");
    DVec3::new(number(0), number(1), number(2))
}

/// Within 2 % and 1 degree of the swing, and from where the swing had the ball.
fn agrees(room: &Room, truth: Released) {
    let event = room.event("released").expect("just seen");
    assert_eq!(event["source"], "velocity", "{event}");
    let used = vector(&event["used"]["linear"]);
    let ratio = used.length() / truth.velocity.length();
    assert!(
        (ratio - 1.0).abs() < 0.02,
        "speed {ratio} of the swing's: {event}"
    );
    let angle = used.angle_between(truth.velocity).to_degrees();
    assert!(angle < 1.0, "direction off by {angle} degrees: {event}");
    let off = vector(&event["position"]).distance(truth.position);
    assert!(
        off < 0.01,
        "let go {off} m from where the swing had it: {event}"
    );
}

/// The journal has the hand's raw poses around the throw: who fits a velocity to them gets the swing's.
fn has_its_poses(room: &mut Room, truth: Released, throws: usize) {
    room.wait_until("the poses behind the throw", |room| {
        room.device("after_throw").len() == throws
    });
    let released = room.event("released").expect("just seen")["step"].clone();
    let [thrown, after] = ["throw", "after_throw"].map(|key| {
        let lines = room.device(key);
        assert_eq!(lines.len(), throws, "{key}");
        let line = lines[throws - 1].clone();
        assert_eq!(line["step"], released, "{key}");
        line
    });
    let time = |value: &Value| value["xr_time_ns"].as_i64().expect("a time");
    let times = |line: &Value| -> Vec<i64> {
        let readings = line["readings"].as_array().expect("a list");
        readings.iter().map(time).collect()
    };
    let before = thrown["readings"].as_array().expect("a list");
    let let_go = &before[before.len() - 1]["right"];
    // Every frame of that time, however many a busy machine has made.
    let (at, opened) = (time(&thrown), time(&let_go["changes"][0]));
    let frames = |from: i64, to: i64| -> Vec<i64> {
        let all = room.device("frame").into_iter().map(time);
        all.filter(|at| (from..=to).contains(at)).collect()
    };
    assert_eq!(times(&thrown), frames(opened - 200_000_000, at));
    assert_eq!(times(&after), frames(at + 1, at + 100_000_000));
    assert!(before.len() >= 2, "{thrown}");
    let held = &before[before.len() - 2]["right"];
    assert_eq!(
        (&held["trigger"], &let_go["trigger"]),
        (&json!(1.0), &json!(0.0))
    );
    // The driver's velocity at the release is the hand's, a little slower than the ball's farther out on the arm.
    let linear = vector(&let_go["grip"]["linear"]);
    let ratio = linear.length() / truth.velocity.length();
    assert!((0.6..1.0).contains(&ratio), "{ratio}: {let_go}");
    assert!(
        before[0]["left"]["grip"]["position"].is_array(),
        "both hands"
    );
}

/// Begins a game by the upper thumb button of the hand that does not throw.
fn begin_red(room: &mut Room) {
    room.packet.left.b = true;
    room.send();
    room.wait_until("a Red game", |room| room.count("game_started") == 1);
    room.packet.left.b = false;
    room.send();
    let started = room.event("game_started").expect("just seen");
    assert_eq!(started["button"], "red");
}

/// Takes a ball, carries it to the foul line, swings and lets go.
fn bowl(room: &mut Room) -> Released {
    room.take_ball(Hand::Right);
    room.walk_to(Hand::Right, -0.2, 0.9);
    let swing = Swing {
        speed: 6.5,
        release_at: 0.1,
    };
    swing.throw(room, Hand::Right)
}

/// Waits until so many throws are counted and the next may be made, back at the rack.
fn await_pinsetter(room: &mut Room, throws: usize) {
    room.wait_until("the pins counted", |room| room.count("settled") == throws);
    room.wait_until("the pinsetter", |room| {
        room.game.phase() == Phase::Ready || room.count("game_over") == 1
    });
    room.walk_to(Hand::Right, 0.6, 2.3);
}

/// Ten frames from a cold start to the final score; the replay of what was recorded is the same.
#[test]
fn a_whole_game_is_played() {
    let Some(runtime) = runtime() else { return };
    let service = Service::start(&runtime, Compositor::Null);
    let out = tempfile::tempdir().expect("a temporary folder");
    let folder = out.path().join("session");
    let mut client = start_game(&service, &folder, ("test", "10"), &[], &[]);
    let mut room = Room::enter(&service, &mut client, &folder);
    begin_red(&mut room);
    let mut throws = 0;
    while room.count("game_over") == 0 {
        assert!(throws < 21, "a game has twenty-one balls at most");
        bowl(&mut room);
        throws += 1;
        await_pinsetter(&mut room, throws);
    }
    assert_eq!(room.count("frame_scored"), 10);
    let total = room.event("game_over").expect("just seen")["total"].clone();
    assert_eq!(
        total,
        room.event("frame_scored").expect("ten were")["total"]
    );
    let (status, said) = client.finish();
    assert!(status.success(), "{said}");
    let sheet = std::fs::read_to_string(folder.join("red-score.txt")).expect("a score sheet");
    assert!(sheet.contains(&total.to_string()), "{total}: {sheet}");
    replays(&folder);
}

/// A game of one frame: chosen by the buttons of the other hand, played to its score.
#[test]
fn a_whole_frame_is_played() {
    let Some(runtime) = runtime() else { return };
    let service = Service::start(&runtime, Compositor::Null);
    let out = tempfile::tempdir().expect("a temporary folder");
    let folder = out.path().join("session");
    let mut client = start(&service, &folder);
    let mut room = Room::enter(&service, &mut client, &folder);
    assert!(client.is_watched(), "no validation layer was loaded");
    let used = room.device("extensions")[0].to_string();
    for extension in [
        "XR_KHR_composition_layer_depth",
        "XR_KHR_visibility_mask",
        "XR_EXT_hand_tracking",
        "XR_EXT_local_floor",
    ] {
        assert!(used.contains(extension), "{extension} is not in {used}");
    }
    room.wait_until("a known controller", |room| {
        room.has_said("profile", "/interaction_profiles/valve/index_controller")
    });
    begin_red(&mut room);
    let mut throws = 0;
    while room.count("frame_scored") == 0 {
        assert!(throws < 3, "a last frame has three balls at most");
        let truth = bowl(&mut room);
        throws += 1;
        agrees(&room, truth);
        has_its_poses(&mut room, truth, throws);
        await_pinsetter(&mut room, throws);
    }
    // Written down once the runtime has taken them.
    let pulses = room.device("pulse");
    let felt = |amplitude: f64| {
        pulses.iter().any(|pulse| {
            let given = pulse["amplitude"].as_f64().expect("a number");
            pulse["hand"] == "right" && (given - amplitude).abs() < 1e-6
        })
    };
    assert!(felt(0.6), "no grab was felt: {pulses:?}");
    assert!(felt(0.4), "no release was felt: {pulses:?}");
    room.wait_until("the game's frame times", |room| {
        !room.device("game_frames").is_empty()
    });
    let of_game = room.device("game_frames")[0].clone();
    let number = |key: &str| of_game[key].as_f64().expect("a number");
    let lines = room.device("frame").len() as f64;
    assert!((100.0..lines).contains(&number("count")), "{of_game}");
    assert!(of_game["missed"].is_u64(), "{of_game}");
    assert!(
        number("prediction_median_ms") > 0.0
            && number("prediction_longest_ms") >= number("prediction_median_ms")
            && number("taken_p99_ms") >= number("taken_median_ms"),
        "{of_game}"
    );
    let total = room.event("frame_scored").expect("just seen")["total"].clone();
    let (status, said) = client.finish();
    assert!(status.success(), "{said}");
    let sheet = std::fs::read_to_string(folder.join("red-score.txt")).expect("a score sheet");
    assert!(
        sheet.contains(&total.to_string()),
        "{total} is not in {sheet}"
    );
}

/// Both buttons on the desk, pushed down by the hand that the runtime tells of.
#[test]
fn red_and_blue_are_pushed_down_in_the_room() {
    let Some(runtime) = runtime() else { return };
    let service = Service::start(&runtime, Compositor::Null);
    let out = tempfile::tempdir().expect("a temporary folder");
    let folder = out.path().join("session");
    let mut client = start(&service, &folder);
    let mut room = Room::enter(&service, &mut client, &folder);
    room.walk_to(Hand::Right, -1.1, 2.55);
    let buttons = room.game.observe().buttons;
    let press = |room: &mut Room, button: Button| {
        let seen = buttons.iter().find(|seen| seen.button == button);
        let top = seen.expect("both are there").top;
        let before = room.count("pressed");
        for height in [0.25, 0.02, 0.25] {
            room.reach(Hand::Right, top + DVec3::Y * height);
        }
        room.wait_until("the press", |room| room.count("pressed") > before);
        assert_eq!(room.count("pressed"), before + 1, "pressed once");
    };
    press(&mut room, Button::Red);
    let started = room.event("game_started").expect("a press starts a game");
    assert_eq!(started["button"], "red");
    press(&mut room, Button::Blue);
    assert_eq!(room.count("confirm_asked"), 1);
    assert_eq!(room.count("game_started"), 1, "a game is played");
    press(&mut room, Button::Blue);
    let started = room.event("game_started").expect("just seen");
    assert_eq!(started["button"], "blue");
    let (status, said) = client.finish();
    assert!(status.success(), "{said}");
}

/// The experimenter's window shows the participant's room, and its keys press Red and Blue.
#[test]
fn the_mirror_shows_the_room_and_takes_the_experimenters_keys() {
    let Some(runtime) = runtime() else { return };
    let service = Service::start(&runtime, Compositor::Xvfb { hz: 45 });
    let out = tempfile::tempdir().expect("a temporary folder");
    let folder = out.path().join("session");
    let screen = service.screen();
    let display = [("DISPLAY", OsStr::new(screen.display()))];
    let mut client = start_alley(&service, &folder, &display);
    let mut room = Room::enter(&service, &mut client, &folder);
    let window = screen.act(&["search", "--sync", "--name", "what the participant sees"]);
    // Until the window has been drawn it takes no keys.
    let pressed = ask_until(PATIENCE, || {
        screen.act(&["windowfocus", &window, "key", "2"]);
        room.follow(Duration::from_millis(200));
        (room.count("game_started") == 1).then_some(())
    });
    assert!(pressed.is_some(), "the key does nothing");
    assert_eq!(
        room.event("game_started").expect("just seen")["button"],
        "blue"
    );
    // The compositor's own window, which is black, may lie over it.
    let seen = ask_until(PATIENCE, || {
        screen.act(&["windowraise", &window]);
        (colours(&screen.shot()) > 60).then_some(())
    });
    assert!(seen.is_some(), "the mirror shows next to nothing");
    let (status, said) = client.finish();
    assert!(status.success(), "{said}");
    assert!(!said.contains("No mirror window"), "{said}");
}

/// The experimenter's screen hangs: the participant plays on, and the program ends in order although the window never answers.
#[test]
fn a_screen_that_hangs_holds_up_neither_headset_nor_end() {
    let Some(runtime) = runtime() else { return };
    let service = Service::start(&runtime, Compositor::Null);
    let mut screen = Screen::open([800, 600]);
    let out = tempfile::tempdir().expect("a temporary folder");
    let folder = out.path().join("session");
    let display = screen.display().to_owned();
    let mut client = start_alley(&service, &folder, &[("DISPLAY", OsStr::new(&display))]);
    let mut room = Room::enter(&service, &mut client, &folder);
    screen.act(&["search", "--sync", "--name", "what the participant sees"]);
    let seen = ask_until(PATIENCE, || (colours(&screen.shot()) > 60).then_some(()));
    assert!(seen.is_some(), "the mirror shows next to nothing");
    screen.stop();
    let pictures = room.device("frame").len();
    room.take_ball(Hand::Right);
    room.wait_until("pictures that go on", |room| {
        room.device("frame").len() > pictures + 40
    });
    let shown = room.device("frame").split_off(pictures);
    assert!(shown.iter().all(|frame| frame["shown"] == true));
    let (status, said) = client.finish();
    assert!(status.success(), "{said}");
    assert!(said.contains("mirror window does not answer"), "{said}");
    let journal = std::fs::read_to_string(folder.join("journal.jsonl")).expect("it was written");
    let last = journal.lines().last().expect("lines");
    assert!(last.contains("\"end\""), "{last}");
    screen.cont();
}

/// The swing's own speed and direction, whichever hand, however often the display shows a picture.
#[test]
fn a_release_is_the_swings_own_at_every_rate() {
    let Some(runtime) = runtime() else { return };
    for hz in [45, 72, 90, 120] {
        let service = Service::start(&runtime, Compositor::Xvfb { hz });
        let out = tempfile::tempdir().expect("a temporary folder");
        let folder = out.path().join("session");
        let mut client = start(&service, &folder);
        let mut room = Room::enter(&service, &mut client, &folder);
        let rate = room
            .said
            .iter()
            .find_map(|line| line["device"]["refresh_rate_hz"].as_f64())
            .expect("the runtime tells its rate");
        assert!(
            (rate - f64::from(hz)).abs() < 0.01,
            "{rate} Hz instead of {hz}"
        );
        for hand in [Hand::Left, Hand::Right] {
            room.take_ball(hand);
            let truth = Swing {
                speed: 5.0 + f64::from(hz) / 40.0,
                release_at: 0.15,
            }
            .throw(&mut room, hand);
            agrees(&room, truth);
            assert_eq!(room.input.is_left, hand == Hand::Left, "it is seen as such");
        }
        // The remote driver tells one pose for all times, so that it cannot tell a program that asks for the trigger's own time
        // from one that does not; the game's tests do. Here the program must have said when the trigger opened.
        let age = room.released_age.expect("the trigger's own time is known");
        assert!(
            age > 0.0,
            "a picture is prepared ahead of its time: {age} s"
        );
        let (status, said) = client.finish();
        assert!(status.success(), "{said}");
    }
}
