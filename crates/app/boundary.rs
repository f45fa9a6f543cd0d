//! The device boundary: what a device says is checked here, before the journal and the game see it.

use std::fmt;

use game::{Input, Tracked, TriggerChange, Velocity};
use glam::{DQuat, DVec3};
use serde::{Deserialize, Serialize};

/// Positions [m] and velocities [m/s, rad/s] are kept to this step: a thousand times finer than any
/// tracker, and it makes a journal half as long.
const STEPS_PER_UNIT: f64 = 1e6;
/// Ages are kept to the nanosecond, which is what runtimes count in.
const AGE_STEPS: f64 = 1e9;
/// Rotations are kept to this step, far within what counts as a rotation.
const ROTATION_STEPS: f64 = 1e8;

/// How many readings were refused, by the part of the device that gave them.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Refused {
    /// Poses or velocities of the head.
    pub head: u64,
    /// Poses or velocities of the hand.
    pub hand: u64,
    /// Trigger values that are not between 0 and 1.
    pub trigger: u64,
}

impl Refused {
    /// True when nothing was refused.
    pub fn is_none(self) -> bool {
        self == Refused::default()
    }
}

impl fmt::Display for Refused {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(
            f,
            "{} of the head, {} of the hand, {} of the trigger",
            self.head, self.hand, self.trigger
        )
    }
}

/// Checks and counts; one per session.
#[derive(Debug, Default)]
pub struct Boundary {
    refused: Refused,
}

impl Boundary {
    /// Returns what the game may consume: a reading with a NaN, an infinity or a rotation that is
    /// none counts as "not tracked", a bad trigger value as "open".
    pub fn admit(&mut self, input: Input) -> Input {
        let trigger_is_good = (0.0..=1.0).contains(&input.trigger);
        self.refused.trigger += u64::from(!trigger_is_good);
        Input {
            head: admit_tracked(input.head, &mut self.refused.head),
            hand: admit_tracked(input.hand, &mut self.refused.hand),
            trigger_change: self.admit_change(input.trigger_change),
            trigger: if trigger_is_good {
                rounded(input.trigger, STEPS_PER_UNIT)
            } else {
                0.0
            },
            ..input
        }
    }

    /// A change whose hand or age is unusable counts as none: the trigger then opened at the frame's own instant.
    fn admit_change(&mut self, change: Option<TriggerChange>) -> Option<TriggerChange> {
        let change = change?;
        let hand = admit_tracked(Some(change.hand), &mut self.refused.hand)?;
        let age_s = rounded(change.age_s, AGE_STEPS);
        let change = TriggerChange { age_s, hand };
        if !change.is_usable() {
            self.refused.trigger += 1;
            return None;
        }
        Some(change)
    }

    /// What was refused so far.
    pub fn refused(&self) -> Refused {
        self.refused
    }
}

fn admit_tracked(tracked: Option<Tracked>, refused: &mut u64) -> Option<Tracked> {
    let mut tracked = tracked?;
    if !tracked.is_usable() {
        *refused += 1;
        return None;
    }
    tracked.pose.position = rounded_vector(tracked.pose.position);
    let [x, y, z, w] = tracked
        .pose
        .rotation
        .normalize()
        .to_array()
        .map(|part| rounded(part, ROTATION_STEPS));
    tracked.pose.rotation = DQuat::from_xyzw(x, y, z, w);
    tracked.velocity = tracked.velocity.map(|velocity| Velocity {
        linear: rounded_vector(velocity.linear),
        angular: rounded_vector(velocity.angular),
    });
    Some(tracked)
}

fn rounded_vector(vector: DVec3) -> DVec3 {
    DVec3::from_array(vector.to_array().map(|part| rounded(part, STEPS_PER_UNIT)))
}

/// Rounds without a library's `round`, and turns -0 into 0, so that a journal shows no `-0.0`.
fn rounded(value: f64, steps: f64) -> f64 {
    (value * steps).round() / steps + 0.0
}

#[cfg(test)]
mod tests {
    use super::*;
    use physics::Pose;

    fn hand_at(position: DVec3, rotation: DQuat) -> Input {
        Input {
            hand: Some(Tracked::at(Pose { position, rotation })),
            trigger: 0.5,
            ..Input::default()
        }
    }

    #[test]
    fn admit_refuses_nan_infinity_and_a_rotation_that_is_none() {
        let bad = [
            hand_at(DVec3::new(0.0, f64::NAN, 0.0), DQuat::IDENTITY),
            hand_at(DVec3::new(f64::INFINITY, 0.0, 0.0), DQuat::IDENTITY),
            hand_at(DVec3::ZERO, DQuat::from_xyzw(0.0, 0.0, 0.0, 0.0)),
            hand_at(DVec3::ZERO, DQuat::from_xyzw(0.0, 0.0, 0.0, 2.0)),
        ];
        let mut boundary = Boundary::default();
        for input in bad {
            assert_eq!(boundary.admit(input).hand, None);
        }
        assert_eq!(
            boundary.refused(),
            Refused {
                hand: 4,
                ..Refused::default()
            }
        );
    }

    #[test]
    fn admit_refuses_a_velocity_that_is_not_a_number() {
        let mut input = hand_at(DVec3::Y, DQuat::IDENTITY);
        let hand = input.hand.as_mut().expect("set above");
        hand.velocity = Some(Velocity {
            linear: DVec3::NAN,
            angular: DVec3::ZERO,
        });
        let mut boundary = Boundary::default();
        assert_eq!(boundary.admit(input).hand, None);
        assert_eq!(boundary.refused().hand, 1);
    }

    #[test]
    fn admit_keeps_a_good_reading_to_a_micrometre() {
        let position = DVec3::new(0.123_456_789, 1.0 / 3.0, -4.5);
        let mut boundary = Boundary::default();
        let admitted = boundary.admit(hand_at(position, DQuat::from_rotation_x(0.7)));
        let pose = admitted.hand.expect("a good reading").pose;
        assert!(
            pose.position.abs_diff_eq(position, 0.5e-6 + 1e-12),
            "{}",
            pose.position
        );
        assert!((pose.rotation.length() - 1.0).abs() < 2e-8);
        assert!(boundary.refused().is_none());
        assert_eq!(
            boundary.admit(admitted),
            admitted,
            "admitting twice changes nothing"
        );
    }

    #[test]
    fn admit_opens_a_trigger_out_of_range() {
        let mut boundary = Boundary::default();
        let input = Input {
            trigger: 1.5,
            ..Input::default()
        };
        assert_eq!(boundary.admit(input).trigger, 0.0);
        assert_eq!(boundary.refused().trigger, 1);
    }
}
