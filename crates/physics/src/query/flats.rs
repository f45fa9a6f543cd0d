//! Flat faces: normals at which a whole face is farthest, and the test that they are the answer.

use glam::DVec3;

use super::{Placed, Separation, gap_along};
use crate::shape::Kind;

/// Angle within which a face counts as square to the normal [rad]; a metre of face then rises by 0.1 nm.
const SLACK: f64 = 1e-10;
/// Closest points that lie this far apart across the normal are still one pair [m].
const LINED_UP: f64 = 1e-11;

/// Outward normals of the shape's flat faces, world frame.
pub(super) fn normals(shape: &Placed) -> impl Iterator<Item = DVec3> {
    let r = shape.rotation;
    let (x, y, z) = (r.x_axis, r.y_axis, r.z_axis);
    let (list, count) = match shape.shape.kind {
        Kind::Cuboid { .. } => ([y, -y, x, -x, z, -z], 6),
        Kind::Frustum { .. } => ([y, -y, x, x, x, x], 2),
        Kind::TruncatedEllipsoid { .. } => ([-y, x, x, x, x, x], 1),
        _ => ([x; 6], 0),
    };
    list.into_iter().take(count)
}

/// The answer at once, if `n` is square to a face of either shape and the closest points line up there.
///
/// When apart that is the global optimum; in a shallow overlap, where the last step's normal was this one, the
/// nearest. Deep overlaps are searched for a shallower way out.
pub(super) fn square_on(a: &Placed, b: &Placed, n: DVec3, s: f64) -> Option<Separation> {
    if s < -0.05 * a.shape.size().min(b.shape.size()) {
        return None;
    }
    let square = |m: &DVec3| m.dot(n) > 1.0 - 1e-14;
    let face = normals(a).chain(normals(b).map(|m| -m)).find(square)?;
    line_up(a, b, face, gap_along(a, b, face)).ok()
}

/// The answer at `n`, with gap `s`, if the closest points line up there; else the offset across n that remains.
///
/// The points of a and of b that are farthest along n form two convex sets (points, lines or faces). They line up if
/// the sets, seen along n, share a point. Projecting in turn on either finds one if there is one.
pub(super) fn line_up(a: &Placed, b: &Placed, n: DVec3, s: f64) -> Result<Separation, DVec3> {
    let mut point_a = a.face_point(n, b.position, SLACK);
    let mut point_b = b.face_point(-n, point_a, SLACK);
    let mut last = f64::INFINITY;
    for _ in 0..12 {
        let d = point_b - point_a;
        let offset = d - n * n.dot(d);
        let length = offset.length();
        if length <= LINED_UP {
            let (gap, iterations, capped) = (s, 0, false);
            return Ok(Separation {
                gap,
                normal: n,
                point_a,
                point_b,
                iterations,
                capped,
            });
        }
        if length > 0.999 * last {
            return Err(offset);
        }
        last = length;
        point_a = a.face_point(n, point_b, SLACK);
        point_b = b.face_point(-n, point_a, SLACK);
    }
    let d = point_b - point_a;
    Err(d - n * n.dot(d))
}
