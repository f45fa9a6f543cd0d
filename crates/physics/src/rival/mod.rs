//! The method that the paper measured its own against (§2.1): polyhedron against polyhedron, bounding spheres first, then
//! each point and each edge of one against the inside of the other.
//!
//! It is a peer to compare with and takes no part in a step. It stops at the first point or edge that is inside, and for
//! each of them at the first plane that has it outside; without these two the paper's rival would be slower than
//! anybody would write it. It says whether two objects overlap, and neither where nor how far.

mod data_set;
mod polyhedron;
mod tessellate;

pub use data_set::{Object, PAPER_POLYGONS, Piece, PlacedObject, PlacedPiece, data_set};
pub use polyhedron::Polyhedron;
pub use tessellate::{MIN_SIDES, polygon_count};

use glam::{DMat3, DVec3};

use crate::pose::Pose;

/// The rival's test, with the memory that it uses again from pair to pair.
#[derive(Clone, Debug, Default)]
pub struct Rival {
    /// Vertices of one polyhedron in the frame of the other.
    moved: Vec<DVec3>,
}

impl Rival {
    /// Whether two polyhedra overlap or touch.
    pub fn overlap(&mut self, a: (&Polyhedron, &Pose), b: (&Polyhedron, &Pose)) -> bool {
        let reach = a.0.bounding_radius() + b.0.bounding_radius();
        if a.1.position.distance_squared(b.1.position) > reach * reach {
            return false;
        }
        self.reaches_into(a, b) || self.reaches_into(b, a)
    }

    /// Whether a point or an edge of a is inside b.
    fn reaches_into(&mut self, a: (&Polyhedron, &Pose), b: (&Polyhedron, &Pose)) -> bool {
        let b_from_a = b.1.inverse() * *a.1;
        let turn = DMat3::from_quat(b_from_a.rotation);
        let moved = a.0.vertices().iter().map(|&v| b_from_a.position + turn * v);
        self.moved.clear();
        self.moved.extend(moved);
        let at = |i: u32| self.moved[i as usize];
        self.moved.iter().any(|&p| b.0.contains(p))
            || a.0
                .edges()
                .iter()
                .any(|&[i, j]| b.0.meets_segment(at(i), at(j)))
    }
}
