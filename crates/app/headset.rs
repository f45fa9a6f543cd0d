//! `bowling play` in a headset: a session with the OpenXR runtime plays the game, and a watchdog stays beside it.
//!
//! The runtime's calls may block for as long as the runtime likes, and a screen's as long as the screen does, so each have a thread of
//! their own: the player's, and the main thread with the mirror. Game and journal are shared; the watch, a third, closes them in order
//! even if a call never returns. A runtime that ends the session or dies is connected to anew; the game waits meanwhile.

mod answered;
mod around;
mod attention;
mod fading;
mod frames;
mod mirror;
mod notes;
mod pace;
mod player;
mod pulses;
mod shared;
mod stage;
mod throws;
mod watch;

use std::path::{Path, PathBuf};
use std::sync::atomic::Ordering;
use std::sync::mpsc;
use std::sync::{Arc, PoisonError};
use std::time::Duration;

use anyhow::{Context, Result, bail};
use renderer::headset::{Found, HeadsetSettings};
use serde_json::json;

use crate::lettering::Scribe;
use crate::pictures::{Painter, Wanted};
use crate::play::{self, Progress};
use crate::session::{Session, Setup};
use crate::sound::Ears;
use crate::study::attendant::Attendance;
use crate::words::Words;
pub use answered::answered;
use player::Player;
use shared::Shared;
use stage::Stage;
use watch::Watch;

/// How long the first connection may take, shaders and assets included.
const LONGEST_BEGINNING: Duration = Duration::from_secs(60);

/// Settings with a refresh rate that somebody asked for [Hz]; `None` for the highest that the machine holds.
pub fn asking_for(refresh_rate_hz: Option<f32>) -> HeadsetSettings {
    HeadsetSettings {
        refresh_rate_hz,
        highest_rate_hz: None,
    }
}

/// Plays in the headset that was found until the runtime or Ctrl-C ends it, and leaves the recording in order.
///
/// # Errors
/// One sentence when the headset cannot be used, an asset is missing, or the recording cannot be written.
pub fn run(
    setup: Setup,
    root: &Path,
    wanted: Wanted,
    (found, settings): (Found, HeadsetSettings),
    attendance: Option<Attendance>,
) -> Result<()> {
    let (attendant, events) = attendance
        .map(|attendance| (attendance.attendant, attendance.events))
        .unzip();
    let config = setup.conditions.lobby.clone();
    let stop = play::interruption()?;
    let words = Words::load(root, &config)?;
    let (scribe, last_word) = Scribe::begin()?;
    let stage = {
        let (scribe, words) = (scribe.clone(), words.clone());
        let (root, config) = (root.to_owned(), config.clone());
        let open = move || Stage::open(found, settings, &scribe, &root, &config, &words);
        let is_given_up = || stop.load(Ordering::Relaxed);
        match answered(LONGEST_BEGINNING, is_given_up, open) {
            Some(stage) => stage?,
            None if is_given_up() => bail!("interrupted before anything was recorded"),
            None => {
                bail!("the OpenXR runtime does not answer: end it, start it again, and try anew")
            }
        }
    };
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
    let shared = Arc::new(Shared::new(session, stop)?);
    let player = Player::new(
        Arc::clone(&shared),
        root,
        &config,
        settings,
        (scribe, ears, words),
    );
    let (sender, ended) = mpsc::channel();
    std::thread::Builder::new()
        .name("headset".to_owned())
        .spawn(move || {
            // The receiver is gone only where this thread has been given up.
            let _ = sender.send(player.play(stage));
        })
        .context("cannot start the headset's thread")?;
    let end = End {
        shared: Arc::clone(&shared),
        root: root.to_owned(),
        wanted,
    };
    let watched = Watch::new(Arc::clone(&shared), ended, attendant).begin(end.clone())?;
    let outcome = mirror::stay(
        watched,
        Arc::clone(&shared),
        root,
        &config,
        events.flatten(),
    );
    last_word.wait();
    end.conclude(outcome)
}

/// What is left to do when nothing more is played.
#[derive(Clone)]
struct End {
    shared: Arc<Shared>,
    root: PathBuf,
    wanted: Wanted,
}

impl End {
    /// Leaves the session in order, with its files and pictures; an error that ended it is reported.
    fn conclude(self, outcome: Result<()>) -> Result<()> {
        let Self {
            shared,
            root,
            wanted,
        } = self;
        shared.voice.finish();
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
        let was_stopped = shared.stop.swap(false, Ordering::Relaxed);
        let config = session.game().config().clone();
        let painter = (session.has_throws() && !was_stopped)
            .then(|| Painter::new(&root, &config))
            .transpose()?
            .map(|painter| painter.stopped_by(Arc::clone(&shared.stop)));
        play::close(session, painter, wanted, Progress::new())?;
        Ok(())
    }
}
