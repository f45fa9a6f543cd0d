//! A setting that helps throws: what it turns, what it says, and that the same inputs still give the same bits.

use game::{Assist, Button, EventKind, Game, Release};
use glam::DVec3;

use crate::support::{Player, Swing, conditions};

/// A ball that is thrown askew, under these settings.
fn thrown(settings: &[&str]) -> (Player, Release) {
    let mut player = Player::new(conditions(settings), 1);
    player.key(Button::Red);
    player.take_ball();
    let askew = Swing {
        yaw: 0.04,
        ..Swing::straight()
    };
    player.swing(0.0, 0.7, askew);
    let released = player.last(|kind| match kind {
        EventKind::Released(release) => Some(*release),
        _ => None,
    });
    (player, released.expect("the hand has opened"))
}

/// To the left of the lane's axis, seen from above [rad].
fn heading(release: &Release) -> f64 {
    let linear = release.used.linear;
    (-linear.x).atan2(-linear.z)
}

#[test]
fn a_throw_that_is_helped_loses_half_its_angle_says_so_and_stays_the_same_when_it_is_played_again()
{
    let (_, own) = thrown(&[]);
    assert_eq!(own.assist, None);
    let (player, helped) = thrown(&["release.assist_share=0.5"]);
    assert!((heading(&own) - 0.04).abs() < 0.005, "{}", heading(&own));
    let (half, turned) = (0.5 * heading(&own), heading(&helped));
    assert!((turned - half).abs() < 1e-9, "{turned} of {half}");
    let floor = |release: &Release| release.used.linear * DVec3::new(1.0, 0.0, 1.0);
    assert!((floor(&helped).length() - floor(&own).length()).abs() < 1e-9);
    assert_eq!(helped.used.linear.y, own.used.linear.y);
    // What was measured is kept beside what was used.
    assert_eq!(helped.from_velocity, own.from_velocity);
    let Assist { share, turned_rad } = helped.assist.expect("it was helped");
    assert_eq!(share, 0.5);
    // To the right, which is negative, as it headed to the left.
    assert!((turned_rad + half).abs() < 1e-9, "{turned_rad}");
    let mut again = Game::new(conditions(&["release.assist_share=0.5"]), 1).unwrap();
    for input in &player.inputs {
        again.step(input);
    }
    assert_eq!(again.hash(), player.game.hash());
}
