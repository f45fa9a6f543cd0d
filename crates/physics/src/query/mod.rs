//! Detection: the paper's search for the unit normal on which two closest points line up (§2.1, Eq. (1)-(2)).
//!
//! With `P_a(n)` the farthest point of a along n and `P_b(n)` that of b along -n, let `D = P_b - P_a` and
//! `s(n) = n.D`, the gap between the two tangent planes. One n with `s(n) > 0` proves the shapes apart, no closer
//! than `s(n)`; the largest `s(n)` is the signed gap. The paper leaves the new estimate of n to an unpublished
//! report; here it is a second-order step on the sphere (`ascent`), after closed forms where there are any
//! (`closed`) and after the normals of flat faces, where the search has its kinks.

mod ascent;
mod closed;
mod flats;

use glam::{DMat3, DVec3};

use crate::pose::Pose;
use crate::shape::{Kind, Shape};

/// Where two shapes touch, Eq. (1)-(2) of the paper.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Contact {
    /// Half way between the two closest points [m], Eq. (1).
    pub point: DVec3,
    /// Unit normal from a to b, Eq. (2).
    pub normal: DVec3,
    /// How far the shapes overlap [m]; negative when they are apart.
    pub depth: f64,
}

/// When the search may stop.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Limits {
    /// Largest number of new normals tried; 5 to 20 in the paper's trials, 20 in its experiment.
    pub iteration_cap: u32,
    /// The search ends when it expects to gain less than this [m].
    pub tolerance: f64,
    /// A gap that is proven larger than this [m] is not refined. Zero: only whether they are apart. Infinite: exact.
    pub enough: f64,
}

impl Default for Limits {
    /// 20 iterations, 1e-13 m, exact.
    fn default() -> Limits {
        Limits {
            iteration_cap: 20,
            tolerance: 1e-13,
            enough: f64::INFINITY,
        }
    }
}

/// The answer of a search.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Separation {
    /// Signed gap along `normal` [m]: proven lower bound of the distance when positive, minus the depth when not.
    pub gap: f64,
    /// Unit normal from a to b on which the gap was found.
    pub normal: DVec3,
    /// The closest point of a [m].
    pub point_a: DVec3,
    /// The closest point of b [m].
    pub point_b: DVec3,
    /// How many new normals were tried; zero for closed forms.
    pub iterations: u32,
    /// Whether the iteration cap ended the search: the gap is still a bound, the normal only an estimate.
    pub capped: bool,
}

impl Separation {
    /// The contact of Eq. (1)-(2).
    pub fn contact(&self) -> Contact {
        Contact {
            point: (self.point_a + self.point_b) * 0.5,
            normal: self.normal,
            depth: -self.gap,
        }
    }
}

/// A shape put somewhere: `frame_from_shape` with its rotation as a matrix, the form that the inner loops use.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Placed<'a> {
    pub shape: &'a Shape,
    pub rotation: DMat3,
    pub position: DVec3,
}

