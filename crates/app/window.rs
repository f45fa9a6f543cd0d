//! `bowling play` in a window: a person at the desk, or the scripted participant to watch.
//!
//! The simulation follows the wall clock in the device's own frames, however fast the window is drawn; the journal sees no
//! difference to a session without a window.

mod aside;
mod cost;
mod keys;
mod overlay;

use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::{Duration, Instant};

use anyhow::{Context, Result, anyhow};
use experiment::protocol::AnsweredIn;
use glam::{DQuat, DVec3};
use renderer::{BackendChoice, Fov, Renderer, TextPainter, View, WindowTarget};
use winit::application::ApplicationHandler;
use winit::dpi::LogicalSize;
use winit::event::WindowEvent;
use winit::event_loop::{ActiveEventLoop, ControlFlow, EventLoop};
use winit::platform::run_on_demand::EventLoopExtRunOnDemand;
use winit::window::{Window, WindowId};

use crate::again::Again;
use crate::choose::Choice;
use crate::convert::{self, Stock};
use crate::devices::desk::Desk;
use crate::devices::gamepad::Gamepads;
use crate::devices::script::Script;
use crate::devices::{Device, LONGEST_CATCH_UP_S};
use crate::fence::{self, Space};
use crate::hints::Grip;
use crate::labels;
use crate::panel::{Panel, PanelStock};
use crate::pictures::{Painter, Wanted};
use crate::play::{self, Progress};
use crate::practice::Track;
use crate::session::{Session, Setup};
use crate::signs::SignStock;
use crate::sound::Ears;
use crate::study::attendant::{Attendance, Attendant};
use crate::words::Words;
use aside::Aside;
use cost::Meter;
use keys::{Command, Keys};
use overlay::Overlay;

/// Vertical field of view of the window [rad]: wide enough to see hand and pins at once.
const WINDOW_FOV: f32 = 1.05;
/// Size of the window at first [points].
const SIZE: (f64, f64) = (960.0, 600.0);
/// Pictures a second of a display that does not tell.
const USUAL_HZ: f64 = 60.0;
/// Where the eyes are while the head is not tracked: behind the approach, at a standing person's height [m].
const SPECTATOR: DVec3 = DVec3::new(0.0, 1.7, 5.0);

/// Opens the window, plays until it is closed or the script is done, and leaves the recording in order.
///
/// # Errors
/// One sentence when no window, driver or asset is there, or the recording cannot be written.
pub fn run(
    setup: Setup,
    root: &Path,
    wanted: Wanted,
    choice: Choice,
    attendance: Option<Attendance>,
) -> Result<()> {
    let (attendant, events) = attendance
        .map(|attendance| (attendance.attendant, attendance.events))
        .unzip();
    let mut events = events.flatten().map_or_else(EventLoop::new, Ok).map_err(|_| {
        anyhow!(
            "no window can be opened: the display server does not answer; start from a desktop, or use --offscreen"
        )
    })?;
    let config = setup.conditions.lobby.clone();
    let mut shell = Shell {
        root: root.to_owned(),
        player: Player::new(&setup, choice),
        attendant,
        frame_s: 1.0 / setup.rate_hz,
        setup: Some(setup),
        stage: None,
        stop: play::interruption()?,
        failure: None,
    };
    // One that has run before must be told to begin anew, which `run_app` does not do.
    events
        .run_app_on_demand(&mut shell)
        .context("the window system ended the session")?;
    let Shell {
        stage,
        failure,
        stop,
        ..
    } = shell;
    let Some(stage) = stage else {
        return Err(failure.unwrap_or_else(|| anyhow!("the window was closed before it opened")));
    };
    let Stage { session, .. } = stage;
    if let Some(failure) = failure {
        session.finish(None, wanted, &mut |_| ())?;
        return Err(failure);
    }
    let painter = session
        .has_throws()
        .then(|| Painter::new(root, &config))
        .transpose()?
        .map(|painter| painter.stopped_by(stop));
    play::close(session, painter, wanted, Progress::new())?;
    Ok(())
}

/// Who plays in the window.
enum Player {
    Desk(Box<Desk>, Box<Gamepads>),
    Script(Box<Script>),
}

impl Player {
    fn new(setup: &Setup, choice: Choice) -> Self {
        let config = &setup.conditions.lobby;
        if choice == Choice::ScriptWindow {
            return Self::Script(Box::new(play::scripted(setup)));
        }
        let steps = (config.physics.step_hz / setup.rate_hz).round() as u32;
        let desk = Desk::new(config.participant.eye_height_m, steps, 1.0 / setup.rate_hz);
        Self::Desk(Box::new(desk), Box::new(Gamepads::open()))
    }

    /// The device, told that `count` of its inputs are due.
    fn due(&mut self, count: u32) -> &mut dyn Device {
        match self {
            Self::Desk(desk, pads) => {
                let (pad, presses) = pads.poll();
                desk.set_gamepad(pad);
                presses.into_iter().for_each(|press| desk.handle(press));
                desk.due(count);
                desk.as_mut()
            }
            Self::Script(script) => script.as_mut(),
        }
    }
}

