//! Reads a journal's lines back, and says what is wrong with one.

use serde_json::Value;

use super::{Check, OLDEST_SCHEMA, SCHEMA};

/// What is wrong with a line.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum LineProblem {
    /// The file begins like no journal.
    #[error("no header, so this is not a journal of this program")]
    Foreign,
    /// The journal is of a version that this program does not know.
    #[error(
        "the journal is of version {schema} and this program reads versions {OLDEST_SCHEMA} to {SCHEMA}: use the program version {program}"
    )]
    Schema {
        /// The journal's version.
        schema: u64,
        /// The program that wrote it.
        program: String,
    },
    /// Bytes that are no UTF-8.
    #[error("not text, so this is not a journal or it was damaged")]
    NoText,
    /// Number and check cannot be read.
    #[error("the line is damaged after it was recorded, so the recording cannot be checked")]
    Damaged,
    /// The number is not the next one.
    #[error(
        "the line says that it is line {says}: lines are missing or in another order after it was recorded, so the recording cannot be checked"
    )]
    OutOfOrder {
        /// The number in the line.
        says: String,
    },
    /// The content does not agree with its check.
    #[error("the line was changed after it was recorded, so the recording cannot be checked")]
    Changed,
}

/// A last line that a crash cut short; it is no part of the journal.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Torn {
    /// Its number.
    pub line: usize,
    /// How much of it there is.
    pub bytes: usize,
}

impl std::fmt::Display for Torn {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(
            f,
            "line {} is not complete ({} bytes): a crash cut it short, and it is set aside",
            self.line, self.bytes
        )
    }
}

/// The lines of a journal, one after another.
#[derive(Debug)]
pub struct Lines<'a> {
    rest: &'a [u8],
    number: usize,
    check: Check,
    schema: u32,
    torn: Option<Torn>,
}

impl<'a> Lines<'a> {
    /// The lines in a journal's bytes.
    pub fn new(bytes: &'a [u8]) -> Self {
        Self {
            rest: bytes,
            number: 0,
            check: Check::of_schema(SCHEMA),
            schema: SCHEMA,
            torn: None,
        }
    }

    /// The number of the line that was read last, from 1.
    pub fn number(&self) -> usize {
        self.number
    }

    /// Version of the journal, once its first line was read.
    pub fn schema(&self) -> u32 {
        self.schema
    }

    /// The last line, where it is not complete; known once [`Lines::next_content`] has given nothing.
    pub fn torn(&self) -> Option<Torn> {
        self.torn
    }

    /// The next line's content, a JSON object; `None` at the end or where the last line is torn.
    ///
    /// # Errors
    /// What is wrong with the line numbered [`Lines::number`].
    pub fn next_content(&mut self) -> Result<Option<String>, LineProblem> {
        if self.rest.is_empty() {
            return Ok(None);
        }
        self.number += 1;
        let Some(length) = self.rest.iter().position(|byte| *byte == b'\n') else {
            let bytes = self.rest.len();
            // A file of one line that is no journal at all deserves its own sentence.
            if self.number == 1 && !self.rest.starts_with(PREFIX.as_bytes()) {
                return Err(self.foreign_or(LineProblem::Damaged));
            }
            self.torn = Some(Torn {
                line: self.number,
                bytes,
            });
            self.rest = &[];
            return Ok(None);
        };
        let line = &self.rest[..length];
        self.rest = &self.rest[length + 1..];
        let line = std::str::from_utf8(line).map_err(|_| LineProblem::NoText)?;
        self.content(line).map(Some)
    }

    fn foreign_or(&self, problem: LineProblem) -> LineProblem {
        match (self.number, std::str::from_utf8(self.rest)) {
            (_, Err(_)) => LineProblem::NoText,
            (1, _) => LineProblem::Foreign,
            _ => problem,
        }
    }

    fn content(&mut self, line: &str) -> Result<String, LineProblem> {
        let is_first = self.number == 1;
        let Some((number, check, inner)) = split(line) else {
            return Err(if is_first {
                LineProblem::Foreign
            } else {
                LineProblem::Damaged
            });
        };
        let content = format!("{{{inner}");
        if is_first {
            self.schema = schema_of(&content)?;
            self.check = Check::of_schema(self.schema);
        }
        let expected = self.check.go_on(content.as_bytes());
        if number != self.number.to_string() {
            return Err(LineProblem::OutOfOrder {
                says: number.to_owned(),
            });
        }
        if check != format!("{expected:08x}") {
            return Err(LineProblem::Changed);
        }
        Ok(content)
    }
}

/// How every line begins.
const PREFIX: &str = "{\"line\":";

/// Line number, check, and the content without its opening brace.
fn split(line: &str) -> Option<(&str, &str, &str)> {
    let (number, rest) = line.strip_prefix(PREFIX)?.split_once(",\"check\":\"")?;
    let (check, inner) = rest.split_once("\",")?;
    Some((number, check, inner))
}

/// A journal of another version would fail with a riddle in some field: its version is looked at first.
fn schema_of(header: &str) -> Result<u32, LineProblem> {
    let value: Value = serde_json::from_str(header).map_err(|_| LineProblem::Foreign)?;
    let schema = value["header"]["schema"]
        .as_u64()
        .ok_or(LineProblem::Foreign)?;
    if (u64::from(OLDEST_SCHEMA)..=u64::from(SCHEMA)).contains(&schema) {
        return Ok(schema as u32);
    }
    let program = value["header"]["program"].as_str().unwrap_or("unknown");
    Err(LineProblem::Schema {
        schema,
        program: program.to_owned(),
    })
}
