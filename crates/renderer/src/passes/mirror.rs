//! The image in the glossy floor at y = 0: the scene drawn once more, seen as if from below the floor, then smaller and
//! smaller copies for what stands high above it and blurs.
//!
//! Planar, not looked up in the eye's own picture: the lamps and the pins' far sides, which the floor mirrors, are not in that
//! picture, and at its edges both eyes would lose different things.

use super::{Batch, DEPTH_FORMAT, GpuMesh};
use crate::passes::lit::LitInputs;
use crate::scene::Pattern;
use crate::shaders::{self, Lookups};
use crate::texture::{self, Texture};

/// Bright lamps stay bright when they are blurred.
const FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba16Float;

/// The image and its smaller copies.
const LEVELS: u32 = 6;

/// The image of one picture size, used by one eye after the other.
#[derive(Debug)]
pub(crate) struct MirrorMap {
    /// Size of the picture that it is for [pixels].
    pub picture: [u32; 2],
    /// All levels, for looking up.
    pub view: wgpu::TextureView,
    levels: Vec<wgpu::TextureView>,
    /// Each level but the last, for making the next.
    sources: Vec<wgpu::BindGroup>,
    depth: wgpu::TextureView,
}

/// Draws the image.
#[derive(Debug)]
pub(crate) struct MirrorPass {
    pipeline: wgpu::RenderPipeline,
    bind_group: wgpu::BindGroup,
    shrink: wgpu::RenderPipeline,
    shrink_layout: wgpu::BindGroupLayout,
    /// Between texels and between levels.
    pub sampler: wgpu::Sampler,
    pub map: MirrorMap,
}

/// What is mirrored.
pub(crate) struct MirrorDraw<'a> {
    pub eye_offset: u32,
    pub background: [f32; 3],
    pub instances: &'a wgpu::Buffer,
    pub batches: &'a [Batch],
    pub meshes: &'a [GpuMesh],
    pub textures: &'a [Texture],
    pub white: &'a Texture,
}

/// Half the picture: it is blurred anyway.
pub(crate) fn map_size(picture: [u32; 2]) -> [u32; 2] {
    picture.map(|side| side.div_ceil(2))
}

impl MirrorPass {
    pub fn new(device: &wgpu::Device, inputs: &LitInputs<'_>, picture: [u32; 2]) -> Self {
        let layout = super::lit::frame_layout(device, Lookups::default());
        let bind_group = super::lit::frame_bind_group(device, &layout, inputs);
        let shrink_layout = texture::bind_group_layout(device);
        let sampler = smooth_sampler(device);
        Self {
            pipeline: pipeline(device, &layout, inputs.texture_layout),
            bind_group,
            shrink: shrink_pipeline(device, &shrink_layout),
            map: MirrorMap::new(device, &shrink_layout, &sampler, picture),
            shrink_layout,
            sampler,
        }
    }

    /// Makes the image fit the picture; `true` if it is another one now.
    pub fn fit(&mut self, device: &wgpu::Device, picture: [u32; 2]) -> bool {
        let differs = self.map.picture != picture;
        if differs {
            self.map = MirrorMap::new(device, &self.shrink_layout, &self.sampler, picture);
        }
        differs
    }

    pub fn record(&self, encoder: &mut wgpu::CommandEncoder, draw: &MirrorDraw<'_>) {
        self.record_image(encoder, draw);
        for (source, target) in self.map.sources.iter().zip(&self.map.levels[1..]) {
            let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
                label: Some("shrink"),
                color_attachments: &[Some(color(target, [0.0; 4]))],
                ..Default::default()
            });
            pass.set_pipeline(&self.shrink);
            pass.set_bind_group(0, source, &[]);
            pass.draw(0..3, 0..1);
        }
    }

    fn record_image(&self, encoder: &mut wgpu::CommandEncoder, draw: &MirrorDraw<'_>) {
        let [r, g, b] = draw.background.map(f64::from);
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("mirror"),
            color_attachments: &[Some(color(&self.map.levels[0], [r, g, b, 1.0]))],
            depth_stencil_attachment: Some(super::depth_attachment(
                &self.map.depth,
                wgpu::StoreOp::Discard,
            )),
            ..Default::default()
        });
        pass.set_pipeline(&self.pipeline);
        pass.set_bind_group(0, &self.bind_group, &[draw.eye_offset]);
        pass.set_vertex_buffer(1, draw.instances.slice(..));
        for batch in draw.batches.iter().filter(|batch| batch.is_mirrored) {
            // A pattern is left out, of which the texture would be a part: it is blurred to its mean.
            let texture = batch
                .texture
                .filter(|_| batch.finish.pattern == Pattern::Texture)
                .map_or(draw.white, |id| &draw.textures[id.0 as usize]);
            pass.set_bind_group(1, &texture.bind_group, &[]);
            super::blurred(draw.meshes, batch).draw(&mut pass, batch);
        }
    }
}

