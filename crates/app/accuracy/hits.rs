//! First hits of a ball on a pin in empty space, and what they must come to by a calculation of its own.

use std::sync::Arc;

use glam::{DMat3, DVec3};
use physics::{BodyId, Compound, Effect, Effects, Response, Settings, World};

use super::profile::Profile;
use crate::hard_cases::scene::{BALL_RADIUS, PIN, Setup, between};
use crate::shot::clock::thread_seconds;
use experiment::random::SplitMix64;

const SEED: u64 = 8;
/// Mass of the ball [kg].
const BALL_MASS: f64 = 6.803886;
/// Restitution of the hits; they are frictionless, so that one line of algebra answers them.
const RESTITUTION: f64 = 0.65;
/// Time in which every hit has happened [s].
const DURATION: f64 = 0.12;

/// A ball on its way to a pin at the origin.
#[derive(Clone, Copy, Debug)]
pub struct Throw {
    /// Where the ball begins [m].
    pub from: DVec3,
    /// Its velocity [m/s].
    pub velocity: DVec3,
}

/// Velocities of the pin just after, linear [m/s] and angular [rad/s].
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct After {
    /// Of its centre of mass.
    pub linear: DVec3,
    /// About it.
    pub angular: DVec3,
}

/// Throw `index`: against any height of the pin, up to grazing, so that the hit falls anywhere in a step.
pub fn throw(index: usize) -> Throw {
    let mut random = SplitMix64::for_index(SEED, index as u64);
    let random = &mut random;
    let height = between(random, -0.13, 0.22);
    let aside = between(random, -0.12, 0.12);
    let back = between(random, 0.3, 0.6);
    Throw {
        from: DVec3::new(aside, height, back),
        velocity: DVec3::new(0.0, 0.0, -between(random, 6.0, 9.0)),
    }
}

/// What the pin must have got, from the profile in its half-plane and the impulse without friction.
///
/// The ball is brought nearer by its distance again and again, which cannot pass the first touch.
pub fn expected(profile: &Profile, throw: &Throw) -> Option<After> {
    let direction = throw.velocity / throw.velocity.length();
    let (mut centre, mut way) = (throw.from, 0.0);
    for _ in 0..20_000 {
        let nearest = profile.nearest(centre);
        let gap = nearest.distance - BALL_RADIUS;
        if gap < 1e-13 {
            let normal = (nearest.point - centre) / nearest.distance;
            return Some(frictionless(nearest.point, normal, throw.velocity));
        }
        way += gap;
        centre = throw.from + direction * way;
        if way > 2.0 {
            return None;
        }
    }
    None
}

/// Newton's restitution without friction: an impulse along the normal through the ball's centre.
fn frictionless(point: DVec3, normal: DVec3, velocity: DVec3) -> After {
    let turn = point.cross(normal) / PIN.inertia;
    let yielding = 1.0 / BALL_MASS + 1.0 / PIN.mass + turn.cross(point).dot(normal);
    let impulse = (1.0 + RESTITUTION) * velocity.dot(normal) / yielding;
    After {
        linear: normal * (impulse / PIN.mass),
        angular: turn * impulse,
    }
}

/// How hits are simulated.
#[derive(Clone, Copy, Debug)]
pub struct How {
    /// Law of impacts.
    pub response: Response,
    /// Steps a second [1/s].
    pub step_hz: f64,
    /// Whether contacts are found inside a step.
    pub is_continuous: bool,
}

/// An empty world in which these hits happen, and the pin in it.
pub fn world(how: How, pin: &Arc<Compound>) -> (World, BodyId) {
    let setup = Setup::new(how.response).weightless().rate(how.step_hz);
    let setup = setup.contact(RESTITUTION, 0.0);
    let template = setup.world();
    let effects = Effects::default().without(Effect::Sleeping);
    let mut world = World::new(Settings {
        effects: effects.set(Effect::Continuous, how.is_continuous),
        ..*template.settings()
    })
    .expect("a scene that runs with one effect runs without it");
    let mut def = setup.pin(pin, DVec3::ZERO);
    def.pose.position = DVec3::ZERO;
    let id = world.add(def);
    (world, id)
}

/// What the pin got in the first touch, if there was one, and the processor time of the whole [s].
pub fn simulated(world: &World, pin: BodyId, how: How, throw: &Throw) -> (Option<After>, f64) {
    let setup = Setup::new(how.response).contact(RESTITUTION, 0.0);
    let mut world = world.clone();
    let mut def = setup.bowling_ball(throw.from);
    def.linear_velocity = throw.velocity;
    world.add(def);
    let begun = thread_seconds();
    let mut after = None;
    for _ in 0..(DURATION * how.step_hz).ceil() as u64 {
        let pose = world.body(pin).pose();
        world.step();
        if after.is_none()
            && let Some(impact) = world.impacts().first()
        {
            let impulse = if impact.a == pin {
                impact.impulse
            } else {
                -impact.impulse
            };
            let turned = DMat3::from_quat(pose.rotation);
            let arm = impact.point - pose.position;
            let local = turned.transpose() * arm.cross(impulse) / PIN.inertia;
            after = Some(After {
                linear: impulse / PIN.mass,
                angular: turned * local,
            });
        }
    }
    (after, thread_seconds() - begun)
}

/// How far two answers are apart, linear [m/s] and angular [rad/s]; a hit that is missed leaves the pin at rest.
pub fn difference(a: Option<After>, b: Option<After>) -> [f64; 2] {
    let (a, b) = (a.unwrap_or_default(), b.unwrap_or_default());
    [
        (a.linear - b.linear).length(),
        (a.angular - b.angular).length(),
    ]
}

/// Simulated time of a hit [s].
pub const HIT_S: f64 = DURATION;
