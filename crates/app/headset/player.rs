//! The runtime's thread: plays frame by frame, through as many connections as it takes.

use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::{Duration, Instant};

use anyhow::Result;
use experiment::protocol::AnsweredIn;
use game::{Button, Config, Event, EventKind};
use renderer::headset::{Found, HeadsetError, HeadsetSession, HeadsetSettings, Note};
use serde_json::json;

use super::around::Around;
use super::attention::Attention;
use super::fading::Fading;
use super::frames::FrameTimes;
use super::notes;
use super::pace::Pace;
use super::pulses::{self, Presses, Whose};
use super::shared::Shared;
use super::stage::Stage;
use super::throws::Throws;
use crate::again::Again;
use crate::convert;
use crate::devices::headset::Participant;
use crate::hints::Grip;
use crate::lettering::Scribe;
use crate::panel::Panel;
use crate::sound::Ears;
use crate::words::Words;
use crate::wrist::Wish;

/// Time between two attempts to connect anew.
const RETRY: Duration = Duration::from_millis(500);
/// Longest wait for a runtime that was asked to end the session.
const LONGEST_END: Duration = Duration::from_secs(3);
/// How often the runtime is asked whether it wants frames, while it wants none.
const IDLE: Duration = Duration::from_millis(10);
/// Connections that end one after the other without a picture, until it is given up.
const UNDRAWN: u32 = 20;

/// The runtime's thread.
pub struct Player {
    shared: Arc<Shared>,
    root: PathBuf,
    config: Config,
    settings: HeadsetSettings,
    participant: Participant,
    /// What a study asks in the room.
    panel: Panel,
    times: FrameTimes,
    pace: Pace,
    again: Option<Again>,
    ears: Ears,
    /// What the hands did around each throw.
    throws: Throws,
    /// Whether the participant plays.
    attention: Attention,
    /// Who presses Red and Blue.
    presses: Presses,
    /// The hand that the tracker has lost.
    fading: Fading,
    /// What is around the participant.
    around: Around,
    scribe: Scribe,
    words: Words,
    /// Why the last attempt to connect failed.
    refusal: String,
    /// Connections in a row that ended before a picture was shown, because it could not be drawn.
    undrawn: u32,
}

impl Player {
    /// Somebody who has not begun.
    pub fn new(
        shared: Arc<Shared>,
        root: &Path,
        config: &Config,
        settings: HeadsetSettings,
        (scribe, ears, words): (Scribe, Ears, Words),
    ) -> Self {
        Self {
            shared,
            root: root.to_owned(),
            participant: Participant::new(config.physics.step_hz),
            panel: Panel::new(AnsweredIn::Headset, words.clone()),
            times: FrameTimes::default(),
            // A rate that somebody asked for stays.
            pace: settings
                .refresh_rate_hz
                .map_or_else(Pace::default, |_| Pace::settled()),
            throws: Throws::default(),
            attention: Attention::new(),
            presses: Presses::default(),
            fading: Fading::new(config.hand.lost_grip_s),
            again: Again::of(config),
            ears,
            around: Around::new(config, words.clone()),
            scribe,
            words,
            refusal: String::new(),
            undrawn: 0,
            config: config.clone(),
            settings,
        }
    }

