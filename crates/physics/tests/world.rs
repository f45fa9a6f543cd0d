//! The world as its callers see it: sleep, driven bodies, ghosts, snapshots, odd input, long extreme runs.
#![allow(
    clippy::disallowed_methods,
    reason = "what is expected may come from any library"
)]

mod support;

use std::sync::Arc;

use glam::{DQuat, DVec3};
use physics::{
    Compound, Effect, Effects, Effort, Material, Motion, PairContact, Pose, Response, Settings,
    SettingsError, Shape, Stage, Stopwatch, World,
};
use support::*;

#[test]
fn clones_run_on_to_the_same_bits() {
    let m = material(0.7, 0.7);
    let (mut world, _) = alley(Settings::default(), &composite_pin(), m);
    throw(&mut world, m, 0.05, 2.0, 8.0);
    for _ in 0..300 {
        world.step();
    }
    let mut other = world.clone();
    let start = world.hash();
    for _ in 0..600 {
        world.step();
        other.step();
        assert_eq!(world.hash(), other.hash(), "at step {}", world.steps());
    }
    assert_ne!(world.hash(), start);
}

#[test]
fn a_second_world_from_the_same_calls_has_the_same_hash() {
    let run = || {
        let m = material(0.7, 0.7);
        let (mut world, _) = alley(Settings::default(), &ellipsoid_pin(), m);
        throw(&mut world, m, -0.03, 2.0, 7.0);
        for _ in 0..1000 {
            world.step();
        }
        world.hash()
    };
    assert_eq!(run(), run());
}

#[test]
fn a_rack_falls_asleep_and_wakes_at_a_touch() {
    let m = material(0.7, 0.7);
    let (mut world, ids) = alley(Settings::default(), &composite_pin(), m);
    let hand = world.add(hand(m, DVec3::new(0.0, 0.2, -17.0)));
    for _ in 0..360 {
        world.step();
    }
    assert!(ids.iter().all(|id| world.body(*id).is_asleep()));
    for i in 0..720 {
        let z = -17.0 - 1.3 * f64::from(i + 1) / 720.0;
        world.drive_to(hand, Pose::from_position(DVec3::new(0.0, 0.3, z)));
        world.step();
    }
    for _ in 0..720 {
        world.step();
    }
    assert!(
        tilt(&world, ids[0]) > 45.0,
        "the hand pushed the head pin over"
    );
}

#[test]
fn on_a_slope_a_pin_tips_where_its_centre_leaves_its_base() {
    let m = material(0.7, 1.0);
    let tip = (BASE_RADIUS / PIN_CG).atan();
    for (shape, direction) in [(composite_pin(), 0.3f64), (ellipsoid_pin(), 2.0)] {
        for (beyond, falls) in [(-0.1f64, false), (0.1, true)] {
            let angle = tip + beyond.to_radians();
            let across = DVec3::new(direction.cos(), 0.0, direction.sin());
            let gravity = (across * angle.sin() - DVec3::Y * angle.cos()) * 9.81;
            let mut world = World::new(Settings {
                gravity,
                ..Settings::default()
            })
            .unwrap();
            world.add(block(
                m,
                DVec3::new(-5.0, -1.0, -5.0),
                DVec3::new(5.0, 0.0, 5.0),
            ));
            let id = world.add(pin(&shape, m, DVec3::ZERO));
            for _ in 0..720 * 3 {
                world.step();
            }
            assert_eq!(
                tilt(&world, id) > 30.0,
                falls,
                "{beyond} degrees beyond the tip angle"
            );
        }
    }
}

#[test]
fn a_leaning_pin_does_not_hang() {
    // Half a degree past its tip angle it starts with hardly any acceleration; sleep must not catch it.
    for response in [Response::UnoSlater, Response::Guarded, Response::Coulomb] {
        for step_hz in [60.0, 90.0, 240.0, 720.0, 1440.0] {
            for (shape, name) in [
                (composite_pin(), "composite"),
                (ellipsoid_pin(), "ellipsoid"),
            ] {
                for (e, mu) in [(0.7, 0.7), (0.0, 1.0)] {
                    for beyond in [0.01f64, 0.1, 0.5] {
                        let settings = Settings {
                            step_hz,
                            response,
                            contact: PairContact {
                                restitution: e,
                                friction: mu,
                            },
                            ..Settings::default()
                        };
                        let most = leans_to(settings, &shape, material(e, mu), beyond);
                        assert!(
                            most > 60.0,
                            "{beyond} degrees beyond, {name}, {response:?}, {step_hz} Hz, {e} {mu}: hangs at {most}"
                        );
                    }
                }
            }
        }
    }
}

