//! Cases whose gap and normal are known because they were built that way.
//!
//! A point of a's surface with an outward normal n and a point of b's with the normal -n are put `gap` apart along n.
//! Then the plane through either point touches its shape, so that for `gap` > 0 no two points are nearer and n is the
//! only normal that proves it. Points are taken on faces, sides, edges, rims, corners and apexes, not only where a
//! random normal happens to lead.

use std::f64::consts::TAU;

use glam::{DQuat, DVec3};
use physics::Pose;

use super::cases::{self, Case, Class, between, direction, random_shape, rotation};
use super::hull::Hull;
use super::known::Known;
use crate::support::Random;

/// A case and its truth, global if `gap` > 0 or one of the two is a half-space.
pub struct Built {
    /// The placed shapes.
    pub case: Case,
    /// The signed gap [m].
    pub gap: f64,
    /// Unit normal from a to b, world frame.
    pub normal: DVec3,
}

/// Two random shapes put `gap` apart [m].
pub fn built(pair: (&str, &str), gap: f64, random: &mut Random) -> Built {
    let (a, b) = (random_shape(pair.0, random), random_shape(pair.1, random));
    put_together(a, b, gap, random)
}

/// The case with number `index` of a pair and class, and its truth where that is known.
///
/// Half of the near and touching ones are built, the others moved along a random line. None that overlaps is built:
/// corners that just pass each other, which no random motion would bring about, have a flat maximum.
pub fn drawn(
    pair: (&str, &str),
    class: Class,
    seed: u64,
    index: usize,
) -> (Case, Option<(f64, DVec3)>) {
    let mut random = cases::random(seed.wrapping_add(index as u64), pair, class);
    let plane = pair.0 == "plane";
    let magnitude = 10f64.powf(between(&mut random, -7.0, -4.0));
    let gap = match class {
        Class::Far => 1.0,
        Class::Near => 0.02,
        Class::Touching if plane => magnitude.copysign(random.next()),
        Class::Touching => magnitude,
        Class::Deep => -0.25,
    };
    let build = matches!(class, Class::Near | Class::Touching) && index.is_multiple_of(2);
    if !build && !plane {
        return (cases::case(pair, class, &mut random), None);
    }
    let built = built(pair, gap, &mut random);
    (built.case, Some((built.gap, built.normal)))
}

/// Puts two shapes `gap` apart [m] at random places of their surfaces.
pub fn put_together(a: Known, b: Known, gap: f64, random: &mut Random) -> Built {
    let (normal_a, point_a) = surface_point(&a, random);
    let (normal_b, point_b) = surface_point(&b, random);
    let position = DVec3::new(random.next(), random.next(), random.next()) * 3.0;
    let pose_a = Pose::new(position, rotation(random));
    let normal = pose_a.rotation * normal_a;
    let spin = DQuat::from_axis_angle(normal, between(random, 0.0, TAU));
    let turn = (spin * DQuat::from_rotation_arc(normal_b, -normal)).normalize();
    let touch = pose_a.rotation * point_a + normal * gap - turn * point_b;
    let pose_b = Pose::new(position + touch, turn);
    Built {
        case: Case {
            a,
            pose_a,
            b,
            pose_b,
        },
        gap,
        normal,
    }
}

/// Puts rims, apexes and corners `gap` apart [m], negative for into each other: the farthest points along one random
/// normal, which no face is square to. For frusta and boxes.
pub fn rims_and_corners(a: Known, b: Known, gap: f64, random: &mut Random) -> Case {
    let pose_a = Pose::new(direction(random) * 3.0, rotation(random));
    let turn = rotation(random);
    let normal = direction(random);
    let farthest = |shape: &Known, n: DVec3| match *shape {
        Known::Frustum(bottom, top, h) => rim_point(bottom, top, h, n),
        Known::Cuboid(h) => h * n.signum(),
        _ => panic!("{shape:?} has neither rims nor corners"),
    };
    let from = pose_a.transform_point(farthest(&a, pose_a.rotation.conjugate() * normal));
    let to = turn * farthest(&b, turn.conjugate() * -normal);
    let pose_b = Pose::new(from + normal * gap - to, turn);
    Case {
        a,
        pose_a,
        b,
        pose_b,
    }
}

/// An outward unit normal and a point that is farthest along it, in the shape's frame.
pub fn surface_point(shape: &Known, random: &mut Random) -> (DVec3, DVec3) {
    let n = direction(random);
    match *shape {
        Known::Sphere(r) => (n, n * r),
        Known::Ellipsoid(a) => (n, a * a * n / (a * n).length()),
        Known::Truncated(a, cut) => on_truncated(a, cut, n, random),
        Known::Capsule(r, h) => {
            if random.next() < 0.0 {
                return (n, n * r + DVec3::Y * h.copysign(n.y));
            }
            let side = around(random);
            (side, side * r + DVec3::Y * between(random, -h, h))
        }
        Known::Frustum(bottom, top, h) => on_frustum(bottom, top, h, n, random),
        Known::Cuboid(h) => on_cuboid(h, n, random),
        Known::Cloud(ref hull) => on_cloud(hull, n, random),
        Known::HalfSpace(normal) => {
            let (u, v) = normal.any_orthonormal_pair();
            (normal, u * random.next() + v * random.next())
        }
    }
}

