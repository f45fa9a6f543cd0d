//! The search for the largest s(n): a second-order step on the sphere of normals, for smooth and kinked shapes alike.
//!
//! Every shape is the hull of pieces with smooth support points (`support.rs`), so `s = min over pairs of pieces` of
//! smooth functions `s_k`. Around n, with the tangent vector t, each of them is
//! `s_k + g_k.t - t.H_k t / 2`, `g_k = D_k - s_k n`, `H_k = C_a + C_b + s_k 1`. Maximising the smallest of a few such
//! models is a tiny dual problem: with one piece it is the Newton step `H t = g`, with two it runs along the kink,
//! with three it sits in a corner. Pairs of pieces enter when a trial normal meets them, and leave when their
//! multiplier vanishes. The true s never falls from one accepted normal to the next.

use glam::{DVec2, DVec3};

use super::models::{Bundle, Tangent, model};
use super::{Limits, Placed, Separation, flats, gap_along};

/// Longest step on the tangent plane [rad, about].
const LONGEST: f64 = 1.0;
/// A step this short changes nothing any more [rad].
const SHORTEST: f64 = 1e-12;
/// The natural pair of pieces at a normal, with its points.
fn natural(a: &Placed, b: &Placed, n: DVec3) -> ((u32, u32), f64) {
    let (tip_a, tip_b) = (a.shape.tip(a.local(n)), b.shape.tip(b.local(-n)));
    let point_a = a.position + a.rotation * tip_a.point;
    let point_b = b.position + b.rotation * tip_b.point;
    ((tip_a.piece, tip_b.piece), n.dot(point_b - point_a))
}

/// Climbs from `start` to the nearest maximum of s; also the points of b that carry the answer.
pub(super) fn ascend(
    a: &Placed,
    b: &Placed,
    start: DVec3,
    limits: Limits,
) -> (Separation, Vec<DVec3>) {
    let mut climb = Climb::new(a, b, start, limits);
    loop {
        if let Some(answer) = climb.step() {
            let carrying = climb.kept.models[..climb.kept.count].iter();
            let carrying = carrying.filter(|m| m.weight > 0.0).map(|m| m.points.1);
            return (answer, carrying.collect());
        }
    }
}

/// A search under way.
struct Climb<'a> {
    a: &'a Placed<'a>,
    b: &'a Placed<'a>,
    limits: Limits,
    scale: f64,
    tangent: Tangent,
    s: f64,
    kept: Bundle,
    iterations: u32,
    /// Longest step trusted at present.
    radius: f64,
    /// How often a pole was left.
    left: u32,
}

impl<'a> Climb<'a> {
    fn new(a: &'a Placed<'a>, b: &'a Placed<'a>, start: DVec3, limits: Limits) -> Climb<'a> {
        let tangent = Tangent::at(start);
        let (pieces, s) = natural(a, b, start);
        let kept = Bundle::new(model(a, b, pieces, &tangent, 1.0));
        let scale = a.shape.size() + b.shape.size();
        Climb {
            a,
            b,
            limits,
            scale,
            tangent,
            s,
            kept,
            iterations: 0,
            radius: LONGEST,
            left: 0,
        }
    }

    fn answer(&self, capped: bool) -> Option<Separation> {
        Some(
            self.kept
                .answer(self.tangent.n, self.s, self.iterations, capped),
        )
    }

    /// One new normal; the answer when the search is over.
    fn step(&mut self) -> Option<Separation> {
        if self.s > self.limits.enough {
            return self.answer(false);
        }
        let (mut t, gain) = self.kept.solve(self.s, self.scale);
        // Apart, the normal is to be right and not only the gap: between corners that nearly touch s is almost flat.
        let straight = self.s <= 0.0 || t.length() < 1e-7;
        let finished = gain <= self.limits.tolerance && straight;
        if self.iterations >= self.limits.iteration_cap {
            return self.answer(!finished);
        }
        if finished && t.length() < SHORTEST {
            return self.answer(false);
        }
        if let Some(over) = self.cross_pole(t) {
            return over;
        }
        if self.iterations >= self.limits.iteration_cap {
            return self.answer(!finished);
        }
        t = t.clamp_length_max(self.radius);
        self.iterations += 1;
        let n = self.tangent.step(t);
        let (pieces, trial) = natural(self.a, self.b, n);
        let newcomer = !self.kept.follows(self.a, self.b, n, pieces);
        if trial >= self.s {
            self.move_to(n, trial);
            if newcomer {
                self.kept
                    .add(model(self.a, self.b, pieces, &self.tangent, 0.0));
            }
            self.radius = (self.radius * 2.0).min(LONGEST);
            return if finished { self.answer(false) } else { None };
        }
        if newcomer {
            // A kink was in the way: the same step again, knowing the other side.
            self.kept
                .add(model(self.a, self.b, pieces, &self.tangent, 0.0));
            return None;
        }
        if finished || t.length() < SHORTEST {
            return self.answer(false);
        }
        self.radius = 0.3 * t.length();
        None
    }

    fn move_to(&mut self, n: DVec3, s: f64) {
        self.tangent = Tangent::at(n);
        self.s = s;
        self.kept.remodel(self.a, self.b, &self.tangent);
    }

    /// A disc's axis is a point where s has no derivative and second-order steps crawl; a step that passes it by
    /// looks there first.
    ///
    /// Either the closest points line up at the pole, which then is the answer, or the search leaves it along the
    /// offset that remains. `None`: no pole in the way, or a worse one.
    fn cross_pole(&mut self, t: DVec2) -> Option<Option<Separation>> {
        let tangent = self.tangent;
        let step = tangent.u * t.x + tangent.w * t.y;
        let pole = self
            .kept
            .poles(self.a, self.b)
            .into_iter()
            .flatten()
            .find(|pole| {
                let height = tangent.n.dot(*pole);
                height > 0.0 && step.dot(*pole) * height >= 0.5 * (1.0 - height * height)
            })?;
        if self.left >= 4 {
            return None;
        }
        let s = gap_along(self.a, self.b, pole);
        if s < self.s {
            return None;
        }
        self.left += 1;
        self.iterations += 1;
        let offset = match flats::line_up(self.a, self.b, pole, s) {
            Ok(answer) => {
                return Some(Some(Separation {
                    iterations: self.iterations,
                    ..answer
                }));
            }
            Err(offset) => offset,
        };
        let mut angle = (offset.length() / (0.1 * self.scale + s.abs())).min(LONGEST);
        let direction = offset.try_normalize()?;
        for _ in 0..30 {
            let n = (pole + direction * angle).try_normalize()?;
            let (pieces, trial) = natural(self.a, self.b, n);
            if trial > s {
                self.s = trial;
                self.tangent = Tangent::at(n);
                self.kept = Bundle::new(model(self.a, self.b, pieces, &self.tangent, 1.0));
                self.radius = LONGEST;
                return Some(None);
            }
            angle *= 0.3;
        }
        None
    }
}
