//! Bare hands, by the joints that the runtime tracks: where the palm is, how the fingers are bent, whether the hand holds.

use std::ffi::c_void;

use glam::{DQuat, DVec3};
use openxr as xr;

use super::HeadsetError;
use super::actions::Side;
use super::runtime::Runtime;
use super::space::{self, TrackedPose};

/// Sum of a finger's three bends at which a hand is open, and at which it is a fist [rad]; chosen: a hand at rest has 1.3, a fist
/// about 4.
const GRASP: [f64; 2] = [1.0, 3.0];
/// Distance from the thumb's tip to the index finger's at which nothing is pinched, and at which it is [m]; chosen: they do not
/// come nearer than 15 mm to each other, because a joint lies within its finger.
const PINCH: [f64; 2] = [0.045, 0.015];

/// A hand without a controller.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BareHand {
    /// The palm's middle: fingers along -z, out of the palm along -y.
    pub palm: TrackedPose,
    /// How far each joint is bent against the part before it [rad], into the palm: of index, middle, ring and little finger from
    /// the palm outwards, then of the thumb, whose first is its own against the palm's plane.
    pub bends: [[f64; 3]; 5],
    /// Middle, ring and little finger, from 0 (open) to 1 (a fist).
    pub grasp: f64,
    /// Thumb and index finger, from 0 (apart) to 1 (together).
    pub pinch: f64,
}

/// What tracks the joints of both hands.
pub(super) struct Joints {
    trackers: [xr::HandTracker; 2],
}

impl Joints {
    /// For both hands; `None` where the runtime, or the headset, tracks none.
    pub fn new(
        runtime: &Runtime,
        session: &xr::Session<xr::Vulkan>,
    ) -> Result<Option<Self>, HeadsetError> {
        let instance = &runtime.instance;
        if !runtime.enabled.ext_hand_tracking || !instance.supports_hand_tracking(runtime.system)? {
            return Ok(None);
        }
        let tracker = |hand| session.create_hand_tracker(hand);
        Ok(Some(Self {
            trackers: [tracker(xr::Hand::LEFT)?, tracker(xr::Hand::RIGHT)?],
        }))
    }

    /// A hand in `base`; `None` while it is not tracked.
    pub fn read(
        &self,
        side: Side,
        base: &xr::Space,
        time: xr::Time,
    ) -> Result<Option<BareHand>, HeadsetError> {
        let located = locate(&self.trackers[side as usize], base, time)?;
        Ok(located.and_then(|located| {
            let palm = located.palm()?;
            let places = located.places()?;
            Some(BareHand::of(palm, &places))
        }))
    }
}

/// What the runtime says of a hand's joints.
struct Located {
    joints: [xr::sys::HandJointLocationEXT; xr::HAND_JOINT_COUNT],
    velocities: [xr::sys::HandJointVelocityEXT; xr::HAND_JOINT_COUNT],
}

impl Located {
    fn palm(&self) -> Option<TrackedPose> {
        let index = joint(xr::HandJoint::PALM);
        let (location, velocity) = (&self.joints[index], &self.velocities[index]);
        space::tracked(
            (location.location_flags, location.pose),
            (
                velocity.velocity_flags,
                velocity.linear_velocity,
                velocity.angular_velocity,
            ),
        )
    }

    /// Where all joints are.
    fn places(&self) -> Option<[DVec3; xr::HAND_JOINT_COUNT]> {
        let known = xr::SpaceLocationFlags::POSITION_VALID;
        let is_known = |joint: &xr::sys::HandJointLocationEXT| joint.location_flags.contains(known);
        let joints = &self.joints;
        joints
            .iter()
            .all(is_known)
            .then(|| joints.map(|joint| space::vector(joint.pose.position)))
    }
}

