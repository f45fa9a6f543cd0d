//! How long a separating normal needs no second look.

use glam::DVec3;

use crate::query::Separation;

/// Bounds of how a body moves from some moment on, until something pushes it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Course {
    /// Velocity of its centre at that moment [m/s].
    pub linear_velocity: DVec3,
    /// Fastest that turning carries a point of its surface [m/s]: angular speed times radius.
    pub turning_speed: f64,
    /// Largest acceleration of its centre [m/s2].
    pub acceleration: f64,
}

impl Course {
    /// Nothing moves.
    pub const STILL: Course = Course {
        linear_velocity: DVec3::ZERO,
        turning_speed: 0.0,
        acceleration: 0.0,
    };
}

/// A proof that two shapes are apart: the planes normal to `normal` through their nearest points have `gap` between.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Certificate {
    /// Unit normal from a to b, world frame.
    pub normal: DVec3,
    /// Distance of the two planes [m], positive.
    pub gap: f64,
}

impl Certificate {
    /// The proof that an answer of the detection contains; none when it found no gap.
    pub fn from_separation(found: &Separation) -> Option<Certificate> {
        (found.gap > 0.0).then_some(Certificate {
            normal: found.normal,
            gap: found.gap,
        })
    }

    /// Time [s] for which the two surely stay apart, whatever they do within their courses; infinite if for ever.
    pub fn holds_for(&self, a: &Course, b: &Course) -> f64 {
        let closing = self.normal.dot(a.linear_velocity - b.linear_velocity);
        let speed = closing + a.turning_speed + b.turning_speed;
        time_to_close(self.gap, speed, a.acceleration + b.acceleration)
    }
}

/// Time [s] in which a gap [m] closes at a speed [m/s] that grows with an acceleration [m/s2] that is not negative.
///
/// A negative speed opens it first. Infinite when the gap never closes, zero when there is none.
pub fn time_to_close(gap: f64, speed: f64, acceleration: f64) -> f64 {
    if gap <= 0.0 {
        return 0.0;
    }
    let root = (speed * speed + 2.0 * acceleration * gap).sqrt();
    // Of the two forms of the root the one that does not subtract equals.
    if speed > 0.0 {
        2.0 * gap / (speed + root)
    } else if acceleration > 0.0 {
        (root - speed) / acceleration
    } else {
        f64::INFINITY
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn time_to_close_solves_the_quadratic() {
        for (gap, speed, acceleration) in [
            (1.0, 2.0, 0.0),
            (1.0, 2.0, 9.81),
            (0.3, 0.0, 9.81),
            (0.3, -2.0, 9.81),
            (1e-9, 100.0, 1e-3),
        ] {
            let t = time_to_close(gap, speed, acceleration);
            let way: f64 = speed * t + 0.5 * acceleration * t * t;
            assert!((way - gap).abs() <= 1e-12 * gap, "{way} instead of {gap}");
        }
        assert_eq!(time_to_close(1.0, 0.0, 0.0), f64::INFINITY);
        assert_eq!(time_to_close(1.0, -1.0, 0.0), f64::INFINITY);
        assert_eq!(time_to_close(0.0, -1.0, 0.0), 0.0);
    }
}
