//! What a scene lists is computed and what it does not list is not; air, oil and rolling against what analysis says.
#![allow(
    clippy::disallowed_methods,
    reason = "what is expected may come from any library"
)]

mod support;

use std::sync::Arc;

use glam::DVec3;
use physics::{
    BodyDef, BodyId, Compound, Counts, Effect, Effects, MassProperties, Motion, OilPattern,
    PairContact, Pose, Response, Settings, Shape, Surface, World,
};
use support::*;

/// Oil from the foul line to 12.192 m (40 ft), `factor` times the friction of the dry lane.
fn oil(lane: &World, id: BodyId, factor: f64) -> OilPattern {
    let foul_line = -lane.body(id).pose().position.z;
    let (from, to) = ([-0.53, foul_line], [0.53, foul_line - 12.192]);
    OilPattern::new(from, to, [2, 2], vec![factor; 4]).expect("four factors for four nodes")
}

/// A throw with air, oil, and a hand that sweeps over the rack; the ball starts on the oil.
fn throw_with_everything(settings: Settings) -> (World, BodyId) {
    let m = material(0.7, 0.7);
    let mut world = World::new(settings).expect("these settings can run");
    let lane = add_building(&mut world, m)[0];
    let pattern = oil(&world, lane, 0.3);
    world.set_oil(lane, pattern);
    for spot in spots() {
        let mut def = pin(&composite_pin(), m, spot);
        def.drag_area_m2 = 0.03;
        world.add(def);
    }
    let mut def = ball(m, DVec3::new(0.05, BALL_RADIUS, -11.0));
    def.linear_velocity = DVec3::NEG_Z * 8.0;
    def.drag_area_m2 = 0.02;
    world.add(def);
    let hand = world.add(hand(m, DVec3::new(-0.3, 0.3, -19.0)));
    (world, hand)
}

/// How often each effect's work was done in a throw.
fn work_of(settings: Settings) -> Counts {
    let (mut world, hand) = throw_with_everything(settings);
    for i in 0..1440 {
        let x = 0.3 * f64::from(i) / 1440.0 - 0.3;
        world.drive_to(hand, Pose::from_position(DVec3::new(x, 0.3, -19.0)));
        world.step();
    }
    for _ in 0..1440 {
        world.step();
    }
    world.effort().work
}

#[test]
fn what_is_not_listed_does_no_work_in_a_whole_throw() {
    for response in [Response::UnoSlater, Response::Guarded, Response::Coulomb] {
        let all = every_effect(response);
        let full = work_of(all);
        for effect in Effect::ALL {
            assert!(full.of(effect) > 0, "{effect} listed, {response:?}");
            let effects = all.effects.without(effect);
            let work = work_of(Settings { effects, ..all });
            assert_eq!(work.of(effect), 0, "{effect} left out, {response:?}");
        }
        let none = work_of(Settings {
            effects: Effects::NONE,
            ..all
        });
        assert_eq!(none, Counts::default());
    }
}

#[test]
fn what_nothing_calls_for_is_not_in_the_plan() {
    let smooth = material(0.0, 0.0);
    let weightless = Settings {
        gravity: DVec3::ZERO,
        rolling_resistance_m: 0.0,
        ..every_effect(Response::Guarded)
    };
    let planned = |world: &World| -> Effects {
        world
            .plan()
            .flat_map(|stage| stage.effects.iter())
            .collect()
    };
    let mut world = World::new(weightless).unwrap();
    let id = world.add(ball(smooth, DVec3::ZERO));
    let always: Effects = [Effect::Rotation, Effect::Continuous, Effect::Sleeping]
        .into_iter()
        .collect();
    assert_eq!(planned(&world), always);
    // A rough object calls for friction, an uneven one for its tumbling, a driven one for the hand.
    world.add(pin(&composite_pin(), material(0.0, 0.5), DVec3::X));
    let more = always.with(Effect::Friction).with(Effect::Gyroscopic);
    assert_eq!(planned(&world), more);
    world.set_motion(id, Motion::Driven);
    assert_eq!(planned(&world), more.with(Effect::Hand));
    let pattern = OilPattern::new([-1.0, -1.0], [1.0, 1.0], [2, 2], vec![1.0; 4]).unwrap();
    world.set_oil(id, pattern);
    assert!(!planned(&world).contains(Effect::Oil));

    let mut world = World::new(Settings {
        contact: PairContact {
            restitution: 0.0,
            friction: 0.0,
        },
        ..every_effect(Response::Coulomb)
    })
    .unwrap();
    world.add(ball(material(1.0, 1.0), DVec3::ZERO));
    assert!(!planned(&world).contains(Effect::Friction));
    let pair = PairContact {
        restitution: 0.0,
        friction: 0.1,
    };
    world.set_pair(Surface(1), Surface(2), pair).unwrap();
    assert!(planned(&world).contains(Effect::Friction));
    assert!(!planned(&world).contains(Effect::Elasticity));
}

