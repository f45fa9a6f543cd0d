//! Depth of the scene from the shadowing light, and the light's own geometry.

use glam::camera::rh::proj::directx;
use glam::{Mat3, Mat4, Vec3, Vec4};

use super::{Batch, DEPTH_FORMAT, GpuMesh};
use crate::scene::{Light, LightSource};
use crate::{RenderError, shaders, texture};

/// Taps of the filter along a side, `SHADOW_TAPS` in shadow_filter.wgsl.
const TAPS: f32 = 3.0;

/// Nearest depth that a spot light's shadow map holds [m].
const SPOT_NEAR_M: f32 = 0.1;

/// Where a light stands, what its shadow map covers and how it is filtered.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct LightFrame {
    pub clip_from_world: Mat4,
    /// As in `Lighting`: direction towards a parallel light (w = 0) or position (w = 1).
    pub position: Vec4,
    /// Unit axis of a spot light; w = cosine of the outer half angle.
    pub axis: Vec4,
    /// Cosine of a spot light's inner half angle.
    pub inner_cosine: f32,
    /// What the map covers across and up [m], at 1 m for a spot light.
    pub extent: [f32; 2],
}

impl LightFrame {
    pub fn new(light: &Light) -> Result<Self, RenderError> {
        match light.source {
            LightSource::Directional {
                direction,
                shadow_min,
                shadow_max,
            } => Self::directional(unit(direction)?, shadow_min, shadow_max),
            LightSource::Spot {
                position,
                direction,
                inner,
                outer,
                range_m,
            } => Self::spot(position, unit(direction)?, inner, outer, range_m),
        }
    }

    fn directional(direction: Vec3, min: Vec3, max: Vec3) -> Result<Self, RenderError> {
        let size = max - min;
        if !(size.is_finite() && size.min_element() > 0.0) {
            return Err(RenderError::Scene(
                "the box of the light's shadows has no volume".to_owned(),
            ));
        }
        // The map's rows lie along the longest side of the box, so that a long lane fills a long map.
        let mut axes = [(size.x, Vec3::X), (size.y, Vec3::Y), (size.z, Vec3::Z)];
        axes.sort_by(|a, b| b.0.total_cmp(&a.0));
        let up = axes
            .into_iter()
            .map(|(_, axis)| axis.reject_from_normalized(direction))
            .find(|up| up.length() > 0.2)
            .and_then(Vec3::try_normalize)
            .expect("three axes cannot all be parallel to one direction");
        let light_from_world = Mat4::from_mat3(basis(direction, up).transpose());
        let corners = (0..8).map(|i| {
            let pick = |bit: u32, a: f32, b: f32| if i >> bit & 1 == 0 { a } else { b };
            light_from_world.transform_point3(Vec3::new(
                pick(0, min.x, max.x),
                pick(1, min.y, max.y),
                pick(2, min.z, max.z),
            ))
        });
        let (low, high) = corners.fold(
            (Vec3::INFINITY, Vec3::NEG_INFINITY),
            |(low, high), corner| (low.min(corner), high.max(corner)),
        );
        let clip_from_light = directx::orthographic(low.x, high.x, low.y, high.y, -high.z, -low.z);
        Ok(Self {
            clip_from_world: clip_from_light * light_from_world,
            position: (-direction).extend(0.0),
            axis: Vec4::ZERO,
            inner_cosine: 0.0,
            extent: [high.x - low.x, high.y - low.y],
        })
    }

    fn spot(
        position: Vec3,
        direction: Vec3,
        inner: f32,
        outer: f32,
        range_m: f32,
    ) -> Result<Self, RenderError> {
        let in_order = 0.0 <= inner && inner < outer && outer < 1.4;
        let reaches = range_m.is_finite() && range_m > SPOT_NEAR_M;
        if !(in_order && reaches && position.is_finite()) {
            return Err(RenderError::Scene(format!(
                "a spot light needs a position, 0 <= inner < outer < 1.4 rad and a range above {SPOT_NEAR_M} m"
            )));
        }
        let up = direction.any_orthonormal_vector();
        let light_from_world =
            Mat4::from_mat3(basis(direction, up).transpose()) * Mat4::from_translation(-position);
        let across = 2.0 * outer.tan();
        Ok(Self {
            clip_from_world: directx::perspective(2.0 * outer, 1.0, SPOT_NEAR_M, range_m)
                * light_from_world,
            position: position.extend(1.0),
            axis: direction.extend(outer.cos()),
            inner_cosine: inner.cos(),
            extent: [across, across],
        })
    }

