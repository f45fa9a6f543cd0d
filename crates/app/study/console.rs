//! The experimenter's terminal: says what is due, takes answers, remarks and the stop. It never names a condition.
//!
//! Lines are read by a thread of their own, so that no frame waits for a keyboard.

use std::io::BufRead;
use std::sync::mpsc::{Receiver, channel};

use anyhow::{Context, Result};
use experiment::protocol::{AnsweredIn, Place, Who};
use experiment::questionnaire::{Act, Answer, Item, Kind, SCALE_STEPS};

use crate::session::Session;

const HELP: &str = "\
Type an answer and Enter; Enter alone skips, `back` goes back. At any time:
  /note WORDS    keep a remark
  /stop REASON   end the session at once
  /status        where the session is";

/// A terminal that attends to a session.
#[derive(Debug)]
pub struct Console {
    lines: Receiver<String>,
    /// What was said last, so that it is said once.
    said: String,
}

impl Console {
    /// Listens to the standard input.
    ///
    /// # Errors
    /// When the system has no thread left.
    pub fn open() -> Result<Self> {
        let (sender, lines) = channel();
        std::thread::Builder::new()
            .name("console".to_owned())
            .spawn(move || {
                for line in std::io::stdin().lock().lines() {
                    // Nobody listens any more, or the input is no text: either ends the reading.
                    if line.map(|line| sender.send(line)).is_err() {
                        return;
                    }
                }
            })
            .context("cannot listen to the terminal")?;
        println!("{HELP}");
        Ok(Self {
            lines,
            said: String::new(),
        })
    }

    /// Says what is due, once, and takes the lines that were typed.
    ///
    /// # Errors
    /// When the journal cannot be written.
    pub fn attend(&mut self, session: &mut Session) -> Result<()> {
        self.say(session);
        while let Ok(line) = self.lines.try_recv() {
            take(line.trim(), session)?;
            self.said.clear();
            self.say(session);
        }
        Ok(())
    }

    fn say(&mut self, session: &Session) {
        let due = due(session);
        if due != self.said {
            println!("{due}");
            self.said = due;
        }
    }
}

/// What is due, in words.
fn due(session: &Session) -> String {
    let Some(course) = session.course() else {
        return String::new();
    };
    if let Some(form) = session.form()
        && let Some(item) = form.current()
    {
        let (number, count) = form.position();
        return format!("[{number}/{count}] {}", question(item));
    }
    match course.protocol().place() {
        Place::Debriefing => format!("{}; Enter when done", course.protocol().next_step()),
        _ => course.protocol().next_step(),
    }
}

/// An item as it is asked.
fn question(item: &Item) -> String {
    let answers = match &item.kind {
        Kind::Scale { low, high } => format!("1 = {low} ... {SCALE_STEPS} = {high}"),
        Kind::YesNo => "yes or no".to_owned(),
        Kind::Choice {
            options,
            several,
            other,
        } => {
            let mut text = if *several {
                "one or more of:".to_owned()
            } else {
                "one of:".to_owned()
            };
            for (number, option) in (1..).zip(options) {
                text += &format!("\n  {number}  {}", option.text);
            }
            if *other {
                text += "\n  or words of your own";
            }
            text
        }
        Kind::Text => "in your own words".to_owned(),
    };
    format!("{}\n  {answers}", item.text)
}

/// Does what a line says; what cannot be understood is said and changes nothing.
fn take(line: &str, session: &mut Session) -> Result<()> {
    let (command, words) = line.split_once(' ').unwrap_or((line, ""));
    match command {
        "/note" => session.remark(words.trim().to_owned()),
        "/stop" => session.stop(Who::Experimenter, words.trim().to_owned()),
        "/status" => Ok(()),
        _ if command.starts_with('/') => {
            println!("{HELP}");
            Ok(())
        }
        _ => answer(line, session),
    }
}

fn answer(line: &str, session: &mut Session) -> Result<()> {
    let Some(item) = session.form().and_then(|form| form.current()).cloned() else {
        let place = session.course().map(|course| course.protocol().place());
        if place == Some(Place::Debriefing) {
            return session.debriefed();
        }
        return Ok(());
    };
    let Some(act) = understood(line, &item) else {
        println!("That is no answer to this question.");
        return Ok(());
    };
    let is_high = matches!(&act, Act::Answer(Answer::Scale(step))
        if item.id.starts_with("sick") && session.course().is_some_and(|course| *step >= course.sickness_stop()));
    if let Err(error) = session.answer(act, AnsweredIn::Desk) {
        // The question stays; only a journal that cannot be written ends the session.
        if error.is::<experiment::questionnaire::AnswerError>() {
            println!("{error}.");
            return Ok(());
        }
        return Err(error);
    }
    if is_high {
        println!(
            "The participant feels unwell: the plan advises to end here. /stop REASON ends the session."
        );
    }
    Ok(())
}

/// The act that a line means for an item.
fn understood(line: &str, item: &Item) -> Option<Act> {
    match line {
        "" => return Some(Act::Skip),
        "back" => return Some(Act::Back),
        _ => {}
    }
    let answer = match &item.kind {
        Kind::Scale { .. } => Answer::Scale(line.parse().ok()?),
        Kind::YesNo => match line.to_lowercase().as_str() {
            "y" | "yes" => Answer::YesNo(true),
            "n" | "no" => Answer::YesNo(false),
            _ => return None,
        },
        Kind::Choice { options, other, .. } => {
            let picked: Option<Vec<String>> = line
                .split([',', ' '])
                .filter(|piece| !piece.is_empty())
                .map(|piece| {
                    let number: usize = piece.parse().ok()?;
                    Some(options.get(number.checked_sub(1)?)?.id.clone())
                })
                .collect();
            match picked {
                Some(chosen) => Answer::Choice {
                    chosen,
                    other: String::new(),
                },
                None if *other => Answer::Choice {
                    chosen: Vec::new(),
                    other: line.to_owned(),
                },
                None => return None,
            }
        }
        Kind::Text => Answer::Text(line.to_owned()),
    };
    Some(Act::Answer(answer))
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::path::Path;

    use experiment::questionnaire::Questionnaire;

    fn item(id: &str) -> Item {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("config/questionnaire.toml");
        let questionnaire = Questionnaire::read(&path).unwrap();
        questionnaire.item(id).unwrap().clone()
    }

    #[test]
    fn lines_are_understood_as_the_item_takes_them() {
        let scale = item("q1");
        assert_eq!(understood("6", &scale), Some(Act::Answer(Answer::Scale(6))));
        assert_eq!(understood("six", &scale), None);
        assert_eq!(understood("", &scale), Some(Act::Skip));
        assert_eq!(understood("back", &scale), Some(Act::Back));
        let age = item("age_band");
        let second = Answer::Choice {
            chosen: vec!["25-34".to_owned()],
            other: String::new(),
        };
        assert_eq!(understood("2", &age), Some(Act::Answer(second)));
        assert_eq!(understood("0", &age), None);
        assert_eq!(understood("9", &age), None);
        assert_eq!(
            understood("Yes", &item("vr_before")),
            Some(Act::Answer(Answer::YesNo(true)))
        );
    }
}
