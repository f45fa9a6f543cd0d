//! Appends to a journal from a thread of its own, so that no frame waits for a disk.

use std::convert::Infallible;
use std::fs::{File, OpenOptions};
use std::io::{BufWriter, Write};
use std::path::{Path, PathBuf};
use std::sync::mpsc::{Receiver, RecvTimeoutError, Sender, channel};
use std::sync::{Arc, OnceLock};
use std::thread::JoinHandle;
use std::time::{Duration, Instant};

use serde::Serialize;

use super::{Check, JournalError, SCHEMA};

/// A power cut loses at most this much; a crash of the program alone loses nothing that was appended.
const SYNC_EVERY: Duration = Duration::from_secs(1);

/// A journal being written; append-only.
///
/// Entries are handed to a thread that numbers, checks, writes and syncs them in their order; what is waiting there when
/// this is dropped is still written.
#[derive(Debug)]
pub struct Appender<T> {
    /// `None` once dropped.
    orders: Option<Sender<Order<T>>>,
    thread: Option<JoinHandle<()>>,
    failure: Arc<OnceLock<JournalError>>,
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
        let refuse = |error: std::io::Error| JournalError::Create {
            path: path.to_owned(),
            problem: error.to_string(),
        };
        let file = options.open(path).map_err(refuse)?;
        let failure = Arc::new(OnceLock::new());
        let (orders, received) = channel();
        let writer = Writer {
            file: BufWriter::new(file),
            path: path.to_owned(),
            line: 0,
            check: Check::of_schema(SCHEMA),
            unsynced_since: None,
            waiting: None,
            failure: Arc::clone(&failure),
        };
        let thread = std::thread::Builder::new()
            .name("journal".to_owned())
            .spawn(move || writer.run(&received))
            .map_err(refuse)?;
        Ok(Self {
            orders: Some(orders),
            thread: Some(thread),
            failure,
        })
    }

    /// Hands over an entry, which must serialise as a JSON object; takes a microsecond or less.
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
        // Nothing is ever sent: this ends when the thread lets go, after its failure, if any, can be read.
        let _ = wait.recv();
        self.failure()
    }

    /// Asks for the same without waiting for it.
    ///
    /// # Errors
    /// As [`Appender::append`].
    pub fn persist(&mut self) -> Result<(), JournalError> {
        self.order(Order::Sync(None))
    }

    fn order(&mut self, order: Order<T>) -> Result<(), JournalError> {
        self.failure()?;
        let orders = self
            .orders
            .as_ref()
            .expect("only dropping takes the channel");
        // A thread that has given up has left its failure, which the next order finds.
        let _ = orders.send(order);
        Ok(())
    }

    fn failure(&self) -> Result<(), JournalError> {
        self.failure.get().cloned().map_or(Ok(()), Err)
    }
}

impl<T> Drop for Appender<T> {
    fn drop(&mut self) {
        self.orders = None;
        if let Some(thread) = self.thread.take() {
            // A panic of the thread has been printed; nothing is left to do.
            let _ = thread.join();
        }
    }
}

/// The thread's side.
struct Writer {
    file: BufWriter<File>,
    path: PathBuf,
    line: u64,
    check: Check,
    /// When the oldest line that is not yet synced was written.
    unsynced_since: Option<Instant>,
    /// Who waits for the sync at hand; kept here so that a failure is told before they go on.
    waiting: Option<Sender<Infallible>>,
    failure: Arc<OnceLock<JournalError>>,
}

impl Writer {
    fn run<T: Serialize>(mut self, orders: &Receiver<Order<T>>) {
        if let Err(error) = self.obey(orders) {
            let failure = JournalError::Write {
                path: self.path.clone(),
                problem: error.to_string(),
            };
            // Set once: the thread ends here.
            let _ = self.failure.set(failure);
            // What is still buffered would fail again.
            let _ = self.file.into_parts();
        }
    }

    /// Writes until nobody can order any more. Lines go to the system whenever no further one waits.
    fn obey<T: Serialize>(&mut self, orders: &Receiver<Order<T>>) -> std::io::Result<()> {
        loop {
            let order = match orders.try_recv() {
                Ok(order) => order,
                Err(_) => {
                    self.file.flush()?;
                    match orders.recv_timeout(self.time_to_sync()) {
                        Ok(order) => order,
                        Err(RecvTimeoutError::Timeout) => {
                            self.sync()?;
                            continue;
                        }
                        Err(RecvTimeoutError::Disconnected) => return self.sync(),
                    }
                }
            };
            match order {
                Order::Append(entry) => self.append(&entry)?,
                Order::Sync(done) => {
                    self.waiting = done;
                    self.sync()?;
                    self.waiting = None;
                }
            }
            if self.time_to_sync().is_zero() {
                self.sync()?;
            }
        }
    }

    fn append(&mut self, entry: &impl Serialize) -> std::io::Result<()> {
        let content = serde_json::to_vec(entry)?;
        let inner = content
            .strip_prefix(b"{")
            .ok_or_else(|| std::io::Error::other("an entry is no JSON object"))?;
        self.line += 1;
        let check = self.check.go_on(&content);
        write!(
            self.file,
            "{{\"line\":{},\"check\":\"{check:08x}\",",
            self.line
        )?;
        self.file.write_all(inner)?;
        self.file.write_all(b"\n")?;
        self.unsynced_since.get_or_insert_with(Instant::now);
        Ok(())
    }

    fn sync(&mut self) -> std::io::Result<()> {
        self.file.flush()?;
        if self.unsynced_since.take().is_some() {
            let file = self.file.get_ref();
            file.sync_data()?;
            // Writing to a file without a name succeeds, and leaves nothing.
            #[cfg(unix)]
            if std::os::unix::fs::MetadataExt::nlink(&file.metadata()?) == 0 {
                return Err(std::io::Error::other("somebody has removed it"));
            }
        }
        Ok(())
    }

    /// Zero when lines have waited long enough.
    fn time_to_sync(&self) -> Duration {
        self.unsynced_since.map_or(SYNC_EVERY, |since| {
            SYNC_EVERY.saturating_sub(since.elapsed())
        })
    }
}
