//! Text, painted by egui into images: captions under pictures, text over the window, boards in the room.

use image::RgbaImage;

use crate::offscreen::Readback;
use crate::{Gpu, RenderError, texture};

/// egui's colours are sRGB bytes and are blended as such, so the target must not encode.
const FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba8Unorm;

/// A block of text on a plain, perhaps translucent, ground.
#[derive(Clone, Debug, PartialEq)]
pub struct TextBlock {
    /// The text; `\n` ends a line, and lines that are too long for the width are wrapped.
    pub text: String,
    /// Size of the letters [pixels].
    pub size_px: f32,
    /// Letters of equal width, for tables.
    pub monospace: bool,
    /// Colour of the letters, sRGB and alpha.
    pub color: [u8; 4],
    /// Colour behind them, sRGB and alpha.
    pub background: [u8; 4],
    /// Space round the text [pixels].
    pub padding_px: u32,
    /// Width of the image [pixels]; `None` takes what the text needs.
    pub width: Option<u32>,
    /// Height of the image [pixels]; `None` takes what the text needs.
    pub height: Option<u32>,
}

impl TextBlock {
    /// Light letters of 16 pixels on a dark translucent ground, as large as the text needs.
    pub fn new(text: impl Into<String>) -> Self {
        Self {
            text: text.into(),
            size_px: 16.0,
            monospace: false,
            color: [240, 236, 228, 255],
            background: [12, 10, 8, 190],
            padding_px: 8,
            width: None,
            height: None,
        }
    }
}

/// Paints text into images with one device.
///
/// The same image serves a file, [`crate::WindowTarget::set_overlays`] and [`crate::Renderer::update_texture`].
pub struct TextPainter {
    gpu: Gpu,
    context: egui::Context,
    painter: egui_wgpu::Renderer,
}

impl TextPainter {
    /// A painter with egui's own fonts.
    pub fn new(gpu: &Gpu) -> Self {
        let options = egui_wgpu::RendererOptions::PREDICTABLE;
        Self {
            gpu: gpu.clone(),
            context: egui::Context::default(),
            painter: egui_wgpu::Renderer::new(&gpu.device, FORMAT, options),
        }
    }

    /// A strip of the given width for under or over a picture, as high as the text needs.
    ///
    /// # Errors
    /// If the width is not one that the device draws.
    pub fn caption(&mut self, text: &str, width: u32) -> Result<RgbaImage, RenderError> {
        self.block(&TextBlock {
            size_px: 14.0,
            padding_px: 5,
            width: Some(width),
            ..TextBlock::new(text)
        })
    }

    /// A block of text as an image.
    ///
    /// # Errors
    /// If the image would have a size that the device does not draw.
    pub fn block(&mut self, block: &TextBlock) -> Result<RgbaImage, RenderError> {
        if !(1.0..=500.0).contains(&block.size_px) {
            return Err(RenderError::Unsupported(format!(
                "letters of {} pixels cannot be drawn: choose 1 to 500",
                block.size_px
            )));
        }
        let padding = block.padding_px as f32;
        let wrap = block.width.map_or(f32::INFINITY, |width| {
            (width as f32 - 2.0 * padding).max(1.0)
        });
        let font = if block.monospace {
            egui::FontId::monospace(block.size_px)
        } else {
            egui::FontId::proportional(block.size_px)
        };
        let mut needed = egui::Vec2::ZERO;
        let output = self.run(self.gpu.max_side(), self.gpu.max_side(), |ui| {
            let painter = ui.ctx().debug_painter();
            let galley = painter.layout(block.text.clone(), font.clone(), color(block.color), wrap);
            needed = galley.size();
            painter.galley(egui::pos2(padding, padding), galley, color(block.color));
        });
        let side = |fixed: Option<u32>, needed: f32| {
            fixed.unwrap_or((needed + 2.0 * padding).ceil() as u32)
        };
        let (width, height) = (side(block.width, needed.x), side(block.height, needed.y));
        self.finish(output, width, height, block.background)
    }

    /// An image of whatever `add_contents` puts into an egui user interface, for boards with more than text.
    ///
    /// # Errors
    /// If the size is not one that the device draws.
    pub fn paint(
        &mut self,
        width: u32,
        height: u32,
        background: [u8; 4],
        add_contents: impl FnMut(&mut egui::Ui),
    ) -> Result<RgbaImage, RenderError> {
        let output = self.run(width, height, add_contents);
        self.finish(output, width, height, background)
    }

    /// egui's context, for whoever turns a window's events into its input.
    pub fn context(&self) -> &egui::Context {
        &self.context
    }

