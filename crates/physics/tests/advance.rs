//! Certificates and times of impact, against brute force and closed forms.
#![allow(
    clippy::disallowed_methods,
    reason = "what is expected may come from any library"
)]

mod support;

use std::f64::consts::PI;

use glam::{DQuat, DVec3};
use physics::advance::{Certificate, Course, TimeOfImpact, Travel, time_of_impact};
use physics::query::{Limits, separation};
use physics::{Compound, Pose, Shape};
use support::*;

fn travel(compound: &Compound, pose: Pose, linear: DVec3, angular: DVec3) -> Travel<'_> {
    Travel {
        compound,
        pose,
        linear_velocity: linear,
        angular_velocity: angular,
    }
}

/// Smallest gap between parts of two bodies on their way, at a time [m].
fn gap(a: &Travel, b: &Travel, t: f64) -> f64 {
    let (pose_a, pose_b) = (a.pose_at(t), b.pose_at(t));
    let mut least = f64::INFINITY;
    for x in a.compound.parts() {
        for y in b.compound.parts() {
            let (at, bt) = (pose_a * x.pose, pose_b * y.pose);
            let found = separation((&x.shape, &at), (&y.shape, &bt), None, Limits::default());
            least = least.min(found.gap);
        }
    }
    least
}

fn shapes(random: &mut Random) -> Vec<Compound> {
    let mut size = |low: f64, high: f64| low + (high - low) * (0.5 * random.next() + 0.5);
    let part = |y: f64, shape: Shape| (Pose::from_position(DVec3::Y * y), shape);
    vec![
        Compound::single(Shape::sphere(size(0.02, 0.3)).expect("fixture sizes are positive")),
        Compound::single(
            Shape::capsule(size(0.01, 0.2), size(0.05, 0.5)).expect("fixture sizes are positive"),
        ),
        Compound::single(
            Shape::cylinder(size(0.01, 0.3), size(0.01, 0.5)).expect("fixture sizes are positive"),
        ),
        Compound::single(
            Shape::ellipsoid(DVec3::new(
                size(0.05, 0.3),
                size(0.05, 0.3),
                size(0.05, 0.3),
            ))
            .expect("fixture sizes are positive"),
        ),
        Compound::single(
            Shape::cuboid(DVec3::new(
                size(0.01, 0.3),
                size(0.01, 0.3),
                size(0.01, 0.3),
            ))
            .expect("fixture sizes are positive"),
        ),
        Compound::new(vec![
            part(
                -0.2,
                Shape::frustum(0.2, 0.05, 0.1).expect("fixture sizes are positive"),
            ),
            part(
                0.1,
                Shape::sphere(0.15).expect("fixture sizes are positive"),
            ),
        ])
        .expect("fixture sizes are positive"),
    ]
}

#[test]
fn no_motion_within_its_bounds_closes_the_gap_before_the_certified_time() {
    let seed = 41;
    println!("seed {seed}");
    let mut random = Random(seed);
    let shapes = shapes(&mut random);
    let (mut certificates, mut closest) = (0, f64::INFINITY);
    while certificates < 300 {
        let pick = |random: &mut Random| ((random.next() * 0.5 + 0.5) * 5.0) as usize;
        let bodies = [pick(&mut random), pick(&mut random)].map(|i| &shapes[i]);
        let start = [0, 1].map(|_| Pose::new(random.vector() * 0.8, random.rotation()));
        let parts = bodies.map(|b| b.parts()[0].shape.clone());
        let (x, y) = ((&parts[0], &start[0]), (&parts[1], &start[1]));
        let found = separation(x, y, None, Limits::default());
        let Some(certificate) = Certificate::from_separation(&found) else {
            continue;
        };
        certificates += 1;
        // What turns reaches its bound only with its farthest point: some do not, and come close.
        let turns = f64::from(u8::from(certificates % 3 > 0));
        let courses = bodies.map(|body| Course {
            linear_velocity: random.vector() * 3.0,
            turning_speed: turns * 10.0 * random.next().abs() * body.bounding_radius(),
            acceleration: 20.0 * random.next().abs(),
        });
        let time = certificate.holds_for(&courses[0], &courses[1]).min(2.0);
        // Half of the motions do their worst along the normal, the others wander.
        for motion in 0..20 {
            let (mut poses, steps) = (start, 100);
            let mut velocities = courses.map(|c| c.linear_velocity);
            let dt = time / f64::from(steps);
            for _ in 0..steps {
                for k in 0..2 {
                    let towards = certificate.normal * [1.0, -1.0][k];
                    let push = if motion % 2 == 0 {
                        towards
                    } else {
                        random.direction()
                    };
                    let axis = random.direction();
                    let rate = courses[k].turning_speed / bodies[k].bounding_radius();
                    let before = velocities[k];
                    velocities[k] += push * (courses[k].acceleration * dt);
                    poses[k].position += (before + velocities[k]) * (0.5 * dt);
                    poses[k].rotation = (DQuat::from_scaled_axis(axis * (rate * dt))
                        * poses[k].rotation)
                        .normalize();
                }
                let (x, y) = ((&parts[0], &poses[0]), (&parts[1], &poses[1]));
                let left = separation(x, y, None, Limits::default()).gap;
                assert!(left >= -1e-9, "{left} before {time} s of {certificate:?}");
                closest = closest.min(left);
            }
        }
    }
    println!("closest {closest:e} m");
    // A bound that nothing comes near would prove nothing.
    assert!(closest < 1e-3);
}

