//! Where s is smooth: Newton's step on the sphere, and discs' axes, on which it is not.

use glam::DVec3;

use super::super::cores::{Core, Disc};
use super::super::path::Arc;
use super::walk::End;
use super::{LINED_UP, ROUNDING, SURE, Search, State};

/// Longest step on the tangent plane; on the sphere the way to its end is an arc of 63 degrees.
const LONGEST: f64 = 2.0;
/// A step as short as this may be the last [rad].
pub(super) const SMALL: f64 = 2e-3;
/// Overlap that counts as touching, in units of the pair's size.
const TOUCHING: f64 = 1e-2;
/// Step along directions in which s is not concave [rad].
pub(super) const STRIDE: f64 = 0.7;

/// What became of a free step.
enum Step {
    Done,
    /// Go along this vector; the second: how much s bends at least, if it is a full Newton step [m].
    Go(DVec3, Option<f64>),
}

impl<A: Core, B: Core> Search<'_, A, B> {
    #[inline(always)]
    pub(super) fn step_free(&mut self) -> bool {
        let (step, newton) = match self.newton_step() {
            Step::Done => return true,
            Step::Go(step, newton) => (step, newton),
        };
        for of_b in [false, true] {
            if self.passes_disc(of_b, step) {
                match self.visit_disc(of_b, false) {
                    Ok(true) => return true,
                    Ok(false) => {}
                    Err((step, rise)) => return self.travel(step, rise, None),
                }
            }
        }
        let rise = self.pair.between(&self.tips).dot(step);
        self.travel(step, rise, newton)
    }

    /// The second-order step from n.
    #[inline(always)]
    fn newton_step(&mut self) -> Step {
        let (pair, n, s) = (self.pair, self.n, self.s);
        let d = pair.between(&self.tips);
        let (u, w) = n.any_orthonormal_pair();
        let g = (u.dot(d), w.dot(d));
        let across = g.0 * g.0 + g.1 * g.1;
        let lined_up = LINED_UP * pair.size;
        let level = across <= lined_up * lined_up;
        if level && s > 0.0 {
            return Step::Done;
        }
        let ca = pair.a.curvature(n, &self.tips.a, u, w);
        let cb = pair.b.curvature(n, &self.tips.b, u, w);
        let k = [ca[0] + cb[0] + s, ca[1] + cb[1], ca[2] + cb[2] + s];
        let det = k[0] * k[2] - k[1] * k[1];
        let slack = -1e-9 * pair.size;
        if level && k[0] > slack && k[2] > slack && det > slack * (k[0].abs() + k[2].abs()) {
            return Step::Done;
        }
        let newton = det > 0.0 && k[0] > 0.0;
        let t = if newton {
            let inverse = 1.0 / det;
            let t = (
                (k[2] * g.0 - k[1] * g.1) * inverse,
                (k[0] * g.1 - k[1] * g.0) * inverse,
            );
            let gain = 0.5 * (t.0 * g.0 + t.1 * g.1);
            let sure = t.0 * t.0 + t.1 * t.1 <= SURE * SURE;
            if gain <= self.goal.tolerance && sure && self.is_narrow(across) {
                return Step::Done;
            }
            t
        } else if let Some(t) = self.saddle_step(k, det, g, u, w) {
            t
        } else {
            uphill(k, g, pair.size, s)
        };
        let mut step = u * t.0 + w * t.1;
        if let Some((_, away)) = self.left
            && step.dot(away) <= 0.0
        {
            step = (d - n * s) * (1.0 / pair.size);
        }
        let length = step.length_squared();
        if length > LONGEST * LONGEST {
            step *= LONGEST / length.sqrt();
        }
        Step::Go(step, newton.then(|| det / (k[0] + k[2])))
    }

    /// Newton's step where s is not concave, if it gains: of edges and corners that all but touch s is a ridge, which is
    /// concave only where they are apart.
    #[inline(never)]
    fn saddle_step(
        &self,
        k: [f64; 3],
        det: f64,
        g: (f64, f64),
        u: DVec3,
        w: DVec3,
    ) -> Option<(f64, f64)> {
        if self.s < -TOUCHING * self.pair.size || det == 0.0 {
            return None;
        }
        let t = (
            (k[2] * g.0 - k[1] * g.1) / det,
            (k[0] * g.1 - k[1] * g.0) / det,
        );
        if t.0 * t.0 + t.1 * t.1 > 1.0 {
            return None;
        }
        let n = self.n + u * t.0 + w * t.1;
        let gained = self.pair.gap(n * (1.0 / n.length())) - self.s;
        (gained > 0.5 * self.s.abs()).then_some(t)
    }

    /// Whether the step passes the axis of the disc that the support point lies on, where s has no derivative.
    #[inline(always)]
    fn passes_disc(&self, of_b: bool, step: DVec3) -> bool {
        if !(if of_b { B::DISCS } else { A::DISCS }) {
            return false;
        }
        let disc = self.disc(of_b);
        let (height, towards) = (self.n.dot(disc.axis), step.dot(disc.axis));
        disc.radius > 0.0 && height > 0.0 && towards * height >= 0.5 * (1.0 - height * height)
    }

    /// The disc that the support point of a (or b) lies on.
    #[inline(always)]
    pub(super) fn disc(&self, of_b: bool) -> Disc {
        if of_b {
            self.pair.b.disc(self.tips.b.sides)
        } else {
            self.pair.a.disc(self.tips.a.sides)
        }
    }

    /// Looks at the axis of a disc: `Ok(true)` it is the answer, `Ok(false)` it is worse than here and nothing
    /// changed; `Err` the search now stands on it, and this is the step that leaves it, with the rise of s along it.
    #[inline(always)]
    pub(super) fn visit_disc(&mut self, of_b: bool, at_once: bool) -> Result<bool, (DVec3, f64)> {
        let pair = self.pair;
        let disc = self.disc(of_b);
        let axis = disc.axis;
        let tips = pair.tips(axis);
        let other = if of_b { tips.a } else { tips.b };
        let s = axis.dot(pair.offset - disc.centre - other.point);
        if !at_once && s < self.s - ROUNDING * pair.size {
            return Ok(false);
        }
        let offset = self.offset_on(axis, of_b, other.point);
        (self.n, self.s, self.tips) = (axis, s, tips);
        let length = offset.length();
        if length <= LINED_UP * pair.size {
            self.state = State::Disc(of_b);
            return Ok(true);
        }
        self.left = None;
        let away = offset * (1.0 / length);
        let bend = if of_b {
            pair.a.curvature_along(axis, &other, away)
        } else {
            pair.b.curvature_along(axis, &other, away)
        };
        let bend = (bend + s).max(0.02 * pair.size.min(disc.radius));
        let angle = (length / bend).min(1.0);
        Err((away * angle, angle * length))
    }

    /// How far the disc square to `axis` and the other core's point or face are apart across the axis.
    #[inline(always)]
    fn offset_on(&self, axis: DVec3, of_b: bool, other: DVec3) -> DVec3 {
        let pair = self.pair;
        let across = |own: DVec3, other: DVec3| {
            let d = pair.offset - own - other;
            d - axis * axis.dot(d)
        };
        let target = pair.offset - other;
        let own = if of_b {
            pair.b.face_point(axis, target)
        } else {
            pair.a.face_point(axis, target)
        };
        let offset = across(own, other);
        if offset.length() <= LINED_UP * pair.size {
            return offset;
        }
        let (a, b) = pair.line_up(axis);
        let lined_up = across(a, b);
        if lined_up.length_squared() < offset.length_squared() {
            lined_up
        } else {
            offset
        }
    }

    /// Goes along `step` as far as s rises; `rise` is the slope of s at its start. True if that was the last step.
    #[inline(always)]
    pub(super) fn travel(&mut self, step: DVec3, rise: f64, newton: Option<f64>) -> bool {
        let left = self.left.take().map(|(index, _)| index);
        let path = Arc {
            from: self.n,
            step,
            left,
        };
        match self.walk(&path, rise, 1.0) {
            End::Kink { index, n, below } => {
                self.hold(State::Circle(index), n, below);
                false
            }
            End::Open { x, n, tips, whole } => {
                let step_squared = step.length_squared() * x * x;
                let small = whole && step_squared < SMALL * SMALL;
                let same = small && tips.sides() == self.tips.sides();
                let before = self.across_squared();
                self.accept(n, tips);
                let bend = newton.filter(|_| same);
                bend.is_some_and(|bend| {
                    self.was_last(step_squared, before, self.across_squared(), bend)
                })
            }
        }
    }

    /// Squared offset of the closest points across n.
    #[inline(always)]
    fn across_squared(&self) -> f64 {
        (self.pair.between(&self.tips) - self.n * self.s).length_squared()
    }
}

