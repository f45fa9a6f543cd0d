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

/// Cosine of the angle from the start within which a box's axis is looked at: 0.1 rad.
const CLOSE: f64 = 0.995;

/// The answer for the convex shape `a` whose farthest point lies over a face of the box `b`, if it does.
///
/// The face is the one that `start` is close to, and without a start that of which a's centre stands out most. Apart that
/// is the largest gap; an overlap is only looked for with a start, and is local.
pub(super) fn over_face(
    a: &Placed,
    b: &Placed,
    half: DVec3,
    start: Option<DVec3>,
) -> Option<Separation> {
    let toward = start.map_or_else(|| b.local(a.position - b.position), |n| -b.local(n));
    let side = match start {
        Some(_) => toward.abs(),
        None => toward.abs() - half,
    };
    let (x, y, z) = (side.x, side.y, side.z);
    let face = if x >= y && x >= z {
        DVec3::X
    } else if y >= z {
        DVec3::Y
    } else {
        DVec3::Z
    };
    if start.is_some() && side.max_element() < CLOSE {
        return None;
    }
    let outward = face * face.dot(toward).signum();
    let n = b.rotation * -outward;
    let tip = b.local(a.support(n) - b.position);
    let aside = tip.abs() - half;
    if (aside * (DVec3::ONE - face)).max_element() > 0.0 {
        return None;
    }
    let gap = outward.dot(tip) - outward.abs().dot(half);
    if gap <= 0.0 && start.is_none() {
        return None;
    }
    let found = line_up(a, b, n, gap).ok()?;
    let upper = if gap > 0.0 {
        Some((found.point_b - found.point_a).length().max(gap))
    } else {
        let balls = super::bounds::overlap(a, b, found.point_a, found.point_b)?;
        Some(balls.max(gap))
    };
    Some(Separation {
        upper,
        iterations: 1,
        local: gap <= 0.0,
        ..found
    })
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
