//! Triangle meshes: the few builders that the alley needs, their OBJ text, and what the renderer takes.

use std::fmt::Write;

use glam::{Affine3A, Mat3, Vec2, Vec3};
use renderer::MeshData;

/// One corner of a triangle: place [m], unit normal, texture coordinate (0,0 at the image's lower left).
#[derive(Clone, Copy, Debug)]
pub struct Vertex {
    /// Place in the mesh's frame [m].
    pub position: Vec3,
    /// Unit normal, away from the solid.
    pub normal: Vec3,
    /// Texture coordinates, v upwards from the image's lower edge.
    pub uv: Vec2,
}

/// Triangles over shared vertices, counter-clockwise from outside.
#[derive(Clone, Debug, Default)]
pub struct Mesh {
    /// The corners.
    pub vertices: Vec<Vertex>,
    /// Three indices into `vertices` each.
    pub triangles: Vec<[u32; 3]>,
}

impl Mesh {
    /// Adds `other`, moved by `self_from_other`.
    pub fn append(&mut self, other: &Mesh, self_from_other: Affine3A) {
        let base = self.vertices.len() as u32;
        let normals = Mat3::from(self_from_other.matrix3).inverse().transpose();
        // A mirror turns triangles inside out.
        let mirrored = normals.determinant() < 0.0;
        self.vertices.extend(other.vertices.iter().map(|v| Vertex {
            position: self_from_other.transform_point3(v.position),
            normal: (normals * v.normal).normalize_or(Vec3::Y),
            uv: v.uv,
        }));
        self.triangles
            .extend(other.triangles.iter().map(|&[a, b, c]| {
                let [b, c] = if mirrored { [c, b] } else { [b, c] };
                [base + a, base + b, base + c]
            }));
    }

    /// Adds the flat four-sided face `corners`, counter-clockwise from outside, its texture running from corner 0
    /// along 0-1 (u) and 0-3 (v).
    pub fn quad(&mut self, corners: [Vec3; 4], uv: [Vec2; 2]) {
        let [a, b, c, d] = corners;
        let normal = (b - a).cross(d - a).normalize_or(Vec3::Y);
        let base = self.vertices.len() as u32;
        let [low, high] = uv;
        let uvs = [
            low,
            Vec2::new(high.x, low.y),
            high,
            Vec2::new(low.x, high.y),
        ];
        self.vertices.extend(
            [a, b, c, d]
                .into_iter()
                .zip(uvs)
                .map(|(position, uv)| Vertex {
                    position,
                    normal,
                    uv,
                }),
        );
        self.triangles
            .extend([[base, base + 1, base + 2], [base, base + 2, base + 3]]);
    }

    /// Its mirror image across the plane x = 0.
    pub fn mirrored(&self) -> Self {
        let mut image = Self::default();
        image.append(self, Affine3A::from_scale(Vec3::new(-1.0, 1.0, 1.0)));
        image
    }

    /// The same for the renderer, whose images run downwards.
    pub fn to_data(&self) -> MeshData {
        let vertices = self.vertices.iter().map(|v| renderer::Vertex {
            position: v.position,
            normal: v.normal,
            uv: Vec2::new(v.uv.x, 1.0 - v.uv.y),
        });
        MeshData {
            vertices: vertices.collect(),
            indices: self.triangles.iter().flatten().copied().collect(),
        }
    }

