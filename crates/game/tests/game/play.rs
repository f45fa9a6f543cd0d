//! Whole throws through inputs alone, in the real room with the real physics.

use crate::support::{Player, Swing, conditions};
use game::{Button, EndReason, EventKind, Game, Model, Phase, ReleaseSource, Roll};
use glam::DVec3;

/// What the last throw felled, and why it ended.
fn settled(player: &Player) -> (Vec<u8>, Vec<u8>, EndReason) {
    let pick = |kind: &EventKind| match kind {
        EventKind::Settled {
            fallen,
            standing,
            reason,
        } => Some((fallen.clone(), standing.clone(), *reason)),
        _ => None,
    };
    player.last(pick).expect("a throw has ended")
}

/// The rolls on the sheet of a button.
fn rolls(player: &Player, button: Button) -> Vec<Roll> {
    player.game.score_sheet(button).rolls().to_vec()
}

#[test]
fn a_ball_is_taken_swung_and_scored_and_the_next_finishes_the_frame() {
    let mut player = Player::new(conditions(&[]), 1);
    player.key(Button::Red);
    player.throw(Swing::straight());

    let release = player.last(|kind| match kind {
        EventKind::Released(release) => Some(*release),
        _ => None,
    });
    let release = release.unwrap();
    assert_eq!(
        (release.model, release.source),
        (Model::Ball(0), ReleaseSource::Velocity)
    );
    assert!((release.speed - 6.8).abs() < 0.1, "{}", release.speed);
    let fitted = release.from_poses.unwrap();
    assert!(
        (fitted.linear - release.used.linear).length() < 0.02 * release.speed,
        "{fitted:?}"
    );
    assert_eq!(
        player.last(|kind| match kind {
            EventKind::FirstHit { pin, .. } => Some(*pin),
            _ => None,
        }),
        Some(1)
    );
    let (fallen, standing, reason) = settled(&player);
    assert_eq!(fallen.len() + standing.len(), 10);
    assert!(fallen.contains(&1) && fallen.len() >= 3, "{fallen:?}");
    assert_eq!(reason, EndReason::Still);
    assert_eq!(
        rolls(&player, Button::Red),
        [Roll::fair(fallen.len() as u8)]
    );
    assert_eq!(player.game.standing(), standing);

    // Another ball, straight again: the frame of a one-frame game ends with two balls, or three after a spare.
    while player.game.playing().is_some() {
        player.throw(Swing {
            yaw: 0.01,
            ..Swing::straight()
        });
    }
    let total = player.game.score_sheet(Button::Red).total();
    assert_eq!(
        player.last(|kind| match kind {
            EventKind::GameOver { button, total } => Some((*button, *total)),
            _ => None,
        }),
        Some((Button::Red, total))
    );
    assert_eq!(player.game.phase(), Phase::Lobby);
    // A full rack on its spots waits for practice.
    assert_eq!(player.game.standing().len(), 10);
}

#[test]
fn standing_pins_are_respotted_where_they_stand() {
    let mut player = Player::new(conditions(&[]), 1);
    player.key(Button::Red);
    player.take_ball();
    // Off the head pin, so that some pins stay.
    player.swing(
        0.0,
        0.7,
        Swing {
            yaw: 0.015,
            ..Swing::straight()
        },
    );
    player.wait_until("the end of the throw", |game| {
        game.phase() == Phase::Setting
    });
    let stand = |player: &Player| -> Vec<(u8, DVec3, f64)> {
        let pins = player
            .game
            .observe()
            .pins
            .into_iter()
            .filter(|pin| pin.is_standing);
        pins.map(|pin| (pin.number, pin.position, pin.lean))
            .collect()
    };
    let before = stand(&player);
    assert!((1..10).contains(&before.len()), "{before:?}");
    player.wait_for_deck();
    let after = stand(&player);
    assert_eq!(before.len(), after.len());
    for ((number, was, lean), (same, is, upright)) in before.iter().zip(&after) {
        assert_eq!(number, same);
        // Straightened over its base: a lean moves the centre of gravity by its height times the angle.
        let shift = DVec3::new(was.x - is.x, 0.0, was.z - is.z).length();
        assert!(
            shift < 0.001 + 0.15 * lean,
            "pin {number} was moved by {shift} m"
        );
        assert!(*upright < 1e-3, "pin {number} leans {upright}");
    }
    // And it is a real rack: it stands untouched.
    player.wait(5.0);
    assert_eq!(player.game.standing().len(), after.len());
    assert!(player.is_ready());
}

#[test]
fn poses_alone_give_the_same_throw() {
    let throw = |with_velocity| {
        let mut player = Player::new(conditions(&[]), 1);
        player.key(Button::Red);
        player.take_ball();
        player.swing(
            0.0,
            0.7,
            Swing {
                with_velocity,
                yaw: 0.02,
                ..Swing::straight()
            },
        );
        player.last(|kind| match kind {
            EventKind::Released(release) => Some(*release),
            _ => None,
        })
    };
    let (measured, fitted) = (throw(true).unwrap(), throw(false).unwrap());
    assert_eq!(
        (measured.source, fitted.source),
        (ReleaseSource::Velocity, ReleaseSource::Poses)
    );
    assert_eq!(fitted.from_velocity, None);
    assert!(
        (fitted.speed / measured.speed - 1.0).abs() < 0.02,
        "{} {}",
        fitted.speed,
        measured.speed
    );
    let angle = fitted
        .used
        .linear
        .angle_between(measured.used.linear)
        .to_degrees();
    assert!(angle < 1.0, "{angle} degrees");
}

