//! A dark edge over a finished picture.

use super::lit::COLOR_FORMAT;
use crate::scene::Vignette;
use crate::uniforms::VignetteRaw;
use crate::{View, shaders};

/// Over so many radians the edge goes from clear to dark.
const SOFTNESS: f32 = 0.3;

/// Darkens the edges of the views' pictures.
#[derive(Debug)]
pub(crate) struct VignettePass {
    pipeline: wgpu::RenderPipeline,
    layout: wgpu::BindGroupLayout,
    /// One for each view.
    eyes: Vec<(wgpu::Buffer, wgpu::BindGroup)>,
}

impl VignettePass {
    pub fn new(device: &wgpu::Device) -> Self {
        let layout = device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
            label: Some("vignette"),
            entries: &[wgpu::BindGroupLayoutEntry {
                binding: 0,
                visibility: wgpu::ShaderStages::VERTEX_FRAGMENT,
                ty: wgpu::BindingType::Buffer {
                    ty: wgpu::BufferBindingType::Uniform,
                    has_dynamic_offset: false,
                    min_binding_size: None,
                },
                count: None,
            }],
        });
        let target = wgpu::ColorTargetState {
            format: COLOR_FORMAT,
            blend: Some(wgpu::BlendState::ALPHA_BLENDING),
            write_mask: wgpu::ColorWrites::COLOR,
        };
        let pipeline = super::Overlay {
            label: "vignette",
            shader: shaders::VIGNETTE.into(),
            layout: &layout,
            topology: wgpu::PrimitiveTopology::TriangleStrip,
            target: Some(target),
            depth: None,
        }
        .pipeline(device);
        Self {
            pipeline,
            layout,
            eyes: Vec::new(),
        }
    }

    /// Takes the frame's views.
    pub fn fit(&mut self, gpu: &crate::Gpu, views: &[View], vignette: Vignette) {
        while self.eyes.len() < views.len() {
            self.eyes.push(self.eye(&gpu.device));
        }
        for (view, (uniform, _)) in views.iter().zip(&self.eyes) {
            let fov = view.fov;
            let raw = VignetteRaw {
                tangents: [fov.left, fov.right, fov.down, fov.up].map(f32::tan),
                clear: vignette.clear,
                dark: vignette.clear + SOFTNESS,
                strength: vignette.strength.clamp(0.0, 1.0),
                padding: 0.0,
            };
            gpu.queue.write_buffer(uniform, 0, bytemuck::bytes_of(&raw));
        }
    }

    fn eye(&self, device: &wgpu::Device) -> (wgpu::Buffer, wgpu::BindGroup) {
        let uniform = device.create_buffer(&wgpu::BufferDescriptor {
            label: Some("vignette"),
            size: size_of::<VignetteRaw>() as u64,
            usage: wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST,
            mapped_at_creation: false,
        });
        let bind_group = device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("vignette"),
            layout: &self.layout,
            entries: &[wgpu::BindGroupEntry {
                binding: 0,
                resource: uniform.as_entire_binding(),
            }],
        });
        (uniform, bind_group)
    }

    /// Draws over the finished picture of one view.
    pub fn record(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        index: usize,
        target: &wgpu::TextureView,
    ) {
        let Some((_, bind_group)) = self.eyes.get(index) else {
            return;
        };
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("vignette"),
            color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                view: target,
                depth_slice: None,
                resolve_target: None,
                ops: wgpu::Operations {
                    load: wgpu::LoadOp::Load,
                    store: wgpu::StoreOp::Store,
                },
            })],
            ..Default::default()
        });
        pass.set_pipeline(&self.pipeline);
        pass.set_bind_group(0, bind_group, &[]);
        pass.draw(0..4, 0..1);
    }
}
