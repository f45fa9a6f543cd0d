//! A ball that is let slide until it rolls: its place in closed form, by integration, and in the world.

use glam::DVec3;
use physics::Response;

use crate::hard_cases::scene::{BALL_RADIUS, G, Setup};

/// Simulated time [s].
pub const DURATION: f64 = 2.0;
/// Speed at the beginning [m/s], without any spin.
const SPEED: f64 = 8.0;
/// Coulomb's coefficient: a dry lane's; it rolls after 1.1 s.
const COEFFICIENT: f64 = 0.2;
/// The paper's friction rate: the slip halves 1.2 times in its reference time of 1/60 s.
const RATE: f64 = 0.02;
/// Time in which a rate takes its share [s].
const REFERENCE: f64 = 1.0 / 60.0;
/// Steps of the integration.
const STEPS: u32 = 2_000_000;

/// Mass over inertia of the bowling ball, times its radius squared.
fn share() -> f64 {
    let setup = Setup::new(Response::Guarded);
    let mass = setup.bowling_ball(DVec3::ZERO).mass;
    mass.mass * BALL_RADIUS * BALL_RADIUS / mass.inertia.x
}

/// Distance after the whole time [m], from the equation of motion.
///
/// Coulomb: the slip falls by `mu g (1 + m r2 / I)` a second until it is none. A rate: the slip falls exponentially.
pub fn place(response: Response) -> f64 {
    let t = DURATION;
    if response == Response::Coulomb {
        let brake = COEFFICIENT * G;
        let rolls = (SPEED / (brake * (1.0 + share()))).min(t);
        let after = SPEED - brake * rolls;
        SPEED * rolls - 0.5 * brake * rolls * rolls + after * (t - rolls)
    } else {
        let fall = -libm::log(1.0 - RATE) / REFERENCE;
        let lost = SPEED / (1.0 + share());
        SPEED * t - lost * (t - (1.0 - libm::exp(-fall * t)) / fall)
    }
}

/// The same distance [m] by the midpoint rule.
pub fn integrated(response: Response) -> f64 {
    let dt = DURATION / f64::from(STEPS);
    let fall = -libm::log(1.0 - RATE) / REFERENCE;
    // What slows the centre at this slip [m/s2].
    let brake = |slip: f64| match response {
        Response::Coulomb if slip > 0.0 => COEFFICIENT * G,
        Response::Coulomb => 0.0,
        _ => slip * fall / (1.0 + share()),
    };
    let turn = 1.0 + share();
    let (mut x, mut v, mut slip) = (0.0, SPEED, SPEED);
    for _ in 0..STEPS {
        let half = slip - 0.5 * dt * brake(slip) * turn;
        let slowing = brake(half);
        x += (v - 0.5 * dt * slowing) * dt;
        v -= dt * slowing;
        slip -= dt * slowing * turn;
    }
    x
}

/// The same distance [m] in a world.
pub fn simulated(response: Response, hz: f64) -> f64 {
    let friction = if response == Response::Coulomb {
        COEFFICIENT
    } else {
        RATE
    };
    let setup = Setup::new(response).rate(hz).contact(0.0, friction);
    let mut world = setup.world();
    world.add(setup.floor());
    let mut def = setup.bowling_ball(DVec3::Y * BALL_RADIUS);
    def.linear_velocity = DVec3::X * SPEED;
    let ball = world.add(def);
    for _ in 0..(DURATION * hz).round() as u64 {
        world.step();
    }
    world.body(ball).pose().position.x
}
