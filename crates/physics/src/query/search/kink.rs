//! On kinks: steps along a circle, corners of two, and the jumps that the closest points lie on.

use glam::DVec3;

use super::super::cores::Core;
use super::super::path::Along;
use super::free::{SMALL, STRIDE};
use super::walk::End;
use super::{LINED_UP, SURE, Search, State, held};

impl<A: Core, B: Core> Search<'_, A, B> {
    /// One step along the circle `index`, or off it.
    #[inline(always)]
    pub(super) fn step_along(&mut self, index: usize) -> bool {
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
        let excess = beyond(over, jump, tolerance);
        let bend = self.s - (c / radius) * over
            + pair.a.curvature_along(self.n, &self.tips.a, ahead)
            + pair.b.curvature_along(self.n, &self.tips.b, ahead);
        let gain = if bend > 0.0 {
            0.5 * along * along / bend
        } else {
            f64::INFINITY
        };
        let level = along.abs() <= tolerance && (self.s > 0.0 || bend > -1e-9 * pair.size);
        let sure = along.abs() <= SURE * bend * radius;
        let settled =
            level || (gain <= self.goal.tolerance && sure && self.is_narrow(along * along));
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
                below,
            } => {
                self.hold(State::Corner(index, other), n, below);
                false
            }
            End::Open { x, n, tips, whole } => {
                let small = bend > 0.0 && whole && excess == 0.0 && x * x < SMALL * SMALL;
                let same = small && tips.sides() == self.tips.sides();
                self.accept(n, tips);
                same && self.was_last(x * x, along * along, self.across_on(index), bend)
            }
        }
    }

    /// Squared offset across n of the closest points, somewhere on the jump of the circle `index`.
    #[inline(always)]
    fn across_on(&self, index: usize) -> f64 {
        let d = self.pair.between(&self.tips);
        let jump = self.jump(index);
        let share = (jump.dot(d) / jump.length_squared()).clamp(0.0, 1.0);
        (d - jump * share - self.n * self.s).length_squared()
    }

    /// The jump of the support point across the circle `index`, from below to above, at n.
    #[inline(always)]
    pub(super) fn jump(&self, index: usize) -> DVec3 {
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
    pub(super) fn step_corner(&mut self, i: usize, j: usize) -> bool {
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
    pub(super) fn shares(&self, i: usize, j: usize, d: DVec3) -> (f64, f64) {
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
}

/// How far `over` lies outside `0..=jump`, with its sign; zero within the tolerance.
#[inline(always)]
fn beyond(over: f64, jump: f64, tolerance: f64) -> f64 {
    if over < -tolerance {
        over
    } else if over - jump > tolerance {
        over - jump
    } else {
        0.0
    }
}
