//! Draws a frame: its data on the device, and its passes in order.

mod batches;
mod check;
mod library;
mod record;

use glam::Vec4;
use image::{Rgba, RgbaImage};

use crate::passes::depth::DepthPass;
use crate::passes::hidden::HiddenPass;
use crate::passes::lit::{LitInputs, LitPass, Shading, Targets};
use crate::passes::mirror::{self, MirrorPass};
use crate::passes::shadow::{LightFrame, ShadowPass};
use crate::passes::vignette::VignettePass;
use crate::passes::{EYE_STRIDE, GpuMesh};
use crate::scene::Scene;
use crate::shaders::Lookups;
use crate::texture::{self, Texture};
use crate::uniforms::{EyeRaw, LightingRaw};
use crate::{Gpu, RenderError, View};
use batches::{Frame, instance_buffer};
pub(crate) use record::EyeTarget;

/// Most views in one frame.
pub const MAX_VIEWS: usize = 4;

/// Settings that hold as long as the renderer does.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct RendererSettings {
    /// Samples per pixel, 4, or 1 for jagged edges.
    pub samples: u32,
    /// The shadow map has this number squared of texels; 0 draws no shadows, at no cost.
    pub shadow_size: u32,
    /// The glossy floor shows what stands on it; without, at no cost, it shows lamps and sky alone.
    pub reflection: bool,
    /// Occluders and corners dim the sky; without, at no cost, it is bright everywhere.
    pub occlusion: bool,
    /// Textures have smaller copies for the distance, and highlights are as wide as a pixel needs; without, both sparkle.
    pub filtered: bool,
    /// One colour a face: no gloss, shadows, reflection or occlusion, whatever else is asked for, and no textures but of pictures.
    pub flat: bool,
}

impl RendererSettings {
    /// Everything that a scene may call for.
    pub const FULL: Self = Self {
        samples: 4,
        shadow_size: 2048,
        reflection: true,
        occlusion: true,
        filtered: true,
        flat: false,
    };
}

