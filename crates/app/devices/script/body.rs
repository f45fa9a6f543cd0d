//! Where the scripted participant's body, head and hand are, in tracking space.

use game::{Tracked, Velocity};
use glam::{DQuat, DVec2, DVec3};
use physics::Pose;

use super::swing::wrapped;

/// Fastest turn on the spot [rad/s]: a person looks round in a second and a half.
const TURN_RATE: f64 = 2.0;
/// Fastest small step in the room [m/s].
const STEP_SPEED: f64 = 0.5;
/// Fastest bending of the knees [m/s].
const BEND_SPEED: f64 = 0.5;
/// Fastest nod [rad/s].
const NOD_RATE: f64 = 1.5;
/// The eyes are this far before the neck's axis [m].
const EYES_BEFORE_NECK: f64 = 0.08;

/// The hand in the body frame: origin on the floor below the body, x right, y up, -z ahead.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct HandState {
    /// Middle of the hand [m].
    pub position: DVec3,
    /// `body_from_hand`.
    pub rotation: DQuat,
    /// Velocity of the middle of the hand [m/s].
    pub linear: DVec3,
    /// Angular velocity about the body's axes [rad/s].
    pub angular: DVec3,
}

impl HandState {
    /// A hand at rest.
    pub fn still(position: DVec3, rotation: DQuat) -> Self {
        HandState {
            position,
            rotation,
            linear: DVec3::ZERO,
            angular: DVec3::ZERO,
        }
    }
}

/// The body; moved once per frame, with its velocities over that frame.
#[derive(Debug, Clone)]
pub struct Body {
    /// Height of the eyes when standing upright [m].
    pub eye_height: f64,
    /// Ground point (x, z) in tracking space [m].
    pub position: DVec2,
    /// Turn to the left from facing -z [rad].
    pub yaw: f64,
    /// How far the knees are bent: the eyes' drop [m].
    pub bend: f64,
    /// Downward angle of the gaze [rad].
    pub nod: f64,
    velocity: DVec2,
    yaw_rate: f64,
    bend_rate: f64,
    nod_rate: f64,
}

impl Body {
    /// Upright in the middle of the tracking space, facing -z.
    pub fn upright(eye_height: f64) -> Self {
        Body {
            eye_height,
            position: DVec2::ZERO,
            yaw: 0.0,
            bend: 0.0,
            nod: 0.0,
            velocity: DVec2::ZERO,
            yaw_rate: 0.0,
            bend_rate: 0.0,
            nod_rate: 0.0,
        }
    }

    /// Moves towards `goal` for one frame of `dt` [s]; true once it is there.
    pub fn approach(&mut self, goal: &Stance, dt: f64) -> bool {
        let way = goal.position - self.position;
        self.velocity = way.clamp_length_max(STEP_SPEED * dt) / dt;
        self.yaw_rate = approach_rate(wrapped(goal.yaw - self.yaw), TURN_RATE, dt);
        self.bend_rate = approach_rate(goal.bend - self.bend, BEND_SPEED, dt);
        self.nod_rate = approach_rate(goal.nod - self.nod, NOD_RATE, dt);
        self.position += self.velocity * dt;
        self.yaw = wrapped(self.yaw + self.yaw_rate * dt);
        self.bend += self.bend_rate * dt;
        self.nod += self.nod_rate * dt;
        self.position.abs_diff_eq(goal.position, 1e-4)
            && wrapped(goal.yaw - self.yaw).abs() < 1e-4
            && (goal.bend - self.bend).abs() < 1e-4
    }

    /// `tracking_from_body`.
    pub fn pose(&self) -> Pose {
        Pose {
            position: DVec3::new(self.position.x, 0.0, self.position.y),
            rotation: DQuat::from_rotation_y(self.yaw),
        }
    }

    /// The head, as a headset reports it.
    pub fn head(&self, with_velocity: bool) -> Tracked {
        let nod = DQuat::from_rotation_x(-self.nod);
        let eyes = HandState {
            position: DVec3::new(0.0, self.eye_height - self.bend, 0.0)
                + nod * DVec3::new(0.0, 0.0, -EYES_BEFORE_NECK),
            rotation: nod,
            linear: DVec3::new(0.0, -self.bend_rate, 0.0)
                + DVec3::new(-self.nod_rate, 0.0, 0.0)
                    .cross(nod * DVec3::new(0.0, 0.0, -EYES_BEFORE_NECK)),
            angular: DVec3::new(-self.nod_rate, 0.0, 0.0),
        };
        self.tracked(&eyes, with_velocity)
    }

