use std::ffi::OsStr;
use std::fs::File;
use std::io::{BufRead, BufReader, Read};
use std::path::{Path, PathBuf};
use std::process::{ExitStatus, Stdio};
use std::sync::{Arc, Condvar, Mutex, MutexGuard};
use std::thread::JoinHandle;
use std::time::{Duration, Instant};

use rustix::process::Signal;

use super::service::Service;
use super::validation::Layers;
use crate::shared::ask_until;
use crate::shared::process::Process;

/// Longest wait for the program's end.
const PATIENCE: Duration = Duration::from_secs(60);

/// A line that the program printed.
struct Line {
    stream: Stream,
    text: String,
}

#[derive(Clone, Copy, PartialEq, Eq)]
enum Stream {
    Output,
    Errors,
}

#[derive(Default)]
struct Said {
    lines: Vec<Line>,
    /// Streams that have ended, of two.
    ended: usize,
}

impl Said {
    /// All lines, in the order in which they came.
    fn text(&self) -> String {
        let lines = self.lines.iter().map(|line| line.text.as_str());
        lines.collect::<Vec<_>>().join("\n")
    }
}

/// What the program prints, and a bell that rings at every line and at a stream's end.
#[derive(Default)]
struct Output {
    said: Mutex<Said>,
    news: Condvar,
}

impl Output {
    fn said(&self) -> MutexGuard<'_, Said> {
        self.said.lock().expect("nobody panics with the lock")
    }

    fn collect(
        self: Arc<Self>,
        stream: Stream,
        pipe: impl Read + Send + 'static,
    ) -> JoinHandle<()> {
        std::thread::spawn(move || {
            for bytes in BufReader::new(pipe).split(b'\n') {
                // A pipe that cannot be read is one that has ended.
                let Ok(bytes) = bytes else { break };
                let text = String::from_utf8_lossy(&bytes).into_owned();
                self.said().lines.push(Line { stream, text });
                self.news.notify_all();
            }
            self.said().ended += 1;
            self.news.notify_all();
        })
    }
}

/// The program as a client of the runtime, under the validation layers; killed when the test ends.
pub struct Client {
    process: Process,
    output: Arc<Output>,
    readers: Vec<JoinHandle<()>>,
    layers: Layers,
    /// From which line on [`Self::wait_for`] looks at output and errors.
    unread: [usize; 2],
}

impl Client {
    /// Starts the program with `arguments` against `service`, without a desktop.
    ///
    /// # Panics
    /// When it cannot be started.
    pub fn start(service: &Service, arguments: &[&str]) -> Self {
        Self::start_in(service, arguments, &[])
    }

    /// As [`Self::start`], with these variables in its environment: a display, say.
    ///
    /// # Panics
    /// When it cannot be started.
    pub fn start_in(service: &Service, arguments: &[&str], environment: &[(&str, &OsStr)]) -> Self {
        Self::start_told(service, arguments, environment, Stdio::null())
    }

    /// As [`Self::start_in`], with what is typed at its terminal.
    ///
    /// # Panics
    /// When it cannot be started.
    pub fn start_told(
        service: &Service,
        arguments: &[&str],
        environment: &[(&str, &OsStr)],
        typed: Stdio,
    ) -> Self {
        let layers = Layers::new();
        let mut command = service.client_command(Path::new(env!("CARGO_BIN_EXE_bowling")));
        command
            .args(arguments)
            // The dynamic loader is what the system takes for the program: nothing is found beside it.
            .env("BOWLING_ROOT", env!("CARGO_MANIFEST_DIR"))
            .envs(layers.environment())
            .envs(environment.iter().copied())
            .stdin(typed)
            .stdout(Stdio::piped())
            .stderr(Stdio::piped());
        let mut process = Process::start("bowling", &mut command);
        let output = Arc::new(Output::default());
        let child = process.child();
        let stdout = child.stdout.take().expect("piped");
        let stderr = child.stderr.take().expect("piped");
        let readers = vec![
            Arc::clone(&output).collect(Stream::Output, stdout),
            Arc::clone(&output).collect(Stream::Errors, stderr),
        ];
        Self {
            process,
            output,
            readers,
            layers,
            unread: [0; 2],
        }
    }

    /// The next line that contains `part`: after the last one that this returned from the same stream, since the order
    /// between the two is chance.
    ///
    /// # Panics
    /// When there is none after `limit`, or when the program ends without it.
    pub fn wait_for(&mut self, part: &str, limit: Duration) -> String {
        let begun = Instant::now();
        let mut said = self.output.said();
        loop {
            let found = said.lines.iter().enumerate().find(|(index, line)| {
                *index >= self.unread[line.stream as usize] && line.text.contains(part)
            });
            if let Some((index, line)) = found {
                self.unread[line.stream as usize] = index + 1;
                return line.text.clone();
            }
            let left = limit.saturating_sub(begun.elapsed());
            if said.ended == 2 || left.is_zero() {
                // The readers go on, and what was printed is shown when this is dropped: both need the lock.
                drop(said);
                panic!("the program did not say {part:?} before its end or within {limit:?}");
            }
            let woken = self.output.news.wait_timeout(said, left);
            said = woken.expect("nobody panics with the lock").0;
        }
    }

    /// All that it has printed so far.
    pub fn output(&self) -> String {
        self.output.said().text()
    }

    /// Whether OpenXR's validation layer watches it.
    pub fn is_watched(&self) -> bool {
        self.layers.have_begun()
    }

