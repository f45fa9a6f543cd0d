//! The search for the largest s(n): Newton's method on the sphere of normals that knows where s has kinks.
//!
//! It is in one of three states. *Free*: s is smooth around n, the step solves `(C_a + C_b + s) t = D - s n` (the
//! second-order reading of the paper's unpublished estimate). *On a circle*: n runs along one kink, the closest point
//! lies somewhere on an edge, a mantle line or between two faces' rims. *On a corner*: two kinks cross in n.
//! A way that meets a kink goes on through it while s rises behind it and stays on it where s would fall; a kink
//! is left when the closest points do not line up on its jump. s never falls from one accepted normal to the next.

mod free;
mod kink;
mod walk;

use glam::DVec3;

use super::cores::Core;
use super::pair::{OF_B, Pair, Tips};

/// Offset across n that leaves the interval of an answer narrow enough, in units of the pair's size.
const NARROW: f64 = 5e-10;
/// Closest points are lined up when this far apart across n, in units of the pair's size.
const LINED_UP: f64 = 1e-11;
/// Cosine of the angle to a known summit within which one look half way decides whether this is its slope: 0.2 rad.
const CLOSE: f64 = 0.98;
/// Cosine of the angle within which there is no other summit: 0.045 rad.
pub(super) const SAME: f64 = 0.999;
/// Closest points that lie this far apart across n are where they would be, in units of the pair's size.
const ALIGNED: f64 = 2e-7;
/// What a last step leaves of the offset across n at most.
const FELL: f64 = 1e-2;
/// A search looks at the discs' axes again after this many normals: most end before.
const SLOW: u32 = 6;
/// Angle by which the normal of an answer may be off [rad].
const SURE: f64 = 3e-5;
/// A gain below this is rounding, in units of the pair's size.
const ROUNDING: f64 = 1e-14;

/// What holds the normal at present.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum State {
    Free,
    /// On the circle with this number.
    Circle(usize),
    /// Where these two circles cross.
    Corner(usize, usize),
    /// On the axis of the disc that ends a (false) or b (true), to be left if it is not the answer.
    Disc(bool),
}

impl State {
    /// Bits of the circles that hold the normal.
    fn held(self) -> u8 {
        match self {
            State::Circle(i) => 1 << i,
            State::Corner(i, j) => 1 << i | 1 << j,
            State::Free | State::Disc(_) => 0,
        }
    }
}

/// When the search may stop, in metres.
#[derive(Clone, Copy)]
pub(super) struct Goal {
    pub cap: u32,
    pub tolerance: f64,
    pub enough: f64,
    /// A summit that need not be found again: its normal and s there.
    pub known: Option<(DVec3, f64)>,
}

/// Where a search ended.
#[derive(Clone, Copy)]
pub(super) struct Summit {
    pub n: DVec3,
    pub s: f64,
    /// Points of the cores whose connection is closest to n, from their centres (b mirrored) [m].
    pub points: (DVec3, DVec3),
    pub iterations: u32,
    /// Whether the closest points line up.
    pub converged: bool,
}

pub(super) struct Search<'p, A, B> {
    pair: &'p Pair<A, B>,
    goal: Goal,
    n: DVec3,
    tips: Tips,
    s: f64,
    state: State,
    /// Circles whose sides the search holds to, as bits: its own and those that coincide with them.
    held: u8,
    /// Kink that was left just now, and the direction away from it.
    left: Option<(usize, DVec3)>,
    /// How much worse than the slope along it a kink must be to be left before the search along it has ended.
    patience: f64,
    iterations: u32,
    idle: u32,
    last: f64,
}

/// How a search ended.
#[derive(Clone, Copy, PartialEq)]
enum Ending {
    /// The closest points line up as its state says.
    LinedUp,
    /// They do within the faces under n, although no step gained anything any more.
    OnFaces,
    /// The gap is as large as was asked for.
    Enough,
    /// The iterations or the gains ended first.
    Unfinished,
}

