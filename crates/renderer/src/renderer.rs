//! Draws a frame: its data on the device, and its passes in order.

mod batches;
mod check;
mod library;

use image::{Rgba, RgbaImage};

use crate::passes::lit::{LitDraw, LitInputs, LitPass, Targets};
use crate::passes::shadow::{LightFrame, ShadowPass};
use crate::passes::{EYE_STRIDE, GpuMesh};
use crate::scene::Scene;
use crate::texture::{self, Texture};
use crate::uniforms::{EyeRaw, LightingRaw};
use crate::{Gpu, RenderError, View};
use batches::{Frame, instance_buffer};

/// Most views in one frame.
pub const MAX_VIEWS: usize = 4;

/// Settings that hold as long as the renderer does.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct RendererSettings {
    /// Samples per pixel, 4, or 1 for jagged edges.
    pub samples: u32,
    /// The shadow map has this number squared of texels; 0 draws no shadows, at no cost.
    pub shadow_size: u32,
}

impl Default for RendererSettings {
    fn default() -> Self {
        Self {
            samples: 4,
            shadow_size: 2048,
        }
    }
}

/// Draws scenes with one device.
#[derive(Debug)]
pub struct Renderer {
    pub(crate) gpu: Gpu,
    settings: RendererSettings,
    meshes: Vec<GpuMesh>,
    textures: Vec<Texture>,
    /// Stands in where a material has no texture.
    white: Texture,
    texture_layout: wgpu::BindGroupLayout,
    sampler: wgpu::Sampler,
    /// The views' eyes, then the light's.
    eyes: wgpu::Buffer,
    lighting: wgpu::Buffer,
    instances: wgpu::Buffer,
    /// Made when the first scene needs them.
    shadow: Option<ShadowPass>,
    lit_shadowed: Option<LitPass>,
    lit_plain: Option<LitPass>,
    targets: Option<Targets>,
    frame: Frame,
}

impl Renderer {
    /// A renderer with nothing in it.
    ///
    /// # Errors
    /// If the device cannot do what the settings ask for.
    pub fn new(gpu: &Gpu, settings: RendererSettings) -> Result<Self, RenderError> {
        if ![1, 4].contains(&settings.samples) {
            return Err(RenderError::Unsupported(format!(
                "{} samples per pixel are not offered: choose 1 or 4",
                settings.samples
            )));
        }
        let most = gpu.max_side();
        if settings.shadow_size > most {
            return Err(RenderError::Unsupported(format!(
                "a shadow map of size {} cannot be drawn: choose 0 to {most}",
                settings.shadow_size
            )));
        }
        let device = &gpu.device;
        let buffer = |label, size, usage| {
            device.create_buffer(&wgpu::BufferDescriptor {
                label: Some(label),
                size,
                usage: usage | wgpu::BufferUsages::COPY_DST,
                mapped_at_creation: false,
            })
        };
        let uniform = wgpu::BufferUsages::UNIFORM;
        let texture_layout = texture::bind_group_layout(device);
        let sampler = texture::sampler(gpu);
        let white_pixel = RgbaImage::from_pixel(1, 1, Rgba([255; 4]));
        Ok(Self {
            settings,
            meshes: Vec::new(),
            textures: Vec::new(),
            white: Texture::new(gpu, &texture_layout, &sampler, &white_pixel)?,
            texture_layout,
            sampler,
            eyes: buffer("eyes", EYE_STRIDE * (MAX_VIEWS as u64 + 1), uniform),
            lighting: buffer("lighting", size_of::<LightingRaw>() as u64, uniform),
            instances: instance_buffer(device, 64),
            shadow: None,
            lit_shadowed: None,
            lit_plain: None,
            targets: None,
            frame: Frame::default(),
            gpu: gpu.clone(),
        })
    }

    /// The device that draws.
    pub fn gpu(&self) -> &Gpu {
        &self.gpu
    }

    /// The settings it was made with.
    pub fn settings(&self) -> RendererSettings {
        self.settings
    }

    /// Records the passes that draw `scene` for each view into its target.
    ///
    /// Targets are single-layer, `Rgba8UnormSrgb`, of `size` pixels and usable as render attachments. Nothing is
    /// submitted; the next call must come after the encoder's submission.
    ///
    /// # Errors
    /// If the scene or a view cannot be drawn; nothing is recorded then.
    pub fn record(
        &mut self,
        encoder: &mut wgpu::CommandEncoder,
        scene: &Scene,
        views: &[(View, &wgpu::TextureView)],
        size: [u32; 2],
    ) -> Result<(), RenderError> {
        let only_views = views.iter().map(|(view, _)| *view);
        self.prepare(scene, only_views, size)?;
        self.record_shadow(encoder);
        for (index, (_, target)) in views.iter().enumerate() {
            self.record_eye(encoder, index, target);
        }
        Ok(())
    }