fn color(view: &wgpu::TextureView, [r, g, b, a]: [f64; 4]) -> wgpu::RenderPassColorAttachment<'_> {
    wgpu::RenderPassColorAttachment {
        view,
        depth_slice: None,
        resolve_target: None,
        ops: wgpu::Operations {
            load: wgpu::LoadOp::Clear(wgpu::Color { r, g, b, a }),
            store: wgpu::StoreOp::Store,
        },
    }
}

/// Between texels and between levels.
fn smooth_sampler(device: &wgpu::Device) -> wgpu::Sampler {
    device.create_sampler(&wgpu::SamplerDescriptor {
        label: Some("mirror"),
        mag_filter: wgpu::FilterMode::Linear,
        min_filter: wgpu::FilterMode::Linear,
        mipmap_filter: wgpu::MipmapFilterMode::Linear,
        ..Default::default()
    })
}

impl MirrorMap {
    fn new(
        device: &wgpu::Device,
        layout: &wgpu::BindGroupLayout,
        sampler: &wgpu::Sampler,
        picture: [u32; 2],
    ) -> Self {
        let [width, height] = map_size(picture);
        let usage = wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::TEXTURE_BINDING;
        let texture = device.create_texture(&wgpu::TextureDescriptor {
            label: Some("mirror"),
            size: wgpu::Extent3d {
                width,
                height,
                depth_or_array_layers: 1,
            },
            mip_level_count: LEVELS.min(width.max(height).ilog2() + 1),
            sample_count: 1,
            dimension: wgpu::TextureDimension::D2,
            format: FORMAT,
            usage,
            view_formats: &[],
        });
        let level = |base_mip_level| {
            texture.create_view(&wgpu::TextureViewDescriptor {
                base_mip_level,
                mip_level_count: Some(1),
                ..Default::default()
            })
        };
        let levels: Vec<_> = (0..texture.mip_level_count()).map(level).collect();
        let sources = levels[..levels.len() - 1]
            .iter()
            .map(|view| texture::bind_group(device, layout, view, sampler))
            .collect();
        let depth_usage = wgpu::TextureUsages::RENDER_ATTACHMENT;
        let depth = texture::single(
            device,
            "mirror depth",
            [width, height],
            1,
            DEPTH_FORMAT,
            depth_usage,
        );
        Self {
            picture,
            view: texture.create_view(&Default::default()),
            levels,
            sources,
            depth: depth.create_view(&Default::default()),
        }
    }
}

fn pipeline(
    device: &wgpu::Device,
    layout: &wgpu::BindGroupLayout,
    texture_layout: &wgpu::BindGroupLayout,
) -> wgpu::RenderPipeline {
    let module = super::shader(device, "mirror", shaders::mirror());
    let layout = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
        label: Some("mirror"),
        bind_group_layouts: &[Some(layout), Some(texture_layout)],
        immediate_size: 0,
    });
    device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
        label: Some("mirror"),
        layout: Some(&layout),
        vertex: wgpu::VertexState {
            module: &module,
            entry_point: Some("vertex"),
            compilation_options: Default::default(),
            buffers: &super::vertex_buffers(),
        },
        primitive: wgpu::PrimitiveState {
            // The mirror turns every triangle the other way round.
            front_face: wgpu::FrontFace::Cw,
            cull_mode: Some(wgpu::Face::Back),
            ..Default::default()
        },
        depth_stencil: Some(super::depth_state()),
        multisample: wgpu::MultisampleState::default(),
        fragment: Some(wgpu::FragmentState {
            module: &module,
            entry_point: Some("mirror_fragment"),
            compilation_options: wgpu::PipelineCompilationOptions {
                constants: &[("GLOSS", 0.0), ("SHADOWED", 0.0)],
                ..Default::default()
            },
            targets: &[Some(FORMAT.into())],
        }),
        multiview_mask: None,
        cache: None,
    })
}

fn shrink_pipeline(device: &wgpu::Device, layout: &wgpu::BindGroupLayout) -> wgpu::RenderPipeline {
    super::Overlay {
        label: "shrink",
        shader: shaders::SHRINK.into(),
        layout,
        topology: wgpu::PrimitiveTopology::TriangleList,
        target: Some(FORMAT.into()),
        depth: None,
    }
    .pipeline(device)
}
