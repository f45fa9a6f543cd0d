//! The search for the largest s(n): Newton's method on the sphere of normals that knows where s has kinks.
//!
//! It is in one of three states. *Free*: s is smooth around n, the step solves `(C_a + C_b + s) t = D - s n` (the
//! second-order reading of the paper's unpublished estimate). *On a circle*: n runs along one kink, the closest point
//! lies somewhere on an edge, a mantle line or between two faces' rims. *On a corner*: two kinks cross in n.
//! A way that meets a kink goes on through it while s rises behind it and stays on it where s would fall; a kink
//! is left when the closest points do not line up on its jump. s never falls from one accepted normal to the next.

use glam::DVec3;

use super::cores::Core;
use super::pair::{OF_B, Pair, Tips, basis};
use super::path::{Along, Arc, Path};

/// Longest step on the tangent plane; on the sphere the way to its end is an arc of 63 degrees.
const LONGEST: f64 = 2.0;
/// Step along directions in which s is not concave [rad].
const STRIDE: f64 = 0.7;
/// Closest points are lined up when this far apart across n, in units of the pair's size.
const LINED_UP: f64 = 1e-11;
/// Offset across n that leaves the interval of an answer narrow enough, in units of the pair's size.
const NARROW: f64 = 1e-8;
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

/// How a way ended.
enum End {
    /// At an ordinary normal; `whole` if nothing stopped it short of where it was to go.
    Open {
        x: f64,
        n: DVec3,
        tips: Tips,
        whole: bool,
    },
    /// On a kink that it must not cross, coming from these sides of all others.
    Kink { index: usize, n: DVec3, sides: u8 },
}

/// What a look at the kinks on a way tells.
enum Look {
    Clear,
    /// s rises no farther than to here; `again` if the way to there has to be looked at again.
    Shorten {
        x: f64,
        again: bool,
    },
    Kink {
        index: usize,
        n: DVec3,
        sides: u8,
    },
}

