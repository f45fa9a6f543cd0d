//! Rows of a table, written by a thread of their own, so that no frame waits for a disk.

use std::io::{self, Write};
use std::sync::mpsc::{Sender, channel};
use std::sync::{Arc, OnceLock};
use std::thread::JoinHandle;

/// A table being written. Rows go to the writer in their order; what is waiting when this is dropped is still written.
#[derive(Debug)]
pub struct Rows<W> {
    /// `None` once closed.
    rows: Option<Sender<String>>,
    /// Gives the writer back.
    thread: Option<JoinHandle<W>>,
    /// Why nothing more is written.
    failure: Arc<OnceLock<String>>,
}

impl<W: Write + Send + 'static> Rows<W> {
    /// Begins behind what the writer has already.
    ///
    /// # Errors
    /// When the system has no thread left.
    pub fn begin(mut writer: W) -> io::Result<Self> {
        let (rows, received) = channel::<String>();
        let failure = Arc::new(OnceLock::new());
        let told = Arc::clone(&failure);
        let write = move || {
            for row in received {
                if let Err(error) = writeln!(writer, "{row}") {
                    // Set once: the thread ends here.
                    let _ = told.set(error.to_string());
                    break;
                }
            }
            writer
        };
        let thread = std::thread::Builder::new()
            .name("rows".to_owned())
            .spawn(write)?;
        Ok(Self {
            rows: Some(rows),
            thread: Some(thread),
            failure,
        })
    }

    /// Hands over a row, without the end of its line.
    ///
    /// # Errors
    /// When an earlier one could not be written.
    pub fn push(&mut self, row: String) -> io::Result<()> {
        self.failure()?;
        if let Some(rows) = &self.rows {
            // A thread that has given up has left its failure, which the next row finds.
            let _ = rows.send(row);
        }
        Ok(())
    }

    /// Waits until all rows are written, and gives the writer back.
    ///
    /// # Errors
    /// When one could not be written.
    pub fn close(mut self) -> io::Result<W> {
        let writer = self.join();
        self.failure()?;
        writer.ok_or_else(|| io::Error::other("the thread that writes them has ended by a fault"))
    }

    fn failure(&self) -> io::Result<()> {
        let failure = self.failure.get().cloned();
        failure.map_or(Ok(()), |why| Err(io::Error::other(why)))
    }
}

impl<W> Rows<W> {
    /// The writer, when all that was waiting is written; a panic of the thread has been printed.
    fn join(&mut self) -> Option<W> {
        self.rows = None;
        self.thread.take()?.join().ok()
    }
}

impl<W> Drop for Rows<W> {
    fn drop(&mut self) {
        self.join();
    }
}

#[cfg(test)]
mod tests {
    use std::io::{BufWriter, Read};
    use std::time::Duration;

    use super::*;

    /// A pipe that nobody reads takes 64 KiB and then holds up who writes, as a disk does that has no time.
    #[test]
    fn who_hands_over_rows_is_not_held_up_by_who_takes_them() {
        const ROWS: usize = 20_000;
        let (mut slow, writer) = io::pipe().expect("a pipe");
        let (sender, handed_over) = channel();
        let frames = std::thread::spawn(move || {
            let mut rows = Rows::begin(BufWriter::new(writer)).expect("a thread");
            for number in 0..ROWS {
                rows.push(format!("{number:0100}")).expect("none failed");
            }
            sender.send(()).expect("somebody waits");
            rows.close().map(drop).expect("all are written");
        });
        let waited = handed_over.recv_timeout(Duration::from_secs(20));
        waited.expect("two megabytes are handed over while nobody reads");
        let mut written = String::new();
        slow.read_to_string(&mut written).expect("text");
        frames.join().expect("no panic");
        let numbers = written.lines().map(|row| row.parse::<usize>());
        assert!(numbers.eq((0..ROWS).map(Ok)), "in their order, all of them");
    }

    #[test]
    fn rows_that_cannot_be_written_are_reported_to_who_comes_next() {
        let (reader, writer) = io::pipe().expect("a pipe");
        drop(reader);
        let mut rows = Rows::begin(writer).expect("a thread");
        rows.push("lost".to_owned()).expect("not yet known");
        rows.join();
        let error = rows.push("next".to_owned()).expect_err("one is lost");
        assert!(error.to_string().contains("pipe"), "{error}");
        assert!(rows.close().is_err());
    }
}
