//! Pairs of shapes whose gap and normal are known because they were put so.
//!
//! A point of a with the outward normal n, and b moved until its point with the normal -n lies a gap further along n:
//! both tangent planes are square to n and the points line up, so that this is the distance of two convex bodies.

use std::f64::consts::TAU;

use glam::{DQuat, DVec3};
use physics::{Pose, Shape};

use super::oracle;
use crate::hard_cases::scene::{between, direction, rotation};
use experiment::random::SplitMix64;

/// Sizes of the shapes [m]: as of pins and balls.
const SIZE: f64 = 0.1;
/// Angle by which a warm start is off [rad]: what a pin at 10 rad/s turns in 1/500 s.
const WARM: f64 = 0.02;

/// What a shape is, before its sizes are drawn.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Kind {
    /// A sphere.
    Ball,
    /// Three different semi-axes.
    Ellipsoid,
    /// A capsule.
    Capsule,
    /// Two different radii.
    Frustum,
    /// A box.
    Cuboid,
    /// The hull of 64 points.
    Cloud,
}

/// A class of pairs.
#[derive(Clone, Copy, Debug)]
pub struct Class {
    /// Name in tables.
    pub name: &'static str,
    /// Kinds of both shapes.
    pub kinds: (Kind, Kind),
}

/// Every class of search that the query has.
pub const CLASSES: [Class; 9] = {
    use Kind::*;
    const fn class(name: &'static str, a: Kind, b: Kind) -> Class {
        Class {
            name,
            kinds: (a, b),
        }
    }
    [
        class("ball-frustum", Ball, Frustum),
        class("ball-box", Ball, Cuboid),
        class("ellipsoid-ellipsoid", Ellipsoid, Ellipsoid),
        class("capsule-ellipsoid", Capsule, Ellipsoid),
        class("frustum-ellipsoid", Frustum, Ellipsoid),
        class("frustum-frustum", Frustum, Frustum),
        class("frustum-box", Frustum, Cuboid),
        class("box-box", Cuboid, Cuboid),
        class("cloud-ellipsoid", Cloud, Ellipsoid),
    ]
};

/// Two placed shapes, and what is true about them.
#[derive(Clone, Debug)]
pub struct Case {
    /// First shape and where it is.
    pub a: (Shape, Pose),
    /// Second shape and where it is.
    pub b: (Shape, Pose),
    /// Signed gap [m].
    pub gap: f64,
    /// Unit normal from a to b.
    pub normal: DVec3,
    /// A normal as the last step's answer would be.
    pub warm: DVec3,
}

impl Case {
    /// Both as the query takes them.
    pub fn placed(&self) -> (oracle::Placed<'_>, oracle::Placed<'_>) {
        ((&self.a.0, &self.a.1), (&self.b.0, &self.b.1))
    }
}

/// A shape, and normals of its faces and mantle in its frame.
fn shape(kind: Kind, random: &mut SplitMix64) -> (Shape, Vec<DVec3>) {
    let mut size = || SIZE * between(random, 0.25, 1.0);
    let (x, y, z) = (size(), size(), size());
    let shape = match kind {
        Kind::Ball => Shape::sphere(x),
        Kind::Ellipsoid => Shape::ellipsoid(DVec3::new(x, y, z)),
        Kind::Capsule => Shape::capsule(0.5 * x, y),
        Kind::Frustum => Shape::frustum(x, y, z),
        Kind::Cuboid => Shape::cuboid(DVec3::new(x, y, z)),
        Kind::Cloud => {
            let semi = DVec3::new(x, y, z);
            let points: Vec<DVec3> = (0..64).map(|_| semi * direction(random)).collect();
            Shape::cloud(&points)
        }
    };
    let normals = match kind {
        Kind::Frustum => vec![DVec3::Y, DVec3::NEG_Y, DVec3::new(2.0 * z, x - y, 0.0)],
        Kind::Cuboid => vec![DVec3::X, DVec3::NEG_Y, DVec3::Z],
        Kind::Capsule => vec![DVec3::X],
        _ => Vec::new(),
    };
    (shape.expect("sizes are positive"), normals)
}

/// Case `index` of a class with this gap [m]; every third stands on a face of a, every third on one of b.
pub fn case(class: &Class, gap: f64, seed: u64, index: usize) -> Case {
    let mut random = SplitMix64::for_index(seed, index as u64);
    let random = &mut random;
    let (a, faces_a) = shape(class.kinds.0, random);
    let (b, faces_b) = shape(class.kinds.1, random);
    let n = direction(random);
    let pose_a = Pose::new(
        direction(random) * SIZE,
        turned(&faces_a, n, index % 3 == 1, random),
    );
    let turn_b = turned(&faces_b, -n, index % 3 == 2, random);
    let point = oracle::support((&a, &pose_a), n);
    let reach = oracle::support((&b, &Pose::new(DVec3::ZERO, turn_b)), -n);
    let pose_b = Pose::new(point + n * gap - reach, turn_b);
    let aside = DQuat::from_axis_angle(n, between(random, 0.0, TAU)) * n.any_orthonormal_vector();
    let warm = n + aside * WARM;
    Case {
        a: (a, pose_a),
        b: (b, pose_b),
        gap,
        normal: n,
        warm: warm / warm.length(),
    }
}

/// A random rotation, which brings one of the face normals to `n` if that is wanted.
fn turned(faces: &[DVec3], n: DVec3, on_face: bool, random: &mut SplitMix64) -> DQuat {
    let free = rotation(random);
    let pick = random.next_u64() as usize;
    if !on_face || faces.is_empty() {
        return free;
    }
    let face = faces[pick % faces.len()];
    let face = free * (face / face.length());
    DQuat::from_rotation_arc(face, n) * free
}

/// The same pair, pushed into each other; the truth is then what the whole sphere says.
pub fn deep(class: &Class, seed: u64, index: usize, samples: u32, starts: usize) -> Case {
    let mut case = case(class, 0.0, seed, index);
    let mut random = SplitMix64::for_index(seed ^ 1, index as u64);
    // A quarter to three quarters of the way to the middle of b.
    let way = (case.b.1.position - case.a.1.position) * between(&mut random, 0.25, 0.5);
    case.b.1.position -= way;
    let (a, b) = case.placed();
    let best = oracle::largest(a, b, samples, starts);
    let aside = best.normal.any_orthonormal_vector() * WARM;
    let warm = best.normal + aside;
    Case {
        gap: best.gap,
        normal: best.normal,
        warm: warm / warm.length(),
        ..case
    }
}
