//! Parts of a picture that no eye sees, because a lens does not show them: nothing is shaded there.

use super::lit::COLOR_FORMAT;
use crate::shaders;

/// Puts the near plane before what is hidden, so that whatever is drawn later lies behind it.
#[derive(Debug)]
pub(crate) struct HiddenPass {
    pipeline: wgpu::RenderPipeline,
}

/// Triangles of one eye's picture, in clip space.
#[derive(Debug)]
pub(crate) struct HiddenMesh {
    corners: wgpu::Buffer,
    count: u32,
}

impl HiddenMesh {
    /// Of three corners each, x to the right and y up from -1 to 1.
    pub fn new(device: &wgpu::Device, corners: &[[f32; 2]]) -> Self {
        use wgpu::util::{BufferInitDescriptor, DeviceExt};
        Self {
            corners: device.create_buffer_init(&BufferInitDescriptor {
                label: Some("hidden"),
                contents: bytemuck::cast_slice(corners),
                usage: wgpu::BufferUsages::VERTEX,
            }),
            count: corners.len() as u32,
        }
    }
}

impl HiddenPass {
    /// For eyes with so many samples to a pixel.
    pub fn new(device: &wgpu::Device, samples: u32) -> Self {
        let module = super::shader(device, "hidden", shaders::HIDDEN);
        let layout = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
            label: Some("hidden"),
            bind_group_layouts: &[],
            immediate_size: 0,
        });
        let corners = wgpu::VertexBufferLayout {
            array_stride: size_of::<[f32; 2]>() as u64,
            step_mode: wgpu::VertexStepMode::Vertex,
            attributes: &wgpu::vertex_attr_array![0 => Float32x2],
        };
        let target = wgpu::ColorTargetState {
            format: COLOR_FORMAT,
            blend: None,
            write_mask: wgpu::ColorWrites::empty(),
        };
        let pipeline = device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
            label: Some("hidden"),
            layout: Some(&layout),
            vertex: wgpu::VertexState {
                module: &module,
                entry_point: Some("vertex"),
                compilation_options: Default::default(),
                buffers: &[Some(corners)],
            },
            // Both sides count: runtimes wind their triangles as they like.
            primitive: wgpu::PrimitiveState::default(),
            depth_stencil: Some(wgpu::DepthStencilState {
                depth_compare: Some(wgpu::CompareFunction::Always),
                ..super::depth_state()
            }),
            multisample: wgpu::MultisampleState {
                count: samples,
                ..Default::default()
            },
            fragment: Some(wgpu::FragmentState {
                module: &module,
                entry_point: Some("fragment"),
                compilation_options: Default::default(),
                targets: &[Some(target)],
            }),
            multiview_mask: None,
            cache: None,
        });
        Self { pipeline }
    }

    /// Draws into an eye's pass, before anything else.
    pub fn draw(&self, pass: &mut wgpu::RenderPass<'_>, mesh: &HiddenMesh) {
        pass.set_pipeline(&self.pipeline);
        pass.set_vertex_buffer(0, mesh.corners.slice(..));
        pass.draw(0..mesh.count, 0..1);
    }
}