    /// Size of the shadow map: `size` x `size` texels in all, shaped so that a texel is about square.
    fn map_size(&self, size: u32, most: u32) -> [u32; 2] {
        let stretch = (self.extent[0] / self.extent[1]).sqrt();
        [stretch, 1.0 / stretch].map(|factor| {
            let side = (size as f32 * factor).round() as u32;
            side.next_multiple_of(16).clamp(16, most)
        })
    }

    /// Step between two taps in texture coordinates, and half the width of the whole filter [m].
    pub fn filter(&self, softness_m: f32, map_size: [u32; 2]) -> ([f32; 2], f32) {
        let texel = (self.extent[0] / map_size[0] as f32).max(self.extent[1] / map_size[1] as f32);
        // More than two texels between taps would show as bands.
        let step = (2.0 * softness_m / TAPS).clamp(0.5 * texel, 2.0 * texel);
        let reach = 0.5 * (TAPS - 1.0) * step + texel;
        (self.extent.map(|extent| step / extent), reach)
    }
}

fn unit(direction: Vec3) -> Result<Vec3, RenderError> {
    direction
        .try_normalize()
        .ok_or_else(|| RenderError::Scene("the light has no direction".to_owned()))
}

/// Axes of a light that shines along `direction`: x right, y up, z back, like an eye's.
fn basis(direction: Vec3, up: Vec3) -> Mat3 {
    Mat3::from_cols(direction.cross(up), up, -direction)
}

/// The shadow map.
#[derive(Debug)]
pub(crate) struct ShadowMap {
    pub view: wgpu::TextureView,
    pub size: [u32; 2],
}

impl ShadowMap {
    fn new(device: &wgpu::Device, size: [u32; 2]) -> Self {
        let usage = wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::TEXTURE_BINDING;
        let texture = texture::single(device, "shadow map", size, 1, DEPTH_FORMAT, usage);
        Self {
            view: texture.create_view(&Default::default()),
            size,
        }
    }
}

/// Draws the shadow map.
#[derive(Debug)]
pub(crate) struct ShadowPass {
    pipeline: wgpu::RenderPipeline,
    bind_group: wgpu::BindGroup,
    pub map: ShadowMap,
}