impl<'p, A: Core, B: Core> Search<'p, A, B> {
    #[inline(always)]
    pub fn run(pair: &'p Pair<A, B>, start: DVec3, state: State, goal: Goal) -> Summit {
        let mut search = Search::new(pair, start, state, goal);
        let ending = search.climb();
        search.summit(ending)
    }

    #[inline(always)]
    fn new(pair: &'p Pair<A, B>, n: DVec3, state: State, goal: Goal) -> Self {
        let natural = pair.tips(n);
        let below = pair.tips_held(n, state.held(), 0);
        let (s, proven) = (n.dot(pair.between(&below)), n.dot(pair.between(&natural)));
        // Circles that almost touch cross in no exact normal.
        let exact = s - proven <= 10.0 * ROUNDING * pair.size;
        let (state, tips, s) = if exact {
            (state, below, s)
        } else {
            (State::Free, natural, proven)
        };
        let patience = if matches!(state, State::Circle(_)) {
            8.0
        } else {
            0.3
        };
        Search {
            pair,
            goal,
            n,
            tips,
            s,
            state,
            held: held(pair, state),
            left: None,
            patience,
            iterations: 0,
            idle: 0,
            last: f64::NEG_INFINITY,
        }
    }

    /// Climbs until the closest points line up or no more can be done.
    #[inline(always)]
    fn climb(&mut self) -> Ending {
        loop {
            if self.s > self.goal.enough {
                return Ending::Enough;
            }
            if self.iterations >= self.goal.cap || self.is_idle() {
                return if self.lines_up() {
                    Ending::OnFaces
                } else {
                    Ending::Unfinished
                };
            }
            self.iterations += 1;
            if self.iterations.is_multiple_of(SLOW) && self.visit_discs() {
                return Ending::LinedUp;
            }
            let before = self.n;
            let over = match self.state {
                State::Free => self.step_free(),
                State::Disc(of_b) => {
                    self.state = State::Free;
                    self.visit_disc(of_b, true)
                        .unwrap_or_else(|(step, rise)| self.travel(step, rise, None))
                }
                State::Circle(index) => self.step_along(index),
                State::Corner(i, j) => self.step_corner(i, j),
            };
            if over || (self.n != before && self.is_on_known_slope()) {
                return Ending::LinedUp;
            }
        }
    }

    /// Looks at the axes of the discs that the support points lie on, towards which steps along a kink crawl.
    #[cold]
    #[inline(never)]
    fn visit_discs(&mut self) -> bool {
        for (of_b, has) in [(false, A::DISCS), (true, B::DISCS)] {
            let disc = self.disc(of_b);
            if !has || disc.radius == 0.0 || disc.axis.dot(self.n) < 0.9 {
                continue;
            }
            match self.visit_disc(of_b, false) {
                Ok(true) => return true,
                Ok(false) => {}
                Err((step, rise)) => {
                    (self.state, self.held) = (State::Free, 0);
                    self.travel(step, rise, None);
                    return false;
                }
            }
        }
        false
    }

    /// Whether the way up from here leads to the summit that is known: it is close, and the way there rises.
    #[inline(always)]
    fn is_on_known_slope(&self) -> bool {
        let Some((n, s)) = self.goal.known else {
            return false;
        };
        let cosine = n.dot(self.n);
        if self.s > s || cosine < CLOSE {
            return false;
        }
        // The two unit normals' sum is this long.
        let half_way = (self.n + n) * (1.0 / (2.0 + 2.0 * cosine).sqrt());
        cosine > SAME || self.pair.rough_gap(half_way) > self.s
    }

    /// Whether the search has stopped gaining although its conditions do not hold: rounding has the last word.
    #[inline(always)]
    fn is_idle(&mut self) -> bool {
        if self.iterations > 3 {
            let gained = self.s > self.last + ROUNDING * self.pair.size;
            self.idle = if gained { 0 } else { self.idle + 1 };
            self.last = self.s;
        }
        self.idle >= 3
    }

    #[cold]
    #[inline(never)]
    fn lines_up(&self) -> bool {
        let (a, b) = self.pair.line_up(self.n);
        let d = self.pair.offset - a - b;
        (d - self.n * self.n.dot(d)).length() < 1e-9 * self.pair.size
    }

