//! Drawing into images, with neither a screen nor a headset.

use image::RgbaImage;

use crate::passes::lit::COLOR_FORMAT;
use crate::renderer::EyeTarget;
use crate::{Gpu, RenderError, Renderer, Scene, View, texture};

impl Renderer {
    /// Draws the scene for each view and brings the images back, sRGB, first row uppermost.
    ///
    /// The same scene gives the same bytes every time on the same driver.
    ///
    /// # Errors
    /// If the scene, a view or the size cannot be drawn.
    pub fn render(
        &mut self,
        scene: &Scene,
        views: &[View],
        width: u32,
        height: u32,
    ) -> Result<Vec<RgbaImage>, RenderError> {
        self.prepare(scene, views.iter().copied(), [width, height])?;
        self.fit_targets([width, height], None);
        if views.is_empty() {
            return Ok(Vec::new());
        }
        let device = &self.gpu.device;
        let target = color_texture(&self.gpu, width, height);
        let target_view = target.create_view(&Default::default());
        let readback = Readback::new(device, width, height, views.len());
        let mut encoder = device.create_command_encoder(&Default::default());
        self.record_shadow(&mut encoder);
        for index in 0..views.len() {
            self.record_eye(&mut encoder, index, EyeTarget::picture(&target_view));
            readback.copy(&mut encoder, &target, index);
        }
        self.gpu.queue.submit([encoder.finish()]);
        readback.images(device)
    }
}

/// A texture that an eye can be drawn into or an image written to, and that is shown or copied from.
pub(crate) fn color_texture(gpu: &Gpu, width: u32, height: u32) -> wgpu::Texture {
    let usage = wgpu::TextureUsages::RENDER_ATTACHMENT
        | wgpu::TextureUsages::COPY_SRC
        | wgpu::TextureUsages::COPY_DST
        | wgpu::TextureUsages::TEXTURE_BINDING;
    texture::single(&gpu.device, "eye", [width, height], 1, COLOR_FORMAT, usage)
}

/// Brings images of four bytes per pixel back from the device.
pub(crate) struct Readback {
    buffer: wgpu::Buffer,
    width: u32,
    height: u32,
    bytes_per_row: u32,
}

impl Readback {
    pub fn new(device: &wgpu::Device, width: u32, height: u32, count: usize) -> Self {
        let bytes_per_row = (4 * width).next_multiple_of(wgpu::COPY_BYTES_PER_ROW_ALIGNMENT);
        let image_bytes = u64::from(bytes_per_row) * u64::from(height);
        let buffer = device.create_buffer(&wgpu::BufferDescriptor {
            label: Some("readback"),
            size: image_bytes * count as u64,
            usage: wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::MAP_READ,
            mapped_at_creation: false,
        });
        Self {
            buffer,
            width,
            height,
            bytes_per_row,
        }
    }

    fn image_bytes(&self) -> u64 {
        u64::from(self.bytes_per_row) * u64::from(self.height)
    }

    /// Records the copy of `texture` to the image number `index`.
    pub fn copy(&self, encoder: &mut wgpu::CommandEncoder, texture: &wgpu::Texture, index: usize) {
        encoder.copy_texture_to_buffer(
            texture.as_image_copy(),
            wgpu::TexelCopyBufferInfo {
                buffer: &self.buffer,
                layout: wgpu::TexelCopyBufferLayout {
                    offset: self.image_bytes() * index as u64,
                    bytes_per_row: Some(self.bytes_per_row),
                    rows_per_image: None,
                },
            },
            texture.size(),
        );
    }

    /// Waits for the copies, which must have been submitted, and returns the images.
    pub fn images(self, device: &wgpu::Device) -> Result<Vec<RgbaImage>, RenderError> {
        let fail = |reason: String| RenderError::Readback(reason);
        let (sender, receiver) = std::sync::mpsc::channel();
        self.buffer
            .map_async(wgpu::MapMode::Read, .., move |result| {
                // The receiver outlives the poll below; if that failed, its error is the one to report.
                let _ = sender.send(result);
            });
        device
            .poll(wgpu::PollType::wait_indefinitely())
            .map_err(|error| fail(error.to_string()))?;
        receiver
            .recv()
            .map_err(|error| fail(error.to_string()))?
            .map_err(|error| fail(error.to_string()))?;
        let bytes = self
            .buffer
            .get_mapped_range(..)
            .map_err(|error| fail(error.to_string()))?;
        let row_bytes = 4 * self.width as usize;
        let images = bytes
            .chunks_exact(self.image_bytes() as usize)
            .map(|image| {
                let rows = image.chunks_exact(self.bytes_per_row as usize);
                let pixels = rows.flat_map(|row| &row[..row_bytes]).copied().collect();
                RgbaImage::from_raw(self.width, self.height, pixels)
                    .expect("the rows make up the whole image")
            });
        Ok(images.collect())
    }
}