#[test]
fn settings_that_no_air_and_no_floor_has_are_refused() {
    let with = |rolling_resistance_m, air_density_kgpm3| {
        let settings = Settings {
            rolling_resistance_m,
            air_density_kgpm3,
            ..Settings::default()
        };
        World::new(settings).err().map(|e| e.to_string())
    };
    assert_eq!(with(0.0, 0.0), None);
    for bad in [-1e-9, f64::NAN, f64::INFINITY] {
        assert!(with(bad, 0.0).is_some_and(|e| e.contains("rolling_resistance_m")));
        assert!(with(0.0, bad).is_some_and(|e| e.contains("air_density_kgpm3")));
    }
    let mut world = World::new(Settings::default()).unwrap();
    let mut def = ball(material(0.5, 0.5), DVec3::ZERO);
    def.drag_area_m2 = f64::NAN;
    let id = world.add(def);
    assert!(world.body(id).is_frozen());
}

#[test]
fn no_step_of_a_throw_raises_the_energy_whatever_is_left_out() {
    let all = every_effect(Response::Guarded).effects;
    for response in [Response::UnoSlater, Response::Guarded, Response::Coulomb] {
        for left_out in Effect::ALL.map(Some).into_iter().chain([None]) {
            // Without a search in time bodies overlap, and are pushed apart.
            if left_out == Some(Effect::Continuous) {
                continue;
            }
            let effects = left_out.map_or(all, |effect| all.without(effect));
            let (mut world, _) = throw_with_everything(Settings {
                effects,
                ..every_effect(response)
            });
            let start = world.energy();
            let mut before = start;
            for _ in 0..720 * 4 {
                world.step();
                let now = world.energy();
                assert!(
                    now - before < 1e-5 * start,
                    "{} J more in step {}, without {left_out:?}, {response:?}",
                    now - before,
                    world.steps()
                );
                before = now;
            }
        }
    }
}

/// A floor of one box, 100 m each way, with Coulomb's law or a rate.
fn floor(settings: Settings) -> World {
    let mut world = World::new(settings).expect("these settings can run");
    let (low, high) = (DVec3::new(-50.0, -1.0, -50.0), DVec3::new(50.0, 0.0, 50.0));
    world.add(block(material(1.0, 1.0), low, high));
    world
}

/// Oil alone, of the three extra effects.
fn coulomb(friction: f64, extra: Effect) -> Settings {
    Settings {
        effects: Effects::default().with(extra),
        contact: PairContact {
            restitution: 0.5,
            friction,
        },
        ..every_effect(Response::Coulomb)
    }
}

#[test]
fn air_slows_a_free_body_exactly_whatever_the_step() {
    for step_hz in [60.0, 90.0, 720.0] {
        let mut world = World::new(Settings {
            step_hz,
            gravity: DVec3::ZERO,
            ..every_effect(Response::Guarded)
        })
        .unwrap();
        let mut def = ball(material(0.5, 0.5), DVec3::ZERO);
        def.linear_velocity = DVec3::new(24.0, 18.0, 0.0);
        def.drag_area_m2 = 0.8;
        let k = 0.5 * 1.2 * 0.8 / def.mass.mass;
        let id = world.add(def);
        while world.steps() < 2 * step_hz as u64 {
            world.step();
        }
        let v = world.body(id).linear_velocity();
        let want = DVec3::new(24.0, 18.0, 0.0) / (1.0 + k * 30.0 * 2.0);
        assert!(
            (v - want).length() < 1e-12 * want.length(),
            "{v} not {want}"
        );
    }
}

