//! Shapes as formulas of their support heights, and the largest gap over many normals: what detection is judged by.

use glam::DVec3;
use physics::{Pose, Shape};

use super::scene::between;
use experiment::random::SplitMix64;

/// The kinds of shapes that are drawn.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Kind {
    Sphere,
    Capsule,
    Cylinder,
    Cone,
    Ellipsoid,
    Cuboid,
}

impl Kind {
    pub const ALL: [Kind; 6] = [
        Kind::Sphere,
        Kind::Capsule,
        Kind::Cylinder,
        Kind::Cone,
        Kind::Ellipsoid,
        Kind::Cuboid,
    ];
}

/// A convex shape in its own frame [m]; the axis of revolution is y.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Known {
    /// Radius.
    Sphere(f64),
    /// Radius and half the segment's length.
    Capsule(f64, f64),
    /// Radius and half height.
    Cylinder(f64, f64),
    /// Radius at y = -half height, and half height.
    Cone(f64, f64),
    /// Semi-axes.
    Ellipsoid(DVec3),
    /// Half extents.
    Cuboid(DVec3),
}

impl Known {
    /// A shape of random sizes up to 1 m.
    pub fn random(kind: Kind, random: &mut SplitMix64) -> Known {
        let mut size = || between(random, 0.2, 1.0);
        match kind {
            Kind::Sphere => Known::Sphere(size()),
            Kind::Capsule => Known::Capsule(0.5 * size(), size()),
            Kind::Cylinder => Known::Cylinder(size(), size()),
            Kind::Cone => Known::Cone(size(), size()),
            Kind::Ellipsoid => Known::Ellipsoid(DVec3::new(size(), size(), size())),
            Kind::Cuboid => Known::Cuboid(DVec3::new(size(), size(), size())),
        }
    }

    /// The program's shape of the same sizes.
    pub fn shape(&self) -> Shape {
        match *self {
            Known::Sphere(r) => Shape::sphere(r),
            Known::Capsule(r, h) => Shape::capsule(r, h),
            Known::Cylinder(r, h) => Shape::cylinder(r, h),
            Known::Cone(r, h) => Shape::cone(r, h),
            Known::Ellipsoid(a) => Shape::ellipsoid(a),
            Known::Cuboid(h) => Shape::cuboid(h),
        }
        .expect("the sizes are positive")
    }

    /// A farthest point along `n` of any length.
    pub fn farthest(&self, n: DVec3) -> DVec3 {
        let across = DVec3::new(n.x, 0.0, n.z);
        let round = |r: f64| across.try_normalize().map_or(DVec3::ZERO, |u| u * r);
        let unit = n / n.length();
        match *self {
            Known::Sphere(r) => unit * r,
            Known::Capsule(r, h) => unit * r + DVec3::Y * h.copysign(n.y),
            Known::Cylinder(r, h) => round(r) + DVec3::Y * h.copysign(n.y),
            Known::Cone(r, h) => {
                if h * n.y > r * across.length() - h * n.y {
                    DVec3::Y * h
                } else {
                    round(r) - DVec3::Y * h
                }
            }
            Known::Ellipsoid(a) => a * a * n / (a * n).length(),
            Known::Cuboid(h) => DVec3::new(h.x.copysign(n.x), h.y.copysign(n.y), h.z.copysign(n.z)),
        }
    }

    /// Radius of a ball about the origin that holds it [m].
    pub fn radius(&self) -> f64 {
        match *self {
            Known::Sphere(r) => r,
            Known::Capsule(r, h) => r + h,
            Known::Cylinder(r, h) | Known::Cone(r, h) => r.hypot(h),
            Known::Ellipsoid(a) => a.max_element(),
            Known::Cuboid(h) => h.length(),
        }
    }

    /// The smallest distance of two parallel planes that hold it [m].
    pub fn smallest_width(&self) -> f64 {
        match *self {
            Known::Sphere(r) | Known::Capsule(r, _) => 2.0 * r,
            Known::Cylinder(r, h) => 2.0 * r.min(h),
            // Along the axis, across it, or between the base's rim and the slant opposite; widths have no other minimum.
            Known::Cone(r, h) => (2.0 * h).min(2.0 * r).min(4.0 * r * h / r.hypot(2.0 * h)),
            Known::Ellipsoid(a) => 2.0 * a.min_element(),
            Known::Cuboid(h) => 2.0 * h.min_element(),
        }
    }
}

