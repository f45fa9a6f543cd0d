//! Second-order models of the pairs of pieces around a normal, and where the smallest of them is largest.

use glam::{DVec2, DVec3};

use super::{Placed, Separation};

/// Pairs of pieces kept at a time; three are enough for the optimum, a fourth is the newcomer.
const KEPT: usize = 4;

/// Second-order model of one pair of pieces at the current normal.
#[derive(Clone, Copy)]
pub(super) struct Model {
    pieces: (u32, u32),
    pub points: (DVec3, DVec3),
    s: f64,
    gradient: DVec2,
    /// Negative second derivative: xx, xy, yy.
    hessian: [f64; 3],
    pub weight: f64,
}

/// Tangent plane at a normal.
#[derive(Clone, Copy)]
pub(super) struct Tangent {
    pub n: DVec3,
    pub u: DVec3,
    pub w: DVec3,
}

impl Tangent {
    pub fn at(n: DVec3) -> Tangent {
        let (u, w) = n.any_orthonormal_pair();
        Tangent { n, u, w }
    }

    pub fn step(&self, t: DVec2) -> DVec3 {
        let moved = self.n + self.u * t.x + self.w * t.y;
        moved / moved.length()
    }
}

/// The model of a pair of pieces, with the weight that it has so far.
pub(super) fn model(
    a: &Placed,
    b: &Placed,
    pieces: (u32, u32),
    tangent: &Tangent,
    weight: f64,
) -> Model {
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

/// The pairs of pieces in play.
pub(super) struct Bundle {
    pub models: [Model; KEPT],
    pub count: usize,
}

impl Bundle {
    pub fn new(first: Model) -> Bundle {
        Bundle {
            models: [first; KEPT],
            count: 1,
        }
    }

    /// Whether one of the models is that of `pieces` at the normal `n`.
    pub fn follows(&self, a: &Placed, b: &Placed, n: DVec3, pieces: (u32, u32)) -> bool {
        let (local_a, local_b) = (a.local(n), b.local(-n));
        self.models[..self.count].iter().any(|m| {
            a.shape.piece_in_charge(m.pieces.0, local_a) == pieces.0
                && b.shape.piece_in_charge(m.pieces.1, local_b) == pieces.1
        })
    }

    /// Axes of the discs in play, as normals from a to b.
    pub fn poles(&self, a: &Placed, b: &Placed) -> [Option<DVec3>; 2] {
        let mut poles = [None, None];
        for m in self.models[..self.count].iter().filter(|m| m.weight > 0.0) {
            poles[0] = poles[0].or(a.shape.pole(m.pieces.0).map(|y| a.rotation.y_axis * y));
            poles[1] = poles[1].or(b.shape.pole(m.pieces.1).map(|y| b.rotation.y_axis * -y));
        }
        poles
    }

    /// Adds a model in place of the least wanted: no weight, and farthest from being the smallest.
    pub fn add(&mut self, model: Model) {
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
    pub fn remodel(&mut self, a: &Placed, b: &Placed, tangent: &Tangent) {
        for m in &mut self.models[..self.count] {
            *m = model(a, b, m.pieces, tangent, m.weight);
        }
    }

    /// Maximises the smallest model: the step, and the gain over `s` that it promises.
    pub fn solve(&mut self, s: f64, scale: f64) -> (DVec2, f64) {
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
    pub fn answer(&self, n: DVec3, s: f64, iterations: u32, capped: bool) -> Separation {
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
