//! Closest points of two polytopes that are apart, by the algorithm of Gilbert, Johnson and Keerthi (1988).
//!
//! All differences of a point of b and a point of a form one polytope, whose point nearest to the origin is the
//! shortest way from a to b. A simplex of up to four of its corners walks towards that point. On a polytope the walk
//! ends after finitely many steps with the exact feature; where that is a face, n is its normal, however small the gap.
//! A sphere is a point here and a capsule a segment; their radii are taken off the gap afterwards.

use glam::DVec3;

use super::{Limits, Placed, Separation, expand, polish};
use crate::shape::Kind;

/// A gap below this is left to the search for overlaps, in units of the pair's size.
const TOUCHING: f64 = 1e-9;
/// What is gained below this is rounding, in units of the pair's size.
pub(super) const ROUNDING: f64 = 1e-14;

/// A corner of the polytope of differences with the points that it comes from [m].
#[derive(Clone, Copy, Debug)]
pub(super) struct Corner {
    /// From a's point to b's.
    pub d: DVec3,
    pub a: DVec3,
    pub b: DVec3,
}

/// The corner with the smallest `n.d`, which is s(n).
#[inline]
pub(super) fn corner(a: &Placed, b: &Placed, n: DVec3) -> Corner {
    let (a, b) = (core_support(a, n), core_support(b, -n));
    Corner { d: b - a, a, b }
}

/// The support point without the shape's rounding.
#[inline]
fn core_support(shape: &Placed, n: DVec3) -> DVec3 {
    match &shape.shape.kind {
        Kind::Sphere { .. } => shape.position,
        Kind::Capsule { segment, .. } => {
            let axis = shape.rotation.y_axis;
            shape.position + axis * segment.half_height().copysign(n.dot(axis))
        }
        Kind::Cloud(hull) => {
            let corner = hull.corners[hull.farthest(shape.local(n))];
            shape.position + shape.rotation * corner
        }
        Kind::Cuboid { half } => {
            let axes = &shape.rotation;
            let reach = |axis: DVec3, half: f64| axis * half.copysign(n.dot(axis));
            shape.position
                + reach(axes.x_axis, half.x)
                + reach(axes.y_axis, half.y)
                + reach(axes.z_axis, half.z)
        }
        _ => shape.support(n),
    }
}

/// Radius about a polytope that makes the shape [m]; `None` for a shape that is curved otherwise.
pub(super) fn rounding(shape: &Placed) -> Option<f64> {
    match shape.shape.kind {
        Kind::Sphere { radius } | Kind::Capsule { radius, .. } => Some(radius),
        Kind::Cuboid { .. } | Kind::Cloud(_) => Some(0.0),
        _ => None,
    }
}

/// A point well inside the shape.
pub(super) fn middle(shape: &Placed) -> DVec3 {
    match &shape.shape.kind {
        Kind::Cloud(hull) => shape.position + shape.rotation * hull.centre,
        _ => shape.position,
    }
}

/// The normal with the largest s(n) so far.
#[derive(Clone, Copy, Debug)]
pub(super) struct Best {
    pub s: f64,
    pub n: DVec3,
}

impl Best {
    #[inline]
    pub fn offer(&mut self, s: f64, n: DVec3) {
        if s > self.s {
            *self = Best { s, n };
        }
    }
}

/// Signed gap of a pair with a vertex cloud in it.
pub(super) fn separation(
    a: &Placed,
    b: &Placed,
    start: Option<DVec3>,
    limits: Limits,
) -> Separation {
    let (Some(p), Some(q)) = (rounding(a), rounding(b)) else {
        return polish::separation(a, b, start, limits);
    };
    let enough = limits.enough + p + q;
    let core = core_separation(a, b, start, Limits { enough, ..limits });
    let n = core.normal;
    let gap = core.gap - p - q;
    Separation {
        gap,
        upper: core.upper.map(|up| (up - p - q).max(gap)),
        point_a: core.point_a + n * p,
        point_b: core.point_b - n * q,
        ..core
    }
}

/// The walk of the simplex, and the growth of the polytope where it ends inside.
fn core_separation(a: &Placed, b: &Placed, start: Option<DVec3>, limits: Limits) -> Separation {
    let size = a.shape.size() + b.shape.size();
    let mut n = start
        .or_else(|| (middle(b) - middle(a)).try_normalize())
        .unwrap_or(DVec3::Y);
    let first = corner(a, b, n);
    let mut best = Best {
        s: n.dot(first.d),
        n,
    };
    let mut simplex = Simplex::new(first);
    let mut nearest = first.d;
    let mut iterations = 0;
    loop {
        let length = nearest.length();
        if length <= TOUCHING * size {
            let corners = &simplex.corners[..simplex.count];
            return expand::separation(a, b, corners, best, iterations, limits);
        }
        if best.s > limits.enough || iterations >= limits.iteration_cap {
            return simplex.answer(best, iterations, best.s > limits.enough);
        }
        iterations += 1;
        n = nearest / length;
        let next = corner(a, b, n);
        best.offer(n.dot(next.d), n);
        if length - best.s <= ROUNDING * size {
            return simplex.answer(best, iterations, true);
        }
        let before = simplex;
        simplex.push(next);
        nearest = simplex.reduce().unwrap_or(DVec3::ZERO);
        if nearest.length() >= length {
            // The feature is final; what is left is rounding, unless the angle that it leaves is too wide.
            let narrow = length - best.s <= 1e-10 * length + 10.0 * ROUNDING * size;
            return before.answer(best, iterations, narrow);
        }
    }
}

