//! The gate before a session: what the participant has ticked on the consent form, said in a window where there is a screen, or in the
//! terminal; whichever has it all first counts.
//!
//! The window has the form's text, so that it can be read there too, its version and its SHA-256. Nothing is written before the gate is
//! passed.

use std::io::Write;
use std::sync::Arc;
use std::sync::mpsc::RecvTimeoutError;
use std::time::{Duration, Instant};

use anyhow::{Result, bail};
use experiment::consent::{Consent, ConsentError, ConsentForm, TICKS, Ticks};
use experiment::study::Study;
use renderer::egui::{self, RichText};
use renderer::{Anchor, BackendChoice, WindowTarget};
use winit::application::ApplicationHandler;
use winit::dpi::LogicalSize;
use winit::event::WindowEvent;
use winit::event_loop::{ActiveEventLoop, ControlFlow, EventLoop};
use winit::platform::run_on_demand::EventLoopExtRunOnDemand;
use winit::window::{Window, WindowId};

use super::board::{FAINT, GROUND, LETTERS, ON, WARNING};
use super::console::Console;
use super::pane::Pane;
use super::{form, today};

/// Size of the window at first [points].
const SIZE: (f64, f64) = (640.0, 700.0);
/// Height of the strip with the ticks [points].
const STRIP: f32 = 260.0;
/// Time between two pictures, and between two looks at the terminal.
const PERIOD: Duration = Duration::from_millis(50);

/// Asks what is ticked; returns the consent, and the window system where a window could be opened.
///
/// # Errors
/// When the participant does not take part, the form cannot be agreed to, or nobody says anything any more.
pub fn pass(study: &Study, console: &Console) -> Result<(Consent, Option<EventLoop<()>>)> {
    let form = study.consent_form();
    // A form that nobody can agree to is not read out.
    form.agree(EVERYTHING, &today())?;
    println!(
        "Consent form {} (SHA-256 {}), in {}.\nThe participant has read it. What is ticked?",
        form.version,
        &form.sha256[..12],
        study.plan_folder().join("consent.md").display()
    );
    let mut gate = Gate {
        form,
        console,
        said: Vec::new(),
        has_terminal: true,
        ticks: Ticks::default(),
        stage: None,
        is_given_up: false,
        outcome: None,
        due: Instant::now(),
    };
    gate.ask();
    let display = crate::choose::display().ok();
    let mut events = display.and_then(|()| EventLoop::new().ok());
    if let Some(events) = &mut events {
        println!("(Or tick it in the window \"{TITLE}\".)");
        if let Err(error) = events.run_app_on_demand(&mut gate) {
            println!("No consent window any more: {error}. The terminal asks.");
        }
        gate.stage = None;
    }
    while gate.outcome.is_none() {
        if !gate.has_terminal {
            bail!("the terminal is closed, so that nobody can say what was ticked");
        }
        gate.listen(PERIOD);
    }
    let consent = gate.outcome.unwrap_or(Err(ConsentError::NotTakingPart))?;
    Ok((consent, events))
}

const TITLE: &str = "Bowling: consent";
const EVERYTHING: Ticks = Ticks {
    take_part: true,
    share_data: true,
    share_motion: true,
    contact: true,
};

/// The form while it is ticked.
struct Gate<'a> {
    form: &'a ConsentForm,
    console: &'a Console,
    /// What was said in the terminal so far.
    said: Vec<bool>,
    /// Somebody may still type.
    has_terminal: bool,
    /// What is ticked in the window.
    ticks: Ticks,
    stage: Option<Stage>,
    /// The window could not be opened, or drawing into it failed.
    is_given_up: bool,
    outcome: Option<Result<Consent, ConsentError>>,
    due: Instant,
}

/// What exists once the window does.
struct Stage {
    target: WindowTarget,
    pane: Pane,
}

/// What was done in the window.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Done {
    Begin,
    Leave,
}

