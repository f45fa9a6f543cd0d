//! Drawing into a window: the views side by side, text over them.

use std::sync::Arc;

use image::RgbaImage;
use winit::window::Window;

use crate::offscreen::color_texture;
use crate::passes::present::{Picture, Place, PresentPass};
use crate::{BackendChoice, Gpu, RenderError, Renderer, Scene, View};

/// Where text lies over the window.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Anchor {
    /// Upper left corner.
    TopLeft,
    /// Upper right corner.
    TopRight,
    /// Middle of the window.
    Center,
    /// Lower left corner.
    BottomLeft,
    /// Middle of the lower edge.
    Bottom,
    /// Lower right corner.
    BottomRight,
}

/// Distance of text from the edge of the window [pixels].
const MARGIN: u32 = 12;

/// A window that scenes are shown in.
#[derive(Debug)]
pub struct WindowTarget {
    // Before the window, so that it is dropped first.
    surface: wgpu::Surface<'static>,
    window: Arc<Window>,
    gpu: Gpu,
    config: wgpu::SurfaceConfiguration,
    /// Width at the right edge that no view fills [pixels].
    reserved: u32,
    present: PresentPass,
    eyes: Vec<Shown>,
    overlays: Vec<(Anchor, Shown)>,
}

/// A texture and the picture of it.
#[derive(Debug)]
struct Shown {
    texture: wgpu::Texture,
    picture: Picture,
}

impl WindowTarget {
    /// Opens a device that can draw to the window, and the window's surface.
    ///
    /// # Errors
    /// If no driver can draw to this window.
    pub fn new(window: Arc<Window>, choice: BackendChoice) -> Result<(Gpu, Self), RenderError> {
        let (gpu, surface) = Gpu::open(choice, Some(&window))?;
        let surface = surface.expect("a window was given, so its surface was made");
        let config = configuration(&gpu, &surface, &window)?;
        surface.configure(&gpu.device, &config);
        let target = Self {
            present: PresentPass::new(&gpu.device, config.format),
            surface,
            window,
            gpu: gpu.clone(),
            config,
            reserved: 0,
            eyes: Vec::new(),
            overlays: Vec::new(),
        };
        Ok((gpu, target))
    }

    /// The window.
    pub fn window(&self) -> &Arc<Window> {
        &self.window
    }

    /// Follows the window to a new size [pixels]; a minimised window has none, and keeps the old one.
    pub fn resize(&mut self, width: u32, height: u32) {
        let most = self.gpu.max_side();
        if width > 0 && height > 0 {
            self.config.width = width.min(most);
            self.config.height = height.min(most);
            self.surface.configure(&self.gpu.device, &self.config);
        }
    }

    /// Keeps a strip at the right edge free of views, for what is laid over it [pixels].
    pub fn reserve_right(&mut self, width: u32) {
        self.reserved = width;
    }

    /// Width over height of the part of the window that each of `count` views may fill.
    pub fn view_aspect(&self, count: usize) -> f32 {
        let part = self.part(0, count);
        part.width as f32 / part.height as f32
    }

    /// Replaces the texts over the window, drawn in this order; an empty list shows none.
    ///
    /// # Errors
    /// If an image has no pixels or more than the device holds.
    pub fn set_overlays(&mut self, overlays: &[(Anchor, &RgbaImage)]) -> Result<(), RenderError> {
        let shown = overlays.iter().map(|(anchor, image)| {
            self.gpu.check_size(image.width(), image.height())?;
            Ok((*anchor, self.show(upload(&self.gpu, image))))
        });
        self.overlays = shown.collect::<Result<_, RenderError>>()?;
        Ok(())
    }

    /// Draws the scene for the views, side by side from the left, and shows it with the texts over it.
    ///
    /// A view whose field of view has another shape than its part of the window gets black bars, so that angles are
    /// never stretched. Returns `false`, having drawn nothing, while the window is hidden or not ready.
    ///
    /// # Errors
    /// If the scene or a view cannot be drawn, or the window is lost for good.
    pub fn draw(
        &mut self,
        renderer: &mut Renderer,
        scene: &Scene,
        views: &[View],
    ) -> Result<bool, RenderError> {
        if views.is_empty() {
            return Err(RenderError::View("there is none to show".to_owned()));
        }
        for view in views {
            view.check()?;
        }
        let Some(frame) = self.next_frame()? else {
            return Ok(false);
        };
        let mut encoder = self.gpu.device.create_command_encoder(&Default::default());
        let size = self.place_views(views);
        let targets: Vec<_> = self
            .eyes
            .iter()
            .map(|eye| eye.texture.create_view(&Default::default()))
            .collect();
        let eyes: Vec<_> = views.iter().copied().zip(&targets).collect();
        renderer.record(&mut encoder, scene, &eyes, size)?;
        self.show_frame(frame, encoder);
        Ok(true)
    }

    /// Shows the texts alone, without a renderer. Returns `false`, having drawn nothing, while the window is hidden or not ready.
    ///
    /// # Errors
    /// If the window is lost for good.
    pub fn draw_overlays(&mut self) -> Result<bool, RenderError> {
        let Some(frame) = self.next_frame()? else {
            return Ok(false);
        };
        self.eyes.clear();
        let encoder = self.gpu.device.create_command_encoder(&Default::default());
        self.show_frame(frame, encoder);
        Ok(true)
    }

    /// Puts the eyes' pictures and the texts into a frame of the surface, and shows it.
    fn show_frame(&mut self, frame: wgpu::SurfaceTexture, mut encoder: wgpu::CommandEncoder) {
        self.place_overlays();
        let overlays = self.overlays.iter().map(|(_, shown)| &shown.picture);
        let pictures = self.eyes.iter().map(|eye| &eye.picture).chain(overlays);
        let target = frame.texture.create_view(&Default::default());
        self.present.record(&mut encoder, &target, pictures);
        self.gpu.queue.submit([encoder.finish()]);
        self.window.pre_present_notify();
        self.gpu.queue.present(frame);
    }

