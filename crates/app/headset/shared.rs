//! What the threads of a session in a headset share.

use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

use anyhow::Result;
use game::Button;
use renderer::View;

use crate::again::Moment;
use crate::journal::Said;
use crate::scenery::hand::Fingers;
use crate::session::Session;
use crate::voice::Voice;

use super::around::Beside;

/// What was in sight in the headset's last frame and is no part of the game.
#[derive(Clone, Default)]
pub struct Seen {
    /// The left eye's view, world frame, once a picture was shown.
    pub left_eye: Option<View>,
    /// What the screen over the lane shows again.
    pub again: Option<Moment>,
    /// What is around the participant.
    pub beside: Beside,
    /// The fingers of a bare hand that plays.
    pub fingers: Option<Fingers>,
}

/// What the threads share.
pub struct Shared {
    /// `None` once the session is finished.
    pub session: Mutex<Option<Session>>,
    /// Milliseconds since `began` at which the runtime's thread last came round.
    beat_ms: AtomicU64,
    /// Whether it is making a connection.
    is_connecting: AtomicBool,
    began: Instant,
    /// What the mirror shows beside the game.
    seen: Mutex<Seen>,
    /// The experimenter's keys for Red and Blue: pressed since the last frame.
    keys: [AtomicBool; 2],
    /// Pictures that the headset missed.
    missed: AtomicU64,
    /// Says what the experimenter should know.
    pub voice: Voice,
    pub stop: Arc<AtomicBool>,
}

impl Shared {
    /// Of a session that begins now.
    ///
    /// # Errors
    /// When the system has no thread left.
    pub fn new(session: Session, stop: Arc<AtomicBool>) -> Result<Self> {
        Ok(Self {
            session: Mutex::new(Some(session)),
            beat_ms: AtomicU64::new(0),
            is_connecting: AtomicBool::new(false),
            began: Instant::now(),
            seen: Mutex::default(),
            keys: Default::default(),
            missed: AtomicU64::new(0),
            voice: Voice::new()?,
            stop,
        })
    }

    pub fn beat(&self) {
        self.is_connecting.store(false, Ordering::Relaxed);
        self.tick();
    }

    /// A connection is made anew, which takes longer than a frame.
    pub fn begin_connecting(&self) {
        self.is_connecting.store(true, Ordering::Relaxed);
        self.tick();
    }

    pub fn is_connecting(&self) -> bool {
        self.is_connecting.load(Ordering::Relaxed)
    }

    fn tick(&self) {
        let now = self.began.elapsed().as_millis() as u64;
        self.beat_ms.store(now, Ordering::Relaxed);
    }

    /// How long the runtime's thread has been silent.
    pub fn silence(&self) -> Duration {
        let beat = Duration::from_millis(self.beat_ms.load(Ordering::Relaxed));
        self.began.elapsed().saturating_sub(beat)
    }

    /// The experimenter presses a key; the next frame takes it.
    pub fn press(&self, button: Button) {
        self.keys[button as usize].store(true, Ordering::Relaxed);
    }

    pub fn take_press(&self, button: Button) -> bool {
        self.keys[button as usize].swap(false, Ordering::Relaxed)
    }

    /// The headset missed so many pictures before this one.
    pub fn miss(&self, pictures: u64) {
        self.missed.fetch_add(pictures, Ordering::Relaxed);
    }

    /// Pictures that the headset has missed so far.
    pub fn missed(&self) -> u64 {
        self.missed.load(Ordering::Relaxed)
    }

    /// What was in sight last.
    pub fn seen(&self) -> Seen {
        self.sight().clone()
    }

    /// What is in sight, to be changed.
    pub fn sight(&self) -> MutexGuard<'_, Seen> {
        // What a thread that panicked left can be shown: its parts belong to two frames at most.
        self.seen.lock().unwrap_or_else(PoisonError::into_inner)
    }

    pub fn must_stop(&self) -> bool {
        self.stop.load(Ordering::Relaxed)
    }

    /// Does something with the session, unless it is finished.
    pub fn with<T>(&self, act: impl FnOnce(&mut Session) -> Result<T>) -> Result<Option<T>> {
        // A thread that panicked left the journal between two lines: it can still be closed.
        let mut session = self.session.lock().unwrap_or_else(PoisonError::into_inner);
        session.as_mut().map(act).transpose()
    }

    pub fn note(&self, said: impl Into<Said>) -> Result<()> {
        self.with(|session| session.device(said)).map(|_| ())
    }
}
