//! The small things that a scripted participant does one after the other.

use glam::{DQuat, DVec2, DVec3};

use super::body::HandState;
use super::swing::{Swing, minimum_jerk};

/// One thing to do; the next begins when it is done.
#[derive(Debug, Clone)]
pub enum Action {
    /// Walk to a point (x, z) of the world with the thumb button, facing it.
    Walk(DVec2),
    /// Walk backward with the other thumb button, this far [m].
    BackOff(f64),
    /// Take small steps to a point (x, z) of the world and face along a yaw in the world [rad].
    Stand(DVec2, f64),
    /// Bend the knees, so that the eyes drop this far [m].
    Bend(f64),
    /// Look at a point of the world.
    Look(DVec3),
    /// Bring the hand somewhere, at rest at both ends.
    Reach(HandGoal, f64),
    /// Bring the trigger to a value within a time [s].
    Trigger(f64, f64),
    /// Throw: the swing, and the time at which the trigger falls below its opening value [s].
    Throw(Box<Swing>, f64),
    /// Do nothing for a time [s].
    Wait(f64),
}

/// Where a reach ends.
#[derive(Debug, Clone, Copy)]
pub enum HandGoal {
    /// In the body frame.
    Body(DVec3, DQuat),
    /// A point of the world, with the rotation in the body frame.
    World(DVec3, DQuat),
}

/// A reach under way, in the body frame.
#[derive(Debug, Clone, Copy)]
pub struct Reach {
    from: HandState,
    to: HandState,
    duration: f64,
}

impl Reach {
    /// From where the hand is to `to`, in `duration` [s].
    pub fn new(from: HandState, to: HandState, duration: f64) -> Self {
        Reach { from, to, duration }
    }

    /// The hand at `time` [s] after the start.
    pub fn hand(&self, time: f64) -> HandState {
        let (part, rate) = minimum_jerk(time / self.duration);
        let way = self.to.position - self.from.position;
        let turn = (self.to.rotation * self.from.rotation.inverse()).to_scaled_axis();
        // The long way round would be the other sign of the same rotation.
        let turn = if turn.length() > std::f64::consts::PI {
            turn * (1.0 - std::f64::consts::TAU / turn.length())
        } else {
            turn
        };
        HandState {
            position: self.from.position + way * part,
            rotation: DQuat::from_scaled_axis(turn * part) * self.from.rotation,
            linear: way * (rate / self.duration),
            angular: turn * (rate / self.duration),
        }
    }

    /// True when the hand has arrived.
    pub fn is_over(&self, time: f64) -> bool {
        time >= self.duration
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn reach_ends_at_its_goal_and_at_rest() {
        let from = HandState::still(DVec3::ZERO, DQuat::from_rotation_y(3.0));
        let to = HandState::still(DVec3::new(0.3, 0.1, -0.2), DQuat::from_rotation_x(-2.0));
        let end = Reach::new(from, to, 0.7).hand(0.7);
        assert!(end.position.abs_diff_eq(to.position, 1e-12));
        assert!(end.rotation.dot(to.rotation).abs() > 1.0 - 1e-12);
        assert_eq!((end.linear, end.angular), (DVec3::ZERO, DVec3::ZERO));
    }

    #[test]
    fn reach_velocities_are_the_derivatives_of_its_pose() {
        let from = HandState::still(DVec3::ZERO, DQuat::from_rotation_y(3.0));
        let to = HandState::still(DVec3::new(0.3, 0.1, -0.2), DQuat::from_rotation_x(-2.0));
        let reach = Reach::new(from, to, 0.7);
        let step = 1e-5;
        for time in [0.1, 0.35, 0.6] {
            let (before, now, after) = (
                reach.hand(time - step),
                reach.hand(time),
                reach.hand(time + step),
            );
            let linear = (after.position - before.position) / (2.0 * step);
            assert!(linear.abs_diff_eq(now.linear, 1e-7), "{linear}");
            let turn = (after.rotation * before.rotation.inverse()).to_scaled_axis() / (2.0 * step);
            assert!(
                turn.abs_diff_eq(now.angular, 1e-6),
                "{turn} {}",
                now.angular
            );
        }
    }
}
