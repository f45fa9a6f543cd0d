//! Where searches begin, and how many: one where s is concave, several where overlapping cores have several maxima.

use glam::DVec3;

use super::candidates::Candidates;
use super::cores::Core;
use super::pair::Pair;
use super::search::{Goal, SAME, Search, State, Summit};

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

/// Cosine of the angle from the start within which a maximum of s is taken for the one that was meant: 0.1 rad.
const STAYED: f64 = 0.995;
/// Overlap so shallow that any maximum of s will do, in units of the pair's size.
const SHALLOW: f64 = 1e-3;

/// Searches from a known normal, and as without one if that leads nowhere.
#[inline]
pub(super) fn from_known<A: Core, B: Core>(
    pair: &Pair<A, B>,
    start: DVec3,
    goal: Goal,
    thin: bool,
) -> Found {
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
    let mut found = from_nothing(pair, Goal { cap, ..goal }, thin, false);
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
/// from the normals at which the other maxima of s lie; `wide`: also from those far below what was found, for which an
/// overlap that is not proven is reason enough.
#[inline]
pub(super) fn from_nothing<A: Core, B: Core>(
    pair: &Pair<A, B>,
    goal: Goal,
    thin: bool,
    wide: bool,
) -> Found {
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
    if thin {
        candidates.collect_thin(pair);
    }
    candidates.climb(pair, first, goal, wide)
}

/// Searches everywhere for a way out of an overlap that nothing proves: it may be an old way out of shapes that have
/// passed each other, or the wrong one of shapes that all but touch.
#[cold]
#[inline(never)]
pub(super) fn in_doubt<A: Core, B: Core>(
    pair: &Pair<A, B>,
    found: Found,
    goal: Goal,
    thin: bool,
) -> Found {
    let used = found.summit.iterations;
    let cap = goal.cap - used;
    let mut other = from_nothing(pair, Goal { cap, ..goal }, thin, true);
    if found.summit.s > other.summit.s {
        other.summit = Summit {
            iterations: other.summit.iterations,
            ..found.summit
        };
    }
    other.summit.iterations += used;
    other
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

impl Candidates {
    /// Climbs from the most promising candidates with what is left of the budget.
    fn climb<A: Core, B: Core>(
        &mut self,
        pair: &Pair<A, B>,
        first: Summit,
        goal: Goal,
        wide: bool,
    ) -> Found {
        let list = &mut self.list[..self.count];
        let mut margin = MARGIN * pair.size;
        if !wide {
            margin = margin.min(2.0 * first.s.abs() + 0.01 * pair.size);
        }
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
