//! Answers, as they were at the end of a form.

use serde::{Deserialize, Serialize};

use super::{Questionnaire, Stage};

/// One answer.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum Answer {
    /// A step of a scale, from 1 to 7.
    Scale(u8),
    /// Yes or no.
    YesNo(bool),
    /// Options by id, in the order of the file, and words of one's own, perhaps none.
    Choice {
        /// Ids of the options.
        chosen: Vec<String>,
        /// Added words.
        #[serde(default, skip_serializing_if = "String::is_empty")]
        other: String,
    },
    /// Words.
    Text(String),
}

/// What one form came to.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Answers {
    /// Which form.
    pub stage: Stage,
    /// The items that were due, in the order of the file.
    pub entries: Vec<Entry>,
}

/// One item of a form.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Entry {
    /// The item's id.
    pub item: String,
    /// `None` when it was skipped or not reached.
    pub answer: Option<Answer>,
    /// When it was last answered or skipped, since the session began [s]; `None` when it was not reached.
    pub at_s: Option<f64>,
}

/// The paper's score: how many of the answered items got a high answer.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Presence {
    /// High answers.
    pub count: u32,
    /// Items that were answered.
    pub answered: u32,
}

impl Answer {
    /// As a cell of a table: no tab, no line break, never empty.
    pub fn cell(&self) -> String {
        match self {
            Answer::Scale(step) => step.to_string(),
            Answer::YesNo(yes) => if *yes { "yes" } else { "no" }.to_owned(),
            Answer::Choice { chosen, other } => {
                let mut parts = chosen.clone();
                if !other.trim().is_empty() {
                    parts.push(format!("other: {}", one_line(other)));
                }
                non_empty(parts.join("; "))
            }
            Answer::Text(words) => non_empty(one_line(words)),
        }
    }

    /// Whether this is the answer that an item with `only_if` waits for.
    pub fn is(&self, awaited: &str) -> bool {
        match self {
            Answer::YesNo(yes) => awaited == if *yes { "yes" } else { "no" },
            Answer::Choice { chosen, .. } => chosen.iter().any(|id| id == awaited),
            Answer::Scale(_) | Answer::Text(_) => false,
        }
    }
}

impl Answers {
    /// The answer to an item, if it was asked and answered.
    pub fn get(&self, item: &str) -> Option<&Answer> {
        self.entries
            .iter()
            .find(|entry| entry.item == item)
            .and_then(|entry| entry.answer.as_ref())
    }

    /// The answer to a scale.
    pub fn scale(&self, item: &str) -> Option<u8> {
        match self.get(item) {
            Some(Answer::Scale(step)) => Some(*step),
            _ => None,
        }
    }

    /// The answer to a yes-or-no item.
    pub fn yes_no(&self, item: &str) -> Option<bool> {
        match self.get(item) {
            Some(Answer::YesNo(yes)) => Some(*yes),
            _ => None,
        }
    }

    /// The number of high answers, and of how many (section 3 of the paper).
    pub fn presence(&self, questionnaire: &Questionnaire) -> Presence {
        let answers = questionnaire.score_items.iter();
        let steps: Vec<u8> = answers.filter_map(|item| self.scale(item)).collect();
        let high = |step: &&u8| **step >= questionnaire.high_from;
        Presence {
            count: steps.iter().filter(high).count() as u32,
            answered: steps.len() as u32,
        }
    }
}

fn one_line(words: &str) -> String {
    words
        .split(|c: char| c.is_whitespace() || c.is_control())
        .filter(|word| !word.is_empty())
        .collect::<Vec<_>>()
        .join(" ")
}

fn non_empty(text: String) -> String {
    if text.is_empty() {
        "n/a".to_owned()
    } else {
        text
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cell_has_no_tab_and_is_never_empty() {
        let choice = Answer::Choice {
            chosen: vec!["bounce".to_owned(), "slide".to_owned()],
            other: "the\tpins\r\nflew".to_owned(),
        };
        assert_eq!(choice.cell(), "bounce; slide; other: the pins flew");
        assert_eq!(Answer::Text(" \n\u{7}".to_owned()).cell(), "n/a");
        assert_eq!(Answer::YesNo(false).cell(), "no");
    }

    #[test]
    fn answer_survives_json() {
        let answer = Answer::Choice {
            chosen: vec!["slide".to_owned()],
            other: String::new(),
        };
        let text = serde_json::to_string(&answer).unwrap();
        assert_eq!(text, r#"{"choice":{"chosen":["slide"]}}"#);
        assert_eq!(serde_json::from_str::<Answer>(&text).unwrap(), answer);
        assert!(serde_json::from_str::<Answer>(r#"{"scale":300}"#).is_err());
    }
}
