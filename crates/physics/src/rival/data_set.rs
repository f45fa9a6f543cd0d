//! The paper's two data sets, rebuilt, and larger ones of the same objects.

use glam::{DQuat, DVec3};

use super::polyhedron::Polyhedron;
use super::tessellate::{MIN_SIDES, polygon_count};
use crate::pose::Pose;
use crate::shape::Shape;

/// Polygons of the paper's two data sets (§2.1).
pub const PAPER_POLYGONS: [usize; 2] = [419, 970];

/// A convex part of an object, once as a formula and once as polygons.
#[derive(Clone, Debug, PartialEq)]
pub struct Piece {
    /// `object_from_piece`.
    pub pose: Pose,
    /// The parametric shape.
    pub shape: Shape,
    /// Radius of a ball about its origin that holds it [m].
    pub radius: f64,
    /// The polyhedron inscribed in the shape.
    pub polyhedron: Polyhedron,
}

/// A composite object.
#[derive(Clone, Debug, PartialEq)]
pub struct Object {
    /// Its convex parts.
    pub pieces: Vec<Piece>,
    /// Radius of a ball about its origin that holds all of them [m].
    pub radius: f64,
}

/// A piece put somewhere.
#[derive(Clone, Copy, Debug)]
pub struct PlacedPiece<'a> {
    /// What is there.
    pub piece: &'a Piece,
    /// `world_from_piece`.
    pub pose: Pose,
}

/// An object put somewhere.
#[derive(Clone, Debug)]
pub struct PlacedObject<'a> {
    radius: f64,
    position: DVec3,
    pieces: Vec<PlacedPiece<'a>>,
}

impl Object {
    /// The object at `pose`, `world_from_object`.
    pub fn place(&self, pose: &Pose) -> PlacedObject<'_> {
        let place = |piece| PlacedPiece {
            piece,
            pose: *pose * piece.pose,
        };
        PlacedObject {
            radius: self.radius,
            position: pose.position,
            pieces: self.pieces.iter().map(place).collect(),
        }
    }
}

impl<'a> PlacedObject<'a> {
    /// Whether two objects overlap: spheres about the objects first, spheres about their pieces next, and for what is
    /// left `overlap`, until it finds a pair of pieces that do. So every method is spared the same.
    pub fn overlaps(
        &self,
        other: &PlacedObject<'a>,
        mut overlap: impl FnMut(PlacedPiece<'a>, PlacedPiece<'a>) -> bool,
    ) -> bool {
        let near = |p: DVec3, q: DVec3, reach: f64| p.distance_squared(q) <= reach * reach;
        near(self.position, other.position, self.radius + other.radius)
            && self.pieces.iter().any(|p| {
                other.pieces.iter().any(|q| {
                    let reach = p.piece.radius + q.piece.radius;
                    near(p.pose.position, q.pose.position, reach) && overlap(*p, *q)
                })
            })
    }
}

/// Seven composite objects of 22 primitives with exactly this many polygons; `None` for fewer than 118.
///
/// The paper gives the numbers of objects, primitives and polygons, and that all were ellipsoids, cylinders and cones
/// (§2.1), but not what they looked like. Here they are three pins, a dumbbell, a mallet, a spindle and a hand,
/// 0.3 to 0.4 m long. The sides of the primitives are raised in turn as long as the total allows it, so that all are
/// about equally fine; what is left over goes to the cylinders and cones, which take it one polygon at a time.
pub fn data_set(polygons: usize) -> Option<Vec<Object>> {
    let objects = objects();
    let shapes: Vec<&Shape> = objects.iter().flatten().map(|(_, shape)| shape).collect();
    let mut sides = sides(&shapes, polygons)?.into_iter();
    let object = |parts: Vec<(Pose, Shape)>| {
        let pieces: Vec<Piece> = parts
            .into_iter()
            .zip(sides.by_ref())
            .map(|((pose, shape), sides)| Piece {
                pose,
                polyhedron: Polyhedron::of(&shape, sides)
                    .expect("the objects are of shapes that can be tessellated"),
                radius: shape.bounding_radius(),
                shape,
            })
            .collect();
        let reach = |p: &Piece| p.pose.position.length() + p.radius;
        let radius = pieces.iter().map(reach).fold(0.0, f64::max);
        Object { pieces, radius }
    };
    Some(objects.into_iter().map(object).collect())
}