#[test]
fn a_gutter_ball_fells_nothing_and_comes_back() {
    let mut player = Player::new(conditions(&[]), 1);
    player.key(Button::Red);
    player.throw(Swing {
        yaw: 0.12,
        ..Swing::straight()
    });
    assert!(settled(&player).0.is_empty());
    assert_eq!(rolls(&player, Button::Red), [Roll::fair(0)]);
    assert_eq!(player.game.standing().len(), 10);
    player.wait_until("the ball on the rack", |game| {
        game.observe().balls.iter().all(|ball| ball.is_on_rack)
    });
    assert_eq!(
        player.count(|kind| matches!(kind, EventKind::BallReturned { ball: 0 })),
        1
    );
}

#[test]
fn a_foul_counts_nothing_and_sets_a_full_rack() {
    let mut player = Player::new(conditions(&[]), 1);
    player.key(Button::Red);
    player.take_ball();
    player.swing(0.0, -0.4, Swing::straight());
    player.wait_for_deck();
    assert_eq!(player.count(|kind| matches!(kind, EventKind::Foul)), 1);
    let (fallen, ..) = settled(&player);
    assert!(!fallen.is_empty());
    assert_eq!(
        rolls(&player, Button::Red),
        [Roll::foul(fallen.len() as u8)]
    );
    assert_eq!(player.game.score_sheet(Button::Red).total(), 0);
    assert_eq!(player.game.standing().len(), 10);
    assert_eq!(player.game.next_delivery().unwrap().ball, 2);
}

#[test]
fn a_ball_that_stops_on_the_lane_ends_the_throw() {
    let mut player = Player::new(conditions(&[]), 1);
    player.key(Button::Red);
    player.take_ball();
    // Set down gently beyond the line, with the feet behind it.
    player.walk_to(0.0, 0.3);
    player.reach(DVec3::new(0.0, 0.3, -0.3));
    player.wait(0.3);
    player.trigger(0.0);
    player.reach(DVec3::new(0.0, 0.9, -0.1));
    player.wait_for_deck();
    let (fallen, _, reason) = settled(&player);
    assert_eq!((fallen.len(), reason), (0, EndReason::Still));
    assert_eq!(rolls(&player, Button::Red), [Roll::fair(0)]);
    player.wait_until("the ball on the rack", |game| {
        game.observe().balls.iter().all(|ball| ball.is_on_rack)
    });
}

#[test]
fn a_world_that_never_rests_ends_the_throw_in_time_and_delivers_a_ball_once() {
    let restless = ["objects.elasticity=1.0", "objects.friction_rate=0.0"];
    let mut player = Player::new(conditions(&restless), 1);
    player.key(Button::Red);
    player.take_ball();
    player.swing(0.0, 0.7, Swing::straight());
    player.wait_for_deck();
    let (fallen, standing, reason) = settled(&player);
    assert_eq!(reason, EndReason::AfterHeadPin);
    assert_eq!(fallen.len() + standing.len(), 10);
    let started = player
        .events
        .iter()
        .find(|event| matches!(event.kind, EventKind::ThrowStarted { .. }))
        .unwrap();
    let ended = player
        .events
        .iter()
        .find(|event| matches!(event.kind, EventKind::Settled { .. }))
        .unwrap();
    let seconds = (ended.step - started.step) as f64 / 720.0;
    assert!((14.0..15.5).contains(&seconds), "{seconds} s");
    // The ball bounces back over the line and forth again; that is no second delivery.
    player.wait(20.0);
    assert_eq!(
        player.count(|kind| matches!(kind, EventKind::ThrowStarted { .. })),
        1
    );
    assert_eq!(rolls(&player, Button::Red).len(), 1);
    player.wait_until("the ball on the rack", |game| {
        game.observe().balls.iter().all(|ball| ball.is_on_rack)
    });
}

#[test]
fn practice_in_the_lobby_is_not_scored() {
    let mut player = Player::new(conditions(&[]), 1);
    player.throw(Swing::straight());
    assert_eq!(player.game.phase(), Phase::Lobby);
    assert!(!settled(&player).0.is_empty());
    assert!(
        Button::BOTH
            .iter()
            .all(|button| rolls(&player, *button).is_empty())
    );
    assert_eq!(player.game.standing().len(), 10);
}

#[test]
fn pins_in_the_pit_are_taken_away() {
    // Nothing may come to rest, so that the throw goes on long enough to look into the pit.
    let mut player = Player::new(conditions(&["rules.still_for_s=10.0"]), 1);
    player.key(Button::Red);
    player.take_ball();
    player.swing(0.0, 0.7, Swing::straight());
    let in_pit = |game: &Game| {
        let seen = game.visible().into_iter();
        let pins = seen.filter(|seen| matches!(seen.model, Model::Pin(_)));
        pins.filter(|pin| pin.pose.position.z < -19.3 && pin.pose.position.y < 0.0)
            .count()
    };
    player.wait_until("a pin in the pit", |game| in_pit(game) > 0);
    player.wait(6.0);
    assert_eq!(player.game.phase(), Phase::Rolling);
    assert_eq!(in_pit(&player.game), 0);
    assert!(player.game.standing().len() < 10);
}