/// Greatest tilt in 4 s of a pin on its edge that leans so many degrees beyond its tip angle [degrees].
fn leans_to(settings: Settings, shape: &Arc<Compound>, m: Material, beyond: f64) -> f64 {
    let mut world = World::new(settings).expect("these settings run");
    world.add(block(
        m,
        DVec3::new(-5.0, -1.0, -5.0),
        DVec3::new(5.0, 0.0, 5.0),
    ));
    let mut def = pin(shape, m, DVec3::ZERO);
    let rotation = tilted((BASE_RADIUS / PIN_CG).atan() + beyond.to_radians());
    let lowest = (rotation * DVec3::new(0.0, -PIN_CG, BASE_RADIUS)).y;
    let other = (rotation * DVec3::new(0.0, -PIN_CG, -BASE_RADIUS)).y;
    def.pose = Pose::new(DVec3::Y * -lowest.min(other), rotation);
    let id = world.add(def);
    let mut most: f64 = 0.0;
    while world.time() < 4.0 {
        world.step();
        most = most.max(tilt(&world, id));
    }
    most
}

#[test]
fn a_pin_whose_centre_overhangs_the_edge_tips_off_and_one_inside_stands() {
    let m = material(0.7, 0.7);
    for (over, falls) in [(0.004, true), (-0.004, false)] {
        let mut world = World::new(Settings {
            effects: Effects::default().without(Effect::Sleeping),
            ..Settings::default()
        })
        .unwrap();
        world.add(block(
            m,
            DVec3::new(-1.0, -1.0, -1.0),
            DVec3::new(0.0, 0.0, 1.0),
        ));
        let id = world.add(pin(&composite_pin(), m, DVec3::new(over, 0.0, 0.0)));
        // A pin that fell tumbles: how it is turned in the end says nothing.
        let mut most: f64 = 0.0;
        for _ in 0..720 * 4 {
            world.step();
            most = most.max(tilt(&world, id));
        }
        assert_eq!(most > 30.0, falls, "centre {over} m over the edge");
    }
}

#[test]
fn a_body_taken_away_wakes_what_it_carried() {
    let m = material(0.7, 0.7);
    let mut world = World::new(Settings::default()).unwrap();
    let table = world.add(block(
        m,
        DVec3::new(-1.0, 0.0, -1.0),
        DVec3::new(1.0, 1.0, 1.0),
    ));
    let id = world.add(ball(m, DVec3::new(0.0, 1.0 + BALL_RADIUS, 0.0)));
    for _ in 0..720 {
        world.step();
    }
    assert!(world.body(id).is_asleep());
    assert!(world.touching(id, table));
    world.remove(table);
    assert!(!world.contains(table));
    for _ in 0..72 {
        world.step();
    }
    assert!(world.body(id).pose().position.y < 1.0 + BALL_RADIUS - 0.04);
}

#[test]
fn what_slept_on_a_struck_body_wakes() {
    let m = material(0.7, 0.7);
    let mut world = World::new(Settings::default()).unwrap();
    world.add(block(
        m,
        DVec3::new(-5.0, -1.0, -5.0),
        DVec3::new(5.0, 0.0, 5.0),
    ));
    // A board of its own under a ball: struck away, it must not leave the ball hanging.
    let mut def = block(m, DVec3::new(-0.2, 0.0, -0.2), DVec3::new(0.2, 0.2, 0.2));
    def.motion = Motion::Driven;
    let board = world.add(def);
    let id = world.add(ball(m, DVec3::new(0.0, 0.2 + BALL_RADIUS, 0.0)));
    for _ in 0..720 {
        world.step();
    }
    assert!(world.body(id).is_asleep());
    let away = Pose::from_position(DVec3::new(0.0, 0.1 - 0.01, 0.0));
    world.drive_to(board, away);
    for _ in 0..720 {
        world.step();
    }
    let height = world.body(id).pose().position.y;
    assert!(
        (height - 0.19 - BALL_RADIUS).abs() < 1e-5,
        "ball at {height}"
    );
}