impl Default for RendererSettings {
    fn default() -> Self {
        Self::FULL
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
    pub(crate) texture_layout: wgpu::BindGroupLayout,
    pub(crate) sampler: wgpu::Sampler,
    /// The views' eyes, their mirror images, then the light's.
    eyes: wgpu::Buffer,
    lighting: wgpu::Buffer,
    instances: wgpu::Buffer,
    /// Made when the first scene needs them.
    shadow: Option<ShadowPass>,
    mirror: Option<MirrorPass>,
    /// One for each shading that was called for.
    lit: Vec<LitPass>,
    vignette: Option<VignettePass>,
    targets: Option<Targets>,
    /// Made when somebody first wants an eye's depth.
    depth: Option<DepthPass>,
    /// Made when there is something that an eye does not see.
    hidden: Option<HiddenPass>,
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
        let sampler = texture::sampler(gpu, settings.filtered);
        let white_pixel = RgbaImage::from_pixel(1, 1, Rgba([255; 4]));
        Ok(Self {
            settings,
            meshes: Vec::new(),
            textures: Vec::new(),
            white: Texture::new(gpu, &texture_layout, &sampler, &white_pixel.into())?,
            texture_layout,
            sampler,
            eyes: buffer("eyes", EYE_STRIDE * (LIGHT_EYE as u64 + 1), uniform),
            lighting: buffer("lighting", size_of::<LightingRaw>() as u64, uniform),
            instances: instance_buffer(device, 64),
            shadow: None,
            mirror: None,
            lit: Vec::new(),
            vignette: None,
            targets: None,
            depth: None,
            hidden: None,
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

    /// The passes that it has made so far, each with its pipeline and textures; what no scene called for is not among them.
    pub fn passes(&self) -> Vec<&'static str> {
        let mut names = Vec::new();
        names.extend(self.shadow.as_ref().map(|_| "shadow"));
        names.extend(self.mirror.as_ref().map(|_| "mirror"));
        names.extend(self.depth.as_ref().map(|_| "depth"));
        names.extend(self.hidden.as_ref().map(|_| "hidden"));
        names.extend(self.lit.iter().map(|pass| match pass.shading {
            Shading::Flat { has_pictures: true } => "flat with pictures",
            Shading::Flat { .. } => "flat",
            Shading::Smooth(lookups) if lookups.occlusion => "lit with occlusion",
            Shading::Smooth(_) => "lit",
        }));
        names.extend(self.vignette.as_ref().map(|_| "vignette"));
        names
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
            eyes.push(view);
        }
        self.check_scene(scene)?;
        let light = scene.light.as_ref().map(LightFrame::new).transpose()?;
        self.pack_instances(scene);
        self.frame.background = scene.background;
        self.fit_passes(scene, light.as_ref(), size);
        self.write_uniforms(scene, &eyes, light.as_ref(), size);
        self.fit_vignette(scene, &eyes);
        Ok(())
    }

    /// Makes what is drawn into of this size, unless it is there; with a format, what brings the depth into images of it too.
    pub(crate) fn fit_targets(&mut self, size: [u32; 2], depth: Option<wgpu::TextureFormat>) {
        let has_size = |targets: &Targets| targets.size == size;
        let has_depth = depth.is_none() || self.depth.as_ref().map(|pass| pass.format) == depth;
        if self.targets.as_ref().is_some_and(has_size) && has_depth {
            return;
        }
        let (device, samples) = (&self.gpu.device, self.settings.samples);
        let targets = Targets::new(device, size, samples, depth.is_some());
        self.depth = depth.map(|format| DepthPass::new(device, &targets.depth, samples, format));
        self.targets = Some(targets);
    }

    /// Makes the dark edge's pass when the first scene calls for it.
    fn fit_vignette(&mut self, scene: &Scene, eyes: &[View]) {
        let wanted = scene.vignette.filter(|vignette| vignette.strength > 0.0);
        self.frame.has_vignette = wanted.is_some();
        if let Some(vignette) = wanted {
            let device = &self.gpu.device;
            self.vignette
                .get_or_insert_with(|| VignettePass::new(device))
                .fit(&self.gpu, eyes, vignette);
        }
    }

    /// How this frame's surfaces are drawn: with what the settings allow and the scene calls for.
    fn shading(&self, scene: &Scene) -> Shading {
        let settings = &self.settings;
        if settings.flat {
            let mut materials = scene.instances.iter().map(|one| &one.material);
            return Shading::Flat {
                has_pictures: materials.any(|material| material.texture.is_some()),
            };
        }
        let is_glossy = || scene.instances.iter().any(|one| one.material.mirror > 0.0);
        let has_occlusion = !scene.occluders.is_empty() || scene.enclosure.is_some();
        Shading::Smooth(Lookups {
            shadows: settings.shadow_size > 0 && scene.light.is_some(),
            mirror: settings.reflection && is_glossy(),
            occlusion: settings.occlusion && has_occlusion,
        })
    }

    /// Makes the passes that this frame needs, and no others.
    fn fit_passes(&mut self, scene: &Scene, light: Option<&LightFrame>, size: [u32; 2]) {
        let device = &self.gpu.device;
        let shading = self.shading(scene);
        let lookups = shading.lookups();
        self.frame.shading = shading;
        let mut inputs = LitInputs {
            eyes: &self.eyes,
            lighting: &self.lighting,
            texture_layout: &self.texture_layout,
            shadow_map: None,
            mirror_map: None,
            samples: self.settings.samples,
            widen_highlights: self.settings.filtered,
        };
        let mut is_new = false;
        if lookups.mirror {
            let mirror = self
                .mirror
                .get_or_insert_with(|| MirrorPass::new(device, &inputs, size));
            is_new |= mirror.fit(device, size);
            inputs.mirror_map = Some((&mirror.map.view, &mirror.sampler));
        }
        if let (true, Some(light)) = (lookups.shadows, light) {
            let size = self.settings.shadow_size;
            let shadow = self
                .shadow
                .get_or_insert_with(|| ShadowPass::new(device, &self.eyes, size, light));
            is_new |= shadow.fit(device, size, light);
            inputs.shadow_map = Some(&shadow.map.view);
        }
        if is_new {
            // The others hold the maps that there were; one of them that is called for again is made anew.
            self.lit.retain(|pass| pass.shading == shading);
        }
        let known = self.lit.iter().position(|pass| pass.shading == shading);
        let place = known.unwrap_or(self.lit.len());
        match known {
            Some(place) if is_new => self.lit[place].rebind(device, &inputs),
            Some(_) => {}
            None => self.lit.push(LitPass::new(device, shading, &inputs)),
        }
        self.lit[place].fit(device, &self.frame.batches, &inputs);
    }

    fn write_uniforms(
        &self,
        scene: &Scene,
        views: &[View],
        light: Option<&LightFrame>,
        size: [u32; 2],
    ) {
        let queue = &self.gpu.queue;
        let write = |index: usize, eye: &EyeRaw| {
            queue.write_buffer(&self.eyes, eye_offset(index), bytemuck::bytes_of(eye));
        };
        for (index, view) in views.iter().enumerate() {
            let eye = EyeRaw::of_view(view, size, mirror::map_size(size));
            write(index, &eye);
            if self.frame.shading.lookups().mirror {
                write(MAX_VIEWS + index, &eye.mirrored());
            }
        }
        if let Some(light) = light {
            let eye = EyeRaw {
                clip_from_world: light.clip_from_world,
                position: light.position,
                mirror: Vec4::ZERO,
            };
            write(LIGHT_EYE, &eye);
        }
        let map_size = self.shadow.as_ref().map(|shadow| shadow.map.size);
        let lighting = LightingRaw::new(scene, light, map_size);
        queue.write_buffer(&self.lighting, 0, bytemuck::bytes_of(&lighting));
    }
}

/// Place of the light's eye in the buffer of eyes.
const LIGHT_EYE: usize = 2 * MAX_VIEWS;

fn eye_offset(index: usize) -> u64 {
    EYE_STRIDE * index as u64
}

#[cfg(test)]
mod tests;
