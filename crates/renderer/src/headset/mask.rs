//! What an eye's lens does not show of its picture, as the runtime tells it.

use openxr as xr;

use super::runtime::{Runtime, STEREO};
use crate::Fov;
use crate::passes::hidden::HiddenMesh;

/// The hidden part of one eye's picture.
pub(super) struct Mask {
    /// Three corners to a triangle, in the plane at distance one before the eye.
    corners: Vec<[f32; 2]>,
    /// As it is drawn, and the field of view that it is drawn for.
    drawn: Option<(Fov, HiddenMesh)>,
}

impl Mask {
    /// Of an eye; `None` where the runtime knows of none, or the whole picture is seen.
    pub fn of(runtime: &Runtime, session: &xr::Session<xr::Vulkan>, eye: usize) -> Option<Self> {
        if !runtime.enabled.khr_visibility_mask {
            return None;
        }
        let hidden = xr::VisibilityMaskTypeKHR::HIDDEN_TRIANGLE_MESH;
        // Without an answer the picture is drawn whole: the mask only saves work.
        let told = session
            .get_visibility_mask_khr(STEREO, eye as u32, hidden)
            .ok()?;
        let corners = corners(&told);
        (!corners.is_empty()).then_some(Self {
            corners,
            drawn: None,
        })
    }

    /// Lays it into a picture with this field of view, unless it lies there.
    pub fn fit(&mut self, device: &wgpu::Device, fov: Fov) {
        if self.drawn.as_ref().is_some_and(|(of, _)| *of == fov) {
            return;
        }
        let corners: Vec<_> = self.corners.iter().map(|at| clip(&fov, *at)).collect();
        self.drawn = Some((fov, HiddenMesh::new(device, &corners)));
    }

    /// As it lies in the picture that it was fitted to.
    pub fn mesh(&self) -> Option<&HiddenMesh> {
        self.drawn.as_ref().map(|(_, mesh)| mesh)
    }
}

/// The corners of whole triangles; one whose corner the runtime did not tell is left out.
fn corners(mask: &xr::VisibilityMask) -> Vec<[f32; 2]> {
    let corner = |index: &u32| mask.vertices.get(*index as usize).map(|at| [at.x, at.y]);
    let (triangles, _) = mask.indices.as_chunks::<3>();
    let whole = triangles.iter().filter_map(|[a, b, c]| {
        let [a, b, c] = [corner(a)?, corner(b)?, corner(c)?];
        let is_finite = [a, b, c]
            .as_flattened()
            .iter()
            .all(|number| number.is_finite());
        is_finite.then_some([a, b, c])
    });
    whole.flatten().collect()
}

/// Where a point of the plane at distance one falls in the picture: x to the right and y up, from -1 to 1.
fn clip(fov: &Fov, [x, y]: [f32; 2]) -> [f32; 2] {
    let between = |at: f32, from: f32, to: f32| {
        let (from, to) = (from.tan(), to.tan());
        (2.0 * at - (from + to)) / (to - from)
    };
    [
        between(x, fov.left, fov.right),
        between(y, fov.down, fov.up),
    ]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::View;
    use glam::{Quat, Vec3};

    /// An eye's own matrix and the mask's agree about a lopsided field of view.
    #[test]
    fn corners_fall_where_points_before_the_eye_do() {
        let fov = Fov {
            left: -0.9,
            right: 0.7,
            up: 0.6,
            down: -0.8,
        };
        let view = View {
            position: Vec3::ZERO,
            rotation: Quat::IDENTITY,
            fov,
        };
        for [x, y] in [[0.0, 0.0], [0.3, -0.5], [-1.26, 0.68]] {
            let seen = view.clip_from_world().project_point3(Vec3::new(x, y, -1.0));
            let [across, up] = clip(&fov, [x, y]);
            assert!((across - seen.x).abs() < 1e-5, "{across} {seen}");
            assert!((up - seen.y).abs() < 1e-5, "{up} {seen}");
        }
        let [left, top] = clip(&fov, [fov.left.tan(), fov.up.tan()]);
        assert!((left + 1.0).abs() < 1e-6 && (top - 1.0).abs() < 1e-6);
    }

    #[test]
    fn triangles_that_are_not_whole_are_left_out() {
        let vertices = [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0], [f32::NAN, 0.0]];
        let mask = |indices: &[u32]| xr::VisibilityMask {
            vertices: vertices.map(|[x, y]| xr::Vector2f { x, y }).to_vec(),
            indices: indices.to_vec(),
        };
        let whole = [[1.0, 0.0], [0.0, 0.0], [0.0, 1.0]];
        assert_eq!(corners(&mask(&[1, 0, 2])), whole);
        assert_eq!(
            corners(&mask(&[0, 1, 4, 1, 0, 2, 0, 1])),
            whole,
            "no such corner"
        );
        assert_eq!(corners(&mask(&[0, 1, 3])), [[0.0; 2]; 0], "no number");
        assert_eq!(corners(&mask(&[])), [[0.0; 2]; 0]);
    }
}
