//! The rival: the same shapes and poses for parry's `contact`.

use glam::DVec3;
use parry3d_f64::math::{Pose as ParryPose, Rotation, Vector};
use parry3d_f64::query::details::{contact_halfspace_support_map, contact_support_map_support_map};
use parry3d_f64::query::{Contact, contact};
use parry3d_f64::shape::{
    Ball, Capsule, Cone, ConvexPolyhedron, Cuboid, Cylinder, HalfSpace, Shape as ParryShape,
    SupportMap,
};
use physics::Pose;

use crate::judge::known::Known;

/// An ellipsoid, which parry does not have, as its generic algorithm wants it.
pub struct Ellipsoid(Vector);

impl SupportMap for Ellipsoid {
    fn local_support_point(&self, direction: Vector) -> Vector {
        let stretched = self.0 * direction;
        let length = stretched.length();
        if length > 0.0 {
            self.0 * stretched / length
        } else {
            Vector::ZERO
        }
    }
}

/// A frustum, which parry does not have: radius below, radius above, half height.
pub struct Frustum(f64, f64, f64);

impl SupportMap for Frustum {
    fn local_support_point(&self, d: Vector) -> Vector {
        let across = (d.x * d.x + d.z * d.z).sqrt();
        let below = self.0 * across - self.2 * d.y > self.1 * across + self.2 * d.y;
        let (r, y) = if below {
            (self.0, -self.2)
        } else {
            (self.1, self.2)
        };
        if across > 0.0 {
            Vector::new(r * d.x / across, y, r * d.z / across)
        } else {
            Vector::new(r, y, 0.0)
        }
    }
}

/// A shape in parry's terms.
pub enum Rival {
    /// One that its `contact` knows.
    Own(Box<dyn ParryShape>),
    /// One that only its algorithm for support maps takes.
    Map(Box<dyn SupportMap>),
    /// A half-space.
    HalfSpace(HalfSpace),
}

fn vector(v: DVec3) -> Vector {
    Vector::new(v.x, v.y, v.z)
}

/// A pose in parry's terms.
pub fn pose(pose: &Pose) -> ParryPose {
    let q = pose.rotation;
    ParryPose::from_parts(
        vector(pose.position),
        Rotation::from_xyzw(q.x, q.y, q.z, q.w),
    )
}

impl Rival {
    /// The same shape, of the same sizes.
    pub fn new(known: &Known) -> Rival {
        match *known {
            Known::Sphere(r) => Rival::Own(Box::new(Ball::new(r))),
            Known::Capsule(r, h) => Rival::Own(Box::new(Capsule::new_y(h, r))),
            Known::Frustum(bottom, top, h) if bottom == top => {
                Rival::Own(Box::new(Cylinder::new(h, bottom)))
            }
            Known::Frustum(bottom, 0.0, h) => Rival::Own(Box::new(Cone::new(h, bottom))),
            Known::Frustum(bottom, top, h) => Rival::Map(Box::new(Frustum(bottom, top, h))),
            Known::Ellipsoid(a) => Rival::Map(Box::new(Ellipsoid(vector(a)))),
            Known::Cuboid(h) => Rival::Own(Box::new(Cuboid::new(vector(h)))),
            Known::Cloud(ref hull) => {
                let points: Vec<Vector> = hull.points.iter().map(|p| vector(*p)).collect();
                let hull = ConvexPolyhedron::from_convex_hull(&points);
                Rival::Own(Box::new(
                    hull.expect("points in general position have a hull"),
                ))
            }
            Known::HalfSpace(n) => Rival::HalfSpace(HalfSpace::new(vector(n))),
            Known::Truncated(..) => unreachable!("no pair of the tables has a truncated ellipsoid"),
        }
    }

    fn map(&self) -> &dyn SupportMap {
        match self {
            Rival::Own(shape) => shape
                .as_support_map()
                .expect("all but half-spaces have one"),
            Rival::Map(map) => &**map,
            Rival::HalfSpace(_) => unreachable!("half-spaces come first and are asked for before"),
        }
    }
}

/// Parry's contact of two shapes, none when they are farther apart than `prediction` [m].
pub fn rival_contact(
    a: (&Rival, &ParryPose),
    b: (&Rival, &ParryPose),
    prediction: f64,
) -> Option<Contact> {
    match (a.0, b.0) {
        (Rival::Own(x), Rival::Own(y)) => contact(a.1, &**x, b.1, &**y, prediction)
            .expect("parry has an algorithm for all of its own convex shapes"),
        (Rival::HalfSpace(plane), other) => {
            contact_halfspace_support_map(&a.1.inv_mul(b.1), plane, other.map(), prediction)
        }
        (x, y) => contact_support_map_support_map(&a.1.inv_mul(b.1), x.map(), y.map(), prediction),
    }
}
