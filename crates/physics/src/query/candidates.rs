//! Normals from which an overlap may be left: s has several maxima there.

use std::f64::consts::{FRAC_1_SQRT_2 as DIAGONAL, TAU};

use glam::DVec3;

use super::cores::{Circle, Core, Symmetric};
use super::pair::{OF_B, Pair};
use super::path::crossings;
use super::search::{State, Summit};

/// Room for all candidates of two boxes and of two frusta, and of thin ones around four circles.
const ROOM: usize = 40;
/// Normals around a circle that are looked at for thin cores: of fewer the sharpest of their maxima are missed.
const AROUND: usize = 48;

/// Normals to search from, each in its own state.
pub(super) struct Candidates {
    pub list: [(f64, DVec3, State); ROOM],
    pub count: usize,
    /// Whether both cores are their own images in their centres.
    symmetric: bool,
}

impl Candidates {
    pub fn new() -> Candidates {
        Candidates {
            list: [(f64::NEG_INFINITY, DVec3::Y, State::Free); ROOM],
            count: 0,
            symmetric: false,
        }
    }

    fn put<A: Core, B: Core>(&mut self, pair: &Pair<A, B>, n: DVec3, state: State) {
        // Of opposite normals of symmetric shapes the one along the line of centres is better.
        let backward = self.symmetric && n.dot(pair.offset) < 0.0;
        if self.count < ROOM && !backward {
            self.list[self.count] = (pair.rough_gap(n), n, state);
            self.count += 1;
        }
    }

    #[inline(never)]
    pub fn collect<A: Core, B: Core>(&mut self, pair: &Pair<A, B>) {
        self.symmetric = pair.a.is_symmetric() && pair.b.is_symmetric();
        let (ends_a, ends_b) = (ends(&pair.a), ends(&pair.b));
        for (ends, of_b) in [(&ends_a, false), (&ends_b, true)] {
            for n in ends.iter().flatten() {
                self.put(pair, *n, State::Disc(of_b));
            }
        }
        for i in (0..2 * OF_B).filter(|i| Pair::<A, B>::has_circle(*i)) {
            let circle = &pair.circle(i);
            let side = || {
                circle.axis * circle.height + circle.axis.any_orthonormal_pair().0 * circle.radius
            };
            let n = circle.nearest(pair.offset).unwrap_or_else(side);
            self.put(pair, n, State::Circle(i));
            for n in if i < OF_B { &ends_b } else { &ends_a }.iter().flatten() {
                if let Some(n) = circle.nearest(*n) {
                    self.put(pair, n, State::Circle(i));
                }
            }
            for j in (i + 1..2 * OF_B).filter(|j| Pair::<A, B>::has_circle(*j)) {
                self.put_crossings(pair, i, j);
            }
        }
        self.collect_between(pair, &ends_a, &ends_b);
    }

    /// The line of centres, thin directions and what lies between two ends' axes.
    fn collect_between<A: Core, B: Core>(
        &mut self,
        pair: &Pair<A, B>,
        ends_a: &[Option<DVec3>; 2],
        ends_b: &[Option<DVec3>; 2],
    ) {
        if let Some(n) = pair.offset.try_normalize() {
            self.put(pair, n, State::Free);
        }
        let thin = [pair.a.thin_axis(), pair.b.thin_axis()];
        if thin.contains(&None)
            && let Some(n) = thinnest(&pair.a.extents().plus(&pair.b.extents()))
        {
            let n = if n.dot(pair.offset) >= 0.0 { n } else { -n };
            self.put(pair, n, State::Free);
        }
        for axis in thin.into_iter().flatten() {
            self.put_about(pair, axis, ends_a, ends_b);
        }
        if let (Some(a), Some(b)) = (ends_a[1].or(ends_a[0]), ends_b[1].or(ends_b[0])) {
            let between = a + b * 1.0_f64.copysign(a.dot(b));
            let n = between * (1.0 / between.length());
            self.put(pair, n, State::Free);
            self.put(pair, -n, State::Free);
        }
    }

    /// The ends of the ridges through a summit at which the cores all but touch.
    ///
    /// Where a rim meets a corner or an apex s is a ridge, the arc of all normals square to the rim's tangent, and falls
    /// from both of its ends to the middle: either may be the higher one. An end lies on a kink.
    #[cold]
    #[inline(never)]
    pub fn collect_ridges<A: Core, B: Core>(&mut self, pair: &Pair<A, B>, summit: &Summit) {
        let tips = pair.tips(summit.n);
        let ends = [
            (A::DISCS, pair.a.disc(tips.a.sides), summit.points.0),
            (B::DISCS, pair.b.disc(tips.b.sides), summit.points.1),
        ];
        for (has, disc, point) in ends {
            let mut tangent = disc.axis.cross(summit.n);
            if tangent.length_squared() < 1e-12 {
                tangent = disc.axis.cross(point - disc.centre);
            }
            let Some(axis) = tangent.try_normalize().filter(|_| has) else {
                continue;
            };
            let ridge = Circle {
                axis,
                ..Circle::NONE
            };
            for i in (0..2 * OF_B).filter(|i| Pair::<A, B>::has_circle(*i)) {
                // Along edges that coincide all ends are as high.
                let Some((p, q)) =
                    crossings(&ridge, &pair.circle(i)).filter(|_| pair.twins(i) == 0)
                else {
                    continue;
                };
                for n in [p, q] {
                    // What an end gains in a search is of second order in the overlap.
                    if pair.rough_gap(n) > summit.s - summit.s * summit.s / pair.size {
                        self.put(pair, n, State::Circle(i));
                    }
                }
            }
        }
    }

