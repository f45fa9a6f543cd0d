//! Standing, falling and sleeping.

mod support;

use glam::{DQuat, DVec3};
use physics::{Effect, Effects, PairContact, Pose, Response, Settings, World};
use support::*;

#[test]
fn a_rack_stands_awake_for_a_minute() {
    for pins in [composite_pin(), ellipsoid_pin()] {
        for (e, mu) in [(0.7, 0.7), (1.0, 0.0), (0.7, 0.0), (1.0, 1.0), (0.0, 0.7)] {
            for response in [Response::UnoSlater, Response::Guarded, Response::Coulomb] {
                let settings = Settings {
                    effects: Effects::default().without(Effect::Sleeping),
                    response,
                    contact: PairContact {
                        restitution: e,
                        friction: mu,
                    },
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

#[test]
fn a_pin_that_circles_on_its_edge_comes_to_stand_where_there_is_friction() {
    for (friction_rate, stands) in [(0.7, true), (0.0, false)] {
        for shape in [composite_pin(), ellipsoid_pin()] {
            let m = material(0.7, friction_rate);
            let mut world = World::new(Settings::default()).expect("default settings run");
            world.add(block(
                m,
                DVec3::new(-2.0, -1.0, -2.0),
                DVec3::new(2.0, 0.0, 2.0),
            ));
            let mut def = pin(&shape, m, DVec3::ZERO);
            // Leaning on its edge, and turning about the line from there through its centre: no slip anywhere.
            let (lean, edge) = (0.042f64, DVec3::X * BASE_RADIUS);
            let rotation = DQuat::from_rotation_z(-lean);
            let arm = rotation * (DVec3::Y * PIN_CG - edge);
            def.pose = Pose::new(arm + edge, rotation);
            def.angular_velocity = arm / arm.length() * 5.5;
            let id = world.add(def);
            for _ in 0..720 * 4 {
                world.step();
            }
            let turning = world.body(id).angular_velocity().length();
            assert_eq!(turning < 0.3, stands, "{turning} rad/s after 4 s");
            assert!(tilt(&world, id) < 8.0);
        }
    }
}