#[test]
fn a_falling_body_nears_its_terminal_speed_to_second_order() {
    let error = |step_hz: f64| {
        let mut world = World::new(Settings {
            step_hz,
            ..every_effect(Response::Guarded)
        })
        .unwrap();
        let mut def = ball(material(0.5, 0.5), DVec3::ZERO);
        def.drag_area_m2 = 1.0;
        // v = v_t tanh(g t / v_t), h = v_t^2/g ln cosh(g t / v_t).
        let terminal = f64::sqrt(2.0 * def.mass.mass * 9.81 / (1.2 * 1.0));
        let id = world.add(def);
        while world.steps() < step_hz as u64 {
            world.step();
        }
        let body = world.body(id);
        let share = 9.81 / terminal;
        let speed = -body.linear_velocity().y - terminal * share.tanh();
        let way = -body.pose().position.y - terminal * terminal / 9.81 * share.cosh().ln();
        (speed, way)
    };
    let (coarse, fine) = (error(60.0), error(120.0));
    for (coarse, fine) in [(coarse.0, fine.0), (coarse.1, fine.1)] {
        assert!(fine.abs() < 1e-4, "{fine}");
        let ratio = coarse / fine;
        assert!((3.8..4.2).contains(&ratio), "errors {coarse} and {fine}");
    }
}

#[test]
fn a_rolling_ball_stops_where_the_arm_of_its_resistance_says() {
    // About the contact: c m g = (I + m R^2) a / R, so the way is v^2 / (2 a).
    let arm = 2e-3;
    let inertia = BALL_MASS.inertia.x + BALL_MASS.mass * BALL_RADIUS * BALL_RADIUS;
    let slowing = arm * BALL_MASS.mass * 9.81 * BALL_RADIUS / inertia;
    for (response, tolerance) in [(Response::Coulomb, 2e-3), (Response::Guarded, 5e-3)] {
        for step_hz in [90.0, 720.0] {
            let mut world = floor(Settings {
                effects: Effects::default().with(Effect::RollingResistance),
                rolling_resistance_m: arm,
                step_hz,
                ..every_effect(response)
            });
            let mut def = ball(material(0.7, 0.7), DVec3::Y * BALL_RADIUS);
            def.linear_velocity = DVec3::X * 1.5;
            def.angular_velocity = DVec3::NEG_Z * (1.5 / BALL_RADIUS);
            let id = world.add(def);
            let want = 1.5 * 1.5 / (2.0 * slowing);
            while !world.body(id).is_asleep() {
                world.step();
                assert!(world.time() < 30.0, "still rolling");
            }
            let way = world.body(id).pose().position.x;
            assert!(
                (way / want - 1.0).abs() < tolerance,
                "{way} m, not {want}, at {step_hz} Hz under {response:?}"
            );
        }
    }
}

#[test]
fn a_pin_that_rolls_on_its_side_comes_to_rest_and_sleeps() {
    for response in [Response::UnoSlater, Response::Guarded, Response::Coulomb] {
        for extra in [Some(Effect::RollingResistance), None] {
            let effects = extra.map_or(Effects::default(), |e| Effects::default().with(e));
            let mut world = floor(Settings {
                effects,
                rolling_resistance_m: 5e-4,
                ..every_effect(response)
            });
            let mut def = pin(&composite_pin(), material(0.7, 0.7), DVec3::ZERO);
            def.pose.position.y = 0.062;
            def.pose.rotation = tilted(std::f64::consts::FRAC_PI_2);
            def.linear_velocity = DVec3::X * 0.5;
            def.angular_velocity = DVec3::NEG_Z * (0.5 / 0.0605);
            let id = world.add(def);
            let (start, mut last) = (world.energy(), world.energy());
            for _ in 0..720 * 20 {
                world.step();
                let rise = world.energy() - last;
                assert!(rise < 1e-5 * start, "{rise} J more, {response:?}");
                last = world.energy();
            }
            assert_eq!(
                world.body(id).is_asleep(),
                extra.is_some(),
                "{response:?}, {extra:?}: {:?}",
                world.body(id).angular_velocity()
            );
        }
    }
}