    /// The surface's next texture, after one repair where the window changed under it.
    fn next_frame(&mut self) -> Result<Option<wgpu::SurfaceTexture>, RenderError> {
        use wgpu::CurrentSurfaceTexture as Current;
        for _ in 0..2 {
            match self.surface.get_current_texture() {
                Current::Success(frame) | Current::Suboptimal(frame) => return Ok(Some(frame)),
                Current::Timeout | Current::Occluded => return Ok(None),
                Current::Outdated => {}
                Current::Lost => {
                    self.surface = self
                        .gpu
                        .instance
                        .create_surface(self.window.clone())
                        .map_err(|error| RenderError::Window(error.to_string()))?;
                }
                Current::Validation => {
                    let reason = "its surface was refused by the driver".to_owned();
                    return Err(RenderError::Window(reason));
                }
            }
            let size = self.window.inner_size();
            self.resize(size.width, size.height);
        }
        // Changed twice within a frame, as while a border is dragged: the next frame will do.
        Ok(None)
    }

    /// The part of the window that belongs to a view.
    fn part(&self, index: usize, count: usize) -> Place {
        let free = self.config.width.saturating_sub(self.reserved);
        let width = (free / count.max(1) as u32).max(1);
        Place {
            x: width * index as u32,
            y: 0,
            width,
            height: self.config.height,
        }
    }

    /// Makes the eyes' textures fit and places their pictures; returns the textures' size.
    fn place_views(&mut self, views: &[View]) -> [u32; 2] {
        let fitted = |at: usize| self.part(at, views.len()).fit(views[at].fov.aspect());
        let places: Vec<Place> = (0..views.len()).map(fitted).collect();
        // All eyes are drawn at the size of the first: the two of a head are mirror images.
        let size = [places[0].width, places[0].height];
        let is_right = |eye: &Shown| [eye.texture.width(), eye.texture.height()] == size;
        if self.eyes.len() != views.len() || !self.eyes.iter().all(is_right) {
            self.eyes = (0..views.len())
                .map(|_| self.show(color_texture(&self.gpu, size[0], size[1])))
                .collect();
        }
        let window = [self.config.width, self.config.height];
        for (eye, place) in self.eyes.iter().zip(places) {
            let queue = &self.gpu.queue;
            self.present.place(queue, &eye.picture, place, window);
        }
        size
    }

    fn place_overlays(&self) {
        let window = [self.config.width, self.config.height];
        for (anchor, shown) in &self.overlays {
            let size = [shown.texture.width(), shown.texture.height()];
            let place = anchored(*anchor, size, window);
            self.present
                .place(&self.gpu.queue, &shown.picture, place, window);
        }
    }

    fn show(&self, texture: wgpu::Texture) -> Shown {
        let picture = self.present.picture(&self.gpu.device, &texture);
        Shown { texture, picture }
    }
}

/// Text keeps its size; what does not fit hangs over the right or lower edge.
fn anchored(anchor: Anchor, size: [u32; 2], window: [u32; 2]) -> Place {
    let far = |axis: usize| window[axis].saturating_sub(size[axis] + MARGIN);
    let middle = |axis: usize| window[axis].saturating_sub(size[axis]) / 2;
    let (x, y) = match anchor {
        Anchor::TopLeft => (MARGIN, MARGIN),
        Anchor::TopRight => (far(0), MARGIN),
        Anchor::Center => (middle(0), middle(1)),
        Anchor::BottomLeft => (MARGIN, far(1)),
        Anchor::Bottom => (middle(0), far(1)),
        Anchor::BottomRight => (far(0), far(1)),
    };
    Place {
        x,
        y,
        width: size[0],
        height: size[1],
    }
}

fn configuration(
    gpu: &Gpu,
    surface: &wgpu::Surface<'static>,
    window: &Window,
) -> Result<wgpu::SurfaceConfiguration, RenderError> {
    let size = window.inner_size();
    let most = gpu.max_side();
    let mut config = surface
        .get_default_config(
            &gpu.adapter,
            size.width.clamp(1, most),
            size.height.clamp(1, most),
        )
        .ok_or_else(|| {
            RenderError::Window(format!("the driver {} does not support it", gpu.name()))
        })?;
    let formats = surface.get_capabilities(&gpu.adapter).formats;
    // Where the surface encodes sRGB itself, text is blended in linear light as in the room.
    if let Some(format) = formats.iter().find(|format| format.is_srgb()) {
        config.format = *format;
    }
    config.present_mode = wgpu::PresentMode::AutoVsync;
    Ok(config)
}

fn upload(gpu: &Gpu, image: &RgbaImage) -> wgpu::Texture {
    let texture = color_texture(gpu, image.width(), image.height());
    gpu.queue.write_texture(
        texture.as_image_copy(),
        image.as_raw(),
        wgpu::TexelCopyBufferLayout {
            offset: 0,
            bytes_per_row: Some(4 * image.width()),
            rows_per_image: None,
        },
        texture.size(),
    );
    texture
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn anchored_keeps_text_inside_the_window() {
        let place = anchored(Anchor::BottomRight, [100, 20], [640, 480]);
        assert_eq!((place.x, place.y), (640 - 100 - MARGIN, 480 - 20 - MARGIN));
        let place = anchored(Anchor::Center, [100, 20], [640, 480]);
        assert_eq!((place.x, place.y), (270, 230));
        let place = anchored(Anchor::TopRight, [700, 20], [640, 480]);
        assert_eq!(place.x, 0, "too wide: its beginning is what is read");
    }
}
