//! What helps a newcomer, and that none of it reaches the game: measures of the body, glow, practice.

use game::{Button, EventKind, Game, Model, Phase};
use glam::{DQuat, DVec3};

use crate::support::{Player, Swing, conditions};

/// Stretches the arm and closes the trigger on nothing.
fn gesture(player: &mut Player, eyes: f64, reach: f64) {
    player.head.position.y = eyes;
    let head = player.game.world_from_tracking() * player.head;
    let hand = player.hand.as_mut().unwrap();
    hand.position = head.position + DVec3::new(0.1, -0.2, -reach);
    player.wait(0.2);
    player.input.trigger = 1.0;
    player.wait(1.6);
    player.input.trigger = 0.0;
    player.wait(0.1);
}

fn measured(kind: &EventKind) -> Option<[f64; 5]> {
    match *kind {
        EventKind::Calibrated {
            eye_height_m,
            reach_m,
            is_seated,
            tray_height_m,
            desk_height_m,
        } => Some([
            eye_height_m,
            reach_m,
            f64::from(u8::from(is_seated)),
            tray_height_m,
            desk_height_m,
        ]),
        _ => None,
    }
}

#[test]
fn one_gesture_measures_somebody_who_sits_and_lifts_them() {
    let mut player = Player::new(conditions(&[]), 1);
    gesture(&mut player, 1.18, 0.7);
    let [eyes, reach, is_seated, tray, desk] = player.last(measured).expect("measured");
    assert_eq!((eyes, is_seated), (1.18, 1.0));
    assert!((reach - 0.7_f64.hypot(0.1)).abs() < 1e-9, "{reach}");
    let head = player.game.head_pose_world().unwrap().position;
    assert!((head.y - 1.62).abs() < 1e-9, "lifted: {head}");
    assert_eq!((tray, desk), (0.7, 0.85), "made for these eyes");
    // They play like anybody else, in both games.
    player.hand.as_mut().unwrap().position.y += 0.44;
    player.key(Button::Blue);
    player.throw(Swing::straight());
    assert_eq!(player.game.score_sheet(Button::Blue).rolls().len(), 1);
    let mut again = Game::new(conditions(&[]), 1).unwrap();
    player.inputs.iter().for_each(|input| again.step(input));
    assert_eq!(again.hash(), player.game.hash());
}

#[test]
fn one_gesture_brings_rack_and_desk_within_reach() {
    let mut player = Player::new(conditions(&[]), 1);
    gesture(&mut player, 1.86, 0.5);
    let [_, _, is_seated, tray, desk] = player.last(measured).expect("measured");
    assert_eq!(is_seated, 0.0);
    assert!(tray > 0.8 && desk > 1.0, "{tray} {desk}");
    for button in [None, Some(Button::Red)] {
        if let Some(button) = button {
            player.key(button);
        }
        let seen = player.game.observe();
        let ball = seen.balls[0];
        assert!((ball.position.y - ball.radius - tray).abs() < 0.002);
        assert!((seen.buttons[0].top.y - desk - 0.04).abs() < 1e-9);
    }
    let head = player.game.head_pose_world().unwrap().position;
    assert!((head.y - 1.86).abs() < 1e-9, "nobody is lifted who stands");
}

/// Somebody who crouches to reach a ball on the rack, and misses it, is not lifted for the rest of the session.
#[test]
fn who_bends_down_with_a_closed_hand_is_not_measured() {
    let mut player = Player::new(conditions(&[]), 1);
    player.head.rotation = DQuat::from_rotation_x(-0.7);
    gesture(&mut player, 1.2, 0.6);
    assert!(player.last(measured).is_none(), "bent over something");
    player.head.rotation = DQuat::from_rotation_x(-0.4);
    gesture(&mut player, 1.2, 0.6);
    assert!(player.last(measured).is_some(), "looking ahead");
}

/// Measured twice is measured once; and an alley that is laid out anew, for a pair of throws, keeps what was placed.
#[test]
fn what_was_placed_stays_through_another_gesture_and_another_room() {
    let mut player = Player::new(conditions(&[]), 1);
    gesture(&mut player, 1.86, 0.6);
    let first = player.last(measured).expect("measured");
    player.wait(0.5);
    gesture(&mut player, 1.86, 0.6);
    assert_eq!(player.count(|kind| measured(kind).is_some()), 2);
    let again = player.last(measured).expect("measured");
    assert_eq!(again[3..], first[3..], "tray and desk");
    let config = conditions(&["objects.elasticity=0.5"]).lobby;
    player.game.lay_out(&config).expect("the same room");
    let ball = player.game.observe().balls[0];
    let tray = ball.position.y - ball.radius;
    assert!((tray - first[3]).abs() < 0.002, "{tray}");
    assert_eq!(player.game.config().objects.elasticity, 0.5);
}

