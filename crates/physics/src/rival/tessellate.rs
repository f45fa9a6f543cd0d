//! Polyhedra for parametric shapes, inscribed, with a polygon count that is known before they are made.

use std::f64::consts::{FRAC_PI_2, TAU};

use glam::DVec3;

use super::polyhedron::Polyhedron;
use crate::shape::{Kind, Shape};

/// Fewest sides of a shape of revolution.
pub const MIN_SIDES: u32 = 3;

/// A ring of vertices about the y axis, or a single one on it where both radii are zero.
#[derive(Clone, Copy, Debug)]
struct Ring {
    y: f64,
    x_radius: f64,
    z_radius: f64,
}

impl Ring {
    fn round(y: f64, radius: f64) -> Ring {
        Ring {
            y,
            x_radius: radius,
            z_radius: radius,
        }
    }

    fn is_point(self) -> bool {
        self.x_radius == 0.0
    }
}

/// How many polygons `Polyhedron::of` makes of a shape; `None` where it makes none.
///
/// With n sides: ellipsoids n max(2, n/2), cylinders and frusta n + 2, cones n + 1, capsules n (2 max(1, n/4) + 1),
/// truncated ellipsoids n max(2, n/2) + 1, boxes 6 whatever n is.
pub fn polygon_count(shape: &Shape, sides: u32) -> Option<usize> {
    let n = sides.max(MIN_SIDES) as usize;
    let count = match shape.kind {
        Kind::Sphere { .. } | Kind::Ellipsoid { .. } => n * (n / 2).max(2),
        Kind::TruncatedEllipsoid { .. } => n * (n / 2).max(2) + 1,
        Kind::Capsule { .. } => n * (2 * (n / 4).max(1) + 1),
        Kind::Frustum(profile) => n + profile.radius.iter().filter(|r| **r > 0.0).count(),
        Kind::Cuboid { .. } => 6,
        _ => return None,
    };
    Some(count)
}

impl Polyhedron {
    /// An inscribed polyhedron: every vertex lies on the shape's surface. `sides` (at least 3) are those of its
    /// cross-section; there are half as many bands of polygons from pole to pole.
    ///
    /// `None` for what is not a bounded parametric shape: half-spaces and vertex clouds.
    pub fn of(shape: &Shape, sides: u32) -> Option<Polyhedron> {
        let n = sides.max(MIN_SIDES);
        let solid = match shape.kind {
            Kind::Sphere { radius } => revolve(&arc(DVec3::splat(radius), -FRAC_PI_2, n), n),
            Kind::Ellipsoid { semi } => revolve(&arc(semi, -FRAC_PI_2, n), n),
            Kind::TruncatedEllipsoid { semi, cut, rim } => {
                let mut rings = arc(semi, libm::asin(cut / semi.y), n);
                rings[0] = Ring {
                    y: cut,
                    x_radius: rim.x,
                    z_radius: rim.z,
                };
                revolve(&rings, n)
            }
            Kind::Capsule { radius, segment } => {
                revolve(&capsule(radius, segment.half_height(), n), n)
            }
            Kind::Frustum(profile) => {
                let end = |i: usize| Ring::round(profile.height[i], profile.radius[i]);
                revolve(&[end(0), end(1)], n)
            }
            Kind::Cuboid { half } => cuboid(half),
            _ => return None,
        };
        Some(solid)
    }
}

/// Rings on an ellipsoid from the latitude `from` (of the unit sphere it is made of) up to the pole.
fn arc(semi: DVec3, from: f64, sides: u32) -> Vec<Ring> {
    let bands = (sides / 2).max(2);
    let ring = |i: u32| {
        let latitude = from + (FRAC_PI_2 - from) * f64::from(i) / f64::from(bands);
        let (sine, cosine) = libm::sincos(latitude);
        // The cosine of a quarter turn is not quite zero; a pole is a single vertex.
        let at_pole = i == bands || (i == 0 && from == -FRAC_PI_2);
        let width = if at_pole { 0.0 } else { cosine };
        Ring {
            y: semi.y * sine,
            x_radius: semi.x * width,
            z_radius: semi.z * width,
        }
    };
    (0..=bands).map(ring).collect()
}

fn capsule(radius: f64, half_height: f64, sides: u32) -> Vec<Ring> {
    let bands = (sides / 4).max(1);
    let cap = |i: u32| {
        let (sine, cosine) = libm::sincos(FRAC_PI_2 * f64::from(i) / f64::from(bands));
        let width = if i == bands { 0.0 } else { radius * cosine };
        Ring::round(half_height + radius * sine, width)
    };
    let upper = (0..=bands).map(cap);
    let lower = upper.clone().rev().map(|ring| Ring { y: -ring.y, ..ring });
    lower.chain(upper).collect()
}

/// Skin over rings from below to above; an end that is no point gets a flat polygon.
fn revolve(rings: &[Ring], sides: u32) -> Polyhedron {
    let mut vertices = Vec::new();
    // Where each ring's vertices start.
    let mut first = Vec::new();
    for ring in rings {
        first.push(vertices.len() as u32);
        let count = if ring.is_point() { 1 } else { sides };
        vertices.extend((0..count).map(|i| {
            let (sine, cosine) = libm::sincos(TAU * f64::from(i) / f64::from(sides));
            DVec3::new(ring.x_radius * cosine, ring.y, ring.z_radius * sine)
        }));
    }
    let vertex = |ring: usize, i: u32| {
        let turn = if rings[ring].is_point() { 0 } else { i % sides };
        first[ring] + turn
    };
    let mut polygons = Vec::new();
    for low in 0..rings.len() - 1 {
        for i in 0..sides {
            let mut polygon = vec![vertex(low, i), vertex(low + 1, i)];
            polygon.extend([vertex(low + 1, i + 1), vertex(low, i + 1)]);
            // At a pole two corners are one.
            polygon.dedup();
            if polygon.first() == polygon.last() {
                polygon.pop();
            }
            polygons.push(polygon);
        }
    }
    let last = rings.len() - 1;
    if !rings[0].is_point() {
        polygons.push((0..sides).map(|i| vertex(0, i)).collect());
    }
    if !rings[last].is_point() {
        polygons.push((0..sides).rev().map(|i| vertex(last, i)).collect());
    }
    Polyhedron::new(vertices, polygons.iter().map(Vec::as_slice))
}

fn cuboid(half: DVec3) -> Polyhedron {
    // Bits 0, 1 and 2 of an index are the signs along x, y and z.
    const FACES: [[u32; 4]; 6] = [
        [0, 4, 6, 2],
        [1, 3, 7, 5],
        [0, 1, 5, 4],
        [2, 6, 7, 3],
        [0, 2, 3, 1],
        [4, 5, 7, 6],
    ];
    let sign = |i: u32, bit: u32| if i >> bit & 1 == 1 { 1.0 } else { -1.0 };
    let corner = |i: u32| half * DVec3::new(sign(i, 0), sign(i, 1), sign(i, 2));
    Polyhedron::new(
        (0..8).map(corner).collect(),
        FACES.iter().map(<[u32; 4]>::as_slice),
    )
}
