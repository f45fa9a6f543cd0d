//! Outlines of the flat or straight part of a shape that is farthest along a normal, and where two of them overlap.

use std::f64::consts::TAU;

use arrayvec::ArrayVec;
use glam::{DVec2, DVec3};

use super::Placed;
use crate::shape::Kind;

/// Angle within which a face or line counts as square to the normal [rad]; a decimetre then rises by 10 um.
const FLAT: f64 = 1e-4;
/// Corners of the polygon in a round face. They lie on its rim, so the polygon is 0.5 % narrower at most.
const CORNERS: u32 = 32;
/// Most corners of what two outlines share, each having at most `CORNERS`.
const MOST: usize = 2 * CORNERS as usize;
/// Points nearer to each other than this are one, in units of the size.
const SAME: f64 = 1e-9;

/// Corners in their order, in a list that needs no allocation.
pub(super) type Corners<T> = ArrayVec<T, MOST>;

/// What a shape is farthest with along a normal.
#[expect(
    clippy::large_enum_variant,
    reason = "a face lives on the stack for one look; a box would allocate in every step"
)]
pub(super) enum Face {
    /// A single point, or a spot of curved surface.
    Point,
    /// An edge (two points) or a face (the corners in their order), in the common frame [m].
    Flat(Corners<DVec3>),
    /// A half-space's plane.
    Plane,
}

/// The part of `shape` that is farthest along `n`.
pub(super) fn face(shape: &Placed, n: DVec3) -> Face {
    let local = shape.local(n);
    let across = (local.x * local.x + local.z * local.z).sqrt();
    let mut points = match &shape.shape.kind {
        Kind::Sphere { .. } | Kind::Ellipsoid { .. } => return Face::Point,
        Kind::HalfSpace { .. } => return Face::Plane,
        Kind::Cuboid { half } => box_face(local, *half),
        Kind::Cloud(hull) => cloud_face(local, &hull.corners),
        Kind::Capsule { radius, segment } if local.y.abs() <= FLAT => segment
            .height
            .map(|y| DVec3::Y * y + local * *radius)
            .into_iter()
            .collect(),
        Kind::Capsule { .. } => return Face::Point,
        Kind::Frustum(profile) => {
            let slope = profile.mantle.0 * local.y - profile.mantle.1 * across;
            if across <= FLAT {
                let end = usize::from(local.y > 0.0);
                let r = profile.radius[end];
                disc(DVec3::new(r, 0.0, r), profile.height[end])
            } else if slope.abs() <= FLAT {
                let out = DVec3::new(local.x, 0.0, local.z) / across;
                let end = |i: usize| out * profile.radius[i] + DVec3::Y * profile.height[i];
                [end(0), end(1)].into_iter().collect()
            } else {
                return Face::Point;
            }
        }
        Kind::TruncatedEllipsoid { cut, rim, .. } if local.y < 0.0 && across <= FLAT => {
            disc(*rim, *cut)
        }
        Kind::TruncatedEllipsoid { .. } => return Face::Point,
    };
    for p in &mut points {
        *p = shape.position + shape.rotation * *p;
    }
    if points.len() < 2 {
        Face::Point
    } else {
        Face::Flat(points)
    }
}

fn disc(semi: DVec3, height: f64) -> Corners<DVec3> {
    if semi.x == 0.0 {
        return Corners::new();
    }
    let corner = |k: u32| {
        let (sin, cos) = libm::sincos(TAU * f64::from(k) / f64::from(CORNERS));
        DVec3::new(semi.x * cos, height, semi.z * sin)
    };
    (0..CORNERS).map(corner).collect()
}

/// Corner, edge or face of a box; the axes along which n does not decide are free.
fn box_face(n: DVec3, half: DVec3) -> Corners<DVec3> {
    let mut points = Corners::from_iter([half.copysign(n)]);
    for axis in [DVec3::X, DVec3::Y, DVec3::Z] {
        if n.dot(axis).abs() > FLAT {
            continue;
        }
        let there: Corners<DVec3> = points
            .iter()
            .rev()
            .map(|p| *p * (1.0 - 2.0 * axis))
            .collect();
        points.extend(there);
    }
    points
}

