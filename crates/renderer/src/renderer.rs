//! Meshes, textures and buffers on the device, and the passes of a frame in order.

use std::path::Path;

use glam::{Mat3, Vec3, Vec4};
use image::{Rgba, RgbaImage};

use crate::passes::lit::{LitDraw, LitInputs, LitPass, Targets};
use crate::passes::shadow::{LightFrame, ShadowPass};
use crate::passes::{Batch, EYE_STRIDE, GpuMesh};
use crate::scene::{Instance, MAX_LAMPS, MeshId, Scene, TextureId};
use crate::texture::{self, Texture};
use crate::uniforms::{EyeRaw, InstanceRaw, LampRaw, LightingRaw};
use crate::{Gpu, MeshData, RenderError, View};

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

/// What `prepare` found out about the current frame; kept to reuse its memory.
#[derive(Debug, Default)]
struct Frame {
    order: Vec<u32>,
    packed: Vec<InstanceRaw>,
    batches: Vec<Batch>,
    background: [f32; 3],
    shadowed: bool,
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

    /// Takes a mesh.
    ///
    /// # Errors
    /// If it has no triangles, an index out of range, or a number that is none.
    pub fn add_mesh(&mut self, mesh: &MeshData) -> Result<MeshId, RenderError> {
        mesh.check()?;
        self.meshes.push(GpuMesh::new(&self.gpu.device, mesh));
        Ok(MeshId(self.meshes.len() as u32 - 1))
    }

    /// Takes a mesh from an OBJ file, as [`MeshData::load_obj`] reads it.
    ///
    /// # Errors
    /// One sentence with the file and, where one is to blame, the line.
    pub fn load_obj(&mut self, path: &Path) -> Result<MeshId, RenderError> {
        self.add_mesh(&MeshData::load_obj(path)?)
    }

    /// Takes a texture, sRGB, its first row uppermost.
    ///
    /// # Errors
    /// If a side is zero or larger than the device holds.
    pub fn add_texture(&mut self, image: &RgbaImage) -> Result<TextureId, RenderError> {
        let texture = self.upload(image)?;
        self.textures.push(texture);
        Ok(TextureId(self.textures.len() as u32 - 1))
    }

    /// Takes a texture from a PNG or JPEG file.
    ///
    /// # Errors
    /// One sentence with the file.
    pub fn load_texture(&mut self, path: &Path) -> Result<TextureId, RenderError> {
        self.add_texture(&texture::load_image(path)?)
    }

    /// Shows another image on a texture, for example a score board's; the size may differ.
    ///
    /// # Errors
    /// If the texture is not this renderer's, or the image cannot be taken.
    pub fn update_texture(&mut self, id: TextureId, image: &RgbaImage) -> Result<(), RenderError> {
        let index = id.0 as usize;
        match self.textures.get(index) {
            None => return Err(RenderError::Texture("it is not this renderer's".to_owned())),
            Some(texture) if texture.replace(&self.gpu, image) => {}
            Some(_) => self.textures[index] = self.upload(image)?,
        }
        Ok(())
    }

    fn upload(&self, image: &RgbaImage) -> Result<Texture, RenderError> {
        Texture::new(&self.gpu, &self.texture_layout, &self.sampler, image)
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

    fn check_scene(&self, scene: &Scene) -> Result<(), RenderError> {
        let fail = |reason: String| Err(RenderError::Scene(reason));
        if scene.lamps.len() > MAX_LAMPS {
            let count = scene.lamps.len();
            return fail(format!(
                "it has {count} lamps, at most {MAX_LAMPS} are drawn"
            ));
        }
        let lamp_is_bad = |lamp: &crate::Lamp| {
            !(lamp.position.is_finite() && lamp.range_m.is_finite() && lamp.range_m > 0.0)
        };
        if let Some(at) = scene.lamps.iter().position(lamp_is_bad) {
            return fail(format!("lamp {at} needs a position and a range above zero"));
        }
        for (at, instance) in scene.instances.iter().enumerate() {
            if let Some(reason) = self.what_is_wrong(instance) {
                return fail(format!("instance {at} {reason}"));
            }
        }
        Ok(())
    }

    fn what_is_wrong(&self, instance: &Instance) -> Option<&'static str> {
        let material = &instance.material;
        let texture_is_known = |id: TextureId| (id.0 as usize) < self.textures.len();
        if instance.mesh.0 as usize >= self.meshes.len() {
            return Some("uses a mesh that is not this renderer's");
        }
        if !material.texture.is_none_or(texture_is_known) {
            return Some("uses a texture that is not this renderer's");
        }
        if !instance.world_from_mesh.is_finite() {
            return Some("has a transform that is not a number");
        }
        if Mat3::from_mat4(instance.world_from_mesh).determinant() <= 0.0 {
            return Some("has a transform that flattens or mirrors it");
        }
        None
    }

