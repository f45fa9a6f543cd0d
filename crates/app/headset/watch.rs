//! The main thread's eye on the headset's: does the runtime answer, has the thread ended?

use std::sync::Arc;
use std::sync::atomic::Ordering;
use std::sync::mpsc::{Receiver, RecvTimeoutError};
use std::time::{Duration, Instant};

use anyhow::{Result, anyhow};
use serde_json::json;

use super::Shared;
use crate::study::attendant::Attendant;

/// A frame that takes longer than this is a runtime that does not answer.
const PATIENCE: Duration = Duration::from_secs(2);
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

    /// Waits for the thread's end.
    ///
    /// # Errors
    /// What ended it.
    pub fn wait(mut self) -> Result<()> {
        loop {
            if let Some(outcome) = self.look(INTERVAL) {
                return outcome;
            }
        }
    }

    /// Looks for at most `wait`: how the thread ended, or nothing while it runs. A thread that hangs in the runtime after it
    /// was asked to stop counts as ended: it is left behind, the session is not.
    pub fn look(&mut self, wait: Duration) -> Option<Result<()>> {
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
        let is_silent = self.shared.silence() > PATIENCE;
        if is_silent != self.is_silent {
            self.is_silent = is_silent;
            if let Err(error) = self.tell() {
                return Some(Err(error));
            }
        }
        if self.shared.must_stop() {
            let since = *self.asked_to_stop.get_or_insert_with(Instant::now);
            if since.elapsed() > PATIENCE && is_silent {
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
        println!(
            "{}",
            if self.is_silent {
                "The OpenXR runtime does not answer: the game waits. Ctrl-C ends and saves."
            } else {
                "The OpenXR runtime answers again."
            }
        );
        self.shared
            .note(json!({ "runtime_answers": !self.is_silent }))?;
        Ok(())
    }
}
