//! Where an eye is and what it sees: pose and field of view to matrices.

use glam::camera::rh::proj::directx;
use glam::{Mat4, Quat, Vec3};

use crate::RenderError;

/// Nearest visible distance [m].
pub const NEAR_M: f32 = 0.05;
/// Farthest visible distance [m]: an alley and its building, with room to spare.
pub const FAR_M: f32 = 100.0;

/// Half angles of a field of view [rad], signed as OpenXR signs them: left and down are negative.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Fov {
    /// To the left edge [rad], usually negative.
    pub left: f32,
    /// To the right edge [rad].
    pub right: f32,
    /// To the upper edge [rad].
    pub up: f32,
    /// To the lower edge [rad], usually negative.
    pub down: f32,
}

impl Fov {
    /// A field of view with its axis in the middle, from full angles [rad].
    pub fn symmetric(horizontal: f32, vertical: f32) -> Self {
        Self {
            left: -0.5 * horizontal,
            right: 0.5 * horizontal,
            up: 0.5 * vertical,
            down: -0.5 * vertical,
        }
    }

    /// A symmetric field of view with square pixels, from the vertical angle [rad] and width over height.
    pub fn from_aspect(vertical: f32, aspect: f32) -> Self {
        Self::symmetric(2.0 * (aspect * (0.5 * vertical).tan()).atan(), vertical)
    }

    /// Width over height of the picture plane, whatever the shape of the pixels.
    pub fn aspect(&self) -> f32 {
        (self.right.tan() - self.left.tan()) / (self.up.tan() - self.down.tan())
    }

    /// Whether each edge is nearer than a right angle and the edges are in order.
    fn is_valid(&self) -> bool {
        let in_range = |angle: f32| angle.abs() < 0.499 * std::f32::consts::PI;
        [self.left, self.right, self.up, self.down]
            .into_iter()
            .all(in_range)
            && self.left < self.right
            && self.down < self.up
    }
}

/// An eye: where it is in the world and what it sees.
///
/// Eye frame: x right, y up, looking along -z, as OpenXR and glam have it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct View {
    /// Position of the eye, world frame [m].
    pub position: Vec3,
    /// Rotation from the eye's axes to the world's.
    pub rotation: Quat,
    /// What the eye sees.
    pub fov: Fov,
}

impl View {
    /// An eye at `position` that looks at `target` with the world's up; straight up or down, -z of the picture is up.
    pub fn looking_at(position: Vec3, target: Vec3, fov: Fov) -> Self {
        let forward = (target - position).try_normalize().unwrap_or(Vec3::NEG_Z);
        let right = forward.cross(Vec3::Y).try_normalize().unwrap_or(Vec3::X);
        let up = right.cross(forward);
        let rotation = Quat::from_mat3(&glam::Mat3::from_cols(right, up, -forward));
        Self {
            position,
            rotation,
            fov,
        }
    }

    /// The two eyes of a head, left first, `eye_distance` [m] apart along the head's x, with the head's rotation.
    ///
    /// `right_fov` is the right eye's; the left eye's is its mirror image.
    pub fn stereo(position: Vec3, rotation: Quat, eye_distance: f32, right_fov: Fov) -> [Self; 2] {
        let left_fov = Fov {
            left: -right_fov.right,
            right: -right_fov.left,
            ..right_fov
        };
        let to_right = rotation * Vec3::X * (0.5 * eye_distance);
        [(-to_right, left_fov), (to_right, right_fov)].map(|(offset, fov)| Self {
            position: position + offset,
            rotation,
            fov,
        })
    }

    /// Eye coordinates from world coordinates.
    pub fn eye_from_world(&self) -> Mat4 {
        Mat4::from_rotation_translation(self.rotation, self.position).inverse()
    }

    /// Clip coordinates (x right, y up, depth 0 to 1) from world coordinates.
    pub fn clip_from_world(&self) -> Mat4 {
        let at_near = |angle: f32| NEAR_M * angle.tan();
        let fov = &self.fov;
        let clip_from_eye = directx::frustum(
            at_near(fov.left),
            at_near(fov.right),
            at_near(fov.down),
            at_near(fov.up),
            NEAR_M,
            FAR_M,
        );
        clip_from_eye * self.eye_from_world()
    }

    /// The pixel, counted from the upper left corner, on which a world point falls; `None` behind the eye.
    pub fn pixel_of(&self, point: Vec3, width: u32, height: u32) -> Option<[f32; 2]> {
        let clip = self.clip_from_world() * point.extend(1.0);
        (clip.w > 0.0).then(|| {
            [
                (0.5 + 0.5 * clip.x / clip.w) * width as f32,
                (0.5 - 0.5 * clip.y / clip.w) * height as f32,
            ]
        })
    }

