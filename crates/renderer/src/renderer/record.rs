//! The passes of a prepared frame, recorded in their order.

use super::{HiddenPass, LIGHT_EYE, MAX_VIEWS, Renderer, eye_offset};
use crate::passes::hidden::HiddenMesh;
use crate::passes::lit::{LitDraw, LitPass};
use crate::passes::mirror::MirrorDraw;
use crate::{RenderError, Scene, View};

/// What an eye is drawn into.
#[derive(Clone, Copy, Debug)]
pub(crate) struct EyeTarget<'a> {
    pub color: &'a wgpu::TextureView,
    /// Where its depth goes, if somebody wants it: an image of the same size, of any format for depth.
    pub depth: Option<&'a wgpu::TextureView>,
    /// What is not seen of the picture.
    pub hidden: Option<&'a HiddenMesh>,
}

impl<'a> EyeTarget<'a> {
    /// The picture and nothing else.
    pub fn picture(color: &'a wgpu::TextureView) -> Self {
        Self {
            color,
            depth: None,
            hidden: None,
        }
    }
}

impl Renderer {
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
        let pictures = views
            .iter()
            .map(|(view, color)| (*view, EyeTarget::picture(color)));
        let eyes: Vec<_> = pictures.collect();
        self.record_eyes(encoder, scene, &eyes, size)
    }

    /// As [`Renderer::record`], with what else is wanted of each eye.
    pub(crate) fn record_eyes(
        &mut self,
        encoder: &mut wgpu::CommandEncoder,
        scene: &Scene,
        eyes: &[(View, EyeTarget<'_>)],
        size: [u32; 2],
    ) -> Result<(), RenderError> {
        self.prepare(scene, eyes.iter().map(|(view, _)| *view), size)?;
        let wanted = eyes.iter().find_map(|(_, eye)| eye.depth);
        self.fit_targets(size, wanted.map(|depth| depth.texture().format()));
        if eyes.iter().any(|(_, eye)| eye.hidden.is_some()) {
            let (device, samples) = (&self.gpu.device, self.settings.samples);
            self.hidden
                .get_or_insert_with(|| HiddenPass::new(device, samples));
        }
        self.record_shadow(encoder);
        for (index, (_, eye)) in eyes.iter().enumerate() {
            self.record_eye(encoder, index, *eye);
        }
        Ok(())
    }

    pub(crate) fn record_shadow(&self, encoder: &mut wgpu::CommandEncoder) {
        let is_shadowed = self.frame.shading.lookups().shadows;
        if let (true, Some(shadow)) = (is_shadowed, &self.shadow) {
            let offset = eye_offset(LIGHT_EYE) as u32;
            let batches = &self.frame.batches;
            shadow.record(encoder, offset, &self.instances, batches, &self.meshes);
        }
    }

    /// The image in the floor for one eye; only that eye's lit pass may follow before the next one's.
    fn record_mirror(&self, encoder: &mut wgpu::CommandEncoder, index: usize) {
        let is_glossy = self.frame.shading.lookups().mirror;
        let Some(mirror) = self.mirror.as_ref().filter(|_| is_glossy) else {
            return;
        };
        mirror.record(
            encoder,
            &MirrorDraw {
                eye_offset: eye_offset(MAX_VIEWS + index) as u32,
                background: self.frame.background,
                instances: &self.instances,
                batches: &self.frame.batches,
                meshes: &self.meshes,
                textures: &self.textures,
                white: &self.white,
            },
        );
    }

    pub(crate) fn record_eye(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        index: usize,
        eye: EyeTarget<'_>,
    ) {
        self.record_mirror(encoder, index);
        let is_due = |pass: &&LitPass| pass.shading == self.frame.shading;
        let lit = self.lit.iter().find(is_due);
        let lit = lit.expect("prepare made the pass of this frame");
        let targets = self.targets.as_ref().expect("the frame's size was fitted");
        lit.record(
            encoder,
            &LitDraw {
                eye_offset: eye_offset(index) as u32,
                targets,
                target: eye.color,
                depth_store: match eye.depth {
                    Some(_) => wgpu::StoreOp::Store,
                    None => wgpu::StoreOp::Discard,
                },
                hidden: self.hidden.as_ref().zip(eye.hidden),
                background: self.frame.background,
                instances: &self.instances,
                batches: &self.frame.batches,
                meshes: &self.meshes,
                textures: &self.textures,
                white: &self.white,
            },
        );
        if let (true, Some(pass)) = (self.frame.has_vignette, &self.vignette) {
            pass.record(encoder, index, eye.color);
        }
        if let (Some(pass), Some(depth)) = (&self.depth, eye.depth) {
            pass.record(encoder, depth);
        }
    }
}
