//! Ellipsoids: one smooth surface, no kinks.

use glam::{DMat3, DVec3};

use super::{Core, Symmetric, Tip};

/// `{p : p^T M^-1 p <= 1}`: support point `M n / h` with `h = sqrt(n.M n)`, derivative `(M - P P^T) / h`.
pub(in crate::query) struct EllipsoidCore {
    square: Symmetric,
    size: f64,
    rotation: DMat3,
    semi: DVec3,
}

impl EllipsoidCore {
    pub fn new(rotation: &DMat3, semi: DVec3) -> EllipsoidCore {
        EllipsoidCore {
            square: Symmetric::turned(rotation, semi * semi),
            size: semi.max_element(),
            rotation: *rotation,
            semi,
        }
    }
}

/// Curvature of a quadric with matrix `square` at the support point `tip` within u and w.
#[inline(always)]
pub(super) fn quadric(square: &Symmetric, q: DVec3, inverse: f64, u: DVec3, w: DVec3) -> [f64; 3] {
    let (mu, mw) = (square.times(u), square.times(w));
    let (qu, qw) = (q.dot(u), q.dot(w));
    [
        (mu.dot(u) - qu * qu) * inverse,
        (mu.dot(w) - qu * qw) * inverse,
        (mw.dot(w) - qw * qw) * inverse,
    ]
}

impl Core for EllipsoidCore {
    const CIRCLES: usize = 0;
    const DISCS: bool = false;

    #[inline(always)]
    fn tip_held(&self, n: DVec3, _held: u8, _sides: u8) -> Tip {
        let w = self.square.times(n);
        let inverse = 1.0 / n.dot(w).sqrt();
        Tip {
            point: w * inverse,
            sides: 0,
            inverse,
        }
    }

    #[inline(always)]
    fn reach(&self, n: DVec3) -> f64 {
        n.dot(self.square.times(n)).sqrt()
    }

    #[inline(always)]
    fn curvature(&self, _: DVec3, tip: &Tip, u: DVec3, w: DVec3) -> [f64; 3] {
        quadric(&self.square, tip.point, tip.inverse, u, w)
    }

    #[inline(always)]
    fn curvature_along(&self, _: DVec3, tip: &Tip, e: DVec3) -> f64 {
        let q = tip.point.dot(e);
        (self.square.times(e).dot(e) - q * q) * tip.inverse
    }

    fn thin_axis(&self) -> Option<DVec3> {
        Some(self.rotation.col(self.semi.min_position()))
    }

    fn extents(&self) -> Symmetric {
        self.square
    }

    fn size(&self) -> f64 {
        self.size
    }
}
