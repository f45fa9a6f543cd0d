//! The experimenter's window beside a headset: what the left eye sees, drawn anew at the window's own rate, and in a study the
//! experimenter's board beside it.
//!
//! It has a device of its own and takes the game's lock only to copy what is seen, so that no screen slows the headset, and one that
//! hangs holds up nothing but this window. Without a display there is none, and the session is the same.

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::Ordering;
use std::time::{Duration, Instant};

use anyhow::{Result, anyhow};
use game::{Button, Config};
use renderer::{Anchor, BackendChoice, Renderer, WindowTarget};
use winit::application::ApplicationHandler;
use winit::dpi::LogicalSize;
use winit::event::WindowEvent;
use winit::event_loop::{ActiveEventLoop, ControlFlow, EventLoop};
use winit::keyboard::{KeyCode, PhysicalKey};
use winit::platform::run_on_demand::EventLoopExtRunOnDemand;
use winit::window::{Window, WindowId};

use super::shared::{Seen, Shared};
use super::watch::Watched;
use crate::convert::{self, Stock};
use crate::signs::SignStock;
use crate::study::board::{Board, WIDTH};
use crate::study::experimenter;

/// Time between two pictures: enough to follow, little beside the headset's.
const PERIOD: Duration = Duration::from_millis(33);
/// The same while the headset misses pictures, for which the same card and processor draw.
const YIELDING: Duration = Duration::from_millis(250);

/// Stays until the headset's thread has ended; with a window where there is a display. `events` is the window system, where a window was
/// there before.
///
/// # Errors
/// What ended the thread.
pub fn stay(
    watched: Watched,
    shared: Arc<Shared>,
    root: &Path,
    config: &Config,
    events: Option<EventLoop<()>>,
) -> Result<()> {
    let display = || crate::choose::display().ok();
    let Some(mut events) = events.or_else(|| display().and_then(|()| EventLoop::new().ok())) else {
        return watched.wait();
    };
    let mut mirror = Mirror {
        watched,
        shared,
        root: root.to_owned(),
        config: config.clone(),
        stage: None,
        is_given_up: false,
        due: Instant::now(),
        missed: 0,
        outcome: None,
    };
    // A fault of the window system or its driver ends the mirror, and must not end the participant's game.
    let ended = catch_unwind(AssertUnwindSafe(|| events.run_app_on_demand(&mut mirror)));
    match mirror.outcome {
        Some(outcome) => outcome,
        None => {
            let why = match ended {
                Ok(Err(error)) => error.to_string(),
                _ => "the window system ended it".to_owned(),
            };
            println!("No mirror window any more: {why}. The participant is not affected.");
            mirror.watched.wait()
        }
    }
}

/// What exists once the window does.
struct Stage {
    target: WindowTarget,
    renderer: Renderer,
    stock: Stock,
    /// The experimenter's, in a study.
    board: Option<Board>,
    signs: SignStock,
}

/// Time to the next picture, while the headset's missed ones go from one number to the other.
fn period(before: u64, missed: u64) -> Duration {
    if missed > before { YIELDING } else { PERIOD }
}

struct Mirror {
    watched: Watched,
    shared: Arc<Shared>,
    root: PathBuf,
    config: Config,
    stage: Option<Stage>,
    /// The window could not be opened, or drawing into it failed: the participant plays on without.
    is_given_up: bool,
    due: Instant,
    /// Pictures that the headset had missed when the last one here was due.
    missed: u64,
    outcome: Option<Result<()>>,
}

impl Mirror {
    fn open(&self, events: &ActiveEventLoop) -> Result<Stage> {
        let is_study = self.shared.with(|session| Ok(session.course().is_some()))?;
        let is_study = is_study == Some(true);
        let width = if is_study { 640.0 + WIDTH } else { 640.0 };
        let attributes = Window::default_attributes()
            .with_title("Bowling: what the participant sees")
            .with_inner_size(LogicalSize::new(width, 640.0));
        let window = Arc::new(events.create_window(attributes)?);
        let (gpu, mut target) = WindowTarget::new(window, BackendChoice::Auto)?;
        let board = is_study.then(|| Board::new(&gpu, target.window()));
        if is_study {
            let strip = f64::from(WIDTH) * target.window().scale_factor();
            target.reserve_right(strip.ceil() as u32);
        }
        let mut renderer = Renderer::new(&gpu, convert::settings(&self.config.shows))?;
        let mut stock = Stock::load(&mut renderer, &self.root, &self.config)?;
        stock.add_screen(&mut renderer, &self.root, &self.config)?;
        let signs = SignStock::new(&gpu, &mut renderer)?;
        Ok(Stage {
            target,
            renderer,
            stock,
            board,
            signs,
        })
    }

