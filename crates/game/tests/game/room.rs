//! What a participant can do in the room besides throwing.

use crate::support::{Player, conditions};
use game::{Button, EventKind, Game, GameError, Input, Model, Phase, TrackedPart};
use glam::{DQuat, DVec3};

/// Presses a button of the room with the hand and comes up again.
fn press(player: &mut Player, button: Button) {
    let top = player.game.observe().buttons[button as usize].top;
    player.reach(top + DVec3::Y * 0.15);
    player.reach(top + DVec3::Y * 0.02);
    player.reach(top + DVec3::Y * 0.15);
}

#[test]
fn the_hand_presses_the_buttons_once_each() {
    let mut player = Player::new(conditions(&[]), 2);
    player.walk_to(-0.6, 2.3);
    press(&mut player, Button::Red);
    assert_eq!(
        player.count(|kind| matches!(
            kind,
            EventKind::Pressed {
                button: Button::Red
            }
        )),
        1
    );
    assert_eq!(player.game.playing(), Some(Button::Red));
    assert_eq!(player.game.config().objects.friction_rate, 0.7);

    // While a game is played, a press asks; the second press of the same button starts.
    press(&mut player, Button::Blue);
    assert_eq!(
        player.count(|kind| matches!(
            kind,
            EventKind::ConfirmAsked {
                button: Button::Blue
            }
        )),
        1
    );
    assert_eq!(
        (player.game.playing(), player.game.confirming()),
        (Some(Button::Red), Some(Button::Blue))
    );
    press(&mut player, Button::Blue);
    assert_eq!(player.game.playing(), Some(Button::Blue));
    assert_eq!(player.game.config().objects.friction_rate, 0.0);
    assert_eq!(
        player.count(|kind| matches!(kind, EventKind::GameStarted { .. })),
        2
    );
}

#[test]
fn a_button_goes_down_with_the_hand_and_up_without_it() {
    let mut player = Player::new(conditions(&[]), 1);
    player.walk_to(-0.6, 2.3);
    let height = |player: &Player| {
        let red = player
            .game
            .visible()
            .into_iter()
            .find(|seen| seen.model == Model::RedButton)
            .unwrap();
        (red.pose.position.y, red.is_highlighted)
    };
    let (up, _) = height(&player);
    let top = player.game.observe().buttons[0].top;
    player.reach(top + DVec3::Y * 0.1);
    player.reach(top + DVec3::Y * 0.02);
    player.frame();
    let (down, is_lit) = height(&player);
    assert!((up - down - 0.025).abs() < 1e-9, "{up} {down}");
    assert!(is_lit);
    // It stays pressed and counts once, however long the hand rests on it.
    player.wait(1.0);
    assert_eq!(
        player.count(|kind| matches!(kind, EventKind::Pressed { .. })),
        1
    );
    player.reach(top + DVec3::Y * 0.2);
    assert_eq!(height(&player), (up, false));
}

#[test]
fn a_confirmation_expires() {
    let mut player = Player::new(conditions(&[]), 1);
    player.key(Button::Red);
    player.key(Button::Blue);
    assert_eq!(player.game.confirming(), Some(Button::Blue));
    player.wait(5.2);
    assert_eq!(player.game.confirming(), None);
    player.key(Button::Blue);
    assert_eq!(player.game.playing(), Some(Button::Red));
    // A press of the other button is no confirmation either.
    player.key(Button::Red);
    assert_eq!(
        (player.game.playing(), player.game.confirming()),
        (Some(Button::Red), Some(Button::Red))
    );
    player.key(Button::Red);
    assert_eq!(
        player.count(|kind| matches!(
            kind,
            EventKind::GameStarted {
                button: Button::Red
            }
        )),
        2
    );
}

#[test]
fn a_locked_button_is_refused_by_hand_and_by_key_and_the_other_is_not() {
    let mut player = Player::new(conditions(&[]), 1);
    player.input.locked = [true, false];
    let top = player.game.observe().buttons[0].top;
    player.reach(top + DVec3::Y * 0.1);
    player.reach(top + DVec3::Y * 0.02);
    player.reach(top + DVec3::Y * 0.2);
    player.key(Button::Red);
    let refused = |player: &Player| {
        player.count(|kind| {
            let button = Button::Red;
            *kind == EventKind::Refused { button }
        })
    };
    assert_eq!((refused(&player), player.game.playing()), (2, None));
    player.key(Button::Blue);
    assert_eq!(player.game.playing(), Some(Button::Blue));
    // During a game too: no second press is asked for.
    player.key(Button::Red);
    player.key(Button::Red);
    assert_eq!(refused(&player), 4);
    assert_eq!(player.game.playing(), Some(Button::Blue));
    assert_eq!(player.game.confirming(), None);
}

