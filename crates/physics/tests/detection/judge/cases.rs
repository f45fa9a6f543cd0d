//! Seeded pairs of placed shapes: far, near, touching and deep.

use std::f64::consts::{FRAC_PI_2, TAU};
use std::sync::Arc;

use glam::{DMat3, DQuat, DVec3};
use physics::Pose;

use super::hull::Hull;
use super::known::Known;
use super::line::lowest;
use crate::support::Random;

/// What the two shapes of a case are to each other.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Class {
    /// 1 m apart.
    Far,
    /// 20 mm apart.
    Near,
    /// From 0.1 micrometres to 0.1 mm apart or overlapping.
    Touching,
    /// Three quarters of the way from touching to coincident centres are left.
    Deep,
}

impl Class {
    /// All classes, in the order of the tables.
    pub const ALL: [Class; 4] = [Class::Far, Class::Near, Class::Touching, Class::Deep];

    /// The word for it in tables and on the command line.
    pub fn name(self) -> &'static str {
        match self {
            Class::Far => "far",
            Class::Near => "near",
            Class::Touching => "touching",
            Class::Deep => "deep",
        }
    }
}

/// Names of the kinds of bounded shapes. `random_shape` also takes `trunc` for a truncated ellipsoid and `plane` for a
/// half-space.
pub const KINDS: [&str; 9] = [
    "ball", "caps", "cyl", "cone", "frus", "ell", "box", "cloud8", "cloud64",
];

/// All pairs of kinds, each once.
pub fn pairs() -> Vec<(&'static str, &'static str)> {
    let mut pairs = Vec::new();
    for (i, a) in KINDS.iter().enumerate() {
        for b in &KINDS[i..] {
            pairs.push((*a, *b));
        }
    }
    pairs
}

/// Two placed shapes.
#[derive(Clone, Debug)]
pub struct Case {
    /// The first shape.
    pub a: Known,
    /// Where it is.
    pub pose_a: Pose,
    /// The second shape.
    pub b: Known,
    /// Where it is.
    pub pose_b: Pose,
}

impl Case {
    /// The length that errors are measured against: the larger of the two bounding radii [m].
    pub fn size(&self) -> f64 {
        self.a.radius().max(self.b.radius())
    }

    /// Gap between the tangent planes with the unit normal `n`, from the judge's heights [m].
    pub fn gap_along(&self, n: DVec3) -> f64 {
        n.dot(self.pose_b.position - self.pose_a.position)
            - self.a.height(self.pose_a.rotation.conjugate() * n)
            - self.b.height(self.pose_b.rotation.conjugate() * -n)
    }
}

/// `pairs`, and truncated ellipsoids and half-spaces with each kind.
pub fn all_pairs() -> Vec<(&'static str, &'static str)> {
    let more = ["trunc", "plane"]
        .into_iter()
        .flat_map(|a| KINDS.map(|b| (a, b)));
    let own = [("trunc", "trunc"), ("plane", "trunc")];
    pairs().into_iter().chain(more).chain(own).collect()
}

/// `all_pairs` without vertex clouds.
pub fn parametric_pairs() -> Vec<(&'static str, &'static str)> {
    let mut pairs = all_pairs();
    pairs.retain(|pair| !pair.0.starts_with("cloud") && !pair.1.starts_with("cloud"));
    pairs
}

/// A generator for one pair and class; the same seed gives the same cases.
pub fn random(seed: u64, pair: (&str, &str), class: Class) -> Random {
    // SplitMix64's finaliser: neighbouring seeds and names must not give related sequences.
    let mut z = seed;
    for byte in pair.0.bytes().chain(pair.1.bytes()).chain([class as u8]) {
        z = z
            .wrapping_add(u64::from(byte) + 1)
            .wrapping_add(0x9e37_79b9_7f4a_7c15);
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^= z >> 31;
    }
    Random(z | 1)
}

/// A number between `low` and `high`.
pub fn between(random: &mut Random, low: f64, high: f64) -> f64 {
    low + (high - low) * 0.5 * (random.next() + 1.0)
}

fn gauss(random: &mut Random) -> f64 {
    let u = between(random, 0.0, 1.0).max(f64::MIN_POSITIVE);
    (-2.0 * u.ln()).sqrt() * between(random, 0.0, TAU).cos()
}

/// A unit vector, uniform on the sphere.
pub fn direction(random: &mut Random) -> DVec3 {
    loop {
        let v = DVec3::new(gauss(random), gauss(random), gauss(random));
        if let Some(n) = v.try_normalize() {
            return n;
        }
    }
}

