//! Brings a pair of placed shapes before the search that suits it, and its answer into the world again.

use glam::{DMat3, DVec3};

use super::cores::{Core, CuboidCore, EllipsoidCore, PointCore, RevolutionCore, TruncatedCore};
use super::pair::Pair;
use super::search::Goal;
use super::starts::{self, Found};
use super::{Limits, Placed, Separation, bounds, boxes, flats, gap_along, simplex};
use crate::shape::Kind;

/// A shape this many times as long as it is thick, or as wide, is thin.
const THIN: f64 = 100.0;
/// A converged answer's interval is no wider than this when apart, in units of the pair's size.
const WIDEST: f64 = 5e-8;
/// An overlap deeper than this that nothing proves is doubted, in units of the pair's size.
const DOUBTFUL: f64 = 1e-6;

/// Order of the families: a pair is searched with the lower one first, so that each has one search.
fn family(kind: &Kind) -> u8 {
    match kind {
        Kind::Sphere { .. } => 0,
        Kind::Capsule { .. } | Kind::Frustum(_) => 1,
        Kind::Ellipsoid { .. } => 2,
        Kind::TruncatedEllipsoid { .. } => 3,
        Kind::Cuboid { .. } => 4,
        Kind::Cloud(_) | Kind::HalfSpace { .. } => 5,
    }
}

/// What a core leaves out: the radius about it [m].
fn rounding(kind: &Kind) -> f64 {
    match kind {
        Kind::Sphere { radius } | Kind::Capsule { radius, .. } => *radius,
        _ => 0.0,
    }
}

/// Whether a shape is so thin that its ways out of others are many and hard to find. The square that the search sees an
/// ellipsoid by then loses more of its short axis than a gap may.
fn is_thin(kind: &Kind) -> bool {
    let (short, long) = match kind {
        Kind::Capsule { radius, segment } => (*radius, segment.half_height()),
        Kind::Frustum(profile) => {
            let (wide, high) = (
                profile.radius[0].max(profile.radius[1]),
                profile.half_height(),
            );
            (wide.min(high), wide.max(high))
        }
        Kind::Ellipsoid { semi } | Kind::TruncatedEllipsoid { semi, .. } => {
            (semi.min_element(), semi.max_element())
        }
        Kind::Cuboid { half } => (half.min_element(), half.max_element()),
        Kind::Sphere { .. } | Kind::HalfSpace { .. } | Kind::Cloud(_) => return false,
    };
    long >= THIN * short
}

/// Searches the signed gap of a pair without a closed form.
#[inline(never)]
pub(super) fn search(a: &Placed, b: &Placed, start: Option<DVec3>, limits: Limits) -> Separation {
    let (first, second) = (family(&a.shape.kind), family(&b.shape.kind));
    if first > second {
        return search(b, a, start.map(|n| -n), limits).swapped();
    }
    let mut task = Task {
        a,
        b,
        start,
        limits,
    };
    if let (Kind::Cuboid { half }, Kind::Cuboid { half: other }) = (&a.shape.kind, &b.shape.kind) {
        match boxes::separation((a, *half), (b, *other), limits.enough) {
            Ok(answer) => return answer,
            Err(n) => task.start = Some(n),
        }
    }
    if let Kind::Cuboid { half } = &b.shape.kind
        && first < second
        && let Some(answer) = flats::over_face(a, b, *half, start)
    {
        return answer;
    }
    match &a.shape.kind {
        Kind::Sphere { .. } => task.with_b(PointCore),
        Kind::Capsule {
            segment: profile, ..
        }
        | Kind::Frustum(profile) => {
            let axis = a.rotation.y_axis;
            task.with_b(RevolutionCore { axis, profile })
        }
        Kind::Ellipsoid { semi } => task.with_b(EllipsoidCore::new(&a.rotation, *semi)),
        Kind::TruncatedEllipsoid { semi, cut, rim } => {
            task.with_b(TruncatedCore::new(&a.rotation, *semi, *cut, *rim))
        }
        Kind::Cuboid { half } => task.with_b(CuboidCore::new(&a.rotation, *half)),
        Kind::HalfSpace { .. } | Kind::Cloud(_) => simplex::separation(a, b, start, limits),
    }
}

