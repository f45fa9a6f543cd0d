//! Throws into a whole rack: no step may raise the energy, for nothing in these scenes does work.

mod support;

use physics::{PairContact, Response, Settings};
use support::*;

/// Largest part of the start's energy by which a step may raise it.
const RISE: f64 = 1e-5;
/// Elasticities and friction rates that are combined.
const VALUES: [f64; 4] = [0.0, 0.49, 0.7, 1.0];

#[test]
fn no_step_of_a_shot_raises_the_energy_from_one_side_of_the_deck_to_the_other() {
    for i in 0..24 {
        throw_with_all_elasticities(i, -0.46 + 0.04 * i as f64);
    }
}

#[test]
fn no_step_of_a_shot_raises_the_energy_close_about_the_head_pin() {
    for i in 0..20 {
        throw_with_all_elasticities(i, -0.13 + 0.01 * i as f64);
    }
}

/// Four throws `offset` metres beside the middle; friction rates, pins and laws go round with `i`.
fn throw_with_all_elasticities(i: usize, offset: f64) {
    let pins = [composite_pin(), ellipsoid_pin()];
    for (j, elasticity) in VALUES.into_iter().enumerate() {
        let m = material(elasticity, VALUES[(i + j) % 4]);
        let step_hz = [720.0, 90.0][(i + j) % 2];
        let settings = Settings {
            step_hz,
            response: [Response::Guarded, Response::UnoSlater, Response::Coulomb][(i / 4) % 3],
            contact: PairContact {
                restitution: elasticity,
                friction: VALUES[(i + j) % 4],
            },
            ..Settings::default()
        };
        let (mut world, ids) = alley(settings, &pins[(i + j / 2) % 2], m);
        let ball = throw(&mut world, m, offset, 2.0, 8.0);
        let start = world.energy();
        let mut before = start;
        for _ in 0..step_hz as u32 * 4 {
            world.step();
            let now = world.energy();
            assert!(
                now - before < RISE * start,
                "{offset} m beside the middle, {m:?}, {:?}: {} J more in step {}",
                settings.response,
                now - before,
                world.steps()
            );
            before = now;
        }
        assert!(before.is_finite() && world.body(ball).pose().is_finite());
        assert!(ids.iter().any(|id| tilt(&world, *id) > 30.0));
    }
}