#[test]
fn no_gesture_is_seen_with_a_ball_after_a_throw_in_motion_or_where_it_is_off() {
    let mut player = Player::new(conditions(&["calibration.gesture=false"]), 1);
    gesture(&mut player, 1.62, 0.6);
    assert!(player.last(measured).is_none(), "off");

    let mut player = Player::new(conditions(&[]), 1);
    player.input.trigger = 1.0;
    let from = player.game.world_from_tracking().position + DVec3::new(0.1, 1.4, -0.4);
    player.hand.as_mut().unwrap().position = from;
    player.move_hand(from + DVec3::new(0.0, 0.0, -0.6), 0.3);
    assert!(player.last(measured).is_none(), "in motion");
    player.input.trigger = 0.0;

    let mut player = Player::new(conditions(&[]), 1);
    player.take_ball();
    let head = player.game.head_pose_world().unwrap().position;
    player.reach(head + DVec3::new(0.1, -0.2, -0.6));
    player.wait(3.0);
    assert!(player.last(measured).is_none(), "with a ball");
    player.swing(0.0, 0.7, Swing::straight());
    player.wait_for_deck();
    gesture(&mut player, 1.62, 0.6);
    assert!(player.last(measured).is_none(), "after a throw");
}

#[test]
fn guidance_leaves_the_game_as_it_is() {
    let played = |is_on: bool| {
        let settings = ["glow", "hints", "feedback"].map(|key| format!("guidance.{key}={is_on}"));
        let settings: Vec<&str> = settings.iter().map(String::as_str).collect();
        let mut player = Player::new(conditions(&settings), 1);
        player.key(Button::Red);
        player.take_ball();
        let glowing = |game: &Game| {
            let mut seen = game.visible().into_iter();
            seen.any(|it| matches!(it.model, Model::Ball(_)) && it.is_highlighted)
        };
        let glows = glowing(&player.game);
        player.swing(0.0, 0.7, Swing::straight());
        player.wait_for_deck();
        (glows, player.game.hash(), player.events)
    };
    let (on, off) = (played(true), played(false));
    assert_eq!((on.0, off.0), (true, false));
    assert_eq!((on.1, on.2), (off.1, off.2));
}

#[test]
fn a_throw_is_told_as_it_was_let_go() {
    let mut player = Player::new(conditions(&[]), 1);
    assert_eq!(player.game.last_throw(), None);
    player.key(Button::Red);
    let swing = Swing {
        yaw: 0.02,
        ..Swing::straight()
    };
    player.throw(swing);
    let seen = player.game.last_throw().expect("thrown");
    assert!((seen.speed - 6.8).abs() < 0.35, "{seen:?}");
    assert!((seen.angle + 0.02).abs() < 0.01, "to the left: {seen:?}");
    assert!(
        (seen.turns - 6.8 / 0.87 / std::f64::consts::TAU).abs() < 0.1,
        "{seen:?}"
    );
    assert!(!seen.is_foul && player.game.throws_over() == 1);
}

#[test]
fn practice_sets_the_same_leave_again_and_again() {
    let mut player = Player::new(conditions(&["practice.leave=[7,10]"]), 1);
    for throw in 1..=2 {
        assert_eq!(player.game.standing(), [7, 10], "before throw {throw}");
        let shown = player.game.visible().into_iter();
        let pins = shown.filter(|seen| matches!(seen.model, Model::Pin(_)));
        assert_eq!(pins.count(), 2);
        player.throw(Swing::straight());
        assert_eq!(player.game.phase(), Phase::Lobby);
        let settled = player.last(|kind| match kind {
            EventKind::Settled {
                fallen, standing, ..
            } => Some(fallen.len() + standing.len()),
            _ => None,
        });
        assert_eq!(settled, Some(2), "two pins were thrown at");
    }
}

#[test]
fn leaves_that_are_none_are_refused() {
    for leave in ["[0]", "[11]", "[7,7]", "[1.5]", "7"] {
        let arguments = [format!("practice.leave={leave}")];
        let error = game::Conditions::load(&crate::support::folder(), "alley", &arguments)
            .unwrap_err()
            .to_string();
        assert!(error.contains("practice.leave"), "{leave}: {error}");
    }
}