    /// Wavefront OBJ with six decimals: a micrometre, far below what can be seen.
    pub fn to_obj(&self, title: &str) -> String {
        let mut text = format!("# {title}\n# Made by make-assets; do not edit.\n");
        let mut line = |args: std::fmt::Arguments| {
            text.write_fmt(args)
                .expect("writing to a string cannot fail");
        };
        for v in &self.vertices {
            let p = v.position;
            line(format_args!(
                "v {:.6} {:.6} {:.6}\n",
                tidy(p.x),
                tidy(p.y),
                tidy(p.z)
            ));
        }
        for v in &self.vertices {
            line(format_args!("vt {:.6} {:.6}\n", tidy(v.uv.x), tidy(v.uv.y)));
        }
        for v in &self.vertices {
            let n = v.normal;
            line(format_args!(
                "vn {:.4} {:.4} {:.4}\n",
                tidy(n.x),
                tidy(n.y),
                tidy(n.z)
            ));
        }
        for t in &self.triangles {
            let [a, b, c] = t.map(|i| i + 1);
            line(format_args!("f {a}/{a}/{a} {b}/{b}/{b} {c}/{c}/{c}\n"));
        }
        text
    }
}

/// No "-0.000000", which would make equal meshes differ as text.
fn tidy(x: f32) -> f32 {
    if x.abs() < 5e-7 { 0.0 } else { x }
}

/// A box with the given half extents, one texture image per face.
pub fn cuboid(half: Vec3) -> Mesh {
    let mut mesh = Mesh::default();
    for axis in 0..3 {
        for sign in [-1.0, 1.0] {
            let (u, v) = ((axis + 1) % 3, (axis + 2) % 3);
            let corner = |su: f32, sv: f32| {
                let mut p = Vec3::ZERO;
                p[axis] = sign * half[axis];
                p[u] = su * sign * half[u];
                p[v] = sv * half[v];
                p
            };
            let corners = [
                corner(-1.0, -1.0),
                corner(1.0, -1.0),
                corner(1.0, 1.0),
                corner(-1.0, 1.0),
            ];
            mesh.quad(corners, [Vec2::ZERO, Vec2::ONE]);
        }
    }
    mesh
}

/// A surface of revolution about y through `profile` (radius, height), from bottom to top. Neighbouring pieces share a
/// smooth normal unless they meet at more than `crease` radians. u runs around the axis, v along the height.
pub fn lathe(profile: &[(f32, f32)], segments: u32, crease: f32) -> Mesh {
    let mut mesh = Mesh::default();
    let (low, high) = (profile[0].1, profile[profile.len() - 1].1);
    let v_of = |y: f32| {
        if high > low {
            (y - low) / (high - low)
        } else {
            0.0
        }
    };
    // Outward normal, in the (radius, height) plane, of the piece from i to i + 1.
    let piece = |i: usize| {
        let d = Vec2::new(
            profile[i + 1].0 - profile[i].0,
            profile[i + 1].1 - profile[i].1,
        );
        Vec2::new(d.y, -d.x).normalize_or(Vec2::X)
    };
    let pieces = profile.len() - 1;
    for i in 0..pieces {
        let here = piece(i);
        let blend = |other: Option<Vec2>| match other {
            Some(o) if here.dot(o) > crease.cos() => (here + o).normalize_or(here),
            _ => here,
        };
        let ends = [
            blend(i.checked_sub(1).map(piece)),
            blend((i + 1 < pieces).then(|| piece(i + 1))),
        ];
        let base = mesh.vertices.len() as u32;
        for (end, normal) in ends.into_iter().enumerate() {
            let (radius, height) = profile[i + end];
            for s in 0..=segments {
                let u = s as f32 / segments as f32;
                // glam's sine, not the system's: the same digits wherever the meshes are made.
                let Vec2 { x: cos, y: sin } = Vec2::from_angle(u * std::f32::consts::TAU);
                mesh.vertices.push(Vertex {
                    position: Vec3::new(radius * cos, height, -radius * sin),
                    normal: Vec3::new(normal.x * cos, normal.y, -normal.x * sin),
                    uv: Vec2::new(u, v_of(height)),
                });
            }
        }
        let row = segments + 1;
        for s in 0..segments {
            let (a, b, c, d) = (base + s, base + s + 1, base + row + s + 1, base + row + s);
            if profile[i].0 > 0.0 {
                mesh.triangles.push([a, b, c]);
            }
            if profile[i + 1].0 > 0.0 {
                mesh.triangles.push([a, c, d]);
            }
        }
    }
    mesh
}

