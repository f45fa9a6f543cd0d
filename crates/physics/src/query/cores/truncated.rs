//! An ellipsoid cut flat below: surface and rim meet without a kink, the flat is a disc.

use glam::{DMat3, DVec3};

use super::ellipsoid::quadric;
use super::{Core, Disc, SQUARE, Symmetric, Tip};

pub(in crate::query) struct TruncatedCore {
    up: DVec3,
    square: Symmetric,
    rim: Symmetric,
    /// In-plane axes of the rim with its semi-axes along them [m].
    axes: [(DVec3, f64); 2],
    /// Height of the cut along `up`, negative [m].
    cut: f64,
    size: f64,
}

impl TruncatedCore {
    pub fn new(rotation: &DMat3, semi: DVec3, cut: f64, rim: DVec3) -> TruncatedCore {
        TruncatedCore {
            up: rotation.y_axis,
            square: Symmetric::turned(rotation, semi * semi),
            rim: Symmetric::turned(rotation, rim * rim),
            axes: [(rotation.x_axis, rim.x), (rotation.z_axis, rim.z)],
            cut,
            size: semi.max_element(),
        }
    }

    fn rim_tip(&self, n: DVec3) -> Tip {
        let w = self.rim.times(n);
        // What rounding leaves along the axis would count with the whole radius where n is close to it.
        let w = w - self.up * w.dot(self.up);
        let h = n.dot(w).max(0.0).sqrt();
        let inverse = if h > 1e-14 * self.size { 1.0 / h } else { 0.0 };
        Tip {
            point: self.up * self.cut + w * inverse,
            sides: 1,
            inverse,
        }
    }
}

impl Core for TruncatedCore {
    const CIRCLES: usize = 0;
    const DISCS: bool = true;

    #[inline(always)]
    fn tip_held(&self, n: DVec3, _held: u8, _sides: u8) -> Tip {
        let w = self.square.times(n);
        let inverse = 1.0 / n.dot(w).sqrt();
        let point = w * inverse;
        if self.up.dot(point) < self.cut {
            return self.rim_tip(n);
        }
        Tip {
            point,
            sides: 0,
            inverse,
        }
    }

    #[inline(always)]
    fn curvature(&self, _: DVec3, tip: &Tip, u: DVec3, w: DVec3) -> [f64; 3] {
        if tip.sides == 0 {
            quadric(&self.square, tip.point, tip.inverse, u, w)
        } else {
            quadric(&self.rim, tip.point - self.up * self.cut, tip.inverse, u, w)
        }
    }

    #[inline(always)]
    fn curvature_along(&self, n: DVec3, tip: &Tip, e: DVec3) -> f64 {
        self.curvature(n, tip, e, e)[0]
    }

    fn is_symmetric(&self) -> bool {
        false
    }

    #[inline(always)]
    fn disc(&self, sides: u8) -> Disc {
        let radius = if sides & 1 == 1 {
            self.axes[0].1.max(self.axes[1].1)
        } else {
            0.0
        };
        Disc {
            axis: -self.up,
            radius,
            centre: self.up * self.cut,
        }
    }

    #[cold]
    #[inline(never)]
    fn face_point(&self, n: DVec3, target: DVec3) -> DVec3 {
        let axial = n.dot(self.up);
        if axial > 0.0 || (n - self.up * axial).length() >= SQUARE {
            return self.tip(n).point;
        }
        let centre = self.up * self.cut;
        let offset = target - centre;
        let [(x, a), (z, b)] = self.axes;
        let (px, pz) = nearest_on_ellipse((offset.dot(x), offset.dot(z)), (a, b));
        centre + x * px + z * pz
    }

    /// Across the axis: at the end that is not cut s is looked at from the middle as it is.
    fn thin_axis(&self) -> Option<DVec3> {
        let [(x, a), (z, b)] = self.axes;
        Some(if a < b { x } else { z })
    }

    fn extents(&self) -> Symmetric {
        self.square
    }

    fn size(&self) -> f64 {
        self.size
    }
}

/// Point of the filled ellipse with semi-axes `(a, b)` nearest to `(x, y)`.
///
/// Outside, the nearest point is `(a^2 x / (a^2 + t), b^2 y / (b^2 + t))` with the t > 0 that puts it on the rim; the
/// condition is convex and falling in t, so Newton's method from t = 0 climbs to it without overshooting.
pub(in crate::query) fn nearest_on_ellipse((x, y): (f64, f64), (a, b): (f64, f64)) -> (f64, f64) {
    let (p, q) = (x / a, y / b);
    if p * p + q * q <= 1.0 {
        return (x, y);
    }
    let (aa, bb) = (a * a, b * b);
    let mut t = 0.0;
    for _ in 0..30 {
        let (u, w) = (a * x / (aa + t), b * y / (bb + t));
        let excess = u * u + w * w - 1.0;
        let slope = 2.0 * (u * u / (aa + t) + w * w / (bb + t));
        if excess <= 1e-15 {
            break;
        }
        t += excess / slope;
    }
    (aa * x / (aa + t), bb * y / (bb + t))
}
