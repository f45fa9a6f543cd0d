//! Shapes as the judge knows them: sizes, support height, and the solver's shape to be judged.

use std::sync::Arc;

use glam::DVec3;
use physics::Shape;

use super::hull::Hull;

/// A convex shape in its own frame, sizes in metres; the axis of revolution is y.
#[derive(Clone, Debug, PartialEq)]
pub enum Known {
    /// Radius.
    Sphere(f64),
    /// Semi-axes.
    Ellipsoid(DVec3),
    /// Semi-axes and the height of the cut.
    Truncated(DVec3, f64),
    /// Radius and half the segment's length.
    Capsule(f64, f64),
    /// Radius at the bottom, radius at the top, half height.
    Frustum(f64, f64, f64),
    /// Half extents.
    Cuboid(DVec3),
    /// Hull of a vertex cloud.
    Cloud(Arc<Hull>),
    /// Outward unit normal of the plane through the origin.
    HalfSpace(DVec3),
}

impl Known {
    /// The solver's shape of the same sizes.
    pub fn shape(&self) -> Shape {
        match self {
            Known::Sphere(r) => Shape::sphere(*r),
            Known::Ellipsoid(a) => Shape::ellipsoid(*a),
            Known::Truncated(a, cut) => Shape::truncated_ellipsoid(*a, *cut),
            Known::Capsule(r, h) => Shape::capsule(*r, *h),
            Known::Frustum(bottom, top, h) => Shape::frustum(*bottom, *top, *h),
            Known::Cuboid(h) => Shape::cuboid(*h),
            Known::Cloud(hull) => Shape::cloud(&hull.points),
            Known::HalfSpace(n) => Shape::half_space(*n),
        }
        .expect("the judge's sizes are valid")
    }

    /// Largest `n.p` over the points p of the shape [m times the length of n].
    ///
    /// A half-space has a height along its own normal only; elsewhere it is infinite.
    pub fn height(&self, n: DVec3) -> f64 {
        let across = || (n.x * n.x + n.z * n.z).sqrt();
        match *self {
            Known::Sphere(r) => r * n.length(),
            Known::Ellipsoid(a) => (a * n).length(),
            Known::Truncated(a, cut) => truncated_height(a, cut, n),
            Known::Capsule(r, h) => r * n.length() + h * n.y.abs(),
            Known::Frustum(bottom, top, h) => {
                let across = across();
                (bottom * across - h * n.y).max(top * across + h * n.y)
            }
            Known::Cuboid(h) => h.x * n.x.abs() + h.y * n.y.abs() + h.z * n.z.abs(),
            Known::Cloud(ref hull) => {
                let mut highest = f64::NEG_INFINITY;
                for p in &hull.points {
                    let height = n.dot(*p);
                    if height > highest {
                        highest = height;
                    }
                }
                highest
            }
            Known::HalfSpace(normal) => {
                if n.dot(normal) > 0.0 && n.cross(normal).length() <= 1e-12 * n.length() {
                    0.0
                } else {
                    f64::INFINITY
                }
            }
        }
    }

    /// Radius of a ball about the origin that holds the shape [m]; 1 m for a half-space.
    pub fn radius(&self) -> f64 {
        match *self {
            Known::Sphere(r) => r,
            Known::Ellipsoid(a) | Known::Truncated(a, _) => a.max_element(),
            Known::Capsule(r, h) => r + h,
            Known::Frustum(bottom, top, h) => bottom.max(top).hypot(h),
            Known::Cuboid(h) => h.length(),
            Known::Cloud(ref hull) => hull.points.iter().map(|p| p.length()).fold(0.0, f64::max),
            Known::HalfSpace(_) => 1.0,
        }
    }

    /// An upper bound of the distance from `p` to the shape [m], zero inside.
    ///
    /// Exact for spheres, capsules and boxes, for the others the length of some way into the shape.
    pub fn outside(&self, p: DVec3) -> f64 {
        match *self {
            Known::Sphere(r) => (p.length() - r).max(0.0),
            Known::Ellipsoid(a) => into_ellipsoid(a, p),
            Known::Truncated(a, cut) => {
                let raised = DVec3::new(p.x, p.y.max(cut), p.z);
                // Towards the axis at the same height, so that the way does not lead below the cut.
                let rest = (1.0 - (raised.y / a.y).powi(2)).max(0.0).sqrt();
                let across = (raised.x / a.x).hypot(raised.z / a.z);
                let inward = if across > rest {
                    1.0 - rest / across
                } else {
                    0.0
                };
                (raised - p).length() + inward * raised.x.hypot(raised.z)
            }
            Known::Capsule(r, h) => {
                let nearest = DVec3::new(0.0, p.y.clamp(-h, h), 0.0);
                (p.distance(nearest) - r).max(0.0)
            }
            Known::Frustum(bottom, top, h) => {
                let y = p.y.clamp(-h, h);
                let radius = bottom + (top - bottom) * (y + h) / (2.0 * h);
                (p.y - y).abs() + (p.x.hypot(p.z) - radius).max(0.0)
            }
            Known::Cuboid(h) => (p.abs() - h).max(DVec3::ZERO).length(),
            Known::Cloud(ref hull) => {
                // Shrunk towards the origin by this factor p is behind every face's plane.
                let beyond = hull.beyond(p).max(0.0);
                p.length() * beyond / (hull.inside_radius() + beyond)
            }
            Known::HalfSpace(normal) => normal.dot(p).max(0.0),
        }
    }
}

/// Length of the way from `p` towards the centre into the ellipsoid.
fn into_ellipsoid(a: DVec3, p: DVec3) -> f64 {
    let level = (p / a).length();
    if level > 1.0 {
        p.length() * (1.0 - 1.0 / level)
    } else {
        0.0
    }
}

/// Support height of an ellipsoid without what lies below `cut`.
///
/// The farthest point of the whole ellipsoid counts unless it was cut away; then it is one of the cut's rim.
fn truncated_height(a: DVec3, cut: f64, n: DVec3) -> f64 {
    let whole = (a * n).length();
    if whole == 0.0 || a.y * a.y * n.y / whole >= cut {
        return whole;
    }
    let rim = (1.0 - (cut / a.y) * (cut / a.y)).sqrt();
    cut * n.y + rim * (a.x * n.x).hypot(a.z * n.z)
}
