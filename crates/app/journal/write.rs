//! Appends to a journal.

use std::fs::{self, File, OpenOptions};
use std::io::{BufWriter, Write};
use std::path::{Path, PathBuf};

use anyhow::{Context, Result};
use game::{Event, Input};

use super::{End, Entry, FIRST_CHECK, Header, InputLine, continue_check};

/// A journal being written; append-only.
#[derive(Debug)]
pub struct Journal {
    file: BufWriter<File>,
    path: PathBuf,
    line: u64,
    check: u32,
    inputs: u64,
    /// Inputs between two flushes: a crash loses at most a second.
    inputs_per_flush: u64,
}

impl Journal {
    /// Creates `path`, which must not exist, and writes the header; without the header no file stays.
    ///
    /// # Errors
    /// When the file exists or cannot be written.
    pub fn create(path: &Path, header: Header) -> Result<Self> {
        let file = OpenOptions::new()
            .append(true)
            .create_new(true)
            .open(path)
            .with_context(|| format!("cannot create the journal {}", path.display()))?;
        let mut journal = Journal {
            file: BufWriter::new(file),
            path: path.to_path_buf(),
            line: 0,
            check: FIRST_CHECK,
            inputs: 0,
            inputs_per_flush: (header.rate_hz as u64).max(1),
        };
        let begun = journal
            .append(&Entry::Header(Box::new(header)))
            .and_then(|()| journal.flush());
        if let Err(error) = begun {
            // What is still buffered would fail again.
            let _ = journal.file.into_parts();
            // The error that is reported says why nothing can be done about a file that stays.
            let _ = fs::remove_file(path);
            return Err(error);
        }
        Ok(journal)
    }

    /// Records what the game is about to consume.
    ///
    /// # Errors
    /// When the disk is full or gone; the session must end then.
    pub fn input(&mut self, input: &Input) -> Result<()> {
        self.append(&Entry::Input(InputLine::from(input)))?;
        self.inputs += 1;
        if self.inputs.is_multiple_of(self.inputs_per_flush) {
            self.flush()
        } else {
            Ok(())
        }
    }

    /// Records what happened in the frame of the last input.
    ///
    /// # Errors
    /// As [`Journal::input`].
    pub fn event(&mut self, event: &Event) -> Result<()> {
        let value = serde_json::to_value(event).context("an event cannot be written as JSON")?;
        self.append(&Entry::Event(value))
    }

    /// Records what the device said of itself.
    ///
    /// # Errors
    /// As [`Journal::input`].
    pub fn device(&mut self, value: serde_json::Value) -> Result<()> {
        self.append(&Entry::Device(value))
    }

    /// Closes the journal; `end.inputs` is filled in here.
    ///
    /// # Errors
    /// As [`Journal::input`].
    pub fn end(mut self, mut end: End) -> Result<()> {
        end.inputs = self.inputs;
        self.append(&Entry::End(end))?;
        self.flush()?;
        self.file
            .get_ref()
            .sync_all()
            .with_context(|| self.failure())
    }

    fn append(&mut self, entry: &Entry) -> Result<()> {
        let content =
            serde_json::to_string(entry).context("a journal line cannot be written as JSON")?;
        self.line += 1;
        self.check = continue_check(self.check, &content);
        let inner = content
            .strip_prefix('{')
            .expect("an entry is a JSON object");
        writeln!(
            self.file,
            "{{\"line\":{},\"check\":\"{:08x}\",{inner}",
            self.line, self.check
        )
        .with_context(|| self.failure())
    }

    /// Hands everything recorded so far to the system, where a crash of this program cannot touch it.
    ///
    /// # Errors
    /// As [`Journal::input`].
    pub fn flush(&mut self) -> Result<()> {
        self.file.flush().with_context(|| self.failure())
    }

    fn failure(&self) -> String {
        format!(
            "cannot write the journal {}: is the disk full?",
            self.path.display()
        )
    }
}