/// Reference data B3 (real-world-physics-problems.com): mu 0.04 to 40 ft, then 0.20; slide 15 m.
#[test]
fn a_ball_skids_over_oil_and_hooks_behind_it() {
    let lane = |world: &mut World| {
        let m = material(1.0, 1.0);
        world.add(block(
            m,
            DVec3::new(-5.0, -0.3, -30.0),
            DVec3::new(5.0, 0.0, 1.0),
        ))
    };
    let throw = |friction: f64, factor: f64| {
        let mut world = World::new(coulomb(friction, Effect::Oil)).unwrap();
        let id = lane(&mut world);
        let pattern = oil(&world, id, factor);
        world.set_oil(id, pattern);
        let radius = 0.1085;
        let mass = MassProperties {
            mass: 7.0,
            inertia: DVec3::splat(0.032),
        };
        let (sin, cos) = 21.5f64.to_radians().sin_cos();
        let sphere = Compound::single(Shape::sphere(radius).unwrap());
        let id = world.add(BodyDef {
            compound: Arc::new(sphere),
            mass,
            linear_velocity: DVec3::NEG_Z * 8.0,
            angular_velocity: (DVec3::NEG_X * cos + DVec3::Z * sin) * 30.0,
            ..ball(material(1.0, 1.0), DVec3::Y * radius)
        });
        let (mut slide, mut hook) = (0.0, 0.0);
        while world.body(id).pose().position.z > -18.288 {
            world.step();
            let body = world.body(id);
            let at = body.pose().position;
            if body.velocity_at(at - DVec3::Y * radius).length() > 1e-6 {
                slide = -at.z;
            }
            hook = at.x.abs();
        }
        (slide, hook)
    };
    // Constant acceleration against the slip, first on oil, then on the dry lane, gives 15.08 m and 0.376 m.
    let (slide, hook) = throw(0.2, 0.2);
    assert!((slide / 15.08 - 1.0).abs() < 5e-3, "slid {slide} m");
    assert!((slide / 15.0 - 1.0).abs() < 0.05, "published 15 m");
    assert!((hook / 0.376 - 1.0).abs() < 1e-2, "hooked {hook} m");
    // B1: 0.12 all the way, which the oil leaves as it is.
    let (slide, hook) = throw(0.12, 1.0);
    assert!((slide / 8.88 - 1.0).abs() < 5e-3, "slid {slide} m");
    assert!((hook / 0.678 - 1.0).abs() < 1e-2, "hooked {hook} m");
}

#[test]
fn a_puck_under_coulomb_slides_its_way_and_less_where_oil_ends() {
    let puck = Arc::new(Compound::single(Shape::cylinder(0.1, 0.02).unwrap()));
    let slide = |settings: Settings, factor: Option<f64>| {
        let mut world = floor(settings);
        if let Some(factor) = factor {
            let (from, to) = ([-1.0, -1.0], [0.1, 1.0]);
            let pattern = OilPattern::new(from, to, [2, 2], vec![factor; 4]).unwrap();
            let id = world.ids().next().unwrap();
            world.set_oil(id, pattern);
        }
        let mut def = pin(&puck, material(1.0, 1.0), DVec3::ZERO);
        def.pose.position.y = 0.02;
        def.linear_velocity = DVec3::X;
        let id = world.add(def);
        for _ in 0..720 * 2 {
            world.step();
        }
        assert_eq!(world.body(id).linear_velocity(), DVec3::ZERO);
        world.body(id).pose().position.x
    };
    // v^2 = 2 mu g x.
    let dry = slide(coulomb(0.2, Effect::Oil), None);
    assert!((dry - 1.0 / (0.4 * 9.81)).abs() < 2e-4, "{dry} m");
    let half = slide(coulomb(0.2, Effect::Oil), Some(0.5));
    let want = 0.1 + (1.0 - 0.2 * 9.81 * 0.1) / (0.4 * 9.81);
    assert!((half - want).abs() < 2e-3, "{half} m, not {want}");
    // Not listed, the oil does nothing.
    let unlisted = slide(coulomb(0.2, Effect::Drag), Some(0.5));
    assert_eq!(unlisted, dry);
}

#[test]
fn what_does_not_turn_slides_and_keeps_its_orientation() {
    let mut world = floor(Settings {
        effects: coulomb(0.2, Effect::Oil).effects.without(Effect::Rotation),
        ..every_effect(Response::Coulomb)
    });
    let mut def = ball(material(1.0, 1.0), DVec3::Y * BALL_RADIUS);
    (def.linear_velocity, def.angular_velocity) = (DVec3::X, DVec3::ONE);
    let id = world.add(def);
    for _ in 0..720 {
        world.step();
    }
    let body = world.body(id);
    assert_eq!(body.pose().rotation, glam::DQuat::IDENTITY);
    let want = 1.0 / (0.4 * 9.81);
    assert!((body.pose().position.x - want).abs() < 1e-3);
}

