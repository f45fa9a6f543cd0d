//! Triangle meshes: the data, simple shapes, and what must hold before one is drawn.

use bytemuck::{Pod, Zeroable};
use glam::{Vec2, Vec3};

use crate::RenderError;

/// A corner of a triangle, in the mesh's frame.
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub struct Vertex {
    /// Position [m].
    pub position: Vec3,
    /// Unit normal, away from the solid.
    pub normal: Vec3,
    /// Texture coordinates, v downwards from the upper edge of the image.
    pub uv: Vec2,
}

/// A triangle mesh; seen from outside, corners run counter-clockwise.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct MeshData {
    /// The corners.
    pub vertices: Vec<Vertex>,
    /// Three indices into `vertices` per triangle.
    pub indices: Vec<u32>,
}

impl MeshData {
    /// A rectangle in the x-y plane that faces +z, centred, `width` by `height` [m], the whole texture on it.
    pub fn quad(width: f32, height: f32) -> Self {
        let mut mesh = Self::default();
        mesh.add_face(Vec3::ZERO, Vec3::X * width, Vec3::Y * height, Vec3::Z);
        mesh
    }

    /// A box, centred, with the whole texture on each face; `size` is its edges [m].
    pub fn cuboid(size: Vec3) -> Self {
        let mut mesh = Self::default();
        let sides = [
            (Vec3::NEG_Z, Vec3::Y, Vec3::X),
            (Vec3::Z, Vec3::Y, Vec3::NEG_X),
            (Vec3::X, Vec3::NEG_Z, Vec3::Y),
            (Vec3::X, Vec3::Z, Vec3::NEG_Y),
            (Vec3::X, Vec3::Y, Vec3::Z),
            (Vec3::NEG_X, Vec3::Y, Vec3::NEG_Z),
        ];
        for (across, up, normal) in sides {
            mesh.add_face(0.5 * normal * size, across * size, up * size, normal);
        }
        mesh
    }

    /// A ball of `radius` [m] with its poles on y, in `slices` round and half as many stacks.
    pub fn sphere(radius: f32, slices: u32) -> Self {
        let slices = slices.max(3);
        let stacks = (slices / 2).max(2);
        let mut mesh = Self::default();
        for stack in 0..=stacks {
            let down = std::f32::consts::PI * stack as f32 / stacks as f32;
            for slice in 0..=slices {
                let round = std::f32::consts::TAU * slice as f32 / slices as f32;
                let normal = Vec3::new(
                    down.sin() * round.cos(),
                    down.cos(),
                    -down.sin() * round.sin(),
                );
                mesh.vertices.push(Vertex {
                    position: radius * normal,
                    normal,
                    uv: Vec2::new(slice as f32 / slices as f32, stack as f32 / stacks as f32),
                });
            }
        }
        let row = slices + 1;
        for stack in 0..stacks {
            for slice in 0..slices {
                let at = stack * row + slice;
                // At the poles one of the two triangles has no area.
                if stack > 0 {
                    mesh.indices.extend([at, at + row, at + 1]);
                }
                if stack + 1 < stacks {
                    mesh.indices.extend([at + 1, at + row, at + row + 1]);
                }
            }
        }
        mesh
    }

    /// Number of triangles.
    pub fn triangles(&self) -> usize {
        self.indices.len() / 3
    }

    /// `across` and `up` are whole edges, `across` x `up` points along `normal`.
    fn add_face(&mut self, centre: Vec3, across: Vec3, up: Vec3, normal: Vec3) {
        let first = self.vertices.len() as u32;
        for (u, v) in [(0.0, 1.0), (1.0, 1.0), (1.0, 0.0), (0.0, 0.0)] {
            self.vertices.push(Vertex {
                position: centre + (u - 0.5) * across + (0.5 - v) * up,
                normal,
                uv: Vec2::new(u, v),
            });
        }
        self.indices
            .extend([0, 1, 2, 0, 2, 3].map(|corner| first + corner));
    }

