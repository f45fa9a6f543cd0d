//! `bowling play` in a headset: a session with the OpenXR runtime plays the game, and a watchdog stays beside it.
//!
//! The runtime's calls may block for as long as the runtime likes, so they have a thread of their own. Game and journal are
//! shared with the main thread, which can close them in order even if a call never returns. A runtime that ends the session or
//! dies is connected to anew; the game waits meanwhile.

mod frames;
mod mirror;
mod pulses;
mod watch;

use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::mpsc;
use std::sync::{Arc, Mutex, PoisonError};
use std::time::{Duration, Instant};

use anyhow::{Context, Result};
use experiment::protocol::AnsweredIn;
use game::{Button, Config};
use renderer::headset::{Focus, HeadsetError, HeadsetSession, HeadsetSettings, Note, Readings};
use renderer::{Renderer, RendererSettings, View};
use serde_json::json;

use crate::convert::{self, Stock};
use crate::devices::headset::Participant;
use crate::panel::{Panel, PanelStock};
use crate::pictures::{Painter, Wanted};
use crate::play::{self, Progress};
use crate::session::{Session, Setup};
use crate::study::attendant::Attendant;
use frames::FrameTimes;
use watch::Watch;

/// Time between two attempts to connect anew.
const RETRY: Duration = Duration::from_millis(500);
/// Longest wait for a runtime that was asked to end the session.
const LONGEST_END: Duration = Duration::from_secs(3);
/// How often the runtime is asked whether it wants frames, while it wants none.
const IDLE: Duration = Duration::from_millis(10);

/// What the two threads share.
struct Shared {
    /// `None` once the session is finished.
    session: Mutex<Option<Session>>,
    /// Milliseconds since `began` at which the runtime's thread last came round.
    beat_ms: AtomicU64,
    began: Instant,
    /// What the left eye saw last, world frame.
    left_eye: Mutex<Option<View>>,
    /// The experimenter's keys for Red and Blue: pressed since the last frame.
    keys: [AtomicBool; 2],
    stop: Arc<AtomicBool>,
}

impl Shared {
    fn beat(&self) {
        let now = self.began.elapsed().as_millis() as u64;
        self.beat_ms.store(now, Ordering::Relaxed);
    }

    /// How long the runtime's thread has been silent.
    fn silence(&self) -> Duration {
        let beat = Duration::from_millis(self.beat_ms.load(Ordering::Relaxed));
        self.began.elapsed().saturating_sub(beat)
    }

    /// The experimenter presses a key; the next frame takes it.
    fn press(&self, button: Button) {
        self.keys[button as usize].store(true, Ordering::Relaxed);
    }

    fn take_press(&self, button: Button) -> bool {
        self.keys[button as usize].swap(false, Ordering::Relaxed)
    }

