//! The passes of a frame, one file each, with the same stem as the shader.

pub(crate) mod depth;
pub(crate) mod hidden;
pub(crate) mod lit;
pub(crate) mod mirror;
pub(crate) mod present;
pub(crate) mod shadow;
pub(crate) mod vignette;

use crate::mesh::Vertex;
use crate::scene::{Instance, Material, MeshId, Pattern, TextureId};
use crate::uniforms::InstanceRaw;

/// Instances that are drawn together: same mesh, same texture, consecutive in the instance buffer.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Batch {
    pub mesh: MeshId,
    pub texture: Option<TextureId>,
    pub finish: Finish,
    pub is_mirrored: bool,
    pub casts_shadows: bool,
    pub first: u32,
    pub count: u32,
}

/// What a pipeline is specialised for.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct Finish {
    pub pattern: Pattern,
    pub is_glossy: bool,
    pub is_mirror: bool,
    pub takes_shadows: bool,
}

impl Finish {
    pub fn of(material: &Material) -> Self {
        Self {
            pattern: material.pattern,
            is_glossy: material.specular > 0.0,
            is_mirror: material.mirror > 0.0,
            takes_shadows: material.takes_shadows,
        }
    }
}

impl Batch {
    /// A batch of one instance.
    pub fn of(instance: &Instance, first: u32) -> Self {
        let material = &instance.material;
        Self {
            mesh: instance.mesh,
            texture: material.texture,
            finish: Finish::of(material),
            is_mirrored: material.is_mirrored,
            casts_shadows: material.casts_shadows,
            first,
            count: 1,
        }
    }

    /// What instances of one batch have in common; by finish first, so that pipelines change seldom.
    pub fn key(&self) -> (Finish, MeshId, Option<TextureId>, bool, bool) {
        (
            self.finish,
            self.mesh,
            self.texture,
            self.is_mirrored,
            self.casts_shadows,
        )
    }
}

/// A mesh on the device.
#[derive(Debug)]
pub(crate) struct GpuMesh {
    vertices: wgpu::Buffer,
    indices: wgpu::Buffer,
    count: u32,
    /// What is drawn for it where it is seen blurred.
    pub stand_in: Option<MeshId>,
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
            stand_in: None,
        }
    }

    /// Triangles of it.
    pub fn triangles(&self) -> u32 {
        self.count / 3
    }

    /// Draws a batch of it; pipeline, bindings and the instance buffer are set.
    pub fn draw(&self, pass: &mut wgpu::RenderPass<'_>, batch: &Batch) {
        pass.set_vertex_buffer(0, self.vertices.slice(..));
        pass.set_index_buffer(self.indices.slice(..), wgpu::IndexFormat::Uint32);
        pass.draw_indexed(0..self.count, 0, batch.first..batch.first + batch.count);
    }
}

/// The mesh that is drawn for a batch in shadows and mirrors.
fn blurred<'a>(meshes: &'a [GpuMesh], batch: &Batch) -> &'a GpuMesh {
    let mesh = &meshes[batch.mesh.0 as usize];
    mesh.stand_in.map_or(mesh, |id| &meshes[id.0 as usize])
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

fn shader(
    device: &wgpu::Device,
    label: &str,
    text: impl Into<std::borrow::Cow<'static, str>>,
) -> wgpu::ShaderModule {
    device.create_shader_module(wgpu::ShaderModuleDescriptor {
        label: Some(label),
        source: wgpu::ShaderSource::Wgsl(text.into()),
    })
}

/// What a pass draws over a whole picture, or a rectangle of it, without vertices from a buffer.
struct Overlay<'a> {
    label: &'static str,
    shader: std::borrow::Cow<'static, str>,
    layout: &'a wgpu::BindGroupLayout,
    topology: wgpu::PrimitiveTopology,
    /// `None` writes depth alone.
    target: Option<wgpu::ColorTargetState>,
    depth: Option<wgpu::DepthStencilState>,
}

impl Overlay<'_> {
    fn pipeline(self, device: &wgpu::Device) -> wgpu::RenderPipeline {
        let module = shader(device, self.label, self.shader);
        let targets: Vec<_> = self.target.into_iter().map(Some).collect();
        let layout = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
            label: Some(self.label),
            bind_group_layouts: &[Some(self.layout)],
            immediate_size: 0,
        });
        device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
            label: Some(self.label),
            layout: Some(&layout),
            vertex: wgpu::VertexState {
                module: &module,
                entry_point: Some("vertex"),
                compilation_options: Default::default(),
                buffers: &[],
            },
            primitive: wgpu::PrimitiveState {
                topology: self.topology,
                ..Default::default()
            },
            depth_stencil: self.depth,
            multisample: wgpu::MultisampleState::default(),
            fragment: Some(wgpu::FragmentState {
                module: &module,
                entry_point: Some("fragment"),
                compilation_options: Default::default(),
                targets: &targets,
            }),
            multiview_mask: None,
            cache: None,
        })
    }
}