    pub(crate) fn check(&self) -> Result<(), RenderError> {
        if !self.position.is_finite() || !self.rotation.is_finite() {
            return Err(RenderError::View("its pose is not a number".to_owned()));
        }
        if !self.rotation.is_normalized() {
            return Err(RenderError::View(
                "its rotation is not a unit quaternion".to_owned(),
            ));
        }
        if !self.fov.is_valid() {
            return Err(RenderError::View(format!(
                "its field of view needs left < right, down < up and less than a right angle each: {:?}",
                self.fov
            )));
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn close(a: [f32; 2], b: [f32; 2]) -> bool {
        (a[0] - b[0]).abs() < 1e-3 && (a[1] - b[1]).abs() < 1e-3
    }

    #[test]
    fn pixel_of_asymmetric_edges() {
        let fov = Fov {
            left: -0.9,
            right: 0.6,
            up: 0.7,
            down: -0.8,
        };
        let view = View {
            position: Vec3::new(1.0, 2.0, 3.0),
            rotation: Quat::IDENTITY,
            fov,
        };
        let at = |x: f32, y: f32| {
            view.pixel_of(view.position + Vec3::new(x, y, -1.0) * 4.0, 200, 100)
                .expect("in front of the eye")
        };
        assert!(close(at(fov.left.tan(), fov.up.tan()), [0.0, 0.0]));
        assert!(close(at(fov.right.tan(), fov.down.tan()), [200.0, 100.0]));
        assert!(close(at(fov.left.tan(), fov.down.tan()), [0.0, 100.0]));
        assert_eq!(view.pixel_of(Vec3::new(1.0, 2.0, 4.0), 200, 100), None);
    }

    #[test]
    fn pixel_of_straight_ahead_is_off_centre_by_the_asymmetry() {
        let fov = Fov {
            left: -(1.0_f32.atan()),
            right: 0.5_f32.atan(),
            up: 0.25_f32.atan(),
            down: -(0.75_f32.atan()),
        };
        let view = View::looking_at(Vec3::ZERO, Vec3::NEG_Z, fov);
        let pixel = view
            .pixel_of(Vec3::new(0.0, 0.0, -2.0), 300, 400)
            .expect("in front of the eye");
        assert!(close(pixel, [200.0, 100.0]), "{pixel:?}");
    }

    #[test]
    fn stereo_mirrors_the_fields_and_parts_the_eyes() {
        let right_fov = Fov {
            left: -0.6,
            right: 0.9,
            up: 0.5,
            down: -0.7,
        };
        let turned = Quat::from_rotation_y(std::f32::consts::FRAC_PI_2);
        let [left, right] = View::stereo(Vec3::Y, turned, 0.06, right_fov);
        // Turned left by a right angle, the head's right is the world's -z.
        assert!((left.position - Vec3::new(0.0, 1.0, 0.03)).length() < 1e-6);
        assert!((right.position - Vec3::new(0.0, 1.0, -0.03)).length() < 1e-6);
        assert_eq!((left.fov.left, left.fov.right), (-0.9, 0.6));
        assert_eq!((left.fov.up, left.fov.down), (0.5, -0.7));
    }

    #[test]
    fn looking_at_turns_forward_to_the_target() {
        let fov = Fov::symmetric(1.0, 1.0);
        for target in [Vec3::X, Vec3::new(-1.0, 2.0, 3.0), Vec3::Y, Vec3::NEG_Y] {
            let view = View::looking_at(Vec3::ZERO, target, fov);
            assert!(view.check().is_ok());
            let forward = view.rotation * Vec3::NEG_Z;
            assert!((forward - target.normalize_or_zero()).length() < 1e-5);
        }
    }

    #[test]
    fn check_refuses_what_is_no_field_of_view() {
        let good = View::looking_at(Vec3::ZERO, Vec3::NEG_Z, Fov::symmetric(1.0, 1.0));
        assert!(good.check().is_ok());
        let mut bad = good;
        bad.fov.left = 0.6;
        assert!(bad.check().is_err());
        bad = good;
        bad.fov.up = 1.6;
        assert!(bad.check().is_err());
        bad = good;
        bad.position.x = f32::NAN;
        assert!(bad.check().is_err());
    }

    #[test]
    fn from_aspect_has_square_pixels() {
        let fov = Fov::from_aspect(0.9, 1.5);
        assert!((fov.aspect() - 1.5).abs() < 1e-5);
    }
}