/// A random unit vector square to y.
fn around(random: &mut Random) -> DVec3 {
    let (sin, cos) = between(random, 0.0, TAU).sin_cos();
    DVec3::new(cos, 0.0, sin)
}

fn on_truncated(a: DVec3, cut: f64, n: DVec3, random: &mut Random) -> (DVec3, DVec3) {
    let shrink = (1.0 - (cut / a.y).powi(2)).sqrt();
    let rim = |v: DVec3| DVec3::new(a.x * shrink * v.x, cut, a.z * shrink * v.z);
    if random.next() < -0.3 {
        let inward = between(random, 0.0, 1.0).sqrt();
        return (DVec3::NEG_Y, rim(around(random) * inward));
    }
    let whole = a * a * n / (a * n).length();
    if whole.y >= cut {
        return (n, whole);
    }
    let flat = DVec3::new(a.x * n.x, 0.0, a.z * n.z);
    (n, rim(flat / flat.length()))
}

fn on_frustum(bottom: f64, top: f64, h: f64, n: DVec3, random: &mut Random) -> (DVec3, DVec3) {
    let choice = between(random, 0.0, 1.0);
    if choice < 0.4 {
        (n, rim_point(bottom, top, h, n))
    } else if choice < 0.7 {
        let out = around(random);
        let low = out * bottom - DVec3::Y * h;
        let high = out * top + DVec3::Y * h;
        let slant = (out * (2.0 * h) + DVec3::Y * (bottom - top)) / (2.0 * h).hypot(bottom - top);
        (slant, low.lerp(high, between(random, 0.0, 1.0)))
    } else {
        let up = top > 0.0 && (bottom == 0.0 || random.next() < 0.0);
        let (radius, y) = if up { (top, 1.0) } else { (bottom, -1.0) };
        let inward = between(random, 0.0, 1.0).sqrt();
        let point = around(random) * radius * inward + DVec3::Y * y * h;
        (DVec3::Y * y, point)
    }
}

/// The farthest point of a frustum along a normal that is not its axis: of a rim, or the apex.
fn rim_point(bottom: f64, top: f64, h: f64, n: DVec3) -> DVec3 {
    let across = n.x.hypot(n.z);
    let out = DVec3::new(n.x / across, 0.0, n.z / across);
    let low = out * bottom - DVec3::Y * h;
    let high = out * top + DVec3::Y * h;
    if n.dot(low) > n.dot(high) { low } else { high }
}

fn on_cuboid(h: DVec3, n: DVec3, random: &mut Random) -> (DVec3, DVec3) {
    let (mut n, mut point) = (n, h * n.signum());
    let axis = (between(random, 0.0, 3.0) as usize).min(2);
    let choice = between(random, 0.0, 1.0);
    if choice < 0.35 {
        // An edge: the normal has no part along it.
        n[axis] = 0.0;
        n /= n.length();
        point[axis] = h[axis] * random.next();
    } else if choice < 0.7 {
        let sign = n[axis].signum();
        n = DVec3::ZERO;
        n[axis] = sign;
        point = h * DVec3::new(random.next(), random.next(), random.next());
        point[axis] = h[axis] * sign;
    }
    (n, point)
}

fn on_cloud(hull: &Hull, n: DVec3, random: &mut Random) -> (DVec3, DVec3) {
    let choice = between(random, 0.0, 1.0);
    if choice < 0.35 || hull.faces.is_empty() {
        let higher = |p: &&DVec3, q: &&DVec3| n.dot(**p).total_cmp(&n.dot(**q));
        let farthest = hull.points.iter().max_by(higher);
        return (n, *farthest.expect("a cloud has at least one point"));
    }
    let pick = between(random, 0.0, hull.faces.len() as f64) as usize;
    let face = &hull.faces[pick.min(hull.faces.len() - 1)];
    let [a, b, c] = face.corners.map(|i| hull.points[i]);
    let (u, v) = (between(random, 0.0, 1.0), between(random, 0.0, 1.0));
    if choice < 0.7 {
        let other = hull.neighbour(face, 0).expect("a hull is closed");
        let between_faces = face.normal.lerp(other.normal, u);
        return (between_faces / between_faces.length(), a.lerp(b, v));
    }
    let (u, v) = if u + v > 1.0 {
        (1.0 - u, 1.0 - v)
    } else {
        (u, v)
    };
    (face.normal, a + (b - a) * u + (c - a) * v)
}