/// A step where s is not concave: Newton's along the direction of positive curvature, a stride along the other.
#[inline(never)]
fn uphill(k: [f64; 3], g: (f64, f64), size: f64, s: f64) -> (f64, f64) {
    let (mean, spread) = (0.5 * (k[0] + k[2]), 0.5 * (k[0] - k[2]));
    let root = (spread * spread + k[1] * k[1]).sqrt();
    let largest = mean + root;
    let (x, y) = if spread >= 0.0 {
        (root + spread, k[1])
    } else {
        (k[1], root - spread)
    };
    let length = (x * x + y * y).sqrt();
    let (x, y) = if length > 1e-300 {
        (x / length, y / length)
    } else {
        (1.0, 0.0)
    };
    let (g_bent, g_other) = (x * g.0 + y * g.1, x * g.1 - y * g.0);
    let (bent, other) = if largest > 0.02 * size {
        let bent = (g_bent / largest).clamp(-STRIDE, STRIDE);
        // Where the surfaces all but touch, s is a sharp ridge: a stride along it from beside it only falls.
        let beside = s > -TOUCHING * size && 5.0 * bent * g_bent > STRIDE * g_other.abs();
        let stride = if beside { 0.0 } else { STRIDE };
        (bent, stride.copysign(g_other))
    } else {
        let slope = (g_bent * g_bent + g_other * g_other).sqrt();
        if slope > 1e-12 * size {
            (g_bent * STRIDE / slope, g_other * STRIDE / slope)
        } else {
            (STRIDE, 0.0)
        }
    };
    (x * bent - y * other, y * bent + x * other)
}