#[test]
fn without_the_gyroscopic_term_a_free_body_keeps_its_angular_velocity() {
    let mut world = World::new(Settings {
        gravity: DVec3::ZERO,
        effects: Effects::default().without(Effect::Gyroscopic),
        ..every_effect(Response::Guarded)
    })
    .unwrap();
    for inertia in [DVec3::new(1e-2, 2e-2, 3e-2), DVec3::new(1e-2, 2e-3, 1e-2)] {
        let mut def = pin(&composite_pin(), material(1.0, 0.0), DVec3::ZERO);
        def.mass.inertia = inertia;
        def.angular_velocity = DVec3::new(0.3, 5.0, -2.0);
        let id = world.add(def);
        let energy = world.body(id).kinetic_energy();
        for _ in 0..720 * 10 {
            world.step();
        }
        let body = world.body(id);
        let turned = body.angular_velocity() - DVec3::new(0.3, 5.0, -2.0);
        assert!(turned.length() < 1e-10, "{turned}");
        assert!((body.kinetic_energy() / energy - 1.0).abs() < 1e-10);
        world.remove(id);
    }
}

#[test]
fn without_a_search_in_time_a_fast_ball_passes_a_pin_between_two_ticks() {
    let passes = |effects: Effects| {
        let mut world = World::new(Settings {
            effects,
            gravity: DVec3::ZERO,
            step_hz: 60.0,
            ..every_effect(Response::Guarded)
        })
        .unwrap();
        let m = material(0.7, 0.0);
        let target = world.add(pin(&composite_pin(), m, DVec3::ZERO));
        let mut def = ball(m, DVec3::new(0.0, 0.11, 0.5));
        def.linear_velocity = DVec3::NEG_Z * 60.0;
        world.add(def);
        for _ in 0..30 {
            world.step();
        }
        world.body(target).linear_velocity() == DVec3::ZERO
    };
    assert!(!passes(Effects::default()));
    assert!(passes(Effects::default().without(Effect::Continuous)));
}

#[test]
fn without_a_search_in_time_a_ball_still_lies_on_the_floor() {
    let mut world = floor(Settings {
        effects: Effects::default().without(Effect::Continuous),
        ..every_effect(Response::Guarded)
    });
    let id = world.add(ball(material(0.7, 0.7), DVec3::Y));
    for _ in 0..720 * 4 {
        world.step();
    }
    let body = world.body(id);
    assert!(body.is_asleep());
    assert!((body.pose().position.y - BALL_RADIUS).abs() < 1e-4);
}

#[test]
fn without_a_hand_driven_bodies_pass_through_and_let_go() {
    for listed in [true, false] {
        let mut world = floor(Settings {
            effects: Effects::default().set(Effect::Hand, listed),
            ..every_effect(Response::Guarded)
        });
        let m = material(0.7, 0.7);
        let id = world.add(pin(&composite_pin(), m, DVec3::ZERO));
        let hand = world.add(hand(m, DVec3::new(-0.5, 0.3, 0.0)));
        for i in 0..720 {
            let x = f64::from(i) / 720.0 - 0.5;
            world.drive_to(hand, Pose::from_position(DVec3::new(x, 0.3, 0.0)));
            world.step();
        }
        assert_eq!(world.body(hand).pose().position.x, 719.0 / 720.0 - 0.5);
        assert_eq!(tilt(&world, id) > 30.0, listed);
        // What was dynamic and touches becomes driven: nothing may stay in contact with it.
        let lying = world.add(ball(m, DVec3::new(0.0, BALL_RADIUS, 3.0)));
        let ground = world.ids().next().unwrap();
        for _ in 0..72 {
            world.step();
        }
        assert!(world.touching(lying, ground));
        world.set_motion(lying, Motion::Driven);
        world.step();
        assert!(!world.touching(lying, ground) || listed);
        world.set_motion(lying, Motion::Dynamic);
        for _ in 0..72 {
            world.step();
        }
        assert!(world.touching(lying, ground));
    }
}
