//! Shapes as the search sees them: turned into the common frame, without their rounding, b mirrored at its centre.
//!
//! Rounding is exact: a sphere is a point and a capsule a segment, and the radius is taken off the gap afterwards.
//! With b mirrored, `s(n) = n.(d - P_a(n) - P_b(n))` treats both alike. A core's surface has up to three *kinks*:
//! circles `{n : n.axis = height}` on the sphere of normals on which its support point jumps from one side of an
//! edge, face or mantle line to the other. A tip records on which side of each circle it lies.

mod cuboid;
mod ellipsoid;
mod revolution;
mod truncated;

use glam::{DMat3, DVec3};

pub(super) use cuboid::CuboidCore;
pub(super) use ellipsoid::EllipsoidCore;
pub(super) use revolution::RevolutionCore;
pub(super) use truncated::TruncatedCore;

/// Angle within which a face counts as square to a normal [rad]: a metre of face then rises by 0.1 nm.
pub(super) const SQUARE: f64 = 1e-10;

/// A support point: the farthest of a core along a normal, from the core's centre.
#[derive(Clone, Copy, Debug)]
pub(super) struct Tip {
    pub point: DVec3,
    /// Bit i: the normal lies above the core's circle i.
    pub sides: u8,
    /// Reciprocal of the length that the curvature is measured with; each core has its own.
    pub inverse: f64,
}

/// A circle of normals on which a support point jumps.
#[derive(Clone, Copy, Debug)]
pub(super) struct Circle {
    pub axis: DVec3,
    /// `n.axis` on the circle; its radius is `radius`.
    pub height: f64,
    pub radius: f64,
    /// Length of the jump [m].
    pub jump: f64,
}

impl Circle {
    pub const NONE: Circle = Circle {
        axis: DVec3::ZERO,
        height: 0.0,
        radius: 1.0,
        jump: 0.0,
    };

    /// The point of the circle nearest to `n`, if `n` is not on the axis.
    pub fn nearest(&self, n: DVec3) -> Option<DVec3> {
        let across = n - self.axis * n.dot(self.axis);
        let length = across.length();
        (length > 1e-9).then(|| self.axis * self.height + across * (self.radius / length))
    }
}

/// A flat disc that ends a core: the outward axis, along which all of its points are equally far, and its centre.
#[derive(Clone, Copy, Debug)]
pub(super) struct Disc {
    pub axis: DVec3,
    /// Largest radius [m]; zero where the core ends in a point.
    pub radius: f64,
    pub centre: DVec3,
}

impl Disc {
    const NONE: Disc = Disc {
        axis: DVec3::ZERO,
        radius: 0.0,
        centre: DVec3::ZERO,
    };
}

/// Symmetric 3 x 3 matrix: xx, xy, xz, yy, yz, zz.
#[derive(Clone, Copy, Debug)]
pub(super) struct Symmetric([f64; 6]);

impl Symmetric {
    pub const ZERO: Symmetric = Symmetric([0.0; 6]);

    /// `sum of w_k r_k r_k^T` over the columns of `r`.
    pub fn turned(r: &DMat3, w: DVec3) -> Symmetric {
        let (x, y, z) = (r.x_axis, r.y_axis, r.z_axis);
        let (p, q, s) = (x * w.x, y * w.y, z * w.z);
        Symmetric([
            p.x * x.x + q.x * y.x + s.x * z.x,
            p.x * x.y + q.x * y.y + s.x * z.y,
            p.x * x.z + q.x * y.z + s.x * z.z,
            p.y * x.y + q.y * y.y + s.y * z.y,
            p.y * x.z + q.y * y.z + s.y * z.z,
            p.z * x.z + q.z * y.z + s.z * z.z,
        ])
    }

    /// `across` in all directions at right angles to the unit `axis`, `along` on it.
    pub fn about_axis(axis: DVec3, across: f64, along: f64) -> Symmetric {
        let p = axis * (along - across);
        Symmetric([
            across + p.x * axis.x,
            p.x * axis.y,
            p.x * axis.z,
            across + p.y * axis.y,
            p.y * axis.z,
            across + p.z * axis.z,
        ])
    }

    #[inline(always)]
    pub fn times(&self, v: DVec3) -> DVec3 {
        let m = &self.0;
        DVec3::new(
            m[0] * v.x + m[1] * v.y + m[2] * v.z,
            m[1] * v.x + m[3] * v.y + m[4] * v.z,
            m[2] * v.x + m[4] * v.y + m[5] * v.z,
        )
    }

