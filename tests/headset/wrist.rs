//! Pause and the way back to the start by the panel at the wrist, which the runtime's controllers need because they have no menu button;
//! and the fence where the tracked space ends. Head and hands are moved through the runtime.

use std::ffi::OsStr;

use bowling_app::signs::facing;
use bowling_app::words::Words;
use bowling_app::wrist::{Arms, Wrist};
use glam::{DQuat, DVec3};
use image::RgbImage;
use physics::Pose;
use renderer::headset::{HeadsetSession, HeadsetSettings};

use crate::inside::{first_frame, found, is_inside, run_inside};
use crate::loss::play;
use crate::machine::runtime;
use crate::play::start_with;
use crate::remote::Packet;
use crate::room::{Hand, PATIENCE, Room};
use crate::service::{Compositor, Service};
use crate::shared::ask_until;

/// Where the wrist of the hand that does not play is held, from the head [m].
const WRIST: DVec3 = DVec3::new(-0.12, -0.30, -0.40);
/// The upper button of the panel, and the lower one.
const PAUSE: usize = 0;
const TO_THE_START: usize = 1;

/// A head at `eye` that looks at a point.
fn looking(eye: DVec3, at: DVec3) -> Pose {
    // Signs face with +z, heads with -z.
    let rotation = facing(eye, at).rotation * DQuat::from_rotation_y(std::f64::consts::PI);
    Pose::new(eye, rotation)
}

/// Where a button of the panel is, as it hangs over a wrist before an eye.
fn button(eye: DVec3, wrist: DVec3, index: usize) -> DVec3 {
    let mut panel = Wrist::default();
    let arms = Arms {
        head: looking(eye, wrist + DVec3::Y * 0.1),
        wrist: Pose::from_position(wrist),
        pointer: None,
    };
    panel.attend(Some(arms), true, 0.0);
    panel.signs(false, &Words::shipped().pause)[index]
        .pose
        .position
}

/// Lifts the left wrist before the eyes and looks at a button of its panel; where that is in tracking space.
fn look_at_button(room: &mut Room, index: usize) -> DVec3 {
    let eye = room.packet.head.position;
    let wrist = eye + WRIST;
    let at = button(eye, wrist, index);
    room.hand(Hand::Left).pose = Pose::from_position(wrist);
    room.packet.head = looking(eye, at);
    room.send();
    at
}

/// Looks ahead, down the lane, until the program has seen it.
fn look_ahead(room: &mut Room) {
    room.packet.head.rotation = DQuat::IDENTITY;
    room.send();
    room.wait_until("a look ahead", |room| {
        let head = room.input.head.map(|head| head.pose.rotation);
        head.is_some_and(|head| head.angle_between(DQuat::IDENTITY) < 3e-3)
    });
}

#[test]
fn a_look_at_the_wrist_pauses_and_leads_to_the_start_and_a_hand_that_points_goes_on() {
    let Some(mut played) = play() else { return };
    let room = &mut played.room;
    room.walk_to(Hand::Right, 0.3, 3.2);
    // Before the runtime gave the focus there was a pause too.
    let [paused, resumed] = ["paused", "resumed"].map(|kind| room.count(kind));
    let at = look_at_button(room, PAUSE);
    room.wait_until("the pause", |room| room.count("paused") > paused);
    let steps = room.game.steps();
    assert!(room.game.is_paused());

    // The hand that plays comes between the eye and the button, with its trigger open, and pulls.
    let eye = room.packet.head.position;
    room.hand(Hand::Right).pose = Pose::from_position(eye.lerp(at, 0.6));
    room.send();
    look_ahead(room);
    assert_eq!(room.game.steps(), steps, "time stands still");
    // At the panel's edge, so that the look alone chooses nothing.
    room.packet.head = looking(eye, at + DVec3::Y * 0.1);
    room.send();
    room.wait_until("a look at the wrist", |room| {
        let head = room.input.head.map(|head| head.pose.rotation);
        head.is_some_and(|head| head.angle_between(room.packet.head.rotation) < 3e-3)
    });
    room.hand(Hand::Right).trigger = 1.0;
    room.send();
    room.wait_until("the end of the pause", |room| {
        room.count("resumed") > resumed
    });
    *room.hand(Hand::Right) = Packet::default().right;
    look_ahead(room);
    room.wait_until("time goes on", |room| room.game.steps() > steps);

    look_at_button(room, TO_THE_START);
    room.wait_until("the start", |room| room.count("went_to_start") == 1);
    let (head, start) = (room.game.head_pose_world(), &room.game.config().start);
    let head = head.expect("it is tracked").position;
    let off = DVec3::new(head.x - start.x_m, 0.0, head.z - start.z_m).length();
    assert!(off < 0.01, "{head} is not the start");

    // With a ball in the hand nothing hangs at the wrist that a long look could choose.
    look_ahead(room);
    room.take_ball(Hand::Right);
    look_at_button(room, PAUSE);
    let steps = room.game.steps();
    room.wait_until("three seconds", |room| room.game.steps() > steps + 3 * 720);
    assert_eq!(room.count("paused"), paused + 1, "the ball is looked at");
    played.end();
}

