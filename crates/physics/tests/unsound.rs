//! Numbers that are none, and bodies that nothing can be made of: they stop at their own body and reach no other.

mod support;

use glam::{DQuat, DVec3};
use physics::{
    BodyDef, BodyId, Material, Motion, PairContact, Pose, Response, Settings, Shape, World,
};
use support::*;

const LAWS: [Response; 3] = [Response::UnoSlater, Response::Guarded, Response::Coulomb];

fn settings(response: Response) -> Settings {
    Settings {
        response,
        contact: PairContact {
            restitution: 0.5,
            friction: 0.4,
        },
        ..Settings::default()
    }
}

fn cube(at: DVec3) -> BodyDef {
    let shape = Shape::cuboid(DVec3::splat(0.1)).expect("a cube has a size");
    let inertia = DVec3::splat(0.04 / 6.0);
    solid(
        shape,
        1.0,
        inertia,
        material(0.5, 0.7),
        Pose::from_position(at),
    )
}

fn ground() -> BodyDef {
    let corner = DVec3::new(5.0, 1.0, 5.0);
    block(
        material(0.5, 0.7),
        -corner,
        corner * DVec3::new(1.0, 0.0, 1.0),
    )
}

fn run(world: &mut World, steps: u32) {
    for _ in 0..steps {
        world.step();
    }
}

/// Two cubes that touch: on each other on the ground, or face to face where nothing has weight.
fn two_cubes(response: Response, has_weight: bool) -> (World, [BodyId; 2]) {
    let mut settings = settings(response);
    if !has_weight {
        settings.gravity = DVec3::ZERO;
    }
    let mut world = World::new(settings).expect("these settings run");
    if has_weight {
        world.add(ground());
    }
    let mut upper = cube(DVec3::Y * 0.3);
    if !has_weight {
        upper.linear_velocity = DVec3::NEG_Y * 1e-5;
    }
    let ids = [world.add(cube(DVec3::Y * 0.1)), world.add(upper)];
    run(&mut world, 20);
    assert!(world.touching(ids[0], ids[1]), "the cubes begin in contact");
    (world, ids)
}

#[test]
fn a_velocity_that_is_none_freezes_its_body_and_not_what_it_touches() {
    let huge = DVec3::X * 1e200;
    for response in LAWS {
        for has_weight in [true, false] {
            for (linear, angular) in [
                (DVec3::NAN, DVec3::ZERO),
                (DVec3::ZERO, DVec3::NAN),
                (DVec3::X * f64::INFINITY, DVec3::ZERO),
                (huge, DVec3::ZERO),
                (DVec3::ZERO, huge),
            ] {
                let (mut world, [lower, upper]) = two_cubes(response, has_weight);
                let before = [lower, upper].map(|id| world.body(id).pose().position);
                world.set_velocity(upper, linear, angular);
                run(&mut world, 20);
                let what = format!("{response:?}, weight {has_weight}, {linear} {angular}");
                assert!(world.body(upper).is_frozen(), "{what}");
                assert!(!world.body(lower).is_frozen(), "{what}: the other froze");
                for (id, from) in [lower, upper].into_iter().zip(before) {
                    let body = world.body(id);
                    let moved = (body.pose().position - from).length();
                    assert!(moved < 1e-5, "{what}: moved by {moved} m");
                    assert!(body.linear_velocity().length() < 1e-4, "{what}");
                }
            }
        }
    }
}

#[test]
fn a_hand_that_would_need_an_endless_speed_freezes_and_not_what_it_holds() {
    for response in LAWS {
        let mut world = World::new(settings(response)).expect("these settings run");
        world.add(ground());
        let lying = world.add(cube(DVec3::Y * 0.1));
        let hand = world.add(hand(material(0.5, 0.7), DVec3::new(0.0, 0.249, 0.0)));
        run(&mut world, 20);
        world.drive_to(hand, Pose::from_position(DVec3::Y * 1e308));
        run(&mut world, 20);
        assert!(world.body(hand).is_frozen());
        assert!(world.body(hand).pose().position.length() < 1.0);
        assert!(!world.body(lying).is_frozen(), "{response:?}");
        assert!(world.body(lying).pose().position.length() < 0.2);
    }
}

