//! Lit surfaces, one pass per eye, into a single-layer target.
//!
//! Debian 12's lavapipe resolves every multisampled layer into the first, and loses geometry with multiview
//! (Mesa 22.3.6); a pass of its own per eye is right on every driver.

use super::{Batch, DEPTH_FORMAT, GpuMesh};
use crate::shaders;
use crate::texture::{self, Texture};
use crate::uniforms::LightingRaw;

/// What the eyes are drawn into; the hardware encodes sRGB and blends and resolves in linear light.
pub(crate) const COLOR_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba8UnormSrgb;

/// `tone_map` of lit.wgsl, for colours that no shader touches.
pub(crate) fn tone_map(color: [f32; 3]) -> [f32; 3] {
    const KNEE: f32 = 0.6;
    color.map(|value| {
        let over = (value - KNEE).max(0.0) / (1.0 - KNEE);
        value.min(KNEE) + (1.0 - KNEE) * (1.0 - (-over).exp())
    })
}

/// Multisampled colour and depth of one size, used by one eye after the other.
#[derive(Debug)]
pub(crate) struct Targets {
    pub size: [u32; 2],
    /// `None` without multisampling: the target itself is drawn to.
    color: Option<wgpu::TextureView>,
    depth: wgpu::TextureView,
}

impl Targets {
    pub fn new(device: &wgpu::Device, size: [u32; 2], samples: u32) -> Self {
        let usage = wgpu::TextureUsages::RENDER_ATTACHMENT;
        let attachment = |format| {
            texture::single(device, "eye", size, samples, format, usage)
                .create_view(&Default::default())
        };
        Self {
            size,
            color: (samples > 1).then(|| attachment(COLOR_FORMAT)),
            depth: attachment(DEPTH_FORMAT),
        }
    }
}

/// Draws the scene for one eye.
#[derive(Debug)]
pub(crate) struct LitPass {
    pipeline: wgpu::RenderPipeline,
    layout: wgpu::BindGroupLayout,
    bind_group: wgpu::BindGroup,
}

/// What the lit pass is made from.
pub(crate) struct LitInputs<'a> {
    pub eyes: &'a wgpu::Buffer,
    pub lighting: &'a wgpu::Buffer,
    pub texture_layout: &'a wgpu::BindGroupLayout,
    /// The shadow map, or `None` for a pass that knows no shadows.
    pub shadow_map: Option<&'a wgpu::TextureView>,
    pub samples: u32,
}

impl LitPass {
    pub fn new(device: &wgpu::Device, inputs: &LitInputs<'_>) -> Self {
        let layout = frame_layout(device, inputs.shadow_map.is_some());
        let bind_group = frame_bind_group(device, &layout, inputs);
        let text = if inputs.shadow_map.is_some() {
            shaders::LIT_SHADOWED
        } else {
            shaders::LIT
        };
        let module = super::shader(device, "lit", text);
        let pipeline_layout = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
            label: Some("lit"),
            bind_group_layouts: &[Some(&layout), Some(inputs.texture_layout)],
            immediate_size: 0,
        });
        let pipeline = device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
            label: Some("lit"),
            layout: Some(&pipeline_layout),
            vertex: wgpu::VertexState {
                module: &module,
                entry_point: Some("vertex"),
                compilation_options: Default::default(),
                buffers: &super::vertex_buffers(),
            },
            primitive: wgpu::PrimitiveState {
                cull_mode: Some(wgpu::Face::Back),
                ..Default::default()
            },
            depth_stencil: Some(super::depth_state()),
            multisample: wgpu::MultisampleState {
                count: inputs.samples,
                ..Default::default()
            },
            fragment: Some(wgpu::FragmentState {
                module: &module,
                entry_point: Some("fragment"),
                compilation_options: Default::default(),
                targets: &[Some(COLOR_FORMAT.into())],
            }),
            multiview_mask: None,
            cache: None,
        });
        Self {
            pipeline,
            layout,
            bind_group,
        }
    }

    /// Binds the inputs anew, for another shadow map; they must be of the kind that the pass was made for.
    pub fn rebind(&mut self, device: &wgpu::Device, inputs: &LitInputs<'_>) {
        self.bind_group = frame_bind_group(device, &self.layout, inputs);
    }

    pub fn record(&self, encoder: &mut wgpu::CommandEncoder, draw: &LitDraw<'_>) {
        let [r, g, b] = tone_map(draw.background).map(f64::from);
        let (view, resolve_target) = match &draw.targets.color {
            Some(color) => (color, Some(draw.target)),
            None => (draw.target, None),
        };
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("lit"),
            color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                view,
                depth_slice: None,
                resolve_target,
                ops: wgpu::Operations {
                    load: wgpu::LoadOp::Clear(wgpu::Color { r, g, b, a: 1.0 }),
                    store: if resolve_target.is_some() {
                        wgpu::StoreOp::Discard
                    } else {
                        wgpu::StoreOp::Store
                    },
                },
            })],
            depth_stencil_attachment: Some(super::depth_attachment(
                &draw.targets.depth,
                wgpu::StoreOp::Discard,
            )),
            ..Default::default()
        });
        pass.set_pipeline(&self.pipeline);
        pass.set_bind_group(0, &self.bind_group, &[draw.eye_offset]);
        pass.set_vertex_buffer(1, draw.instances.slice(..));
        for batch in draw.batches {
            let texture = batch
                .texture
                .map_or(draw.white, |id| &draw.textures[id.0 as usize]);
            pass.set_bind_group(1, &texture.bind_group, &[]);
            draw.meshes[batch.mesh.0 as usize].draw(&mut pass, batch);
        }
    }
}

