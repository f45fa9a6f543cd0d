//! A head, or a spectator, to the views of two eyes.

use game::DisplayConfig;
use glam::{DQuat, DVec3};
use physics::Pose;
use renderer::{Fov, View};

use super::rotation;

/// Vertical field of view of the spectator's eyes [rad].
const SPECTATOR_FOV: f32 = 0.85;
/// Vertical field of view of the bird's eye [rad].
const BIRD_FOV: f32 = 0.9;

/// The two eyes of a head, left first, with the angles of the display profile in use.
pub fn eyes(world_from_head: &Pose, display: &DisplayConfig) -> [View; 2] {
    View::stereo(
        world_from_head.position.as_vec3(),
        rotation(world_from_head.rotation),
        display.eye_distance_m as f32,
        right_eye(display),
    )
}

/// The right eye's field of view: its outer edge is at the right.
fn right_eye(display: &DisplayConfig) -> Fov {
    let profile = display.current();
    let radians = |degrees: f64| degrees.to_radians() as f32;
    Fov {
        left: -radians(profile.inner_deg),
        right: radians(profile.outer_deg),
        up: radians(profile.up_deg),
        down: -radians(profile.down_deg),
    }
}

/// A spectator's two eyes before the pin deck, left first; narrower than a headset's, for the pins' sake.
pub fn spectator_eyes(headpin_z: f64, display: &DisplayConfig) -> [View; 2] {
    let [left, right] = eyes(&spectator(headpin_z), display);
    let fov = Fov::from_aspect(SPECTATOR_FOV, right.fov.aspect());
    [View { fov, ..left }, View { fov, ..right }]
}

/// One eye under the ceiling above the approach, which sees the approach and the lane down to the pins.
pub fn bird(aspect: f32) -> View {
    let pose = towards(DVec3::new(1.2, 2.7, 3.2), DVec3::new(-0.1, 0.0, -5.0));
    View {
        position: pose.position.as_vec3(),
        rotation: rotation(pose.rotation),
        fov: Fov::from_aspect(BIRD_FOV, aspect),
    }
}

/// `world_from_head` of a spectator before the pin deck, who looks at the pins from above the lane.
pub fn spectator(headpin_z: f64) -> Pose {
    let position = DVec3::new(0.25, 0.75, headpin_z + 1.3);
    towards(position, DVec3::new(0.0, 0.1, headpin_z - 0.4))
}

/// Upright at `position`, looking at `target`.
fn towards(position: DVec3, target: DVec3) -> Pose {
    let way = target - position;
    let yaw = libm::atan2(-way.x, -way.z);
    let pitch = libm::atan2(way.y, libm::sqrt(way.x * way.x + way.z * way.z));
    Pose {
        position,
        rotation: DQuat::from_rotation_y(yaw) * DQuat::from_rotation_x(pitch),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use game::{DisplayProfile, DisplayProfileName};
    use glam::Vec3;

    fn display(profile: DisplayProfileName) -> DisplayConfig {
        let angles = |outer_deg, inner_deg, up_deg, down_deg| DisplayProfile {
            outer_deg,
            inner_deg,
            up_deg,
            down_deg,
            width_px: 64,
            height_px: 64,
            relayed_width_px: 64,
            relayed_height_px: 64,
        };
        DisplayConfig {
            profile,
            eye_distance_m: 0.06,
            modern: angles(54.0, 44.0, 46.0, 50.0),
            of_1996: angles(37.5, 37.5, 20.0, 20.0),
        }
    }

    #[test]
    fn eyes_lie_left_and_right_of_the_head_along_its_own_axis() {
        let quarter_left = DQuat::from_rotation_y(std::f64::consts::FRAC_PI_2);
        let head = Pose {
            position: DVec3::new(0.0, 1.6, 2.0),
            rotation: quarter_left,
        };
        let [left, right] = eyes(&head, &display(DisplayProfileName::Modern));
        // Facing -x, the right hand is at -z.
        assert!(
            right.position.abs_diff_eq(Vec3::new(0.0, 1.6, 1.97), 1e-5),
            "{}",
            right.position
        );
        assert!(
            left.position.abs_diff_eq(Vec3::new(0.0, 1.6, 2.03), 1e-5),
            "{}",
            left.position
        );
    }

    #[test]
    fn eyes_mirror_the_profile_and_keep_its_angles() {
        let [left, right] = eyes(&Pose::IDENTITY, &display(DisplayProfileName::Modern));
        let degrees = |angle: f32| angle.to_degrees().round();
        assert_eq!(
            (degrees(left.fov.left), degrees(left.fov.right)),
            (-54.0, 44.0)
        );
        assert_eq!(
            (degrees(right.fov.left), degrees(right.fov.right)),
            (-44.0, 54.0)
        );
        assert_eq!(
            (degrees(left.fov.up), degrees(left.fov.down)),
            (46.0, -50.0)
        );
        let [old, _] = eyes(&Pose::IDENTITY, &display(DisplayProfileName::Of1996));
        assert!(((old.fov.right - old.fov.left).to_degrees() - 75.0).abs() < 1e-3);
        assert!(((old.fov.up - old.fov.down).to_degrees() - 40.0).abs() < 1e-3);
    }

    #[test]
    fn spectator_looks_down_at_the_pins() {
        let pose = spectator(-18.288);
        let ahead = pose.rotation * DVec3::NEG_Z;
        let deck = (DVec3::new(0.0, 0.1, -18.688) - pose.position).normalize_or_zero();
        assert!(ahead.dot(deck) > 0.9999, "{ahead} {deck}");
    }
}
