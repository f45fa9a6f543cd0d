//! Appends to a journal.

use std::fs;
use std::path::Path;

use anyhow::{Context, Result};
use experiment::journal::Appender;
use experiment::protocol::Note;
use game::{Event, Input};

use super::{End, Entry, Header, InputLine, Said};

type Line = Entry<Event, Said>;

/// A journal being written; append-only.
pub struct Journal {
    lines: Appender<Line>,
    inputs: u64,
}

impl Journal {
    /// Creates `path`, which must not exist, and writes the header; without the header no file stays.
    ///
    /// # Errors
    /// When the file exists or cannot be written.
    pub fn create(path: &Path, header: Header) -> Result<Self> {
        let mut lines = Appender::create(path)?;
        let begun = lines
            .append(Entry::Header(Box::new(header)))
            .and_then(|()| lines.sync());
        if let Err(error) = begun {
            drop(lines);
            // The error that is reported says why nothing can be done about a file that stays.
            let _ = fs::remove_file(path);
            return Err(error.into());
        }
        Ok(Journal { lines, inputs: 0 })
    }

    /// The same journal, whose session has consumed `inputs` inputs in earlier ones.
    #[must_use]
    pub fn behind(mut self, inputs: u64) -> Self {
        self.inputs = inputs;
        self
    }

    /// Records what the game is about to consume.
    ///
    /// # Errors
    /// When the disk is full or gone; the session must end then.
    pub fn input(&mut self, input: &Input) -> Result<()> {
        self.inputs += 1;
        self.append(Entry::Input(InputLine::from(input)))
    }

    /// Records what happened in the frame of the last input.
    ///
    /// # Errors
    /// As [`Journal::input`].
    pub fn event(&mut self, event: &Event) -> Result<()> {
        self.append(Entry::Event(event.clone()))
    }

    /// Records what the device said of itself.
    ///
    /// # Errors
    /// As [`Journal::input`].
    pub fn device(&mut self, said: impl Into<Said>) -> Result<()> {
        self.append(Entry::Device(said.into()))
    }

    /// Records what the experiment noted, and has it outlast a power cut as soon as the disk can.
    ///
    /// # Errors
    /// As [`Journal::input`].
    pub fn study(&mut self, note: &Note) -> Result<()> {
        let value = serde_json::to_value(note).context("a note cannot be written as JSON")?;
        self.append(Entry::Study(value))?;
        Ok(self.lines.persist()?)
    }

    /// Closes the journal; `end.inputs` is filled in here.
    ///
    /// # Errors
    /// As [`Journal::input`].
    pub fn end(mut self, mut end: End) -> Result<()> {
        end.inputs = self.inputs;
        self.append(Entry::End(end))?;
        Ok(self.lines.sync()?)
    }

    fn append(&mut self, entry: Line) -> Result<()> {
        Ok(self.lines.append(entry)?)
    }
}
