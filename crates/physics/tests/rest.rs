//! Standing, falling and sleeping.

mod support;

use glam::DVec3;
use physics::{Response, Settings};
use support::*;

#[test]
fn a_rack_stands_awake_for_a_minute() {
    for pins in [composite_pin(), ellipsoid_pin()] {
        for (e, mu) in [(0.7, 0.7), (1.0, 0.0), (0.7, 0.0), (1.0, 1.0), (0.0, 0.7)] {
            for response in [Response::UnoSlater, Response::Guarded] {
                let settings = Settings {
                    sleeping: false,
                    response,
                    ..Settings::default()
                };
                let (mut world, ids) = alley(settings, &pins, material(e, mu));
                let start: Vec<DVec3> = ids
                    .iter()
                    .map(|id| world.body(*id).pose().position)
                    .collect();
                for _ in 0..60 * 720 {
                    world.step();
                }
                for (id, from) in ids.iter().zip(start) {
                    let drift = (world.body(*id).pose().position - from).length();
                    assert!(drift < 1e-6, "drift {drift} at {e} {mu} {response:?}");
                    assert!(tilt(&world, *id) < 1e-4);
                }
            }
        }
    }
}
