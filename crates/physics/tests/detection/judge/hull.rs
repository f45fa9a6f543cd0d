//! Convex hull of a vertex cloud in general position, by gift wrapping.

use glam::DVec3;

/// A triangle of the hull.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Face {
    /// Its corners, counter-clockwise from outside, as indices of points.
    pub corners: [usize; 3],
    /// Outward unit normal.
    pub normal: DVec3,
}

/// Points and the triangles of their hull.
#[derive(Clone, Debug, PartialEq)]
pub struct Hull {
    /// All points [m].
    pub points: Vec<DVec3>,
    /// The triangles; none if all points lie in a plane.
    pub faces: Vec<Face>,
}

impl Hull {
    /// The hull of points of which no four lie in a plane; of fewer than four, or of flat ones, only the points.
    pub fn new(points: Vec<DVec3>) -> Hull {
        let faces = wrap(&points);
        Hull { points, faces }
    }

    /// How far `p` lies outside the farthest plane [m]; not positive inside.
    pub fn beyond(&self, p: DVec3) -> f64 {
        let over = |face: &Face| face.normal.dot(p - self.points[face.corners[0]]);
        self.faces
            .iter()
            .map(over)
            .fold(f64::NEG_INFINITY, f64::max)
    }

    /// Radius of the largest ball about the origin inside [m].
    pub fn inside_radius(&self) -> f64 {
        let offset = |face: &Face| face.normal.dot(self.points[face.corners[0]]);
        self.faces.iter().map(offset).fold(f64::INFINITY, f64::min)
    }

    /// The face on the other side of the edge from corner `i` to the next of `face`.
    pub fn neighbour(&self, face: &Face, i: usize) -> Option<&Face> {
        let (from, to) = (face.corners[i], face.corners[(i + 1) % 3]);
        self.faces.iter().find(|other| {
            (0..3).any(|k| other.corners[k] == to && other.corners[(k + 1) % 3] == from)
        })
    }
}

/// The triangle whose plane has every other point behind it, among those over the edge from `i` to `j`.
fn over_edge(points: &[DVec3], i: usize, j: usize) -> Option<Face> {
    let edge = points[j] - points[i];
    let mut best: Option<(usize, DVec3)> = None;
    for (k, p) in points.iter().enumerate() {
        if k == i || k == j {
            continue;
        }
        if best.is_none_or(|(_, normal)| normal.dot(p - points[i]) > 0.0) {
            best = Some((k, edge.cross(p - points[i])));
        }
    }
    let (k, normal) = best?;
    Some(Face {
        corners: [i, j, k],
        normal: normal.try_normalize()?,
    })
}

fn is_flat(points: &[DVec3], face: &Face) -> bool {
    let origin = points[face.corners[0]];
    let size = points
        .iter()
        .map(|p| p.distance(origin))
        .fold(0.0, f64::max);
    let off = |p: &DVec3| face.normal.dot(p - origin).abs();
    points.iter().all(|p| off(p) <= 1e-12 * size)
}

fn wrap(points: &[DVec3]) -> Vec<Face> {
    let Some(first) = first_face(points) else {
        return Vec::new();
    };
    let (mut faces, mut next) = (vec![first], 0);
    while next < faces.len() && faces.len() < 2 * points.len() {
        let [a, b, c] = faces[next].corners;
        next += 1;
        for (from, to) in [(b, a), (c, b), (a, c)] {
            let known = faces.iter().any(|face| {
                (0..3).any(|k| face.corners[k] == from && face.corners[(k + 1) % 3] == to)
            });
            if !known && let Some(face) = over_edge(points, from, to) {
                faces.push(face);
            }
        }
    }
    faces
}

/// A face at the extreme point along x: of all edges from there, one that has all points on one side.
fn first_face(points: &[DVec3]) -> Option<Face> {
    let extreme = (0..points.len()).max_by(|i, j| points[*i].x.total_cmp(&points[*j].x))?;
    (0..points.len())
        .filter(|j| *j != extreme)
        .filter_map(|j| over_edge(points, extreme, j))
        .find(|face| {
            let over = |p: &DVec3| face.normal.dot(p - points[extreme]);
            points.iter().all(|p| over(p) <= 1e-13) && !is_flat(points, face)
        })
}
