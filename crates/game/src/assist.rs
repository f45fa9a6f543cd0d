//! Help for whoever throws past the pins: off by default, because what is thrown is what is studied.

use std::f64::consts::PI;

use glam::{DQuat, DVec2, DVec3};

use crate::event::{Assist, ReleaseVelocity};

/// Farthest that help turns a throw [rad]: from the foul line the lane is 1.7 degrees wide to either side at the pins.
const FARTHEST: f64 = 5.0 * PI / 180.0;

/// Turns a release about the vertical towards the lane's axis by a share of its angle to it, seen from above; speed, rise and
/// spin about its own way stay. A share of 0 touches nothing.
pub(crate) fn help(thrown: ReleaseVelocity, share: f64) -> (ReleaseVelocity, Option<Assist>) {
    if share == 0.0 {
        return (thrown, None);
    }
    // Ahead is -z; what heads to the right of it is turned to the left.
    let heading = DVec2::new(-thrown.linear.z, thrown.linear.x);
    let angle = if heading == DVec2::ZERO {
        0.0
    } else {
        heading.to_angle()
    };
    let turned_rad = (share * angle).clamp(-FARTHEST, FARTHEST);
    let turn = DQuat::from_rotation_y(turned_rad);
    let turned = |vector: DVec3| turn * vector;
    let helped = ReleaseVelocity {
        linear: turned(thrown.linear),
        angular: turned(thrown.angular),
    };
    (helped, Some(Assist { share, turned_rad }))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn thrown(degrees_to_the_right: f64) -> ReleaseVelocity {
        let heading = DQuat::from_rotation_y(-degrees_to_the_right.to_radians());
        ReleaseVelocity {
            linear: heading * DVec3::new(0.0, 0.7, -6.0),
            angular: heading * DVec3::new(-20.0, 3.0, 0.0),
        }
    }

    /// Where a throw of so many degrees to the right goes, with a share of help.
    fn heads(degrees: f64, share: f64) -> f64 {
        let (helped, _) = help(thrown(degrees), share);
        let there = |to: f64| {
            let expected = thrown(to);
            helped.linear.abs_diff_eq(expected.linear, 1e-9)
                && helped.angular.abs_diff_eq(expected.angular, 1e-9)
        };
        // In hundredths of a degree, which is how the shares below come out even.
        let found = (-18_000..=18_000).map(|hundredths| f64::from(hundredths) / 100.0);
        found
            .into_iter()
            .find(|to| there(*to))
            .expect("a throw of the same speed and spin")
    }

    #[test]
    fn a_throw_loses_a_share_of_its_angle_and_nothing_else() {
        assert_eq!(heads(4.0, 0.5), 2.0);
        assert_eq!(heads(-4.0, 0.25), -3.0);
        assert_eq!(heads(3.0, 1.0), 0.0);
        assert_eq!(heads(0.0, 1.0), 0.0);
    }

    #[test]
    fn help_ends_at_five_degrees() {
        assert_eq!(heads(20.0, 1.0), 15.0);
        assert_eq!(heads(-170.0, 0.5), -165.0);
    }

    #[test]
    fn without_a_share_every_bit_stays() {
        let (helped, assist) = help(thrown(4.0), 0.0);
        assert_eq!((helped, assist), (thrown(4.0), None));
        let still = ReleaseVelocity {
            linear: DVec3::ZERO,
            angular: DVec3::ZERO,
        };
        assert_eq!(help(still, 0.5).0, still);
        let assist = help(thrown(4.0), 0.5).1.expect("it was helped");
        assert!((assist.turned_rad - 2.0_f64.to_radians()).abs() < 1e-12);
    }
}
