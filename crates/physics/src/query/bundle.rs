//! The search for the largest s(n): a second-order step on the sphere of normals, for smooth and kinked shapes alike.
//!
//! Every shape is the hull of pieces with smooth support points (`support.rs`), so `s = min over pairs of pieces` of
//! smooth functions `s_k`. Around n, with the tangent vector t, each of them is
//! `s_k + g_k.t - t.H_k t / 2`, `g_k = D_k - s_k n`, `H_k = C_a + C_b + s_k 1`. Maximising the smallest of a few such
//! models is a tiny dual problem: with one piece it is the Newton step `H t = g`, with two it runs along the kink,
//! with three it sits in a corner. Pairs of pieces enter when a trial normal meets them, and leave when their
//! multiplier vanishes. The true s never falls from one accepted normal to the next.

use glam::{DVec2, DVec3};

use super::{Limits, Placed, Separation, flats, gap_along};

/// Longest step on the tangent plane [rad, about].
const LONGEST: f64 = 1.0;
/// A step this short changes nothing any more [rad].
const SHORTEST: f64 = 1e-12;
/// Pairs of pieces kept at a time; three are enough for the optimum, a fourth is the newcomer.
const KEPT: usize = 4;

/// Second-order model of one pair of pieces at the current normal.
#[derive(Clone, Copy)]
struct Model {
    pieces: (u32, u32),
    points: (DVec3, DVec3),
    s: f64,
    gradient: DVec2,
    /// Negative second derivative: xx, xy, yy.
    hessian: [f64; 3],
    weight: f64,
}

/// Tangent plane at a normal.
#[derive(Clone, Copy)]
struct Tangent {
    n: DVec3,
    u: DVec3,
    w: DVec3,
}

impl Tangent {
    fn at(n: DVec3) -> Tangent {
        let (u, w) = n.any_orthonormal_pair();
        Tangent { n, u, w }
    }

    fn step(&self, t: DVec2) -> DVec3 {
        let moved = self.n + self.u * t.x + self.w * t.y;
        moved / moved.length()
    }
}

/// The natural pair of pieces at a normal, with its points.
fn natural(a: &Placed, b: &Placed, n: DVec3) -> ((u32, u32), f64) {
    let (tip_a, tip_b) = (a.shape.tip(a.local(n)), b.shape.tip(b.local(-n)));
    let point_a = a.position + a.rotation * tip_a.point;
    let point_b = b.position + b.rotation * tip_b.point;
    ((tip_a.piece, tip_b.piece), n.dot(point_b - point_a))
}

