//! How deep two polytopes overlap, by growing a polytope inside that of their differences (van den Bergen 2001).
//!
//! The polytope inside has the origin within. Its facet nearest to the origin bounds the depth from below and s at
//! that facet's normal bounds it from above; where they meet, no other normal can be better: the answer is global.

use std::f64::consts::FRAC_1_SQRT_2;

use glam::DVec3;

use super::simplex::{Best, Corner, ROUNDING, corner, rounding};
use super::{Limits, Placed, Separation, flats};
use crate::hull::{Facet, Surface};

/// What the growth found.
pub(super) struct Growth {
    corners: Vec<Corner>,
    /// The polytope inside, of the same corners; none where they span no volume.
    surface: Option<Surface>,
    pub best: Best,
    pub iterations: u32,
    /// Largest ball about the origin in the polytope inside: the shapes overlap by no less [m]. None while the origin
    /// lies outside.
    pub inner: Option<f64>,
    pub converged: bool,
}

/// Signed gap of two overlapping polytopes; `first` are corners found so far, and `best` the normal.
pub(super) fn separation(
    a: &Placed,
    b: &Placed,
    first: &[Corner],
    best: Best,
    iterations: u32,
    limits: Limits,
) -> Separation {
    let growth = grow(a, b, first, best, iterations, limits.iteration_cap, 0.0);
    let Best { s, n } = growth.best;
    let (point_a, point_b) = growth.contact(a, b);
    Separation {
        gap: s,
        upper: growth.inner.map(|inner| (-inner).max(s)),
        normal: n,
        point_a,
        point_b,
        iterations: growth.iterations,
        capped: !growth.converged,
        local: false,
    }
}

/// Grows until no normal can be better than the best by more than `room_left` [m], or the iterations end.
pub(super) fn grow(
    a: &Placed,
    b: &Placed,
    first: &[Corner],
    best: Best,
    iterations: u32,
    cap: u32,
    room_left: f64,
) -> Growth {
    let slack = ROUNDING * (a.shape.size() + b.shape.size());
    let mut growth = Growth {
        corners: first.to_vec(),
        surface: None,
        best,
        iterations,
        inner: None,
        converged: false,
    };
    let Some(first) = growth.first_four(a, b) else {
        // All differences lie in one plane, across which the overlap has no depth.
        growth.converged = true;
        return growth;
    };
    let more = cap.saturating_sub(iterations).min(64) as usize;
    let mut surface = Surface::new(first, more);
    while let Some(nearest) = nearest(&surface) {
        let (n, depth) = (-nearest.normal, nearest.offset);
        growth.inner = (depth >= 0.0).then_some(depth);
        let room = -growth.best.s - depth;
        if room <= room_left.max(slack) || growth.iterations >= cap {
            growth.converged = room <= room_left.max(1e5 * slack);
            break;
        }
        growth.iterations += 1;
        let next = corner(a, b, n);
        let s = n.dot(next.d);
        if -s - depth <= slack {
            growth.best = Best { s, n };
            growth.converged = true;
            break;
        }
        growth.best.offer(s, n);
        surface.add(next.d, slack);
        growth.corners.push(next);
    }
    growth.surface = Some(surface);
    growth
}

/// The facet nearest to the origin.
fn nearest(surface: &Surface) -> Option<Facet> {
    let mut best: Option<&Facet> = None;
    for facet in surface.facets.iter().filter(|f| f.normal != DVec3::ZERO) {
        if best.is_none_or(|b| facet.offset < b.offset) {
            best = Some(facet);
        }
    }
    best.copied()
}

impl Growth {
    /// Adds corners until four span a volume; `None` if there is none.
    fn first_four(&mut self, a: &Placed, b: &Placed) -> Option<[DVec3; 4]> {
        let size = a.shape.size() + b.shape.size();
        while self.corners.len() < 4 {
            let at = self.corners[0].d;
            let to = |i: usize| self.corners[i].d - at;
            let (axes, normal) = match self.corners.len() {
                1 => ([DVec3::X, DVec3::Y, DVec3::Z], None),
                2 => {
                    let along = to(1).normalize_or(DVec3::X);
                    let (u, w) = along.any_orthonormal_pair();
                    ([u, w, (u + w) * FRAC_1_SQRT_2], None)
                }
                _ => {
                    let normal = to(1).cross(to(2)).normalize_or(DVec3::X);
                    ([normal; 3], Some(normal))
                }
            };
            let along = (self.corners.len() == 2).then(|| to(1).normalize_or(DVec3::X));
            let mut widest: Option<(f64, Corner)> = None;
            for n in axes.into_iter().flat_map(|axis| [axis, -axis]) {
                let found = corner(a, b, n);
                self.best.offer(n.dot(found.d), n);
                let away = found.d - at;
                let width = match (along, normal) {
                    (Some(along), _) => away.cross(along).length(),
                    (_, Some(normal)) => normal.dot(away).abs(),
                    _ => away.length(),
                };
                if widest.is_none_or(|(w, _)| width > w) {
                    widest = Some((width, found));
                }
            }
            let (_, found) = widest.filter(|(width, _)| *width > 1e-10 * size)?;
            self.corners.push(found);
        }
        Some([0, 1, 2, 3].map(|i| self.corners[i].d))
    }

    /// The corners of the facet nearest to the origin.
    pub fn nearest_corners(&self) -> Vec<Corner> {
        let facet = self.surface.as_ref().and_then(nearest);
        let corners = facet.map_or([0; 3], |facet| facet.corners);
        corners.map(|i| self.corners[i]).to_vec()
    }

    /// Points of a and b that lie on one line along the best normal, as far as there are any.
    pub fn contact(&self, a: &Placed, b: &Placed) -> (DVec3, DVec3) {
        let Best { s, n } = self.best;
        let lined_up = || {
            let found = flats::line_up(a, b, n, s).ok()?;
            let (p, q) = (rounding(a).unwrap_or(0.0), rounding(b).unwrap_or(0.0));
            Some((found.point_a - n * p, found.point_b + n * q))
        };
        self.points(n).or_else(lined_up).unwrap_or_else(|| {
            let found = corner(a, b, n);
            (found.a, found.b)
        })
    }

    /// Points of a and b that lie on one line along n, from the facet of this normal that the origin is over.
    fn points(&self, n: DVec3) -> Option<(DVec3, DVec3)> {
        for facet in &self.surface.as_ref()?.facets {
            if facet.normal.dot(n) > -(1.0 - 1e-13) {
                continue;
            }
            let [p, q, r] = facet.corners.map(|i| self.corners[i]);
            let normal = (q.d - p.d).cross(r.d - p.d);
            let weights = [
                normal.dot(q.d.cross(r.d)),
                normal.dot(r.d.cross(p.d)),
                normal.dot(p.d.cross(q.d)),
            ];
            let sum = weights[0] + weights[1] + weights[2];
            if weights.iter().all(|w| *w >= -1e-9 * sum) && sum > 0.0 {
                let [x, y, z] = weights.map(|w| w / sum);
                return Some((p.a * x + q.a * y + r.a * z, p.b * x + q.b * y + r.b * z));
            }
        }
        None
    }
}