/// As [`space::locate`] does, because `openxr` leaves the velocities' flags uninitialised here too.
#[expect(unsafe_code, reason = "a call through the runtime's function table")]
fn locate(
    tracker: &xr::HandTracker,
    base: &xr::Space,
    time: xr::Time,
) -> Result<Option<Located>, HeadsetError> {
    let Some(functions) = &base.instance().exts().ext_hand_tracking else {
        return Ok(None);
    };
    // The validation layer takes no flags of 0, also where the runtime is to write them; these alone make nothing known.
    let location = xr::sys::HandJointLocationEXT {
        location_flags: xr::SpaceLocationFlags::ORIENTATION_VALID,
        pose: xr::Posef::IDENTITY,
        radius: 0.0,
    };
    let velocity = xr::sys::HandJointVelocityEXT {
        velocity_flags: xr::SpaceVelocityFlags::LINEAR_VALID,
        ..Default::default()
    };
    let mut located = Located {
        joints: [location; xr::HAND_JOINT_COUNT],
        velocities: [velocity; xr::HAND_JOINT_COUNT],
    };
    let info = xr::sys::HandJointsLocateInfoEXT {
        ty: xr::sys::HandJointsLocateInfoEXT::TYPE,
        next: std::ptr::null(),
        base_space: base.as_raw(),
        time,
    };
    let mut velocities = xr::sys::HandJointVelocitiesEXT {
        ty: xr::sys::HandJointVelocitiesEXT::TYPE,
        next: std::ptr::null_mut(),
        joint_count: xr::HAND_JOINT_COUNT as u32,
        joint_velocities: located.velocities.as_mut_ptr(),
    };
    let mut locations = xr::sys::HandJointLocationsEXT {
        ty: xr::sys::HandJointLocationsEXT::TYPE,
        next: std::ptr::from_mut(&mut velocities).cast::<c_void>(),
        is_active: false.into(),
        joint_count: xr::HAND_JOINT_COUNT as u32,
        joint_locations: located.joints.as_mut_ptr(),
    };
    // SAFETY: tracker and space are of the one session that owns both, and all structs are initialised, chained and outlive the
    // call; the arrays have as many places as they say.
    let answer = unsafe { (functions.locate_hand_joints)(tracker.as_raw(), &info, &mut locations) };
    if answer.into_raw() < 0 {
        return Err(answer.into());
    }
    Ok(bool::from(locations.is_active).then_some(located))
}

fn joint(joint: xr::HandJoint) -> usize {
    joint.into_raw() as usize
}

impl BareHand {
    /// Of the places of its joints, in the order of `XrHandJointEXT`, in the space that the palm is in.
    fn of(palm: TrackedPose, places: &[DVec3; xr::HAND_JOINT_COUNT]) -> Self {
        let [thumb, fingers @ ..] = FINGERS.map(joint);
        let across = palm.rotation * DVec3::X;
        let bent = fingers.map(|first| {
            // Metacarpal, proximal, intermediate, distal, tip.
            let bones = bones::<4>(places, first);
            [0, 1, 2].map(|at| bend(bones[at], bones[at + 1], across))
        });
        let [index, middle, ring, little] = bent;
        let of_fist = [middle, ring, little].map(|bends| share(bends.iter().sum(), GRASP));
        let tip = |first: xr::HandJoint| places[joint(first)];
        let apart = tip(xr::HandJoint::THUMB_TIP).distance(tip(xr::HandJoint::INDEX_TIP));
        Self {
            palm,
            bends: [
                index,
                middle,
                ring,
                little,
                thumb_bends(palm.rotation, places, thumb),
            ],
            grasp: of_fist.iter().sum::<f64>() / 3.0,
            pinch: share(apart, PINCH),
        }
    }
}

/// The first joint of thumb, index, middle, ring and little finger.
const FINGERS: [xr::HandJoint; 5] = [
    xr::HandJoint::THUMB_METACARPAL,
    xr::HandJoint::INDEX_METACARPAL,
    xr::HandJoint::MIDDLE_METACARPAL,
    xr::HandJoint::RING_METACARPAL,
    xr::HandJoint::LITTLE_METACARPAL,
];

/// From each of a finger's joints to the next.
fn bones<const N: usize>(places: &[DVec3], first: usize) -> [DVec3; N] {
    std::array::from_fn(|at| places[first + at + 1] - places[first + at])
}

/// How far `to` is bent against `from` into the palm, whose x axis is `across` [rad].
fn bend(from: DVec3, to: DVec3, across: DVec3) -> f64 {
    let turned = from.cross(to);
    let angle = turned.length().atan2(from.dot(to));
    if turned.dot(across) > 0.0 {
        -angle
    } else {
        angle
    }
}

