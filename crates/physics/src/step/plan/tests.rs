//! What the plan of a scene has in it, and that an effect with its neutral value is as good as none.

use super::*;
use crate::body::Spin;
use crate::oil::OilPattern;
use crate::pose::Pose;
use crate::world::{BodyId, World};

#[path = "../../../tests/support/mod.rs"]
mod support;

use support::{
    BALL_RADIUS, add_building, ball, composite_pin, ellipsoid_pin, every_effect, hand, material,
    pin,
};

/// So small that it changes nothing, and not zero, so that the effect is in the plan.
const TINY: f64 = 1e-100;
/// Steps of a throw at which states are taken: standing and rolling, the first hit, the heap, rest.
const STATES: [u64; 16] = [
    1, 2, 40, 80, 97, 100, 104, 110, 130, 170, 250, 400, 700, 1500, 2500, 4000,
];

fn names(plan: &Plan) -> Vec<&'static str> {
    plan.stages().map(|planned| planned.stage.name()).collect()
}

#[test]
fn a_scene_without_effects_keeps_what_every_step_needs() {
    let settings = Settings {
        effects: Effects::NONE,
        ..Settings::default()
    };
    let plan = Plan::new(&settings, Effect::ALL.into_iter().collect());
    assert_eq!(
        names(&plan),
        ["drive", "gather", "carry", "strike", "arrive"]
    );
    assert_eq!(plan.gravity, DVec3::ZERO);
    assert_eq!(plan.friction, Source::Nothing);
    assert!(
        plan.stages()
            .all(|planned| planned.effects == Effects::NONE)
    );
}

#[test]
fn what_nothing_calls_for_is_left_out_though_listed() {
    let settings = Settings {
        effects: Effect::ALL.into_iter().collect(),
        rolling_resistance_m: 1e-3,
        ..Settings::default()
    };
    let called: Effects = [Effect::Rotation, Effect::Sleeping, Effect::Oil]
        .into_iter()
        .collect();
    let plan = Plan::new(&settings, called);
    // Oil does nothing where there is no friction.
    assert_eq!(plan.effects, called.without(Effect::Oil));
    assert_eq!(
        names(&plan),
        ["gather", "carry", "strike", "arrive", "sleep"]
    );
    assert_eq!(plan.rolling, None);
    let all = Plan::new(&settings, settings.effects);
    assert_eq!(all.rolling, Some(1e-3));
    assert_eq!(names(&all).len(), 9);
}

#[test]
fn coefficients_come_from_the_table_under_coulomb_alone() {
    for (response, source) in [
        (Response::UnoSlater, Source::Products),
        (Response::Guarded, Source::Products),
        (Response::Coulomb, Source::Table),
    ] {
        let settings = Settings {
            response,
            ..Settings::default()
        };
        let plan = Plan::new(&settings, Effects::default());
        assert_eq!((plan.elasticity, plan.friction), (source, source));
    }
}

/// Takes a step stage by stage; adds what each one counts.
fn step_by_stages(world: &mut World, counted: &mut Vec<(Stage, Effect)>) {
    let dt = world.dt();
    world.impacts.clear();
    world.steps += 1;
    world.awake.sort_unstable();
    for stage in world.plan.stages.clone() {
        let before = world.effort.work;
        world.run(stage, dt);
        let work = world.effort.work;
        let acts = |effect: &Effect| work.of(*effect) > before.of(*effect);
        let new = Effect::ALL.into_iter().filter(acts);
        counted.extend(new.map(|effect| (stage, effect)));
    }
    world.dismiss();
}

