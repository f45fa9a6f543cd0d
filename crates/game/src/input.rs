//! What a participant does, at one instant, as plain numbers.

use glam::{DQuat, DVec3};
use physics::Pose;
use serde::{Deserialize, Serialize};

/// How far a rotation's length may be from one before it is refused: a headset's `f32` is good to 1e-6.
const ROTATION_TOLERANCE: f64 = 1e-3;

/// Linear and angular velocity of a tracked thing.
///
/// Both in tracking space's axes; the angular one about those axes too, not about the device's own.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Velocity {
    /// Velocity of the tracked point [m/s].
    pub linear: DVec3,
    /// Angular velocity [rad/s].
    pub angular: DVec3,
}

/// Where a head or a hand is, in tracking space: x right, y up, -z forward, floor at y = 0.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Tracked {
    /// `tracking_from_device`.
    #[serde(with = "PoseNumbers")]
    pub pose: Pose,
    /// Velocities, where the device measures them.
    pub velocity: Option<Velocity>,
}

/// The serialised form of a [`Pose`]: position [m] and rotation (x, y, z, w).
#[derive(Serialize, Deserialize)]
#[serde(remote = "Pose")]
struct PoseNumbers {
    position: DVec3,
    rotation: DQuat,
}

impl Tracked {
    /// A pose without measured velocities.
    pub fn at(pose: Pose) -> Self {
        Self {
            pose,
            velocity: None,
        }
    }

    /// True when every number is finite and the rotation is one.
    pub fn is_usable(&self) -> bool {
        let velocity = self
            .velocity
            .is_none_or(|v| v.linear.is_finite() && v.angular.is_finite());
        let rotation = self.pose.rotation;
        velocity
            && self.pose.position.is_finite()
            && rotation.is_finite()
            && (rotation.length() - 1.0).abs() < ROTATION_TOLERANCE
    }
}

/// The last change of the trigger, where a device knows more of it than that it lies within a frame.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct TriggerChange {
    /// How long before the instant of the frame's poses it happened [s]; a picture is prepared ahead of its time, so this
    /// may be longer than the frame.
    pub age_s: f64,
    /// Where the hand was then.
    pub hand: Tracked,
}

impl TriggerChange {
    /// Longest age that is believed [s]: runtimes keep a shorter history, and what flies so long flies through things.
    pub const LONGEST_AGE_S: f64 = 0.2;

    /// True when the numbers can be used.
    pub fn is_usable(&self) -> bool {
        self.hand.is_usable() && (0.0..=Self::LONGEST_AGE_S).contains(&self.age_s)
    }
}

/// Everything that the game consumes in one displayed frame.
///
/// Poses are those of the instant that the frame's last physics step reaches.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Input {
    /// The head; `None` while it is not tracked.
    pub head: Option<Tracked>,
    /// The hand; `None` while it is not tracked.
    pub hand: Option<Tracked>,
    /// Trigger, from 0 (open) to 1 (closed).
    pub trigger: f64,
    /// Thumb button that walks forward.
    pub walk_forward: bool,
    /// Thumb button that walks backward.
    pub walk_back: bool,
    /// The key that stands for the Red button in the room.
    pub press_red: bool,
    /// The key that stands for the Blue button in the room.
    pub press_blue: bool,
    /// Whether presses of Red and of Blue, in the room or by key, are refused in this frame.
    #[serde(default)]
    pub locked: [bool; 2],
    /// Whether tracking space has been laid anew since the frame before: head and hand are elsewhere in it without having
    /// moved.
    #[serde(default)]
    pub recentred: bool,
    /// Whether the session is paused: the head may move, and nothing else does.
    #[serde(default)]
    pub paused: bool,
    /// A wish to be back at the start, facing the lane.
    #[serde(default)]
    pub recentre: bool,
    /// Whether the hand is a left one: it is drawn as one, and a ball lies in it as in one.
    #[serde(default)]
    pub is_left: bool,
    /// Physics steps that this frame advances.
    pub steps: u32,
    /// When the trigger last changed, if it did since the frame before and the device measured when.
    pub trigger_change: Option<TriggerChange>,
}

impl Input {
    /// Turns poses and trigger values that hold no usable number into "not tracked" and "open".
    ///
    /// Returns how many were refused. A device calls it before the journal sees the input.
    pub fn refuse_unusable(&mut self) -> u32 {
        let mut refused = 0;
        for tracked in [&mut self.head, &mut self.hand] {
            if tracked.is_some_and(|tracked| !tracked.is_usable()) {
                *tracked = None;
                refused += 1;
            }
        }
        if self
            .trigger_change
            .is_some_and(|change| !change.is_usable())
        {
            self.trigger_change = None;
            refused += 1;
        }
        if !(0.0..=1.0).contains(&self.trigger) {
            self.trigger = 0.0;
            refused += 1;
        }
        refused
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn somewhere() -> Tracked {
        let position = DVec3::new(0.1, 1.0 / 3.0, -2e-17);
        let rotation = DQuat::from_rotation_y(0.1);
        Tracked {
            pose: Pose { position, rotation },
            velocity: Some(Velocity {
                linear: DVec3::new(1e-300, f64::MIN_POSITIVE, 7.0),
                angular: DVec3::Y,
            }),
        }
    }

    #[test]
    fn numbers_round_trip_through_json() {
        let input = Input {
            head: Some(somewhere()),
            hand: Some(Tracked::at(somewhere().pose)),
            trigger: 0.1 + 0.2,
            steps: 8,
            ..Input::default()
        };
        let text = serde_json::to_string(&input).unwrap();
        assert_eq!(serde_json::from_str::<Input>(&text).unwrap(), input);
    }

    #[test]
    fn unusable_numbers_are_refused_and_counted() {
        let mut nan = somewhere();
        nan.pose.position.x = f64::NAN;
        let mut zero = somewhere();
        zero.pose.rotation = DQuat::from_xyzw(0.0, 0.0, 0.0, 0.0);
        let mut input = Input {
            head: Some(nan),
            hand: Some(zero),
            trigger: f64::NAN,
            trigger_change: Some(TriggerChange {
                age_s: -0.01,
                hand: somewhere(),
            }),
            ..Input::default()
        };
        assert_eq!(input.refuse_unusable(), 4);
        assert_eq!(input, Input::default());
        let mut good = Input {
            head: Some(somewhere()),
            ..Input::default()
        };
        assert_eq!(good.refuse_unusable(), 0);
        assert_eq!(good.head, Some(somewhere()));
    }
}