/// The thumb bends about an axis of its own: to whichever side, only inward.
fn thumb_bends(palm: DQuat, places: &[DVec3], first: usize) -> [f64; 3] {
    let [metacarpal, proximal, distal] = bones::<3>(places, first);
    let out_of_palm = palm * DVec3::NEG_Y;
    let down = metacarpal.normalize_or_zero().dot(out_of_palm);
    [
        down.clamp(-1.0, 1.0).asin(),
        metacarpal.angle_between(proximal),
        proximal.angle_between(distal),
    ]
}

/// How far a value has gone from the first of two to the second, from 0 to 1.
fn share(value: f64, [open, closed]: [f64; 2]) -> f64 {
    ((value - open) / (closed - open)).clamp(0.0, 1.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A right hand in its own frame: each finger of bones of 4 cm in a plane of its own, bent as given, the thumb straight out.
    fn places(bends: [f64; 3], thumb_tip: DVec3) -> [DVec3; xr::HAND_JOINT_COUNT] {
        let mut places = [DVec3::ZERO; xr::HAND_JOINT_COUNT];
        for (finger, first) in FINGERS.iter().enumerate().skip(1) {
            let first = joint(*first);
            let mut place = DVec3::new(0.02 * (finger as f64 - 3.0), 0.0, 0.0);
            let mut angle = 0.0;
            for (at, more) in [0.0, bends[0], bends[1], bends[2], 0.0]
                .into_iter()
                .enumerate()
            {
                places[first + at] = place;
                angle += more;
                place += 0.04 * DVec3::new(0.0, -f64::sin(angle), -f64::cos(angle));
            }
        }
        let thumb = joint(FINGERS[0]);
        for at in 0..4 {
            places[thumb + at] = thumb_tip * (at as f64 / 3.0);
        }
        places
    }

    /// The same hand anywhere, and its mirror image, which is a left hand.
    fn seen(bends: [f64; 3], thumb_tip: DVec3, is_left: bool) -> BareHand {
        let rotation = DQuat::from_euler(glam::EulerRot::YXZ, 0.7, -1.1, 2.0);
        let position = DVec3::new(0.3, 1.2, -0.4);
        let side = if is_left { -1.0 } else { 1.0 };
        let world = places(bends, thumb_tip)
            .map(|place| position + rotation * (place * DVec3::new(side, 1.0, 1.0)));
        let palm = TrackedPose {
            position,
            rotation,
            velocity: None,
        };
        BareHand::of(palm, &world)
    }

    const AWAY: DVec3 = DVec3::new(-0.09, 0.0, 0.0);

    #[test]
    fn bends_are_those_of_the_joints_of_either_hand() {
        let bends = [0.4, 0.9, -0.1];
        for is_left in [false, true] {
            let hand = seen(bends, AWAY, is_left);
            for finger in &hand.bends[..4] {
                let off = [0, 1, 2].map(|at| (finger[at] - bends[at]).abs());
                assert!(off.iter().all(|off| *off < 1e-9), "{finger:?}");
            }
            assert!(hand.bends[4].iter().all(|bend| bend.abs() < 1e-6));
        }
    }

    #[test]
    fn an_open_hand_and_one_at_rest_are_open_and_a_fist_is_closed() {
        assert_eq!(seen([0.1, 0.1, 0.1], AWAY, false).grasp, 0.0);
        assert!(seen([0.4, 0.5, 0.4], AWAY, true).grasp < 0.3);
        assert!(seen([1.0, 1.0, 0.6], AWAY, false).grasp > 0.7);
        assert_eq!(seen([1.6, 1.5, 1.0], AWAY, true).grasp, 1.0);
    }

    #[test]
    fn thumb_and_index_finger_pinch_by_their_distance() {
        let tip = places([0.0; 3], AWAY)[joint(xr::HandJoint::INDEX_TIP)];
        let pinch = |apart: f64| seen([0.0; 3], tip + DVec3::Y * apart, false).pinch;
        assert_eq!((pinch(0.1), pinch(0.01)), (0.0, 1.0));
        assert!((pinch(0.03) - 0.5).abs() < 1e-9);
    }
}