struct Task<'t> {
    a: &'t Placed<'t>,
    b: &'t Placed<'t>,
    start: Option<DVec3>,
    limits: Limits,
}

impl Task<'_> {
    fn with_b<A: Core>(&self, a: A) -> Separation {
        let r = &self.b.rotation;
        let mirrored = DMat3::from_cols(-r.x_axis, -r.y_axis, -r.z_axis);
        match &self.b.shape.kind {
            Kind::Sphere { .. } => self.solve(a, PointCore),
            Kind::Capsule {
                segment: profile, ..
            }
            | Kind::Frustum(profile) => {
                let axis = mirrored.y_axis;
                self.solve(a, RevolutionCore { axis, profile })
            }
            Kind::Ellipsoid { semi } => self.solve(a, EllipsoidCore::new(&mirrored, *semi)),
            Kind::TruncatedEllipsoid { semi, cut, rim } => {
                self.solve(a, TruncatedCore::new(&mirrored, *semi, *cut, *rim))
            }
            Kind::Cuboid { half } => self.solve(a, CuboidCore::new(&mirrored, *half)),
            Kind::HalfSpace { .. } | Kind::Cloud(_) => {
                simplex::separation(self.a, self.b, self.start, self.limits)
            }
        }
    }

    fn solve<A: Core, B: Core>(&self, a: A, b: B) -> Separation {
        let pair = Pair::new(a, b, self.b.position - self.a.position);
        let radii = (rounding(&self.a.shape.kind), rounding(&self.b.shape.kind));
        let goal = Goal {
            cap: self.limits.iteration_cap,
            tolerance: self.limits.tolerance.max(1e-13 * pair.size),
            enough: self.limits.enough + radii.0 + radii.1,
            known: None,
        };
        let thin = is_thin(&self.a.shape.kind) || is_thin(&self.b.shape.kind);
        let found = match self.start {
            Some(start) => starts::from_known(&pair, start, goal, thin),
            None => starts::from_nothing(&pair, goal, thin, false),
        };
        let answer = self.answer(&pair, &found, radii, thin);
        // Without a start all that is promising about thin shapes has been looked at, and most has no ball in it.
        let doubtful = answer.gap < -DOUBTFUL * pair.size && answer.upper.is_none();
        if doubtful && (found.local || !thin) && answer.iterations < goal.cap {
            let found = starts::in_doubt(&pair, found, goal, thin);
            return self.answer(&pair, &found, radii, thin);
        }
        answer
    }

    #[inline(always)]
    fn answer<A, B>(
        &self,
        pair: &Pair<A, B>,
        found: &Found,
        radii: (f64, f64),
        thin: bool,
    ) -> Separation {
        let summit = &found.summit;
        let (n, (core_a, core_b)) = (summit.n, summit.points);
        let point_a = self.a.position + core_a + n * radii.0;
        let point_b = self.b.position - core_b - n * radii.1;
        let mut gap = summit.s - radii.0 - radii.1;
        if thin {
            gap = gap_along(self.a, self.b, n);
        }
        let upper = if summit.s > 0.0 {
            let distance = (pair.offset - core_a - core_b).length();
            Some((distance - radii.0 - radii.1).max(gap))
        } else {
            bounds::overlap(self.a, self.b, point_a, point_b).map(|up| up.max(gap))
        };
        // Of needles and plates rounding may leave more than the search saw.
        let width = upper.map_or(0.0, |upper| upper - gap);
        let narrow = (WIDEST * pair.size).max(2.0 * self.limits.tolerance);
        let wide = gap > 0.0 && gap <= self.limits.enough && width > narrow;
        Separation {
            gap,
            upper,
            normal: n,
            point_a,
            point_b,
            iterations: summit.iterations,
            capped: found.capped || wide,
            local: found.local,
        }
    }
}