/// What became of a free step.
enum Step {
    Done,
    /// Go along this vector; the second: whether it is a full Newton step.
    Go(DVec3, bool),
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
            let over = match self.state {
                State::Free => self.step_free(),
                State::Disc(of_b) => {
                    self.state = State::Free;
                    self.visit_disc(of_b, true)
                        .unwrap_or_else(|(step, rise)| self.travel(step, rise, false))
                }
                State::Circle(index) => self.step_along(index),
                State::Corner(i, j) => self.step_corner(i, j),
            };
            if over {
                return Ending::LinedUp;
            }
        }
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

    /// Whether an offset across n of this squared length leaves |D| - s narrow.
    #[inline(always)]
    fn is_narrow(&self, across_squared: f64) -> bool {
        let narrow = self.goal.tolerance.max(NARROW * self.pair.size);
        self.s <= 0.0 || across_squared <= narrow * narrow
    }

    #[inline(always)]
    fn step_free(&mut self) -> bool {
        let (step, newton) = match self.newton_step() {
            Step::Done => return true,
            Step::Go(step, newton) => (step, newton),
        };
        for of_b in [false, true] {
            if self.passes_disc(of_b, step) {
                match self.visit_disc(of_b, false) {
                    Ok(true) => return true,
                    Ok(false) => {}
                    Err((step, rise)) => return self.travel(step, rise, false),
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
        let (u, w) = basis(n);
        let g = (u.dot(d), w.dot(d));
        let across = g.0 * g.0 + g.1 * g.1;
        let level = across <= (LINED_UP * pair.size).powi(2);
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
            if gain <= self.goal.tolerance && self.is_narrow(across) {
                return Step::Done;
            }
            t
        } else {
            uphill(k, g, pair.size)
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
        Step::Go(step, newton)
    }

    /// Whether the step passes the axis of the disc that the support point lies on, where s has no derivative.
    #[inline(always)]
    fn passes_disc(&self, of_b: bool, step: DVec3) -> bool {
        if !(if of_b { B::DISCS } else { A::DISCS }) {
            return false;
        }
        let disc = if of_b {
            self.pair.b.disc(self.tips.b.sides)
        } else {
            self.pair.a.disc(self.tips.a.sides)
        };
        let (height, towards) = (self.n.dot(disc.axis), step.dot(disc.axis));
        disc.radius > 0.0 && height > 0.0 && towards * height >= 0.5 * (1.0 - height * height)
    }

    /// Looks at the axis of a disc: `Ok(true)` it is the answer, `Ok(false)` it is worse than here and nothing
    /// changed; `Err` the search now stands on it, and this is the step that leaves it, with the rise of s along it.
    #[inline(always)]
    fn visit_disc(&mut self, of_b: bool, at_once: bool) -> Result<bool, (DVec3, f64)> {
        let pair = self.pair;
        let disc = if of_b {
            pair.b.disc(self.tips.b.sides)
        } else {
            pair.a.disc(self.tips.a.sides)
        };
        let axis = disc.axis;
        let tips = pair.tips(axis);
        let other = if of_b { tips.a } else { tips.b };
        let d = pair.offset - disc.centre - other.point;
        let s = axis.dot(d);
        if !at_once && s < self.s - ROUNDING * pair.size {
            return Ok(false);
        }
        let own = |target: DVec3| {
            if of_b {
                pair.b.face_point(axis, target)
            } else {
                pair.a.face_point(axis, target)
            }
        };
        let aside = |own: DVec3, other: DVec3| {
            let d = pair.offset - own - other;
            d - axis * axis.dot(d)
        };
        let mut offset = aside(own(pair.offset - other.point), other.point);
        if offset.length() > LINED_UP * pair.size {
            let (a, b) = pair.line_up(axis);
            let lined_up = aside(a, b);
            if lined_up.length_squared() < offset.length_squared() {
                offset = lined_up;
            }
        }
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

    /// Goes along `step` as far as s rises; `rise` is the slope of s at its start. True if that was the last step.
    #[inline(always)]
    fn travel(&mut self, step: DVec3, rise: f64, newton: bool) -> bool {
        let left = self.left.take().map(|(index, _)| index);
        let path = Arc {
            from: self.n,
            step,
            left,
        };
        match self.walk(&path, rise, 1.0) {
            End::Kink { index, n, sides } => {
                self.hold(State::Circle(index), n, sides);
                false
            }
            End::Open { x, n, tips, whole } => {
                let small = newton && whole && step.length_squared() * x * x < 1e-9;
                let last = small && tips.sides() == self.tips.sides();
                self.accept(n, tips);
                if !last {
                    return false;
                }
                let d = self.pair.between(&self.tips);
                self.is_narrow((d - self.n * self.s).length_squared())
            }
        }
    }

    /// Puts the search on a kink.
    #[inline(always)]
    fn hold(&mut self, state: State, n: DVec3, sides: u8) {
        self.tips = self.pair.tips_on(n, sides & !state.held());
        self.n = n;
        self.s = n.dot(self.pair.between(&self.tips));
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

    /// One step along the circle `index`, or off it.
    #[inline(always)]
    fn step_along(&mut self, index: usize) -> bool {
        let pair = self.pair;
        let circle = pair.circle(index);
        let (c, radius, jump) = (circle.height, circle.radius, circle.jump);
        // Without what rounding has put along the axis: a flat cone's small circle would magnify it at every step.
        let out = self.n - circle.axis * self.n.dot(circle.axis);
        let out = out * (1.0 / radius);
        let ahead = circle.axis.cross(out);
        let upward = circle.axis * radius - out * c;
        let d = pair.between(&self.tips);
        let (along, over) = (ahead.dot(d), upward.dot(d));
        let tolerance = LINED_UP * pair.size;
        let excess = if over < -tolerance {
            over
        } else if over - jump > tolerance {
            over - jump
        } else {
            0.0
        };
        let bend = self.s - (c / radius) * over
            + pair.a.curvature_along(self.n, &self.tips.a, ahead)
            + pair.b.curvature_along(self.n, &self.tips.b, ahead);
        let gain = if bend > 0.0 {
            0.5 * along * along / bend
        } else {
            f64::INFINITY
        };
        let level = along.abs() <= tolerance && (self.s > 0.0 || bend > -1e-9 * pair.size);
        let settled = level || (gain <= self.goal.tolerance && self.is_narrow(along * along));
        if excess == 0.0 && settled {
            return true;
        }
        if excess != 0.0 && (settled || excess.abs() > self.patience * along.abs()) {
            self.leave(index, excess > 0.0, upward);
            return false;
        }
        // Where s > 0 it is concave, however little it bends: nearly touching corners.
        let concave = bend > 0.0 && self.s > 0.0;
        let stride = if concave || bend > 1e-5 * pair.size {
            along / (bend * radius)
        } else {
            STRIDE.copysign(along)
        };
        let length = stride.abs().min(1.0);
        let path = Along {
            circle,
            out,
            ahead: ahead * 1.0_f64.copysign(stride),
        };
        match self.walk(&path, along.abs(), length) {
            End::Kink {
                index: other,
                n,
                sides,
            } => {
                self.hold(State::Corner(index, other), n, sides);
                false
            }
            End::Open { x, n, tips, whole } => {
                let small = bend > 0.0 && x * x < 1e-9 && whole && excess == 0.0;
                let last = small && tips.sides() == self.tips.sides();
                self.accept(n, tips);
                last && self.is_lined_up_on(index)
            }
        }
    }

    /// Whether the closest points line up somewhere on the jump of the circle `index`.
    #[inline(always)]
    fn is_lined_up_on(&self, index: usize) -> bool {
        let d = self.pair.between(&self.tips);
        let jump = self.jump(index);
        let share = (jump.dot(d) / jump.length_squared()).clamp(0.0, 1.0);
        let across = d - jump * share - self.n * self.s;
        self.is_narrow(across.length_squared())
    }

    /// The jump of the support point across the circle `index`, from below to above, at n.
    #[inline(always)]
    fn jump(&self, index: usize) -> DVec3 {
        let circle = &self.pair.circle(index);
        (circle.axis - self.n * circle.height) * (circle.jump / circle.radius)
    }

    /// Leaves the circle `index` to the given side.
    #[inline(always)]
    fn leave(&mut self, index: usize, above: bool, upward: DVec3) {
        if above {
            self.tips = self.pair.tips_on(self.n, self.tips.sides() | 1 << index);
        }
        self.left = Some((index, if above { upward } else { -upward }));
        self.state = State::Free;
        self.held = 0;
    }

    /// Where two kinks cross the closest points are a mixture of two jumps, with one closed form for each share.
    #[inline(always)]
    fn step_corner(&mut self, i: usize, j: usize) -> bool {
        let d = self.pair.between(&self.tips);
        let (share_i, share_j) = self.shares(i, j, d);
        let (jump_i, jump_j) = (self.pair.circle(i).jump, self.pair.circle(j).jump);
        let excess = |share: f64, jump: f64| (-share).max(share - 1.0) * jump;
        let (over_i, over_j) = (excess(share_i, jump_i), excess(share_j, jump_j));
        let tolerance = LINED_UP * self.pair.size;
        if over_i <= tolerance && over_j <= tolerance {
            return true;
        }
        let (leave, stay, share) = if over_i > over_j {
            (i, j, share_i)
        } else {
            (j, i, share_j)
        };
        if share > 1.0 {
            self.tips = self.pair.tips_on(self.n, self.tips.sides() | 1 << leave);
        }
        self.state = State::Circle(stay);
        self.held = held(self.pair, self.state);
        false
    }

    /// Shares of the jumps i and j with which d lines up with n.
    #[inline(always)]
    fn shares(&self, i: usize, j: usize, d: DVec3) -> (f64, f64) {
        let (across_i, across_j) = (
            self.n.cross(self.pair.circle(i).axis),
            self.n.cross(self.pair.circle(j).axis),
        );
        let (jump_i, jump_j) = (self.jump(i), self.jump(j));
        (
            d.dot(across_j) / jump_i.dot(across_j),
            d.dot(across_i) / jump_j.dot(across_i),
        )
    }

    /// Follows a way up to `end`; `rise` is the slope of s at its start.
    #[inline(always)]
    fn walk<P: Path>(&self, path: &P, rise: f64, end: f64) -> End {
        let (pair, held) = (self.pair, self.held);
        let sides = self.tips.sides();
        let mut x = end;
        let mut whole = true;
        let mut n = path.at(x);
        let mut tips = pair.tips_held(n, held, sides);
        for _ in 0..4 {
            if tips.sides() == sides {
                break;
            }
            match self.look(path, rise, x, sides ^ tips.sides()) {
                Look::Clear => break,
                Look::Kink { index, n, sides } => return End::Kink { index, n, sides },
                Look::Shorten { x: shorter, again } => {
                    x = shorter;
                    whole = false;
                    n = path.at(x);
                    tips = pair.tips_held(n, held, sides);
                    if !again {
                        break;
                    }
                }
            }
        }
        for _ in 0..12 {
            if n.dot(pair.between(&tips)) >= self.s - ROUNDING * pair.size {
                break;
            }
            x *= 0.35;
            whole = false;
            n = path.at(x);
            tips = pair.tips_held(n, held, sides);
        }
        End::Open { x, n, tips, whole }
    }

    /// Looks at the kinks (`crossed`, as bits) between the start of the way and `end`, in their order.
    #[inline(never)]
    fn look<P: Path>(&self, path: &P, rise: f64, end: f64, crossed: u8) -> Look {
        let (pair, held) = (self.pair, self.held);
        let mut list = [(0.0, 0usize, DVec3::ZERO); 2 * OF_B];
        let mut count = 0;
        for index in (0..2 * OF_B).filter(|i| crossed >> i & 1 == 1) {
            if let Some((x, n)) = path.meets(&pair.circle(index), index, end) {
                let mut at = count;
                while at > 0 && list[at - 1].0 > x {
                    list[at] = list[at - 1];
                    at -= 1;
                }
                list[at] = (x, index, n);
                count += 1;
            }
        }
        let list = &list[..count];
        let mut sides = self.tips.sides();
        let (mut from, mut slope) = (0.0, rise);
        for &(x, index, n) in list {
            let bit = 1u8 << index;
            if A::SMALL_CIRCLES || B::SMALL_CIRCLES {
                // A small circle may have been crossed twice in between: then the way there comes first.
                let ties = list.iter().filter(|k| (k.0 - x).abs() < 1e-12);
                let ties = ties.fold(bit, |bits, k| bits | 1 << k.1);
                let seen = pair.tips_held(n, held, sides).sides();
                if (seen ^ sides) & !ties != 0 && x < end {
                    return Look::Shorten { x, again: true };
                }
            }
            let tips = pair.tips_on(n, sides);
            let heading = path.heading(n);
            let before = heading.dot(pair.between(&tips));
            if before < 0.0 {
                // The top lies before the kink: as regula falsi finds it.
                if x <= from {
                    return Look::Clear;
                }
                let share = (slope / (slope - before)).clamp(0.05, 0.95);
                let x = from + (x - from) * share;
                return Look::Shorten { x, again: false };
            }
            sides ^= bit;
            let circle = &pair.circle(index);
            let after = before - circle.jump * circle.axis.dot(heading).abs() / circle.radius;
            if after <= 0.0 {
                return self.stop_at(index, n, sides);
            }
            (from, slope) = (x, after);
        }
        Look::Clear
    }

    /// The kink `index` ends the way, unless rounding puts it below where the way began.
    #[inline(always)]
    fn stop_at(&self, index: usize, n: DVec3, sides: u8) -> Look {
        let pair = self.pair;
        let on_one = self.held == 0;
        let n = if on_one {
            pair.circle(index).nearest(n).unwrap_or(n)
        } else {
            n
        };
        let s = n.dot(pair.between(&pair.tips_on(n, sides)));
        // Circles that almost touch cross in no exact normal: what is held there would not be what s is.
        let exact = s - pair.gap(n) <= 10.0 * ROUNDING * pair.size;
        if exact && s >= self.s - 10.0 * ROUNDING * pair.size {
            Look::Kink { index, n, sides }
        } else {
            Look::Clear
        }
    }

    /// The answer where the search stands.
    #[inline(always)]
    fn summit(self, ending: Ending) -> Summit {
        // On a kink the search holds to one side of it; what is proven is s itself.
        let natural = self.held == 0 && ending != Ending::Unfinished;
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

/// A step where s is not concave: Newton's along the direction of positive curvature, a stride along the other.
#[inline(never)]
fn uphill(k: [f64; 3], g: (f64, f64), size: f64) -> (f64, f64) {
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
        (
            (g_bent / largest).clamp(-STRIDE, STRIDE),
            STRIDE.copysign(g_other),
        )
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