/// Everything that exists once the window does.
struct Stage {
    target: WindowTarget,
    renderer: Renderer,
    stock: Stock,
    overlay: Overlay,
    panel: Panel,
    panel_stock: PanelStock,
    signs: SignStock,
    track: Track,
    words: Words,
    meter: Meter,
    keys: Keys,
    session: Session,
    /// The experimenter's, in a study.
    aside: Option<Aside>,
    ears: Ears,
    again: Option<Again>,
    /// Up to when the alley has been simulated.
    simulated: Instant,
}

/// The window's application: opens the stage when the system is ready, and then runs it.
struct Shell {
    root: PathBuf,
    player: Player,
    /// Who attends to a study's session.
    attendant: Option<Attendant>,
    frame_s: f64,
    setup: Option<Setup>,
    stage: Option<Stage>,
    stop: Arc<std::sync::atomic::AtomicBool>,
    failure: Option<anyhow::Error>,
}

impl Shell {
    fn open(&mut self, events: &ActiveEventLoop) -> Result<()> {
        let Some(setup) = self.setup.take() else {
            return Ok(());
        };
        let words = Words::load(&self.root, &setup.conditions.lobby)?;
        let attributes = Window::default_attributes()
            .with_title(&words.window.title)
            .with_inner_size(LogicalSize::new(SIZE.0, SIZE.1));
        let window = events
            .create_window(attributes)
            .context("cannot open a window; use --offscreen")?;
        let (gpu, target) = WindowTarget::new(Arc::new(window), BackendChoice::Auto)
            .context("cannot draw into the window")?;
        let mut renderer = Renderer::new(&gpu, convert::settings(&setup.conditions.lobby.shows))
            .context("cannot draw")?;
        let config = &setup.conditions.lobby;
        let mut stock = Stock::load(&mut renderer, &self.root, config)?;
        stock.add_screen(&mut renderer, &self.root, config)?;
        let again = Again::of(config);
        let overlay = Overlay::new(
            TextPainter::new(&gpu),
            words.clone(),
            setup.conditions.lobby.practice.only,
        );
        let panel_stock = PanelStock::new(&gpu, &mut renderer, &words)?;
        let signs = SignStock::new(&gpu, &mut renderer)?;
        // Last: nothing is written before everything else works.
        let mut session = Session::start(setup)?;
        let ears = Ears::open(session.game().config());
        if let Some(line) = ears.line() {
            session.device(line)?;
        }
        println!(
            "Recording into {}. F1 shows the keys, Esc ends and saves.",
            session.folder().display()
        );
        let aside = session
            .course()
            .map(|_| Aside::open(events, SIZE.0))
            .transpose();
        let aside = aside.unwrap_or_else(|error| {
            println!("No experimenter's window: {error:#}. The terminal has it all.");
            None
        });
        let simulated = Instant::now();
        self.stage = Some(Stage {
            target,
            renderer,
            stock,
            overlay,
            panel: Panel::new(AnsweredIn::Desk, words.clone()),
            panel_stock,
            signs,
            track: Track::default(),
            words,
            meter: Meter::new(),
            keys: Keys::default(),
            session,
            aside,
            ears,
            again,
            simulated,
        });
        Ok(())
    }

    /// Simulates what is due and draws the picture.
    fn frame(&mut self, events: &ActiveEventLoop) -> Result<()> {
        let Some(stage) = &mut self.stage else {
            return Ok(());
        };
        let begun = Instant::now();
        let late = stage.simulated.elapsed().as_secs_f64();
        if late > LONGEST_CATCH_UP_S {
            stage.simulated += Duration::from_secs_f64(late - LONGEST_CATCH_UP_S);
        }
        let count = (late.min(LONGEST_CATCH_UP_S) / self.frame_s) as u32;
        let device = self.player.due(count);
        for _ in 0..count {
            let input = if stage.session.is_asking() {
                device.wait(stage.session.game())
            } else {
                device.next(stage.session.game())
            };
            let watch = stage.meter.stopwatch();
            stage.session.frame_watched(input, watch)?;
            stage.overlay.notice(stage.session.game());
            stage.ears.notice(stage.session.game());
            if let Some(again) = &mut stage.again {
                again.notice(stage.session.game());
            }
            stage.track.notice(stage.session.game());
        }
        stage.ears.hear(stage.session.game());
        stage.simulated += Duration::from_secs_f64(f64::from(count) * self.frame_s);
        if let Some(attendant) = &mut self.attendant {
            attendant.attend(&mut stage.session)?;
            stage.panel.attend(&mut stage.session)?;
        }
        if let Some(aside) = &mut stage.aside {
            aside.attend(&mut stage.session)?;
        }
        let is_over = match stage.session.course() {
            Some(_) => stage.session.is_over(),
            None => device.is_done(),
        };
        if is_over || self.stop.load(std::sync::atomic::Ordering::Relaxed) {
            events.exit();
        }
        let drawn = Instant::now();
        stage.draw()?;
        let rate = stage.display_hz();
        let game = stage.session.game();
        let warning = stage.meter.frame((begun, drawn), game, rate);
        // A picture that took the time of several kept as many from being shown.
        stage
            .session
            .picture((begun.elapsed().as_secs_f64() * rate) as u64);
        if let Some(warning) = warning {
            eprintln!("warning: {}", warning.replace('\n', " "));
        }
        Ok(())
    }

