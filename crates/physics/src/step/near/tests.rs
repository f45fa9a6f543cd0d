//! The broad phase against looking at every pair.

use std::sync::Arc;

use glam::{DQuat, DVec3};

use crate::query::{Limits, separation};
use crate::random::Random;
use crate::{BodyDef, Compound, MassProperties, Material, Motion, Pose, Settings, Shape, World};

const DT: f64 = 1.0 / 720.0;

impl Random {
    /// Small and large ones alike: two decades up to `largest`.
    fn size(&mut self, largest: f64) -> f64 {
        largest * libm::pow(10.0, self.next() - 1.0)
    }

    fn pose(&mut self) -> Pose {
        Pose::new(
            self.vector() * 1.5,
            DQuat::from_scaled_axis(self.vector() * 3.0),
        )
    }

    fn body(&mut self, kind: u32) -> BodyDef {
        let mut shape = |kind: u32| match kind % 4 {
            0 => Shape::sphere(self.size(0.3)),
            1 => Shape::cylinder(self.size(0.3), self.size(0.5)),
            2 => Shape::cuboid(DVec3::new(self.size(0.5), self.size(0.5), self.size(0.5))),
            _ => Shape::ellipsoid(DVec3::new(self.size(0.3), self.size(0.3), self.size(0.3))),
        };
        let single = shape(kind).unwrap();
        let compound = match kind {
            // Two of the building: a lane, and the ground.
            40 => Compound::single(Shape::cuboid(DVec3::new(0.5, 0.1, 10.0)).unwrap()),
            41 => Compound::single(Shape::half_space(DVec3::Y).unwrap()),
            _ if kind.is_multiple_of(3) => {
                let other = (
                    Pose::from_position(DVec3::Y * 0.2),
                    shape(kind / 3).unwrap(),
                );
                Compound::new(vec![(Pose::IDENTITY, single), other]).unwrap()
            }
            _ => Compound::single(single),
        };
        let (motion, pose) = match kind {
            40 => (Motion::Fixed, self.pose()),
            41 => (Motion::Fixed, Pose::from_position(DVec3::Y * -2.0)),
            _ if kind % 7 == 3 => (Motion::Fixed, self.pose()),
            _ if kind % 11 == 5 => (Motion::Driven, self.pose()),
            _ => (Motion::Dynamic, self.pose()),
        };
        BodyDef {
            compound: Arc::new(compound),
            motion,
            mass: MassProperties {
                mass: 1.0,
                inertia: DVec3::splat(0.01),
            },
            material: Material {
                elasticity: 1.0,
                friction_rate: 0.0,
                surface: crate::surface::Surface::default(),
            },
            pose,
            linear_velocity: DVec3::ZERO,
            angular_velocity: DVec3::ZERO,
            drag_area_m2: 0.0,
        }
    }
}

fn world(random: &mut Random) -> World {
    let settings = Settings {
        gravity: DVec3::ZERO,
        ..Settings::default()
    };
    let mut world = World::new(settings).unwrap();
    for kind in 0..46 {
        world.add(random.body(kind));
    }
    world
}

/// Smallest gap between parts of two bodies as they stand [m].
fn gap(world: &World, a: usize, b: usize) -> f64 {
    let (a, b) = (&world.bodies[a], &world.bodies[b]);
    let mut least = f64::INFINITY;
    for x in a.compound.parts() {
        for y in b.compound.parts() {
            let (at, bt) = (a.pose() * x.pose, b.pose() * y.pose);
            let found = separation((&x.shape, &at), (&y.shape, &bt), None, Limits::default());
            least = least.min(found.gap);
        }
    }
    least
}

