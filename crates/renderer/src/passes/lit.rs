//! Lit surfaces, one pass per eye, into a single-layer target.
//!
//! Debian 12's lavapipe resolves every multisampled layer into the first, and loses geometry with multiview
//! (Mesa 22.3.6); a pass of its own per eye is right on every driver.

use super::hidden::{HiddenMesh, HiddenPass};
use super::{Batch, DEPTH_FORMAT, Finish, GpuMesh};
use crate::scene::Pattern;
use crate::shaders::{self, Lookups};
use crate::texture::{self, Texture};
use crate::uniforms::LightingRaw;

/// What the eyes are drawn into; the hardware encodes sRGB and blends and resolves in linear light.
pub(crate) const COLOR_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba8UnormSrgb;

/// `tone_map` of lighting.wgsl, for colours that no shader touches.
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
    pub depth: wgpu::TextureView,
}

impl Targets {
    /// With `reads_depth` a later pass may read the depth.
    pub fn new(device: &wgpu::Device, size: [u32; 2], samples: u32, reads_depth: bool) -> Self {
        let attachment = |format, more| {
            let usage = wgpu::TextureUsages::RENDER_ATTACHMENT | more;
            texture::single(device, "eye", size, samples, format, usage)
                .create_view(&Default::default())
        };
        let read = match reads_depth {
            true => wgpu::TextureUsages::TEXTURE_BINDING,
            false => wgpu::TextureUsages::empty(),
        };
        Self {
            size,
            color: (samples > 1).then(|| attachment(COLOR_FORMAT, wgpu::TextureUsages::empty())),
            depth: attachment(DEPTH_FORMAT, read),
        }
    }
}

/// How surfaces are drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Shading {
    /// Lit, with these lookups.
    Smooth(Lookups),
    /// One colour a face, and pictures where something in the frame has a texture.
    Flat { has_pictures: bool },
}

impl Default for Shading {
    /// With nothing to look up.
    fn default() -> Self {
        Self::Smooth(Lookups::default())
    }
}

impl Shading {
    pub fn lookups(self) -> Lookups {
        match self {
            Self::Smooth(lookups) => lookups,
            Self::Flat { .. } => Lookups::default(),
        }
    }

    /// Whether a texture is bound for each batch.
    fn has_textures(self) -> bool {
        !matches!(
            self,
            Self::Flat {
                has_pictures: false
            }
        )
    }

    /// What a batch is drawn with.
    fn kind(self, batch: &Batch) -> Kind {
        match (self, batch.texture) {
            (Self::Smooth(_), _) => Kind::Lit(batch.finish),
            (Self::Flat { .. }, Some(_)) => Kind::Picture,
            (Self::Flat { .. }, None) => Kind::Face,
        }
    }
}

/// What a pipeline is made for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Kind {
    /// A lit surface of this finish.
    Lit(Finish),
    /// A face of one colour.
    Face,
    /// A picture among such faces.
    Picture,
}

impl Kind {
    /// Entry points of its shader, for vertices and for fragments.
    fn entry_points(self) -> [&'static str; 2] {
        match self {
            Self::Lit(_) => ["vertex", "fragment"],
            Self::Face => ["flat_vertex", "flat_fragment"],
            Self::Picture => ["vertex", "picture_fragment"],
        }
    }
}

/// Draws the scene for one eye.
#[derive(Debug)]
pub(crate) struct LitPass {
    pub shading: Shading,
    module: wgpu::ShaderModule,
    pipeline_layout: wgpu::PipelineLayout,
    /// One for each kind that was called for.
    pipelines: Vec<(Kind, wgpu::RenderPipeline)>,
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
    /// The image in the floor and how it is sampled, or `None` for a pass that knows no mirror.
    pub mirror_map: Option<(&'a wgpu::TextureView, &'a wgpu::Sampler)>,
    pub samples: u32,
    /// Highlights are as wide as the pixel needs.
    pub widen_highlights: bool,
}

