//! Gaps that are formulas.

use glam::{DQuat, DVec2, DVec3};
use physics::Pose;

use crate::judge::built::surface_point;
use crate::judge::cases::{self, Case, between, direction, random_shape, rotation};
use crate::judge::known::Known;
use crate::support::Random;
use crate::{Wrong, answer};

/// Signed distance of a point from a frustum: in the plane through the axis it is a trapezoid.
fn from_frustum(bottom: f64, top: f64, h: f64, p: DVec3) -> f64 {
    let q = DVec2::new(p.x.hypot(p.z), p.y);
    let (low, high) = (DVec2::new(bottom, -h), DVec2::new(top, h));
    let along = high - low;
    let outward = DVec2::new(along.y, -along.x) / along.length();
    let inside = outward.dot(q - low).max(q.y.abs() - h);
    if inside <= 0.0 {
        return inside;
    }
    let to_segment = |a: DVec2, b: DVec2| {
        let t = ((q - a).dot(b - a) / (b - a).length_squared()).clamp(0.0, 1.0);
        q.distance(a.lerp(b, t))
    };
    to_segment(low, high)
        .min(to_segment(DVec2::new(0.0, -h), low))
        .min(to_segment(DVec2::new(0.0, h), high))
}

/// Signed distance of a point from a box.
fn from_cuboid(h: DVec3, p: DVec3) -> f64 {
    let over = p.abs() - h;
    over.max(DVec3::ZERO).length() + over.max_element().min(0.0)
}

/// Distance of two segments, each given by its middle and half its length as a vector.
fn between_segments(a: (DVec3, DVec3), b: (DVec3, DVec3)) -> f64 {
    // The distance is convex in both parameters: alternate the two exact minimisations.
    let (mut s, mut t): (f64, f64) = (0.0, 0.0);
    for _ in 0..20_000 {
        let to = b.0 + b.1 * t - a.0;
        s = (to.dot(a.1) / a.1.length_squared()).clamp(-1.0, 1.0);
        let to = a.0 + a.1 * s - b.0;
        t = (to.dot(b.1) / b.1.length_squared()).clamp(-1.0, 1.0);
    }
    (b.0 + b.1 * t).distance(a.0 + a.1 * s)
}

#[test]
fn a_sphere_against_boxes_capsules_and_all_of_revolution() {
    let mut wrong = Wrong::default();
    let mut random = Random(31);
    for kind in ["ball", "caps", "cyl", "cone", "frus", "box"] {
        for i in 0..400 {
            let body = random_shape(kind, &mut random);
            let radius = between(&mut random, 0.05, 1.0);
            let pose_a = Pose::new(direction(&mut random) * 2.0, rotation(&mut random));
            let mut p = direction(&mut random) * between(&mut random, 0.0, 1.6);
            if i % 8 == 0 {
                // On the axis, where every direction across is as good.
                p = DVec3::Y * p.y;
            }
            let distance = match body {
                Known::Sphere(r) => p.length() - r,
                Known::Capsule(r, h) => p.distance(DVec3::Y * p.y.clamp(-h, h)) - r,
                Known::Frustum(bottom, top, h) => from_frustum(bottom, top, h, p),
                Known::Cuboid(h) => from_cuboid(h, p),
                _ => unreachable!("the kinds are listed above"),
            };
            let case = beside(body, pose_a, p, radius, &mut random);
            let found = answer(&case);
            wrong.unless((found.gap - (distance - radius)).abs() < 1e-12, || {
                format!(
                    "{case:?}: {found:?}: {} instead of {}",
                    found.gap,
                    distance - radius
                )
            });
            wrong.unless(!found.capped, || format!("{case:?}"));
        }
    }
    wrong.end();
}

/// A body and a sphere whose centre is at `p` in the body's frame.
fn beside(body: Known, pose_a: Pose, p: DVec3, radius: f64, random: &mut Random) -> Case {
    Case {
        a: body,
        pose_a,
        b: Known::Sphere(radius),
        pose_b: Pose::new(pose_a.transform_point(p), rotation(random)),
    }
}

/// The direction of a short way is rounding, off which a long mantle stands out: what is claimed has to be proven.
#[test]
fn a_sphere_with_its_centre_close_to_an_axis_or_a_surface_claims_what_its_normal_proves() {
    let mut wrong = Wrong::default();
    let mut random = Random(37);
    for kind in ["caps", "cyl", "cone", "frus", "box"] {
        for i in 0..2000 {
            let body = random_shape(kind, &mut random);
            let radius = between(&mut random, 0.05, 1.0);
            let pose_a = Pose::new(direction(&mut random) * 2.0, rotation(&mut random));
            let short = 10f64.powf(between(&mut random, -13.0, -2.0));
            let p = if i % 2 == 0 {
                let aside = direction(&mut random);
                DVec3::new(
                    aside.x * short,
                    between(&mut random, -0.3, 0.3),
                    aside.z * short,
                )
            } else {
                let (n, point) = surface_point(&body, &mut random);
                point + n * short.copysign(random.next())
            };
            let case = beside(body, pose_a, p, radius, &mut random);
            let found = answer(&case);
            let proven = case.gap_along(found.normal);
            wrong.unless(found.gap - proven <= 1e-13 * case.size(), || {
                let by = found.gap - proven;
                format!("{kind} {i} {p}: {by:.1e} beyond {proven}, {found:?}")
            });
        }
    }
    wrong.end();
}