    /// Replaces every normal by the area-weighted mean over the triangles that share the corner.
    pub(crate) fn compute_normals(&mut self) {
        let mut sums = vec![Vec3::ZERO; self.vertices.len()];
        for corner in self.indices.chunks_exact(3) {
            let [a, b, c] = [corner[0], corner[1], corner[2]].map(|index| index as usize);
            let at = |index: usize| self.vertices[index].position;
            let twice_area = (at(b) - at(a)).cross(at(c) - at(a));
            for index in [a, b, c] {
                sums[index] += twice_area;
            }
        }
        for (vertex, sum) in self.vertices.iter_mut().zip(sums) {
            // A corner of triangles without area is never seen; any unit vector will do.
            vertex.normal = sum.try_normalize().unwrap_or(Vec3::Y);
        }
    }

    /// Checks what drawing relies on.
    pub(crate) fn check(&self) -> Result<(), RenderError> {
        let fail = |reason: String| Err(RenderError::Mesh(reason));
        if self.indices.is_empty() {
            return fail("it has no triangles".to_owned());
        }
        if !self.indices.len().is_multiple_of(3) {
            return fail(format!(
                "{} indices do not make whole triangles",
                self.indices.len()
            ));
        }
        let count = self.vertices.len();
        if let Some(index) = self.indices.iter().find(|&&index| index as usize >= count) {
            return fail(format!("index {index} is beyond its {count} vertices"));
        }
        let finite =
            |v: &Vertex| v.position.is_finite() && v.normal.is_finite() && v.uv.is_finite();
        if let Some(at) = self.vertices.iter().position(|vertex| !finite(vertex)) {
            return fail(format!("vertex {at} holds something that is not a number"));
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn faces_outwards(mesh: &MeshData) -> bool {
        mesh.indices.chunks_exact(3).all(|corner| {
            let [a, b, c] = [corner[0], corner[1], corner[2]].map(|i| mesh.vertices[i as usize]);
            let face = (b.position - a.position).cross(c.position - a.position);
            face.length() > 0.0 && face.dot(a.normal) > 0.0 && face.dot(b.normal) > 0.0
        })
    }

    #[test]
    fn shapes_face_outwards_and_are_drawable() {
        for mesh in [
            MeshData::quad(2.0, 1.0),
            MeshData::cuboid(Vec3::new(1.0, 2.0, 3.0)),
            MeshData::sphere(0.5, 12),
        ] {
            assert!(mesh.check().is_ok());
            assert!(faces_outwards(&mesh));
        }
        assert_eq!(MeshData::cuboid(Vec3::ONE).triangles(), 12);
    }

    #[test]
    fn cuboid_has_its_size() {
        let mesh = MeshData::cuboid(Vec3::new(1.0, 2.0, 3.0));
        let most = mesh
            .vertices
            .iter()
            .map(|v| v.position)
            .reduce(Vec3::max)
            .expect("a box has corners");
        assert_eq!(most, Vec3::new(0.5, 1.0, 1.5));
    }

    #[test]
    fn compute_normals_finds_those_of_a_sphere() {
        let exact = MeshData::sphere(1.0, 24);
        let mut mesh = exact.clone();
        mesh.compute_normals();
        // The seam's corners see one side only; the rest agree to a fraction of a facet.
        let agree = mesh
            .vertices
            .iter()
            .zip(&exact.vertices)
            .filter(|(a, b)| a.normal.dot(b.normal) > 0.99)
            .count();
        assert!(agree * 10 > mesh.vertices.len() * 9, "{agree}");
    }

    #[test]
    fn check_says_what_is_wrong() {
        let good = MeshData::quad(1.0, 1.0);
        let reason = |mesh: MeshData| mesh.check().expect_err("it is broken").to_string();
        assert!(reason(MeshData::default()).contains("no triangles"));
        let mut bad = good.clone();
        bad.indices[2] = 4;
        assert!(reason(bad).contains("index 4 is beyond its 4 vertices"));
        let mut bad = good.clone();
        bad.indices.pop();
        assert!(reason(bad).contains("whole triangles"));
        let mut bad = good;
        bad.vertices[3].normal.y = f32::NAN;
        assert!(reason(bad).contains("vertex 3"));
    }
}
