//! The two kinds of way that the search takes over the sphere of normals, and where they meet a kink.

use glam::DVec3;

use super::cores::Circle;

/// A way over the sphere, run through by `x` from 0.
pub(super) trait Path {
    fn at(&self, x: f64) -> DVec3;

    /// Direction of the way at its point `n`, of any length.
    fn heading(&self, n: DVec3) -> DVec3;

    /// Where in `0..=end` the way meets the circle with the number `index`, if it does.
    fn meets(&self, circle: &Circle, index: usize, end: f64) -> Option<(f64, DVec3)>;
}

/// `normalize(from + x step)`, a great circle.
pub(super) struct Arc {
    pub from: DVec3,
    pub step: DVec3,
    /// The circle that the search has just left; the way begins on it and meets it again at the far root only.
    pub left: Option<usize>,
}

impl Path for Arc {
    #[inline(always)]
    fn at(&self, x: f64) -> DVec3 {
        let n = self.from + self.step * x;
        n * (1.0 / n.length())
    }

    #[inline(always)]
    fn heading(&self, n: DVec3) -> DVec3 {
        self.step - n * n.dot(self.step)
    }

    #[inline(always)]
    fn meets(&self, circle: &Circle, index: usize, end: f64) -> Option<(f64, DVec3)> {
        let (rise, slope) = (self.from.dot(circle.axis), self.step.dot(circle.axis));
        let c = circle.height;
        let x = if c == 0.0 {
            -rise / slope
        } else {
            // (rise + x slope)^2 = c^2 (1 + x^2 |step|^2), with the sign of c.
            let (qa, qb, qc) = (
                slope * slope - c * c * self.step.length_squared(),
                rise * slope,
                rise * rise - c * c,
            );
            let root = (qb * qb - qa * qc).max(0.0).sqrt();
            let q = -(qb + root.copysign(qb));
            let first = if qa == 0.0 { -1.0 } else { q / qa };
            let second = if q == 0.0 { 0.0 } else { qc / q };
            let fits = |x: f64| x >= -1e-9 && x <= end + 1e-9 && (rise + x * slope) * c >= -1e-12;
            if self.left == Some(index) {
                let far = if first.abs() > second.abs() {
                    first
                } else {
                    second
                };
                if fits(far) { far } else { end }
            } else {
                match (fits(first), fits(second)) {
                    (true, true) => first.min(second),
                    (true, false) => first,
                    (false, true) => second,
                    (false, false) => 0.5 * end,
                }
            }
        };
        let x = if x.is_finite() {
            x.clamp(0.0, end)
        } else {
            end
        };
        Some((x, self.at(x)))
    }
}

/// Along one circle: `height axis + radius normalize(out + x ahead)`.
pub(super) struct Along {
    pub circle: Circle,
    /// Unit vector from the circle's centre to where the way begins.
    pub out: DVec3,
    /// Unit tangent in the sense of the way.
    pub ahead: DVec3,
}

impl Path for Along {
    #[inline(always)]
    fn at(&self, x: f64) -> DVec3 {
        let out = self.out + self.ahead * x;
        self.circle.axis * self.circle.height + out * (self.circle.radius / out.length())
    }

    #[inline(always)]
    fn heading(&self, n: DVec3) -> DVec3 {
        let out = (n - self.circle.axis * self.circle.height) * (1.0 / self.circle.radius);
        let around = self.circle.axis.cross(out);
        // Whichever sense the way has at its start it keeps.
        let sense = self.circle.axis.cross(self.out).dot(self.ahead);
        around * 1.0_f64.copysign(sense)
    }

    #[inline(always)]
    fn meets(&self, circle: &Circle, _: usize, _: f64) -> Option<(f64, DVec3)> {
        let (p, q) = crossings(&self.circle, circle)?;
        let along = |n: DVec3| {
            let out = n - self.circle.axis * self.circle.height;
            let (near, ahead) = (out.dot(self.out), out.dot(self.ahead));
            let x = ahead / near;
            (near > 1e-6 * self.circle.radius && x >= -1e-9).then(|| (x.max(0.0), n))
        };
        match (along(p), along(q)) {
            (Some(x), Some(y)) => Some(if x.0 < y.0 { x } else { y }),
            (x, y) => x.or(y),
        }
    }
}

/// The two normals in which two circles cross.
#[inline(always)]
pub(super) fn crossings(one: &Circle, two: &Circle) -> Option<(DVec3, DVec3)> {
    let cosine = one.axis.dot(two.axis);
    let across = one.axis.cross(two.axis);
    let det = across.length_squared();
    if det < 1e-20 {
        return None;
    }
    let inverse = 1.0 / det;
    let p = (one.height - two.height * cosine) * inverse;
    let q = (two.height - one.height * cosine) * inverse;
    let rest = 1.0 - (p * one.height + q * two.height);
    if rest < -1e-14 * det {
        return None;
    }
    let middle = one.axis * p + two.axis * q;
    let aside = across * (rest.max(0.0) * inverse).sqrt();
    let unit = |v: DVec3| v * (1.0 / v.length());
    Some((unit(middle + aside), unit(middle - aside)))
}