/// Two placed shapes.
#[derive(Clone, Copy, Debug)]
pub struct Pair {
    pub a: Known,
    pub pose_a: Pose,
    pub b: Known,
    pub pose_b: Pose,
}

impl Pair {
    /// What errors are measured against [m].
    pub fn size(&self) -> f64 {
        self.a.radius().max(self.b.radius())
    }

    /// The same pair with a and b exchanged.
    pub fn swapped(&self) -> Pair {
        Pair {
            a: self.b,
            pose_a: self.pose_b,
            b: self.a,
            pose_b: self.pose_a,
        }
    }

    /// The same pair somewhere else.
    pub fn moved(&self, by: Pose) -> Pair {
        Pair {
            pose_a: by * self.pose_a,
            pose_b: by * self.pose_b,
            ..*self
        }
    }

    /// Gap between the tangent planes with the unit normal `n` [m].
    pub fn gap_along(&self, n: DVec3) -> f64 {
        let own = self.pose_a.rotation.conjugate() * n;
        let other = self.pose_b.rotation.conjugate() * -n;
        n.dot(self.pose_b.position - self.pose_a.position)
            - own.dot(self.a.farthest(own))
            - other.dot(self.b.farthest(other))
    }

    /// The largest gap close to the normal `near` and close to the best others of 300 normals and all axes.
    pub fn best_gap(&self, near: DVec3) -> f64 {
        let own = self.climb(near, 1e-3, 1e-9);
        let elsewhere = |n: &DVec3| n.dot(near) < 0.97;
        let mut starts: Vec<(f64, DVec3)> = sphere(300)
            .chain(self.special())
            .filter(elsewhere)
            .map(|n| (self.gap_along(n), n))
            .collect();
        starts.sort_by(|x, y| y.0.total_cmp(&x.0));
        let mut best = own;
        for (_, n) in starts.into_iter().take(2) {
            // Roughly first: only what comes near is worth climbing to the top of.
            let rough = self.climb(n, 0.05, 1e-3);
            if rough.0 > own.0 - 0.01 * self.size() {
                let there = self.climb(rough.1, 1e-2, 1e-9);
                if there.0 > best.0 {
                    best = there;
                }
            }
        }
        best.0
    }

    /// Normals of faces, and axes.
    fn special(&self) -> impl Iterator<Item = DVec3> + '_ {
        let axes = [self.pose_a.rotation, self.pose_b.rotation]
            .into_iter()
            .flat_map(|q| DVec3::AXES.map(|axis| q * axis));
        axes.flat_map(|n| [n, -n])
    }

    /// Climbs to a maximum nearby with steps that shrink from `reach` to `least` [rad]; gap and normal there.
    fn climb(&self, start: DVec3, mut reach: f64, least: f64) -> (f64, DVec3) {
        let (mut n, mut best) = (start, self.gap_along(start));
        let mut turn = 0.0f64;
        while reach > least {
            let (u, v) = n.any_orthonormal_pair();
            let mut gained = false;
            for k in 0..8 {
                let (sin, cos) = (turn + f64::from(k) * std::f64::consts::FRAC_PI_4).sin_cos();
                let next = n + (u * cos + v * sin) * reach;
                let next = next / next.length();
                let gap = self.gap_along(next);
                if gap > best {
                    (n, best, gained) = (next, gap, true);
                    break;
                }
            }
            // Other directions every time, so that no ridge lies between them for ever.
            turn += 0.7;
            reach *= if gained { 1.3 } else { 0.7 };
        }
        (best, n)
    }
}

/// Normals spread evenly over the sphere, along a spiral.
fn sphere(count: u32) -> impl Iterator<Item = DVec3> {
    let golden_angle = 2.399_963_229_728_653;
    (0..count).map(move |i| {
        let y = 1.0 - (2.0 * f64::from(i) + 1.0) / f64::from(count);
        let (sin, cos) = (golden_angle * f64::from(i)).sin_cos();
        let across = (1.0 - y * y).sqrt();
        DVec3::new(across * cos, y, across * sin)
    })
}
