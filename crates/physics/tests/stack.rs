//! Faces and lines that carry: stacks, slopes, leaning and lying things (hard cases 3.4 to 3.11).
#![allow(
    clippy::disallowed_methods,
    reason = "what is expected may come from any library"
)]

mod support;

use glam::{DQuat, DVec3};
use physics::{
    BodyDef, BodyId, Effect, Effects, PairContact, Pose, Response, Settings, Shape, World,
};
use support::*;

const G: f64 = 9.81;

fn world(friction: f64) -> World {
    let settings = Settings {
        step_hz: 120.0,
        response: Response::Coulomb,
        effects: Effects::default().without(Effect::Sleeping),
        contact: PairContact {
            restitution: 0.0,
            friction,
        },
        ..Settings::default()
    };
    let mut world = World::new(settings).expect("settings are valid");
    let m = material(0.0, 0.5);
    world.add(block(
        m,
        DVec3::new(-5.0, -1.0, -5.0),
        DVec3::new(5.0, 0.0, 5.0),
    ));
    world
}

fn body(shape: Shape, mass: f64, inertia: DVec3, pose: Pose) -> BodyDef {
    solid(shape, mass, inertia, material(0.0, 0.5), pose)
}

fn cube(side: f64, mass: f64, at: DVec3) -> BodyDef {
    let shape = Shape::cuboid(DVec3::splat(side / 2.0)).expect("sizes are positive");
    let inertia = DVec3::splat(side * side / 6.0);
    body(shape, mass, inertia, Pose::from_position(at))
}

fn cylinder(radius: f64, half: f64, mass: f64, pose: Pose) -> BodyDef {
    let across = (3.0 * radius * radius + 4.0 * half * half) / 12.0;
    let inertia = DVec3::new(across, radius * radius / 2.0, across);
    body(
        Shape::cylinder(radius, half).expect("sizes are positive"),
        mass,
        inertia,
        pose,
    )
}

fn run(world: &mut World, seconds: f64) {
    for _ in 0..(seconds * 120.0) as u32 {
        world.step();
    }
}

fn position(world: &World, id: BodyId) -> DVec3 {
    world.body(id).pose().position
}

#[test]
fn ten_cubes_stand_on_each_other() {
    let mut world = world(0.5);
    let at = |k: usize| DVec3::Y * (0.1 + 0.2 * k as f64);
    let cubes: Vec<_> = (0..10).map(|k| world.add(cube(0.2, 1.0, at(k)))).collect();
    run(&mut world, 20.0);
    for (k, id) in cubes.iter().enumerate() {
        let moved = position(&world, *id) - at(k);
        assert!(moved.length() < 5e-4, "cube {k} moved by {moved}");
        assert!(tilt(&world, *id) < 0.1, "cube {k} leans");
    }
}

#[test]
fn a_heavy_cube_lies_on_a_light_one() {
    let mut world = world(0.5);
    let light = world.add(cube(0.2, 1.0, DVec3::Y * 0.1));
    let heavy = world.add(cube(0.2, 1000.0, DVec3::Y * 0.3));
    run(&mut world, 10.0);
    assert!((position(&world, light).y - 0.1).abs() < 1e-3);
    assert!((position(&world, heavy).y - 0.3).abs() < 2e-3);
    assert!(world.body(heavy).linear_velocity().length() < 1e-4);
}

#[test]
fn five_cylinders_stand_end_to_end() {
    let mut world = world(0.5);
    let at = |k: usize| DVec3::Y * (0.05 + 0.1 * k as f64);
    let all: Vec<_> = (0..5)
        .map(|k| world.add(cylinder(0.05, 0.05, 1.0, Pose::from_position(at(k)))))
        .collect();
    run(&mut world, 20.0);
    for (k, id) in all.iter().enumerate() {
        let moved = position(&world, *id) - at(k);
        assert!(moved.length() < 1e-4, "cylinder {k} moved by {moved}");
    }
}

#[test]
fn a_cylinder_on_its_side_neither_yaws_nor_rocks() {
    let mut world = world(0.5);
    let lying = DQuat::from_rotation_z(std::f64::consts::FRAC_PI_2);
    let pose = Pose::new(DVec3::Y * 0.05, lying);
    let id = world.add(cylinder(0.05, 0.1, 1.0, pose));
    run(&mut world, 20.0);
    let axis = world.body(id).pose().rotation * DVec3::Y;
    assert!(axis.y.abs() < 1e-6 && axis.z.abs() < 1e-4, "{axis}");
}

#[test]
fn a_box_slides_where_the_slope_is_steeper_than_its_friction() {
    for (degrees, slides) in [(26.4654, false), (26.6654, true), (30.0, true)] {
        let angle = f64::to_radians(degrees);
        let mu = f64::tan(f64::to_radians(26.5654));
        let settings = Settings {
            step_hz: 120.0,
            gravity: DVec3::new(G * angle.sin(), -G * angle.cos(), 0.0),
            effects: Effects::default().without(Effect::Sleeping),
            ..*world(mu).settings()
        };
        let mut world = World::new(settings).expect("settings are valid");
        let m = material(0.0, 0.5);
        world.add(block(
            m,
            DVec3::new(-5.0, -1.0, -5.0),
            DVec3::new(50.0, 0.0, 5.0),
        ));
        let id = world.add(cube(0.2, 1.0, DVec3::Y * 0.1));
        run(&mut world, 2.0);
        let x = position(&world, id).x;
        let acceleration = (G * (angle.sin() - mu * angle.cos())).max(0.0);
        let want = 0.5 * acceleration * 4.0;
        if slides {
            assert!((x - want).abs() < 0.01 * want, "{degrees}: {x}, not {want}");
        } else {
            // A tenth of a millimetre in a minute.
            assert!(x.abs() < 2.0 / 60.0 * 1e-4, "{degrees}: creeps {x}");
        }
    }
}

#[test]
fn a_box_dropped_flat_bounces_flat() {
    let settings = Settings {
        response: Response::Guarded,
        ..Settings::default()
    };
    let mut world = World::new(settings).expect("settings are valid");
    let m = material(1.0, 0.0);
    world.add(block(
        m,
        DVec3::new(-5.0, -1.0, -5.0),
        DVec3::new(5.0, 0.0, 5.0),
    ));
    let mut def = body(
        Shape::cuboid(DVec3::new(0.2, 0.1, 0.3)).unwrap(),
        2.0,
        DVec3::new(0.033, 0.043, 0.017),
        Pose::from_position(DVec3::new(0.3, 0.6, 0.2)),
    );
    def.material = m;
    let id = world.add(def);
    for _ in 0..720 {
        world.step();
    }
    assert!(world.body(id).angular_velocity().length() < 1e-6);
    let body = world.body(id);
    let apex = body.pose().position.y + body.linear_velocity().y.powi(2) / (2.0 * G);
    assert!((apex - 0.6).abs() < 1e-4, "{apex}");
}