    /// Does what the experimenter typed and clicked; a session that cannot be written any more ends.
    fn attend(&mut self) -> Result<()> {
        let Some(board) = self.stage.as_mut().and_then(|stage| stage.board.as_mut()) else {
            return Ok(());
        };
        self.shared.with(|session| board.act(session)).map(|_| ())
    }

    fn draw(&mut self) -> Result<()> {
        let Some(stage) = &mut self.stage else {
            return Ok(());
        };
        if let Some(board) = &mut stage.board {
            let told = self
                .shared
                .with(|session| Ok(experimenter::told(session)))?;
            if let Some(told) = told.flatten()
                && let Some(image) = board.image(stage.target.window(), &told)?
            {
                stage.target.set_overlays(&[(Anchor::Center, &image)])?;
            }
        }
        let Seen {
            left_eye,
            again,
            beside,
            fingers,
        } = self.shared.seen();
        let Some(view) = left_eye else {
            stage.target.draw_overlays()?;
            return Ok(());
        };
        let seen = self.shared.with(|session| {
            let game = session.game();
            Ok((
                game.visible(),
                convert::HandLook::of(game).bent(fingers),
                convert::Scores::of(game),
                convert::vignette(game),
                beside.instances(game, &stage.stock),
            ))
        })?;
        let Some((visible, hand, scores, vignette, more)) = seen else {
            return Ok(());
        };
        stage.stock.show_scores(&mut stage.renderer, &scores)?;
        stage.stock.show_again(again)?;
        let mut scene = convert::scene(visible.iter(), &stage.stock, hand);
        scene.vignette = vignette;
        scene.instances.extend(more);
        let signs = stage.signs.instances(&beside.signs, &mut stage.renderer)?;
        scene.instances.extend(signs);
        stage
            .target
            .draw(&mut stage.renderer, &scene, &[view])
            .map(|_| ())
            .map_err(|error| anyhow!(error))
    }

    fn give_up(&mut self, error: &anyhow::Error) {
        self.is_given_up = true;
        self.stage = None;
        println!("No mirror window: {error:#}. The participant is not affected.");
    }
}

impl ApplicationHandler for Mirror {
    fn resumed(&mut self, events: &ActiveEventLoop) {
        if self.stage.is_some() || self.is_given_up {
            return;
        }
        match self.open(events) {
            Ok(stage) => self.stage = Some(stage),
            Err(error) => self.give_up(&error),
        }
    }

    fn window_event(&mut self, _: &ActiveEventLoop, _: WindowId, event: WindowEvent) {
        // In a study keys are typed on the board, and nobody presses for the participant.
        let is_key = matches!(event, WindowEvent::KeyboardInput { .. });
        if let Some(stage) = &mut self.stage
            && let Some(board) = &mut stage.board
        {
            board.hear(stage.target.window(), &event);
            if is_key {
                return;
            }
        }
        match event {
            WindowEvent::RedrawRequested => {
                if let Err(error) = self.draw() {
                    self.give_up(&error);
                }
            }
            WindowEvent::CloseRequested => self.shared.stop.store(true, Ordering::Relaxed),
            WindowEvent::Resized(size) => {
                if let Some(stage) = &mut self.stage {
                    stage.target.resize(size.width, size.height);
                }
            }
            WindowEvent::KeyboardInput { event, .. } => {
                let key = event.physical_key;
                if !event.state.is_pressed() || event.repeat {
                    return;
                }
                match key {
                    PhysicalKey::Code(KeyCode::Digit1 | KeyCode::Numpad1) => {
                        self.shared.press(Button::Red);
                    }
                    PhysicalKey::Code(KeyCode::Digit2 | KeyCode::Numpad2) => {
                        self.shared.press(Button::Blue);
                    }
                    PhysicalKey::Code(KeyCode::Escape) => {
                        self.shared.stop.store(true, Ordering::Relaxed);
                    }
                    _ => {}
                }
            }
            _ => {}
        }
    }

    fn about_to_wait(&mut self, events: &ActiveEventLoop) {
        self.outcome = match self.attend() {
            Ok(()) => self.watched.outcome(),
            Err(error) => Some(Err(error)),
        };
        if self.outcome.is_some() {
            events.exit();
            return;
        }
        let now = Instant::now();
        if now >= self.due {
            let missed = self.shared.missed();
            self.due = now + period(std::mem::replace(&mut self.missed, missed), missed);
            if let Some(stage) = &self.stage {
                stage.target.window().request_redraw();
            }
        }
        events.set_control_flow(ControlFlow::WaitUntil(self.due));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_mirror_draws_less_while_the_headset_misses_pictures() {
        assert_eq!(period(7, 7), PERIOD);
        assert_eq!(period(7, 8), YIELDING);
    }
}
