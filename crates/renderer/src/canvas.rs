//! Textures that show another picture, as a screen in the room does.

use crate::scene::TextureId;
use crate::texture::Texture;
use crate::{Gpu, RenderError, Renderer, Scene, View};

/// A renderer's texture that any renderer of the same device can draw on.
#[derive(Debug)]
pub struct Canvas {
    gpu: Gpu,
    view: wgpu::TextureView,
    size: [u32; 2],
}

impl Renderer {
    /// Takes a texture of `size` pixels that can be drawn on, black at first.
    ///
    /// # Errors
    /// If a side is zero or larger than the device holds.
    pub fn add_canvas(&mut self, size: [u32; 2]) -> Result<(TextureId, Canvas), RenderError> {
        self.gpu.check_size(size[0], size[1])?;
        let texture = Texture::canvas(&self.gpu, &self.texture_layout, &self.sampler, size);
        let canvas = Canvas {
            gpu: self.gpu.clone(),
            view: texture.view(),
            size,
        };
        Ok((self.take_texture(texture), canvas))
    }
}

impl Canvas {
    /// Width over height.
    pub fn aspect(&self) -> f32 {
        self.size[0] as f32 / self.size[1] as f32
    }

    /// Draws the scene on it with a renderer other than the one whose texture it is; what is drawn afterwards shows it.
    ///
    /// # Errors
    /// If the scene or the view cannot be drawn.
    pub fn paint(
        &self,
        renderer: &mut Renderer,
        scene: &Scene,
        view: View,
    ) -> Result<(), RenderError> {
        let mut encoder = self.gpu.device.create_command_encoder(&Default::default());
        renderer.record(&mut encoder, scene, &[(view, &self.view)], self.size)?;
        self.gpu.queue.submit([encoder.finish()]);
        Ok(())
    }
}
