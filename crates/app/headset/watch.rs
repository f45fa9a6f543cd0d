//! An eye on the headset's thread, and on the main one with its screen: does the runtime answer, has the thread ended, does anybody
//! hear of it?

use std::sync::atomic::Ordering;
use std::sync::mpsc::{Receiver, RecvTimeoutError};
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

use anyhow::{Context, Result, anyhow};
use serde_json::json;

use super::{End, Shared};
use crate::study::attendant::Attendant;

/// A frame that takes longer than this is a runtime that does not answer.
const PATIENCE: Duration = Duration::from_secs(2);
/// The same of a new connection.
const CONNECTING: Duration = Duration::from_secs(60);
/// A main thread that does not hear of the end for so long hangs in its screen.
const SCREEN: Duration = Duration::from_secs(2);
/// How often somebody who only waits looks.
const INTERVAL: Duration = Duration::from_millis(100);

/// Watches the headset's thread.
pub struct Watch {
    shared: Arc<Shared>,
    ended: Receiver<Result<()>>,
    /// Who attends to a study's session.
    attendant: Option<Attendant>,
    is_silent: bool,
    asked_to_stop: Option<Instant>,
}

impl Watch {
    /// Over the thread that sends its outcome to `ended`.
    pub fn new(
        shared: Arc<Shared>,
        ended: Receiver<Result<()>>,
        attendant: Option<Attendant>,
    ) -> Self {
        Self {
            shared,
            ended,
            attendant,
            is_silent: false,
            asked_to_stop: None,
        }
    }

    /// Watches from a thread of its own. Where nobody takes the outcome, it concludes the session itself, and ends the program.
    ///
    /// # Errors
    /// When the system has no thread left.
    pub fn begin(mut self, end: End) -> Result<Watched> {
        let slot = Arc::new((Mutex::new(None), Condvar::new()));
        let watched = Watched {
            slot: Arc::clone(&slot),
        };
        let watch = move || {
            let outcome = loop {
                if let Some(outcome) = self.look(INTERVAL) {
                    break outcome;
                }
            };
            let (slot, changed) = &*slot;
            let mut slot = locked(slot);
            *slot = Some(outcome);
            changed.notify_all();
            let waited = changed.wait_timeout_while(slot, SCREEN, |slot| slot.is_some());
            let (mut slot, _) = waited.unwrap_or_else(PoisonError::into_inner);
            let Some(outcome) = slot.take() else { return };
            drop(slot);
            end.shared.voice.say(
                "The screen of the mirror window does not answer: ended without it.".to_owned(),
            );
            std::process::exit(match end.conclude(outcome) {
                Ok(()) => 0,
                Err(error) => {
                    eprintln!("error: {error:#}");
                    1
                }
            });
        };
        std::thread::Builder::new()
            .name("watch".to_owned())
            .spawn(watch)
            .context("cannot start the watchdog's thread")?;
        Ok(watched)
    }

    /// Looks for at most `wait`: how the thread ended, or nothing while it runs. A thread that hangs in the runtime after it
    /// was asked to stop counts as ended: it is left behind, the session is not.
    fn look(&mut self, wait: Duration) -> Option<Result<()>> {
        match self.ended.recv_timeout(wait) {
            Ok(outcome) => return Some(outcome),
            Err(RecvTimeoutError::Disconnected) => {
                return Some(Err(anyhow!(
                    "the headset's thread ended by a fault of the program; the recording is in order up to here"
                )));
            }
            Err(RecvTimeoutError::Timeout) => {}
        }
        if let Err(error) = self.attend() {
            return Some(Err(error));
        }
        let silence = self.shared.silence();
        let is_silent = silence
            > match self.shared.is_connecting() {
                true => CONNECTING,
                false => PATIENCE,
            };
        if is_silent != self.is_silent {
            self.is_silent = is_silent;
            if let Err(error) = self.tell() {
                return Some(Err(error));
            }
        }
        if self.shared.must_stop() {
            let since = *self.asked_to_stop.get_or_insert_with(Instant::now);
            if since.elapsed() > PATIENCE && silence > PATIENCE {
                return Some(Ok(()));
            }
        }
        None
    }

    /// Lets whoever attends to a study's session do what is due; one that is over stops the play.
    fn attend(&mut self) -> Result<()> {
        let Some(attendant) = &mut self.attendant else {
            return Ok(());
        };
        let is_over = self.shared.with(|session| {
            attendant.attend(session)?;
            Ok(session.is_over())
        })?;
        if is_over == Some(true) {
            self.shared.stop.store(true, Ordering::Relaxed);
        }
        Ok(())
    }

    fn tell(&self) -> Result<()> {
        let text = match self.is_silent {
            true => "The OpenXR runtime does not answer: the game waits. Ctrl-C ends and saves.",
            false => "The OpenXR runtime answers again.",
        };
        self.shared.voice.say(text.to_owned());
        self.shared
            .note(json!({ "runtime_answers": !self.is_silent }))?;
        Ok(())
    }
}

/// A thread that is watched.
pub struct Watched {
    slot: Arc<(Mutex<Option<Result<()>>>, Condvar)>,
}

/// A thread that panicked left a whole outcome or none.
fn locked<T>(slot: &Mutex<T>) -> MutexGuard<'_, T> {
    slot.lock().unwrap_or_else(PoisonError::into_inner)
}

impl Watched {
    /// How the thread ended, once; nothing while it runs.
    pub fn outcome(&self) -> Option<Result<()>> {
        let (slot, changed) = &*self.slot;
        let outcome = locked(slot).take();
        changed.notify_all();
        outcome
    }

    /// Waits for the thread's end.
    ///
    /// # Errors
    /// What ended it.
    pub fn wait(self) -> Result<()> {
        let (slot, changed) = &*self.slot;
        let waited = changed.wait_while(locked(slot), |slot| slot.is_none());
        let outcome = waited.unwrap_or_else(PoisonError::into_inner).take();
        changed.notify_all();
        outcome.unwrap_or(Ok(()))
    }
}