    /// Whether an offset across n of this squared length leaves |D| - s narrow and the closest points where they are.
    #[inline(always)]
    fn is_narrow(&self, across_squared: f64) -> bool {
        let narrow = self.goal.tolerance.max(NARROW * self.pair.size);
        let aligned = self.goal.tolerance.max(ALIGNED * self.pair.size);
        across_squared <= aligned * aligned
            && (self.s <= 0.0 || across_squared <= narrow * (narrow + 2.0 * self.s))
    }

    /// Whether a full Newton step that brought the squared offset across n from `before` to `after` was the last.
    ///
    /// What is left is the square of the step, if the offset fell as it does where that holds; where s hardly bends
    /// (by `bend` at least [m]) a small offset may still be a large angle.
    #[inline(always)]
    fn was_last(&self, step_squared: f64, before: f64, after: f64, bend: f64) -> bool {
        let left = step_squared * step_squared * self.pair.size;
        left <= 4.0 * self.goal.tolerance
            && after <= FELL * FELL * before
            && after <= SURE * SURE * bend * bend
            && self.is_narrow(after)
    }

    /// Puts the search on a kink, where these are the support points below it.
    #[inline(always)]
    fn hold(&mut self, state: State, n: DVec3, below: Tips) {
        self.tips = below;
        self.n = n;
        self.s = n.dot(self.pair.between(&below));
        self.state = state;
        self.held = held(self.pair, state);
    }

    /// Moves to a normal unless s is lower there.
    #[inline(always)]
    fn accept(&mut self, n: DVec3, tips: Tips) {
        let s = n.dot(self.pair.between(&tips));
        if s >= self.s - 10.0 * ROUNDING * self.pair.size {
            (self.n, self.tips, self.s) = (n, tips, s);
        }
    }

    /// The answer where the search stands.
    #[inline(always)]
    fn summit(self, ending: Ending) -> Summit {
        // Where kinks cross the search holds to one side of each; what is proven is s itself.
        let one = matches!(self.state, State::Circle(_)) && self.held.count_ones() == 1;
        let natural = (self.held == 0 || one) && ending != Ending::Unfinished;
        let s = if natural {
            self.s
        } else {
            self.s.min(self.pair.gap(self.n))
        };
        // Where several jumps coincide their shares are not told apart by one.
        let twins = self.held != self.state.held();
        let faces = ending == Ending::OnFaces || twins || matches!(self.state, State::Disc(_));
        Summit {
            n: self.n,
            s,
            points: if faces {
                self.pair.line_up(self.n)
            } else {
                self.points()
            },
            iterations: self.iterations,
            converged: ending != Ending::Unfinished,
        }
    }

    /// The support points, on kinks the points of their jumps that line up best.
    #[inline(always)]
    fn points(&self) -> (DVec3, DVec3) {
        let (mut a, mut b) = (self.tips.a.point, self.tips.b.point);
        let mut add = |index: usize, share: f64| {
            let moved = self.jump(index) * share.clamp(0.0, 1.0);
            if index < OF_B {
                a += moved;
            } else {
                b += moved;
            }
        };
        let d = self.pair.between(&self.tips);
        match self.state {
            State::Free | State::Disc(_) => {}
            State::Circle(i) => {
                let jump = self.jump(i);
                add(i, jump.dot(d) / jump.length_squared());
            }
            State::Corner(i, j) => {
                let (share_i, share_j) = self.shares(i, j, d);
                add(i, share_i);
                add(j, share_j);
            }
        }
        (a, b)
    }
}

/// The circles whose sides a search in this state holds to.
#[inline(always)]
fn held<A: Core, B: Core>(pair: &Pair<A, B>, state: State) -> u8 {
    match state {
        State::Free | State::Disc(_) => 0,
        State::Circle(i) => state.held() | pair.twins(i),
        State::Corner(i, j) => state.held() | pair.twins(i) | pair.twins(j),
    }
}