    pub fn plus(&self, other: &Symmetric) -> Symmetric {
        let mut sum = self.0;
        for (x, y) in sum.iter_mut().zip(other.0) {
            *x += y;
        }
        Symmetric(sum)
    }

    pub fn trace(&self) -> f64 {
        self.0[0] + self.0[3] + self.0[5]
    }

    /// Direction of `(self + shift 1)^-1 v`, not normalised: the adjugate times v.
    pub fn solve_direction(&self, shift: f64, v: DVec3) -> DVec3 {
        let [a, b, c, d, e, f] = self.0;
        let (a, d, f) = (a + shift, d + shift, f + shift);
        let (xx, xy, xz) = (d * f - e * e, c * e - b * f, b * e - c * d);
        let (yy, yz, zz) = (a * f - c * c, b * c - a * e, a * d - b * b);
        DVec3::new(
            xx * v.x + xy * v.y + xz * v.z,
            xy * v.x + yy * v.y + yz * v.z,
            xz * v.x + yz * v.y + zz * v.z,
        )
    }
}

/// What the search asks of a core. All vectors in the common frame, points from the core's centre.
///
/// What a core does not override it does not have: kinks, discs, flat faces, curvature.
pub(super) trait Core {
    /// How many kinks there are.
    const CIRCLES: usize;
    /// Whether the core ends in flat discs.
    const DISCS: bool;

    /// Support point along the unit normal `n`; of the circles that are `held` (bits) on the given `sides`, whether or
    /// not n lies there.
    fn tip_held(&self, n: DVec3, held: u8, sides: u8) -> Tip;

    /// Support point along the unit normal `n`.
    #[inline(always)]
    fn tip(&self, n: DVec3) -> Tip {
        self.tip_held(n, 0, 0)
    }

    /// How far the core reaches along the unit normal `n`, to half of the digits: for the choice of normals [m].
    #[inline(always)]
    fn reach(&self, n: DVec3) -> f64 {
        n.dot(self.tip(n).point)
    }

    /// Derivative of the support point `tip` by n within the tangent plane of u and w: uu, uw, ww [m].
    #[inline(always)]
    fn curvature(&self, _n: DVec3, _tip: &Tip, _u: DVec3, _w: DVec3) -> [f64; 3] {
        [0.0; 3]
    }

    /// The same along the one direction e [m].
    #[inline(always)]
    fn curvature_along(&self, _n: DVec3, _tip: &Tip, _e: DVec3) -> f64 {
        0.0
    }

    /// The circle with number `index`.
    #[inline(always)]
    fn circle(&self, _index: usize) -> Circle {
        Circle::NONE
    }

    /// Whether a circle is small: a great arc can then cross it twice.
    #[inline(always)]
    fn has_small_circle(&self) -> bool {
        false
    }

    /// Whether the core is its own image in its centre.
    fn is_symmetric(&self) -> bool {
        true
    }

    /// The disc at the end that tips on these `sides` belong to.
    #[inline(always)]
    fn disc(&self, _sides: u8) -> Disc {
        Disc::NONE
    }

    /// Point nearest to `target` of all that are farthest along n within `SQUARE`.
    fn face_point(&self, n: DVec3, _target: DVec3) -> DVec3 {
        self.tip(n).point
    }

    /// Shortest axis of an ellipsoid: s tends to have a maximum near it, and no kink leads there.
    fn thin_axis(&self) -> Option<DVec3> {
        None
    }

    /// Ellipsoid-like matrix of the core's extents [m2], from which the first normal is guessed.
    fn extents(&self) -> Symmetric;

    /// Largest extent [m].
    fn size(&self) -> f64;
}

/// A point: what is left of a sphere.
pub(super) struct PointCore;

impl Core for PointCore {
    const CIRCLES: usize = 0;
    const DISCS: bool = false;

    #[inline(always)]
    fn tip_held(&self, _: DVec3, _held: u8, _sides: u8) -> Tip {
        Tip {
            point: DVec3::ZERO,
            sides: 0,
            inverse: 0.0,
        }
    }

    fn extents(&self) -> Symmetric {
        Symmetric::ZERO
    }

    fn size(&self) -> f64 {
        0.0
    }
}
