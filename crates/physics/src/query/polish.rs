//! A curved shape against a vertex cloud: a climb with a bundle of the cloud's corners, then what makes it certain.
//!
//! Where the climb does not end, the corners that carried its last step go to `search`, which is exact against a
//! corner, an edge or a face of the cloud; a corner that the answer's normal shows to be farther joins them. Apart,
//! the answer is the maximum of a concave function. Overlapping, a growing polytope (`expand`) shows where else to
//! search and how much could still be gained.

use glam::{DMat3, DVec3};

use super::cores::{Core, EllipsoidCore, PointCore, RevolutionCore, TruncatedCore};
use super::pair::Pair;
use super::search::{Goal, Search, State, Summit};
use super::simplex::{Best, corner, middle};
use super::{Limits, Placed, Separation, bounds, bundle, expand, flats, gap_along};
use crate::shape::{Kind, Profile};

/// What an overlap can still be shallower by when the search for other ways out ends, in units of the pair's size.
const CERTAIN: f64 = 2e-5;
/// Normals that the polytope tries at most to show where else to search.
const GROWN: u32 = 40;
/// Steps of the bundle before the exact search takes over; it needs five on average, twelve at times.
const CLIMB: u32 = 9;
/// The same for truncated ellipsoids, on whose seam, where the curvature jumps, the bundle may stall.
const CLIMB_OVER_SEAM: u32 = 6;
/// Steps of a search before it is asked whether a corner is missing.
const IMPATIENT: u32 = 3;
/// Width of the interval of a gap that counts as found, in units of the pair's size.
const NARROW: f64 = 1e-8;
/// A corner that is farther by less than this is rounding, in units of the pair's size.
const ROUNDING: f64 = 1e-13;

/// What is known of the pair.
#[derive(Clone, Copy)]
pub(super) struct Known {
    pub best: Best,
    pub points: (DVec3, DVec3),
    pub iterations: u32,
    /// Whether no normal close by is better.
    pub converged: bool,
}

/// Signed gap of the curved shape a and the cloud b.
pub(super) fn separation(
    a: &Placed,
    b: &Placed,
    start: Option<DVec3>,
    limits: Limits,
) -> Separation {
    let size = a.shape.size() + b.shape.size();
    let n = start.or_else(|| (middle(b) - a.position).try_normalize());
    let climb = match a.shape.kind {
        Kind::TruncatedEllipsoid { .. } => CLIMB_OVER_SEAM,
        _ => CLIMB,
    };
    let iteration_cap = limits.iteration_cap.min(climb);
    let within = Limits {
        iteration_cap,
        ..limits
    };
    let (first, carrying) = bundle::ascend(a, b, n.unwrap_or(DVec3::Y), within);
    let mut known = Known {
        best: Best {
            s: first.gap,
            n: first.normal,
        },
        points: (first.point_a, first.point_b),
        iterations: first.iterations,
        converged: !first.capped,
    };
    if known.best.s > 0.0 && known.best.s <= limits.enough {
        // Beside a flat end's axis s rises steeply on all sides, and a model of it may see its top where none is.
        known.converged &= first.point_a.distance(first.point_b) - known.best.s <= NARROW * size;
    }
    let shallow = CERTAIN * size;
    if !known.converged {
        visit_poles(a, b, &mut known, limits.iteration_cap);
    }
    if !known.converged && -known.best.s <= shallow {
        polish(a, b, &different(carrying), &mut known, limits);
    }
    if known.best.s > 0.0 || known.best.s > limits.enough {
        return apart(a, b, known, limits.enough);
    }
    // A shallow overlap leaves no room for a better way out, and an unfinished climb no budget to follow one.
    let spent = !known.converged && known.iterations >= limits.iteration_cap;
    if spent || -known.best.s <= shallow {
        let balls = bounds::overlap(a, b, known.points.0, known.points.1);
        return known.answer(balls.map(|up| up.max(known.best.s)));
    }
    let start = corner(a, b, known.best.n);
    let growth = expand::grow(a, b, &[start], known.best, 0, GROWN, shallow);
    if growth.best.s > known.best.s + 0.1 * shallow || !known.converged {
        known.best = growth.best;
        known.points = growth.contact(a, b);
        known.converged = false;
        let corners = growth.nearest_corners().into_iter().map(|c| c.b).collect();
        polish(a, b, &different(corners), &mut known, limits);
    }
    if known.best.s > 0.0 {
        return apart(a, b, known, limits.enough);
    }
    let room = growth.inner.map(|inner| -inner - known.best.s);
    known.converged &= room.is_some_and(|room| room <= 2.0 * shallow);
    let balls = bounds::overlap(a, b, known.points.0, known.points.1);
    let inner = growth.inner.map(|inner| -inner);
    let upper = balls.into_iter().chain(inner).reduce(f64::min);
    known.answer(upper.map(|up| up.max(known.best.s)))
}