/// Pixels of the window that show the fence: between green and blue, and bright.
fn fence_pixels(picture: &RgbImage) -> usize {
    let is_fence = |[red, green, blue]: [u8; 3]| green > 150 && blue > 180 && red < green - 60;
    picture.pixels().filter(|pixel| is_fence(pixel.0)).count()
}

/// The runtime of these tests tells no bounds, as the test below has it: those of the settings stand for them.
#[test]
fn the_fence_is_seen_when_somebody_comes_near_the_edge() {
    let Some(runtime) = runtime() else { return };
    let service = Service::start(&runtime, Compositor::Xvfb { hz: 45 });
    let out = tempfile::tempdir().expect("a temporary folder");
    let folder = out.path().join("session");
    let screen = service.screen();
    let display = [("DISPLAY", OsStr::new(screen.display()))];
    let space = ["comfort.space_m=[1.6, 1.6]"];
    let mut client = start_with(&service, &folder, "test", &display, &space);
    let mut room = Room::enter(&service, &mut client, &folder);
    let window = screen.act(&["search", "--sync", "--name", "what the participant sees"]);
    let seen = |room: &mut Room, what: &str, holds: &dyn Fn(&RgbImage) -> bool| {
        let found = ask_until(PATIENCE, || {
            // The compositor's own window, which is black, may lie over it.
            screen.act(&["windowraise", &window]);
            room.follow(std::time::Duration::from_millis(50));
            let picture = screen.shot();
            holds(&picture).then_some(())
        });
        let picture = screen.shot();
        let fence = fence_pixels(&picture);
        assert!(found.is_some(), "{what}: {fence} pixels of the fence");
    };
    let is_room = |picture: &RgbImage| crate::shared::screen::colours(picture) > 12;
    seen(&mut room, "in the middle", &|picture| {
        is_room(picture) && fence_pixels(picture) == 0
    });
    // To the edge at the right, and facing it.
    room.packet.head = looking(DVec3::new(0.7, 1.6, 0.0), DVec3::new(2.0, 1.4, 0.0));
    room.send();
    seen(&mut room, "at the edge", &|picture| {
        fence_pixels(picture) > 500
    });
    room.packet.head = Pose::from_position(DVec3::Y * 1.6);
    room.send();
    seen(&mut room, "in the middle again", &|picture| {
        is_room(picture) && fence_pixels(picture) == 0
    });
    let (status, said) = client.finish();
    assert!(status.success(), "{said}");
}

/// What a runtime says that knows of no bounds: nothing, and the program goes by its settings.
#[test]
fn this_runtime_tells_no_bounds() {
    if !is_inside() {
        let Some(runtime) = runtime() else { return };
        let service = Service::start(&runtime, Compositor::Null);
        run_inside(&service, "wrist::this_runtime_tells_no_bounds");
        return;
    }
    let mut headset = HeadsetSession::open(found(), HeadsetSettings::default()).expect("a headset");
    let told = first_frame(&mut headset, |headset, frame| {
        let bounds = headset.bounds(&frame).expect("no loss");
        headset.skip(frame).expect("the service runs");
        Some(bounds)
    });
    assert_eq!(told, None);
}
