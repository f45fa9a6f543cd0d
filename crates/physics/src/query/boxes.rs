//! Two boxes: the largest gap over their fifteen axes, three faces each and nine pairs of edges (Gottschalk, Lin and
//! Manocha 1996), with the closest points where it belongs to them.
//!
//! Where boxes overlap the largest gap over these axes is the depth, because the polytope of their differences has no
//! other facets. Where they are apart it is the distance only between a face and a corner or between two edges; else
//! the corner or edge at hand leads to the features that are nearest.

use glam::DVec3;

use super::cores::SQUARE;
use super::{Placed, Separation, flats};

/// Edges whose directions differ by less than this [rad] have no axis of their own.
const PARALLEL: f64 = 1e-8;
/// An edge pair's gap, or one of b's faces, counts only if larger by this, in units of the size: ties go to faces of a.
const TIE: f64 = 1e-12;
/// Rounding of the gap, in units of the size.
const ROUNDING: f64 = 1e-14;

/// One of the fifteen axes: a face of a (0 to 2) or b (3 to 5), or edge i of a with edge j of b (6 + 3 j + i).
type Axis = usize;

struct Boxes<'p> {
    a: &'p Placed<'p>,
    b: &'p Placed<'p>,
    half: (DVec3, DVec3),
    /// From a's centre to b's.
    offset: DVec3,
    size: f64,
}

/// The signed gap, or a normal along which the boxes are apart and from which the search will find it.
#[inline]
pub(super) fn separation(
    (a, half_a): (&Placed, DVec3),
    (b, half_b): (&Placed, DVec3),
    enough: f64,
) -> Result<Separation, DVec3> {
    let pair = Boxes {
        a,
        b,
        half: (half_a, half_b),
        offset: b.position - a.position,
        size: half_a.max_element() + half_b.max_element(),
    };
    let (axis, parallel) = pair.widest();
    let n = pair.normal(axis);
    let (corner_a, corner_b) = pair.corners(n);
    let s = n.dot(corner_b - corner_a);
    if s > enough {
        return Ok(pair.answer(s, None, n, corner_a, corner_b));
    }
    if let Some((point_a, point_b)) = pair.lined_up(axis, n, s, corner_a, corner_b) {
        let slack = if s > 0.0 {
            0.0
        } else if parallel {
            4.0 * PARALLEL
        } else {
            2.0 * TIE
        };
        let upper = s + slack * pair.size;
        return Ok(pair.answer(s, Some(upper), n, point_a, point_b));
    }
    let (near_a, near_b) = pair.nearest(axis, corner_a, corner_b);
    pair.between(near_a, near_b).ok_or(n)
}