impl<'a> Placed<'a> {
    pub fn new(shape: &'a Shape, pose: &Pose) -> Placed<'a> {
        Placed {
            shape,
            rotation: DMat3::from_quat(pose.rotation),
            position: pose.position,
        }
    }

    /// A direction in the shape's frame.
    pub fn local(&self, direction: DVec3) -> DVec3 {
        let r = &self.rotation;
        DVec3::new(
            r.x_axis.dot(direction),
            r.y_axis.dot(direction),
            r.z_axis.dot(direction),
        )
    }

    /// Support point along the unit normal `n`.
    pub fn support(&self, n: DVec3) -> DVec3 {
        self.position + self.rotation * self.shape.tip(self.local(n)).point
    }

    /// The nearest point to `target` of all that are farthest along `n`; see `Shape::face_point`.
    pub fn face_point(&self, n: DVec3, target: DVec3, slack: f64) -> DVec3 {
        let target = self.local(target - self.position);
        self.position + self.rotation * self.shape.face_point(self.local(n), target, slack)
    }
}

/// Signed gap between two placed shapes.
///
/// `start` is the normal of an earlier answer for the pair, if any; without it the search starts from the line of
/// centres, as in the paper. The shapes may be given in any common frame.
///
/// Coincident centres have no line of centres: the search then starts from +y, and the answer is a valid separating
/// direction, the same every time. Two half-spaces have no finite gap; they answer with minus infinity.
pub fn separation(
    (shape_a, pose_a): (&Shape, &Pose),
    (shape_b, pose_b): (&Shape, &Pose),
    start: Option<DVec3>,
    limits: Limits,
) -> Separation {
    separation_placed(
        &Placed::new(shape_a, pose_a),
        &Placed::new(shape_b, pose_b),
        start,
        limits,
    )
}

/// The gap along a fixed normal: a lower bound of the distance, at the price of two support points.
pub(crate) fn gap_along(a: &Placed, b: &Placed, n: DVec3) -> f64 {
    n.dot(b.support(-n) - a.support(n))
}

pub(crate) fn separation_placed(
    a: &Placed,
    b: &Placed,
    start: Option<DVec3>,
    limits: Limits,
) -> Separation {
    if let Some(answer) = closed::separation(a, b) {
        return answer;
    }
    let first = start.or_else(|| centres(a, b)).unwrap_or(DVec3::Y);
    let early = gap_along(a, b, first);
    if early > limits.enough {
        return along(a, b, first, early);
    }
    if let Some(answer) = flats::square_on(a, b, first, early) {
        return answer;
    }
    let mut best = ascent::ascend(a, b, first, limits);
    if best.gap > limits.enough || (best.gap > 0.0 && !best.capped) {
        return best;
    }
    // Overlapping shapes have several local maxima; the shallowest way out decides. Also a capped search may have
    // stalled on a flat.
    for n in flats::normals(a).chain(flats::normals(b).map(|n| -n)) {
        let s = gap_along(a, b, n);
        if s > best.gap - 1e-3 * best.gap.abs() - 1e-12
            && let Ok(answer) = flats::line_up(a, b, n, s)
            && answer.gap >= best.gap - 1e-15
        {
            best = Separation {
                iterations: best.iterations,
                ..answer
            };
        }
    }
    if best.gap <= 0.0 && start.is_none() {
        best = from_other_starts(a, b, best, limits);
    }
    best
}

/// Searches an overlap again from the shapes' axes, the most promising first, with what is left of the budget.
fn from_other_starts(a: &Placed, b: &Placed, first: Separation, limits: Limits) -> Separation {
    let (ra, rb) = (&a.rotation, &b.rotation);
    let axes = [ra.y_axis, rb.y_axis, ra.x_axis, ra.z_axis];
    let mut starts = [(0.0, DVec3::ZERO); 8];
    for (start, n) in starts
        .iter_mut()
        .zip(axes.into_iter().flat_map(|n| [n, -n]))
    {
        *start = (gap_along(a, b, n), n);
    }
    starts.sort_by(|x, y| y.0.total_cmp(&x.0));
    let mut best = first;
    let mut used = first.iterations;
    for (_, n) in starts {
        let iteration_cap = limits.iteration_cap.saturating_sub(used);
        if iteration_cap == 0 {
            break;
        }
        let other = ascent::ascend(
            a,
            b,
            n,
            Limits {
                iteration_cap,
                ..limits
            },
        );
        used += other.iterations;
        if other.gap > best.gap + 1e-12 {
            best = other;
        }
    }
    Separation {
        iterations: used,
        ..best
    }
}

/// Where the search starts without a known normal: the line of centres.
///
/// The middle of a long box says little about which of its faces is near; there the direction from the box to the
/// other's centre takes its place.
fn centres(a: &Placed, b: &Placed) -> Option<DVec3> {
    match (&a.shape.kind, &b.shape.kind) {
        (Kind::Cuboid { .. }, _) => closed::outside(a, b.position).map(|(_, n)| n),
        (_, Kind::Cuboid { .. }) => closed::outside(b, a.position).map(|(_, n)| -n),
        _ => (b.position - a.position).try_normalize(),
    }
}

/// The answer along one normal without any search.
fn along(a: &Placed, b: &Placed, n: DVec3, gap: f64) -> Separation {
    Separation {
        gap,
        normal: n,
        point_a: a.support(n),
        point_b: b.support(-n),
        iterations: 0,
        capped: false,
    }
}

/// Signed distance of a point from a shape, where there is a closed form for it.
pub(crate) fn distance_to_point(shape: &Placed, point: DVec3) -> Option<f64> {
    closed::outside(shape, point).map(|(distance, _)| distance)
}
