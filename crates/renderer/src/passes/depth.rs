//! The depth that an eye was drawn with, in an image of somebody else's.
//!
//! wgpu resolves the samples of colours alone, and what a headset's runtime takes has one sample to a pixel.

use crate::shaders;

/// Brings the depth of one eye's samples into an image with one sample to a pixel.
#[derive(Debug)]
pub(crate) struct DepthPass {
    /// What it writes.
    pub format: wgpu::TextureFormat,
    pipeline: wgpu::RenderPipeline,
    bind_group: wgpu::BindGroup,
}

impl DepthPass {
    /// A pass that reads `drawn`, of so many samples, and writes images of `format`.
    pub fn new(
        device: &wgpu::Device,
        drawn: &wgpu::TextureView,
        samples: u32,
        format: wgpu::TextureFormat,
    ) -> Self {
        let layout = device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
            label: Some("depth"),
            entries: &[wgpu::BindGroupLayoutEntry {
                binding: 0,
                visibility: wgpu::ShaderStages::FRAGMENT,
                ty: wgpu::BindingType::Texture {
                    sample_type: wgpu::TextureSampleType::Depth,
                    view_dimension: wgpu::TextureViewDimension::D2,
                    multisampled: samples > 1,
                },
                count: None,
            }],
        });
        let bind_group = device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("depth"),
            layout: &layout,
            entries: &[wgpu::BindGroupEntry {
                binding: 0,
                resource: wgpu::BindingResource::TextureView(drawn),
            }],
        });
        Self {
            format,
            pipeline: pipeline(device, &layout, samples, format),
            bind_group,
        }
    }

    /// Records the copy of what was just drawn into `target`.
    pub fn record(&self, encoder: &mut wgpu::CommandEncoder, target: &wgpu::TextureView) {
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("depth"),
            depth_stencil_attachment: Some(super::depth_attachment(target, wgpu::StoreOp::Store)),
            ..Default::default()
        });
        pass.set_pipeline(&self.pipeline);
        pass.set_bind_group(0, &self.bind_group, &[]);
        pass.draw(0..3, 0..1);
    }
}

fn pipeline(
    device: &wgpu::Device,
    layout: &wgpu::BindGroupLayout,
    samples: u32,
    format: wgpu::TextureFormat,
) -> wgpu::RenderPipeline {
    super::Overlay {
        label: "depth",
        shader: shaders::depth(samples).into(),
        layout,
        topology: wgpu::PrimitiveTopology::TriangleList,
        target: None,
        depth: Some(wgpu::DepthStencilState {
            format,
            depth_compare: Some(wgpu::CompareFunction::Always),
            ..super::depth_state()
        }),
    }
    .pipeline(device)
}