/// Checks every pair of the world against what is due; returns how many it has, and how many come within reach.
fn check(world: &World) -> (u32, u32) {
    let (mut seen, mut close) = (0, 0);
    for b in 0..world.bodies.len() {
        for a in 0..b {
            seen += 1;
            let (x, y) = (&world.bodies[a], &world.bodies[b]);
            let moved = x.motion == Motion::Dynamic || y.motion == Motion::Dynamic;
            let reach = x.reach + y.reach;
            let apart = (x.position - y.position).length()
                - x.compound.bounding_radius()
                - y.compound.bounding_radius();
            if !moved || reach == 0.0 || apart > reach {
                continue;
            }
            let gap = gap(world, a, b);
            let place = world.pairs.near(a).iter().find(|n| n.other == b as u32);
            let Some(near) = place else {
                assert!(
                    gap > reach,
                    "{a} and {b}: gap {gap}, reach {reach}, not near"
                );
                continue;
            };
            let left = world.pairs.get(near.pair).clearance - (x.path + y.path);
            assert!(
                left <= gap.max(0.0) + 1e-9,
                "{a} and {b}: {left} left of {gap}"
            );
            if gap <= reach {
                close += 1;
                let is_due = world.scratch.due.iter().any(|due| due.2 == near.pair);
                assert!(is_due, "{a} and {b}: gap {gap}, reach {reach}, not due");
            }
        }
    }
    (seen, close)
}

#[test]
fn no_pair_within_reach_is_missed_in_four_million_poses() {
    let seed = 510;
    println!("seed {seed}");
    let mut random = Random(seed);
    let (mut seen, mut close) = (0, 0);
    while seen < 4_000_000 {
        let mut world = world(&mut random);
        let ids: Vec<_> = world.ids().collect();
        for _ in 0..200 {
            for id in &ids {
                let may_jump = world.body(*id).compound.bounding_radius().is_finite();
                let is_gone = world.body(*id).pose().position.length() > 2.5;
                if may_jump && (is_gone || random.next() > 0.98) {
                    world.set_pose(*id, random.pose());
                }
                if random.next() > 0.96 {
                    // Up to 100 m/s and 50 rad/s, and some come to rest.
                    let fast = random.size(100.0) * f64::from(u8::from(random.next() > -0.5));
                    world.set_velocity(*id, random.vector() * fast, random.vector() * 50.0);
                }
            }
            world.awake.sort_unstable();
            for slot in world.awake.clone() {
                world.bodies[slot as usize].until = DT;
                world.bodies[slot as usize].look_ahead();
            }
            world.gather_due();
            let found = check(&world);
            (seen, close) = (seen + found.0, close + found.1);
            // They go on without regard to each other.
            for (_, _, pair) in std::mem::take(&mut world.scratch.due) {
                world.first_contact(pair, 0.0, DT);
                world.wait(pair);
            }
            for i in 0..world.awake.len() {
                world.end_step(world.awake[i] as usize, DT);
            }
            world.dismiss();
        }
    }
    println!("{seen} poses of pairs, {close} within reach");
    assert!(close > 10_000);
}

#[test]
fn nothing_passes_anything_in_a_room_of_fast_bodies() {
    let seed = 44;
    println!("seed {seed}");
    let mut random = Random(seed);
    let mut world = world(&mut random);
    for id in world.ids().collect::<Vec<_>>() {
        world.remove(id);
    }
    for side in [DVec3::X, DVec3::Y, DVec3::Z] {
        for n in [side, -side] {
            let mut def = random.body(41);
            def.compound = Arc::new(Compound::single(Shape::half_space(n).unwrap()));
            def.pose = Pose::from_position(n * -2.0);
            world.add(def);
        }
    }
    for i in 0..27 {
        let mut def = random.body(0);
        let shape = match i % 3 {
            0 => Shape::sphere(0.1),
            1 => Shape::cylinder(0.01, 0.4),
            _ => Shape::ellipsoid(DVec3::new(0.2, 0.05, 0.1)),
        };
        def.compound = Arc::new(Compound::single(shape.unwrap()));
        let cell = DVec3::new(f64::from(i % 3), f64::from(i / 3 % 3), f64::from(i / 9));
        def.pose = Pose::from_position((cell - 1.0) * 1.1);
        def.linear_velocity = random.vector() * 100.0;
        def.angular_velocity = random.vector() * 30.0;
        world.add(def);
    }
    let mut impacts = 0;
    for _ in 0..200 {
        world.step();
        impacts += world.impacts().len();
        for b in 0..world.bodies.len() {
            for a in 0..b {
                if world.contains(world.id(a))
                    && world.contains(world.id(b))
                    && world.bodies[b].motion == Motion::Dynamic
                {
                    let gap = gap(&world, a, b);
                    assert!(gap > -2e-5, "{a} and {b}: {gap} at {}", world.steps());
                }
            }
        }
    }
    println!("{impacts} impacts");
    assert!(impacts > 300);
}
