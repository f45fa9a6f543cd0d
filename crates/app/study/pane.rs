//! A user interface in a window: it hears the window's events and is painted to an image, as all text is, when something on it has
//! changed.

use anyhow::{Context, Result};
use renderer::egui;
use renderer::{Gpu, RgbaImage, TextPainter};
use winit::event::WindowEvent;
use winit::window::Window;

/// Pictures that a user interface takes to come to rest after an event.
const PICTURES_AFTER_EVENT: u8 = 3;

/// The user interface of one window.
pub struct Pane {
    painter: TextPainter,
    events: egui_winit::State,
    size: Option<[u32; 2]>,
    /// Pictures that are still due although nothing new is shown.
    due: u8,
}

impl Pane {
    /// One in `window`, painted with `gpu`.
    pub fn new(gpu: &Gpu, window: &Window) -> Self {
        let painter = TextPainter::new(gpu);
        let events = egui_winit::State::new(
            painter.context().clone(),
            egui::ViewportId::ROOT,
            window,
            Some(window.scale_factor() as f32),
            None,
            None,
        );
        Self {
            painter,
            events,
            size: None,
            due: PICTURES_AFTER_EVENT,
        }
    }

    /// Hears what happens in the window.
    pub fn hear(&mut self, window: &Window, event: &WindowEvent) {
        if self.events.on_window_event(window, event).repaint {
            self.stir();
        }
    }

    /// Something was done with it.
    pub fn stir(&mut self) {
        self.due = PICTURES_AFTER_EVENT;
    }

    /// Something new is to be shown.
    pub fn renew(&mut self) {
        self.due = self.due.max(1);
    }

    /// The image of the whole window, clear where `show` puts nothing; `None` when it looks as before.
    ///
    /// # Errors
    /// When the device does not paint it.
    pub fn image(
        &mut self,
        window: &Window,
        mut show: impl FnMut(&mut egui::Ui),
    ) -> Result<Option<RgbaImage>> {
        let size = window.inner_size();
        let size = [size.width.max(1), size.height.max(1)];
        if self.size == Some(size) && self.due == 0 {
            return Ok(None);
        }
        self.size = Some(size);
        self.due = self.due.saturating_sub(1);
        let mut input = self.events.take_egui_input(window);
        let is_click =
            |event: &egui::Event| matches!(event, egui::Event::PointerButton { pressed: true, .. });
        // A click takes the keys from a line, and in one picture with it what was typed before would be lost.
        if let Some(at @ 1..) = input.events.iter().position(is_click) {
            let clicked = input.events.split_off(at);
            self.pass(input.clone(), size, &mut show)?;
            input.events = clicked;
        }
        self.pass(input, size, &mut show).map(Some)
    }

    /// The image after what the window heard.
    fn pass(
        &mut self,
        input: egui::RawInput,
        size: [u32; 2],
        show: &mut impl FnMut(&mut egui::Ui),
    ) -> Result<RgbaImage> {
        let image = self.painter.interact(input, size[0], size[1], show);
        image.context("cannot paint what is shown to the experimenter")
    }
}