#[test]
fn what_a_stage_counts_is_among_the_effects_that_it_lists() {
    for response in [Response::UnoSlater, Response::Guarded, Response::Coulomb] {
        let mut counted = Vec::new();
        let throw = Throw::new(response, false);
        for state in &throw.states {
            let (mut world, mut other) = (state.clone(), state.clone());
            for i in 0..20 {
                let x = 0.01 * f64::from(i) - 0.3;
                let target = Pose::from_position(DVec3::new(x, 0.3, -19.0));
                world.drive_to(throw.hand, target);
                other.drive_to(throw.hand, target);
                step_by_stages(&mut world, &mut counted);
                other.step();
            }
            assert_eq!(world.hash(), other.hash(), "these are the steps");
        }
        for (stage, effect) in &counted {
            let listed = stage.effects().contains(effect);
            assert!(listed, "{effect} acts in {}, {response:?}", stage.name());
        }
        for effect in Effect::ALL {
            let acts = counted.iter().any(|(_, counted)| *counted == effect);
            assert!(acts, "{effect}, {response:?}");
        }
        // Blows set bodies off anew, with all that acts on what is carried.
        assert!(counted.contains(&(Stage::Strike, Effect::RollingResistance)));
    }
}

/// Where a hand is out of reach.
fn far_away() -> Pose {
    Pose::from_position(DVec3::new(0.0, 50.0, 100.0))
}

/// A throw into a rack through oil and air, with a hand that sweeps over the deck, and states of it.
struct Throw {
    lane: BodyId,
    hand: BodyId,
    states: Vec<World>,
}

impl Throw {
    fn new(response: Response, is_ellipsoid: bool) -> Throw {
        let m = material(0.7, 0.7);
        let mut world = World::new(every_effect(response)).unwrap();
        let lane = add_building(&mut world, m)[0];
        let oil = OilPattern::new([-1.0, 12.0], [1.0, -12.0], [2, 2], vec![0.2, 0.3, 1.0, 0.9]);
        world.set_oil(lane, oil.unwrap());
        let shape = if is_ellipsoid {
            ellipsoid_pin()
        } else {
            composite_pin()
        };
        for spot in support::spots() {
            let mut def = pin(&shape, m, spot);
            def.drag_area_m2 = 0.03;
            world.add(def);
        }
        let mut def = ball(m, DVec3::new(0.04, BALL_RADIUS, -17.1));
        def.linear_velocity = DVec3::NEG_Z * 8.0;
        def.angular_velocity = DVec3::new(-50.0, 3.0, 4.0);
        def.drag_area_m2 = 0.02;
        world.add(def);
        let hand = world.add(hand(m, DVec3::new(-0.3, 0.3, -19.0)));
        let mut states = Vec::new();
        for step in 0..=4000 {
            if STATES.contains(&step) {
                states.push(world.clone());
            }
            let x = 0.3 * step.min(1440) as f64 / 1440.0 - 0.3;
            world.drive_to(hand, Pose::from_position(DVec3::new(x, 0.3, -19.0)));
            world.step();
        }
        Throw { lane, hand, states }
    }
}

/// A world that goes on with other settings.
fn continued(world: &World, change: impl Fn(&mut Settings)) -> World {
    let mut world = world.clone();
    change(&mut world.settings);
    let drags = world.settings.effects.contains(Effect::Drag);
    let air = world.settings.air_density_kgpm3 / 1.2;
    for body in &mut world.bodies {
        body.drag *= if drags { air } else { 0.0 };
    }
    world.contacts = crate::surface::PairTable::new(world.settings.contact);
    world.plan = Plan::new(&world.settings, Effect::ALL.into_iter().collect());
    for slot in 0..world.bodies.len() {
        world.decide_meeting(slot);
    }
    world
}

