//! A pause, and the way back to the start.

use game::{BallSeen, Button, EventKind, Game, Input, PinSeen};
use glam::{DQuat, DVec3};

use crate::support::{Player, Swing, conditions};

fn paused(kind: &EventKind) -> bool {
    matches!(kind, EventKind::Paused)
}

fn resumed(kind: &EventKind) -> bool {
    matches!(kind, EventKind::Resumed)
}

/// The alley without head and hand.
fn bodies(game: &Game) -> (Vec<BallSeen>, Vec<PinSeen>, u64) {
    let seen = game.observe();
    (seen.balls, seen.pins, game.steps())
}

#[test]
fn nothing_moves_in_a_pause_whatever_the_device_says() {
    let mut player = Player::new(conditions(&[]), 1);
    player.key(Button::Red);
    player.take_ball();
    player.swing(0.0, 0.7, Swing::straight());
    assert!(!player.game.observe().is_set, "a ball is on its way");
    let before = bodies(&player.game);
    let rig = player.game.world_from_tracking();
    player.input.paused = true;
    player.input.walk_forward = true;
    player.input.trigger = 1.0;
    player.wait(3.0);
    assert_eq!(bodies(&player.game), before);
    assert_eq!(player.game.world_from_tracking(), rig);
    assert!(player.game.is_paused() && player.game.hand_pose_world().is_none());
    assert_eq!(player.count(paused), 1, "marked once");
    player.key(Button::Blue);
    assert_eq!(
        player.count(|kind| matches!(kind, EventKind::Pressed { .. })),
        1
    );
    player.input.paused = false;
    player.input.walk_forward = false;
    player.input.trigger = 0.0;
    player.wait_for_deck();
    assert_eq!(player.count(resumed), 1);
    assert_eq!(player.game.score_sheet(Button::Red).rolls().len(), 1);

    let mut again = Game::new(conditions(&[]), 1).unwrap();
    player.inputs.iter().for_each(|input| again.step(input));
    assert_eq!(again.hash(), player.game.hash(), "a replay pauses too");
    // The same without the paused frames is the same game: a pause leaves nothing behind but its events.
    let mut without = Game::new(conditions(&[]), 1).unwrap();
    let played = player.inputs.iter().filter(|input| !input.paused);
    played.for_each(|input| without.step(input));
    assert_eq!(bodies(&without), bodies(&player.game));
}

#[test]
fn a_held_ball_is_still_held_after_a_pause() {
    let mut player = Player::new(conditions(&[]), 1);
    player.take_ball();
    let held = player.game.held();
    player.input.paused = true;
    player.wait(5.0);
    player.input.paused = false;
    player.wait(0.5);
    assert_eq!(player.game.held(), held);
    assert_eq!(
        player.count(|kind| matches!(kind, EventKind::Dropped { .. })),
        0
    );
}

#[test]
fn the_way_back_to_the_start_turns_the_head_down_the_lane() {
    let mut player = Player::new(conditions(&[]), 1);
    player.walk_to(-0.8, 3.0);
    let held_height = player.hand.unwrap().position.y;
    player.head.position = DVec3::new(0.4, 1.7, -0.6);
    player.head.rotation = DQuat::from_rotation_y(1.1) * DQuat::from_rotation_x(-0.3);
    player.input.recentre = true;
    player.frame();
    player.input.recentre = false;
    player.frame();
    let head = player.game.head_pose_world().unwrap();
    let start = &player.game.config().start;
    let expected = DVec3::new(start.x_m, 1.7, start.z_m);
    assert!(head.position.distance(expected) < 1e-9, "{}", head.position);
    let ahead = head.rotation * DVec3::NEG_Z;
    assert!(ahead.x.abs() < 1e-9 && ahead.z < 0.0, "{ahead}");
    assert_eq!(
        player.count(|kind| matches!(kind, EventKind::WentToStart)),
        1
    );
    assert!(held_height > 0.0);
    let mut again = Game::new(conditions(&[]), 1).unwrap();
    player.inputs.iter().for_each(|input| again.step(input));
    assert_eq!(again.hash(), player.game.hash());
}

/// The wish is heard in a pause too; without a head there is nothing to go by.
#[test]
fn the_start_can_be_reached_in_a_pause_and_not_without_a_head() {
    let mut player = Player::new(conditions(&[]), 1);
    player.head.position.x = 0.5;
    player.input.paused = true;
    player.input.recentre = true;
    player.frame();
    let head = player.game.head_pose_world().unwrap();
    assert!((head.position.x - player.game.config().start.x_m).abs() < 1e-9);
    let rig = player.game.world_from_tracking();
    player.game.step(&Input {
        recentre: true,
        ..Input::default()
    });
    assert_eq!(player.game.world_from_tracking(), rig);
}
