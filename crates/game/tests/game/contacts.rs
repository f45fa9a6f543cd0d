use game::{Button, Contact, EventKind, Model, Phase, RollingBall};

use crate::support::{Player, Swing, conditions};

/// Everything that could be heard of one throw, frame by frame.
fn heard(swing: Swing) -> (Player, Vec<Contact>, Vec<RollingBall>) {
    let mut player = Player::new(conditions(&[]), 1);
    player.key(Button::Red);
    player.take_ball();
    player.swing(0.0, 0.7, swing);
    let (mut contacts, mut rolling) = (Vec::new(), Vec::new());
    while player.game.phase() != Phase::Setting {
        let before = player.game.steps();
        player.frame();
        let game = &player.game;
        for contact in game.contacts() {
            assert!(contact.step > before && contact.step <= game.steps());
        }
        let reported: Vec<_> = game
            .events()
            .iter()
            .filter_map(|event| match event.kind {
                EventKind::Impact { a, b, impulse, .. } => Some((a, b, impulse)),
                _ => None,
            })
            .collect();
        let known = game.contacts().iter().map(|c| (c.a, c.b, c.impulse));
        assert_eq!(known.collect::<Vec<_>>(), reported);
        contacts.extend_from_slice(game.contacts());
        rolling.extend(game.rolling());
        assert!(game.time() < 120.0, "the throw does not end");
    }
    (player, contacts, rolling)
}

#[test]
fn a_straight_ball_rolls_on_the_lane_and_its_contacts_have_their_own_steps() {
    let (player, contacts, rolling) = heard(Swing::straight());
    let on_lane = |ball: &&RollingBall| ball.surface == Model::Lane;
    let lane: Vec<_> = rolling.iter().filter(on_lane).collect();
    // 18 m at some 6.5 m/s, 90 times a second.
    assert!((150..400).contains(&lane.len()), "{}", lane.len());
    for ball in lane.iter().filter(|ball| ball.point.z > -18.0) {
        assert!(ball.point.y.abs() < 0.005, "{ball:?}");
        assert!((4.0..8.0).contains(&ball.speed), "{ball:?}");
    }
    let pins = contacts
        .iter()
        .filter(|c| matches!((c.a, c.b), (Model::Pin(_), _) | (_, Model::Pin(_))));
    assert!(pins.count() > 5);
    // Eight steps a frame: contacts that all fell on a frame's last step would be told by their frame alone.
    assert!(contacts.iter().any(|contact| contact.step % 8 != 0));
    // In the end the ball lies in the pit, or still rolls there.
    let last = player.game.rolling();
    assert!(
        last.iter().all(|ball| ball.surface != Model::Lane),
        "{last:?}"
    );
}

#[test]
fn a_ball_in_the_gutter_rolls_on_the_gutter() {
    let (_, _, rolling) = heard(Swing {
        yaw: 0.12,
        ..Swing::straight()
    });
    let gutter = rolling.iter().filter(|ball| ball.surface == Model::Gutter);
    assert!(gutter.count() > 50);
}
