//! Tracking space is laid anew: what has not moved is elsewhere in it, and nothing comes of that.

use game::{Button, EventKind, Model};
use glam::DVec3;

use crate::support::{Player, conditions};

/// A jump that a fast hand could make in a frame at 90 Hz, so that its speed gives nothing away: 22.5 m/s.
const JUMP: f64 = 0.25;

/// The hand at one side of the head pin, and in the next frame at the other: how the pin stands half a second later.
fn pin_behind_a_jump(recentred: bool) -> (bool, usize) {
    let mut player = Player::new(conditions(&[]), 1);
    player.key(Button::Red);
    player.walk_to(0.0, -17.6);
    let pin = player.game.observe().pins[0].position + DVec3::Y * 0.15;
    player.reach(pin + DVec3::new(0.0, 0.0, 0.4));
    player.reach(pin + DVec3::new(JUMP / 2.0, 0.0, 0.4));
    player.reach(pin + DVec3::new(JUMP / 2.0, 0.0, 0.0));
    assert!(player.game.standing().contains(&1), "nothing has moved yet");
    player.input.recentred = recentred;
    player.move_hand(pin - DVec3::X * (JUMP / 2.0), JUMP * crate::support::RATE);
    player.input.recentred = false;
    player.wait(0.5);
    let struck = player.count(
        |kind| matches!(kind, EventKind::Impact { a, b, .. } if [a, b].contains(&&Model::Hand)),
    );
    (player.game.standing().contains(&1), struck)
}

#[test]
fn a_hand_that_is_elsewhere_in_a_new_space_strikes_nothing_on_the_way() {
    assert_eq!(pin_behind_a_jump(true), (true, 0));
    // The same way as a movement does fell it.
    let (stands, struck) = pin_behind_a_jump(false);
    assert!(!stands && struck > 0, "the jump must lead through the pin");
}

/// The jump is no motion: a ball that is let go with it, by a device without velocities, falls.
#[test]
fn a_held_ball_is_kept_and_a_jump_gives_it_no_speed() {
    let mut player = Player::new(conditions(&[]), 1);
    player.take_ball();
    let hand = player.hand.expect("it is tracked").position;
    player.move_hand(hand + DVec3::new(-0.5, 0.5, 0.0), 1.0);
    let rig = player.game.world_from_tracking();
    let (hand, ball) = (
        player.hand.expect("it is tracked").position,
        player.game.observe().balls[0].position,
    );
    let jump = DVec3::new(0.0, 0.0, -JUMP);
    player.input.recentred = true;
    player.head.position += jump;
    player.move_hand(hand + jump, JUMP * crate::support::RATE);
    player.input.recentred = false;
    assert_eq!(player.game.held(), Some(Model::Ball(0)));
    let moved = player.game.observe().balls[0].position - ball;
    assert!(moved.distance(jump) < 1e-6, "it stays in the hand: {moved}");
    assert_eq!(player.game.world_from_tracking(), rig, "nobody walks");
    player.trigger(0.0);
    let released = player.last(|kind| match kind {
        EventKind::Released(release) => Some(release.speed),
        _ => None,
    });
    let speed = released.expect("the hand has opened");
    assert!(speed < 1e-6, "{speed} m/s");
}
