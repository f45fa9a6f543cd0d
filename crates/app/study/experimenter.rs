//! What the experimenter is told, and what the experimenter says: the same in the terminal and in the window. It never names
//! a condition, only Red and Blue.

use std::time::Instant;

use anyhow::Result;
use experiment::protocol::{AnsweredIn, Part, Place, Who};
use experiment::questionnaire::{Act, Answer, AnswerError, Item, Kind, SCALE_STEPS};
use experiment::staircase::Reply;

use crate::session::Session;

/// What can be typed.
pub const HELP: &str = "\
Type an answer and Enter; Enter alone skips, `back` goes back. At any time:
  /note WORDS    keep a remark
  /stop REASON   end the session at once
  /status        where the session is, and how tracking and pictures fare";

/// What the experimenter is told.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Told {
    /// The next step, or the question that is asked.
    pub due: String,
    /// The parts of the session.
    pub parts: Vec<Part>,
    /// How tracking and pictures fare.
    pub health: Vec<String>,
}

/// What there is to tell; `None` outside a study.
pub fn told(session: &Session) -> Option<Told> {
    let course = session.course()?;
    Some(Told {
        due: due(session)?,
        parts: course.protocol().outline(),
        health: session.health().lines(Instant::now()),
    })
}

/// What is due, in words; `None` outside a study.
pub fn due(session: &Session) -> Option<String> {
    let course = session.course()?;
    if let Some(form) = session.form()
        && let Some(item) = form.current()
    {
        let (number, count) = form.position();
        return Some(format!("[{number}/{count}] {}", question(item)));
    }
    let step = course.protocol().next_step();
    Some(match course.protocol().place() {
        Place::Debriefing => format!("{step}; Enter when done"),
        Place::Comparing(_) => format!("{step}\n  same or different"),
        _ => step,
    })
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

/// Does what a line says; returns what is to be said to that. What cannot be understood changes nothing.
///
/// # Errors
/// When the journal cannot be written.
pub fn take(line: &str, session: &mut Session) -> Result<Option<String>> {
    let line = line.trim();
    let (command, words) = line.split_once(' ').unwrap_or((line, ""));
    let words = words.trim();
    match command {
        "/note" if words.is_empty() => Ok(Some("There are no words to keep.".to_owned())),
        "/note" => {
            session.remark(words.to_owned())?;
            Ok(Some("The remark is kept.".to_owned()))
        }
        // It is stopped once.
        "/stop" if session.is_over() => Ok(None),
        "/stop" => session
            .stop(Who::Experimenter, words.to_owned())
            .map(|()| None),
        "/status" => Ok(Some(session.health().lines(Instant::now()).join("\n"))),
        _ if command.starts_with('/') => Ok(Some(HELP.to_owned())),
        _ => answer(line, session),
    }
}

fn answer(line: &str, session: &mut Session) -> Result<Option<String>> {
    let Some(item) = session.form().and_then(|form| form.current()).cloned() else {
        let place = session.course().map(|course| course.protocol().place());
        return match place {
            Some(Place::Comparing(_)) => compare(line, session),
            Some(Place::Debriefing) if line.is_empty() => session.debriefed().map(|()| None),
            _ if line.is_empty() => Ok(None),
            _ => Ok(Some(
                "Nothing is asked now: /note WORDS keeps a remark.".to_owned(),
            )),
        };
    };
    let Some(act) = understood(line, &item) else {
        return Ok(Some("That is no answer to this question.".to_owned()));
    };
    let is_high = matches!(&act, Act::Answer(Answer::Scale(step))
        if item.id.starts_with("sick") && session.course().is_some_and(|course| *step >= course.sickness_stop()));
    match session.answer(act, AnsweredIn::Desk) {
        Ok(()) if is_high => Ok(Some(
            "The participant feels unwell: the plan advises to end here. /stop REASON ends the session."
                .to_owned(),
        )),
        Ok(()) => Ok(None),
        // The question stays; only a journal that cannot be written ends the session.
        Err(error) if error.is::<AnswerError>() => Ok(Some(format!("{error}."))),
        Err(error) => Err(error),
    }
}

/// Takes what is said of a pair of throws.
fn compare(line: &str, session: &mut Session) -> Result<Option<String>> {
    let reply = match line.to_lowercase().as_str() {
        "s" | "same" => Reply::Same,
        "d" | "different" => Reply::Different,
        _ => return Ok(Some("Type `same` or `different`.".to_owned())),
    };
    session.compare(reply, AnsweredIn::Desk).map(|()| None)
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
