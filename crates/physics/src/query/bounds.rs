//! How far a gap can be from the truth: bounds that hold whatever the search did.
//!
//! From below s(n) itself: the planes with normal n part the shapes by that much. From above, when apart, the
//! distance of any point of a from any point of b. When overlapping, balls inside the shapes: if the ball of radius
//! p about a point lies in a and that of radius q in b, no translation shorter than p + q parts them. Half way between
//! the closest points both are large, but a slender tip, or two edges, may not reach that far: then a point of one
//! shape's surface, where p = 0, may still lie in the other.

use glam::DVec3;

use super::{Placed, closed};
use crate::shape::Kind;

/// A proven upper bound of the signed gap of overlapping shapes, from balls about half way between the closest points or
/// close to it; `None` where no point that is looked at lies in both or no ball is known.
pub(super) fn overlap(a: &Placed, b: &Placed, point_a: DVec3, point_b: DVec3) -> Option<f64> {
    let middle = (point_a + point_b) * 0.5;
    let in_both = |point| Some(-(inner_radius(a, point)? + inner_radius(b, point)?));
    if let Some(upper) = in_both(middle) {
        return Some(upper);
    }
    let radii = [inner_radius(b, point_a), inner_radius(a, point_b)];
    if let Some(radius) = radii.into_iter().flatten().reduce(f64::max) {
        return Some(-radius);
    }
    let depth = (point_a - point_b).length();
    let inward = |shape: &Placed| (shape.position - middle).clamp_length_max(depth);
    let inward = inward(a) + inward(b);
    in_both(middle + inward * 0.5).or_else(|| in_both(middle + inward))
}

/// Radius of a ball about `point` that lies inside the shape [m].
fn inner_radius(shape: &Placed, point: DVec3) -> Option<f64> {
    let q = shape.local(point - shape.position);
    let radius = match &shape.shape.kind {
        Kind::Ellipsoid { semi } => in_ellipsoid(q, *semi)?,
        Kind::TruncatedEllipsoid { semi, cut, .. } => in_ellipsoid(q, *semi)?.min(q.y - cut),
        Kind::HalfSpace { normal } => -q.dot(*normal),
        Kind::Cloud(hull) => hull.inner_radius(q)?,
        _ => -closed::outside(shape, point)?.0,
    };
    (radius >= 0.0).then_some(radius)
}

/// Radius of a ball about q inside the ellipsoid: the better of two that are.
///
/// One scales the ellipsoid until q lies on it. The other is the part around q of the ball that touches the ellipsoid
/// from inside with the smallest radius of curvature that there is, which is exact close to the surface.
fn in_ellipsoid(q: DVec3, semi: DVec3) -> Option<f64> {
    let (short, long) = (semi.min_element(), semi.max_element());
    let scaled = (q / semi).length();
    if scaled > 1.0 {
        return None;
    }
    let inscribed = short * (1.0 - scaled);
    let Some(n) = (q / (semi * semi)).try_normalize() else {
        return Some(inscribed);
    };
    let surface = semi * (semi * n) / (semi * n).length();
    let touching = short * short / long;
    let rolling = touching - (q - (surface - n * touching)).length();
    Some(inscribed.max(rolling))
}