#[test]
fn a_hand_that_appears_inside_a_pin_pushes_it_out_gently() {
    let m = material(0.7, 0.7);
    let mut world = World::new(Settings::default()).unwrap();
    world.add(block(
        m,
        DVec3::new(-5.0, -1.0, -5.0),
        DVec3::new(5.0, 0.0, 5.0),
    ));
    let id = world.add(pin(&composite_pin(), m, DVec3::ZERO));
    let hand = world.add(hand(m, DVec3::new(2.0, 0.1, 0.0)));
    world.step();
    world.set_pose(hand, Pose::from_position(DVec3::new(0.03, 0.1, 0.0)));
    let mut fastest: f64 = 0.0;
    for _ in 0..720 {
        world.step();
        fastest = fastest.max(world.body(id).linear_velocity().length());
    }
    let gone = world.body(id).pose().position - world.body(hand).pose().position;
    assert!(gone.length() > 0.1, "still inside: {gone}");
    assert!(fastest < 1.5, "thrown at {fastest} m/s");
}

#[test]
fn ghosts_touch_nothing() {
    let m = material(0.7, 0.7);
    let (mut world, ids) = alley(Settings::default(), &composite_pin(), m);
    world.set_collides(ids[0], false);
    world.set_motion(ids[0], Motion::Fixed);
    let ball = throw(&mut world, m, 0.0, 0.6, 8.0);
    for _ in 0..50 {
        world.step();
        assert!(
            world
                .impacts()
                .iter()
                .all(|i| i.a != ids[0] && i.b != ids[0])
        );
    }
    let ball = world.body(ball);
    assert!(
        ball.pose().position.z < -18.2,
        "inside the head pin: {}",
        ball.pose().position
    );
    assert!((ball.linear_velocity().z + 8.0).abs() < 1e-6);
}

#[test]
fn a_ball_in_a_gutter_and_one_against_a_wall_come_to_rest() {
    let m = material(0.7, 0.7);
    let mut world = World::new(Settings::default()).unwrap();
    add_building(&mut world, m);
    let mut def = ball(m, DVec3::new(0.6445, 0.05, -5.0));
    def.linear_velocity = DVec3::new(0.3, 0.0, 0.0);
    let gutter = world.add(def);
    let start = world.energy();
    let mut last = start;
    for _ in 0..720 * 6 {
        world.step();
        assert!(
            world.energy() <= last + 1e-5,
            "energy rises by {}",
            world.energy() - last
        );
        last = world.energy();
    }
    let body = world.body(gutter);
    assert!((body.pose().position.y - (BALL_RADIUS - 0.0889)).abs() < 1e-4);
    assert!(
        body.linear_velocity().x.abs() < 1e-3,
        "{}",
        body.linear_velocity()
    );
}

#[test]
fn driven_bodies_arrive_where_they_are_sent() {
    let mut world = World::new(Settings::default()).unwrap();
    let id = world.add(hand(material(0.7, 0.7), DVec3::ZERO));
    let goal = Pose::new(DVec3::new(0.01, 0.02, -0.03), DQuat::from_rotation_y(0.05));
    world.drive_to(id, goal);
    world.step();
    let at = world.body(id).pose();
    assert!((at.position - goal.position).length() < 1e-12);
    assert!(at.rotation.angle_between(goal.rotation) < 1e-7);
    world.step();
    assert_eq!(world.body(id).linear_velocity(), DVec3::ZERO);
}

#[test]
fn settings_that_cannot_run_are_refused() {
    let base = Settings::default();
    let refused = |settings| World::new(settings).unwrap_err();
    assert_eq!(
        refused(Settings {
            step_hz: 0.0,
            ..base
        }),
        SettingsError::StepRate(0.0)
    );
    assert_eq!(
        refused(Settings {
            iteration_cap: 0,
            ..base
        }),
        SettingsError::IterationCap
    );
    assert!(
        World::new(Settings {
            step_hz: f64::NAN,
            ..base
        })
        .is_err()
    );
    assert!(
        World::new(Settings {
            gravity: DVec3::NAN,
            ..base
        })
        .is_err()
    );
    assert!(
        World::new(Settings {
            friction_reference_s: -1.0,
            ..base
        })
        .is_err()
    );
}

