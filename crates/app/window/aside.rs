//! The experimenter's window at the desk: beside the participant's, never over it.
//!
//! A window of its own and no side panel: what is typed in it cannot reach the game, it can be moved to another screen, and what the
//! participant looks at is the alley alone. It has no mirror: the participant's window is the picture of what they see.

use std::sync::Arc;
use std::time::{Duration, Instant};

use anyhow::{Context, Result};
use renderer::{Anchor, BackendChoice, WindowTarget};
use winit::dpi::{LogicalPosition, LogicalSize};
use winit::event::WindowEvent;
use winit::event_loop::ActiveEventLoop;
use winit::window::{Window, WindowId};

use crate::session::Session;
use crate::study::board::{Board, WIDTH};
use crate::study::experimenter;

/// Time between two pictures of it: it must not take any from the participant's.
const PERIOD: Duration = Duration::from_millis(66);
const HEIGHT: f32 = 600.0;

/// The window.
pub struct Aside {
    target: WindowTarget,
    board: Board,
    drawn: Instant,
    is_closed: bool,
}

impl Aside {
    /// Opens it to the right of a participant's window that is `beside` wide [points].
    ///
    /// # Errors
    /// When no further window can be opened or drawn into.
    pub fn open(events: &ActiveEventLoop, beside: f64) -> Result<Self> {
        let attributes = Window::default_attributes()
            .with_title("Bowling: the experimenter")
            .with_active(false)
            .with_position(LogicalPosition::new(beside, 0.0))
            .with_inner_size(LogicalSize::new(WIDTH, HEIGHT));
        let window = Arc::new(events.create_window(attributes)?);
        let (gpu, target) = WindowTarget::new(window, BackendChoice::Auto)?;
        let board = Board::new(&gpu, target.window());
        Ok(Self {
            target,
            board,
            drawn: Instant::now(),
            is_closed: false,
        })
    }

    /// Whether an event of the window `id` is this one's.
    pub fn is(&self, id: WindowId) -> bool {
        self.target.window().id() == id
    }

    /// Hears what happens in it; who closes it has the terminal.
    pub fn hear(&mut self, event: &WindowEvent) {
        match event {
            WindowEvent::CloseRequested => {
                self.is_closed = true;
                self.target.window().set_visible(false);
            }
            WindowEvent::Resized(size) => self.target.resize(size.width, size.height),
            _ => {}
        }
        let window = Arc::clone(self.target.window());
        self.board.hear(&window, event);
    }

    /// Does what was typed and clicked, and draws what has changed.
    ///
    /// # Errors
    /// When the journal cannot be written, or the window cannot be drawn into.
    pub fn attend(&mut self, session: &mut Session) -> Result<()> {
        self.board.act(session)?;
        if self.is_closed || self.drawn.elapsed() < PERIOD {
            return Ok(());
        }
        self.drawn = Instant::now();
        let Some(told) = experimenter::told(session) else {
            return Ok(());
        };
        if let Some(image) = self.board.image(self.target.window(), &told)? {
            self.target.set_overlays(&[(Anchor::Center, &image)])?;
        }
        self.target
            .draw_overlays()
            .context("cannot draw into the experimenter's window")?;
        Ok(())
    }
}