impl Gate<'_> {
    /// Asks in the terminal for the next tick.
    fn ask(&self) {
        if let Some(name) = TICKS.get(self.said.len()) {
            print!("  {} [y/n] ", name.replace('_', " "));
            // A closed output has nobody to ask; the window or the next line tells.
            let _ = std::io::stdout().flush();
        }
    }

    /// Takes what was typed, waiting for it at most so long.
    fn listen(&mut self, wait: Duration) {
        let line = match self.console.line(wait) {
            Ok(line) => line,
            Err(RecvTimeoutError::Timeout) => return,
            Err(RecvTimeoutError::Disconnected) => {
                self.has_terminal = false;
                return;
            }
        };
        match line.trim().to_lowercase().as_str() {
            "y" | "yes" => self.said.push(true),
            "n" | "no" => self.said.push(false),
            _ => {}
        }
        if let [take_part, share_data, share_motion, contact] = self.said[..] {
            let ticks = Ticks {
                take_part,
                share_data,
                share_motion,
                contact,
            };
            self.outcome = Some(self.form.agree(ticks, &today()));
        }
        self.ask();
    }

    fn open(events: &ActiveEventLoop) -> Result<Stage> {
        let attributes = Window::default_attributes()
            .with_title(TITLE)
            .with_inner_size(LogicalSize::new(SIZE.0, SIZE.1));
        let window = Arc::new(events.create_window(attributes)?);
        let (gpu, target) = WindowTarget::new(window, BackendChoice::Auto)?;
        let pane = Pane::new(&gpu, target.window());
        Ok(Stage { target, pane })
    }

    fn draw(&mut self) -> Result<()> {
        let Some(Stage { target, pane }) = &mut self.stage else {
            return Ok(());
        };
        let mut done = None;
        let window = Arc::clone(target.window());
        let (form, ticks) = (self.form, &mut self.ticks);
        let image = pane.image(&window, |ui| show(ui, form, ticks, &mut done))?;
        if let Some(image) = image {
            target.set_overlays(&[(Anchor::Center, &image)])?;
        }
        target.draw_overlays()?;
        match done {
            Some(Done::Begin) => self.outcome = Some(self.form.agree(self.ticks, &today())),
            Some(Done::Leave) => self.outcome = Some(Err(ConsentError::NotTakingPart)),
            None => {}
        }
        Ok(())
    }

    fn give_up(&mut self, error: &anyhow::Error) {
        self.stage = None;
        self.is_given_up = true;
        println!("No consent window: {error:#}. The terminal asks.");
    }
}

/// The form above, the ticks below.
fn show(ui: &mut egui::Ui, consent: &ConsentForm, ticks: &mut Ticks, done: &mut Option<Done>) {
    let frame = egui::Frame::new().fill(GROUND).inner_margin(14.0);
    egui::Panel::bottom("ticks")
        .exact_size(STRIP)
        .resizable(false)
        .frame(frame)
        .show(ui, |ui| {
            ui.visuals_mut().override_text_color = Some(LETTERS);
            tick(ui, consent, ticks, done);
        });
    egui::CentralPanel::default().frame(frame).show(ui, |ui| {
        ui.visuals_mut().override_text_color = Some(LETTERS);
        egui::ScrollArea::vertical().show(ui, |ui| {
            form::show(ui, &consent.text);
        });
    });
}

fn tick(ui: &mut egui::Ui, form: &ConsentForm, ticks: &mut Ticks, done: &mut Option<Done>) {
    let boxes = [
        &mut ticks.take_part,
        &mut ticks.share_data,
        &mut ticks.share_motion,
        &mut ticks.contact,
    ];
    for (name, is_ticked) in TICKS.into_iter().zip(boxes) {
        let words = form
            .tick(name)
            .map_or(name.replace('_', " "), str::to_owned);
        ui.checkbox(is_ticked, RichText::new(words).size(15.0));
    }
    ui.add_space(6.0);
    let print = format!("Version {}, SHA-256 {}", form.version, form.sha256);
    ui.label(RichText::new(print).size(11.0).color(FAINT));
    let refusal = form.agree(*ticks, &today()).err();
    ui.horizontal(|ui| {
        let words = RichText::new("Begin the session").size(18.0).strong();
        let begin = egui::Button::new(words.color(GROUND)).fill(ON);
        if ui.add_enabled(refusal.is_none(), begin).clicked() {
            *done = Some(Done::Begin);
        }
        if ui.button(RichText::new("No session").size(18.0)).clicked() {
            *done = Some(Done::Leave);
        }
    });
    if let Some(refusal) = refusal {
        let words = RichText::new(refusal.to_string());
        ui.label(words.size(13.0).color(WARNING));
    }
}

impl ApplicationHandler for Gate<'_> {
    fn resumed(&mut self, events: &ActiveEventLoop) {
        if self.stage.is_none() && !self.is_given_up {
            match Self::open(events) {
                Ok(stage) => self.stage = Some(stage),
                Err(error) => self.give_up(&error),
            }
        }
    }

    fn window_event(&mut self, _: &ActiveEventLoop, _: WindowId, event: WindowEvent) {
        let Some(Stage { target, pane }) = &mut self.stage else {
            return;
        };
        pane.hear(target.window(), &event);
        match event {
            WindowEvent::RedrawRequested => {
                if let Err(error) = self.draw() {
                    self.give_up(&error);
                }
            }
            WindowEvent::CloseRequested => self.outcome = Some(Err(ConsentError::NotTakingPart)),
            WindowEvent::Resized(size) => target.resize(size.width, size.height),
            _ => {}
        }
    }

    fn about_to_wait(&mut self, events: &ActiveEventLoop) {
        if self.has_terminal && self.outcome.is_none() {
            self.listen(Duration::ZERO);
        }
        // Without a window the terminal goes on alone.
        if self.outcome.is_some() || self.is_given_up {
            events.exit();
            return;
        }
        let now = Instant::now();
        if now >= self.due {
            self.due = now + PERIOD;
            if let Some(stage) = &self.stage {
                stage.target.window().request_redraw();
            }
        }
        events.set_control_flow(ControlFlow::WaitUntil(self.due));
    }
}