    /// What is highest among the normals square to a needle's axis, and among those from a plate's axis towards the
    /// line of centres: of thin cores s has more maxima there than axes and crossings lead to.
    #[cold]
    #[inline(never)]
    pub fn collect_thin<A: Core, B: Core>(&mut self, pair: &Pair<A, B>) {
        for extents in [pair.a.extents(), pair.b.extents()] {
            let longest = extents.times(extents.times(extents.times(DVec3::new(0.48, 0.6, 0.64))));
            let thinnest = thinnest(&extents);
            let across = thinnest.and_then(|n| n.cross(pair.offset).try_normalize());
            for axis in [longest.try_normalize(), across].into_iter().flatten() {
                self.put_highest(pair, axis);
            }
        }
    }

    /// The maxima of s among many normals around a great circle.
    fn put_highest<A: Core, B: Core>(&mut self, pair: &Pair<A, B>, axis: DVec3) {
        let (u, w) = axis.any_orthonormal_pair();
        let at = |k: usize| {
            let (sin, cos) = libm::sincos(k as f64 * (TAU / AROUND as f64));
            u * cos + w * sin
        };
        let heights: [f64; AROUND] = std::array::from_fn(|k| pair.rough_gap(at(k)));
        for k in peaks(&heights) {
            self.put(pair, at(k), State::Free);
        }
    }

    /// Where an ellipsoid's shortest axis leads: s has a maximum near it, and several around a mantle or a cut's rim.
    fn put_about<A: Core, B: Core>(
        &mut self,
        pair: &Pair<A, B>,
        axis: DVec3,
        ends_a: &[Option<DVec3>; 2],
        ends_b: &[Option<DVec3>; 2],
    ) {
        let mut has_mantle = false;
        for (discs, mantle, ends) in [(A::DISCS, 0, ends_a), (B::DISCS, OF_B, ends_b)] {
            if discs && Pair::<A, B>::has_circle(mantle) {
                has_mantle = true;
                self.put_around(pair, &pair.circle(mantle), axis, State::Circle(mantle));
            } else if let Some(axis_of_cut) = ends[0].or(ends[1]) {
                let rim = Circle {
                    axis: axis_of_cut,
                    height: DIAGONAL,
                    radius: DIAGONAL,
                    jump: 0.0,
                };
                self.put_around(pair, &rim, axis, State::Free);
            }
        }
        if !has_mantle {
            self.put(pair, axis, State::Free);
            self.put(pair, -axis, State::Free);
        }
    }

    /// Those of eight normals around a circle, the nearest to `from` the first, that are higher than their neighbours.
    fn put_around<A: Core, B: Core>(
        &mut self,
        pair: &Pair<A, B>,
        circle: &Circle,
        from: DVec3,
        state: State,
    ) {
        let Some(first) = circle.nearest(from) else {
            return;
        };
        let middle = circle.axis * circle.height;
        let out = first - middle;
        let ahead = circle.axis.cross(out);
        let (c, d) = (out * DIAGONAL, ahead * DIAGONAL);
        let around = [out, c + d, ahead, d - c, -out, -c - d, -ahead, c - d].map(|v| middle + v);
        let heights = around.map(|n| pair.rough_gap(n));
        for k in peaks(&heights) {
            self.put(pair, around[k], state);
        }
    }

    fn put_crossings<A: Core, B: Core>(&mut self, pair: &Pair<A, B>, i: usize, j: usize) {
        let (one, two) = (&pair.circle(i), &pair.circle(j));
        let Some((p, q)) = crossings(one, two) else {
            return;
        };
        if one.height == 0.0 && two.height == 0.0 {
            // Opposite normals: s differs by the offset alone.
            let n = if p.dot(pair.offset) >= 0.0 { p } else { q };
            self.put(pair, n, State::Corner(i, j));
        } else {
            self.put(pair, p, State::Corner(i, j));
            self.put(pair, q, State::Corner(i, j));
        }
    }
}

/// Which of the heights around a circle are higher than their neighbours; of equal ones the last.
fn peaks<const N: usize>(heights: &[f64; N]) -> impl Iterator<Item = usize> + '_ {
    (0..N).filter(|&k| {
        let (before, after) = (heights[(k + N - 1) % N], heights[(k + 1) % N]);
        heights[k] >= before && heights[k] > after
    })
}

/// The direction in which cores of these summed extents are thinnest: needles and plates part that way.
///
/// The eigenvector of the matrix's smallest eigenvalue, by three steps of inverse iteration.
fn thinnest(sum: &Symmetric) -> Option<DVec3> {
    let shift = 1e-9 * sum.trace();
    let mut n = DVec3::new(0.48, 0.6, 0.64);
    for _ in 0..3 {
        n = sum.solve_direction(shift, n).try_normalize()?;
    }
    Some(n)
}

/// Outward axes of the flat ends, where there are any.
fn ends<C: Core>(core: &C) -> [Option<DVec3>; 2] {
    let end = |sides| {
        let disc = core.disc(sides);
        (C::DISCS && disc.radius > 0.0).then_some(disc.axis)
    };
    [end(0), end(1)]
}
