//! The hull of two coaxial discs: cylinder, cone, frustum, and the segment inside a capsule.

use glam::DVec3;

use super::{Circle, Core, Disc, SQUARE, Symmetric, Tip};
use crate::shape::Profile;

pub(in crate::query) struct RevolutionCore<'a> {
    pub axis: DVec3,
    pub profile: &'a Profile,
}

/// Multiplied out: the precision of `powi` is nowhere specified.
#[inline(always)]
fn cube(x: f64) -> f64 {
    x * x * x
}

/// How far n leans from the axis where rounding along it starts to tell.
const NEAR_AXIS: f64 = 0.1;

impl RevolutionCore<'_> {
    /// n along the axis, n across it and the length of that.
    ///
    /// Close to the axis what rounding leaves of it in the vector across would count with the disc's whole radius.
    #[inline(always)]
    fn split(&self, n: DVec3) -> (f64, DVec3, f64) {
        let axial = n.dot(self.axis);
        let mut across = n - self.axis * axial;
        let mut length = across.length();
        if length < NEAR_AXIS {
            across -= self.axis * across.dot(self.axis);
            length = across.length();
        }
        (axial, across, length)
    }

    #[inline(always)]
    fn disc_tip(&self, across: DVec3, length: f64, side: usize) -> Tip {
        let inverse = if length > 1e-14 { 1.0 / length } else { 0.0 };
        let p = self.profile;
        Tip {
            point: across * (inverse * p.radius[side]) + self.axis * p.height[side],
            sides: side as u8,
            inverse,
        }
    }
}

impl Core for RevolutionCore<'_> {
    const CIRCLES: usize = 1;
    const DISCS: bool = true;

    #[inline(always)]
    fn tip_held(&self, n: DVec3, held: u8, sides: u8) -> Tip {
        let (axial, across, length) = self.split(n);
        let p = self.profile;
        let natural = u8::from(axial * p.mantle.0 > length * p.mantle.1);
        let side = natural & !held | sides & held & 1;
        self.disc_tip(across, length, usize::from(side & 1))
    }

    #[inline(always)]
    fn reach(&self, n: DVec3) -> f64 {
        let axial = n.dot(self.axis);
        let across = (1.0 - axial * axial).max(0.0).sqrt();
        let p = self.profile;
        let low = p.radius[0] * across + p.height[0] * axial;
        let high = p.radius[1] * across + p.height[1] * axial;
        if low > high { low } else { high }
    }

    /// A disc's support point moves around its rim only: `r / |n across| e e^T`, e along the rim.
    #[inline(always)]
    fn curvature(&self, n: DVec3, tip: &Tip, u: DVec3, w: DVec3) -> [f64; 3] {
        let rim = self.axis.cross(n);
        let (p, q) = (rim.dot(u), rim.dot(w));
        let f = self.profile.radius[usize::from(tip.sides & 1)] * cube(tip.inverse);
        [f * p * p, f * p * q, f * q * q]
    }

    #[inline(always)]
    fn curvature_along(&self, n: DVec3, tip: &Tip, e: DVec3) -> f64 {
        let p = self.axis.cross(n).dot(e);
        self.profile.radius[usize::from(tip.sides & 1)] * cube(tip.inverse) * p * p
    }

    /// The normals of the mantle, along which it is a straight line.
    #[inline(always)]
    fn circle(&self, _: usize) -> Circle {
        Circle {
            axis: self.axis,
            height: self.profile.mantle.1,
            radius: self.profile.mantle.0,
            jump: self.profile.slant,
        }
    }

    #[inline(always)]
    fn has_small_circle(&self) -> bool {
        self.profile.mantle.1 != 0.0
    }

    fn is_symmetric(&self) -> bool {
        let p = self.profile;
        p.radius[0] == p.radius[1] && p.height[0] == -p.height[1]
    }

    #[inline(always)]
    fn disc(&self, sides: u8) -> Disc {
        let side = usize::from(sides & 1);
        Disc {
            axis: if side == 1 { self.axis } else { -self.axis },
            radius: self.profile.radius[side],
            centre: self.axis * self.profile.height[side],
        }
    }

    #[cold]
    #[inline(never)]
    fn face_point(&self, n: DVec3, target: DVec3) -> DVec3 {
        let p = self.profile;
        let axial = n.dot(self.axis);
        let across = n - self.axis * axial;
        let length = across.length();
        if length < SQUARE {
            let side = usize::from(axial > 0.0);
            let centre = self.axis * p.height[side];
            let offset = target - centre;
            let offset = offset - self.axis * offset.dot(self.axis);
            let reach = offset.length();
            let scale = if reach > p.radius[side] {
                p.radius[side] / reach
            } else {
                1.0
            };
            return centre + offset * scale;
        }
        if (axial * p.mantle.0 - length * p.mantle.1).abs() < SQUARE {
            let out = across / length;
            let low = out * p.radius[0] + self.axis * p.height[0];
            let edge = out * (p.radius[1] - p.radius[0]) + self.axis * (p.height[1] - p.height[0]);
            let along = (target - low).dot(edge) / edge.length_squared();
            return low + edge * along.clamp(0.0, 1.0);
        }
        self.tip(n).point
    }

    fn extents(&self) -> Symmetric {
        let p = self.profile;
        let radius = p.radius[0].max(p.radius[1]);
        Symmetric::about_axis(self.axis, radius * radius, p.height[1] * p.height[1])
    }

    fn size(&self) -> f64 {
        self.profile.radius[0]
            .max(self.profile.radius[1])
            .max(self.profile.height[1])
    }
}
