//! Where things are: spaces located in other spaces.

use std::ffi::c_void;

use glam::{DQuat, DVec3};
use openxr as xr;

use super::HeadsetError;

/// A tracked thing in tracking space.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TrackedPose {
    /// Position [m].
    pub position: DVec3,
    /// `tracking_from_thing`.
    pub rotation: DQuat,
    /// Linear [m/s] and angular [rad/s] velocity in tracking space's axes, where the runtime says that it knows both.
    pub velocity: Option<[DVec3; 2]>,
}

/// Locates `space` in `base`; `None` while the runtime knows no position or no orientation.
///
/// `openxr::Space::relate` leaves the velocity's flags uninitialised, which the validation layer refuses; the same call with
/// structs set to zero is right.
#[expect(unsafe_code, reason = "a call through the runtime's function table")]
pub(super) fn locate(
    space: &xr::Space,
    base: &xr::Space,
    time: xr::Time,
) -> Result<Option<TrackedPose>, HeadsetError> {
    let mut velocity = xr::sys::SpaceVelocity {
        ty: xr::sys::SpaceVelocity::TYPE,
        next: std::ptr::null_mut(),
        velocity_flags: xr::SpaceVelocityFlags::EMPTY,
        linear_velocity: xr::Vector3f::default(),
        angular_velocity: xr::Vector3f::default(),
    };
    let mut location = xr::sys::SpaceLocation {
        ty: xr::sys::SpaceLocation::TYPE,
        next: std::ptr::from_mut(&mut velocity).cast::<c_void>(),
        location_flags: xr::SpaceLocationFlags::EMPTY,
        pose: xr::Posef::IDENTITY,
    };
    // SAFETY: both spaces live, and both structs are initialised, chained and outlive the call.
    let answer = unsafe {
        (space.instance().fp().locate_space)(space.as_raw(), base.as_raw(), time, &mut location)
    };
    if answer.into_raw() < 0 {
        return Err(answer.into());
    }
    Ok(tracked(
        (location.location_flags, location.pose),
        (
            velocity.velocity_flags,
            velocity.linear_velocity,
            velocity.angular_velocity,
        ),
    ))
}

/// What the flags say is known; tracked or inferred alike, as a controller behind the back is inferred.
pub(super) fn tracked(
    (known, pose): (xr::SpaceLocationFlags, xr::Posef),
    (moves, linear, angular): (xr::SpaceVelocityFlags, xr::Vector3f, xr::Vector3f),
) -> Option<TrackedPose> {
    let place = xr::SpaceLocationFlags::POSITION_VALID | xr::SpaceLocationFlags::ORIENTATION_VALID;
    if !known.contains(place) {
        return None;
    }
    let motion = xr::SpaceVelocityFlags::LINEAR_VALID | xr::SpaceVelocityFlags::ANGULAR_VALID;
    Some(TrackedPose {
        position: vector(pose.position),
        rotation: rotation(pose.orientation),
        velocity: moves
            .contains(motion)
            .then(|| [vector(linear), vector(angular)]),
    })
}

pub(super) fn vector(v: xr::Vector3f) -> DVec3 {
    DVec3::new(v.x.into(), v.y.into(), v.z.into())
}

pub(super) fn rotation(q: xr::Quaternionf) -> DQuat {
    DQuat::from_xyzw(q.x.into(), q.y.into(), q.z.into(), q.w.into()).normalize()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Monado's drivers always know the head's place; what a runtime that has lost it says is seen here.
    #[test]
    fn what_the_runtime_does_not_know_is_not_tracked() {
        use xr::{SpaceLocationFlags as Known, SpaceVelocityFlags as Moves};
        let one = xr::Vector3f {
            x: 1.0,
            y: 0.0,
            z: 0.0,
        };
        let read = |known, moves| tracked((known, xr::Posef::IDENTITY), (moves, one, one));
        let place = Known::POSITION_VALID | Known::ORIENTATION_VALID;
        let both = Moves::LINEAR_VALID | Moves::ANGULAR_VALID;
        for lost in [
            Known::EMPTY,
            Known::POSITION_VALID,
            Known::ORIENTATION_VALID | Known::ORIENTATION_TRACKED,
        ] {
            assert_eq!(read(lost, both), None, "{lost:?}");
        }
        let seen = read(place, both).expect("inferred is as good as tracked");
        assert_eq!(seen.velocity, Some([DVec3::X; 2]));
        let still = read(place, Moves::LINEAR_VALID).expect("its place is known");
        assert_eq!(still.velocity, None, "half a velocity is none");
    }
}
