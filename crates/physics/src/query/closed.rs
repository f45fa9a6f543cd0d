//! Pairs with a closed form: a half-space against anything, a sphere against all that has a distance formula.

use glam::DVec3;

use super::{Placed, Separation};
use crate::shape::{Kind, Profile};

/// A face is taken for the nearest feature up to this far outside it [m]: there the direction to a corner is rounding.
const ON_FACE: f64 = 1e-10;

/// The answer, if the pair has a closed form.
#[inline]
pub(super) fn separation(a: &Placed, b: &Placed) -> Option<Separation> {
    match (&a.shape.kind, &b.shape.kind) {
        (Kind::HalfSpace { .. }, Kind::HalfSpace { .. }) => Some(half_spaces(a, b)),
        (Kind::HalfSpace { normal }, _) => Some(plane(a, b, a.rotation * *normal)),
        (_, Kind::HalfSpace { normal }) => Some(plane(b, a, b.rotation * *normal).swapped()),
        (Kind::Sphere { radius }, _) => {
            let (distance, normal) = outside(b, a.position)?;
            Some(from_sphere(a, distance, normal, *radius).swapped())
        }
        (_, Kind::Sphere { radius }) => {
            let (distance, normal) = outside(a, b.position)?;
            Some(from_sphere(b, distance, normal, *radius))
        }
        _ => None,
    }
}

fn answer(gap: f64, normal: DVec3, point_a: DVec3, point_b: DVec3) -> Separation {
    Separation {
        gap,
        upper: Some(gap),
        normal,
        point_a,
        point_b,
        iterations: 0,
        capped: false,
        local: false,
    }
}

fn half_spaces(a: &Placed, b: &Placed) -> Separation {
    answer(f64::NEG_INFINITY, DVec3::Y, a.position, b.position)
}

/// Half-space `a` with outward normal `n` against `b`: one support point. On a flat, the middle of the flat.
#[inline]
fn plane(a: &Placed, b: &Placed, n: DVec3) -> Separation {
    let point_b = b.face_point(-n, b.position, super::cores::SQUARE);
    let gap = n.dot(point_b - a.position);
    answer(gap, n, point_b - n * gap, point_b)
}

/// A shape at signed `distance` from the centre of the `sphere`, with outward `normal` there.
#[inline]
fn from_sphere(sphere: &Placed, distance: f64, normal: DVec3, radius: f64) -> Separation {
    let centre = sphere.position;
    answer(
        distance - radius,
        normal,
        centre - normal * distance,
        centre - normal * radius,
    )
}

/// Signed distance of a point from a shape's surface and the outward normal there; `None` without a closed form.
#[inline]
pub(super) fn outside(shape: &Placed, point: DVec3) -> Option<(f64, DVec3)> {
    let q = point - shape.position;
    Some(match &shape.shape.kind {
        Kind::Sphere { radius } => from_point(q, *radius),
        Kind::Capsule { radius, segment } => {
            let axis = shape.rotation.y_axis;
            let along = q.dot(axis);
            let clamped = along.clamp(segment.height[0], segment.height[1]);
            if clamped == along {
                from_point(square_to(axis, q - axis * along), *radius)
            } else {
                from_point(q - axis * clamped, *radius)
            }
        }
        Kind::Cuboid { half } => {
            let (distance, normal) = from_box(shape.local(q), *half);
            (distance, shape.rotation * normal)
        }
        Kind::Frustum(profile) => from_frustum(q, shape.rotation.y_axis, profile),
        _ => return None,
    })
}

/// Distance from a ball about the origin. At its very centre every direction is as good: +x, always.
#[inline]
fn from_point(q: DVec3, radius: f64) -> (f64, DVec3) {
    let length = q.length();
    let normal = if length > 1e-150 {
        q * (1.0 / length)
    } else {
        DVec3::X
    };
    (length - radius, normal)
}

#[inline]
fn from_box(q: DVec3, half: DVec3) -> (f64, DVec3) {
    let excess = q.abs() - half;
    let nearest = excess.max_element();
    if nearest > ON_FACE {
        let outward = excess.max(DVec3::ZERO) * q.signum();
        let length = outward.length();
        return (length, outward * (1.0 / length));
    }
    // Inside: the nearest face; ties go to y, then x, so that a ball in the middle of a floor leaves upwards.
    let axis = if excess.y == nearest {
        DVec3::Y
    } else if excess.x == nearest {
        DVec3::X
    } else {
        DVec3::Z
    };
    (nearest, axis * axis.dot(q.signum()))
}

/// `across` without what rounding has left along the axis: of a short way that would be an angle, off which a whole
/// mantle stands out.
#[inline]
fn square_to(axis: DVec3, across: DVec3) -> DVec3 {
    across - axis * axis.dot(across)
}

/// Distance from a frustum about the origin, in the plane of its axis and the point: the outline is a trapezium.
#[inline]
fn from_frustum(q: DVec3, axis: DVec3, profile: &Profile) -> (f64, DVec3) {
    let Profile {
        radius,
        height,
        mantle,
        slant,
    } = *profile;
    let along = q.dot(axis);
    let across = square_to(axis, q - axis * along);
    let rho = across.length();
    let out = if rho > 1e-14 * slant {
        across * (1.0 / rho)
    } else {
        axis.any_orthonormal_vector()
    };
    let (lid, floor) = (along - height[1], height[0] - along);
    let side = (rho - radius[0]) * mantle.0 + (along - height[0]) * mantle.1;
    let (mut distance, mut normal) = if lid >= floor {
        (lid, axis)
    } else {
        (floor, -axis)
    };
    if side > distance {
        (distance, normal) = (side, out * mantle.0 + axis * mantle.1);
    }
    if distance <= ON_FACE {
        return (distance, normal);
    }
    // Outside: the nearer of the disc on this side and the mantle.
    let end = usize::from(lid > floor);
    let disc = ((rho - radius[end]).max(0.0), along - height[end]);
    let mut best = (disc.0 * disc.0 + disc.1 * disc.1, disc);
    if side > 0.0 {
        let t = (along - height[0]) * mantle.0 - (rho - radius[0]) * mantle.1;
        if (0.0..=slant).contains(&t) && side * side <= best.0 {
            // The direction of a short way would be rounding, and off it the whole mantle stands out.
            return (side, out * mantle.0 + axis * mantle.1);
        }
        let t = t.clamp(0.0, slant);
        let wall = (
            rho - radius[0] + t * mantle.1,
            along - height[0] - t * mantle.0,
        );
        let square = wall.0 * wall.0 + wall.1 * wall.1;
        if square < best.0 {
            best = (square, wall);
        }
    }
    let length = best.0.sqrt();
    (length, (out * best.1.0 + axis * best.1.1) * (1.0 / length))
}