impl Boxes<'_> {
    /// The axis with the largest gap, and whether two edges are parallel.
    #[inline(always)]
    fn widest(&self) -> (Axis, bool) {
        let (half_a, half_b) = self.half;
        let t = self.a.local(self.offset);
        let axes = &self.b.rotation;
        let c = [axes.x_axis, axes.y_axis, axes.z_axis].map(|axis| self.a.local(axis));
        let size = c.map(DVec3::abs);
        let tie = TIE * self.size;
        // Signed squares: they order as the gaps do, and an edge pair's needs no root.
        let faces = t.abs() - half_a - size[0] * half_b.x - size[1] * half_b.y - size[2] * half_b.z;
        let mut scores = [f64::NEG_INFINITY; 15];
        let mut parallel = false;
        scores[..3].copy_from_slice(&(faces * faces.abs()).to_array());
        for j in 0..3 {
            let (k, l) = ((j + 1) % 3, (j + 2) % 3);
            let face = t.dot(c[j]).abs() - half_b[j] - half_a.dot(size[j]) - tie;
            scores[3 + j] = face * face.abs();
            let reach_a = DVec3::new(
                half_a.y * size[j].z + half_a.z * size[j].y,
                half_a.z * size[j].x + half_a.x * size[j].z,
                half_a.x * size[j].y + half_a.y * size[j].x,
            );
            let gaps = t.cross(c[j]).abs() - reach_a - size[l] * half_b[k] - size[k] * half_b[l];
            let square = c[j] * c[j];
            let lengths = DVec3::new(
                square.y + square.z,
                square.z + square.x,
                square.x + square.y,
            );
            for i in 0..3 {
                let gap = gaps[i] - tie;
                let none = lengths[i] < PARALLEL * PARALLEL;
                parallel |= none;
                let score = gap * gap.abs() / lengths[i];
                scores[6 + 3 * j + i] = if none { f64::NEG_INFINITY } else { score };
            }
        }
        let mut best = (scores[0], 0);
        for (axis, score) in scores.into_iter().enumerate().skip(1) {
            best = if score > best.0 { (score, axis) } else { best };
        }
        (best.1, parallel)
    }

    /// The unit normal along the axis, from a to b.
    #[inline(always)]
    fn normal(&self, axis: Axis) -> DVec3 {
        let (ra, rb) = (&self.a.rotation, &self.b.rotation);
        let n = match axis {
            0..3 => ra.col(axis),
            3..6 => rb.col(axis - 3),
            _ => {
                let across = ra.col((axis - 6) % 3).cross(rb.col((axis - 6) / 3));
                across * (1.0 / across.length())
            }
        };
        n * 1.0_f64.copysign(n.dot(self.offset))
    }

    /// The corners farthest along n, from a's centre.
    #[inline(always)]
    fn corners(&self, n: DVec3) -> (DVec3, DVec3) {
        let (ra, rb) = (&self.a.rotation, &self.b.rotation);
        let (half_a, half_b) = self.half;
        let of_a = ra.x_axis * half_a.x.copysign(n.dot(ra.x_axis))
            + ra.y_axis * half_a.y.copysign(n.dot(ra.y_axis))
            + ra.z_axis * half_a.z.copysign(n.dot(ra.z_axis));
        let of_b = rb.x_axis * half_b.x.copysign(n.dot(rb.x_axis))
            + rb.y_axis * half_b.y.copysign(n.dot(rb.y_axis))
            + rb.z_axis * half_b.z.copysign(n.dot(rb.z_axis));
        (of_a, self.offset - of_b)
    }

    /// Points of the features that belong to the axis, if they line up along its normal.
    #[inline(always)]
    fn lined_up(
        &self,
        axis: Axis,
        n: DVec3,
        s: f64,
        corner_a: DVec3,
        corner_b: DVec3,
    ) -> Option<(DVec3, DVec3)> {
        let (ra, rb) = (&self.a.rotation, &self.b.rotation);
        let slack = ROUNDING * self.size;
        let inside = |point: DVec3, axes: &glam::DMat3, half: DVec3, except: usize| {
            (0..3).all(|k| k == except || point.dot(axes.col(k)).abs() <= half[k] + slack)
        };
        let square = |axes: &glam::DMat3, i: usize| {
            (0..3).any(|k| k != i && n.dot(axes.col(k)).abs() < SQUARE)
        };
        let found = match axis {
            0..3 => {
                if square(rb, 3) {
                    return self.on_flats(n, s);
                }
                inside(corner_b, ra, self.half.0, axis).then_some((corner_b - n * s, corner_b))
            }
            3..6 => {
                if square(ra, 3) {
                    return self.on_flats(n, s);
                }
                let from_b = corner_a - self.offset;
                inside(from_b, rb, self.half.1, axis - 3).then_some((corner_a, corner_a + n * s))
            }
            _ => {
                let (i, j) = ((axis - 6) % 3, (axis - 6) / 3);
                if square(ra, i) || square(rb, j) {
                    return self.on_flats(n, s);
                }
                let (x, y) = self.shares(i, j, corner_a, corner_b);
                let (end_a, end_b) = (self.half.0[i], self.half.1[j]);
                let along = x.abs() <= end_a + slack && y.abs() <= end_b + slack;
                along.then(|| self.on_edges(i, j, corner_a, corner_b, (x, y)))
            }
        };
        // In an overlap they do, but for rounding: the largest gap is that of the facet which the origin is over.
        found.or_else(|| if s > 0.0 { None } else { self.on_flats(n, s) })
    }

    /// Where faces or edges lie square to n: points of both that line up, if there are any.
    #[cold]
    #[inline(never)]
    fn on_flats(&self, n: DVec3, s: f64) -> Option<(DVec3, DVec3)> {
        let centre = self.a.position;
        match flats::line_up(self.a, self.b, n, s) {
            Ok(found) => Some((found.point_a - centre, found.point_b - centre)),
            Err(_) if s > 0.0 => None,
            Err(_) => Some(self.corners(n)),
        }
    }

    /// How far along edge i of a and edge j of b their lines are closest, from the middles of the edges that end in
    /// the corners [m].
    #[inline(always)]
    fn shares(&self, i: usize, j: usize, corner_a: DVec3, corner_b: DVec3) -> (f64, f64) {
        let (u, v) = (self.a.rotation.col(i), self.b.rotation.col(j));
        let (p, q) = (self.middle(u, corner_a), self.middle_of_b(v, corner_b));
        let w = q - p;
        let cosine = u.dot(v);
        let (along_u, along_v) = (u.dot(w), v.dot(w));
        let inverse = 1.0 / u.cross(v).length_squared();
        (
            (along_u - cosine * along_v) * inverse,
            (cosine * along_u - along_v) * inverse,
        )
    }

    /// The middle of a's edge along u that ends in the corner.
    #[inline(always)]
    fn middle(&self, u: DVec3, corner_a: DVec3) -> DVec3 {
        corner_a - u * u.dot(corner_a)
    }

    #[inline(always)]
    fn middle_of_b(&self, v: DVec3, corner_b: DVec3) -> DVec3 {
        corner_b - v * v.dot(corner_b - self.offset)
    }

    /// The points that far along the edges.
    #[inline(always)]
    fn on_edges(
        &self,
        i: usize,
        j: usize,
        corner_a: DVec3,
        corner_b: DVec3,
        (x, y): (f64, f64),
    ) -> (DVec3, DVec3) {
        let (u, v) = (self.a.rotation.col(i), self.b.rotation.col(j));
        (
            self.middle(u, corner_a) + u * x,
            self.middle_of_b(v, corner_b) + v * y,
        )
    }

    /// Points of the axis' features that are nearest to each other: of a box to the other's corner, or of two edges.
    #[inline(never)]
    fn nearest(&self, axis: Axis, corner_a: DVec3, corner_b: DVec3) -> (DVec3, DVec3) {
        match axis {
            0..3 => {
                let q = self.a.local(corner_b);
                let held = q.clamp(-self.half.0, self.half.0);
                (self.a.rotation * held, corner_b)
            }
            3..6 => {
                let q = self.b.local(corner_a - self.offset);
                let held = q.clamp(-self.half.1, self.half.1);
                (corner_a, self.offset + self.b.rotation * held)
            }
            _ => {
                let (i, j) = ((axis - 6) % 3, (axis - 6) / 3);
                let (end_a, end_b) = (self.half.0[i], self.half.1[j]);
                let (u, v) = (self.a.rotation.col(i), self.b.rotation.col(j));
                let (p, q) = (self.middle(u, corner_a), self.middle_of_b(v, corner_b));
                let (x, y) = self.shares(i, j, corner_a, corner_b);
                // From the end that is passed by more; the other edge's nearest point to it, and back.
                if x.abs() - end_a > y.abs() - end_b {
                    let x = x.clamp(-end_a, end_a);
                    let y = v.dot(p + u * x - q).clamp(-end_b, end_b);
                    let x = u.dot(q + v * y - p).clamp(-end_a, end_a);
                    (p + u * x, q + v * y)
                } else {
                    let y = y.clamp(-end_b, end_b);
                    let x = u.dot(q + v * y - p).clamp(-end_a, end_a);
                    let y = v.dot(p + u * x - q).clamp(-end_b, end_b);
                    (p + u * x, q + v * y)
                }
            }
        }
    }

    /// The answer if these points are the closest of all: no corner lies farther along the way between them.
    #[inline(always)]
    fn between(&self, point_a: DVec3, point_b: DVec3) -> Option<Separation> {
        let way = point_b - point_a;
        let length = way.length();
        let n = way * (1.0 / length);
        let (corner_a, corner_b) = self.corners(n);
        let s = n.dot(corner_b - corner_a);
        (length - s <= ROUNDING * self.size && s > 0.0)
            .then(|| self.answer(s, Some(length.max(s)), n, point_a, point_b))
    }

    #[inline(always)]
    fn answer(
        &self,
        gap: f64,
        upper: Option<f64>,
        normal: DVec3,
        point_a: DVec3,
        point_b: DVec3,
    ) -> Separation {
        let centre = self.a.position;
        Separation {
            gap,
            upper: upper.or_else(|| Some((point_b - point_a).length().max(gap))),
            normal,
            point_a: centre + point_a,
            point_b: centre + point_b,
            iterations: 0,
            capped: false,
            local: false,
        }
    }
}
