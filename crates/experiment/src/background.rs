//! Writes in the background, so that no frame waits for a disk.

use std::io;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::mpsc::{Receiver, Sender, TryRecvError, channel};
use std::sync::{Arc, OnceLock};
use std::thread::{self, JoinHandle};
use std::time::Duration;

/// The thread looks this often for what was handed over. Nobody wakes it for that: a wake-up takes the thread that hands over
/// ten microseconds, and a hundred now and then (docs/frame.md).
const LOOK_EVERY: Duration = Duration::from_millis(2);

/// What is said of a thread that panicked.
const FAULT: &str = "the thread that writes it has ended by a fault of the program";

/// What writes.
pub trait Sink<T>: Send + 'static {
    /// Writes one item.
    ///
    /// # Errors
    /// What the system says; nothing is written any more then.
    fn write(&mut self, item: T) -> io::Result<()>;

    /// Nothing waits at the moment; called again and again until something does.
    ///
    /// # Errors
    /// As [`Sink::write`].
    fn pause(&mut self) -> io::Result<()> {
        Ok(())
    }

    /// Nothing comes any more.
    ///
    /// # Errors
    /// As [`Sink::write`].
    fn close(&mut self) -> io::Result<()> {
        Ok(())
    }
}

/// A sink with a thread of its own. Items reach it in their order; what is waiting when this is dropped is still written.
#[derive(Debug)]
pub struct BackgroundWriter<T, S> {
    /// `None` once closed.
    items: Option<Sender<T>>,
    /// Gives the sink back, unless it failed.
    thread: Option<JoinHandle<Option<S>>>,
    /// Why nothing more is written.
    failure: Arc<OnceLock<String>>,
}

impl<T: Send + 'static, S: Sink<T>> BackgroundWriter<T, S> {
    /// Starts the thread, which shows as `name` where the system lists threads.
    ///
    /// # Errors
    /// When the system has no thread left.
    pub fn begin(name: &str, mut sink: S) -> io::Result<Self> {
        let (items, received) = channel();
        let failure = Arc::new(OnceLock::new());
        let told = Arc::clone(&failure);
        let write = move || {
            let drained = catch_unwind(AssertUnwindSafe(|| drain(&received, &mut sink)));
            let problem = match drained {
                Ok(Ok(())) => return Some(sink),
                Ok(Err(error)) => error.to_string(),
                // Its message has been printed.
                Err(_) => FAULT.to_owned(),
            };
            // Set once, and before channel and sink let go of who waits for them: the thread ends here.
            let _ = told.set(problem);
            None
        };
        let thread = thread::Builder::new().name(name.to_owned()).spawn(write)?;
        Ok(Self {
            items: Some(items),
            thread: Some(thread),
            failure,
        })
    }

    /// Hands over an item, in a microsecond or two.
    ///
    /// # Errors
    /// Why an earlier one could not be written.
    pub fn hand_over(&mut self, item: T) -> Result<(), String> {
        self.failure()?;
        if let Some(items) = &self.items {
            // A thread that has given up has left its failure, which the next item finds.
            let _ = items.send(item);
        }
        Ok(())
    }

    /// Waits until all items are written, and gives the sink back.
    ///
    /// # Errors
    /// Why one could not be written.
    pub fn close(mut self) -> Result<S, String> {
        let sink = self.join();
        self.failure()?;
        sink.ok_or_else(|| FAULT.to_owned())
    }

    /// Why nothing more is written.
    ///
    /// # Errors
    /// The reason, where there is one.
    pub fn failure(&self) -> Result<(), String> {
        self.failure.get().cloned().map_or(Ok(()), Err)
    }
}

impl<T, S> BackgroundWriter<T, S> {
    /// Has the thread look now.
    pub fn hurry(&self) {
        if let Some(thread) = &self.thread {
            thread.thread().unpark();
        }
    }

    /// The sink, when all that was waiting is written.
    fn join(&mut self) -> Option<S> {
        self.items = None;
        self.hurry();
        self.thread.take()?.join().ok()?
    }
}

impl<T, S> Drop for BackgroundWriter<T, S> {
    fn drop(&mut self) {
        self.join();
    }
}

/// Writes until nobody can hand anything over any more.
fn drain<T>(items: &Receiver<T>, sink: &mut impl Sink<T>) -> io::Result<()> {
    loop {
        match items.try_recv() {
            Ok(item) => sink.write(item)?,
            Err(TryRecvError::Empty) => {
                sink.pause()?;
                thread::park_timeout(LOOK_EVERY);
            }
            Err(TryRecvError::Disconnected) => return sink.close(),
        }
    }
}

#[cfg(test)]
mod tests {
    use std::io::{BufRead, BufReader, PipeWriter, Read, Write};

    use super::*;

    impl Sink<String> for PipeWriter {
        fn write(&mut self, item: String) -> io::Result<()> {
            writeln!(self, "{item}")
        }
    }

    /// A pipe that nobody reads takes 64 KiB and then holds up who writes, as a disk does that has no time.
    #[test]
    fn who_hands_over_is_not_held_up_by_who_writes() {
        const ITEMS: usize = 20_000;
        let (mut slow, pipe) = io::pipe().unwrap();
        let (sender, handed_over) = channel();
        let frames = thread::spawn(move || {
            let mut writer = BackgroundWriter::begin("test", pipe).unwrap();
            for number in 0..ITEMS {
                writer.hand_over(format!("{number:0100}")).unwrap();
            }
            sender.send(()).unwrap();
            writer.close().map(drop).unwrap();
        });
        let waited = handed_over.recv_timeout(Duration::from_secs(20));
        waited.expect("two megabytes are handed over while nobody reads");
        let mut written = String::new();
        slow.read_to_string(&mut written).unwrap();
        frames.join().unwrap();
        let numbers = written.lines().map(str::parse::<usize>);
        assert!(
            numbers.eq((0..ITEMS).map(Ok)),
            "in their order, all of them"
        );
    }

    #[test]
    fn an_item_is_written_though_none_follows() {
        let (written, pipe) = io::pipe().unwrap();
        let (sender, lines) = channel();
        thread::spawn(move || {
            let lines = BufReader::new(written).lines();
            lines.for_each(|line| sender.send(line.unwrap()).unwrap());
        });
        let mut writer = BackgroundWriter::begin("test", pipe).unwrap();
        for item in ["one", "two"] {
            writer.hand_over(item.to_owned()).unwrap();
            let line = lines.recv_timeout(Duration::from_secs(20));
            assert_eq!(line.as_deref(), Ok(item));
        }
    }

    #[test]
    fn what_cannot_be_written_is_reported_to_who_comes_next() {
        let (reader, pipe) = io::pipe().unwrap();
        drop(reader);
        let mut writer = BackgroundWriter::begin("test", pipe).unwrap();
        writer.hand_over("lost".to_owned()).unwrap();
        assert!(writer.join().is_none(), "a sink that failed is let go");
        let error = writer.hand_over("next".to_owned()).unwrap_err();
        assert!(error.contains("pipe"), "{error}");
        assert!(writer.close().is_err());
    }
}