    /// Checks the scene and sends the frame's data to the device.
    pub(crate) fn prepare(
        &mut self,
        scene: &Scene,
        views: impl ExactSizeIterator<Item = View>,
        size: [u32; 2],
    ) -> Result<(), RenderError> {
        self.gpu.check_size(size[0], size[1])?;
        if views.len() > MAX_VIEWS {
            return Err(RenderError::View(format!(
                "{} views at once, at most {MAX_VIEWS} are drawn",
                views.len()
            )));
        }
        let mut eyes = Vec::with_capacity(MAX_VIEWS);
        for view in views {
            view.check()?;
            eyes.push(EyeRaw {
                clip_from_world: view.clip_from_world(),
                position: view.position.extend(1.0),
            });
        }
        self.check_scene(scene)?;
        let light = scene.light.as_ref().map(LightFrame::new).transpose()?;
        self.pack_instances(scene);
        self.frame.background = scene.background;
        self.fit_passes(light.as_ref());
        self.write_uniforms(scene, &eyes, light.as_ref());
        if self
            .targets
            .as_ref()
            .is_none_or(|targets| targets.size != size)
        {
            self.targets = Some(Targets::new(&self.gpu.device, size, self.settings.samples));
        }
        Ok(())
    }

    /// Makes the passes that this frame needs, and no others.
    fn fit_passes(&mut self, light: Option<&LightFrame>) {
        let device = &self.gpu.device;
        let size = self.settings.shadow_size;
        let mut inputs = LitInputs {
            eyes: &self.eyes,
            lighting: &self.lighting,
            texture_layout: &self.texture_layout,
            shadow_map: None,
            samples: self.settings.samples,
        };
        let Some(light) = light.filter(|_| size > 0) else {
            self.frame.shadowed = false;
            self.lit_plain
                .get_or_insert_with(|| LitPass::new(device, &inputs));
            return;
        };
        self.frame.shadowed = true;
        let shadow = self
            .shadow
            .get_or_insert_with(|| ShadowPass::new(device, &self.eyes, size, light));
        let is_new = shadow.fit(device, size, light);
        inputs.shadow_map = Some(&shadow.map.view);
        match &mut self.lit_shadowed {
            Some(lit) if is_new => lit.rebind(device, &inputs),
            Some(_) => {}
            none => *none = Some(LitPass::new(device, &inputs)),
        }
    }

    fn write_uniforms(&self, scene: &Scene, eyes: &[EyeRaw], light: Option<&LightFrame>) {
        let queue = &self.gpu.queue;
        for (index, eye) in eyes.iter().enumerate() {
            queue.write_buffer(&self.eyes, eye_offset(index), bytemuck::bytes_of(eye));
        }
        if let Some(light) = light {
            let eye = EyeRaw {
                clip_from_world: light.clip_from_world,
                position: light.position,
            };
            queue.write_buffer(&self.eyes, eye_offset(MAX_VIEWS), bytemuck::bytes_of(&eye));
        }
        let map_size = self.shadow.as_ref().map(|shadow| shadow.map.size);
        let lighting = LightingRaw::new(scene, light, map_size);
        queue.write_buffer(&self.lighting, 0, bytemuck::bytes_of(&lighting));
    }

    pub(crate) fn record_shadow(&self, encoder: &mut wgpu::CommandEncoder) {
        if let (true, Some(shadow)) = (self.frame.shadowed, &self.shadow) {
            let offset = eye_offset(MAX_VIEWS) as u32;
            let batches = &self.frame.batches;
            shadow.record(encoder, offset, &self.instances, batches, &self.meshes);
        }
    }

    pub(crate) fn record_eye(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        index: usize,
        target: &wgpu::TextureView,
    ) {
        let lit = if self.frame.shadowed {
            &self.lit_shadowed
        } else {
            &self.lit_plain
        };
        let lit = lit.as_ref().expect("prepare made the pass of this frame");
        let targets = self.targets.as_ref().expect("prepare made the targets");
        lit.record(
            encoder,
            &LitDraw {
                eye_offset: eye_offset(index) as u32,
                targets,
                target,
                background: self.frame.background,
                instances: &self.instances,
                batches: &self.frame.batches,
                meshes: &self.meshes,
                textures: &self.textures,
                white: &self.white,
            },
        );
    }
}

fn eye_offset(index: usize) -> u64 {
    EYE_STRIDE * index as u64
}

#[cfg(test)]
mod tests;
