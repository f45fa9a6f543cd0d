//! The pendulum swing of a straight arm, with its velocities in closed form.
//!
//! Angles are measured at the shoulder: 0 hangs down, positive is forward. Frame: the body's, x to
//! the right, y up, -z ahead, so that a positive angle is a positive turn about +x.

use std::f64::consts::{FRAC_PI_2, PI, TAU};

use glam::{DQuat, DVec3};

use super::body::HandState;

/// One throw of the arm.
#[derive(Debug, Clone)]
pub struct Swing {
    /// Shoulder in the body frame at the release [m].
    pub shoulder: DVec3,
    /// From the shoulder to the middle of the hand [m].
    pub arm_length: f64,
    /// Angle at which the arm starts, in front [rad].
    pub start_angle: f64,
    /// Angle behind the vertical where the swing turns, positive [rad].
    pub backswing: f64,
    /// Angular speed at the lowest point of the forward swing [rad/s].
    pub peak_rate: f64,
    /// Time for the way back [s].
    pub back_time: f64,
    /// From the middle of the hand to the middle of the ball beyond the fingers [m].
    pub ball_distance: f64,
    /// Turn of the wrist at the lowest point, about the ball's middle [rad/s]: it spins the ball and leaves its way alone.
    pub wrist: DVec3,
}

impl Swing {
    /// Time from the start to the lowest point of the forward swing [s].
    pub fn time_of_lowest_point(&self) -> f64 {
        self.back_time + self.quarter()
    }

    /// Time from the start until the follow-through has come to rest [s].
    pub fn duration(&self) -> f64 {
        self.back_time + 2.0 * self.quarter()
    }

    /// Quarter of the forward swing's period: from the turn to the lowest point [s].
    ///
    /// The forward swing is `-backswing * cos(rate * t)`, whose greatest speed is
    /// `backswing * rate`.
    fn quarter(&self) -> f64 {
        FRAC_PI_2 * self.backswing / self.peak_rate
    }

    /// Angle [rad] and its rate [rad/s] at `time` [s] after the start.
    pub fn angle(&self, time: f64) -> (f64, f64) {
        if time < self.back_time {
            let (s, rate) = minimum_jerk(time / self.back_time);
            let way = -self.backswing - self.start_angle;
            return (self.start_angle + way * s, way * rate / self.back_time);
        }
        let frequency = self.peak_rate / self.backswing;
        let phase = (frequency * (time - self.back_time)).min(PI);
        (
            -self.backswing * libm::cos(phase),
            self.backswing * frequency * libm::sin(phase),
        )
    }

    /// How far the wrist has turned, as a share of `wrist` [s], and the rate of that [1].
    ///
    /// It turns with the square of the arm's speed: not on the way back, fastest at the lowest point.
    fn wrist_turn(&self, time: f64) -> (f64, f64) {
        let frequency = self.peak_rate / self.backswing;
        let phase = (frequency * (time - self.back_time)).clamp(0.0, PI);
        let sine = libm::sin(phase);
        let turned = 0.5 * (phase - sine * libm::cos(phase)) / frequency;
        (turned, sine * sine)
    }

    /// The hand at `time`: its fingers along the arm, but for the turn of the wrist.
    pub fn hand(&self, time: f64) -> HandState {
        let (angle, rate) = self.angle(time);
        let (turned, turning) = self.wrist_turn(time);
        let arm = DQuat::from_rotation_x(angle) * DVec3::NEG_Y;
        let ball = arm * (self.arm_length + self.ball_distance);
        let swing = DVec3::X * rate;
        let twist = DQuat::from_scaled_axis(self.wrist * turned);
        let angular = self.wrist * turning + twist * swing;
        let from_ball = twist * (arm * -self.ball_distance);
        HandState {
            position: self.shoulder + ball + from_ball,
            rotation: twist * fingers_along_arm(angle),
            linear: swing.cross(ball) + angular.cross(from_ball),
            angular,
        }
    }
}

/// `body_from_hand` of a hand whose fingers (-z) continue an arm at `angle` [rad], palm to the front.
pub fn fingers_along_arm(angle: f64) -> DQuat {
    DQuat::from_rotation_x(angle - FRAC_PI_2) * DQuat::from_rotation_z(PI)
}

