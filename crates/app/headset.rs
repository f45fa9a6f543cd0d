//! `bowling play` in a headset: a session with the OpenXR runtime plays the game, and a watchdog stays beside it.
//!
//! The runtime's calls may block for as long as the runtime likes, so they have a thread of their own. Game and journal are
//! shared with the main thread, which can close them in order even if a call never returns. A runtime that ends the session or
//! dies is connected to anew; the game waits meanwhile.

mod around;
mod attention;
mod fading;
mod frames;
mod mirror;
mod notes;
mod pulses;
mod shared;
mod throws;
mod watch;

use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::mpsc;
use std::sync::{Arc, Mutex, PoisonError};
use std::time::{Duration, Instant};

use anyhow::{Context, Result};
use experiment::protocol::AnsweredIn;
use game::{Button, Config, Event, EventKind};
use renderer::Renderer;
use renderer::headset::{HeadsetError, HeadsetSession, HeadsetSettings, Note};
use serde_json::json;

use crate::again::Again;
use crate::convert::{self, Stock};
use crate::devices::headset::Participant;
use crate::panel::{Panel, PanelStock};
use crate::pictures::{Painter, Wanted};
use crate::play::{self, Progress};
use crate::session::{Session, Setup};
use crate::signs::SignStock;
use crate::sound::Ears;
use crate::study::attendant::Attendant;
use crate::words::Words;
use crate::wrist::Wish;
use around::Around;
use attention::Attention;
use fading::Fading;
use frames::FrameTimes;
use shared::Shared;
use throws::Throws;
use watch::Watch;

/// Time between two attempts to connect anew.
const RETRY: Duration = Duration::from_millis(500);
/// Longest wait for a runtime that was asked to end the session.
const LONGEST_END: Duration = Duration::from_secs(3);
/// How often the runtime is asked whether it wants frames, while it wants none.
const IDLE: Duration = Duration::from_millis(10);

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
    let words = Words::load(root, &config)?;
    let stage = Stage::open(settings, root, &config)?;
    let headset = stage.headset.headset();
    println!("{} on {}.", headset.system, headset.runtime);
    let made = json!({ "headset": {
        "system": headset.system,
        "vendor_id": headset.vendor_id,
        "runtime": headset.runtime,
        "eye_px": headset.eye_size,
    }});
    // Last: nothing is written before everything else works.
    let mut session = Session::start(setup)?;
    session.device(made)?;
    let ears = Ears::open(&config);
    if let Some(line) = ears.line() {
        session.device(line)?;
    }
    println!(
        "Recording into {}. Ctrl-C ends and saves.",
        session.folder().display()
    );
    let shared = Arc::new(Shared {
        session: Mutex::new(Some(session)),
        beat_ms: AtomicU64::new(0),
        began: Instant::now(),
        left_eye: Mutex::new(None),
        again: Mutex::new(None),
        fingers: Mutex::new(None),
        keys: Default::default(),
        stop: Arc::clone(&stop),
    });
    let player = Player {
        shared: Arc::clone(&shared),
        root: root.to_owned(),
        participant: Participant::new(config.physics.step_hz),
        panel: Panel::new(AnsweredIn::Headset, words.clone()),
        times: FrameTimes::default(),
        throws: Throws::default(),
        attention: Attention::new(),
        fading: Fading::new(config.hand.lost_grip_s),
        again: Again::of(&config),
        ears,
        around: Around::new(&config, words),
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
    signs: SignStock,
    headset: HeadsetSession,
}

impl Stage {
    fn open(settings: HeadsetSettings, root: &Path, config: &Config) -> Result<Self> {
        let headset = HeadsetSession::open(settings)?;
        let mut renderer = Renderer::new(headset.gpu(), convert::settings(&config.shows))
            .context("cannot draw for the headset")?;
        let mut stock = Stock::load(&mut renderer, root, config)?;
        stock.add_screen(&mut renderer, root, config)?;
        let words = Words::load(root, config)?;
        let panel = PanelStock::new(headset.gpu(), &mut renderer, &words)?;
        let signs = SignStock::new(headset.gpu(), &mut renderer)?;
        Ok(Self {
            renderer,
            stock,
            panel,
            signs,
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
    again: Option<Again>,
    ears: Ears,
    /// What the hands did around each throw.
    throws: Throws,
    /// Whether the participant plays.
    attention: Attention,
    /// The hand that the tracker has lost.
    fading: Fading,
    /// What is around the participant.
    around: Around,
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
                Ok(()) => return self.end(),
                // Whatever the runtime answers in the middle of a game: it is asked anew before anything is given up.
                Err(error) if error.is::<HeadsetError>() => {
                    println!("{error:#}. The game waits for the headset; Ctrl-C ends and saves.");
                    self.shared.note(json!({ "lost": format!("{error:#}") }))?;
                    self.times.pause();
                }
                Err(error) => return Err(error),
            }
        }
        self.end()
    }