    /// The image of a user interface that heard `input`: [`TextPainter::paint`] for one that is clicked and typed into. It keeps
    /// its state from one call to the next, so it has a painter of its own.
    ///
    /// # Errors
    /// If the size [pixels] is not one that the device draws.
    pub fn interact(
        &mut self,
        input: egui::RawInput,
        width: u32,
        height: u32,
        add_contents: impl FnMut(&mut egui::Ui),
    ) -> Result<RgbaImage, RenderError> {
        let output = self.context.run_ui(input, add_contents);
        self.finish(output, width, height, [0; 4])
    }

    fn run(
        &self,
        width: u32,
        height: u32,
        add_contents: impl FnMut(&mut egui::Ui),
    ) -> egui::FullOutput {
        let size = egui::vec2(width as f32, height as f32);
        let input = egui::RawInput {
            screen_rect: Some(egui::Rect::from_min_size(egui::Pos2::ZERO, size)),
            max_texture_side: Some(self.gpu.max_side() as usize),
            // No clock: the same contents give the same image.
            time: Some(0.0),
            ..Default::default()
        };
        self.context.run_ui(input, add_contents)
    }

    /// Paints what egui put out.
    fn finish(
        &mut self,
        mut output: egui::FullOutput,
        width: u32,
        height: u32,
        background: [u8; 4],
    ) -> Result<RgbaImage, RenderError> {
        let (device, queue) = (&self.gpu.device, &self.gpu.queue);
        for (id, deltas) in &output.textures_delta.set {
            for delta in deltas {
                self.painter.update_texture(device, queue, *id, delta);
            }
        }
        let freed = std::mem::take(&mut output.textures_delta.free);
        output.textures_delta.clear();
        let checked = self.gpu.check_size(width, height);
        let image = checked.and_then(|()| self.draw(output, width, height, background));
        for id in &freed {
            self.painter.free_texture(id);
        }
        image
    }

    fn draw(
        &mut self,
        output: egui::FullOutput,
        width: u32,
        height: u32,
        background: [u8; 4],
    ) -> Result<RgbaImage, RenderError> {
        let (device, queue) = (&self.gpu.device, &self.gpu.queue);
        let pixels_per_point = output.pixels_per_point;
        let jobs = self.context.tessellate(output.shapes, pixels_per_point);
        let screen = egui_wgpu::ScreenDescriptor {
            size_in_pixels: [width, height],
            pixels_per_point,
        };
        let usage = wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::COPY_SRC;
        let target = texture::single(device, "text", [width, height], 1, FORMAT, usage);
        let view = target.create_view(&Default::default());
        let mut encoder = device.create_command_encoder(&Default::default());
        // The buffers are all there is to prepare: no custom painting, so no command buffers of its own.
        self.painter
            .update_buffers(device, queue, &mut encoder, &jobs, &screen);
        let pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("text"),
            color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                view: &view,
                depth_slice: None,
                resolve_target: None,
                ops: wgpu::Operations {
                    load: wgpu::LoadOp::Clear(premultiplied(background)),
                    store: wgpu::StoreOp::Store,
                },
            })],
            ..Default::default()
        });
        self.painter
            .render(&mut pass.forget_lifetime(), &jobs, &screen);
        let readback = Readback::new(device, width, height, 1);
        readback.copy(&mut encoder, &target, 0);
        queue.submit([encoder.finish()]);
        let mut image = readback
            .images(device)?
            .pop()
            .expect("one image was asked for");
        image
            .pixels_mut()
            .for_each(|pixel| straighten(&mut pixel.0));
        Ok(image)
    }
}

fn color([r, g, b, a]: [u8; 4]) -> egui::Color32 {
    egui::Color32::from_rgba_unmultiplied(r, g, b, a)
}

/// egui blends colours that are multiplied by their alpha already.
fn premultiplied([r, g, b, a]: [u8; 4]) -> wgpu::Color {
    let a = f64::from(a) / 255.0;
    let [r, g, b] = [r, g, b].map(|byte| a * f64::from(byte) / 255.0);
    wgpu::Color { r, g, b, a }
}

/// Image files and textures hold colours that are not multiplied.
fn straighten(pixel: &mut [u8; 4]) {
    let a = u32::from(pixel[3]);
    for value in &mut pixel[..3] {
        // Where nothing covers, the colour stays black.
        let straight = (u32::from(*value) * 255 + a / 2).checked_div(a);
        *value = straight.unwrap_or(0).min(255) as u8;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn straighten_undoes_premultiplication() {
        let mut pixel = [60, 30, 0, 120];
        straighten(&mut pixel);
        assert_eq!(pixel, [128, 64, 0, 120]);
        let mut clear = [0, 0, 0, 0];
        straighten(&mut clear);
        assert_eq!(clear, [0, 0, 0, 0]);
    }
}
