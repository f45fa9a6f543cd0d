//! Flat faces: the test that closest points line up at a normal at which a whole face is farthest.

use glam::DVec3;

use super::{Placed, Separation};
use crate::shape::Kind;

/// Angle within which a face counts as square to the normal [rad]; a metre of face then rises by 0.1 nm.
const SLACK: f64 = 1e-10;
/// Closest points that lie this far apart across the normal are still one pair [m].
const LINED_UP: f64 = 1e-11;

/// The answer for a box whose face decided the last time, if it decides again: the other shape's farthest point, or
/// face, still lies above it.
///
/// Apart that is the largest gap, for such a normal is a maximum and there is one; in an overlap it is the way out
/// that was followed until now.
pub(crate) fn on_face(a: &Placed, b: &Placed, last: DVec3) -> Option<Separation> {
    let n = face_normal(a, last).or_else(|| face_normal(b, last))?;
    let s = super::gap_along(a, b, n);
    line_up(a, b, n, s).ok()
}

/// The axis of a box that `n` is, if it is one but for rounding.
fn face_normal(shape: &Placed, n: DVec3) -> Option<DVec3> {
    if !matches!(shape.shape.kind, Kind::Cuboid { .. }) {
        return None;
    }
    let r = &shape.rotation;
    let axes = [r.x_axis, r.y_axis, r.z_axis].into_iter();
    let axis = axes.max_by(|u, w| u.dot(n).abs().total_cmp(&w.dot(n).abs()))?;
    let along = axis.dot(n);
    (along.abs() > 1.0 - 1e-14).then_some(axis * along.signum())
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
                upper: None,
                normal: n,
                point_a,
                point_b,
                iterations,
                capped,
                local: false,
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