/// The hull, seen along n, of those vertices that lie as far along n as the farthest.
///
/// Of a face with more than `CORNERS` vertices those that are farthest in as many directions stand for all.
fn cloud_face(n: DVec3, vertices: &[DVec3]) -> Corners<DVec3> {
    let height = |p: &&DVec3| n.dot(**p);
    let Some(top) = vertices
        .iter()
        .max_by(|p, q| height(p).total_cmp(&height(q)))
    else {
        return Corners::new();
    };
    let (u, w) = plane_axes(n, [DVec3::X, DVec3::Y, DVec3::Z]);
    let across = |p: &DVec3| DVec2::new(u.dot(*p - *top), w.dot(*p - *top));
    let level = || {
        let near = |p: &&DVec3| n.dot(*top - **p) <= FLAT * p.distance(*top);
        vertices.iter().filter(near)
    };
    let chosen: Corners<DVec3> = if level().count() <= CORNERS as usize {
        level().copied().collect()
    } else {
        let farthest = |k: u32| {
            let (sin, cos) = libm::sincos(TAU * f64::from(k) / f64::from(CORNERS));
            let along = |p: &&DVec3| across(p).dot(DVec2::new(cos, sin));
            level().max_by(|p, q| along(p).total_cmp(&along(q)))
        };
        (0..CORNERS).filter_map(farthest).copied().collect()
    };
    let flat: Corners<DVec2> = chosen.iter().map(across).collect();
    hull(&flat).into_iter().map(|i| chosen[i]).collect()
}

/// Corners of the hull of points in a plane, counter-clockwise from the one with the smallest number.
fn hull(points: &[DVec2]) -> Corners<usize> {
    let size = points.iter().map(|p| p.length()).fold(0.0, f64::max);
    let mut order: Corners<usize> = (0..points.len()).collect();
    order.sort_unstable_by(|i, j| {
        let (p, q) = (points[*i], points[*j]);
        p.x.total_cmp(&q.x).then(p.y.total_cmp(&q.y)).then(i.cmp(j))
    });
    let mut distinct: Corners<usize> = Corners::new();
    for i in order {
        let last = distinct.last();
        if last.is_none_or(|last| points[i].distance(points[*last]) > SAME * size) {
            distinct.push(i);
        }
    }
    if distinct.len() < 3 {
        return distinct;
    }
    let mut corners: Corners<usize> = Corners::new();
    chain(points, size, &mut distinct.iter().copied(), &mut corners);
    chain(
        points,
        size,
        &mut distinct.iter().rev().copied(),
        &mut corners,
    );
    let first = (0..corners.len()).min_by_key(|i| corners[*i]).unwrap_or(0);
    corners.rotate_left(first);
    corners
}

/// Adds one side of the hull of points that come in their order along x, without its last corner.
fn chain(
    points: &[DVec2],
    size: f64,
    order: &mut dyn Iterator<Item = usize>,
    corners: &mut Corners<usize>,
) {
    let first = corners.len();
    for i in order {
        while corners.len() >= first + 2 {
            let (p, q) = (
                points[corners[corners.len() - 2]],
                points[corners[corners.len() - 1]],
            );
            if (q - p).perp_dot(points[i] - p) > SAME * size * (points[i] - p).length() {
                break;
            }
            corners.pop();
        }
        corners.push(i);
    }
    corners.pop();
}

/// Two axes across n, from the first of `axes` that is not close to n: rounding does not change the choice.
pub(super) fn plane_axes(n: DVec3, axes: [DVec3; 3]) -> (DVec3, DVec3) {
    let axis = if n.dot(axes[0]).abs() < 0.8 {
        axes[0]
    } else {
        axes[1]
    };
    let u = (axis - n * n.dot(axis)).normalize_or(axes[2]);
    (u, n.cross(u))
}

