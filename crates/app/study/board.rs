//! The experimenter's board in a window: what is on and what is next, the question that is asked, tracking and pictures, a
//! line to type in, and Stop. What it says and does is [`super::experimenter`]'s, as in the terminal.

use anyhow::Result;
use experiment::protocol::Standing;
use renderer::egui::{self, Color32, RichText};
use renderer::{Gpu, RgbaImage};
use winit::event::WindowEvent;
use winit::window::Window;

use super::experimenter::{self, HELP, Told};
use super::pane::Pane;
use crate::session::Session;

/// Width of the board [points].
pub const WIDTH: f32 = 380.0;

pub(super) const GROUND: Color32 = Color32::from_rgb(24, 26, 32);
pub(super) const LETTERS: Color32 = Color32::from_rgb(240, 236, 228);
pub(super) const FAINT: Color32 = Color32::from_rgb(130, 130, 130);
pub(super) const ON: Color32 = Color32::from_rgb(120, 210, 160);
const STOP: Color32 = Color32::from_rgb(150, 44, 40);
pub(super) const WARNING: Color32 = Color32::from_rgb(255, 180, 80);
/// Height of the Stop button, which nobody should have to aim at [points].
const STOP_HEIGHT: f32 = 44.0;

/// The board.
pub struct Board {
    pane: Pane,
    content: Content,
    told: Option<Told>,
}

/// What is on the board besides what is told.
#[derive(Debug, Default)]
struct Content {
    /// What is being typed.
    line: String,
    /// What was said to the last line.
    reply: String,
    /// Lines that were sent and not yet taken.
    sent: Vec<String>,
}

impl Board {
    /// A board in `window`, painted with `gpu`.
    pub fn new(gpu: &Gpu, window: &Window) -> Self {
        let content = Content {
            reply: HELP.to_owned(),
            ..Content::default()
        };
        Self {
            pane: Pane::new(gpu, window),
            content,
            told: None,
        }
    }

    /// Hears what happens in the window.
    pub fn hear(&mut self, window: &Window, event: &WindowEvent) {
        self.pane.hear(window, event);
    }

    /// Does what was typed and clicked.
    ///
    /// # Errors
    /// When the journal cannot be written.
    pub fn act(&mut self, session: &mut Session) -> Result<()> {
        for line in std::mem::take(&mut self.content.sent) {
            self.content.reply = experimenter::take(&line, session)?.unwrap_or_default();
            self.pane.stir();
        }
        Ok(())
    }

    /// The board as an image of the whole window, clear beside the board; `None` when it looks as before.
    ///
    /// # Errors
    /// When the device does not paint it.
    pub fn image(&mut self, window: &Window, told: &Told) -> Result<Option<RgbaImage>> {
        if self.told.as_ref() != Some(told) {
            self.told = Some(told.clone());
            self.pane.renew();
        }
        let content = &mut self.content;
        let image = self.pane.image(window, |ui| show(ui, told, content))?;
        // A line that was sent is answered in the next picture.
        if !self.content.sent.is_empty() {
            self.pane.stir();
        }
        Ok(image)
    }
}

impl Content {
    fn send(&mut self, line: String) {
        self.sent.push(line);
        self.line.clear();
    }

    /// Ends the session; what stands in the line is the reason.
    fn stop(&mut self) {
        self.send(format!("/stop {}", self.line));
    }
}

fn show(ui: &mut egui::Ui, told: &Told, content: &mut Content) {
    let frame = egui::Frame::new().fill(GROUND).inner_margin(14.0);
    egui::Panel::right("board")
        .exact_size(WIDTH)
        .resizable(false)
        .frame(frame)
        .show(ui, |ui| {
            ui.visuals_mut().override_text_color = Some(LETTERS);
            let is_stopped = stop(ui);
            ui.add_space(10.0);
            ui.label(RichText::new(&told.due).size(17.0).strong());
            ui.add_space(6.0);
            typing(ui, content);
            // After what was typed just before it: that is the reason.
            if is_stopped {
                content.stop();
            }
            ui.add_space(10.0);
            parts(ui, told);
            ui.add_space(10.0);
            health(ui, told);
        });
}

/// Whether Stop is clicked, or its key pressed.
fn stop(ui: &mut egui::Ui) -> bool {
    let words = RichText::new("Stop the session (Esc)").size(18.0).strong();
    let button = egui::Button::new(words).fill(STOP);
    let size = egui::vec2(ui.available_width(), STOP_HEIGHT);
    let is_key = ui.input(|input| input.key_pressed(egui::Key::Escape));
    ui.add_sized(size, button).clicked() || is_key
}

/// The line, and what can be done with it.
fn typing(ui: &mut egui::Ui, content: &mut Content) {
    let edit = egui::TextEdit::singleline(&mut content.line)
        .hint_text("answer, or words of a note")
        .desired_width(f32::INFINITY);
    let line = ui.add(edit);
    let is_entered = line.lost_focus() && ui.input(|input| input.key_pressed(egui::Key::Enter));
    ui.horizontal(|ui| {
        let mut is_clicked = |words: &str| ui.button(words).clicked();
        if is_clicked("Answer") || is_entered {
            let line = content.line.clone();
            content.send(line);
        }
        if is_clicked("Back") {
            content.send("back".to_owned());
        }
        if is_clicked("Keep as a note") {
            content.send(format!("/note {}", content.line));
        }
    });
    // Whoever types need not click first.
    line.request_focus();
    ui.label(RichText::new(&content.reply).size(12.0).color(FAINT));
}

fn parts(ui: &mut egui::Ui, told: &Told) {
    for part in &told.parts {
        let (mark, color) = match part.standing {
            Standing::Done => ("done", FAINT),
            Standing::On => ("now", ON),
            Standing::Next => ("next", LETTERS),
            Standing::Later => ("", FAINT),
        };
        ui.horizontal(|ui| {
            let width = egui::vec2(40.0, 16.0);
            ui.add_sized(width, egui::Label::new(RichText::new(mark).color(color)));
            ui.label(RichText::new(&part.name).color(color));
        });
    }
}

fn health(ui: &mut egui::Ui, told: &Told) {
    for line in &told.health {
        let is_bad = line.contains("LOST") || line.contains("WAITS");
        let color = if is_bad { WARNING } else { LETTERS };
        ui.label(RichText::new(line).size(13.0).color(color));
    }
}