    /// Something given in the body frame, as a headset reports it in tracking space.
    pub fn tracked(&self, hand: &HandState, with_velocity: bool) -> Tracked {
        let body = self.pose();
        let lever = body.rotation * hand.position;
        let spin = DVec3::Y * self.yaw_rate;
        let walk = DVec3::new(self.velocity.x, 0.0, self.velocity.y);
        Tracked {
            pose: Pose {
                position: body.position + lever,
                rotation: body.rotation * hand.rotation,
            },
            velocity: with_velocity.then(|| Velocity {
                linear: walk + spin.cross(lever) + body.rotation * hand.linear,
                angular: spin + body.rotation * hand.angular,
            }),
        }
    }
}

/// What the body moves towards.
#[derive(Debug, Clone, Copy)]
pub struct Stance {
    /// Ground point (x, z) in tracking space [m].
    pub position: DVec2,
    /// Turn to the left from facing -z [rad].
    pub yaw: f64,
    /// The eyes' drop by bent knees [m].
    pub bend: f64,
    /// Downward angle of the gaze [rad].
    pub nod: f64,
}

/// Rate that covers `way` in one frame, but no faster than `limit`.
fn approach_rate(way: f64, limit: f64, dt: f64) -> f64 {
    (way / dt).clamp(-limit, limit)
}

/// Yaw that faces along `direction` (x, z).
pub fn yaw_towards(direction: DVec2) -> f64 {
    libm::atan2(-direction.x, -direction.y)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn yaw_towards_turns_the_front_into_the_direction() {
        for direction in [
            DVec2::new(0.0, -1.0),
            DVec2::new(1.0, 0.0),
            DVec2::new(-0.6, 0.8),
        ] {
            let front = DQuat::from_rotation_y(yaw_towards(direction)) * DVec3::NEG_Z;
            assert!(
                front.abs_diff_eq(DVec3::new(direction.x, 0.0, direction.y), 1e-12),
                "{front}"
            );
        }
    }

    #[test]
    fn tracked_velocities_are_the_derivatives_of_the_pose() {
        let dt = 1e-4;
        let mut body = Body::upright(1.6);
        let goal = Stance {
            position: DVec2::new(1.0, -2.0),
            yaw: 1.0,
            bend: 0.3,
            nod: 0.5,
        };
        let hand = HandState::still(DVec3::new(0.3, 1.0, -0.4), DQuat::from_rotation_x(0.5));
        body.approach(&goal, dt);
        let (head_before, hand_before) = (body.head(true).pose, body.tracked(&hand, true).pose);
        body.approach(&goal, dt);
        for (before, now) in [
            (head_before, body.head(true)),
            (hand_before, body.tracked(&hand, true)),
        ] {
            let velocity = now.velocity.expect("asked for");
            // A backward difference is off by half a step times the acceleration, about 2e-4.
            let linear = (now.pose.position - before.position) / dt;
            assert!(
                linear.abs_diff_eq(velocity.linear, 1e-3),
                "{linear} {}",
                velocity.linear
            );
            let angular = (now.pose.rotation * before.rotation.inverse()).to_scaled_axis() / dt;
            assert!(
                angular.abs_diff_eq(velocity.angular, 1e-3),
                "{angular} {}",
                velocity.angular
            );
        }
    }

    #[test]
    fn approach_arrives_and_then_stands_still() {
        let mut body = Body::upright(1.6);
        let goal = Stance {
            position: DVec2::new(0.1, 0.0),
            yaw: -0.2,
            bend: 0.1,
            nod: 0.1,
        };
        let frames = (0..100).take_while(|_| !body.approach(&goal, 0.01)).count();
        assert!((10..60).contains(&frames), "{frames}");
        body.approach(&goal, 0.01);
        assert!(body.head(true).velocity.expect("asked for").linear.length() < 1e-9);
    }
}