impl ShadowPass {
    pub fn new(device: &wgpu::Device, eyes: &wgpu::Buffer, size: u32, frame: &LightFrame) -> Self {
        let layout = device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
            label: Some("shadow"),
            entries: &[super::eye_layout_entry(wgpu::ShaderStages::VERTEX)],
        });
        let bind_group = device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("shadow"),
            layout: &layout,
            entries: &[super::eye_entry(eyes)],
        });
        let module = super::shader(device, "shadow", shaders::SHADOW);
        let pipeline_layout = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
            label: Some("shadow"),
            bind_group_layouts: &[Some(&layout)],
            immediate_size: 0,
        });
        let pipeline = device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
            label: Some("shadow"),
            layout: Some(&pipeline_layout),
            vertex: wgpu::VertexState {
                module: &module,
                entry_point: Some("vertex"),
                compilation_options: Default::default(),
                buffers: &super::vertex_buffers(),
            },
            // Both sides cast, so that a flat screen or a thin sheet has a shadow from either side.
            primitive: wgpu::PrimitiveState::default(),
            depth_stencil: Some(super::depth_state()),
            multisample: wgpu::MultisampleState::default(),
            fragment: None,
            multiview_mask: None,
            cache: None,
        });
        let most = device.limits().max_texture_dimension_2d;
        Self {
            pipeline,
            bind_group,
            map: ShadowMap::new(device, frame.map_size(size, most)),
        }
    }

    /// Makes the map fit the light; `true` if it is another map now.
    pub fn fit(&mut self, device: &wgpu::Device, size: u32, frame: &LightFrame) -> bool {
        let wanted = frame.map_size(size, device.limits().max_texture_dimension_2d);
        let differs = wanted != self.map.size;
        if differs {
            self.map = ShadowMap::new(device, wanted);
        }
        differs
    }

    pub fn record(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        eye_offset: u32,
        instances: &wgpu::Buffer,
        batches: &[Batch],
        meshes: &[GpuMesh],
    ) {
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("shadow"),
            depth_stencil_attachment: Some(super::depth_attachment(
                &self.map.view,
                wgpu::StoreOp::Store,
            )),
            ..Default::default()
        });
        pass.set_pipeline(&self.pipeline);
        pass.set_bind_group(0, &self.bind_group, &[eye_offset]);
        pass.set_vertex_buffer(1, instances.slice(..));
        for batch in batches.iter().filter(|batch| batch.casts_shadows) {
            super::blurred(meshes, batch).draw(&mut pass, batch);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sun(direction: Vec3) -> Light {
        Light {
            source: LightSource::Directional {
                direction,
                shadow_min: Vec3::new(-1.0, 0.0, -20.0),
                shadow_max: Vec3::new(1.0, 3.0, 4.0),
            },
            color: [1.0; 3],
            softness_m: 0.01,
        }
    }

    #[test]
    fn directional_map_holds_the_whole_box() {
        for direction in [
            Vec3::NEG_Y,
            Vec3::new(0.3, -1.0, -0.4),
            Vec3::NEG_Z,
            Vec3::X,
        ] {
            let frame = LightFrame::new(&sun(direction)).expect("a good light");
            for i in 0..8 {
                let corner = Vec3::new(
                    if i & 1 == 0 { -1.0 } else { 1.0 },
                    if i & 2 == 0 { 0.0 } else { 3.0 },
                    if i & 4 == 0 { -20.0 } else { 4.0 },
                );
                let clip = frame.clip_from_world * corner.extend(1.0);
                assert!(clip.x.abs() <= 1.0001 && clip.y.abs() <= 1.0001, "{clip}");
                assert!((-1e-4..=1.0001).contains(&clip.z), "{clip}");
            }
        }
    }

    #[test]
    fn directional_depth_grows_along_the_light() {
        let frame = LightFrame::new(&sun(Vec3::new(0.2, -1.0, 0.1))).expect("a good light");
        let depth = |y: f32| (frame.clip_from_world * Vec3::new(0.0, y, 0.0).extend(1.0)).z;
        assert!(depth(2.0) < depth(0.5));
    }

    #[test]
    fn map_is_long_where_the_box_is_long_and_keeps_its_area() {
        let frame = LightFrame::new(&sun(Vec3::NEG_Y)).expect("a good light");
        let [width, height] = frame.map_size(2048, 16384);
        assert!(height > 8 * width, "{width} x {height}");
        let area = f64::from(width) * f64::from(height);
        assert!((area / (2048.0 * 2048.0) - 1.0).abs() < 0.05, "{area}");
        assert_eq!(frame.map_size(2048, 4096)[1], 4096);
    }

    #[test]
    fn spot_covers_its_cone() {
        let light = Light {
            source: LightSource::Spot {
                position: Vec3::new(0.0, 3.0, 0.0),
                direction: Vec3::NEG_Y,
                inner: 0.3,
                outer: 0.5,
                range_m: 5.0,
            },
            ..sun(Vec3::X)
        };
        let frame = LightFrame::new(&light).expect("a good light");
        let rim = Vec3::new(3.0 * 0.5_f32.tan() * 0.6, 0.0, 3.0 * 0.5_f32.tan() * 0.8);
        let clip = frame.clip_from_world * rim.extend(1.0);
        let radius = (clip.truncate() / clip.w).truncate().length();
        assert!((radius - 1.0).abs() < 1e-4, "{radius}");
        assert!((clip.w - 3.0).abs() < 1e-5, "clip w is the distance");
    }

    #[test]
    fn bad_lights_are_refused() {
        assert!(LightFrame::new(&sun(Vec3::ZERO)).is_err());
        let flat = Light {
            source: LightSource::Directional {
                direction: Vec3::NEG_Y,
                shadow_min: Vec3::ZERO,
                shadow_max: Vec3::new(1.0, 0.0, 1.0),
            },
            ..sun(Vec3::X)
        };
        assert!(LightFrame::new(&flat).is_err());
    }
}
