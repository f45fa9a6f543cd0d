//! A device that says when the trigger opened: the ball leaves the hand then, and not at the end of the frame.

use game::{EventKind, Model, Tracked, TriggerChange, Velocity};
use glam::{DQuat, DVec3};
use physics::Pose;

use crate::support::{Player, RATE, conditions};

/// Within the frame, at its beginning, and some frames before it: a runtime predicts poses that far ahead.
const AGES: [f64; 4] = [0.0, 0.004, 1.0 / 90.0, 0.035];

/// The ball is where free flight from the hand at that instant leads, with the velocity that this hand gave it.
#[test]
fn the_ball_flies_from_the_instant_at_which_the_trigger_opened() {
    for age_s in AGES {
        let mut player = Player::new(conditions(&[]), 1);
        player.take_ball();
        // Clear of rack and floor.
        let hand = player.hand.expect("it is tracked").position;
        player.move_hand(hand + DVec3::new(-0.5, 0.5, 0.0), 1.0);
        let now = player.hand.expect("it is tracked");
        let ball_in_hand = now
            .inverse()
            .transform_point(player.game.observe().balls[0].position);
        let tracking_from_world = player.game.world_from_tracking().inverse();
        // What the runtime knows of that instant differs from what it had predicted for now.
        let then = Pose {
            position: now.position + DVec3::new(0.01, -0.02, 0.03),
            rotation: DQuat::from_rotation_x(0.1) * now.rotation,
        };
        let velocity = Velocity {
            linear: DVec3::new(0.3, 1.5, -4.0),
            angular: DVec3::new(-3.0, 0.5, 0.2),
        };
        player.input.trigger = 0.0;
        player.input.trigger_change = Some(TriggerChange {
            age_s,
            hand: Tracked {
                pose: tracking_from_world * then,
                velocity: Some(velocity),
            },
        });
        player.frame();
        player.input.trigger_change = None;
        let arm = then.rotation * ball_in_hand;
        let start = velocity.linear + velocity.angular.cross(arm);
        let fall = DVec3::NEG_Y * 9.80665;
        for frame in 0..5 {
            let flown = age_s + f64::from(frame) / RATE;
            let expected = then.position + arm + (start + 0.5 * fall * flown) * flown;
            let ball = &player.game.observe().balls[0];
            let off = ball.position.distance(expected);
            assert!(off < 2e-6, "age {age_s} s, {flown} s flown: {off} m off");
            player.frame();
        }
    }
}

/// A picture of an instant within the last step shows a flying ball between its two poses.
#[test]
fn a_picture_within_a_step_shows_a_pose_between() {
    let mut player = Player::new(conditions(&[]), 1);
    player.take_ball();
    player.hand_velocity = Some(Velocity {
        linear: DVec3::new(0.0, 1.0, -5.0),
        angular: DVec3::ZERO,
    });
    player.trigger(0.0);
    player.hand_velocity = None;
    player.frame();
    let ball = |share| {
        let seen = player.game.visible_at(share);
        let ball = seen.iter().find(|seen| seen.model == Model::Ball(0));
        ball.expect("it is seen").pose.position
    };
    assert_eq!(ball(1.0), player.game.observe().balls[0].position);
    // A step of 1/720 s at 5 m/s.
    let way = ball(1.0) - ball(0.0);
    assert!((way.z + 5.0 / 720.0).abs() < 1e-6, "{way}");
    assert!(ball(0.25).distance(ball(0.0).lerp(ball(1.0), 0.25)) < 1e-12);
}

/// An age that no runtime reports is not believed: the ball then leaves at the end of the frame.
#[test]
fn an_impossible_age_counts_as_none() {
    let mut player = Player::new(conditions(&[]), 1);
    player.take_ball();
    let before = player.game.observe().balls[0].position;
    player.input.trigger = 0.0;
    player.input.trigger_change = Some(TriggerChange {
        age_s: 3.0,
        hand: Tracked::at(Pose::from_position(DVec3::new(9.0, 9.0, 9.0))),
    });
    player.frame();
    assert_eq!(player.game.held(), None);
    assert!(player.game.observe().balls[0].position.distance(before) < 0.02);
}

/// A release that was long ago, close to the pins: the ball has flown on meanwhile, and not through the pin that stood there.
#[test]
fn a_ball_strikes_what_was_on_its_way_since_the_release() {
    let mut player = Player::new(conditions(&[]), 1);
    player.take_ball();
    player.walk_to(0.0, -17.0);
    let pin = player.game.observe().pins[0].position;
    player.move_hand(pin + DVec3::new(0.0, 0.25, 0.5), 1.0);
    assert!(
        player.game.standing().contains(&1),
        "nothing has struck it yet"
    );
    let now = player.hand.expect("it is tracked");
    player.input.trigger = 0.0;
    player.input.trigger_change = Some(TriggerChange {
        age_s: 0.15,
        hand: Tracked {
            pose: player.game.world_from_tracking().inverse() * now,
            velocity: Some(Velocity {
                linear: DVec3::new(0.0, 0.0, -8.0),
                angular: DVec3::ZERO,
            }),
        },
    });
    player.frame();
    player.input.trigger_change = None;
    player.frame();
    let struck = player.count(|kind| match kind {
        EventKind::Impact { a, b, .. } => {
            [*a, *b].contains(&Model::Pin(1)) && [*a, *b].contains(&Model::Ball(0))
        }
        _ => false,
    });
    // A metre of free flight would have ended behind it.
    assert_eq!(struck, 1);
}