    fn command(&mut self, command: Command, events: &ActiveEventLoop) {
        match command {
            Command::End => events.exit(),
            Command::Help => {
                if let Some(stage) = &mut self.stage {
                    stage.overlay.toggle_help();
                }
            }
            Command::Cost => {
                // In a study nothing may tell the conditions apart, not even what they cost.
                if let Some(stage) = &mut self.stage
                    && stage.session.course().is_none()
                {
                    stage.overlay.toggle_cost();
                }
            }
            Command::Desk(event) => {
                if let Player::Desk(desk, _) = &mut self.player {
                    desk.handle(event);
                }
            }
            Command::LetGo => {
                if let Player::Desk(desk, _) = &mut self.player {
                    desk.let_go();
                }
            }
        }
    }

    /// Keeps the first failure for the end of the loop, which winit cannot carry out itself.
    fn keep(&mut self, result: Result<()>, events: &ActiveEventLoop) {
        if let Err(error) = result {
            self.failure.get_or_insert(error);
            events.exit();
        }
    }
}

impl Stage {
    /// Pictures that the display shows a second.
    fn display_hz(&self) -> f64 {
        let monitor = self.target.window().current_monitor();
        let rate = monitor.and_then(|monitor| monitor.refresh_rate_millihertz());
        rate.map_or(USUAL_HZ, |millihertz| f64::from(millihertz) / 1e3)
    }

    fn draw(&mut self) -> Result<()> {
        let game = self.session.game();
        let visible = game.visible();
        self.stock
            .show_scores(&mut self.renderer, &convert::Scores::of(game))?;
        let again = self.again.as_ref();
        self.stock
            .show_again(again.and_then(|again| again.at(game.time())))?;
        let mut scene = convert::scene(visible.iter(), &self.stock, convert::HandLook::of(game));
        scene.vignette = convert::vignette(game);
        let panel = self
            .panel_stock
            .instances(&self.panel, &mut self.renderer)?;
        scene.instances.extend(panel);
        let signs = labels::signs(game, Grip::Mouse, &self.words);
        let signs = self.signs.instances(&signs, &mut self.renderer)?;
        scene.instances.extend(signs);
        scene.instances.extend(self.track.instances(&self.stock));
        let space = Space::of_settings(game.config().comfort.space_m);
        let fence = fence::instances(game, space.as_ref(), &[], &self.stock);
        scene.instances.extend(fence);
        let (position, rotation) = game
            .head_pose_world()
            .map_or((SPECTATOR, DQuat::IDENTITY), |head| {
                (head.position, head.rotation)
            });
        let fov = Fov::from_aspect(WINDOW_FOV, self.target.view_aspect(1));
        let view = View {
            position: position.as_vec3(),
            rotation: rotation.as_quat(),
            fov,
        };
        self.overlay
            .show(game, self.meter.report(), &mut self.target)?;
        self.target
            .draw(&mut self.renderer, &scene, &[view])
            .context("cannot draw into the window")?;
        Ok(())
    }
}

impl ApplicationHandler for Shell {
    fn resumed(&mut self, events: &ActiveEventLoop) {
        // The picture sets the pace: vertical synchronisation where there is a screen, the processor elsewhere.
        events.set_control_flow(ControlFlow::Poll);
        let opened = self.open(events);
        self.keep(opened, events);
    }

    fn window_event(&mut self, events: &ActiveEventLoop, id: WindowId, event: WindowEvent) {
        if let Some(aside) = self.stage.as_mut().and_then(|stage| stage.aside.as_mut())
            && aside.is(id)
        {
            aside.hear(&event);
            return;
        }
        if matches!(event, WindowEvent::RedrawRequested) {
            let drawn = self.frame(events);
            self.keep(drawn, events);
            return;
        }
        let Some(stage) = &mut self.stage else { return };
        if let WindowEvent::Resized(size) = event {
            stage.target.resize(size.width, size.height);
        }
        let size = stage.target.window().inner_size();
        if let Some(command) = stage.keys.command(&event, size) {
            self.command(command, events);
        }
    }

    fn about_to_wait(&mut self, _: &ActiveEventLoop) {
        if let Some(stage) = &self.stage {
            stage.target.window().request_redraw();
        }
    }
}