    /// Plays until the end, through as many connections as it takes.
    pub fn play(mut self, stage: Stage) -> Result<()> {
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
                Err(error) if error.is::<HeadsetError>() && self.undrawn < UNDRAWN => {
                    let text = format!(
                        "{error:#}. The game waits for the headset; Ctrl-C ends and saves."
                    );
                    self.shared.voice.say(text);
                    self.undrawn += 1;
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
        self.shared.begin_connecting();
        let opened = Found::look().map_err(Into::into).and_then(|found| {
            let (root, config) = (&self.root, &self.config);
            Stage::open(
                found,
                self.settings,
                &self.scribe,
                root,
                config,
                &self.words,
            )
        });
        self.shared.beat();
        let stage = match opened {
            Ok(stage) => stage,
            Err(error) if error.is::<HeadsetError>() => {
                let refusal = format!("{error:#}");
                if refusal != self.refusal {
                    self.shared.voice.say(format!("Not yet: {refusal}."));
                    self.shared.note(json!({ "refused": refusal }))?;
                    self.refusal = refusal;
                }
                return Ok(None);
            }
            Err(error) => return Err(error),
        };
        self.refusal.clear();
        self.attention.reconnect();
        let text = "Connected to the headset again: the game goes on.";
        self.shared.voice.say(text.to_owned());
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
                    self.shared.voice.say(text);
                }
                self.attention.hear(&note);
                self.pace.hear(&note);
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

    /// This machine does not hold the display's rate: a lower one is asked for, and kept to when a connection is made anew.
    fn slow_down(&mut self, headset: &HeadsetSession) -> Result<()> {
        let Some((from, to)) = headset.slow_down() else {
            self.pace.settle();
            return Ok(());
        };
        self.settings.highest_rate_hz = Some(to);
        let text =
            format!("This machine does not hold the headset's {from} Hz: asked for {to} Hz.");
        self.shared.voice.say(text);
        self.shared
            .note(json!({ "slowed_down": { "from_hz": from, "to_hz": to } }))
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
        let (participant, panel, keys) = (&mut self.participant, &mut self.panel, &self.shared);
        let (fading, ears, again) = (&mut self.fading, &mut self.ears, &mut self.again);
        let (attention, around) = (&mut self.attention, &mut self.around);
        let presses = &mut self.presses;
        let played = self.shared.with(|session| {
            let rig = session.game().world_from_tracking();
            let arms = attention
                .is_present(focus)
                .then(|| participant.arms(&readings, rig))
                .flatten();
            let game = session.game();
            let is_busy = game.held().is_some() || game.could_take_a_ball();
            let wish = around.heed(arms, is_busy, attention, at);
            let is_here = attention.is_here(focus);
            let mut input = if is_here {
                let is_holding = session.game().held().is_some();
                participant.input(&readings, at, frame.period_s(), is_holding)
            } else {
                participant.pause(&readings)
            };
            input.recentre = wish == Some(Wish::Recentre);
            let thumb = [input.press_red, input.press_blue];
            let key = Button::BOTH.map(|button| keys.take_press(button));
            presses.follow(thumb, key);
            input.press_red |= key[Button::Red as usize];
            input.press_blue |= key[Button::Blue as usize];
            let held = session.game().held();
            session.frame(input)?;
            if !is_here || wish.is_some() {
                panel.forget_trigger();
            }
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
            let visible = game.visible_at(participant.share());
            let look = convert::HandLook::of(game).bent(fingers);
            let mut scene = convert::scene(visible.iter(), &stage.stock, look);
            if is_here {
                let faded = fading.of(&visible, at);
                if let Some((hand, share)) = faded {
                    let hand = convert::shrunk_hand(&hand, &stage.stock, look, share);
                    scene.instances.extend(hand);
                }
            } else {
                fading.forget();
            }
            scene.vignette = convert::vignette(game);
            let grip = fingers.map_or(Grip::Trigger, |_| Grip::BareHand);
            let beside = around.beside(game, grip, arms, attention.is_paused());
            scene.instances.extend(beside.instances(game, &stage.stock));
            let signs = stage.signs.instances(&beside.signs, &mut stage.renderer)?;
            scene.instances.extend(signs);
            let pulses = [Whose::Playing, Whose::Other]
                .map(|whose| pulses::of(game.events(), held, presses, whose).filter(|_| is_here));
            let happened = Happened::among(game.events());
            let shown = (convert::Scores::of(game), moment);
            Ok((
                scene,
                shown,
                beside,
                game.world_from_tracking(),
                pulses,
                happened,
            ))
        })?;
        let Some((mut scene, (scores, moment), beside, rig, pulses, happened)) = played else {
            // The main thread has finished the session without this one.
            headset.skip(frame)?;
            return Ok(());
        };
        stage.stock.show_again(moment.clone())?;
        {
            let mut seen = self.shared.sight();
            (seen.again, seen.beside, seen.fingers) = (moment, beside, fingers);
        }
        stage.stock.show_scores(&mut stage.renderer, &scores)?;
        let panel = stage.panel.instances(&self.panel, &mut stage.renderer)?;
        scene.instances.extend(panel);
        let simulated = frame.woken().elapsed();
        let timing = self.times.of(&frame, simulated);
        self.shared.miss(timing.missed());
        let is_shown = if frame.should_render() {
            let rig = (rig.position.as_vec3(), rig.rotation.as_quat());
            let views = headset
                .show(frame, &mut stage.renderer, &scene, rig, false)?
                .views;
            self.shared.sight().left_eye = views.first().copied();
            !views.is_empty()
        } else {
            headset.skip(frame)?;
            false
        };
        // Behind the picture, which waits for nothing that is only written down.
        for line in self.throws.follow(at, &readings, happened.released) {
            self.shared.note(line)?;
        }
        if is_shown {
            self.undrawn = 0;
        }
        if is_shown
            && self.attention.is_here(focus)
            && self.pace.is_lost(timing.missed(), timing.period_s())
        {
            self.slow_down(headset)?;
        }
        if self.attention.is_paused() != was_paused {
            self.shared.note(json!({ "paused": !was_paused }))?;
        }
        let playing = self.participant.throwing();
        for (side, pulse) in [playing, playing.other()].into_iter().zip(pulses) {
            if let Some(pulse) = pulse {
                headset.pulse(side, pulse.amplitude, pulse.seconds)?;
                self.shared.note(pulse.line(side))?;
            }
        }
        let line = self.times.finish(timing, is_shown);
        self.shared.with(|session| {
            if let Some(missed) = line.missed_before_it() {
                session.picture(missed);
            }
            session.device(line)
        })?;
        if happened.has_ended {
            self.shared.note(self.times.game_summary())?;
        }
        if happened.has_begun {
            self.times.begin_game();
        }
        if happened.has_begun || happened.released.is_some() {
            self.pace.settle();
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
