//! The peer: the same lane, pins and ball in rapier3d, single precision, with its default parameters.
//!
//! It has neither ellipsoids nor frustums, and its time depends on what stands for them, so there are three pins. Mass and
//! moments of inertia are ours in all of them, not the shapes'.

use std::f64::consts::TAU;

use glam::DVec3;
use rapier3d::dynamics::{MassProperties, RigidBodyBuilder, RigidBodyHandle};
use rapier3d::geometry::{ColliderBuilder, SharedShape};
use rapier3d::math::{Pose, Vector};
use rapier3d::pipeline::PhysicsWorld;

use crate::scenes::{PAIR, SPEED, START, offset};
use crate::support::{
    BALL_MASS, BALL_RADIUS, BASE_RADIUS, PIN_CG, PIN_MASS, building_boxes, spots,
};

/// What stands for the parts of a pin. The head is a ball in each.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Pins {
    /// What it has closed forms for, the cheapest pin of four parts: cylinders for base and neck, a capsule for the belly.
    Primitives,
    /// Hulls of two rings of points for base and neck, a capsule for the belly.
    Frustums,
    /// Hulls for all three; the belly's of nine rings.
    Hulls,
}

/// The three pins with their names.
pub const PEERS: [(&str, Pins); 3] = [
    ("primitives", Pins::Primitives),
    ("frustums", Pins::Frustums),
    ("hulls", Pins::Hulls),
];
/// Points of a ring of a hull.
const RING: u32 = 16;

/// A world of the peer with its pins.
pub struct Peer {
    world: PhysicsWorld,
    pins: Vec<RigidBodyHandle>,
}

fn vector(v: DVec3) -> Vector {
    Vector::new(v.x as f32, v.y as f32, v.z as f32)
}

fn mass(ours: physics::MassProperties) -> MassProperties {
    MassProperties::new(Vector::ZERO, ours.mass as f32, vector(ours.inertia))
}

/// Surface without a mass of its own.
fn collider(shape: SharedShape) -> ColliderBuilder {
    ColliderBuilder::new(shape)
        .density(0.0)
        .restitution(PAIR.restitution as f32)
        .friction(PAIR.friction as f32)
}

/// Hull of rings of points, each a height and a radius [m].
fn hull(rings: impl IntoIterator<Item = (f64, f64)>) -> SharedShape {
    let ring = |(y, r): (f64, f64)| {
        (0..RING).map(move |k| {
            let (sin, cos) = (f64::from(k) / f64::from(RING) * TAU).sin_cos();
            vector(DVec3::new(r * cos, y, r * sin))
        })
    };
    let points: Vec<Vector> = rings.into_iter().flat_map(ring).collect();
    SharedShape::convex_hull(&points).expect("rings at different heights span a volume")
}

/// Base, belly and neck, each about its own middle.
fn parts(pins: Pins) -> [SharedShape; 3] {
    let (wide, tall) = (0.0605, 0.112);
    let capsule = SharedShape::capsule_y((tall - wide) as f32, wide as f32);
    let base = hull([(-0.0095, BASE_RADIUS), (0.0095, 0.0359)]);
    let neck = hull([(-0.028, 0.0265), (0.028, 0.0230)]);
    match pins {
        Pins::Primitives => [
            SharedShape::cylinder(0.0095, BASE_RADIUS as f32),
            capsule,
            SharedShape::cylinder(0.028, 0.02475),
        ],
        Pins::Frustums => [base, capsule, neck],
        Pins::Hulls => {
            let rings = (-4..=4).map(|i| {
                let (sin, cos) = (f64::from(i) * 0.37).sin_cos();
                (tall * sin, wide * cos)
            });
            [base, hull(rings), neck]
        }
    }
}

fn pin_shape(pins: Pins) -> SharedShape {
    let up = |y: f64| Pose::from_translation(vector(DVec3::Y * (y - PIN_CG)));
    let [base, belly, neck] = parts(pins);
    SharedShape::compound(vec![
        (up(0.0095), base),
        (up(0.1143), belly),
        (up(0.247), neck),
        (up(0.3487), SharedShape::ball(0.0323)),
    ])
}

impl Peer {
    /// A rack, and no ball.
    pub fn rack(pins: Pins, rate: u32, sleeping: bool) -> Peer {
        let mut world = PhysicsWorld::new();
        world.integration_parameters.dt = 1.0 / rate as f32;
        for (low, high) in building_boxes() {
            let half = vector((high - low) * 0.5);
            let at = RigidBodyBuilder::fixed().translation(vector((low + high) * 0.5));
            world.insert(at, collider(SharedShape::cuboid(half.x, half.y, half.z)));
        }
        let shape = pin_shape(pins);
        let pins = spots().into_iter().map(|spot| {
            let body = RigidBodyBuilder::dynamic()
                .translation(vector(spot + DVec3::Y * PIN_CG))
                .additional_mass_properties(mass(PIN_MASS))
                .can_sleep(sleeping);
            world.insert(body, collider(shape.clone())).0
        });
        let pins = pins.collect();
        Peer { world, pins }
    }

    /// Throw `i`, about to begin.
    pub fn shot(pins: Pins, rate: u32, i: u32) -> Peer {
        let mut peer = Peer::rack(pins, rate, true);
        let at = DVec3::new(offset(i), BALL_RADIUS, START - 18.288);
        let body = RigidBodyBuilder::dynamic()
            .translation(vector(at))
            .additional_mass_properties(mass(BALL_MASS))
            .linvel(vector(DVec3::NEG_Z * SPEED))
            .angvel(vector(DVec3::NEG_X * (SPEED / BALL_RADIUS)));
        peer.world
            .insert(body, collider(SharedShape::ball(BALL_RADIUS as f32)));
        peer
    }

    /// Takes one step.
    pub fn step(&mut self) {
        self.world.step();
    }

    /// Takes `steps` steps.
    pub fn run(&mut self, steps: u32) {
        for _ in 0..steps {
            self.step();
        }
    }

    /// Number of pins that lean or lie lower than a standing pin does.
    pub fn fallen(&self) -> usize {
        let is_down = |handle: &&RigidBodyHandle| {
            let pose = self.world.bodies[**handle].position();
            (pose.rotation * Vector::Y).y < 0.9 || pose.translation.y < BALL_RADIUS as f32
        };
        self.pins.iter().filter(is_down).count()
    }

    /// Number of bodies that move by themselves and do not sleep.
    pub fn awake(&self) -> usize {
        let bodies = self.world.bodies.iter();
        let awake = bodies.filter(|(_, body)| body.is_dynamic() && !body.is_sleeping());
        awake.count()
    }
}
