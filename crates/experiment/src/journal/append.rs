//! Appends to a journal in the background.

use std::convert::Infallible;
use std::fs::{self, File, OpenOptions};
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::sync::mpsc::{Sender, channel};
use std::time::{Duration, Instant};

use serde::Serialize;

use super::{Check, JournalError, SCHEMA};
use crate::background::{BackgroundWriter, Sink};

/// A power cut loses at most this much; a kill of the program alone what was appended in the last milliseconds.
const SYNC_EVERY: Duration = Duration::from_secs(1);
/// Lines go to the system at the latest when there is so much of them [bytes].
const BUFFER: usize = 1 << 16;

/// A journal being written; append-only.
///
/// Entries are handed to a thread that numbers, checks, writes and syncs them in their order; what is waiting there when
/// this is dropped is still written.
#[derive(Debug)]
pub struct Appender<T> {
    path: PathBuf,
    writer: BackgroundWriter<Order<T>, Writer>,
}

#[derive(Debug)]
enum Order<T> {
    Append(T),
    /// Make everything so far outlast a power cut, then let go of who waits.
    Sync(Option<Sender<Infallible>>),
}

impl<T: Serialize + Send + 'static> Appender<T> {
    /// Creates `path`, which must not exist, readable by its owner alone.
    ///
    /// # Errors
    /// When the file exists or cannot be created.
    pub fn create(path: &Path) -> Result<Self, JournalError> {
        let mut options = OpenOptions::new();
        options.append(true).create_new(true);
        #[cfg(unix)]
        std::os::unix::fs::OpenOptionsExt::mode(&mut options, 0o600);
        let writer = options.open(path).and_then(|file| {
            let writer = Writer {
                file,
                buffer: Vec::with_capacity(BUFFER),
                line: 0,
                check: Check::of_schema(SCHEMA),
                unsynced_since: None,
                waiting: None,
            };
            // Without a thread nothing is written: no empty file stays.
            BackgroundWriter::begin("journal", writer).inspect_err(|_| {
                let _ = fs::remove_file(path);
            })
        });
        Ok(Self {
            path: path.to_owned(),
            writer: writer.map_err(|error| JournalError::Create {
                path: path.to_owned(),
                problem: error.to_string(),
            })?,
        })
    }

    /// Hands over an entry, which must serialise as a JSON object; takes a microsecond or two.
    ///
    /// # Errors
    /// When an earlier entry could not be written: the disk is full or gone.
    pub fn append(&mut self, entry: T) -> Result<(), JournalError> {
        self.order(Order::Append(entry))
    }

    /// Waits until everything appended so far outlasts a power cut.
    ///
    /// # Errors
    /// As [`Appender::append`].
    pub fn sync(&mut self) -> Result<(), JournalError> {
        let (done, wait) = channel();
        self.order(Order::Sync(Some(done)))?;
        self.writer.hurry();
        // Nothing is ever sent: this ends when the thread lets go, after its failure, if any, can be read.
        let _ = wait.recv();
        self.writer.failure().map_err(|problem| self.lost(problem))
    }

    /// Asks for the same without waiting for it.
    ///
    /// # Errors
    /// As [`Appender::append`].
    pub fn persist(&mut self) -> Result<(), JournalError> {
        self.order(Order::Sync(None))
    }

    fn order(&mut self, order: Order<T>) -> Result<(), JournalError> {
        let handed_over = self.writer.hand_over(order);
        handed_over.map_err(|problem| self.lost(problem))
    }

    fn lost(&self, problem: String) -> JournalError {
        let path = self.path.clone();
        JournalError::Write { path, problem }
    }
}

/// The thread's side. Dropped, also where an entry was at fault, it hands over the lines before that.
#[derive(Debug)]
struct Writer {
    file: File,
    /// Lines that the system does not have yet.
    buffer: Vec<u8>,
    line: u64,
    check: Check,
    /// When the oldest line that is not yet synced was written.
    unsynced_since: Option<Instant>,
    /// Who waits for the sync at hand; kept here so that a failure is told before they go on.
    waiting: Option<Sender<Infallible>>,
}

impl<T: Serialize + Send + 'static> Sink<Order<T>> for Writer {
    fn write(&mut self, order: Order<T>) -> io::Result<()> {
        match order {
            Order::Append(entry) => self.append(&entry),
            Order::Sync(done) => {
                self.waiting = done;
                self.sync()?;
                self.waiting = None;
                Ok(())
            }
        }
    }

    fn pause(&mut self) -> io::Result<()> {
        self.flush()?;
        self.sync_in_time()
    }

    fn close(&mut self) -> io::Result<()> {
        self.sync()
    }
}

impl Drop for Writer {
    fn drop(&mut self) {
        // Who waited has been told of the failure, if that is why.
        let _ = self.flush();
    }
}

impl Writer {
    fn append(&mut self, entry: &impl Serialize) -> io::Result<()> {
        let content = serde_json::to_vec(entry)?;
        let inner = content
            .strip_prefix(b"{")
            .ok_or_else(|| io::Error::other("an entry is no JSON object"))?;
        self.line += 1;
        let check = self.check.go_on(&content);
        write!(
            self.buffer,
            "{{\"line\":{},\"check\":\"{check:08x}\",",
            self.line
        )?;
        self.buffer.extend_from_slice(inner);
        self.buffer.push(b'\n');
        self.unsynced_since.get_or_insert_with(Instant::now);
        if self.buffer.len() >= BUFFER {
            self.flush()?;
        }
        self.sync_in_time()
    }

    /// Hands the lines to the system; what it does not take would fail again and is let go.
    fn flush(&mut self) -> io::Result<()> {
        let written = self.file.write_all(&self.buffer);
        self.buffer.clear();
        written
    }

    /// Syncs where lines have waited long enough.
    fn sync_in_time(&mut self) -> io::Result<()> {
        match self.unsynced_since {
            Some(since) if since.elapsed() >= SYNC_EVERY => self.sync(),
            _ => Ok(()),
        }
    }

    fn sync(&mut self) -> io::Result<()> {
        self.flush()?;
        if self.unsynced_since.take().is_some() {
            self.file.sync_data()?;
            // Writing to a file without a name succeeds, and leaves nothing.
            #[cfg(unix)]
            if std::os::unix::fs::MetadataExt::nlink(&self.file.metadata()?) == 0 {
                return Err(io::Error::other("somebody has removed it"));
            }
        }
        Ok(())
    }
}