#[test]
fn the_extreme_condition_stays_bounded_in_a_closed_room() {
    // E0 F0 for ten minutes: nothing damps anything, so the simulation has to stay bounded on its own. Without
    // friction both laws are one.
    let room = Shape::cuboid(DVec3::new(2.0, 0.1, 2.0)).unwrap();
    {
        let m = material(1.0, 0.0);
        let mut world = World::new(Settings::default()).unwrap();
        let sides = [
            (DVec3::new(0.0, -0.1, 0.0), DQuat::IDENTITY),
            (DVec3::new(0.0, 1.6, 0.0), DQuat::IDENTITY),
            (
                DVec3::new(1.1, 0.8, 0.0),
                DQuat::from_rotation_z(std::f64::consts::FRAC_PI_2),
            ),
            (
                DVec3::new(-1.1, 0.8, 0.0),
                DQuat::from_rotation_z(std::f64::consts::FRAC_PI_2),
            ),
            (
                DVec3::new(0.0, 0.8, 1.1),
                DQuat::from_rotation_x(std::f64::consts::FRAC_PI_2),
            ),
            (
                DVec3::new(0.0, 0.8, -1.1),
                DQuat::from_rotation_x(std::f64::consts::FRAC_PI_2),
            ),
        ];
        for (position, rotation) in sides {
            let mut def = block(m, DVec3::NEG_ONE, DVec3::ONE);
            def.compound = Arc::new(Compound::single(room.clone()));
            def.pose = Pose::new(position, rotation);
            world.add(def);
        }
        for x in [-0.4, 0.0, 0.4] {
            world.add(pin(&composite_pin(), m, DVec3::new(x, 0.0, -0.3)));
            world.add(pin(&ellipsoid_pin(), m, DVec3::new(x, 0.0, 0.3)));
        }
        let mut def = ball(m, DVec3::new(0.1, 0.3, 0.8));
        def.linear_velocity = DVec3::new(0.5, 0.0, -6.0);
        world.add(def);
        let start = world.energy();
        for _ in 0..600 * 720 {
            world.step();
        }
        let drift = world.energy() / start - 1.0;
        println!("energy drift {drift:.1e} in ten minutes");
        assert!(drift.abs() < 1e-3, "energy drifted by {drift}");
        for id in world.ids() {
            let p = world.body(id).pose().position;
            assert!(p.abs().max_element() < 1.7, "{p} left the room");
        }
    }
}

#[test]
fn balls_that_strike_the_same_ground_in_one_step_all_bounce() {
    let mut world = World::new(Settings::default()).unwrap();
    let elastic = material(1.0, 0.0);
    let corner = DVec3::new(30.0, 1.0, 30.0);
    world.add(block(elastic, -corner, corner * DVec3::new(1.0, 0.0, 1.0)));
    for i in 0..49 {
        let at = DVec3::new(f64::from(i) - 24.0, 1.0, 0.0);
        world.add(ball(elastic, at));
    }
    let before = world.energy();
    for _ in 0..720 {
        world.step();
    }
    // A shared count of impacts stopped half of them dead.
    assert!((world.energy() / before - 1.0).abs() < 1e-12);
}

/// Keeps what it is told; its `u64` counts the beginnings.
#[derive(Default)]
struct Log(Vec<Stage>, u64);

impl Stopwatch for Log {
    fn begin(&mut self) {
        self.1 += 1;
    }

    fn lap(&mut self, stage: Stage) {
        self.0.push(stage);
    }
}

#[test]
fn a_watched_step_tells_the_stages_of_the_plan_and_changes_nothing() {
    let m = material(0.7, 0.7);
    let (mut world, _) = alley(Settings::default(), &composite_pin(), m);
    throw(&mut world, m, 0.05, 1.0, 8.0);
    let mut other = world.clone();
    let plan: Vec<Stage> = world.plan().map(|planned| planned.stage).collect();
    let mut log = Log::default();
    for _ in 0..400 {
        world.step();
        other.step_watched(&mut log);
    }
    assert_eq!(world.hash(), other.hash());
    assert_eq!(log.1, 400, "a ball that rolls keeps every step busy");
    assert_eq!(log.0.len(), 400 * plan.len());
    assert!(log.0.chunks(plan.len()).all(|stages| stages == plan));
}

#[test]
fn effort_counts_tests_and_what_is_spared() {
    let m = material(0.7, 0.7);
    let (mut world, _) = alley(Settings::default(), &composite_pin(), m);
    // On its way, far from everything but the lane below it.
    throw(&mut world, m, 0.05, 8.0, 5.0);
    for _ in 0..720 {
        world.step();
    }
    let rolling = world.effort();
    assert!(rolling.due < rolling.near, "most pairs wait: {rolling:?}");
    for _ in 0..720 {
        world.step();
    }
    let hit = world.effort();
    let spent = |of: fn(&Effort) -> u64| (of(&rolling), of(&hit) - of(&rolling));
    // A ball on a box is a closed form; cones and ellipsoids of pins are searched.
    let (before, among_pins) = spent(|effort| effort.iterations);
    assert!(
        among_pins > 100 && among_pins > 10 * before,
        "{before}, {among_pins}"
    );
    let (_, spared) = spent(|effort| effort.spared);
    assert!(spared > 0 && spared < 5 * 10 * 10 * hit.due, "{spared}");
    assert!(hit.looks >= hit.due / 10, "{hit:?}");
}