/// Time at which two balls touch: the smaller root of |d + v t| = r.
fn quadratic(d: DVec3, v: DVec3, r: f64) -> Option<f64> {
    let (a, b, c) = (v.dot(v), d.dot(v), d.dot(d) - r * r);
    let root = b * b - a * c;
    (root >= 0.0 && b < 0.0).then(|| c / (-b + root.sqrt()))
}

#[test]
fn balls_touch_at_the_root_of_their_quadratic() {
    let seed = 44;
    println!("seed {seed}");
    let mut random = Random(seed);
    let (mut hits, mut misses, mut searches, mut worst) = (0, 0, 0u64, 0.0f64);
    for round in 0.. {
        if hits == 10_000 {
            break;
        }
        let radii = [
            0.05 + 0.2 * random.next().abs(),
            0.05 + 0.2 * random.next().abs(),
        ];
        // Every second pair of balls sits beside the bodies' centres, where no ball around the body tells the time.
        let beside = f64::from(round / 2 % 2);
        let offsets = [0, 1].map(|_| random.vector() * 0.2 * beside);
        let spins = [0, 1].map(|_| random.vector() * 50.0 * (1.0 - beside));
        let balls = [0, 1].map(|k| {
            let at = Pose::from_position(offsets[k]);
            Compound::new(vec![(at, Shape::sphere(radii[k]).unwrap())]).unwrap()
        });
        let poses = [0, 1].map(|_| Pose::from_position(random.vector() * 2.0));
        let apart = poses[1].position + offsets[1] - poses[0].position - offsets[0];
        let speed = 100.0 * random.next().abs();
        // Half aim somewhere near the other, half anywhere; both are fast.
        let direction = if round % 2 == 0 {
            (apart + random.vector() * 0.5).try_normalize().unwrap()
        } else {
            random.direction()
        };
        let other = random.vector() * 30.0;
        let a = travel(&balls[0], poses[0], other + direction * speed, spins[0]);
        let b = travel(&balls[1], poses[1], other, spins[1]);
        let sum = radii[0] + radii[1];
        if apart.length() < sum {
            continue;
        }
        let expected = quadratic(apart, -direction * speed, sum).filter(|t| *t < 1.0);
        match (time_of_impact(&a, &b, 1.0), expected) {
            (Some(found), Some(t)) => {
                worst = worst.max((found.time - t).abs() * speed);
                assert!(!found.capped && found.time <= t + 1e-12);
                (hits, searches) = (hits + 1, searches + u64::from(found.searches));
            }
            (None, None) => misses += 1,
            (found, expected) => {
                // Only a touch that is hardly one may be judged either way.
                let t = -apart.dot(-direction * speed) / (speed * speed);
                let closest = (apart - direction * (speed * t)).length() - sum;
                let at_the_end = expected.is_some_and(|t| t > 1.0 - 1e-8);
                assert!(
                    closest.abs() < 1e-7 || at_the_end,
                    "{found:?} and {expected:?}"
                );
            }
        }
    }
    let mean = searches as f64 / f64::from(hits);
    println!("{hits} hits, {misses} misses, error {worst:e} m, {mean:.2} searches");
    assert!(worst <= 1e-6, "error times speed is {worst} m");
    assert!(mean <= 5.0, "{mean} searches per touch");
}

/// Checks a time of impact against the gap at many times.
fn verify(a: &Travel, b: &Travel, duration: f64, found: Option<&TimeOfImpact>) {
    let until = found.map_or(duration, |f| f.time);
    for i in 0..=400 {
        let t = until * f64::from(i) / 400.0;
        let left = gap(a, b, t);
        assert!(left > -1.1e-7, "gap {left} at {t} s, {found:?}");
    }
    if let Some(found) = found {
        // The turn of a ball moves nothing.
        let turning = |x: &Travel| {
            let radius = x.compound.bounding_radius();
            if *x.compound == Compound::single(Shape::sphere(radius).expect("a radius is positive"))
            {
                0.0
            } else {
                x.compound.bounding_radius() * x.angular_velocity.length()
            }
        };
        let linear = (a.linear_velocity - b.linear_velocity).length();
        let speed = linear + turning(a) + turning(b);
        let after = gap(a, b, found.time + 1e-6 / speed);
        assert!(after <= 1e-12, "gap {after} after {found:?}");
    }
}

