//! What the shaders read, laid out as WGSL lays it out. Names and order are those of the shaders' structs.

use bytemuck::{Pod, Zeroable};
use glam::{Mat3, Mat4, Vec3, Vec4};

use crate::passes::shadow::LightFrame;
use crate::scene::{Instance, MAX_LAMPS, Scene};

/// `Eye` in common.wgsl.
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
#[repr(C)]
pub(crate) struct EyeRaw {
    pub clip_from_world: Mat4,
    pub position: Vec4,
}

/// `Lamp` in lit.wgsl.
#[derive(Clone, Copy, Debug, Default, Pod, Zeroable)]
#[repr(C)]
pub(crate) struct LampRaw {
    pub position: Vec3,
    pub range_m: f32,
    pub color: [f32; 3],
    pub padding: f32,
}

/// `Lighting` in lit.wgsl.
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
#[repr(C)]
pub(crate) struct LightingRaw {
    pub light_clip_from_world: Mat4,
    pub light_position: Vec4,
    pub light_axis: Vec4,
    pub light_color: Vec4,
    pub sky: Vec4,
    pub ground: Vec4,
    pub shadow_step_uv: [f32; 2],
    pub shadow_reach_m: f32,
    pub lamp_count: u32,
    pub lamps: [LampRaw; MAX_LAMPS],
}

impl LightingRaw {
    /// Light of a scene: the shadowing one as `light` frames it, and the lamps.
    pub fn new(
        scene: &Scene,
        light: Option<&LightFrame>,
        shadow_map_size: Option<[u32; 2]>,
    ) -> Self {
        let mut raw: Self = Zeroable::zeroed();
        // Without a light its colour is black, and any direction will do.
        raw.light_position = Vec4::Y;
        raw.sky = Vec3::from(scene.sky).extend(0.0);
        raw.ground = Vec3::from(scene.ground).extend(0.0);
        if let (Some(frame), Some(light)) = (light, &scene.light) {
            raw.light_clip_from_world = frame.clip_from_world;
            raw.light_position = frame.position;
            raw.light_axis = frame.axis;
            raw.light_color = Vec3::from(light.color).extend(frame.inner_cosine);
            if let Some(size) = shadow_map_size {
                (raw.shadow_step_uv, raw.shadow_reach_m) = frame.filter(light.softness_m, size);
            }
        }
        raw.lamp_count = scene.lamps.len() as u32;
        for (raw, lamp) in raw.lamps.iter_mut().zip(&scene.lamps) {
            *raw = LampRaw {
                position: lamp.position,
                range_m: lamp.range_m,
                color: lamp.color,
                padding: 0.0,
            };
        }
        raw
    }
}

/// `Picture` in present.wgsl.
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
#[repr(C)]
pub(crate) struct PictureRaw {
    pub rectangle: [f32; 4],
    pub encode: u32,
    pub padding: [u32; 3],
}

/// `InstanceInput` and `LookInput`: one instance as vertex attributes 3 to 10.
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
#[repr(C)]
pub(crate) struct InstanceRaw {
    /// Rows of the affine transform.
    pub world_from_mesh: [[f32; 4]; 3],
    /// Rows of the matrix for normals.
    pub normal_from_mesh: [[f32; 3]; 3],
    pub base_color: [f32; 4],
    pub surface: [f32; 4],
}

impl InstanceRaw {
    pub const ATTRIBUTES: [wgpu::VertexAttribute; 8] = wgpu::vertex_attr_array![
        3 => Float32x4, 4 => Float32x4, 5 => Float32x4,
        6 => Float32x3, 7 => Float32x3, 8 => Float32x3,
        9 => Float32x4, 10 => Float32x4
    ];

    pub fn new(instance: &Instance) -> Self {
        let rows = instance.world_from_mesh.transpose().to_cols_array_2d();
        let material = &instance.material;
        let [r, g, b] = material.base_color;
        let [repeat_u, repeat_v] = material.texture_repeat;
        Self {
            world_from_mesh: [rows[0], rows[1], rows[2]],
            normal_from_mesh: normal_matrix(&instance.world_from_mesh)
                .transpose()
                .to_cols_array_2d(),
            base_color: [r, g, b, material.roughness.clamp(MIN_ROUGHNESS, 1.0)],
            surface: [material.specular, material.emission, repeat_u, repeat_v],
        }
    }
}

/// Below it the highlight of a light without size would fit between two pixels and sparkle.
const MIN_ROUGHNESS: f32 = 0.05;

/// Cofactors of the linear part: the inverse transpose up to a positive factor, and no division.
fn normal_matrix(world_from_mesh: &Mat4) -> Mat3 {
    let m = Mat3::from_mat4(*world_from_mesh);
    Mat3::from_cols(
        m.y_axis.cross(m.z_axis),
        m.z_axis.cross(m.x_axis),
        m.x_axis.cross(m.y_axis),
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn normal_matrix_keeps_normals_square_to_the_surface() {
        let squash = Mat4::from_scale(Vec3::new(1.0, 0.25, 2.0)) * Mat4::from_rotation_x(0.4);
        let (along, normal) = (Vec3::new(1.0, 2.0, 0.0), Vec3::new(2.0, -1.0, 0.0));
        let along = squash.transform_vector3(along);
        let normal = normal_matrix(&squash) * normal;
        assert!(along.dot(normal).abs() < 1e-5);
        assert!(normal.length() > 0.1);
    }
}