/// What one eye's pass draws, and into what.
pub(crate) struct LitDraw<'a> {
    pub eye_offset: u32,
    pub targets: &'a Targets,
    pub target: &'a wgpu::TextureView,
    pub background: [f32; 3],
    pub instances: &'a wgpu::Buffer,
    pub batches: &'a [Batch],
    pub meshes: &'a [GpuMesh],
    pub textures: &'a [Texture],
    pub white: &'a Texture,
}

fn frame_layout(device: &wgpu::Device, shadows: bool) -> wgpu::BindGroupLayout {
    let entry = |binding, ty| wgpu::BindGroupLayoutEntry {
        binding,
        visibility: wgpu::ShaderStages::FRAGMENT,
        ty,
        count: None,
    };
    let mut entries = vec![
        super::eye_layout_entry(wgpu::ShaderStages::VERTEX_FRAGMENT),
        entry(
            1,
            wgpu::BindingType::Buffer {
                ty: wgpu::BufferBindingType::Uniform,
                has_dynamic_offset: false,
                min_binding_size: wgpu::BufferSize::new(size_of::<LightingRaw>() as u64),
            },
        ),
    ];
    if shadows {
        entries.push(entry(
            2,
            wgpu::BindingType::Texture {
                sample_type: wgpu::TextureSampleType::Depth,
                view_dimension: wgpu::TextureViewDimension::D2,
                multisampled: false,
            },
        ));
        entries.push(entry(
            3,
            wgpu::BindingType::Sampler(wgpu::SamplerBindingType::Comparison),
        ));
    }
    device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
        label: Some("frame"),
        entries: &entries,
    })
}

fn frame_bind_group(
    device: &wgpu::Device,
    layout: &wgpu::BindGroupLayout,
    inputs: &LitInputs<'_>,
) -> wgpu::BindGroup {
    let sampler = inputs.shadow_map.map(|_| {
        device.create_sampler(&wgpu::SamplerDescriptor {
            label: Some("shadow"),
            mag_filter: wgpu::FilterMode::Linear,
            min_filter: wgpu::FilterMode::Linear,
            compare: Some(wgpu::CompareFunction::LessEqual),
            ..Default::default()
        })
    });
    let mut entries = vec![
        super::eye_entry(inputs.eyes),
        wgpu::BindGroupEntry {
            binding: 1,
            resource: inputs.lighting.as_entire_binding(),
        },
    ];
    if let (Some(map), Some(sampler)) = (inputs.shadow_map, &sampler) {
        entries.push(wgpu::BindGroupEntry {
            binding: 2,
            resource: wgpu::BindingResource::TextureView(map),
        });
        entries.push(wgpu::BindGroupEntry {
            binding: 3,
            resource: wgpu::BindingResource::Sampler(sampler),
        });
    }
    device.create_bind_group(&wgpu::BindGroupDescriptor {
        label: Some("frame"),
        layout,
        entries: &entries,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tone_map_is_straight_below_the_knee_and_stays_below_white() {
        assert_eq!(tone_map([0.0, 0.25, 0.6]), [0.0, 0.25, 0.6]);
        let [a, b, c] = tone_map([0.8, 1.5, 40.0]);
        assert!(0.6 < a && a < b && b < c && c <= 1.0, "{a} {b} {c}");
        let slope = (tone_map([0.601; 3])[0] - 0.6) / 0.001;
        assert!((slope - 1.0).abs() < 0.01, "no kink at the knee: {slope}");
    }
}
