//! The experimenter's terminal. What is said and understood is [`super::experimenter`]'s.
//!
//! Lines are read by a thread of their own, so that no frame waits for a keyboard.

use std::io::BufRead;
use std::sync::mpsc::{Receiver, RecvTimeoutError, channel};
use std::time::Duration;

use anyhow::{Context, Result};

use super::experimenter::{self, HELP};
use crate::session::Session;
use crate::voice::Voice;

/// A terminal that attends to a session.
#[derive(Debug)]
pub struct Console {
    lines: Receiver<String>,
    /// What was said last, so that it is said once.
    said: String,
    /// A session in a headset attends to its terminal under the lock that its frames take.
    voice: Voice,
}

impl Console {
    /// Listens to the standard input.
    ///
    /// # Errors
    /// When the system has no thread left.
    pub fn listen() -> Result<Self> {
        let (sender, lines) = channel();
        std::thread::Builder::new()
            .name("console".to_owned())
            .spawn(move || {
                for line in std::io::stdin().lock().lines() {
                    // Nobody listens any more, or the input is no text: either ends the reading.
                    let Ok(line) = line else { return };
                    if sender.send(line).is_err() {
                        return;
                    }
                }
            })
            .context("cannot listen to the terminal")?;
        Ok(Self {
            lines,
            said: String::new(),
            voice: Voice::new()?,
        })
    }

    /// Says what can be typed while a session runs.
    pub fn introduce(&self) {
        println!("{HELP}");
    }

    /// The next line that was typed, waiting for it at most so long.
    ///
    /// # Errors
    /// When nobody types any more, or not yet.
    pub fn line(&self, wait: Duration) -> Result<String, RecvTimeoutError> {
        self.lines.recv_timeout(wait)
    }

    /// Says what is due, once, and takes the lines that were typed.
    ///
    /// # Errors
    /// When the journal cannot be written.
    pub fn attend(&mut self, session: &mut Session) -> Result<()> {
        self.say(session);
        while let Ok(line) = self.lines.try_recv() {
            if let Some(reply) = experimenter::take(&line, session)? {
                self.voice.say(reply);
            }
            self.said.clear();
            self.say(session);
        }
        Ok(())
    }

    fn say(&mut self, session: &Session) {
        let due = experimenter::due(session).unwrap_or_default();
        if due != self.said {
            self.voice.say(due.clone());
            self.said = due;
        }
    }
}

impl Drop for Console {
    fn drop(&mut self) {
        self.voice.finish();
    }
}
