//! `bowling query`: the detection for anyone who wants to compare, JSON lines in, JSON lines out.
//!
//! Every line is answered in its place, a bad one with the reason, so that line n of the output belongs to line n of
//! the input. What has been read is answered before more is waited for, so that a program can talk to it over pipes.

mod answer;
mod obj;
mod parse;

use std::fs::File;
use std::hint::black_box;
use std::io::{self, BufRead, BufReader, IsTerminal, Read, Write};
use std::path::Path;
use std::time::Instant;

use anyhow::{Context, Result, bail};
use physics::query::Limits;
use serde_json::Value;

use crate::args::{QueryArguments, Question};
use answer::answer;
use parse::{Parser, Placed};

/// Answers are handed over at the latest when they are this long [bytes].
const HELD_BACK: usize = 1 << 16;
/// A measured turn lasts at least this long [s], so that the clock's own step does not show.
const TURN: f64 = 1e-3;
/// Turns end after this time [s], but not before the fifth, or after this many.
const PATIENCE: f64 = 2.0;
const TURNS: usize = 101;

/// Answers all queries of the file, or of standard input.
///
/// # Errors
/// When the file cannot be read, the output cannot be written, or a line could not be answered.
pub fn query(arguments: &QueryArguments) -> Result<()> {
    let limits = Limits {
        iteration_cap: arguments.cap,
        tolerance: arguments.tolerance,
        ..Limits::default()
    };
    let (name, input) = open(arguments.file.as_deref())?;
    let mut desk = Desk {
        question: arguments.question,
        limits,
        parser: Parser::default(),
        asked: Vec::new(),
        keep: arguments.time,
        lines: 0,
        bad: 0,
        first_bad: 0,
    };
    match desk.answer_all(BufReader::new(input), &mut io::stdout().lock()) {
        Ok(()) => {}
        Err(Failure::Output(error)) => return Err(error).context("the answers cannot be written"),
        Err(Failure::Input(error)) => return Err(error).context(format!("{name} cannot be read")),
    }
    if arguments.time {
        eprintln!("{}", desk.time());
    }
    if desk.bad > 0 {
        bail!(
            "{} of {} lines could not be answered, the first is line {}",
            desk.bad,
            desk.lines,
            desk.first_bad
        );
    }
    Ok(())
}

/// What is read, and its name in sentences.
fn open(file: Option<&Path>) -> Result<(String, Box<dyn Read>)> {
    match file {
        Some(path) if path != Path::new("-") => {
            let name = path.display().to_string();
            let file = File::open(path).with_context(|| format!("{name} cannot be read"))?;
            Ok((name, Box::new(file)))
        }
        _ => {
            if io::stdin().is_terminal() {
                eprintln!(
                    "Reading queries from the terminal, one JSON object a line; Ctrl-D ends."
                );
            }
            Ok(("standard input".to_owned(), Box::new(io::stdin())))
        }
    }
}

/// Which side of the conversation broke off.
enum Failure {
    Input(io::Error),
    Output(io::Error),
}

/// Where lines are handed in and answers out.
struct Desk {
    question: Question,
    limits: Limits,
    parser: Parser,
    /// The queries so far, if they are to be timed.
    asked: Vec<(Placed, Placed)>,
    keep: bool,
    lines: usize,
    bad: usize,
    first_bad: usize,
}

impl Desk {
    fn answer_all(
        &mut self,
        mut input: BufReader<impl Read>,
        output: &mut impl Write,
    ) -> Result<(), Failure> {
        let (mut line, mut answers) = (Vec::new(), Vec::new());
        loop {
            // Whole lines only, so that an interrupted run ends with one; and nothing is held back from whoever
            // waits for it before asking on.
            let more_is_here = input.buffer().contains(&b'\n');
            if !more_is_here || answers.len() >= HELD_BACK {
                output
                    .write_all(&answers)
                    .and_then(|()| output.flush())
                    .map_err(Failure::Output)?;
                answers.clear();
            }
            line.clear();
            if input.read_until(b'\n', &mut line).map_err(Failure::Input)? == 0 {
                return Ok(());
            }
            writeln!(answers, "{}", self.answer(&line)).map_err(Failure::Output)?;
        }
    }

    /// The answer to one line, or what is wrong with it.
    fn answer(&mut self, line: &[u8]) -> String {
        self.lines += 1;
        let text = self.parser.query(line).and_then(|query| {
            let answer = answer(&query, self.question, self.limits);
            if !answer.is_finite() {
                return Err("sizes or positions are too large for an answer in numbers".to_owned());
            }
            if self.keep {
                self.asked.push(query);
            }
            Ok(answer.to_string())
        });
        text.unwrap_or_else(|reason| {
            if self.bad == 0 {
                self.first_bad = self.lines;
            }
            self.bad += 1;
            format!(
                r#"{{"line":{},"error":{}}}"#,
                self.lines,
                Value::from(reason)
            )
        })
    }

    /// Asks all queries again and again and says what one of them takes.
    fn time(&self) -> String {
        if self.asked.is_empty() {
            return "no query to time".to_owned();
        }
        let pass = || {
            for query in &self.asked {
                black_box(answer(black_box(query), self.question, self.limits));
            }
        };
        let (started, mut turns) = (Instant::now(), Vec::new());
        let mut passes = 0;
        while turns.len() < 5 || (turns.len() < TURNS && started.elapsed().as_secs_f64() < PATIENCE)
        {
            let (turn, mut count) = (Instant::now(), 0);
            while count == 0 || turn.elapsed().as_secs_f64() < TURN {
                pass();
                count += 1;
            }
            turns.push(turn.elapsed().as_secs_f64() * 1e9 / f64::from(count));
            passes += count;
        }
        turns.sort_by(f64::total_cmp);
        let each = turns[turns.len() / 2] / self.asked.len() as f64;
        format!(
            "{each:.1} ns per query, median of {passes} passes through {}",
            self.asked.len()
        )
    }
}