/// Looks at the axes of the flat ends close by, towards which the climb crawls.
fn visit_poles(a: &Placed, b: &Placed, known: &mut Known, cap: u32) {
    for pole in [a.shape.pole(0), a.shape.pole(1)].into_iter().flatten() {
        let n = a.rotation.y_axis * pole;
        if n.dot(known.best.n) < 0.9 || known.iterations >= cap {
            continue;
        }
        known.iterations += 1;
        let s = gap_along(a, b, n);
        if s <= known.best.s {
            continue;
        }
        known.best = Best { s, n };
        if let Ok(lined_up) = flats::line_up(a, b, n, s) {
            known.points = (lined_up.point_a, lined_up.point_b);
            known.converged = true;
        }
    }
}

/// The answer for shapes that are apart.
fn apart(a: &Placed, b: &Placed, mut known: Known, enough: f64) -> Separation {
    let Best { s, n } = known.best;
    let narrow = NARROW * (a.shape.size() + b.shape.size());
    let mut upper = (known.points.1 - known.points.0).length().max(s);
    if upper - s > narrow
        && let Ok(lined_up) = flats::line_up(a, b, n, s)
    {
        known.points = (lined_up.point_a, lined_up.point_b);
        known.converged = true;
        upper = (known.points.1 - known.points.0).length().max(s);
    }
    known.converged &= upper - s <= narrow;
    let answer = known.answer(Some(upper));
    Separation {
        capped: answer.capped && s <= enough,
        ..answer
    }
}

impl Known {
    fn answer(&self, upper: Option<f64>) -> Separation {
        Separation {
            gap: self.best.s,
            upper,
            normal: self.best.n,
            point_a: self.points.0,
            point_b: self.points.1,
            iterations: self.iterations,
            capped: !self.converged,
            local: false,
        }
    }
}

/// Up to three different ones of the points.
fn different(points: Vec<DVec3>) -> Vec<DVec3> {
    let mut different: Vec<DVec3> = Vec::with_capacity(4);
    for p in points {
        if different.len() < 3 && !different.contains(&p) {
            different.push(p);
        }
    }
    different
}

/// Searches against a few corners until no other is farther along the normal found.
fn polish(a: &Placed, b: &Placed, first: &[DVec3], known: &mut Known, limits: Limits) {
    let slack = ROUNDING * (a.shape.size() + b.shape.size());
    let mut corners = first.to_vec();
    // Steps of a search before it is asked whether a corner is missing.
    let mut patience = IMPATIENT;
    while known.iterations < limits.iteration_cap && known.best.s <= limits.enough {
        let cap = limits.iteration_cap.min(known.iterations + patience);
        let within = Limits {
            iteration_cap: cap,
            ..limits
        };
        let before = known.iterations;
        let found = against(a, &corners, known, within, slack);
        let n = found.n;
        let next = corner(a, b, n);
        let s = n.dot(next.d);
        let closed = found.s - s <= slack;
        if s > known.best.s || (closed && s >= known.best.s - slack) {
            known.best = Best { s, n };
            known.points = found.points;
        }
        if closed && found.converged {
            known.converged = s >= known.best.s - slack;
            return;
        }
        let is_new = !corners.contains(&next.b);
        if !is_new && (patience > IMPATIENT || known.iterations == before) {
            return;
        }
        patience = if is_new { IMPATIENT } else { u32::MAX / 2 };
        if is_new {
            corners = found.corners;
            corners.push(next.b);
        }
    }
}

/// The answer against some corners only.
struct Found {
    n: DVec3,
    s: f64,
    points: (DVec3, DVec3),
    converged: bool,
    /// Those that carry the closest point.
    corners: Vec<DVec3>,
}

impl Found {
    /// Whether none of these corners is farther along the normal than the closest point.
    fn holds(&self, corners: &[DVec3], slack: f64) -> bool {
        let height = self.n.dot(self.points.1) - slack;
        corners.iter().all(|p| self.n.dot(*p) >= height)
    }
}