/// A sphere of the given radius about the origin.
pub fn sphere(radius: f32, segments: u32, rings: u32) -> Mesh {
    let profile: Vec<_> = (0..=rings)
        .map(|i| {
            let Vec2 { x: cos, y: sin } =
                Vec2::from_angle(std::f32::consts::PI * i as f32 / rings as f32);
            // Exact poles: the lathe leaves out triangles that shrink to nothing there.
            let r = if i == 0 || i == rings {
                0.0
            } else {
                radius * sin
            };
            (r, -radius * cos)
        })
        .collect();
    lathe(&profile, segments, std::f32::consts::PI)
}

/// A capsule along y: cylinder of `half_height` with round ends on top of it.
///
/// `segments` run around the axis and half as many from pole to pole.
pub fn capsule(radius: f32, half_height: f32, segments: u32) -> Mesh {
    let quarter = segments / 4;
    let arc = |i: u32| Vec2::from_angle(std::f32::consts::FRAC_PI_2 * i as f32 / quarter as f32);
    let mut profile = Vec::new();
    for i in 0..=quarter {
        let Vec2 { x: cos, y: sin } = arc(i);
        profile.push((
            if i == 0 { 0.0 } else { radius * sin },
            -half_height - radius * cos,
        ));
    }
    for i in (0..=quarter).rev() {
        let Vec2 { x: cos, y: sin } = arc(i);
        profile.push((
            if i == 0 { 0.0 } else { radius * sin },
            half_height + radius * cos,
        ));
    }
    lathe(&profile, segments, std::f32::consts::PI)
}

/// A closed cylinder along y, resting on y = 0, with a small bevel that catches the light.
pub fn drum(radius: f32, height: f32, segments: u32) -> Mesh {
    let bevel = 0.08 * radius.min(height);
    let profile = [
        (0.0, 0.0),
        (radius, 0.0),
        (radius, height - bevel),
        (radius - bevel, height),
        (0.0, height),
    ];
    lathe(&profile, segments, 0.3)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Signed volume by the divergence theorem: positive only when every triangle faces outward.
    fn volume(mesh: &Mesh) -> f32 {
        let p = |i: u32| mesh.vertices[i as usize].position;
        mesh.triangles
            .iter()
            .map(|&[a, b, c]| p(a).cross(p(b)).dot(p(c)) / 6.0)
            .sum()
    }

    #[test]
    fn builders_face_outward_and_enclose_their_volume() {
        let close = |mesh: Mesh, expected: f32| {
            let got = volume(&mesh);
            assert!(
                (got / expected - 1.0).abs() < 0.03,
                "volume {got}, expected {expected}"
            );
        };
        close(cuboid(Vec3::new(0.5, 1.0, 1.5)), 6.0);
        close(sphere(1.0, 48, 24), std::f32::consts::PI * 4.0 / 3.0);
        close(
            capsule(0.5, 1.0, 48),
            (0.5 + 1.0 / 6.0) * std::f32::consts::PI,
        );
        close(drum(1.0, 0.5, 64), std::f32::consts::PI * 0.5);
    }

    #[test]
    fn append_keeps_a_mirrored_part_facing_outward() {
        let mut mesh = Mesh::default();
        mesh.append(
            &cuboid(Vec3::ONE),
            Affine3A::from_scale(Vec3::new(-1.0, 1.0, 1.0)),
        );
        assert!((volume(&mesh) - 8.0).abs() < 1e-4);
        assert!(mesh.vertices.iter().all(|v| v.normal.dot(v.position) > 0.0));
    }

    #[test]
    fn lathe_normals_agree_with_the_triangles() {
        let mesh = sphere(1.0, 16, 8);
        for v in &mesh.vertices {
            assert!(
                v.normal.dot(v.position) > 0.95,
                "{:?} at {:?}",
                v.normal,
                v.position
            );
        }
    }
}
