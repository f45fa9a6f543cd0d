//! Peers in the same rounds: parry's GJK and EPA on the same support points, rapier on the same scenarios.

use glam::DVec3;
use parry3d_f64::math::{Pose as ParryPose, Rotation, Vector as ParryVector};
use parry3d_f64::query::details::contact_support_map_support_map;
use parry3d_f64::shape::SupportMap;
use physics::{Pose, Shape};
use rapier3d::dynamics::{
    CoefficientCombineRule, MassProperties, RigidBodyBuilder, RigidBodyHandle,
};
use rapier3d::geometry::{ColliderBuilder, SharedShape};
use rapier3d::math::Vector;
use rapier3d::pipeline::PhysicsWorld;

use super::oracle::Placed;
use super::simbench::{Form, GRAVITY, Scenario, Simulated};

/// One of our shapes as parry's generic algorithm wants it.
struct Map<'a>(&'a Shape);

impl SupportMap for Map<'_> {
    fn local_support_point(&self, direction: ParryVector) -> ParryVector {
        let d = DVec3::new(direction.x, direction.y, direction.z);
        let p = self.0.support(d);
        ParryVector::new(p.x, p.y, p.z)
    }
}

fn parry_pose(pose: &Pose) -> ParryPose {
    let (p, q) = (pose.position, pose.rotation);
    ParryPose::from_parts(
        ParryVector::new(p.x, p.y, p.z),
        Rotation::from_xyzw(q.x, q.y, q.z, q.w),
    )
}

/// Signed gap [m] and normal from a to b of two placed shapes by GJK and EPA; `None` if they answer nothing.
pub fn gap(a: Placed, b: Placed) -> Option<(f64, DVec3)> {
    let (pose_a, pose_b) = (parry_pose(a.1), parry_pose(b.1));
    let between = pose_a.inv_mul(&pose_b);
    let contact = contact_support_map_support_map(&between, &Map(a.0), &Map(b.0), 10.0)?;
    let n = contact.normal1;
    Some((contact.dist, a.1.rotation * DVec3::new(n.x, n.y, n.z)))
}

/// A scenario in rapier, in single precision.
pub struct Rapier {
    world: PhysicsWorld,
    handles: Vec<RigidBodyHandle>,
    masses: Vec<(f64, DVec3)>,
}

fn vector(v: DVec3) -> Vector {
    Vector::new(v.x as f32, v.y as f32, v.z as f32)
}

fn double(v: Vector) -> DVec3 {
    DVec3::new(f64::from(v.x), f64::from(v.y), f64::from(v.z))
}

impl Rapier {
    /// The scenario with so many steps a second [1/s] and solver iterations.
    ///
    /// A pair's friction is the product of two colliders' there: the ground has 1, a box its own on the ground, and a ball
    /// what makes the product with a box right. A ball on the ground would have friction then, so scenes have either.
    pub fn new(scenario: &Scenario, hz: f64, iterations: usize) -> Rapier {
        let mut world = PhysicsWorld::new();
        world.gravity = vector(DVec3::NEG_Y * GRAVITY);
        world.integration_parameters.dt = (1.0 / hz) as f32;
        world.integration_parameters.num_solver_iterations = iterations;
        let [on_box, on_ground] = scenario.friction;
        let of_ball = if on_ground > 0.0 {
            on_box / on_ground
        } else {
            0.0
        };
        let collider = |shape: SharedShape, friction: f64| {
            ColliderBuilder::new(shape)
                .density(0.0)
                .restitution(scenario.restitution as f32)
                .friction(friction as f32)
                .friction_combine_rule(CoefficientCombineRule::Multiply)
        };
        let ground = SharedShape::halfspace(Vector::Y);
        world.insert(RigidBodyBuilder::fixed(), collider(ground, 1.0));
        let mut handles = Vec::new();
        for (index, thing) in scenario.things.iter().enumerate() {
            let (shape, friction) = match thing.form {
                Form::Ball(radius) => (SharedShape::ball(radius as f32), of_ball),
                Form::Cuboid(half) => {
                    let half = vector(half);
                    (SharedShape::cuboid(half.x, half.y, half.z), on_ground)
                }
            };
            let inertia = vector(thing.inertia());
            let mass = MassProperties::new(Vector::ZERO, thing.mass as f32, inertia);
            let body = RigidBodyBuilder::dynamic()
                .translation(vector(thing.at))
                .additional_mass_properties(mass)
                .can_sleep(false);
            let (handle, _) = world.insert(body, collider(shape, friction));
            if index == 0 && scenario.force != DVec3::ZERO {
                world.bodies[handle].add_force(vector(scenario.force), true);
            }
            handles.push(handle);
        }
        let masses = scenario
            .things
            .iter()
            .map(|thing| (thing.mass, thing.inertia()));
        Rapier {
            world,
            handles,
            masses: masses.collect(),
        }
    }
}

impl Simulated for Rapier {
    fn step(&mut self) {
        self.world.step();
    }

    fn state(&self, index: usize) -> (DVec3, DVec3) {
        let body = &self.world.bodies[self.handles[index]];
        (double(body.translation()), double(body.linvel()))
    }

    fn energy(&self) -> f64 {
        let bodies = self.handles.iter().zip(&self.masses);
        let energy = bodies.map(|(handle, (mass, inertia))| {
            let body = &self.world.bodies[*handle];
            let (v, w) = (double(body.linvel()), double(body.angvel()));
            let height = double(body.translation()).y;
            // All moments of a ball are the same; the box of the scenarios does not turn.
            mass * (GRAVITY * height + 0.5 * v.length_squared()) + 0.5 * w.dot(*inertia * w)
        });
        energy.sum()
    }
}