/// A rotation, uniform among all.
pub fn rotation(random: &mut Random) -> DQuat {
    loop {
        let [x, y, z, w] = [(); 4].map(|()| gauss(random));
        let q = DQuat::from_xyzw(x, y, z, w);
        if q.length_squared() > 1e-6 {
            return q.normalize();
        }
    }
}

/// A shape of random sizes of about 1 m.
///
/// # Panics
/// On a kind of another name.
pub fn random_shape(kind: &str, random: &mut Random) -> Known {
    let mut size = |low: f64| between(random, low, 1.0);
    match kind {
        "ball" => Known::Sphere(size(0.3)),
        "caps" => Known::Capsule(0.5 * size(0.4), size(0.3)),
        "cyl" => {
            let r = size(0.2);
            Known::Frustum(r, r, size(0.2))
        }
        "cone" => Known::Frustum(size(0.2), 0.0, size(0.3)),
        "frus" => Known::Frustum(size(0.2), size(0.2), size(0.2)),
        "ell" => Known::Ellipsoid(DVec3::new(size(0.2), size(0.2), size(0.2))),
        "box" => Known::Cuboid(DVec3::new(size(0.2), size(0.2), size(0.2))),
        "cloud8" => cloud(8, random),
        "cloud64" => cloud(64, random),
        "trunc" => {
            let a = DVec3::new(size(0.2), size(0.2), size(0.2));
            Known::Truncated(a, -0.95 * a.y * size(0.1))
        }
        "plane" => Known::HalfSpace(direction(random)),
        _ => panic!("no shape is called {kind}"),
    }
}

/// Points on a random ellipsoid about their own middle, so that the origin is inside.
fn cloud(count: usize, random: &mut Random) -> Known {
    let semi = DVec3::new(
        between(random, 0.2, 1.0),
        between(random, 0.2, 1.0),
        between(random, 0.2, 1.0),
    );
    let points: Vec<DVec3> = (0..count).map(|_| semi * direction(random)).collect();
    let middle = points.iter().sum::<DVec3>() / count as f64;
    let points = points.into_iter().map(|p| p - middle).collect();
    Known::Cloud(Arc::new(Hull::new(points)))
}

/// Two random shapes in random orientations, moved along a random line until their gap is the class's.
pub fn case(pair: (&str, &str), class: Class, random: &mut Random) -> Case {
    let (a, b) = (random_shape(pair.0, random), random_shape(pair.1, random));
    let centre = DVec3::new(random.next(), random.next(), random.next()) * 3.0;
    let pose_a = Pose::new(centre, rotation(random));
    let mut case = Case {
        a,
        pose_a,
        b,
        pose_b: Pose::new(centre, rotation(random)),
    };
    let along = direction(random);
    let magnitude = 10f64.powf(between(random, -7.0, -4.0));
    let distance = match class {
        Class::Far => distance_for(&case, along, 1.0),
        Class::Near => distance_for(&case, along, 0.02),
        Class::Touching if random.next() < 0.0 => distance_for(&case, along, -magnitude),
        Class::Touching => distance_for(&case, along, magnitude),
        Class::Deep => 0.75 * distance_for(&case, along, 1e-3),
    };
    case.pose_b.position = centre + along * distance;
    case
}

/// How far b must be moved from a's position along the unit vector `along` for the gap to be `gap` [m].
///
/// The gap at distance t is at least g where some normal n has `t n.along - h(n) >= g |n|`, with h the sum of both
/// heights. So t is the smallest `(h(n) + g |n|) / n.along`, and on the plane `n.along = 1` that is a convex
/// function, which two nested line searches minimise. With g < 0 it is so nearly, for the small overlaps here.
pub fn distance_for(case: &Case, along: DVec3, gap: f64) -> f64 {
    let (u, v) = along.any_orthonormal_pair();
    let to_a = DMat3::from_quat(case.pose_a.rotation.conjugate());
    let to_b = DMat3::from_quat(case.pose_b.rotation.conjugate());
    let height = |n: DVec3| case.a.height(to_a * n) + case.b.height(to_b * -n) + gap * n.length();
    // Angles instead of offsets: the whole plane lies in a bounded square, and what falls and rises still does.
    let edge = FRAC_PI_2 - 0.01;
    // Errors of the distance are about as large as these of the angles: a tenth of the smallest touching gap.
    let precision = if gap.abs() < 1e-3 { 1e-8 } else { 1e-5 };
    let (_, distance) = lowest(edge, precision, |x| {
        let row = along + u * x.tan();
        lowest(edge, precision, |y| height(row + v * y.tan())).1
    });
    distance
}
