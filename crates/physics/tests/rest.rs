//! Standing, falling and sleeping.
#![allow(
    clippy::disallowed_methods,
    reason = "what is expected may come from any library"
)]

mod support;

use std::sync::Arc;

use glam::{DQuat, DVec3};
use physics::{
    BodyId, Compound, Effect, Effects, PairContact, Pose, Response, Settings, Shape, World,
};
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

const LAWS: [Response; 3] = [Response::UnoSlater, Response::Guarded, Response::Coulomb];

/// A rack that never sleeps.
fn awake_rack(
    response: Response,
    step_hz: f64,
    (e, mu): (f64, f64),
    shape: &Arc<Compound>,
) -> (World, Vec<BodyId>) {
    let settings = Settings {
        effects: Effects::default().without(Effect::Sleeping),
        response,
        step_hz,
        contact: PairContact {
            restitution: e,
            friction: mu,
        },
        ..Settings::default()
    };
    alley(settings, shape, material(e, mu))
}

/// Runs for so many seconds; the farthest that a body strays from where it was [m], and its greatest tilt [degrees].
fn watch(world: &mut World, ids: &[BodyId], seconds: f64) -> (f64, f64) {
    let start: Vec<DVec3> = ids
        .iter()
        .map(|id| world.body(*id).pose().position)
        .collect();
    let (mut drift, mut lean) = (0.0_f64, 0.0_f64);
    let end = world.time() + seconds;
    while world.time() < end {
        world.step();
        for (id, from) in ids.iter().zip(&start) {
            drift = drift.max((world.body(*id).pose().position - from).length());
            lean = lean.max(tilt(world, *id));
        }
    }
    (drift, lean)
}

/// A pin with a base of so many corners: a hull of rings through the outline of the composite one.
fn hull_pin(corners: u32) -> Arc<Compound> {
    let rings = [
        (0.0, BASE_RADIUS),
        (0.019, 0.0359),
        (0.1143, 0.0605),
        (0.219, 0.0314),
        (0.381, 0.01),
    ];
    let ring = |(height, radius): (f64, f64)| {
        (0..corners).map(move |k| {
            let angle = std::f64::consts::TAU * f64::from(k) / f64::from(corners);
            DVec3::new(radius * angle.cos(), height - PIN_CG, radius * angle.sin())
        })
    };
    let points: Vec<DVec3> = rings.into_iter().flat_map(ring).collect();
    Arc::new(Compound::single(
        Shape::cloud(&points).expect("the rings span a body"),
    ))
}

#[test]
fn pins_that_are_hulls_stand_awake_under_every_law() {
    for response in LAWS {
        for (corners, step_hz) in [(8, 60.0), (12, 90.0), (24, 240.0), (32, 720.0)] {
            let shape = hull_pin(corners);
            let (mut world, ids) = awake_rack(response, step_hz, (0.49, 0.49), &shape);
            let (drift, lean) = watch(&mut world, &ids, 20.0);
            let what = format!("{corners} corners, {response:?}, {step_hz} Hz");
            assert_eq!(drift, 0.0, "{what}");
            assert!(lean <= 1e-3, "tilt {lean} degrees, {what}");
        }
    }
}

#[test]
fn a_nudged_rack_that_has_settled_stands_for_minutes() {
    let rates = [60.0, 90.0, 240.0];
    for (response, step_hz) in LAWS.into_iter().flat_map(|law| rates.map(|hz| (law, hz))) {
        for (shape, e, mu) in [
            (composite_pin(), 0.49, 0.49),
            (ellipsoid_pin(), 0.0, 0.7),
            (composite_pin(), 0.7, 1.0),
        ] {
            let (mut world, ids) = awake_rack(response, step_hz, (e, mu), &shape);
            let mut random = Random(0x6e75_6467_6531);
            for id in &ids {
                // At most half of what tips a pin over.
                let turn = random.vector() * DVec3::new(0.3, 0.9, 0.3);
                let slide = random.vector() * DVec3::new(0.05, 0.0, 0.05);
                world.set_velocity(*id, slide, turn);
            }
            let (moved, _) = watch(&mut world, &ids, 20.0);
            assert!(moved > 1e-4, "the nudge does nothing: {moved} m");
            let (drift, lean) = watch(&mut world, &ids, 180.0);
            let what = format!("{response:?}, {step_hz} Hz, e {e} mu {mu}");
            assert!(drift <= 1e-6, "drift {drift} m, {what}");
            assert!(lean <= 1e-3, "tilt {lean} degrees, {what}");
        }
    }
}