    /// Sorts instances into batches and sends them.
    fn pack_instances(&mut self, scene: &Scene) {
        let frame = &mut self.frame;
        let key = |at: u32| {
            let instance = &scene.instances[at as usize];
            (instance.mesh, instance.material.texture)
        };
        frame.order.clear();
        frame.order.extend(0..scene.instances.len() as u32);
        // By place in the scene last, so that the order is the same every time.
        frame.order.sort_unstable_by_key(|&at| (key(at), at));
        frame.packed.clear();
        frame.batches.clear();
        for &at in &frame.order {
            let first = frame.packed.len() as u32;
            frame
                .packed
                .push(InstanceRaw::new(&scene.instances[at as usize]));
            let (mesh, texture) = key(at);
            match frame.batches.last_mut() {
                Some(last) if (last.mesh, last.texture) == (mesh, texture) => last.count += 1,
                _ => frame.batches.push(Batch {
                    mesh,
                    texture,
                    first,
                    count: 1,
                }),
            }
        }
        let bytes: &[u8] = bytemuck::cast_slice(&frame.packed);
        if bytes.len() as u64 > self.instances.size() {
            let count = frame.packed.len().next_power_of_two();
            self.instances = instance_buffer(&self.gpu.device, count);
        }
        self.gpu.queue.write_buffer(&self.instances, 0, bytes);
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
        let lighting = lighting(scene, light, map_size);
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

fn instance_buffer(device: &wgpu::Device, count: usize) -> wgpu::Buffer {
    device.create_buffer(&wgpu::BufferDescriptor {
        label: Some("instances"),
        size: (count * size_of::<InstanceRaw>()) as u64,
        usage: wgpu::BufferUsages::VERTEX | wgpu::BufferUsages::COPY_DST,
        mapped_at_creation: false,
    })
}

fn lighting(
    scene: &Scene,
    light: Option<&LightFrame>,
    shadow_map_size: Option<[u32; 2]>,
) -> LightingRaw {
    let mut raw: LightingRaw = bytemuck::Zeroable::zeroed();
    // Without a light its colour is black, and any direction will do.
    raw.light_position = Vec4::Y;
    raw.sky = Vec3::from(scene.sky).extend(0.0);
    raw.ground = Vec3::from(scene.ground).extend(0.0);
    if let (Some(frame), Some(light)) = (light, &scene.light) {
        raw.light_clip_from_world = frame.clip_from_world;
        raw.light_position = frame.position;
        raw.light_axis = frame.axis;
        raw.light_color = Vec3::from(light.color).extend(frame.inner_cosine);
        if let Some(size) = shadow_map_size {
            (raw.shadow_step_uv, raw.shadow_reach_m) = frame.filter(light.softness_m, size);
        }
    }
    raw.lamp_count = scene.lamps.len() as u32;
    for (raw, lamp) in raw.lamps.iter_mut().zip(&scene.lamps) {
        *raw = LampRaw {
            position: lamp.position,
            range_m: lamp.range_m,
            color: lamp.color,
            padding: 0.0,
        };
    }
    raw
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::{Light, LightSource, Material};
    use crate::{BackendChoice, Fov};
    use glam::Mat4;

    fn renderer(settings: RendererSettings) -> Renderer {
        let gpu = Gpu::new(BackendChoice::Noop).expect("the test backend needs no driver");
        Renderer::new(&gpu, settings).expect("good settings")
    }

    fn view() -> View {
        View::looking_at(Vec3::Z * 3.0, Vec3::ZERO, Fov::symmetric(1.0, 1.0))
    }

    fn instance(mesh: MeshId) -> Instance {
        Instance {
            mesh,
            material: Material::new([0.5; 3]),
            world_from_mesh: Mat4::IDENTITY,
        }
    }

    fn sun() -> Light {
        Light {
            source: LightSource::Directional {
                direction: Vec3::NEG_Y,
                shadow_min: Vec3::splat(-2.0),
                shadow_max: Vec3::splat(2.0),
            },
            color: [1.0; 3],
            softness_m: 0.01,
        }
    }

    /// Every pipeline, layout and bind group is checked by the validation of a device that draws nothing.
    #[test]
    fn every_pass_validates_on_a_device_without_pixels() {
        for (shadow_size, light) in [(0, None), (0, Some(sun())), (256, Some(sun())), (256, None)] {
            for samples in [1, 4] {
                let mut renderer = renderer(RendererSettings {
                    samples,
                    shadow_size,
                });
                let mesh = renderer.add_mesh(&MeshData::quad(1.0, 1.0)).expect("good");
                let scene = Scene {
                    instances: vec![instance(mesh); 100],
                    light,
                    ..Scene::default()
                };
                let images = renderer.render(&scene, &[view(), view()], 32, 16);
                assert_eq!(images.expect("drawn").len(), 2);
            }
        }
    }

    #[test]
    fn shadows_off_make_no_pass_and_no_map() {
        let mut renderer = renderer(RendererSettings {
            samples: 1,
            shadow_size: 0,
        });
        let scene = Scene {
            light: Some(sun()),
            ..Scene::default()
        };
        renderer.render(&scene, &[view()], 8, 8).expect("drawn");
        assert!(renderer.shadow.is_none() && renderer.lit_shadowed.is_none());
    }

    #[test]
    fn instances_of_one_mesh_and_texture_are_one_batch() {
        let mut renderer = renderer(RendererSettings::default());
        let a = renderer.add_mesh(&MeshData::quad(1.0, 1.0)).expect("good");
        let b = renderer.add_mesh(&MeshData::quad(2.0, 1.0)).expect("good");
        let picture = RgbaImage::from_pixel(5, 3, Rgba([9; 4]));
        let texture = renderer.add_texture(&picture).expect("good");
        let mut scene = Scene::default();
        for at in 0..12 {
            let mut one = instance(if at % 2 == 0 { a } else { b });
            if at % 3 == 0 {
                one.material.texture = Some(texture);
            }
            scene.instances.push(one);
        }
        renderer.pack_instances(&scene);
        assert_eq!(renderer.frame.batches.len(), 4);
        let drawn: u32 = renderer.frame.batches.iter().map(|batch| batch.count).sum();
        assert_eq!(drawn, 12);
    }

    #[test]
    fn bad_scenes_are_refused_in_a_sentence() {
        let mut renderer = renderer(RendererSettings::default());
        let mesh = renderer.add_mesh(&MeshData::quad(1.0, 1.0)).expect("good");
        let mut reason = |instance: Instance| {
            let scene = Scene {
                instances: vec![instance],
                ..Scene::default()
            };
            let error = renderer.render(&scene, &[view()], 8, 8);
            error.expect_err("it is broken").to_string()
        };
        let mut bad = instance(MeshId(7));
        assert!(reason(bad).contains("instance 0 uses a mesh"));
        bad = instance(mesh);
        bad.world_from_mesh.w_axis.x = f32::NAN;
        assert!(reason(bad).contains("not a number"));
        bad = instance(mesh);
        bad.world_from_mesh = Mat4::from_scale(Vec3::new(-1.0, 1.0, 1.0));
        assert!(reason(bad).contains("mirrors"));
        bad = instance(mesh);
        bad.material.texture = Some(TextureId(0));
        assert!(reason(bad).contains("uses a texture"));
    }

    #[test]
    fn bad_settings_and_sizes_are_refused() {
        let gpu = Gpu::new(BackendChoice::Noop).expect("the test backend needs no driver");
        let with = |samples, shadow_size| {
            Renderer::new(
                &gpu,
                RendererSettings {
                    samples,
                    shadow_size,
                },
            )
        };
        assert!(with(3, 0).is_err());
        assert!(with(4, u32::MAX).is_err());
        let mut renderer = with(4, 0).expect("good settings");
        let error = renderer.render(&Scene::default(), &[view()], 0, 8);
        assert!(error.expect_err("no pixels").to_string().contains("0 x 8"));
    }

    #[test]
    fn update_texture_takes_another_size() {
        let mut renderer = renderer(RendererSettings::default());
        let small = RgbaImage::from_pixel(4, 4, Rgba([1; 4]));
        let id = renderer.add_texture(&small).expect("good");
        renderer.update_texture(id, &small).expect("same size");
        let large = RgbaImage::from_pixel(9, 2, Rgba([1; 4]));
        renderer.update_texture(id, &large).expect("other size");
        assert!(renderer.update_texture(TextureId(5), &small).is_err());
        assert!(renderer.add_texture(&RgbaImage::new(0, 3)).is_err());
    }
}