#[test]
fn a_key_that_is_kept_down_presses_once() {
    let mut player = Player::new(conditions(&[]), 1);
    player.input.press_blue = true;
    player.wait(0.5);
    assert_eq!(
        player.count(|kind| matches!(kind, EventKind::Pressed { .. })),
        1
    );
    assert_eq!(player.game.playing(), Some(Button::Blue));
}

#[test]
fn walking_follows_the_heading_and_starts_smoothly() {
    let mut player = Player::new(conditions(&[]), 1);
    player.frame();
    let start = player.game.world_from_tracking().position;
    player.head.rotation = DQuat::from_rotation_y(-0.5) * DQuat::from_rotation_x(-0.6);
    player.input.walk_forward = true;
    player.frame();
    let first = player.game.world_from_tracking().position.distance(start);
    assert!(first > 0.0 && first < 1.2 / 90.0 / 5.0, "{first}");
    player.wait(1.0);
    let way = player.game.world_from_tracking().position - start;
    // A second and a frame at 1.2 m/s, less half of the 0.3 s that the start takes.
    assert!(
        (way.length() - 1.2 * (1.0 + 1.0 / 90.0 - 0.15)).abs() < 0.01,
        "{way}"
    );
    assert!(way.angle_between(DQuat::from_rotation_y(-0.5) * DVec3::NEG_Z) < 1e-6);
    player.input.walk_forward = false;
    player.input.walk_back = true;
    player.wait(3.0);
    let back = player.game.world_from_tracking().position - start;
    assert!(back.dot(way) < 0.0);
}

#[test]
fn walls_stop_a_walk_and_the_lane_does_not() {
    let mut player = Player::new(conditions(&[]), 1);
    player.head.rotation = DQuat::from_rotation_y(std::f64::consts::FRAC_PI_2);
    player.input.walk_forward = true;
    player.wait(5.0);
    let head = player.game.head_pose_world().unwrap().position;
    assert!((head.x + 4.1).abs() < 1e-9, "{head}");
    player.head.rotation = DQuat::IDENTITY;
    player.wait(25.0);
    let head = player.game.head_pose_world().unwrap().position;
    // Past the foul line, along the lane, up to the cushion.
    assert!((head.z + 19.556363).abs() < 1e-6, "{head}");
}

#[test]
fn the_desk_stops_a_walk() {
    let mut player = Player::new(conditions(&[]), 1);
    player.walk_to(-1.1, 3.0);
    player.head.rotation = DQuat::IDENTITY;
    player.input.walk_forward = true;
    player.wait(2.0);
    let head = player.game.head_pose_world().unwrap().position;
    // The desk's near side at 1.9 + 0.4 / 2, and the margin of 0.12 before it.
    assert!((head.z - 2.22).abs() < 1e-9, "{head}");
}

#[test]
fn a_hand_fells_a_pin_and_the_machine_puts_it_back() {
    let mut player = Player::new(conditions(&[]), 1);
    player.key(Button::Red);
    player.walk_to(0.0, -17.6);
    let pin = player.game.observe().pins[0].position;
    player.reach(pin + DVec3::new(0.0, 0.15, 0.3));
    player.reach(pin + DVec3::new(0.0, 0.15, -0.1));
    player.reach(pin + DVec3::new(0.0, 0.6, 0.4));
    assert_eq!(
        player.count(|kind| matches!(
            kind,
            EventKind::Touched {
                model: Model::Pin(1)
            }
        )),
        1
    );
    assert!(!player.game.standing().contains(&1));
    player.wait_for_deck();
    assert_eq!(player.game.standing().len(), 10);
    for pin in player.game.observe().pins {
        assert!(pin.lean < 1e-3);
    }
    assert!(player.game.score_sheet(Button::Red).rolls().is_empty());
    assert_eq!(player.game.phase(), Phase::Ready);
}

#[test]
fn a_pin_can_be_taken_and_let_go() {
    let mut player = Player::new(conditions(&[]), 1);
    player.walk_to(0.0, -17.6);
    let pin = player.game.observe().pins[0].position;
    player.reach(pin + DVec3::new(0.0, 0.4, 0.1));
    player.reach(pin + DVec3::new(0.0, 0.3, 0.0));
    player.trigger(1.0);
    assert_eq!(player.game.held(), Some(Model::Pin(1)));
    player.reach(pin + DVec3::new(0.0, 1.0, 0.3));
    let carried = player.game.observe().pins[0].position;
    assert!(
        (carried - (pin + DVec3::new(0.0, 0.7, 0.3))).length() < 1e-6,
        "{carried}"
    );
    player.trigger(0.0);
    player.wait(1.0);
    assert!(player.game.observe().pins[0].position.y < 0.3);
    player.wait_until("the pin on its spot", |game| game.standing().len() == 10);
}