#[test]
fn a_half_space_against_anything() {
    let mut wrong = Wrong::default();
    let mut random = Random(37);
    for kind in cases::KINDS.into_iter().chain(["trunc"]) {
        for _ in 0..100 {
            let b = random_shape(kind, &mut random);
            let up = direction(&mut random);
            let pose_a = Pose::new(direction(&mut random), rotation(&mut random));
            let pose_b = Pose::new(direction(&mut random) * 2.0, rotation(&mut random));
            let normal = pose_a.rotation * up;
            let lowest = b.height(pose_b.rotation.conjugate() * -normal);
            let gap = normal.dot(pose_b.position - pose_a.position) - lowest;
            let a = Known::HalfSpace(up);
            let case = Case {
                a,
                pose_a,
                b,
                pose_b,
            };
            let found = answer(&case);
            wrong.unless((found.gap - gap).abs() < 1e-12, || {
                format!("{case:?}: {}", found.gap)
            });
            wrong.unless(found.normal.distance(normal) < 1e-12, || {
                format!("{case:?}")
            });
            wrong.unless(!found.capped && found.iterations == 0, || {
                format!("{case:?}")
            });
        }
    }
    wrong.end();
}

#[test]
fn capsules_are_segments_with_a_radius() {
    let mut wrong = Wrong::default();
    let mut random = Random(41);
    for _ in 0..100 {
        let a = random_shape("caps", &mut random);
        let b = random_shape("caps", &mut random);
        let pose_a = Pose::new(direction(&mut random), rotation(&mut random));
        let pose_b = Pose::new(direction(&mut random) * 2.0, rotation(&mut random));
        let (Known::Capsule(r, h), Known::Capsule(q, k)) = (&a, &b) else {
            unreachable!("two capsules were asked for")
        };
        let axis = |pose: &Pose, h: f64| (pose.position, pose.rotation * DVec3::Y * h);
        let distance = between_segments(axis(&pose_a, *h), axis(&pose_b, *k));
        let gap = distance - r - q;
        let case = Case {
            a,
            pose_a,
            b,
            pose_b,
        };
        let found = answer(&case);
        wrong.unless((found.gap - gap).abs() < 1e-9, || {
            format!("{case:?}: {found:?}: {} instead of {gap}", found.gap)
        });
    }
    wrong.end();
}

#[test]
fn boxes_with_parallel_axes() {
    let mut wrong = Wrong::default();
    let mut random = Random(43);
    for _ in 0..400 {
        let mut half = || {
            DVec3::new(
                between(&mut random, 0.2, 1.0),
                between(&mut random, 0.2, 1.0),
                between(&mut random, 0.2, 1.0),
            )
        };
        let (a, b) = (half(), half());
        let d = direction(&mut random) * between(&mut random, 0.0, 3.0);
        let turn = rotation(&mut random);
        let origin = direction(&mut random);
        let case = Case {
            a: Known::Cuboid(a),
            pose_a: Pose::new(origin, turn),
            b: Known::Cuboid(b),
            pose_b: Pose::new(origin + turn * d, turn),
        };
        let gap = from_cuboid(a + b, d);
        let found = answer(&case);
        wrong.unless((found.gap - gap).abs() < 1e-9, || {
            format!("{case:?}: {found:?}: {} instead of {gap}", found.gap)
        });
    }
    wrong.end();
}

#[test]
fn bodies_of_revolution_on_one_axis() {
    let mut wrong = Wrong::default();
    let mut random = Random(47);
    let flip = DQuat::from_rotation_x(std::f64::consts::PI);
    for i in 0..200 {
        let a = random_shape(["cyl", "cone", "frus", "caps"][i % 4], &mut random);
        let b = random_shape(["frus", "cyl", "caps", "cone"][i / 4 % 4], &mut random);
        let gap = between(&mut random, 1e-4, 0.5);
        let turn = rotation(&mut random);
        let spin = DQuat::from_rotation_y(between(&mut random, 0.0, 6.0));
        let turn_b = if i % 3 == 0 {
            turn * spin * flip
        } else {
            turn * spin
        };
        let reach = |shape: &Known, turn: DQuat, n: DVec3| shape.height(turn.conjugate() * n);
        let axis = turn * DVec3::Y;
        let height = reach(&a, turn, axis) + reach(&b, turn_b, -axis) + gap;
        let case = Case {
            a,
            pose_a: Pose::new(DVec3::ZERO, turn),
            b,
            pose_b: Pose::new(axis * height, turn_b),
        };
        let found = answer(&case);
        wrong.unless((found.gap - gap).abs() < 1e-9, || {
            format!("{case:?}: {found:?}: {} instead of {gap}", found.gap)
        });
        wrong.unless(found.normal.distance(axis) < 1e-6, || {
            format!("{case:?}: {}", found.normal)
        });
    }
    wrong.end();
}