    /// Its process number.
    pub fn id(&mut self) -> u32 {
        self.process.id()
    }

    /// How it ended; none while it runs.
    pub fn ended(&mut self) -> Option<ExitStatus> {
        self.process.ended()
    }

    /// Asks it to end, if it has not ended by itself: how it ended, and all that it printed.
    ///
    /// # Panics
    /// When it does not end.
    pub fn finish(mut self) -> (ExitStatus, String) {
        self.process.signal(Signal::TERM);
        self.wait()
    }

    /// Waits for its own end: how it ended, and all that it printed.
    ///
    /// # Panics
    /// When it does not end, or when the validation layers found something wrong.
    pub fn wait(mut self) -> (ExitStatus, String) {
        let ended = self.process.ended_within(PATIENCE);
        let ended = ended.expect("the program ends when it is asked to");
        for reader in std::mem::take(&mut self.readers) {
            reader.join().expect("no reader panics");
        }
        let output = self.output();
        assert_eq!(self.layers.complaints(&output), Vec::<String>::new());
        (ended, output)
    }
}

impl Drop for Client {
    fn drop(&mut self) {
        if std::thread::panicking() {
            let said = self.output();
            eprintln!(
                "the program said:\n{said}\n{:?}",
                self.layers.complaints(&said)
            );
        }
    }
}

/// Lines of a journal while the program writes it.
pub struct JournalLines {
    path: PathBuf,
    file: BufReader<File>,
    line: Vec<u8>,
}

/// The lines of the journal in a recording's `folder`, from the first one on.
///
/// # Panics
/// When there is no journal after `limit`.
pub fn journal_lines(folder: &Path, limit: Duration) -> JournalLines {
    journal_file(&folder.join("journal.jsonl"), limit)
}

/// The lines of the journal `path`.
///
/// # Panics
/// When there is none after `limit`.
pub fn journal_file(path: &Path, limit: Duration) -> JournalLines {
    let file = ask_until(limit, || File::open(path).ok())
        .unwrap_or_else(|| panic!("no {} within {limit:?}", path.display()));
    JournalLines {
        path: path.to_owned(),
        file: BufReader::new(file),
        line: Vec::new(),
    }
}

impl JournalLines {
    /// The next line, without its end, as soon as all of it is written; none when that takes longer than `limit`.
    pub fn next_within(&mut self, limit: Duration) -> Option<String> {
        ask_until(limit, || {
            // Half a line stays, and is read on.
            self.file
                .read_until(b'\n', &mut self.line)
                .unwrap_or_else(|error| panic!("{}: {error}", self.path.display()));
            let line = self.line.strip_suffix(b"\n")?;
            let line = String::from_utf8(line.to_vec()).expect("a journal is text");
            self.line.clear();
            Some(line)
        })
    }

    /// The next line that contains `part`.
    ///
    /// # Panics
    /// When there is none after `limit`.
    pub fn wait_for(&mut self, part: &str, limit: Duration) -> String {
        let begun = Instant::now();
        loop {
            let line = self.next_within(limit.saturating_sub(begun.elapsed()));
            let line = line.unwrap_or_else(|| {
                panic!("{} has no {part:?} within {limit:?}", self.path.display());
            });
            if line.contains(part) {
                return line;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use std::fs::OpenOptions;
    use std::io::Write;

    use super::*;
    use crate::machine::runtime;
    use crate::service::Compositor;

    const BRIEF: Duration = Duration::from_secs(20);

    #[test]
    fn the_program_plays_with_the_runtimes_libraries_until_it_is_asked_to_end() {
        let Some(runtime) = runtime() else { return };
        let service = Service::start(&runtime, Compositor::Null);
        let folder = tempfile::tempdir().expect("a temporary folder");
        let out = folder.path().join("out");
        let out_argument = out.to_str().expect("a temporary folder's name is text");
        let arguments = [
            "play",
            "--device",
            "script",
            "--no-video",
            "--out",
            out_argument,
        ];
        let mut client = Client::start(&service, &arguments);
        let mut journal = journal_lines(&out, BRIEF);
        journal.wait_for("header", BRIEF);
        let mapped = std::fs::read_to_string(format!("/proc/{}/maps", client.id()));
        let libraries = runtime.display().to_string();
        assert!(mapped.is_ok_and(|mapped| mapped.contains(&libraries)));
        client.wait_for("frame 1", BRIEF);
        assert!(client.ended().is_none(), "{}", client.output());
        let (status, output) = client.finish();
        assert!(status.success(), "{status}\n{output}");
        assert!(output.contains("Interrupted"), "{output}");
    }

    #[test]
    fn journal_lines_come_whole_and_in_order() {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let mut journal = OpenOptions::new()
            .create(true)
            .append(true)
            .open(folder.path().join("journal.jsonl"))
            .expect("a fresh folder");
        let mut lines = journal_lines(folder.path(), BRIEF);
        journal.write_all(b"one\nhal").expect("writable");
        assert_eq!(lines.next_within(BRIEF).as_deref(), Some("one"));
        assert_eq!(lines.next_within(Duration::ZERO), None, "half a line");
        journal.write_all(b"f\nthree\n").expect("writable");
        assert_eq!(lines.next_within(BRIEF).as_deref(), Some("half"));
        assert_eq!(lines.wait_for("thr", BRIEF), "three");
    }
}
