//! Where searches begin, and how many: one where s is concave, several where overlapping cores have several maxima.

use glam::DVec3;

use super::cores::{Circle, Core};
use super::pair::{OF_B, Pair};
use super::path::crossings;
use super::search::{Goal, SAME, Search, State, Summit};

/// Room for all candidates of two boxes and of two frusta.
const ROOM: usize = 40;
/// Most candidates that are searched from.
const POLISHED: usize = 6;
/// Candidates farther below the best summit than this are not searched from, in units of the pair's size.
const MARGIN: f64 = 0.15;

/// A candidate farther below the best summit than this is looked at before it is searched from, in the same units.
const FAR_BELOW: f64 = 0.08;

/// The highest summit found.
pub(super) struct Found {
    pub summit: Summit,
    /// Whether the iterations ended before the search did.
    pub capped: bool,
    /// Whether an overlap was searched from a known start alone.
    pub local: bool,
}

const DIAGONAL: f64 = std::f64::consts::FRAC_1_SQRT_2;
/// Cosine of the angle from the start within which a maximum of s is taken for the one that was meant: 0.1 rad.
const STAYED: f64 = 0.995;
/// Overlap so shallow that any maximum of s will do, in units of the pair's size.
const SHALLOW: f64 = 1e-3;

/// Searches from a known normal, and as without one if that leads nowhere.
#[inline]
pub(super) fn from_known<A: Core, B: Core>(pair: &Pair<A, B>, start: DVec3, goal: Goal) -> Found {
    let summit = Search::run(pair, start, State::Free, goal);
    let stayed = summit.s > -SHALLOW * pair.size || summit.n.dot(start) > STAYED;
    if (summit.converged && stayed) || summit.iterations >= goal.cap {
        let capped = !summit.converged || !stayed;
        let local = summit.s <= 0.0;
        return Found {
            summit,
            capped,
            local,
        };
    }
    let cap = goal.cap - summit.iterations;
    let mut found = from_nothing(pair, Goal { cap, ..goal });
    found.summit.iterations += summit.iterations;
    if summit.s > found.summit.s {
        let iterations = found.summit.iterations;
        found.summit = Summit {
            iterations,
            ..summit
        };
        found.capped |= !summit.converged;
    }
    found
}

/// Searches without a known normal: from the line of centres, weighed with the cores' extents, and if they overlap
/// from the normals at which the other maxima of s lie.
#[inline]
pub(super) fn from_nothing<A: Core, B: Core>(pair: &Pair<A, B>, goal: Goal) -> Found {
    let first = Search::run(pair, first_normal(pair), State::Free, goal);
    if first.s > 0.0 && first.converged {
        // s is concave where it is positive: there is no other maximum.
        return Found {
            summit: first,
            capped: false,
            local: false,
        };
    }
    let mut candidates = Candidates::new();
    if first.s > -SHALLOW * pair.size {
        candidates.collect_ridges(pair, &first);
    }
    candidates.collect(pair);
    candidates.climb(pair, first, goal)
}

/// `(M_a + M_b)^-1 d` for the matrices of the cores' extents: exact for two ellipsoids of one shape.
#[inline(always)]
fn first_normal<A: Core, B: Core>(pair: &Pair<A, B>) -> DVec3 {
    let sum = pair.a.extents().plus(&pair.b.extents());
    let n = sum.solve_direction(0.02 * sum.trace(), pair.offset);
    let length = n.length_squared();
    if length > 1e-300 && length.is_finite() {
        n * (1.0 / length.sqrt())
    } else {
        DVec3::Y
    }
}

/// The direction in which both cores together are thinnest: needles and plates part that way.
///
/// The eigenvector of the smallest eigenvalue of the summed matrices, by three steps of inverse iteration.
fn thinnest<A: Core, B: Core>(pair: &Pair<A, B>) -> Option<DVec3> {
    let sum = pair.a.extents().plus(&pair.b.extents());
    let shift = 1e-9 * sum.trace();
    let mut n = DVec3::new(0.48, 0.6, 0.64);
    for _ in 0..3 {
        n = sum.solve_direction(shift, n).try_normalize()?;
    }
    Some(n)
}

/// Normals to search from, each in its own state.
struct Candidates {
    list: [(f64, DVec3, State); ROOM],
    count: usize,
    /// Whether both cores are their own images in their centres.
    symmetric: bool,
}

impl Candidates {
    fn new() -> Candidates {
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
    fn collect<A: Core, B: Core>(&mut self, pair: &Pair<A, B>) {
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
            && let Some(n) = thinnest(pair)
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
    fn collect_ridges<A: Core, B: Core>(&mut self, pair: &Pair<A, B>, summit: &Summit) {
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
        for (k, n) in around.into_iter().enumerate() {
            let (before, after) = (heights[(k + 7) % 8], heights[(k + 1) % 8]);
            if heights[k] >= before && heights[k] > after {
                self.put(pair, n, state);
            }
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

    /// Climbs from the most promising candidates with what is left of the budget.
    fn climb<A: Core, B: Core>(&mut self, pair: &Pair<A, B>, first: Summit, goal: Goal) -> Found {
        let list = &mut self.list[..self.count];
        let margin = (MARGIN * pair.size).min(2.0 * first.s.abs() + 0.01 * pair.size);
        let mut best = first;
        let mut used = first.iterations;
        let mut capped = !first.converged;
        for _ in 0..POLISHED {
            let Some(next) = next_best(list, best.s - margin) else {
                break;
            };
            let (s, n, state) = std::mem::replace(next, (f64::NEG_INFINITY, DVec3::Y, State::Free));
            if n.dot(best.n) > SAME || (best.converged && is_below(pair, n, s, &best)) {
                continue;
            }
            if used >= goal.cap {
                capped = true;
                break;
            }
            let known = best.converged.then_some((best.n, best.s));
            let cap = goal.cap - used;
            let other = Search::run(pair, n, state, Goal { cap, known, ..goal });
            used += other.iterations;
            capped |= !other.converged;
            if other.s > best.s || (other.s > 0.0 && other.converged) {
                best = other;
            }
            if best.s > 0.0 && best.converged {
                capped = false;
                break;
            }
        }
        best.iterations = used;
        Found {
            summit: best,
            capped,
            local: false,
        }
    }
}

/// Whether a candidate lies far below the summit, on a slope that rises all the way to it.
#[inline(always)]
fn is_below<A: Core, B: Core>(pair: &Pair<A, B>, n: DVec3, s: f64, summit: &Summit) -> bool {
    let below = summit.s - s;
    if below < FAR_BELOW * pair.size {
        return false;
    }
    let at = |x: f64| {
        let n = n * (1.0 - x) + summit.n * x;
        pair.rough_gap(n * (1.0 / n.length()))
    };
    let (first, half) = (at(0.1), at(0.5));
    first > s + 0.03 * below && half > first
}

/// The candidate with the largest s above `floor`.
fn next_best(list: &mut [(f64, DVec3, State)], floor: f64) -> Option<&mut (f64, DVec3, State)> {
    let mut best = None;
    let mut largest = floor;
    for candidate in list {
        if candidate.0 > largest {
            largest = candidate.0;
            best = Some(candidate);
        }
    }
    best
}

/// Outward axes of the flat ends, where there are any.
fn ends<C: Core>(core: &C) -> [Option<DVec3>; 2] {
    let end = |sides| {
        let disc = core.disc(sides);
        (C::DISCS && disc.radius > 0.0).then_some(disc.axis)
    };
    [end(0), end(1)]
}