/// Up to four corners and the weights with which they make up the point nearest to the origin.
#[derive(Clone, Copy)]
struct Simplex {
    corners: [Corner; 4],
    weights: [f64; 4],
    count: usize,
}

impl Simplex {
    fn new(first: Corner) -> Simplex {
        Simplex {
            corners: [first; 4],
            weights: [1.0, 0.0, 0.0, 0.0],
            count: 1,
        }
    }

    fn push(&mut self, corner: Corner) {
        self.corners[self.count] = corner;
        self.count += 1;
    }

    /// The answer with the points of a and b that belong to the weights.
    fn answer(&self, best: Best, iterations: u32, finished: bool) -> Separation {
        let (mut point_a, mut point_b) = (DVec3::ZERO, DVec3::ZERO);
        for (c, weight) in self.corners[..self.count].iter().zip(self.weights) {
            point_a += c.a * weight;
            point_b += c.b * weight;
        }
        Separation {
            gap: best.s,
            upper: Some((point_b - point_a).length().max(best.s)),
            normal: best.n,
            point_a,
            point_b,
            iterations,
            capped: !finished,
            local: false,
        }
    }

    /// Drops the corners that do not carry the point nearest to the origin and returns that point; `None` if the
    /// origin lies inside.
    fn reduce(&mut self) -> Option<DVec3> {
        let d = self.corners.map(|c| c.d);
        let (weights, nearest) = match self.count {
            1 => ([1.0, 0.0, 0.0, 0.0], d[0]),
            2 => {
                let (w, v) = on_segment(d[0], d[1]);
                ([w[0], w[1], 0.0, 0.0], v)
            }
            3 => {
                let (w, v) = on_triangle([d[0], d[1], d[2]]);
                ([w[0], w[1], w[2], 0.0], v)
            }
            _ => on_tetrahedron(d)?,
        };
        let mut count = 0;
        for (i, weight) in weights.into_iter().enumerate() {
            if weight > 0.0 {
                (self.corners[count], self.weights[count]) = (self.corners[i], weight);
                count += 1;
            }
        }
        self.count = count;
        Some(nearest)
    }
}

fn on_segment(p: DVec3, q: DVec3) -> ([f64; 2], DVec3) {
    let edge = q - p;
    let inverse = 1.0 / edge.length_squared();
    let t = -p.dot(edge) * inverse;
    if t >= 1.0 {
        return ([0.0, 1.0], q);
    }
    if t > 0.0 {
        let v = p + edge * t;
        // Square to the edge to the last digit, also where the distance is tiny.
        return ([1.0 - t, t], v - edge * (v.dot(edge) * inverse));
    }
    ([1.0, 0.0], p)
}

/// Weights of the point of a triangle nearest to the origin, and the point; the regions as in Ericson (2005), §5.1.5.
fn on_triangle([a, b, c]: [DVec3; 3]) -> ([f64; 3], DVec3) {
    let (ab, ac) = (b - a, c - a);
    let normal = ab.cross(ac);
    let square = normal.length_squared();
    // Twice the areas of the triangles that the origin's projection makes with the sides, times the normal's length.
    let areas = [
        normal.dot(b.cross(c)),
        normal.dot(c.cross(a)),
        normal.dot(a.cross(b)),
    ];
    if square > 0.0 && areas.iter().all(|x| *x > 0.0) {
        let sum = areas[0] + areas[1] + areas[2];
        // Along the normal itself, so that its direction keeps its digits where the distance is tiny.
        let nearest = normal * (normal.dot(a) / square);
        return (areas.map(|x| x / sum), nearest);
    }
    // The nearest point lies on a side that the projection is beyond.
    let corners = [a, b, c];
    let mut best = ([1.0, 0.0, 0.0], a);
    for (i, area) in areas.into_iter().enumerate() {
        if area > 0.0 && square > 0.0 {
            continue;
        }
        let (j, k) = ((i + 1) % 3, (i + 2) % 3);
        let (w, v) = on_segment(corners[j], corners[k]);
        if v.length_squared() <= best.1.length_squared() {
            best = ([0.0; 3], v);
            (best.0[j], best.0[k]) = (w[0], w[1]);
        }
    }
    best
}

/// The newest corner is the last; the triangle of the others was left towards it and cannot be nearest again.
fn on_tetrahedron(d: [DVec3; 4]) -> Option<([f64; 4], DVec3)> {
    let mut best: Option<([f64; 4], DVec3)> = None;
    let new = d[3];
    for (i, j, opposite) in [(0, 1, 2), (1, 2, 0), (2, 0, 1)] {
        let normal = (d[i] - new).cross(d[j] - new);
        if normal.dot(new) * normal.dot(d[opposite] - new) < 0.0 {
            continue;
        }
        let (w, v) = on_triangle([d[i], d[j], new]);
        if best.is_none_or(|(_, b)| v.length_squared() < b.length_squared()) {
            let mut weights = [0.0; 4];
            (weights[i], weights[j], weights[3]) = (w[0], w[1], w[2]);
            best = Some((weights, v));
        }
    }
    best
}