/// The same state twice: with an effect that has its neutral value, and without the effect.
fn pair(throw: &Throw, state: &World, effect: Effect) -> (World, World) {
    let mut state = state.clone();
    for i in 0..state.bodies.len() {
        let body = &mut state.bodies[i];
        match effect {
            Effect::Rotation => body.momentum = DVec3::ZERO,
            Effect::Gyroscopic => body.mass.inertia = DVec3::splat(body.mass.inertia.x),
            Effect::Sleeping => {
                state.wake(i);
            }
            _ => {}
        }
    }
    let mut listed = continued(&state, |settings| match effect {
        // Exactly: what just touches begins to approach with any weight, and what rubs is answered in another order.
        Effect::Gravity => settings.gravity = DVec3::ZERO,
        Effect::Friction => settings.contact.friction = 0.0,
        Effect::Elasticity => settings.contact.restitution = TINY,
        Effect::RollingResistance => settings.rolling_resistance_m = TINY,
        Effect::Drag => settings.air_density_kgpm3 = TINY,
        _ => {}
    });
    let unlisted = |state: &World| {
        continued(state, |settings| {
            settings.effects = settings.effects.without(effect)
        })
    };
    let mut other = unlisted(&state);
    for body in &mut listed.bodies {
        match effect {
            Effect::Elasticity => body.material.elasticity = TINY,
            Effect::Friction => body.material.friction_rate = 0.0,
            Effect::Rotation => body.mass.inertia *= 1e100,
            Effect::Gyroscopic => body.spin = Spin::Free,
            _ => {}
        }
    }
    for body in &mut other.bodies {
        match effect {
            Effect::Rotation => body.spin = Spin::Never,
            Effect::Gyroscopic => body.spin = Spin::Steady,
            _ => {}
        }
    }
    if effect == Effect::Oil {
        let corners = ([-1.0, 12.0], [1.0, -12.0]);
        // All that is touched lies behind the first rows.
        let factors = vec![0.5, 0.5, 1.0, 1.0, 1.0, 1.0];
        let oil = OilPattern::new(corners.0, corners.1, [2, 3], factors);
        listed.set_oil(throw.lane, oil.unwrap());
        other.disturb(other.slot(throw.lane));
    }
    if effect == Effect::Hand {
        listed.set_pose(throw.hand, far_away());
        let at = state.body(throw.hand).pose();
        state.set_pose(throw.hand, far_away());
        other = unlisted(&state);
        other.set_pose(throw.hand, at);
    }
    (listed, other)
}

/// Largest difference of a position [m], a rotation, a velocity [m/s] or [rad/s].
fn difference(a: &World, b: &World, without: BodyId) -> f64 {
    let mut worst: f64 = 0.0;
    for id in a.ids().filter(|id| *id != without) {
        let (a, b) = (a.body(id), b.body(id));
        let turned = (a.rotation - b.rotation).length();
        let turned = turned.min((a.rotation + b.rotation).length());
        let velocity = (a.linear - b.linear).length();
        let turning = (a.angular_velocity() - b.angular_velocity()).length();
        let moved = (a.position - b.position).length();
        for difference in [turned, velocity, turning, moved] {
            worst = worst.max(difference);
        }
    }
    worst
}

/// Steps once with the neutral value and once without the effect, from many states under a law.
///
/// Returns how many states were compared, and the largest difference.
fn compare(effect: Effect, response: Response, throws: &[Throw]) -> (u32, f64) {
    let (mut compared, mut worst) = (0, 0.0_f64);
    for throw in throws {
        for state in &throw.states {
            let (mut listed, mut other) = pair(throw, state, effect);
            assert!(listed.plan.has(effect) && !other.plan.has(effect));
            let before = listed.effort.events;
            listed.step();
            other.step();
            // Without a search in time nothing may come about inside the step; and the time of an impact is only right to
            // 0.1 um over the speed, where the rounding of a bound decides about the last digits.
            let is_timed = matches!(effect, Effect::Continuous | Effect::Gyroscopic);
            if is_timed && listed.effort.events != before {
                continue;
            }
            let off = difference(&listed, &other, throw.hand);
            if off > 1e-12 {
                println!("{effect} {response:?} at step {}: {off:e}", state.steps());
            }
            worst = worst.max(off);
            compared += 1;
        }
    }
    (compared, worst)
}

#[test]
fn a_step_with_a_neutral_value_is_the_step_without_the_effect() {
    for response in [Response::UnoSlater, Response::Guarded, Response::Coulomb] {
        let throws = [false, true].map(|is_ellipsoid| Throw::new(response, is_ellipsoid));
        for effect in Effect::ALL {
            let (compared, worst) = compare(effect, response, &throws);
            let least = match effect {
                Effect::Continuous | Effect::Gyroscopic => 10,
                _ => 32,
            };
            assert!(compared >= least, "{effect}: {compared} states compared");
            assert!(
                worst <= 1e-12,
                "{effect}: {worst:e} apart under {response:?}"
            );
        }
    }
}
