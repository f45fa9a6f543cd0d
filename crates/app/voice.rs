//! What is said to the terminal by a thread that must never wait for it: a terminal that is held, or a pipe that nobody reads, takes
//! no more lines for as long as it likes.

use std::sync::mpsc::{Sender, channel};
use std::time::Duration;

use anyhow::{Context, Result};

/// How long the last lines are waited for.
const LAST: Duration = Duration::from_secs(1);

/// Something for the thread that says it.
enum Line {
    Text(String),
    /// All before this was said.
    End(Sender<()>),
}

/// Says lines in the order in which they came.
#[derive(Debug)]
pub struct Voice {
    lines: Sender<Line>,
}

impl Voice {
    /// Begins to listen.
    ///
    /// # Errors
    /// When the system has no thread left.
    pub fn new() -> Result<Self> {
        let (lines, due) = channel();
        std::thread::Builder::new()
            .name("voice".to_owned())
            .spawn(move || {
                for line in due {
                    match line {
                        Line::Text(text) => println!("{text}"),
                        Line::End(said) => {
                            // Who asked has gone on without.
                            let _ = said.send(());
                        }
                    }
                }
            })
            .context("cannot start the thread that writes to the terminal")?;
        Ok(Self { lines })
    }

    /// Says a line some time soon.
    pub fn say(&self, text: String) {
        // The thread ends with this sender alone, or by a closed output, to which nothing can be said.
        let _ = self.lines.send(Line::Text(text));
    }

    /// Waits until all was said, as long as it does not take long.
    pub fn finish(&self) {
        let (said, heard) = channel();
        if self.lines.send(Line::End(said)).is_ok() {
            let _ = heard.recv_timeout(LAST);
        }
    }
}