/// Sides for each shape so that the polygons add up to `polygons`.
fn sides(shapes: &[&Shape], polygons: usize) -> Option<Vec<u32>> {
    let count = |shape: &Shape, sides: u32| {
        polygon_count(shape, sides).expect("the objects are of shapes that can be tessellated")
    };
    let mut sides = vec![MIN_SIDES; shapes.len()];
    let least: usize = shapes.iter().map(|shape| count(shape, MIN_SIDES)).sum();
    let mut left = polygons.checked_sub(least)?;
    while left > 0 {
        let mut raised = false;
        for (shape, sides) in shapes.iter().zip(&mut sides) {
            let price = count(shape, *sides + 1) - count(shape, *sides);
            if price > 0 && price <= left {
                *sides += 1;
                left -= price;
                raised = true;
            }
        }
        debug_assert!(raised, "a cylinder can always take one more polygon");
    }
    Some(sides)
}

fn objects() -> Vec<Vec<(Pose, Shape)>> {
    vec![pin(), pin(), pin(), dumbbell(), mallet(), spindle(), hand()]
}

fn made<E: std::fmt::Debug>(shape: Result<Shape, E>) -> Shape {
    shape.expect("the objects' sizes are positive")
}

fn up(y: f64) -> Pose {
    Pose::from_position(DVec3::new(0.0, y, 0.0))
}

fn ellipsoid(x: f64, y: f64, z: f64) -> Shape {
    made(Shape::ellipsoid(DVec3::new(x, y, z)))
}

/// Belly, neck and head.
fn pin() -> Vec<(Pose, Shape)> {
    vec![
        (up(-0.03), ellipsoid(0.0605, 0.112, 0.0605)),
        (up(0.1), made(Shape::frustum(0.03, 0.023, 0.05))),
        (up(0.2), ellipsoid(0.0323, 0.0323, 0.0323)),
    ]
}

/// A bar between two balls.
fn dumbbell() -> Vec<(Pose, Shape)> {
    vec![
        (Pose::IDENTITY, made(Shape::cylinder(0.015, 0.12))),
        (up(-0.13), ellipsoid(0.06, 0.05, 0.06)),
        (up(0.13), ellipsoid(0.06, 0.05, 0.06)),
    ]
}

/// A handle, a head across it and a point on the head.
fn mallet() -> Vec<(Pose, Shape)> {
    let across = DQuat::from_xyzw(
        0.0,
        0.0,
        -std::f64::consts::FRAC_1_SQRT_2,
        std::f64::consts::FRAC_1_SQRT_2,
    );
    let head = Pose::new(DVec3::new(0.0, 0.14, 0.0), across);
    let point = Pose::new(DVec3::new(0.12, 0.14, 0.0), across);
    vec![
        (Pose::IDENTITY, made(Shape::cylinder(0.014, 0.15))),
        (head, made(Shape::cylinder(0.045, 0.07))),
        (point, made(Shape::frustum(0.045, 0.0, 0.05))),
    ]
}

/// A drum between two cones.
fn spindle() -> Vec<(Pose, Shape)> {
    vec![
        (Pose::IDENTITY, made(Shape::cylinder(0.07, 0.04))),
        (up(0.1), made(Shape::frustum(0.07, 0.0, 0.06))),
        (up(-0.1), made(Shape::frustum(0.0, 0.07, 0.06))),
    ]
}

/// Palm, forearm, fingers and thumb.
fn hand() -> Vec<(Pose, Shape)> {
    let aside = Pose::from_position(DVec3::new(0.06, 0.02, 0.01));
    vec![
        (
            Pose::IDENTITY,
            made(Shape::cuboid(DVec3::new(0.045, 0.05, 0.015))),
        ),
        (up(-0.15), made(Shape::cylinder(0.035, 0.1))),
        (up(0.09), ellipsoid(0.045, 0.05, 0.015)),
        (aside, ellipsoid(0.03, 0.018, 0.015)),
    ]
}
