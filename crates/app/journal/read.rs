//! Reads a journal back, and says in one sentence with file and line what is wrong with it.

use std::fs;
use std::path::Path;

use anyhow::{Context, Result, anyhow, bail};
use game::Input;

use super::{End, Entry, FIRST_CHECK, Header, SCHEMA, continue_check};

/// A whole journal.
#[derive(Debug)]
pub struct Recording {
    /// What the session was.
    pub header: Header,
    /// What the game consumed, frame by frame.
    pub inputs: Vec<Input>,
    /// What happened: the index of its input, and the event as recorded.
    pub events: Vec<(usize, serde_json::Value)>,
    /// How it ended.
    pub end: End,
}

/// Reads the journal at `path`.
///
/// # Errors
/// When it cannot be read, is no journal, is of another version, was cut short or was changed.
pub fn read(path: &Path) -> Result<Recording> {
    let bytes = fs::read(path).with_context(|| {
        format!(
            "cannot read {}: give the folder that `bowling play` printed at its end",
            path.display()
        )
    })?;
    let text = String::from_utf8(bytes).map_err(|error| {
        let line = error.as_bytes()[..error.utf8_error().valid_up_to()]
            .iter()
            .filter(|b| **b == b'\n')
            .count()
            + 1;
        anyhow!(
            "{} line {line}: not text, so this is not a journal or it was damaged",
            path.display()
        )
    })?;
    parse(&text).map_err(|(line, problem)| anyhow!("{} line {line}: {problem}", path.display()))
}

/// The line and what is wrong there.
type Problem = (usize, String);

fn parse(text: &str) -> Result<Recording, Problem> {
    let mut lines = Lines {
        text,
        number: 0,
        check: FIRST_CHECK,
    };
    let header = match lines.next_entry()? {
        Some(Entry::Header(header)) => *header,
        _ => {
            return Err((
                1,
                "no header, so this is not a journal of `bowling play`".to_owned(),
            ));
        }
    };
    let mut inputs = Vec::new();
    let mut events = Vec::new();
    while let Some(entry) = lines.next_entry()? {
        match entry {
            Entry::Header(_) => return Err((lines.number, "a second header".to_owned())),
            Entry::Input(line) => inputs.push(Input::from(&line)),
            Entry::Event(event) => match inputs.len().checked_sub(1) {
                Some(input) => events.push((input, event)),
                None => {
                    return Err((lines.number, "an event before the first input".to_owned()));
                }
            },
            Entry::Device(_) => {}
            Entry::End(end) => {
                if lines.next_entry()?.is_some() {
                    return Err((
                        lines.number,
                        "something follows the end of the session".to_owned(),
                    ));
                }
                return Ok(Recording {
                    header,
                    inputs,
                    events,
                    end,
                });
            }
        }
    }
    Err((
        lines.number,
        "the recording stops here, before its end: it was cut short and cannot be checked"
            .to_owned(),
    ))
}

struct Lines<'a> {
    text: &'a str,
    number: usize,
    check: u32,
}

impl Lines<'_> {
    fn next_entry(&mut self) -> Result<Option<Entry>, Problem> {
        if self.text.is_empty() {
            return Ok(None);
        }
        self.number += 1;
        let Some((line, rest)) = self.text.split_once('\n') else {
            let cut = "the line is not complete: the recording was cut short and cannot be checked";
            // A file of one line that is no journal at all deserves the other sentence.
            let foreign = self.number == 1 && split_line(self.text).is_none();
            return Err((
                self.number,
                if foreign {
                    no_journal()
                } else {
                    cut.to_owned()
                },
            ));
        };
        self.text = rest;
        self.entry(line)
            .map(Some)
            .map_err(|problem| (self.number, problem.to_string()))
    }

    fn entry(&mut self, line: &str) -> Result<Entry> {
        let Some((number, check, inner)) = split_line(line) else {
            bail!(if self.number == 1 {
                no_journal()
            } else {
                changed("is damaged")
            });
        };
        let content = format!("{{{inner}");
        let expected = continue_check(self.check, &content);
        self.check = expected;
        if self.number == 1 {
            check_schema(&content)?;
        }
        if number != self.number.to_string() {
            bail!(changed(&format!(
                "says that it is line {number}: lines are missing or in another order"
            )));
        }
        if check != format!("{expected:08x}") {
            bail!(changed("was changed"));
        }
        serde_json::from_str(&content).map_err(|error| anyhow!("cannot be understood ({error})"))
    }
}

fn no_journal() -> String {
    "no header, so this is not a journal of `bowling play`".to_owned()
}

fn changed(how: &str) -> String {
    format!("the line {how} after it was recorded, so the recording cannot be checked")
}

/// A journal of another schema would fail with a riddle in some field: name the version instead.
fn check_schema(content: &str) -> Result<()> {
    let value: serde_json::Value =
        serde_json::from_str(content).map_err(|_| anyhow!(no_journal()))?;
    match value["header"]["schema"].as_u64() {
        None => bail!(no_journal()),
        Some(schema) if schema == u64::from(SCHEMA) => Ok(()),
        Some(schema) => bail!(
            "the journal is of version {schema} and this program reads version {SCHEMA}: use the program version {}",
            value["header"]["program"]
        ),
    }
}

/// Line number, check, and the content without its opening brace.
fn split_line(line: &str) -> Option<(&str, &str, &str)> {
    let (number, rest) = line
        .strip_prefix("{\"line\":")?
        .split_once(",\"check\":\"")?;
    let (check, inner) = rest.split_once("\",")?;
    Some((number, check, inner))
}