#[test]
fn coefficients_outside_0_to_1_freeze_their_body_and_nothing_panics() {
    for response in LAWS {
        for motion in [Motion::Dynamic, Motion::Driven, Motion::Fixed] {
            for bad in [f64::NAN, -1.0, 2.0, f64::INFINITY] {
                for (elasticity, friction_rate) in [(bad, 0.7), (0.7, bad)] {
                    let mut world = World::new(settings(response)).expect("these settings run");
                    let mut def = ground();
                    def.motion = motion;
                    def.material = Material {
                        elasticity,
                        friction_rate,
                        ..def.material
                    };
                    let id = world.add(def);
                    let mut def = ball(material(0.9, 0.9), DVec3::Y * (BALL_RADIUS + 0.02));
                    def.linear_velocity = DVec3::new(2.0, -1.0, 0.0);
                    def.angular_velocity = DVec3::new(3.0, 5.0, 40.0);
                    let ball = world.add(def);
                    let (what, start) = (format!("{response:?} {motion:?} {bad}"), world.energy());
                    assert!(world.body(id).is_frozen(), "{what}");
                    run(&mut world, 360);
                    assert!(!world.body(ball).is_frozen(), "{what}");
                    assert!(world.energy() <= start, "{what}: gains energy");
                    let pose = world.body(id).pose();
                    world.set_pose(id, pose);
                    assert!(world.body(id).is_frozen(), "{what}: a pose mends nothing");
                }
            }
        }
    }
}

#[test]
fn no_call_thaws_a_body_that_no_mass_can_move() {
    for bad in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        let mut world = World::new(Settings::default()).expect("default settings run");
        let at = DVec3::Y * 2.0;
        let with_mass = |motion| {
            let mut def = cube(at);
            (def.motion, def.mass.mass, def.mass.inertia.y) = (motion, bad, bad);
            def
        };
        let moved = world.add(with_mass(Motion::Dynamic));
        let fixed = world.add(with_mass(Motion::Fixed));
        assert!(world.body(moved).is_frozen());
        assert!(
            !world.body(fixed).is_frozen(),
            "what is fixed needs no mass"
        );
        world.set_pose(moved, Pose::from_position(at));
        world.set_velocity(moved, DVec3::X, DVec3::Y);
        world.set_motion(moved, Motion::Driven);
        world.set_motion(moved, Motion::Dynamic);
        world.set_motion(fixed, Motion::Dynamic);
        let falling = world.add(cube(DVec3::Y * 2.3));
        run(&mut world, 360);
        let above = world.body(falling).pose().position.y - 2.0;
        assert!((above - 0.2).abs() < 1e-3, "lies {above} m above");
        assert!(world.energy().is_finite());
        for id in [moved, fixed] {
            let body = world.body(id);
            assert!(body.is_frozen(), "mass {bad}");
            assert_eq!(body.pose().position, at);
            assert_eq!(body.linear_velocity(), DVec3::ZERO);
        }
        world.set_motion(fixed, Motion::Fixed);
        world.set_pose(fixed, Pose::from_position(at));
        assert!(!world.body(fixed).is_frozen());
    }
}

#[test]
fn a_frozen_body_is_thawed_by_a_pose_and_by_nothing_else() {
    let mut world = World::new(Settings::default()).expect("default settings run");
    let id = world.add(cube(DVec3::Y));
    world.set_velocity(id, DVec3::NAN, DVec3::ZERO);
    world.set_velocity(id, DVec3::X, DVec3::ZERO);
    world.set_motion(id, Motion::Dynamic);
    run(&mut world, 10);
    assert!(world.body(id).is_frozen());
    assert_eq!(world.body(id).pose().position, DVec3::Y);
    world.set_pose(id, Pose::from_position(DVec3::NAN));
    assert!(world.body(id).is_frozen() && world.body(id).pose().is_finite());
    world.set_pose(id, Pose::from_position(DVec3::X));
    run(&mut world, 10);
    assert!(!world.body(id).is_frozen());
    assert!(world.body(id).pose().position.y < 0.0, "it falls again");
}

#[test]
fn a_target_without_an_orientation_is_ignored() {
    let mut world = World::new(Settings::default()).expect("default settings run");
    let id = world.add(hand(material(0.5, 0.5), DVec3::ZERO));
    let nowhere = Pose {
        position: DVec3::X,
        rotation: DQuat::from_xyzw(0.0, 0.0, 0.0, 0.0),
    };
    world.drive_to(id, nowhere);
    run(&mut world, 2);
    assert!(!world.body(id).is_frozen());
    assert_eq!(world.body(id).pose(), Pose::from_position(DVec3::ZERO));
}

#[test]
fn broken_state_freezes_its_body_and_leaves_the_others_alone() {
    let m = material(0.7, 0.7);
    let (mut world, ids) = alley(Settings::default(), &composite_pin(), m);
    world.step();
    world.set_velocity(ids[3], DVec3::new(f64::NAN, 0.0, 0.0), DVec3::ZERO);
    run(&mut world, 720);
    assert!(world.body(ids[3]).is_frozen());
    assert!(ids.iter().all(|id| world.body(*id).pose().is_finite()));
    assert!(ids.iter().all(|id| tilt(&world, *id) < 1e-6));
}