    /// What is left to say when nothing more is played.
    fn end(&mut self) -> Result<()> {
        if let Some(line) = self.throws.finish() {
            self.shared.note(line)?;
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
        self.attention.reconnect();
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
                self.shared.note(notes::line(&note))?;
                if let Some(text) = notes::text(&note) {
                    println!("{text}");
                }
                self.attention.hear(&note);
                match note {
                    Note::Recentred(at) => self.participant.recentre(at),
                    Note::Exit => return Ok(()),
                    _ => {}
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

    fn frame(&mut self, stage: &mut Stage) -> Result<()> {
        let headset = &mut stage.headset;
        let frame = headset.wait()?;
        let readings = headset.read(&frame)?;
        let was_paused = self.attention.is_paused();
        self.attention.press_menu(&readings);
        self.around.look(headset, &frame)?;
        let focus = headset.focus();
        let at = frame.display_time_ns();
        let fingers = self.participant.fingers(&readings);
        self.shared.see_fingers(fingers);
        let (participant, panel, keys) = (&mut self.participant, &mut self.panel, &self.shared);
        let (fading, ears, again) = (&mut self.fading, &mut self.ears, &mut self.again);
        let (attention, around) = (&mut self.attention, &mut self.around);
        let played = self.shared.with(|session| {
            let rig = session.game().world_from_tracking();
            let arms = attention
                .is_present(focus)
                .then(|| participant.arms(&readings, rig))
                .flatten();
            let wish = around.heed(arms, attention, at);
            let is_here = attention.is_here(focus);
            let mut input = if is_here {
                let is_holding = session.game().held().is_some();
                participant.input(&readings, at, frame.period_s(), is_holding)
            } else {
                participant.pause(&readings)
            };
            input.recentre = wish == Some(Wish::Recentre);
            input.press_red |= keys.take_press(Button::Red);
            input.press_blue |= keys.take_press(Button::Blue);
            let held = session.game().held();
            session.frame(input)?;
            if is_here {
                panel.attend(session)?;
            }
            let game = session.game();
            ears.notice(game);
            ears.hear(game);
            let moment = again.as_mut().and_then(|again| {
                again.notice(game);
                again.at(game.time())
            });
            stage.stock.show_again(moment.clone())?;
            keys.set_again(moment);
            let visible = game.visible_at(participant.share());
            let scores = convert::Scores::of(game);
            stage.stock.show_scores(&mut stage.renderer, &scores)?;
            let hand_shape = convert::HandShape::of(game).bent(fingers);
            let mut scene = convert::scene(visible.iter(), &stage.stock, hand_shape);
            if is_here {
                let faded = fading.of(&visible, at);
                if let Some((hand, share)) = faded {
                    let hand = convert::shrunk_hand(&hand, &stage.stock, hand_shape, share);
                    scene.instances.extend(hand);
                }
            } else {
                fading.forget();
            }
            scene.vignette = convert::vignette(game);
            let drawn = (&stage.stock, &mut stage.signs, &mut stage.renderer);
            let more = around.instances(game, arms, attention.is_paused(), drawn)?;
            scene.instances.extend(more);
            let pulse = pulses::of(game.events(), held).filter(|_| is_here);
            let happened = Happened::among(game.events());
            Ok((scene, game.world_from_tracking(), pulse, happened))
        })?;
        let Some((mut scene, rig, pulse, happened)) = played else {
            // The main thread has finished the session without this one.
            headset.skip(frame)?;
            return Ok(());
        };
        for line in self.throws.follow(at, &readings, happened.released) {
            self.shared.note(line)?;
        }
        let panel = stage.panel.instances(&self.panel, &mut stage.renderer)?;
        scene.instances.extend(panel);
        let simulated = frame.woken().elapsed();
        let timing = self.times.of(&frame, simulated);
        let is_shown = if frame.should_render() {
            let rig = (rig.position.as_vec3(), rig.rotation.as_quat());
            let views = headset
                .show(frame, &mut stage.renderer, &scene, rig, false)?
                .views;
            self.shared.see(views.first().copied());
            !views.is_empty()
        } else {
            headset.skip(frame)?;
            false
        };
        if self.attention.is_paused() != was_paused {
            self.shared.note(json!({ "paused": !was_paused }))?;
        }
        if let Some(pulse) = pulse {
            let side = self.participant.throwing();
            headset.pulse(side, pulse.amplitude, pulse.seconds)?;
        }
        let line = self.times.finish(timing, is_shown);
        self.shared.note(line)?;
        if happened.has_ended {
            self.shared.note(self.times.game_summary())?;
        }
        if happened.has_begun {
            self.times.begin_game();
        }
        Ok(())
    }
}

/// What a frame's events mean to those who keep account of it.
#[derive(Clone, Copy, Debug, Default)]
struct Happened {
    /// The step at which a hand let go.
    released: Option<u64>,
    /// A game began.
    has_begun: bool,
    /// A game is over.
    has_ended: bool,
}

impl Happened {
    fn among(events: &[Event]) -> Self {
        let mut happened = Self::default();
        for event in events {
            match event.kind {
                EventKind::Released(_) => happened.released = Some(event.step),
                EventKind::GameStarted { .. } => happened.has_begun = true,
                EventKind::GameOver { .. } => happened.has_ended = true,
                _ => {}
            }
        }
        happened
    }
}