    fn left_eye(&self) -> Option<View> {
        *self.left_eye.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn must_stop(&self) -> bool {
        self.stop.load(Ordering::Relaxed)
    }

    /// Does something with the session, unless it is finished.
    fn with<T>(&self, act: impl FnOnce(&mut Session) -> Result<T>) -> Result<Option<T>> {
        // A thread that panicked left the journal between two lines: it can still be closed.
        let mut session = self.session.lock().unwrap_or_else(PoisonError::into_inner);
        session.as_mut().map(act).transpose()
    }

    fn note(&self, value: serde_json::Value) -> Result<()> {
        self.with(|session| session.device(value)).map(|_| ())
    }
}

/// Connects, plays until the runtime or Ctrl-C ends it, and leaves the recording in order.
///
/// `refresh_rate_hz` is what the headset is asked for [Hz]; `None` for its highest.
///
/// # Errors
/// One sentence when no headset can be used, an asset is missing, or the recording cannot be written.
pub fn run(
    setup: Setup,
    root: &Path,
    wanted: Wanted,
    refresh_rate_hz: Option<f32>,
    attendant: Option<Attendant>,
) -> Result<()> {
    let config = setup.conditions.lobby.clone();
    let settings = HeadsetSettings { refresh_rate_hz };
    let stop = play::interruption()?;
    let stage = Stage::open(settings, root, &config)?;
    println!(
        "{} on {}.",
        stage.headset.headset().system,
        stage.headset.headset().runtime
    );
    // Last: nothing is written before everything else works.
    let session = Session::start(setup)?;
    println!(
        "Recording into {}. Ctrl-C ends and saves.",
        session.folder().display()
    );
    let shared = Arc::new(Shared {
        session: Mutex::new(Some(session)),
        beat_ms: AtomicU64::new(0),
        began: Instant::now(),
        left_eye: Mutex::new(None),
        keys: Default::default(),
        stop: Arc::clone(&stop),
    });
    let player = Player {
        shared: Arc::clone(&shared),
        root: root.to_owned(),
        participant: Participant::new(config.physics.step_hz),
        panel: Panel::new(AnsweredIn::Headset),
        times: FrameTimes::default(),
        is_paused: false,
        menu_was_down: false,
        refusal: String::new(),
        config: config.clone(),
        settings,
    };
    let (sender, ended) = mpsc::channel();
    std::thread::Builder::new()
        .name("headset".to_owned())
        .spawn(move || {
            // The receiver is gone only where the main thread has given this one up.
            let _ = sender.send(player.play(stage));
        })
        .context("cannot start the headset's thread")?;
    let watch = Watch::new(Arc::clone(&shared), ended, attendant);
    let outcome = mirror::stay(watch, Arc::clone(&shared), root, &config);
    let session = shared
        .session
        .lock()
        .unwrap_or_else(PoisonError::into_inner)
        .take();
    let Some(session) = session else {
        return outcome;
    };
    if outcome.is_err() {
        session.finish(None, wanted, &mut |_| ())?;
        return outcome;
    }
    // Who stops by Ctrl-C or from the mirror wants no pictures; one who stops these does.
    let was_stopped = stop.swap(false, Ordering::Relaxed);
    let painter = (session.has_throws() && !was_stopped)
        .then(|| Painter::new(root, &config))
        .transpose()?
        .map(|painter| painter.stopped_by(stop));
    play::close(session, painter, wanted, Progress::new())?;
    Ok(())
}

/// Everything that lasts as long as one connection to the runtime.
struct Stage {
    renderer: Renderer,
    stock: Stock,
    panel: PanelStock,
    headset: HeadsetSession,
}

impl Stage {
    fn open(settings: HeadsetSettings, root: &Path, config: &Config) -> Result<Self> {
        let headset = HeadsetSession::open(settings)?;
        let mut renderer = Renderer::new(headset.gpu(), RendererSettings::default())
            .context("cannot draw for the headset")?;
        let stock = Stock::load(&mut renderer, root, config)?;
        let panel = PanelStock::new(headset.gpu(), &mut renderer)?;
        Ok(Self {
            renderer,
            stock,
            panel,
            headset,
        })
    }
}

/// The runtime's thread.
struct Player {
    shared: Arc<Shared>,
    root: PathBuf,
    config: Config,
    settings: HeadsetSettings,
    participant: Participant,
    /// What a study asks in the room.
    panel: Panel,
    times: FrameTimes,
    /// The participant paused by the menu button.
    is_paused: bool,
    /// Whether a menu button was down in the last frame.
    menu_was_down: bool,
    /// Why the last attempt to connect failed.
    refusal: String,
}

impl Player {
    /// Plays until the end, through as many connections as it takes.
    fn play(mut self, stage: Stage) -> Result<()> {
        let mut stage = Some(stage);
        while !self.shared.must_stop() {
            let Some(mut connected) = stage.take() else {
                stage = self.reconnect()?;
                continue;
            };
            let ended = self.play_on(&mut connected);
            match ended {
                Ok(()) => return self.shared.note(self.times.summary()),
                // Whatever the runtime answers in the middle of a game: it is asked anew before anything is given up.
                Err(error) if error.is::<HeadsetError>() => {
                    println!("{error:#}. The game waits for the headset; Ctrl-C ends and saves.");
                    self.shared.note(json!({ "lost": format!("{error:#}") }))?;
                    self.times.pause();
                }
                Err(error) => return Err(error),
            }
        }
        self.shared.note(self.times.summary())
    }

    /// One attempt after a pause; only what cannot pass is an error.
    fn reconnect(&mut self) -> Result<Option<Stage>> {
        std::thread::sleep(RETRY);
        self.shared.beat();
        let stage = match Stage::open(self.settings, &self.root, &self.config) {
            Ok(stage) => stage,
            Err(error) if error.is::<HeadsetError>() => {
                let refusal = format!("{error:#}");
                if refusal != self.refusal {
                    println!("Not yet: {refusal}.");
                    self.shared.note(json!({ "refused": refusal }))?;
                    self.refusal = refusal;
                }
                return Ok(None);
            }
            Err(error) => return Err(error),
        };
        self.refusal.clear();
        println!("Connected to the headset again: the game goes on.");
        self.shared
            .note(json!({ "reconnected": stage.headset.headset().runtime }))?;
        Ok(Some(stage))
    }

