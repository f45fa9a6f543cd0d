//! Position and orientation of a body or of a part.

use std::ops::Mul;

use glam::{DQuat, DVec3};

/// A rigid transform: `target_from_source`, rotation first, then translation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pose {
    /// Where the source's origin lies in the target frame [m].
    pub position: DVec3,
    /// Rotation from the source to the target frame; a unit quaternion.
    pub rotation: DQuat,
}

impl Pose {
    /// The transform that changes nothing.
    pub const IDENTITY: Pose = Pose {
        position: DVec3::ZERO,
        rotation: DQuat::IDENTITY,
    };

    /// A pose from its position [m] and its rotation (unit quaternion).
    pub fn new(position: DVec3, rotation: DQuat) -> Pose {
        Pose { position, rotation }
    }

    /// An upright pose at `position` [m].
    pub fn from_position(position: DVec3) -> Pose {
        Pose::new(position, DQuat::IDENTITY)
    }

    /// Takes a point [m] from the source to the target frame.
    pub fn transform_point(&self, point: DVec3) -> DVec3 {
        self.position + self.rotation * point
    }

    /// Takes a direction or a velocity from the source to the target frame.
    pub fn transform_vector(&self, vector: DVec3) -> DVec3 {
        self.rotation * vector
    }

    /// The transform back: `source_from_target`.
    pub fn inverse(&self) -> Pose {
        let rotation = self.rotation.conjugate();
        Pose::new(-(rotation * self.position), rotation)
    }

    /// Whether every number is finite.
    pub fn is_finite(&self) -> bool {
        self.position.is_finite() && self.rotation.is_finite()
    }
}

impl Mul for Pose {
    type Output = Pose;

    /// `c_from_b * b_from_a = c_from_a`.
    fn mul(self, b_from_a: Pose) -> Pose {
        Pose::new(
            self.transform_point(b_from_a.position),
            self.rotation * b_from_a.rotation,
        )
    }
}

impl Default for Pose {
    fn default() -> Pose {
        Pose::IDENTITY
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn inverse_undoes_a_pose() {
        let pose = Pose::new(
            DVec3::new(1.0, -2.0, 3.0),
            DQuat::from_scaled_axis(DVec3::new(0.3, 1.1, -0.4)),
        );
        let point = DVec3::new(0.2, 0.7, -1.3);
        let back = (pose.inverse() * pose).transform_point(point);
        assert!((back - point).length() < 1e-15);
    }

    #[test]
    fn product_applies_the_right_factor_first() {
        let turn = Pose::new(
            DVec3::ZERO,
            DQuat::from_rotation_y(std::f64::consts::FRAC_PI_2),
        );
        let shift = Pose::from_position(DVec3::X);
        let moved = (turn * shift).transform_point(DVec3::ZERO);
        assert!((moved - DVec3::NEG_Z).length() < 1e-15);
    }
}
