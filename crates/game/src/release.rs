//! How fast a held body leaves the hand.
//!
//! Two estimates, one for devices that measure velocities and one for poses alone; the same code serves a scripted arm and
//! a real one. The commonest complaint about throwing in virtual reality is the release, in 1997 already (§5).

use std::collections::VecDeque;

use glam::{DMat3, DVec3};
use physics::Pose;

use crate::config::{ReleaseConfig, ReleaseFit};
use crate::event::ReleaseVelocity;
use crate::input::Velocity;

/// Below this angle [rad] the series of the logarithm's coefficient is exact to rounding.
const SMALL_ANGLE: f64 = 1e-4;

/// The hand's recent poses, world frame.
#[derive(Clone, Debug, Default)]
pub(crate) struct PoseHistory {
    samples: VecDeque<(f64, Pose)>,
}

impl PoseHistory {
    /// Adds the pose at `time` [s]; forgets what is older than `window` [s]. A second pose for one time replaces the first.
    pub(crate) fn push(&mut self, time: f64, pose: Pose, window: f64) {
        while self.samples.back().is_some_and(|(last, _)| *last >= time) {
            self.samples.pop_back();
        }
        self.samples.push_back((time, pose));
        // Half a millisecond of grace, or rounding decides whether the sample at the window's edge counts.
        while self
            .samples
            .front()
            .is_some_and(|(first, _)| *first < time - window - 5e-4)
        {
            self.samples.pop_front();
        }
    }

    /// Forgets everything: the next pose does not continue the last.
    pub(crate) fn clear(&mut self) {
        self.samples.clear();
    }

    /// Velocities of a body that is fixed to the hand with its centre at `arm` [m] from the hand, world axes, now.
    ///
    /// The poses are written in the exponential coordinates of the last one, where a swing about any fixed axis is a
    /// straight line, however far it turns; there a polynomial in time is fitted by least squares, and its slope at the last
    /// pose is the hand's velocity. `None` with fewer than two poses.
    pub(crate) fn velocity(&self, arm: DVec3, fit: ReleaseFit) -> Option<ReleaseVelocity> {
        let (now, last) = *self.samples.back()?;
        let hand_from_world = last.inverse();
        let rows: Vec<(f64, Twist)> = self
            .samples
            .iter()
            .map(|(time, pose)| (time - now, Twist::log(hand_from_world * *pose)))
            .collect();
        let slope = slope_now(
            &rows,
            match fit {
                ReleaseFit::Linear => 1,
                ReleaseFit::Quadratic => 2,
                ReleaseFit::Cubic => 3,
            },
        )?;
        let angular = last.rotation * slope.angular;
        let linear = last.rotation * slope.linear + angular.cross(arm);
        Some(ReleaseVelocity { linear, angular })
    }
}

/// Velocities of a body fixed to a hand that moves with `hand` (world axes), its centre at `arm` [m] from the hand.
pub(crate) fn carried(hand: Velocity, arm: DVec3) -> ReleaseVelocity {
    ReleaseVelocity {
        linear: hand.linear + hand.angular.cross(arm),
        angular: hand.angular,
    }
}

/// The estimates, and the one that is used: measured velocities where there are any.
pub(crate) fn estimate(
    history: &PoseHistory,
    measured: Option<Velocity>,
    arm: DVec3,
    config: &ReleaseConfig,
) -> (Option<ReleaseVelocity>, Option<ReleaseVelocity>) {
    (
        measured.map(|hand| carried(hand, arm)),
        history.velocity(arm, config.fit),
    )
}

/// A small rigid motion in exponential coordinates.
#[derive(Clone, Copy, Debug)]
struct Twist {
    linear: DVec3,
    angular: DVec3,
}

impl Twist {
    /// The constant motion over unit time that leads from the identity to `pose`.
    fn log(pose: Pose) -> Self {
        // Of the two quaternions of a rotation, the one that turns the short way.
        let rotation = if pose.rotation.w < 0.0 {
            -pose.rotation
        } else {
            pose.rotation
        };
        let angular = rotation.to_scaled_axis();
        let angle = angular.length();
        let half_sine = rotation.xyz().length();
        let coefficient = if angle < SMALL_ANGLE {
            1.0 / 12.0
        } else {
            (1.0 - 0.5 * angle * rotation.w / half_sine) / (angle * angle)
        };
        let cross = DMat3::from_cols(
            angular.cross(DVec3::X),
            angular.cross(DVec3::Y),
            angular.cross(DVec3::Z),
        );
        let p = pose.position;
        let linear = p - 0.5 * (cross * p) + coefficient * (cross * (cross * p));
        Self { linear, angular }
    }
}

