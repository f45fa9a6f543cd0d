//! Contact manifolds: the few points that stand for a whole face or line of contact.

use arrayvec::ArrayVec;
use glam::{DVec2, DVec3};

use super::outline::{Corners, Face, face, overlap, plane_axes, reduce};
use super::{Placed, Separation};
use crate::pose::Pose;
use crate::shape::{Kind, Shape};

/// One point of a manifold.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ContactPoint {
    /// Half way between the two surfaces [m], Eq. (1).
    pub point: DVec3,
    /// How far the surfaces overlap here along the normal [m]; negative when they are apart.
    pub depth: f64,
}

/// Where two shapes touch, with one to four points.
#[derive(Clone, Debug, PartialEq)]
pub struct Manifold {
    /// Unit normal from a to b, Eq. (2).
    pub normal: DVec3,
    points: ArrayVec<ContactPoint, 4>,
}

impl Manifold {
    /// The points, around the face or from end to end of the line that they span.
    pub fn points(&self) -> &[ContactPoint] {
        &self.points
    }
}

/// The points that span the contact of two shapes whose signed gap is known.
///
/// Where two faces, a face and an edge or two parallel edges lie square to the normal within 1e-4 rad, it is the part
/// that they share, reduced to the four corners (two ends) that span it best; elsewhere the one point of Eq. (1).
/// Round faces count as polygons of 32 corners on their rims. `known` is the pair's answer from
/// [`separation`](super::separation); a half-space takes every face whole.
pub fn manifold(
    (shape_a, pose_a): (&Shape, &Pose),
    (shape_b, pose_b): (&Shape, &Pose),
    known: &Separation,
) -> Manifold {
    manifold_placed(
        &Placed::new(shape_a, pose_a),
        &Placed::new(shape_b, pose_b),
        known,
    )
}

/// The same for placed shapes.
pub(crate) fn manifold_placed(a: &Placed, b: &Placed, known: &Separation) -> Manifold {
    let contact = known.contact();
    let single = ContactPoint {
        point: contact.point,
        depth: contact.depth,
    };
    let n = known.normal;
    let of = |points| Manifold { normal: n, points };
    let (u, w) = plane_axes(n, [a.rotation.x_axis, a.rotation.y_axis, a.rotation.z_axis]);
    let frame = Frame {
        origin: contact.point,
        u,
        w,
        n,
    };
    let (Some(below), Some(above)) = (frame.sheet(a, n), frame.sheet(b, -n)) else {
        return of(ArrayVec::from_iter([single]));
    };
    let size = a.shape.size().min(b.shape.size());
    let shared = match (below.outline.is_empty(), above.outline.is_empty()) {
        (true, _) => above.outline.clone(),
        (_, true) => below.outline.clone(),
        _ => overlap(&below.outline, &above.outline, size),
    };
    let points: ArrayVec<ContactPoint, 4> = reduce(&shared, size)
        .into_iter()
        .map(|at| {
            let (low, high) = (above.height(at), below.height(at));
            ContactPoint {
                point: frame.point(at, 0.5 * (low + high)),
                depth: high - low,
            }
        })
        .collect();
    if points.len() < 2 {
        return of(ArrayVec::from_iter([single]));
    }
    of(points)
}

/// Coordinates across and along the normal.
struct Frame {
    origin: DVec3,
    u: DVec3,
    w: DVec3,
    n: DVec3,
}

/// A face or edge as seen along the normal, and its height over the plane across it.
struct Sheet {
    /// Empty for a plane without end.
    outline: Corners<DVec2>,
    centre: DVec2,
    rise: f64,
    slope: DVec2,
}

impl Sheet {
    fn height(&self, at: DVec2) -> f64 {
        self.rise + self.slope.dot(at - self.centre)
    }
}

impl Frame {
    fn across(&self, v: DVec3) -> DVec2 {
        DVec2::new(self.u.dot(v), self.w.dot(v))
    }

    fn point(&self, at: DVec2, height: f64) -> DVec3 {
        self.origin + self.u * at.x + self.w * at.y + self.n * height
    }

    /// The face or edge of `shape` that is farthest along `outward`; `None` where that is a point.
    fn sheet(&self, shape: &Placed, outward: DVec3) -> Option<Sheet> {
        let (points, normal, centre) = match (face(shape, outward), &shape.shape.kind) {
            (Face::Plane, Kind::HalfSpace { normal }) => {
                (Corners::new(), shape.rotation * *normal, shape.position)
            }
            (Face::Flat(points), _) => {
                let centre = points.iter().copied().sum::<DVec3>() / points.len() as f64;
                let normal = normal_of(&points, centre, outward);
                (points, normal, centre)
            }
            _ => return None,
        };
        let middle = centre - self.origin;
        Some(Sheet {
            outline: points
                .iter()
                .map(|p| self.across(*p - self.origin))
                .collect(),
            centre: self.across(middle),
            rise: self.n.dot(middle),
            slope: -self.across(normal) / self.n.dot(normal),
        })
    }
}

/// Normal of a face from its corners (Newell's sum); of an edge the one that is nearest to `outward`.
fn normal_of(points: &[DVec3], centre: DVec3, outward: DVec3) -> DVec3 {
    if points.len() == 2 {
        let edge = (points[1] - points[0]).normalize_or_zero();
        return outward - edge * edge.dot(outward);
    }
    let next = points.iter().cycle().skip(1);
    points
        .iter()
        .zip(next)
        .map(|(p, q)| (*p - centre).cross(*q - centre))
        .sum()
}

#[cfg(test)]
mod tests;