#[test]
fn a_dropped_ball_goes_back_to_the_rack() {
    let mut player = Player::new(conditions(&[]), 1);
    player.take_ball();
    player.walk_to(0.0, 2.5);
    player.trigger(0.0);
    player.wait(2.0);
    let ball = player.game.observe().balls[0];
    assert!(
        ball.is_free && !ball.is_on_rack && ball.position.y < 0.3,
        "{ball:?}"
    );
    player.wait(25.0);
    assert!(player.game.observe().balls[0].is_on_rack);
    assert_eq!(
        player.count(|kind| matches!(kind, EventKind::ThrowStarted { .. })),
        0
    );
}

#[test]
fn a_held_ball_is_not_pressed_through_the_floor() {
    let mut player = Player::new(conditions(&[]), 1);
    player.take_ball();
    player.walk_to(0.0, 2.5);
    let hand = player.hand.unwrap().position;
    player.reach(DVec3::new(hand.x, 0.0, hand.z));
    let ball = player.game.observe().balls[0];
    assert!((ball.position.y - ball.radius).abs() < 1e-6, "{ball:?}");
    player.trigger(0.0);
    player.wait(2.0);
    let ball = player.game.observe().balls[0];
    assert!(
        ball.position.y > 0.9 * ball.radius && ball.position.y < 3.0 * ball.radius,
        "{ball:?}"
    );
}

#[test]
fn a_lost_hand_is_hidden_and_keeps_its_grip() {
    let mut player = Player::new(conditions(&[]), 1);
    player.take_ball();
    let held = player.game.observe().balls[0].position;
    let hand = player.hand.take();
    player.input.trigger = 0.0;
    player.wait(0.28);
    assert_eq!(player.game.held(), Some(Model::Ball(0)));
    assert!(player.game.observe().balls[0].position.distance(held) < 1e-9);
    assert!(
        player
            .game
            .visible()
            .iter()
            .all(|seen| seen.model != Model::Hand)
    );
    let lost = |kind: &EventKind| {
        matches!(
            kind,
            EventKind::Tracking {
                part: TrackedPart::Hand,
                found: false
            }
        )
    };
    assert_eq!(player.count(lost), 1);
    // It comes back elsewhere: the ball is with it at once, without a push on the way.
    player.input.trigger = 1.0;
    let moved = DVec3::new(-0.3, 0.2, 0.1);
    player.hand = hand.map(|hand| physics::Pose::new(hand.position + moved, hand.rotation));
    player.frame();
    assert!(
        player.game.observe().balls[0]
            .position
            .distance(held + moved)
            < 1e-9
    );
    player.trigger(0.0);
    let speed = player.last(|kind| match kind {
        EventKind::Released(release) => Some(release.speed),
        _ => None,
    });
    assert!(speed.unwrap() < 1e-9, "{speed:?}");
}

#[test]
fn a_hand_that_stays_lost_drops_what_it_held() {
    let mut player = Player::new(conditions(&[]), 1);
    player.take_ball();
    let held = player.game.observe().balls[0].position;
    player.hand = None;
    player.wait(0.32);
    assert_eq!(player.game.held(), None);
    let dropped = |kind: &EventKind| matches!(kind, EventKind::Dropped { .. });
    assert_eq!(player.count(dropped), 1);
    player.wait(0.2);
    let fallen = held.y - player.game.observe().balls[0].position.y;
    assert!(fallen > 0.1, "it fell by {fallen} m");
}

#[test]
fn poses_without_usable_numbers_count_as_not_tracked() {
    let mut player = Player::new(conditions(&[]), 1);
    player.frame();
    player.hand = Some(physics::Pose::from_position(DVec3::NAN));
    player.head.position.y = f64::INFINITY;
    player.frame();
    assert!(player.game.head_pose_world().is_none() && player.game.hand_pose_world().is_none());
    player.wait(0.5);
    assert!(
        player
            .game
            .visible()
            .iter()
            .all(|seen| seen.pose.is_finite())
    );
}

#[test]
fn sessions_that_cannot_be_are_refused() {
    let refuse = |conditions, frames| Game::new(conditions, frames).err().unwrap();
    assert_eq!(refuse(conditions(&[]), 0), GameError::Frames(0));
    assert_eq!(refuse(conditions(&[]), 11), GameError::Frames(11));
    let mut differing = conditions(&[]);
    differing.blue.physics.step_hz = 1440.0;
    assert_eq!(
        refuse(differing, 10),
        GameError::DifferingCondition("physics.step_hz")
    );
}

#[test]
fn a_frame_without_steps_changes_nothing_but_time_stands() {
    let mut player = Player::new(conditions(&[]), 1);
    player.wait(0.2);
    let (hash, steps) = (player.game.hash(), player.game.steps());
    player.game.step(&Input {
        steps: 0,
        ..player.input
    });
    assert_eq!((player.game.hash(), player.game.steps()), (hash, steps));
}