#[test]
fn touches_of_random_pairs_are_neither_early_nor_late() {
    let seed = 7;
    println!("seed {seed}");
    let mut random = Random(seed);
    let (mut hits, mut searches, mut iterations) = (0, 0, 0);
    for round in 0..3000 {
        let shapes = shapes(&mut random);
        let (i, j) = (round % 6, round / 6 % 6);
        let poses = [0, 1].map(|_| Pose::new(random.vector() * 0.9, random.rotation()));
        let towards = poses[1].position - poses[0].position + random.vector() * 0.3;
        let speed = 100f64.powf(random.next().abs());
        let a = travel(
            &shapes[i],
            poses[0],
            towards * speed,
            random.vector() * 50.0,
        );
        let b = travel(
            &shapes[j],
            poses[1],
            random.vector() * speed,
            random.vector() * 50.0,
        );
        if gap(&a, &b, 0.0) <= 0.0 {
            assert_eq!(time_of_impact(&a, &b, 0.1).map(|f| f.time), Some(0.0));
            continue;
        }
        let found = time_of_impact(&a, &b, 0.1);
        verify(&a, &b, 0.1, found.as_ref());
        if let Some(found) = found {
            assert!(!found.capped, "{found:?}");
            hits += 1;
            searches += found.searches;
            iterations += found.iterations;
        }
    }
    let mean = |x: u32| f64::from(x) / f64::from(hits);
    println!(
        "{hits} hits: {:.2} searches, {:.2} iterations",
        mean(searches),
        mean(iterations)
    );
    assert!(hits > 400);
}

#[test]
fn thin_rods_that_spin_at_50_rad_per_s_hit_each_other() {
    // A rod 2 mm thick sweeps through one that crosses its plane. By its angular sweep alone it hits in every phase
    // in which it reaches the other within the time.
    let rod = Compound::single(Shape::capsule(0.001, 0.5).unwrap());
    for phase in 0..64 {
        let angle = PI * (0.02 + 0.96 * f64::from(phase) / 64.0);
        for distance in [0.05, 0.3, 0.49] {
            let across = Pose::new(DVec3::X * distance, DQuat::from_rotation_x(PI / 2.0));
            let turned = Pose::new(DVec3::ZERO, DQuat::from_rotation_z(PI / 2.0 + angle));
            let a = travel(&rod, turned, DVec3::ZERO, DVec3::Z * 50.0);
            let b = travel(&rod, across, DVec3::ZERO, DVec3::ZERO);
            let found = time_of_impact(&a, &b, 0.1).expect("a rod that comes round hits");
            // Both are cylinders of 1 mm about their lines: they touch when the lines are 2 mm apart.
            let before = libm::asin(0.002 / distance);
            let expected = (PI - angle - before) / 50.0;
            let error = (found.time - expected).abs() * 25.0;
            assert!(error <= 1e-6, "{found:?} instead of {expected}");
        }
    }
}

#[test]
fn nothing_tunnels_at_any_phase_with_both_bodies_fast() {
    let ball = Compound::single(Shape::sphere(BALL_RADIUS).unwrap());
    let wall = Compound::single(Shape::cuboid(DVec3::new(0.5, 0.5, 0.0005)).unwrap());
    let pin = composite_pin();
    for speed in [8.0, 20.0, 50.0, 100.0] {
        for phase in 0..64 {
            let back = 0.5 + speed / 90.0 * f64::from(phase) / 64.0;
            let spin = DVec3::X * (speed / BALL_RADIUS);
            let start = Pose::from_position(DVec3::new(0.0, 0.02, back));
            let a = travel(&ball, start, DVec3::NEG_Z * speed, -spin);
            // The other comes to meet it, and turns.
            let b = travel(&wall, Pose::IDENTITY, DVec3::Z * speed, DVec3::Z * 20.0);
            let found = time_of_impact(&a, &b, 1.0).expect("the ball hits the wall");
            let expected = (back - BALL_RADIUS - 0.0005) / (2.0 * speed);
            assert!((found.time - expected).abs() * 2.0 * speed <= 1e-6);
            let b = travel(&pin, Pose::IDENTITY, DVec3::Z * speed, DVec3::Y * 20.0);
            let found = time_of_impact(&a, &b, 1.0).expect("the ball hits the pin");
            verify(&a, &b, 1.0, Some(&found));
            assert_eq!(found.parts.1, 1, "the belly");
        }
    }
}
