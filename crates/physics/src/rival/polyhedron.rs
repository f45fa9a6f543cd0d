//! Closed convex surfaces made of flat polygons.

use glam::DVec3;

/// The half-space behind a polygon: all points with `normal . p <= offset`.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Plane {
    normal: DVec3,
    offset: f64,
}

impl Plane {
    /// Signed height of a point over the plane [m]: positive outside.
    fn height(&self, point: DVec3) -> f64 {
        self.normal.dot(point) - self.offset
    }
}

/// A closed convex polyhedron in its own frame, with the origin inside.
///
/// Polygons may have any number of corners: the end of a cylinder is one. They are counted as they are, not as
/// triangles, because that is how the paper counts (§2.1).
#[derive(Clone, Debug, PartialEq)]
pub struct Polyhedron {
    vertices: Vec<DVec3>,
    /// Indices into `vertices`, polygon after polygon, each counter-clockwise as seen from outside.
    corners: Vec<u32>,
    /// Where each polygon ends in `corners`.
    ends: Vec<u32>,
    edges: Vec<[u32; 2]>,
    planes: Vec<Plane>,
    radius: f64,
}

impl Polyhedron {
    /// Takes vertices [m] and polygons that the caller knows to be flat, convex and closed, as a tessellator does.
    pub(super) fn new<'a>(
        vertices: Vec<DVec3>,
        polygons: impl Iterator<Item = &'a [u32]>,
    ) -> Polyhedron {
        let mut solid = Polyhedron {
            radius: vertices.iter().map(|v| v.length()).fold(0.0, f64::max),
            vertices,
            corners: Vec::new(),
            ends: Vec::new(),
            edges: Vec::new(),
            planes: Vec::new(),
        };
        for polygon in polygons {
            solid.push(polygon);
        }
        solid
    }

    fn push(&mut self, polygon: &[u32]) {
        let at = |i: u32| self.vertices[i as usize];
        let following = polygon.iter().cycle().skip(1);
        let sides = polygon.iter().zip(following);
        // Newell's sum: twice the polygon's area along its normal, from all corners, so that no short side decides.
        let area: DVec3 = sides.clone().map(|(&i, &j)| at(i).cross(at(j))).sum();
        let normal = area
            .try_normalize()
            .expect("a tessellator makes no polygon without an area");
        let offset = polygon.iter().map(|&i| normal.dot(at(i))).sum::<f64>() / polygon.len() as f64;
        self.planes.push(Plane { normal, offset });
        // Each edge belongs to two polygons that run along it in opposite directions: one of them takes it.
        let rising = sides.filter(|(i, j)| i < j).map(|(&i, &j)| [i, j]);
        self.edges.extend(rising);
        self.corners.extend(polygon);
        self.ends.push(self.corners.len() as u32);
    }

    /// Corners of the surface [m], own frame.
    pub fn vertices(&self) -> &[DVec3] {
        &self.vertices
    }

    /// Pairs of vertex indices, each edge once.
    pub fn edges(&self) -> &[[u32; 2]] {
        &self.edges
    }

    /// How many flat polygons the surface has.
    pub fn polygon_count(&self) -> usize {
        self.ends.len()
    }

    /// Vertex indices of each polygon, counter-clockwise as seen from outside.
    pub fn polygons(&self) -> impl Iterator<Item = &[u32]> {
        let starts = std::iter::once(0).chain(self.ends.iter().copied());
        let ranges = starts.zip(self.ends.iter().copied());
        ranges.map(|(start, end)| &self.corners[start as usize..end as usize])
    }

    /// Radius of the smallest ball about the origin that holds all vertices [m].
    pub fn bounding_radius(&self) -> f64 {
        self.radius
    }

    /// Whether a point [m, own frame] lies inside or on the surface: behind the plane of every polygon.
    pub fn contains(&self, point: DVec3) -> bool {
        self.planes.iter().all(|plane| plane.height(point) <= 0.0)
    }

    /// Whether a part of the segment from `p` to `q` [m, own frame] lies inside.
    ///
    /// The segment is cut by one plane after the other (Cyrus and Beck 1978) until nothing is left of it.
    pub fn meets_segment(&self, p: DVec3, q: DVec3) -> bool {
        let (mut from, mut to) = (0.0, 1.0);
        for plane in &self.planes {
            let (start, end) = (plane.height(p), plane.height(q));
            if start > 0.0 && end > 0.0 {
                return false;
            }
            if start > 0.0 {
                from = f64::max(from, start / (start - end));
            } else if end > 0.0 {
                to = f64::min(to, start / (start - end));
            }
            if from > to {
                return false;
            }
        }
        true
    }
}