/// Position 0 to 1 and its rate for a reach of unit time that starts and ends at rest with the
/// least jerk, as human reaches do (Flash and Hogan 1985).
pub fn minimum_jerk(part: f64) -> (f64, f64) {
    let t = part.clamp(0.0, 1.0);
    let position = t * t * t * (10.0 + t * (-15.0 + 6.0 * t));
    let rate = 30.0 * t * t * (1.0 - t) * (1.0 - t);
    (position, rate)
}

/// An angle brought into (-pi, pi].
pub fn wrapped(angle: f64) -> f64 {
    let turned = angle.rem_euclid(TAU);
    if turned > PI { turned - TAU } else { turned }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn swing() -> Swing {
        Swing {
            shoulder: DVec3::new(0.2, 1.0, 0.0),
            arm_length: 0.6,
            start_angle: 0.4,
            backswing: 1.3,
            peak_rate: 9.0,
            back_time: 0.8,
            ball_distance: 0.17,
            wrist: DVec3::new(0.0, -1.5, 3.0),
        }
    }

    #[test]
    fn hand_velocities_are_the_derivatives_of_its_pose() {
        let swing = swing();
        let step = 1e-5;
        for time in [0.1, 0.5, 0.79, 0.85, 0.95, 1.1] {
            let (before, now, after) = (
                swing.hand(time - step),
                swing.hand(time),
                swing.hand(time + step),
            );
            let linear = (after.position - before.position) / (2.0 * step);
            // The error of a central difference is step^2 times the third derivative, about 1e-7.
            assert!(
                linear.abs_diff_eq(now.linear, 1e-6),
                "{time}: {linear} {}",
                now.linear
            );
            let turn = (after.rotation * before.rotation.inverse()).to_scaled_axis() / (2.0 * step);
            assert!(
                turn.abs_diff_eq(now.angular, 1e-6),
                "{time}: {turn} {}",
                now.angular
            );
        }
    }

    #[test]
    fn angle_is_continuous_where_the_swing_turns() {
        let swing = swing();
        let (before, after) = (swing.angle(0.8 - 1e-9), swing.angle(0.8));
        assert!((before.0 - after.0).abs() < 1e-6 && (before.1 - after.1).abs() < 1e-6);
        assert!((after.0 + 1.3).abs() < 1e-12);
    }

    #[test]
    fn lowest_point_is_reached_at_peak_rate() {
        let swing = Swing {
            wrist: DVec3::ZERO,
            ..swing()
        };
        let (angle, rate) = swing.angle(swing.time_of_lowest_point());
        assert!(
            angle.abs() < 1e-12 && (rate - 9.0).abs() < 1e-12,
            "{angle} {rate}"
        );
        let hand = swing.hand(swing.time_of_lowest_point());
        assert!(
            hand.linear.abs_diff_eq(DVec3::NEG_Z * 5.4, 1e-9),
            "{}",
            hand.linear
        );
    }

    #[test]
    fn wrist_spins_the_ball_and_leaves_its_way_alone() {
        let (swing, straight) = (
            swing(),
            Swing {
                wrist: DVec3::ZERO,
                ..swing()
            },
        );
        let ball = |swing: &Swing, time: f64| {
            let hand = swing.hand(time);
            let arm = hand.rotation * DVec3::NEG_Z * swing.ball_distance;
            (
                hand.position + arm,
                hand.linear + hand.angular.cross(arm),
                hand.angular,
            )
        };
        for time in [0.5, 0.9, swing.time_of_lowest_point(), 1.1] {
            let (turned, plain) = (ball(&swing, time), ball(&straight, time));
            assert!(turned.0.abs_diff_eq(plain.0, 1e-12), "{time}");
            assert!(turned.1.abs_diff_eq(plain.1, 1e-12), "{time}");
        }
        let spin = ball(&swing, swing.time_of_lowest_point()).2;
        let roll = DQuat::from_scaled_axis(swing.wrist * 0.5 * swing.quarter()) * DVec3::X * 9.0;
        assert!(spin.abs_diff_eq(swing.wrist + roll, 1e-9), "{spin}");
    }

    #[test]
    fn wrapped_brings_angles_near_zero() {
        assert!((wrapped(TAU + 0.1) - 0.1).abs() < 1e-12);
        assert!((wrapped(-TAU - 0.1) + 0.1).abs() < 1e-12);
        assert!((wrapped(1.5 * PI) + FRAC_PI_2).abs() < 1e-12);
    }
}
