//! Our side of the comparison: a rack, a ball that rolls towards it, under each model.

use glam::DVec3;
use physics::{Effect, Effects, Motion, PairContact, Response, Settings, World};

use crate::support::{BALL_RADIUS, alley, composite_pin, material, throw};

/// Speed of the ball [m/s].
pub const SPEED: f64 = 8.0;
/// Where it begins before the head pin [m].
pub const START: f64 = 2.0;
/// Simulated time of a throw [s].
pub const DURATION: u32 = 4;
/// Throws of a round, each from another offset.
pub const THROWS: u32 = 16;
/// Step rates [1/s]: a headset's frames, and the game's own steps.
pub const RATES: [u32; 2] = [90, 720];
/// The models with their names.
pub const MODELS: [(&str, Response); 3] = [
    ("uno_slater", Response::UnoSlater),
    ("guarded", Response::Guarded),
    ("coulomb", Response::Coulomb),
];
/// Coefficients of every pair under Coulomb's law, ours and the peer's.
pub const PAIR: PairContact = PairContact {
    restitution: 0.5,
    friction: 0.2,
};

/// Where throw `i` begins, beside the lane's middle [m].
pub fn offset(i: u32) -> f64 {
    0.012 * f64::from(i) - 0.09
}

fn settings(response: Response, rate: u32, sleeping: bool) -> Settings {
    Settings {
        step_hz: f64::from(rate),
        response,
        effects: Effects::default().set(Effect::Sleeping, sleeping),
        contact: PAIR,
        ..Settings::default()
    }
}

/// A rack, and no ball.
pub fn rack(response: Response, rate: u32, sleeping: bool) -> World {
    let settings = settings(response, rate, sleeping);
    alley(settings, &composite_pin(), material(0.7, 0.7)).0
}

/// Throw `i`, about to begin.
pub fn shot(response: Response, rate: u32, i: u32) -> World {
    let mut world = rack(response, rate, true);
    throw(&mut world, material(0.7, 0.7), offset(i), START, SPEED);
    world
}

/// Takes `steps` steps; a profiler finds them by this name.
#[inline(never)]
pub fn counted_steps(world: &mut World, steps: u32) {
    for _ in 0..steps {
        world.step();
    }
}

/// Number of bodies that stand lower or lean further than a standing pin does: those that a throw has felled.
pub fn fallen(world: &World) -> usize {
    let is_down = |position: DVec3, axis: DVec3| axis.y < 0.9 || position.y < BALL_RADIUS;
    let pins = world.ids().filter(|id| {
        let mass = world.body(*id).mass().mass;
        let body = world.body(*id);
        body.motion() == Motion::Dynamic
            && mass < 2.0
            && is_down(body.pose().position, body.pose().rotation * DVec3::Y)
    });
    pins.count()
}

/// Number of bodies that move by themselves and are not asleep.
pub fn awake(world: &World) -> usize {
    let awake = world.ids().filter(|id| {
        let body = world.body(*id);
        body.motion() == Motion::Dynamic && !body.is_asleep()
    });
    awake.count()
}
