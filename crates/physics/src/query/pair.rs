//! Two cores in one frame: support points, the gap along a normal, and where flat sides line up.

use glam::DVec3;

use super::cores::{Circle, Core, Tip};

/// Circles are numbered through both cores: a's from 0, b's from here on.
pub(super) const OF_B: usize = 3;

/// Axes that differ by less than this [rad] are parallel.
const PARALLEL: f64 = 1e-10;

/// Most projections of faces on each other in turn; one or two do unless the faces barely meet.
const PROJECTIONS: u32 = 100;

/// Core a, and core b mirrored at its centre, whose centre lies at `offset` from a's.
pub(super) struct Pair<A, B> {
    pub a: A,
    pub b: B,
    pub offset: DVec3,
    /// Length that tolerances are measured against [m].
    pub size: f64,
}

/// The support points of both cores along one normal.
#[derive(Clone, Copy)]
pub(super) struct Tips {
    pub a: Tip,
    pub b: Tip,
}

impl Tips {
    /// On which side of each circle the support points lie.
    #[inline(always)]
    pub fn sides(&self) -> u8 {
        self.a.sides | self.b.sides << OF_B
    }
}

impl<A: Core, B: Core> Pair<A, B> {
    #[inline(always)]
    pub fn new(a: A, b: B, offset: DVec3) -> Pair<A, B> {
        let size = a.size() + b.size();
        Pair { a, b, offset, size }
    }

    /// The circle with this number.
    #[inline(always)]
    pub fn circle(&self, index: usize) -> Circle {
        if index < OF_B {
            self.a.circle(index)
        } else {
            self.b.circle(index - OF_B)
        }
    }

    /// The support points along n.
    #[inline(always)]
    pub fn tips(&self, n: DVec3) -> Tips {
        self.tips_held(n, 0, 0)
    }

    /// The support points along n on the given `sides` of all circles, whether or not n lies there.
    #[inline(always)]
    pub fn tips_on(&self, n: DVec3, sides: u8) -> Tips {
        self.tips_held(n, !0, sides)
    }

    /// The support points along n, on the given `sides` of those circles that the search is `held` to.
    #[inline(always)]
    pub fn tips_held(&self, n: DVec3, held: u8, sides: u8) -> Tips {
        let of_a = (1 << OF_B) - 1;
        Tips {
            a: self.a.tip_held(n, held & of_a, sides & of_a),
            b: self.b.tip_held(n, held >> OF_B, sides >> OF_B),
        }
    }

    /// The circles that coincide with the circle `index`, as bits: of parallel edges all jumps happen at once.
    #[inline(always)]
    pub fn twins(&self, index: usize) -> u8 {
        let circle = self.circle(index);
        let others = if index < OF_B {
            OF_B..OF_B + B::CIRCLES
        } else {
            0..A::CIRCLES
        };
        others.fold(0, |bits, other| {
            let twin = self.circle(other);
            let cosine = circle.axis.dot(twin.axis);
            let parallel = circle.axis.cross(twin.axis).length_squared() < PARALLEL * PARALLEL;
            let level = (circle.height - twin.height * cosine).abs() < PARALLEL;
            bits | u8::from(parallel && level) << other
        })
    }

    /// `D`, from a's support point to b's.
    #[inline(always)]
    pub fn between(&self, tips: &Tips) -> DVec3 {
        self.offset - tips.a.point - tips.b.point
    }

    /// `s(n)`, the gap between the tangent planes.
    #[inline(always)]
    pub fn gap(&self, n: DVec3) -> f64 {
        n.dot(self.between(&self.tips(n)))
    }

    /// `s(n)` to half of the digits: good enough to choose where to search.
    #[inline(always)]
    pub fn rough_gap(&self, n: DVec3) -> f64 {
        n.dot(self.offset) - self.a.reach(n) - self.b.reach(n)
    }

    /// Whether there is a circle with this number.
    #[inline(always)]
    pub fn has_circle(index: usize) -> bool {
        if index < OF_B {
            index < A::CIRCLES
        } else {
            index - OF_B < B::CIRCLES
        }
    }

    /// Points of both cores, farthest along n, that come closest to lying on one line along n.
    ///
    /// Where the cores are flat under n these are two convex sets; projecting in turn on either one closes in on a
    /// pair of nearest points.
    #[cold]
    #[inline(never)]
    pub fn line_up(&self, n: DVec3) -> (DVec3, DVec3) {
        let mut point_a = self.a.face_point(n, self.offset);
        let mut point_b = self.b.face_point(n, self.offset - point_a);
        let mut last = f64::INFINITY;
        for _ in 0..PROJECTIONS {
            point_a = self.a.face_point(n, self.offset - point_b);
            point_b = self.b.face_point(n, self.offset - point_a);
            let d = self.offset - point_a - point_b;
            let aside = (d - n * n.dot(d)).length();
            if aside > 0.9999 * last || aside < 1e-15 * self.size {
                break;
            }
            last = aside;
        }
        (point_a, point_b)
    }
}