/// The answer against up to four corners: that against the first of their faces and edges at which no corner is
/// farther, else the nearest.
fn against(a: &Placed, corners: &[DVec3], known: &mut Known, limits: Limits, slack: f64) -> Found {
    if let [p] = corners {
        return on_edge(a, [*p, *p], known, limits);
    }
    let count = corners.len();
    for out in 0..if count == 3 { 1 } else { 4 } {
        let rest: Vec<DVec3> = match count {
            3 => corners.to_vec(),
            4 => (0..4).filter(|i| *i != out).map(|i| corners[i]).collect(),
            _ => break,
        };
        if known.iterations < limits.iteration_cap
            && let Some(found) = on_face(a, [rest[0], rest[1], rest[2]], known)
            && found.holds(corners, slack)
        {
            return found;
        }
    }
    let mut edges: Vec<(f64, [DVec3; 2])> = Vec::with_capacity(6);
    for i in 0..count {
        for j in i + 1..count {
            let edge = [corners[i], corners[j]];
            edges.push((distance_squared(known.points.0, edge), edge));
        }
    }
    edges.sort_by(|x, y| x.0.total_cmp(&y.0));
    let mut best = on_edge(a, edges[0].1, known, limits);
    for (_, edge) in &edges[1..] {
        if best.holds(corners, slack) || known.iterations >= limits.iteration_cap {
            break;
        }
        let found = on_edge(a, *edge, known, limits);
        if found.s < best.s || found.holds(corners, slack) {
            best = found;
        }
    }
    best
}

fn distance_squared(point: DVec3, [p, q]: [DVec3; 2]) -> f64 {
    let edge = q - p;
    let along = ((point - p).dot(edge) / edge.length_squared()).clamp(0.0, 1.0);
    (p + edge * along).distance_squared(point)
}

/// The answer at the normal of a face, if the closest point lies in it.
fn on_face(a: &Placed, [p, q, r]: [DVec3; 3], known: &mut Known) -> Option<Found> {
    let normal = (q - p).cross(r - p);
    let n = normal.try_normalize()?;
    let n = if n.dot(known.best.n) >= 0.0 { n } else { -n };
    known.iterations += 1;
    let point = a.face_point(n, (p + q + r) / 3.0, super::cores::SQUARE);
    let s = n.dot(p - point);
    let below = point + n * s;
    let weights = [
        normal.dot((q - below).cross(r - below)),
        normal.dot((r - below).cross(p - below)),
        normal.dot((p - below).cross(q - below)),
    ];
    let inside = weights
        .iter()
        .all(|w| *w >= -1e-12 * normal.length_squared());
    inside.then(|| Found {
        n,
        s,
        points: (point, below),
        converged: true,
        corners: vec![p, q, r],
    })
}

/// The exact search against an edge, or a corner twice.
fn on_edge(a: &Placed, [p, q]: [DVec3; 2], known: &mut Known, limits: Limits) -> Found {
    let half = (q - p) * 0.5;
    let middle = p + half;
    let offset = middle - a.position;
    let cap = limits.iteration_cap.saturating_sub(known.iterations);
    let goal = Goal {
        cap,
        tolerance: limits.tolerance,
        enough: f64::INFINITY,
        known: None,
    };
    let n = known.best.n;
    let summit = match half.try_normalize() {
        Some(axis) => {
            let profile = Profile::new(0.0, 0.0, half.length());
            let core = RevolutionCore {
                axis,
                profile: &profile,
            };
            curved(a, core, offset, n, goal)
        }
        None => curved(a, PointCore, offset, n, goal),
    };
    known.iterations += summit.iterations;
    let point_b = middle - summit.points.1;
    let along = (point_b - middle).dot(half);
    let reach = half.length_squared() * (1.0 - 1e-14);
    let corners = if p == q || along <= -reach {
        vec![p]
    } else if along >= reach {
        vec![q]
    } else {
        vec![p, q]
    };
    Found {
        n: summit.n,
        s: summit.s,
        points: (a.position + summit.points.0, point_b),
        converged: summit.converged,
        corners,
    }
}

/// Searches the curved shape against a core at `offset`.
fn curved<B: Core>(a: &Placed, b: B, offset: DVec3, n: DVec3, goal: Goal) -> Summit {
    let r: &DMat3 = &a.rotation;
    match &a.shape.kind {
        Kind::Frustum(profile) => {
            let axis = r.y_axis;
            run(RevolutionCore { axis, profile }, b, offset, n, goal)
        }
        Kind::TruncatedEllipsoid { semi, cut, rim } => {
            run(TruncatedCore::new(r, *semi, *cut, *rim), b, offset, n, goal)
        }
        Kind::Ellipsoid { semi } => run(EllipsoidCore::new(r, *semi), b, offset, n, goal),
        _ => unreachable!("all other shapes are polytopes with a radius, or have a closed form"),
    }
}

fn run<A: Core, B: Core>(a: A, b: B, offset: DVec3, n: DVec3, goal: Goal) -> Summit {
    let pair = Pair::new(a, b, offset);
    let tolerance = goal.tolerance.max(1e-13 * pair.size);
    Search::run(&pair, n, State::Free, Goal { tolerance, ..goal })
}