/// Slope at t = 0 of the least-squares polynomial of a degree; of a lower one where there are too few rows.
///
/// Forsythe's recurrence: polynomials that are orthogonal over the rows' times, with their slopes at zero. Nothing is
/// inverted, so close and irregular times do no harm.
fn slope_now(rows: &[(f64, Twist)], degree: usize) -> Option<Twist> {
    let size = |p: &[f64]| p.iter().map(|value| value * value).sum::<f64>();
    // Values of the last polynomial and the one before it at the rows' times, and their value and slope at zero.
    let (mut before, mut last) = (vec![0.0; rows.len()], vec![1.0; rows.len()]);
    let (mut before_at_zero, mut at_zero) = ((0.0, 0.0), (1.0, 0.0));
    let mut before_size = 1.0;
    let mut weights = vec![0.0; rows.len()];
    for _ in 0..degree.min(rows.len().saturating_sub(1)) {
        let last_size = size(&last);
        let times = rows.iter().map(|(t, _)| t);
        let centre = times.zip(&last).map(|(t, p)| t * p * p).sum::<f64>() / last_size;
        let share = if before_at_zero == (0.0, 0.0) {
            0.0
        } else {
            last_size / before_size
        };
        let times = rows.iter().map(|(t, _)| t);
        let next: Vec<f64> = times
            .zip(last.iter().zip(&before))
            .map(|(t, (p, q))| (t - centre) * p - share * q)
            .collect();
        let next_at_zero = (
            -centre * at_zero.0 - share * before_at_zero.0,
            at_zero.0 - centre * at_zero.1 - share * before_at_zero.1,
        );
        let next_size = size(&next);
        for (weight, p) in weights.iter_mut().zip(&next) {
            *weight += p * next_at_zero.1 / next_size;
        }
        (before, last, before_size) = (last, next, last_size);
        (before_at_zero, at_zero) = (at_zero, next_at_zero);
    }
    let zero = Twist {
        linear: DVec3::ZERO,
        angular: DVec3::ZERO,
    };
    let slope = rows
        .iter()
        .zip(weights)
        .fold(zero, |sum, ((_, twist), weight)| Twist {
            linear: sum.linear + weight * twist.linear,
            angular: sum.angular + weight * twist.angular,
        });
    (rows.len() > 1).then_some(slope)
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DQuat;

    const ARM: f64 = 0.7;
    const SHOULDER: DVec3 = DVec3::new(0.2, 1.4, 0.5);

    /// A swing forward about the shoulder: angle behind the vertical `backswing * cos(rate t)`, hand turning with the arm.
    struct Swing {
        backswing: f64,
        rate: f64,
        yaw: f64,
    }

    impl Swing {
        fn pose(&self, t: f64) -> Pose {
            let turn = DQuat::from_rotation_y(self.yaw)
                * DQuat::from_rotation_x(-self.backswing * (self.rate * t).cos());
            Pose {
                position: SHOULDER + turn * DVec3::new(0.0, -ARM, 0.0),
                rotation: turn,
            }
        }

        fn velocity(&self, t: f64) -> Velocity {
            let axis = DQuat::from_rotation_y(self.yaw) * DVec3::X;
            let angular = axis * self.backswing * self.rate * (self.rate * t).sin();
            let linear = angular.cross(self.pose(t).position - SHOULDER);
            Velocity { linear, angular }
        }
    }

    fn agrees(estimate: ReleaseVelocity, truth: ReleaseVelocity) {
        let ratio = estimate.linear.length() / truth.linear.length();
        assert!((ratio - 1.0).abs() < 0.02, "speed ratio {ratio}");
        let angle = estimate.linear.angle_between(truth.linear).to_degrees();
        assert!(angle < 1.0, "direction off by {angle} degrees");
    }

    /// At 90 Hz, for slow and fast swings (3 to 11 m/s at the ball), at the bottom and up to 15 degrees of arc beside it.
    #[test]
    fn pendulum_velocities_come_out_of_poses_alone() {
        let config = crate::config::tests::default_config().release;
        for (backswing, rate) in [(0.9, 4.0), (1.0, 7.0), (1.2, 10.0)] {
            for yaw in [0.0, 0.3] {
                for late in [-0.25, 0.0, 0.25] {
                    let swing = Swing {
                        backswing,
                        rate,
                        yaw,
                    };
                    let release = std::f64::consts::FRAC_PI_2 / rate + late / (backswing * rate);
                    let mut history = PoseHistory::default();
                    for frame in (0..20).rev() {
                        let t = release - f64::from(frame) / 90.0;
                        history.push(t, swing.pose(t), config.window_s);
                    }
                    let arm = swing.pose(release).rotation * DVec3::new(0.03, -0.12, 0.02);
                    let truth = carried(swing.velocity(release), arm);
                    let estimate = history.velocity(arm, config.fit).unwrap();
                    agrees(estimate, truth);
                    assert!(
                        (estimate.angular - truth.angular).length() < 0.02 * truth.angular.length()
                    );
                }
            }
        }
    }

    #[test]
    fn a_steady_turn_is_exact_with_a_line() {
        let mut history = PoseHistory::default();
        for frame in 0..10 {
            let t = f64::from(frame) / 90.0;
            let rotation = DQuat::from_rotation_x(9.0 * t);
            history.push(
                t,
                Pose {
                    position: rotation * DVec3::NEG_Y,
                    rotation,
                },
                0.12,
            );
        }
        let last = DQuat::from_rotation_x(0.9);
        let estimate = history
            .velocity(last * DVec3::NEG_Y, ReleaseFit::Linear)
            .unwrap();
        let truth = DVec3::new(9.0, 0.0, 0.0).cross(last * DVec3::new(0.0, -2.0, 0.0));
        assert!(
            (estimate.linear - truth).length() < 1e-9,
            "{} {truth}",
            estimate.linear
        );
    }

    #[test]
    fn each_degree_is_exact_for_its_own_motion() {
        let fits = [ReleaseFit::Linear, ReleaseFit::Quadratic, ReleaseFit::Cubic];
        for (degree, fit) in (1..).zip(fits) {
            let mut history = PoseHistory::default();
            for frame in 0..9 {
                // Frames that a display skipped: times are not evenly spaced.
                let t = f64::from(frame + frame / 4) / 90.0 - 0.1;
                let x = (1..=degree).map(|power| t.powi(power)).sum::<f64>() + 2.0;
                history.push(t, Pose::from_position(DVec3::X * x), 1.0);
            }
            let (now, _) = *history.samples.back().unwrap();
            let expected: f64 = (1..=degree)
                .map(|power| f64::from(power) * now.powi(power - 1))
                .sum();
            let found = history.velocity(DVec3::ZERO, fit).unwrap().linear.x;
            assert!(
                (found - expected).abs() < 1e-9,
                "{fit:?}: {found}, not {expected}"
            );
        }
    }

    #[test]
    fn carried_adds_the_turn_at_the_centre() {
        let hand = Velocity {
            linear: DVec3::NEG_Z,
            angular: DVec3::new(5.0, 0.0, 0.0),
        };
        let velocity = carried(hand, DVec3::new(0.0, -0.2, 0.0));
        assert!((velocity.linear - DVec3::new(0.0, 0.0, -2.0)).length() < 1e-15);
    }

    #[test]
    fn history_keeps_the_window_and_survives_a_repeated_time() {
        let mut history = PoseHistory::default();
        assert_eq!(history.velocity(DVec3::ZERO, ReleaseFit::Linear), None);
        for frame in 0..50 {
            history.push(f64::from(frame) / 90.0, Pose::IDENTITY, 0.08);
            history.push(
                f64::from(frame) / 90.0,
                Pose::from_position(DVec3::X * f64::from(frame)),
                0.08,
            );
        }
        assert_eq!(history.samples.len(), 8);
        let velocity = history
            .velocity(DVec3::ZERO, ReleaseFit::Quadratic)
            .unwrap();
        assert!(
            (velocity.linear - DVec3::X * 90.0).length() < 1e-6,
            "{}",
            velocity.linear
        );
        history.clear();
        assert_eq!(history.velocity(DVec3::ZERO, ReleaseFit::Linear), None);
    }
}
