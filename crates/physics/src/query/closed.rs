//! Pairs with a closed form: a half-space against anything, a sphere against all that has a distance formula.

use glam::DVec3;

use super::{Placed, Separation};
use crate::shape::Kind;

/// The answer, if the pair has a closed form.
pub(super) fn separation(a: &Placed, b: &Placed) -> Option<Separation> {
    match (&a.shape.kind, &b.shape.kind) {
        (Kind::HalfSpace { .. }, Kind::HalfSpace { .. }) => Some(half_spaces(a, b)),
        (Kind::HalfSpace { normal }, _) => Some(plane(a, b, a.rotation * *normal)),
        (_, Kind::HalfSpace { normal }) => Some(flip(plane(b, a, b.rotation * *normal))),
        (Kind::Sphere { radius }, _) => {
            let (distance, normal) = outside(b, a.position)?;
            Some(flip(from_sphere(b, a, distance, normal, *radius)))
        }
        (_, Kind::Sphere { radius }) => {
            let (distance, normal) = outside(a, b.position)?;
            Some(from_sphere(a, b, distance, normal, *radius))
        }
        _ => None,
    }
}

fn flip(s: Separation) -> Separation {
    Separation {
        normal: -s.normal,
        point_a: s.point_b,
        point_b: s.point_a,
        ..s
    }
}

fn answer(gap: f64, normal: DVec3, point_a: DVec3, point_b: DVec3) -> Separation {
    Separation {
        gap,
        normal,
        point_a,
        point_b,
        iterations: 0,
        capped: false,
    }
}

fn half_spaces(a: &Placed, b: &Placed) -> Separation {
    answer(f64::NEG_INFINITY, DVec3::Y, a.position, b.position)
}

/// Half-space `a` with outward normal `n` against `b`: one support point. On a flat, the middle of the flat.
fn plane(a: &Placed, b: &Placed, n: DVec3) -> Separation {
    let point_b = b.face_point(-n, b.position, 1e-10);
    let gap = n.dot(point_b - a.position);
    answer(gap, n, point_b - n * gap, point_b)
}

/// Shape `a`, at signed `distance` along `normal` from the centre of the sphere `b`.
fn from_sphere(a: &Placed, b: &Placed, distance: f64, normal: DVec3, radius: f64) -> Separation {
    let _ = a;
    let surface = b.position - normal * distance;
    answer(
        distance - radius,
        normal,
        surface,
        b.position - normal * radius,
    )
}

/// Signed distance of a point from a shape's surface and the outward normal there; `None` without a closed form.
pub(super) fn outside(shape: &Placed, point: DVec3) -> Option<(f64, DVec3)> {
    let q = shape.local(point - shape.position);
    let (distance, normal) = match shape.shape.kind {
        Kind::Sphere { radius } => from_point(q, radius),
        Kind::Capsule {
            radius,
            half_height,
        } => {
            let on_axis = DVec3::new(0.0, q.y.clamp(-half_height, half_height), 0.0);
            from_point(q - on_axis, radius)
        }
        Kind::Cuboid { half } => from_box(q, half),
        Kind::Frustum {
            bottom,
            top,
            half_height,
        } => from_frustum(q, bottom, top, half_height),
        _ => return None,
    };
    Some((distance, shape.rotation * normal))
}

/// Distance from a ball about the origin. At its very centre every direction is as good: +x, always.
fn from_point(q: DVec3, radius: f64) -> (f64, DVec3) {
    let length = q.length();
    let normal = if length > 0.0 {
        q.try_normalize().unwrap_or(DVec3::X)
    } else {
        DVec3::X
    };
    (length - radius, normal)
}

fn from_box(q: DVec3, half: DVec3) -> (f64, DVec3) {
    let excess = q.abs() - half;
    let outward = excess.max(DVec3::ZERO) * q.signum();
    if let Some(normal) = outward.try_normalize() {
        return (outward.length(), normal);
    }
    // Inside: the nearest face; ties go to y, then x, so that a ball in the middle of a floor leaves upwards.
    let best = excess.max_element();
    let axis = if excess.y == best {
        DVec3::Y
    } else if excess.x == best {
        DVec3::X
    } else {
        DVec3::Z
    };
    (best, axis * axis.dot(q.signum()))
}

/// Distance from a frustum in the plane of its axis and the point: the profile is a trapezium.
fn from_frustum(q: DVec3, bottom: f64, top: f64, half_height: f64) -> (f64, DVec3) {
    let across = DVec3::new(q.x, 0.0, q.z);
    let rho = across.length();
    let out = across.try_normalize().unwrap_or(DVec3::X);
    let slant = ((top - bottom) * (top - bottom) + 4.0 * half_height * half_height).sqrt();
    let side_normal = (2.0 * half_height / slant, (bottom - top) / slant); // (rho, y)
    let side = (rho - bottom) * side_normal.0 + (q.y + half_height) * side_normal.1;
    let (lid, floor) = (q.y - half_height, -half_height - q.y);
    if side <= 0.0 && lid <= 0.0 && floor <= 0.0 {
        return if lid >= side && lid >= floor {
            (lid, DVec3::Y)
        } else if floor >= side {
            (floor, DVec3::NEG_Y)
        } else {
            (side, out * side_normal.0 + DVec3::Y * side_normal.1)
        };
    }
    // Outside: the nearest of the two discs and the slanted side.
    let to_disc = |radius: f64, y: f64| ((rho - radius).max(0.0), q.y - y);
    let along = (side_normal.0 * (q.y + half_height) - side_normal.1 * (rho - bottom)) / slant;
    let along = along.clamp(0.0, 1.0);
    let to_side = (
        rho - bottom - (top - bottom) * along,
        q.y + half_height - 2.0 * half_height * along,
    );
    let mut best = to_side;
    for d in [to_disc(bottom, -half_height), to_disc(top, half_height)] {
        if d.0 * d.0 + d.1 * d.1 < best.0 * best.0 + best.1 * best.1 {
            best = d;
        }
    }
    let length = (best.0 * best.0 + best.1 * best.1).sqrt();
    match (out * best.0 + DVec3::Y * best.1).try_normalize() {
        Some(normal) => (length, normal),
        None => (0.0, if lid >= floor { DVec3::Y } else { DVec3::NEG_Y }),
    }
}