/// The part of the convex `outline` that lies within `other`, both seen along one direction.
///
/// Either may be a line (two points); two lines overlap along a third if they are parallel, and otherwise not.
pub(super) fn overlap(outline: &[DVec2], other: &[DVec2], size: f64) -> Corners<DVec2> {
    match (outline.len(), other.len()) {
        (2, 2) => common_line(outline, other, size),
        (_, 2) => overlap(other, outline, size),
        _ => {
            let other = counter_clockwise(other);
            let mut part = counter_clockwise(outline);
            for (i, p) in other.iter().enumerate() {
                let edge = other[(i + 1) % other.len()] - *p;
                part = clip(&part, *p, edge.normalize_or_zero(), SAME * size);
            }
            part
        }
    }
}

fn counter_clockwise(outline: &[DVec2]) -> Corners<DVec2> {
    let area: f64 = outline
        .iter()
        .zip(outline.iter().cycle().skip(1))
        .map(|(p, q)| p.perp_dot(*q))
        .sum();
    let mut points: Corners<DVec2> = outline.iter().copied().collect();
    if area < 0.0 {
        points.reverse();
    }
    points
}

/// What of an outline lies to the left of the line through p along the unit vector `edge`.
///
/// A cut adds one corner at most, unless rounding makes the outline dented; what then is too much is left out.
fn clip(outline: &[DVec2], p: DVec2, edge: DVec2, slack: f64) -> Corners<DVec2> {
    let mut kept = Corners::new();
    for (i, here) in outline.iter().enumerate() {
        let next = outline[(i + 1) % outline.len()];
        let (d, e) = (edge.perp_dot(*here - p), edge.perp_dot(next - p));
        if d >= -slack {
            _ = kept.try_push(*here);
        }
        if (d >= -slack) != (e >= -slack) {
            _ = kept.try_push(here.lerp(next, (d / (d - e)).clamp(0.0, 1.0)));
        }
    }
    kept
}

fn common_line(one: &[DVec2], two: &[DVec2], size: f64) -> Corners<DVec2> {
    let length = one[0].distance(one[1]);
    let along = (one[1] - one[0]) / length;
    let other = two[1] - two[0];
    if along.perp_dot(other).abs() > FLAT * other.length() {
        return Corners::new();
    }
    let aside = along.perp_dot(two[0] - one[0]).abs();
    let (p, q) = (along.dot(two[0] - one[0]), along.dot(two[1] - one[0]));
    let (from, to) = (p.min(q).max(0.0), p.max(q).min(length));
    if aside > FLAT * size || to <= from {
        return Corners::new();
    }
    [one[0] + along * from, one[0] + along * to]
        .into_iter()
        .collect()
}

/// Up to four corners that span the outline best, in its order.
pub(super) fn reduce(outline: &[DVec2], size: f64) -> ArrayVec<DVec2, 4> {
    // A direction that is square to no edge of anything regular; ties go to the first in the outline's order.
    let first = DVec2::new(0.798_635_51, 0.601_815_02);
    let slack = SAME * size;
    let highest = |height: &dyn Fn(DVec2) -> f64| {
        let mut best = 0;
        for i in 1..outline.len() {
            if height(outline[i]) > height(outline[best]) + slack {
                best = i;
            }
        }
        best
    };
    if outline.is_empty() {
        return ArrayVec::new();
    }
    let p = outline[highest(&|x| first.dot(x))];
    let far = highest(&|x| x.distance(p));
    let across = (outline[far] - p).perp().normalize_or_zero();
    let sides = [across, -across].map(|side| highest(&|x| side.dot(x - p)));
    let mut chosen = [highest(&|x| first.dot(x)), far, sides[0], sides[1]];
    chosen.sort_unstable();
    let mut corners = ArrayVec::<DVec2, 4>::new();
    for i in chosen {
        if corners.iter().all(|c| c.distance(outline[i]) > slack) {
            corners.push(outline[i]);
        }
    }
    corners
}
