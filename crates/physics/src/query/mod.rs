//! Detection: the paper's search for the unit normal on which two closest points line up (§2.1, Eq. (1)-(2)).
//!
//! With `P_a(n)` the farthest point of a along n and `P_b(n)` that of b along -n, let `D = P_b - P_a` and
//! `s(n) = n.D`, the gap between the two tangent planes. One n with `s(n) > 0` proves the shapes apart, no closer
//! than `s(n)`; the largest `s(n)` is the signed gap. The paper leaves the new estimate of n to an unpublished
//! report. Here there are closed forms for some pairs (`closed`) and a second-order search that follows the kinks of
//! s for all others (`search`, from where `starts` says). Vertex clouds have kinks without number: against another
//! polytope a simplex walks to the closest features (`simplex`), against a curved shape a bundle of corners does
//! (`bundle`, `polish`), and a growing polytope proves an overlap's depth (`expand`).

mod bounds;
mod boxes;
mod bundle;
mod candidates;
mod closed;
mod cores;
mod expand;
mod flats;
mod manifold;
mod models;
mod outline;
mod pair;
mod path;
mod polish;
mod search;
mod simplex;
mod solve;
mod starts;

pub(crate) use flats::on_face;
pub(crate) use manifold::manifold_placed;
pub use manifold::{ContactPoint, Manifold, manifold};

use glam::{DMat3, DVec3};

use crate::pose::Pose;
use crate::shape::Shape;

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
    /// Signed gap along `normal` [m]: a proven lower bound of the true one, which is the distance when apart and minus
    /// the depth when not.
    pub gap: f64,
    /// A proven upper bound of the signed gap [m]; `None` where there is none.
    pub upper: Option<f64>,
    /// Unit normal from a to b on which the gap was found.
    pub normal: DVec3,
    /// The closest point of a [m].
    pub point_a: DVec3,
    /// The closest point of b [m].
    pub point_b: DVec3,
    /// How many new normals were tried; zero for closed forms.
    pub iterations: u32,
    /// Whether the search ended before the closest points lined up, or before every promising start was tried, or left
    /// an interval wider than 1e-7 of the size: the bounds hold, the normal is only an estimate.
    pub capped: bool,
    /// Whether an overlap was searched from the given start alone: there may be a shallower way out elsewhere.
    pub local: bool,
}

/// A proof that two shapes are apart.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Apart {
    /// Unit normal from a to b of two planes that part the shapes.
    pub normal: DVec3,
    /// How far the planes are apart [m]: no point of a is nearer to a point of b.
    pub gap_at_least: f64,
    /// How many new normals were tried.
    pub iterations: u32,
}

impl Separation {
    /// The answer for the two shapes in the other order.
    #[inline]
    fn swapped(self) -> Separation {
        Separation {
            normal: -self.normal,
            point_a: self.point_b,
            point_b: self.point_a,
            ..self
        }
    }

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
/// centres, as in the paper. The shapes may be given in any common frame. A start that has grown old costs time only: an
/// overlap that it leads to and nothing proves is looked for again without it.
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

/// Whether two shapes are apart: ends at the first normal that parts them. `None`: they overlap or touch, or the
/// iterations ended before it was known.
///
/// Arguments as for [`separation`]; `limits.enough` is not used.
pub fn apart(
    a: (&Shape, &Pose),
    b: (&Shape, &Pose),
    start: Option<DVec3>,
    limits: Limits,
) -> Option<Apart> {
    let found = separation(
        a,
        b,
        start,
        Limits {
            enough: 0.0,
            ..limits
        },
    );
    (found.gap > 0.0).then_some(Apart {
        normal: found.normal,
        gap_at_least: found.gap,
        iterations: found.iterations,
    })
}

/// The gap along a fixed normal: a lower bound of the distance, at the price of two support points.
pub(crate) fn gap_along(a: &Placed, b: &Placed, n: DVec3) -> f64 {
    n.dot(b.support(-n) - a.support(n))
}

#[inline]
pub(crate) fn separation_placed(
    a: &Placed,
    b: &Placed,
    start: Option<DVec3>,
    limits: Limits,
) -> Separation {
    if let Some(answer) = far(a, b, limits.enough) {
        return answer;
    }
    match closed::separation(a, b) {
        Some(answer) => answer,
        None => solve::search(a, b, start, limits),
    }
}

/// The answer for shapes whose bounding balls are farther apart than is asked for. The points are the balls'.
#[inline]
fn far(a: &Placed, b: &Placed, enough: f64) -> Option<Separation> {
    let (radius_a, radius_b) = (a.shape.bounding_radius(), b.shape.bounding_radius());
    let between = b.position - a.position;
    let reach = radius_a + radius_b + enough;
    let square = between.length_squared();
    // Not so for infinite reach, of half-spaces or an exact gap.
    if !(square > reach * reach && reach > 0.0) {
        return None;
    }
    let distance = square.sqrt();
    let normal = between * (1.0 / distance);
    Some(Separation {
        gap: distance - radius_a - radius_b,
        upper: None,
        normal,
        point_a: a.position + normal * radius_a,
        point_b: b.position - normal * radius_b,
        iterations: 0,
        capped: false,
        local: false,
    })
}

/// Signed distance of a point from a shape, where there is a closed form for it.
pub(crate) fn distance_to_point(shape: &Placed, point: DVec3) -> Option<f64> {
    closed::outside(shape, point).map(|(distance, _)| distance)
}
