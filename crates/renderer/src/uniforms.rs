//! What the shaders read, laid out as WGSL lays it out. Names and order are those of the shaders' structs.

use bytemuck::{Pod, Zeroable};
use glam::{Mat3, Mat4, Vec3, Vec4};

use crate::View;
use crate::passes::shadow::LightFrame;
use crate::scene::{Instance, MAX_LAMPS, Occluder, Scene};

/// `Eye` in common.wgsl.
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
#[repr(C)]
pub(crate) struct EyeRaw {
    pub clip_from_world: Mat4,
    pub position: Vec4,
    pub mirror: Vec4,
}

impl EyeRaw {
    /// An eye whose picture has `size` pixels and its image in the floor `mirror_size`.
    pub fn of_view(view: &View, size: [u32; 2], mirror_size: [u32; 2]) -> Self {
        let fov = &view.fov;
        let pixels_per_unit = mirror_size[1] as f32 / (fov.up.tan() - fov.down.tan());
        Self {
            clip_from_world: view.clip_from_world(),
            position: view.position.extend(1.0),
            mirror: Vec4::new(
                1.0 / size[0] as f32,
                1.0 / size[1] as f32,
                pixels_per_unit,
                0.0,
            ),
        }
    }

    /// The same eye's mirror image below the plane y = 0: what it sees of the world is what the plane mirrors.
    pub fn mirrored(&self) -> Self {
        let flip = Vec3::new(1.0, -1.0, 1.0);
        Self {
            clip_from_world: self.clip_from_world * Mat4::from_scale(flip),
            position: self.position * flip.extend(1.0),
            mirror: self.mirror,
        }
    }
}

/// `Lamp` in lighting.wgsl.
#[derive(Clone, Copy, Debug, Default, Pod, Zeroable)]
#[repr(C)]
pub(crate) struct LampRaw {
    pub position: Vec3,
    pub range_m: f32,
    pub color: [f32; 3],
    pub padding: f32,
}

/// `Lighting` in lighting.wgsl.
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
#[repr(C)]
pub(crate) struct LightingRaw {
    pub light_clip_from_world: Mat4,
    pub light_position: Vec4,
    pub light_axis: Vec4,
    pub light_color: Vec4,
    pub sky: Vec4,
    pub ground: Vec4,
    pub room_min: Vec4,
    pub room_max: Vec4,
    pub shadow_step_uv: [f32; 2],
    pub shadow_reach_m: f32,
    pub lamp_count: u32,
    pub occluder_groups: u32,
    pub padding: [u32; 3],
    pub lamps: [LampRaw; MAX_LAMPS],
    pub groups: [Vec4; OCCLUDER_GROUPS],
    pub occluders: [Vec4; OCCLUDER_GROUPS * GROUP_SIZE],
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
        if let Some(room) = &scene.enclosure {
            raw.room_min = room.min.extend(room.reach_m);
            raw.room_max = room.max.extend(0.0);
        }
        raw.group(&scene.occluders);
        raw
    }

    /// Puts occluders that are near each other into one group, so that what is far from a group asks none of it.
    fn group(&mut self, occluders: &[Occluder]) {
        let mut groups: Vec<Vec<&Occluder>> = Vec::new();
        for occluder in occluders {
            let apart = |group: &[&Occluder]| group[0].position.distance(occluder.position);
            let nearest = (0..groups.len())
                .filter(|&index| groups[index].len() < GROUP_SIZE)
                .min_by(|&a, &b| apart(&groups[a]).total_cmp(&apart(&groups[b])));
            match nearest {
                Some(index)
                    if groups.len() == OCCLUDER_GROUPS || apart(&groups[index]) < GROUP_WIDTH_M =>
                {
                    groups[index].push(occluder);
                }
                _ => groups.push(vec![occluder]),
            }
        }
        self.occluder_groups = groups.len() as u32;
        for (index, group) in groups.iter().enumerate() {
            let middle = group.iter().map(|one| one.position).sum::<Vec3>() / group.len() as f32;
            let reach = group
                .iter()
                .map(|one| one.position.distance(middle) + FADED_AT * one.radius_m);
            self.groups[index] = middle.extend(reach.fold(0.0, f32::max));
            for (place, one) in group.iter().enumerate() {
                let at = index * GROUP_SIZE + place;
                self.occluders[at] = one.position.extend(one.radius_m);
            }
        }
    }
}

/// As in lighting.wgsl; more places than occluders, because groups are not all full.
const OCCLUDER_GROUPS: usize = 6;
const GROUP_SIZE: usize = 8;
/// Occluders nearer than this to the first of a group belong to it, while there is room [m].
const GROUP_WIDTH_M: f32 = 1.5;
/// At so many radii a sphere hides less than a hundredth of the sky, less than a picture can show where it fades.
const FADED_AT: f32 = 11.0;

/// `Picture` in present.wgsl.
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
#[repr(C)]
pub(crate) struct PictureRaw {
    pub rectangle: [f32; 4],
    pub encode: u32,
    pub padding: [u32; 3],
}

/// `Vignette` in vignette.wgsl.
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
#[repr(C)]
pub(crate) struct VignetteRaw {
    pub tangents: [f32; 4],
    pub clear: f32,
    pub dark: f32,
    pub strength: f32,
    pub padding: f32,
}

/// `InstanceInput` and `LookInput`: one instance as vertex attributes 3 to 11.
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
#[repr(C)]
pub(crate) struct InstanceRaw {
    /// Rows of the affine transform.
    pub world_from_mesh: [[f32; 4]; 3],
    /// Rows of the matrix for normals.
    pub normal_from_mesh: [[f32; 3]; 3],
    pub base_color: [f32; 4],
    pub surface: [f32; 4],
    pub mirror: f32,
}

impl InstanceRaw {
    pub const ATTRIBUTES: [wgpu::VertexAttribute; 9] = wgpu::vertex_attr_array![
        3 => Float32x4, 4 => Float32x4, 5 => Float32x4,
        6 => Float32x3, 7 => Float32x3, 8 => Float32x3,
        9 => Float32x4, 10 => Float32x4, 11 => Float32
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
            mirror: material.mirror,
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
    fn every_occluder_has_a_place_in_a_group_that_reaches_it() {
        let occluders: Vec<Occluder> = (0..crate::MAX_OCCLUDERS)
            .map(|i| Occluder {
                position: Vec3::new(0.2 * (i % 5) as f32, 0.1, -0.9 * i as f32),
                radius_m: 0.05 + 0.001 * i as f32,
            })
            .collect();
        let mut raw: LightingRaw = Zeroable::zeroed();
        raw.group(&occluders);
        let mut found = 0;
        for group in 0..raw.occluder_groups as usize {
            let bounds = raw.groups[group];
            for sphere in &raw.occluders[group * GROUP_SIZE..(group + 1) * GROUP_SIZE] {
                if sphere.w > 0.0 {
                    found += 1;
                    let away = bounds.truncate().distance(sphere.truncate());
                    assert!(away + FADED_AT * sphere.w <= bounds.w * 1.0001, "{away}");
                }
            }
        }
        assert_eq!(found, occluders.len());
    }

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