    /// Plays on one connection until the runtime or somebody ends it.
    fn play_on(&mut self, stage: &mut Stage) -> Result<()> {
        let mut asked: Option<Instant> = None;
        loop {
            self.shared.beat();
            for note in stage.headset.poll()? {
                self.shared.note(note_line(&note))?;
                if let Some(text) = note_text(&note) {
                    println!("{text}");
                }
                if note == Note::Exit {
                    return Ok(());
                }
            }
            match asked {
                // Not running, so there is nothing to end; or a runtime that never comes to its end.
                None if self.shared.must_stop() => {
                    if stage.headset.request_exit().is_err() {
                        return Ok(());
                    }
                    asked = Some(Instant::now());
                }
                Some(since) if since.elapsed() > LONGEST_END => return Ok(()),
                _ => {}
            }
            if stage.headset.is_running() {
                self.frame(stage)?;
            } else {
                self.times.pause();
                std::thread::sleep(IDLE);
            }
        }
    }

    /// The menu button pauses, and goes on.
    fn hear_menu(&mut self, readings: &Readings) -> Result<()> {
        let is_down = readings.hands.iter().any(|hand| hand.menu);
        if is_down && !self.menu_was_down {
            self.is_paused = !self.is_paused;
            self.shared.note(json!({ "paused": self.is_paused }))?;
        }
        self.menu_was_down = is_down;
        Ok(())
    }

    fn frame(&mut self, stage: &mut Stage) -> Result<()> {
        let headset = &mut stage.headset;
        let frame = headset.wait()?;
        let readings = headset.read(&frame)?;
        self.hear_menu(&readings)?;
        let is_here = headset.focus() == Focus::Focused && !self.is_paused;
        let (participant, panel, keys) = (&mut self.participant, &mut self.panel, &self.shared);
        let played = self.shared.with(|session| {
            let mut input = if is_here {
                let is_holding = session.game().held().is_some();
                let (at, period) = (frame.display_time_ns(), frame.period_s());
                participant.input(&readings, at, period, is_holding)
            } else {
                participant.pause(&readings)
            };
            input.press_red |= keys.take_press(Button::Red);
            input.press_blue |= keys.take_press(Button::Blue);
            let held = session.game().held();
            session.frame(input)?;
            if is_here {
                panel.attend(session)?;
            }
            let game = session.game();
            let visible = game.visible_at(participant.share());
            let scene = convert::scene(visible.iter(), &stage.stock, game.held().is_some());
            Ok((
                scene,
                game.world_from_tracking(),
                pulses::of(game.events(), held),
            ))
        })?;
        let Some((mut scene, rig, pulse)) = played else {
            // The main thread has finished the session without this one.
            headset.skip(frame)?;
            return Ok(());
        };
        let panel = stage.panel.instances(&self.panel, &mut stage.renderer)?;
        scene.instances.extend(panel);
        let simulated = frame.woken().elapsed();
        let timing = self.times.of(&frame, simulated);
        if frame.should_render() {
            let rig = (rig.position.as_vec3(), rig.rotation.as_quat());
            let (views, _) = headset.show(frame, &mut stage.renderer, &scene, rig, false)?;
            *self
                .shared
                .left_eye
                .lock()
                .unwrap_or_else(PoisonError::into_inner) = views.first().copied();
        } else {
            headset.skip(frame)?;
        }
        if let Some(pulse) = pulse.filter(|_| is_here) {
            let side = self.participant.throwing();
            headset.pulse(side, pulse.amplitude, pulse.seconds)?;
        }
        let line = self.times.finish(timing);
        self.shared.note(line)
    }
}

/// A note as the journal keeps it.
fn note_line(note: &Note) -> serde_json::Value {
    match note {
        Note::Focus(focus) => json!({ "focus": format!("{focus:?}").to_lowercase() }),
        Note::Exit => json!({ "exit": true }),
        Note::Profile { side, profile } => {
            json!({ "hand": format!("{side:?}").to_lowercase(), "profile": profile })
        }
        Note::BindingsRejected { profile, answer } => {
            json!({ "bindings_rejected": profile, "answer": answer })
        }
        Note::Recentred => json!({ "recentred": true }),
        Note::Worn(is_worn) => json!({ "worn": is_worn }),
        Note::RefreshRate(rate) => json!({ "refresh_rate_hz": rate }),
    }
}

/// What the experimenter reads of a note; nothing of what is in order.
fn note_text(note: &Note) -> Option<String> {
    match note {
        Note::Profile {
            side,
            profile: Some(profile),
        } => Some(format!("{side:?} hand: {profile}.")),
        Note::Profile { side, .. } => Some(format!("{side:?} hand: no controller.")),
        Note::BindingsRejected { profile, answer } => Some(format!(
            "The runtime refused the bindings of {profile} ({answer}); other controllers work."
        )),
        Note::Focus(Focus::Visible) => {
            Some("The participant is in a menu of the system: the game waits.".to_owned())
        }
        Note::Worn(false) => Some("The headset was taken off.".to_owned()),
        _ => None,
    }
}
