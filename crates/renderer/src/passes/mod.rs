//! The passes of a frame, one file each, with the same stem as the shader.

pub(crate) mod lit;
pub(crate) mod present;
pub(crate) mod shadow;

use crate::mesh::Vertex;
use crate::scene::{MeshId, TextureId};
use crate::uniforms::InstanceRaw;

/// Instances that are drawn together: same mesh, same texture, consecutive in the instance buffer.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Batch {
    pub mesh: MeshId,
    pub texture: Option<TextureId>,
    pub first: u32,
    pub count: u32,
}

/// A mesh on the device.
#[derive(Debug)]
pub(crate) struct GpuMesh {
    vertices: wgpu::Buffer,
    indices: wgpu::Buffer,
    count: u32,
}

impl GpuMesh {
    pub fn new(device: &wgpu::Device, mesh: &crate::MeshData) -> Self {
        use wgpu::util::{BufferInitDescriptor, DeviceExt};
        let buffer = |contents, usage| {
            device.create_buffer_init(&BufferInitDescriptor {
                label: Some("mesh"),
                contents,
                usage,
            })
        };
        Self {
            vertices: buffer(
                bytemuck::cast_slice(&mesh.vertices),
                wgpu::BufferUsages::VERTEX,
            ),
            indices: buffer(
                bytemuck::cast_slice(&mesh.indices),
                wgpu::BufferUsages::INDEX,
            ),
            count: mesh.indices.len() as u32,
        }
    }

    /// Draws a batch of it; pipeline, bindings and the instance buffer are set.
    pub fn draw(&self, pass: &mut wgpu::RenderPass<'_>, batch: &Batch) {
        pass.set_vertex_buffer(0, self.vertices.slice(..));
        pass.set_index_buffer(self.indices.slice(..), wgpu::IndexFormat::Uint32);
        pass.draw_indexed(0..self.count, 0, batch.first..batch.first + batch.count);
    }
}

/// Bytes between two eyes in the buffer of eyes: the largest alignment that a device may ask for.
pub(crate) const EYE_STRIDE: u64 = 256;

/// Depth of eyes and of the shadow map.
pub(crate) const DEPTH_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Depth32Float;

/// Vertices in buffer 0, instances in buffer 1.
fn vertex_buffers() -> [Option<wgpu::VertexBufferLayout<'static>>; 2] {
    const VERTEX: [wgpu::VertexAttribute; 3] =
        wgpu::vertex_attr_array![0 => Float32x3, 1 => Float32x3, 2 => Float32x2];
    [
        Some(wgpu::VertexBufferLayout {
            array_stride: size_of::<Vertex>() as u64,
            step_mode: wgpu::VertexStepMode::Vertex,
            attributes: &VERTEX,
        }),
        Some(wgpu::VertexBufferLayout {
            array_stride: size_of::<InstanceRaw>() as u64,
            step_mode: wgpu::VertexStepMode::Instance,
            attributes: &InstanceRaw::ATTRIBUTES,
        }),
    ]
}

/// The buffer of eyes as binding 0, placed by a dynamic offset.
fn eye_layout_entry(visibility: wgpu::ShaderStages) -> wgpu::BindGroupLayoutEntry {
    wgpu::BindGroupLayoutEntry {
        binding: 0,
        visibility,
        ty: wgpu::BindingType::Buffer {
            ty: wgpu::BufferBindingType::Uniform,
            has_dynamic_offset: true,
            min_binding_size: wgpu::BufferSize::new(size_of::<crate::uniforms::EyeRaw>() as u64),
        },
        count: None,
    }
}

/// One eye of the buffer of eyes, at the offset that is given when the group is set.
fn eye_entry(eyes: &wgpu::Buffer) -> wgpu::BindGroupEntry<'_> {
    wgpu::BindGroupEntry {
        binding: 0,
        resource: wgpu::BindingResource::Buffer(wgpu::BufferBinding {
            buffer: eyes,
            offset: 0,
            size: wgpu::BufferSize::new(size_of::<crate::uniforms::EyeRaw>() as u64),
        }),
    }
}

fn depth_state() -> wgpu::DepthStencilState {
    wgpu::DepthStencilState {
        format: DEPTH_FORMAT,
        depth_write_enabled: Some(true),
        depth_compare: Some(wgpu::CompareFunction::Less),
        stencil: wgpu::StencilState::default(),
        bias: wgpu::DepthBiasState::default(),
    }
}

/// Depth that a pass begins with at the far end, and afterwards keeps or not.
fn depth_attachment(
    view: &wgpu::TextureView,
    store: wgpu::StoreOp,
) -> wgpu::RenderPassDepthStencilAttachment<'_> {
    wgpu::RenderPassDepthStencilAttachment {
        view,
        depth_ops: Some(wgpu::Operations {
            load: wgpu::LoadOp::Clear(1.0),
            store,
        }),
        stencil_ops: None,
    }
}

fn shader(device: &wgpu::Device, label: &str, text: &'static str) -> wgpu::ShaderModule {
    device.create_shader_module(wgpu::ShaderModuleDescriptor {
        label: Some(label),
        source: wgpu::ShaderSource::Wgsl(text.into()),
    })
}