fn model(a: &Placed, b: &Placed, pieces: (u32, u32), tangent: &Tangent, weight: f64) -> Model {
    let Tangent { n, u, w } = *tangent;
    let (local_a, local_b) = (a.local(n), b.local(-n));
    let pieces = (
        a.shape.piece_in_charge(pieces.0, local_a),
        b.shape.piece_in_charge(pieces.1, local_b),
    );
    let (piece_a, piece_b) = (a.shape.piece(pieces.0), b.shape.piece(pieces.1));
    let point_a = a.position + a.rotation * piece_a.point(local_a);
    let point_b = b.position + b.rotation * piece_b.point(local_b);
    let d = point_b - point_a;
    let s = n.dot(d);
    let (ua, wa, ub, wb) = (a.local(u), a.local(w), b.local(u), b.local(w));
    let (ca, cb) = (
        piece_a.curvature(local_a, ua),
        piece_b.curvature(local_b, ub),
    );
    let (da, db) = (
        piece_a.curvature(local_a, wa),
        piece_b.curvature(local_b, wb),
    );
    let hessian = [
        ua.dot(ca) + ub.dot(cb) + s,
        wa.dot(ca) + wb.dot(cb),
        wa.dot(da) + wb.dot(db) + s,
    ];
    let gradient = DVec2::new(u.dot(d), w.dot(d));
    Model {
        pieces,
        points: (point_a, point_b),
        s,
        gradient,
        hessian,
        weight,
    }
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

/// The pairs of pieces in play.
struct Bundle {
    models: [Model; KEPT],
    count: usize,
}

impl Bundle {
    fn new(first: Model) -> Bundle {
        Bundle {
            models: [first; KEPT],
            count: 1,
        }
    }

    /// Whether one of the models is that of `pieces` at the normal `n`.
    fn follows(&self, a: &Placed, b: &Placed, n: DVec3, pieces: (u32, u32)) -> bool {
        let (local_a, local_b) = (a.local(n), b.local(-n));
        self.models[..self.count].iter().any(|m| {
            a.shape.piece_in_charge(m.pieces.0, local_a) == pieces.0
                && b.shape.piece_in_charge(m.pieces.1, local_b) == pieces.1
        })
    }

    /// Axes of the discs in play, as normals from a to b.
    fn poles(&self, a: &Placed, b: &Placed) -> [Option<DVec3>; 2] {
        let mut poles = [None, None];
        for m in self.models[..self.count].iter().filter(|m| m.weight > 0.0) {
            poles[0] = poles[0].or(a.shape.pole(m.pieces.0).map(|y| a.rotation.y_axis * y));
            poles[1] = poles[1].or(b.shape.pole(m.pieces.1).map(|y| b.rotation.y_axis * -y));
        }
        poles
    }

    /// Adds a model in place of the least wanted: no weight, and farthest from being the smallest.
    fn add(&mut self, model: Model) {
        if self.count < KEPT {
            self.models[self.count] = model;
            self.count += 1;
            return;
        }
        let mut out = 0;
        for i in 1..KEPT {
            let (x, y) = (&self.models[i], &self.models[out]);
            if (x.weight, -x.s) < (y.weight, -y.s) {
                out = i;
            }
        }
        self.models[out] = model;
    }

    /// Models again at a new normal, dropping pairs without weight that are clearly out of play.
    fn remodel(&mut self, a: &Placed, b: &Placed, tangent: &Tangent) {
        for m in &mut self.models[..self.count] {
            *m = model(a, b, m.pieces, tangent, m.weight);
        }
    }

    /// Maximises the smallest model: the step, and the gain over `s` that it promises.
    fn solve(&mut self, s: f64, scale: f64) -> (DVec2, f64) {
        let curvature = self.curvature(s, scale);
        let count = self.count;
        let mut best: Option<(f64, DVec2, [f64; KEPT])> = None;
        // The dual function is convex: the subset whose solution violates no other model least is the optimum.
        for subset in 1u8..(1 << count) {
            if subset.count_ones() > 3 {
                continue;
            }
            if let Some((t, weights)) = self.stationary(subset, curvature) {
                let quadratic = 0.5 * t.dot(apply(curvature, t));
                let value = self.models[..count]
                    .iter()
                    .map(|m| m.s + m.gradient.dot(t))
                    .fold(f64::INFINITY, f64::min)
                    - quadratic;
                if best.is_none_or(|b| value > b.0) {
                    best = Some((value, t, weights));
                }
            }
        }
        let Some((value, t, weights)) = best else {
            return (DVec2::ZERO, 0.0);
        };
        for (m, weight) in self.models[..count].iter_mut().zip(weights) {
            m.weight = weight;
        }
        (t, value - s)
    }

    /// Weighted curvature, made positive definite so that the model has a maximum.
    fn curvature(&self, s: f64, scale: f64) -> [f64; 3] {
        let mut sum = [0.0; 3];
        let mut total = 0.0;
        for m in &self.models[..self.count] {
            for (x, h) in sum.iter_mut().zip(m.hessian) {
                *x += m.weight * h;
            }
            total += m.weight;
        }
        if total > 0.0 {
            sum = sum.map(|x| x / total);
        } else {
            sum = self.models[0].hessian;
        }
        let mean = 0.5 * (sum[0] + sum[2]);
        let spread = (0.25 * (sum[0] - sum[2]) * (sum[0] - sum[2]) + sum[1] * sum[1]).sqrt();
        // Where s > 0 it is concave by itself, if only just.
        let floor = if s > 0.0 { 1e-12 * scale } else { 1e-3 * scale };
        let shift = (floor - (mean - spread)).max(0.0);
        [sum[0] + shift, sum[1], sum[2] + shift]
    }

    /// Stationary point with exactly the models of `subset` active; `None` unless all multipliers are >= 0.
    fn stationary(&self, subset: u8, h: [f64; 3]) -> Option<(DVec2, [f64; KEPT])> {
        let mut index = [0usize; 3];
        let mut size = 0;
        for i in 0..self.count {
            if subset >> i & 1 == 1 {
                index[size] = i;
                size += 1;
            }
        }
        let m = |i: usize| &self.models[index[i]];
        let mut weights = [0.0; KEPT];
        let t = match size {
            1 => {
                weights[index[0]] = 1.0;
                solve(h, m(0).gradient)
            }
            2 => {
                let (dg, ds) = (m(0).gradient - m(1).gradient, m(0).s - m(1).s);
                let slope = dg.dot(solve(h, dg));
                if slope <= 0.0 {
                    return None;
                }
                let lambda = (-ds - dg.dot(solve(h, m(1).gradient))) / slope;
                if !(0.0..=1.0).contains(&lambda) {
                    return None;
                }
                weights[index[0]] = lambda;
                weights[index[1]] = 1.0 - lambda;
                solve(h, m(1).gradient + dg * lambda)
            }
            _ => {
                let (g, k) = (m(0).gradient - m(2).gradient, m(1).gradient - m(2).gradient);
                let det = g.perp_dot(k);
                if det.abs() <= 1e-14 * g.length() * k.length() {
                    return None;
                }
                let (p, q) = (m(2).s - m(0).s, m(2).s - m(1).s);
                let t = DVec2::new(p * k.y - q * g.y, q * g.x - p * k.x) / det;
                let right = apply(h, t) - m(2).gradient;
                let (x, y) = (right.perp_dot(k) / det, g.perp_dot(right) / det);
                let slack = -1e-12;
                if x < slack || y < slack || x + y > 1.0 - slack {
                    return None;
                }
                weights[index[0]] = x;
                weights[index[1]] = y;
                weights[index[2]] = 1.0 - x - y;
                t
            }
        };
        t.is_finite().then_some((t, weights))
    }

    /// The answer at the current normal; on kinks the closest points are the weighted mean of the pieces' points.
    fn answer(&self, n: DVec3, s: f64, iterations: u32, capped: bool) -> Separation {
        let (mut point_a, mut point_b, mut total) = (DVec3::ZERO, DVec3::ZERO, 0.0);
        for m in &self.models[..self.count] {
            point_a += m.points.0 * m.weight;
            point_b += m.points.1 * m.weight;
            total += m.weight;
        }
        Separation {
            gap: s,
            upper: None,
            normal: n,
            point_a: point_a / total,
            point_b: point_b / total,
            iterations,
            capped,
            local: false,
        }
    }
}

fn apply(h: [f64; 3], v: DVec2) -> DVec2 {
    DVec2::new(h[0] * v.x + h[1] * v.y, h[1] * v.x + h[2] * v.y)
}

fn solve(h: [f64; 3], v: DVec2) -> DVec2 {
    let det = h[0] * h[2] - h[1] * h[1];
    DVec2::new(h[2] * v.x - h[1] * v.y, h[0] * v.y - h[1] * v.x) / det
}