impl LitPass {
    /// A pass of this shading; the inputs hold what it looks up.
    pub fn new(device: &wgpu::Device, shading: Shading, inputs: &LitInputs<'_>) -> Self {
        let layout = frame_layout(device, shading.lookups());
        let bind_group = frame_bind_group(device, &layout, inputs);
        let text = match shading {
            Shading::Smooth(lookups) => shaders::lit(lookups),
            Shading::Flat { has_pictures } => shaders::flat(has_pictures),
        };
        let mut groups = vec![Some(&layout)];
        if shading.has_textures() {
            groups.push(Some(inputs.texture_layout));
        }
        let pipeline_layout = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
            label: Some("lit"),
            bind_group_layouts: &groups,
            immediate_size: 0,
        });
        Self {
            shading,
            module: super::shader(device, "lit", text),
            pipeline_layout,
            pipelines: Vec::new(),
            layout,
            bind_group,
        }
    }

    /// Makes the pipelines that these batches call for, unless they are there.
    pub fn fit(&mut self, device: &wgpu::Device, batches: &[Batch], inputs: &LitInputs<'_>) {
        for batch in batches {
            let kind = self.shading.kind(batch);
            if self.pipelines.iter().all(|(known, _)| *known != kind) {
                let pipeline = self.pipeline(device, kind, inputs);
                self.pipelines.push((kind, pipeline));
            }
        }
    }

    fn pipeline(
        &self,
        device: &wgpu::Device,
        kind: Kind,
        inputs: &LitInputs<'_>,
    ) -> wgpu::RenderPipeline {
        let constants = match kind {
            Kind::Lit(finish) => self.constants(finish, inputs.widen_highlights),
            Kind::Face | Kind::Picture => Vec::new(),
        };
        let [vertex, fragment] = kind.entry_points();
        device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
            label: Some("lit"),
            layout: Some(&self.pipeline_layout),
            vertex: wgpu::VertexState {
                module: &self.module,
                entry_point: Some(vertex),
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
                module: &self.module,
                entry_point: Some(fragment),
                compilation_options: wgpu::PipelineCompilationOptions {
                    constants: &constants,
                    ..Default::default()
                },
                targets: &[Some(COLOR_FORMAT.into())],
            }),
            multiview_mask: None,
            cache: None,
        })
    }

    /// The `override`s of the lit shader for a finish.
    fn constants(&self, finish: Finish, widen_highlights: bool) -> Vec<(&'static str, f64)> {
        let flag = |is_on: bool| f64::from(u8::from(is_on));
        let pattern = match finish.pattern {
            Pattern::Texture => 0.0,
            Pattern::Planks => 1.0,
            Pattern::Carpet => 2.0,
            Pattern::Panels => 3.0,
        };
        let mut constants = vec![
            ("PATTERN", pattern),
            ("GLOSS", flag(finish.is_glossy)),
            ("SHADOWED", flag(finish.takes_shadows)),
            ("WIDEN_HIGHLIGHTS", flag(widen_highlights)),
        ];
        if self.shading.lookups().mirror {
            constants.push(("MIRROR", flag(finish.is_mirror)));
        }
        constants
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
                draw.depth_store,
            )),
            ..Default::default()
        });
        if let Some((hidden, mesh)) = draw.hidden {
            hidden.draw(&mut pass, mesh);
        }
        pass.set_bind_group(0, &self.bind_group, &[draw.eye_offset]);
        pass.set_vertex_buffer(1, draw.instances.slice(..));
        let mut current = None;
        for batch in draw.batches {
            let kind = self.shading.kind(batch);
            if current != Some(kind) {
                let made = self.pipelines.iter().find(|(known, _)| *known == kind);
                let (_, pipeline) = made.expect("the frame's batches were fitted");
                pass.set_pipeline(pipeline);
                current = Some(kind);
            }
            if self.shading.has_textures() {
                let texture = batch
                    .texture
                    .map_or(draw.white, |id| &draw.textures[id.0 as usize]);
                pass.set_bind_group(1, &texture.bind_group, &[]);
            }
            draw.meshes[batch.mesh.0 as usize].draw(&mut pass, batch);
        }
    }
}

/// What one eye's pass draws, and into what.
pub(crate) struct LitDraw<'a> {
    pub eye_offset: u32,
    pub targets: &'a Targets,
    pub target: &'a wgpu::TextureView,
    /// Whether a later pass reads the depth.
    pub depth_store: wgpu::StoreOp,
    /// What is not seen of the picture.
    pub hidden: Option<(&'a HiddenPass, &'a HiddenMesh)>,
    pub background: [f32; 3],
    pub instances: &'a wgpu::Buffer,
    pub batches: &'a [Batch],
    pub meshes: &'a [GpuMesh],
    pub textures: &'a [Texture],
    pub white: &'a Texture,
}

/// What a frame binds beside its textures.
pub(crate) fn frame_layout(device: &wgpu::Device, lookups: Lookups) -> wgpu::BindGroupLayout {
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
    if lookups.shadows {
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
    if lookups.mirror {
        entries.push(entry(
            4,
            wgpu::BindingType::Texture {
                sample_type: wgpu::TextureSampleType::Float { filterable: true },
                view_dimension: wgpu::TextureViewDimension::D2,
                multisampled: false,
            },
        ));
        entries.push(entry(
            5,
            wgpu::BindingType::Sampler(wgpu::SamplerBindingType::Filtering),
        ));
    }
    device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
        label: Some("frame"),
        entries: &entries,
    })
}

/// The inputs, as [`frame_layout`] has them.
pub(crate) fn frame_bind_group(
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
    if let Some((map, sampler)) = inputs.mirror_map {
        entries.push(wgpu::BindGroupEntry {
            binding: 4,
            resource: wgpu::BindingResource::TextureView(map),
        });
        entries.push(wgpu::BindGroupEntry {
            binding: 5,
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
