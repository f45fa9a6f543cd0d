//! One form while it is filled in: an item at a time, skip, back, and a log that makes it again.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

use super::{Answer, Answers, Entry, Item, Kind, Questionnaire, SCALE_STEPS};

/// Longest text that an answer may have [characters].
pub const LONGEST_TEXT: usize = 4000;

/// Which form of a session.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Stage {
    /// Before the first throw.
    Before,
    /// After game 1 or 2.
    AfterGame(u8),
    /// After both games.
    After,
}

/// What the participant did.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Act {
    /// Answered the item that was shown.
    Answer(Answer),
    /// Left it out.
    Skip,
    /// Went back to the item before.
    Back,
}

/// One act, when, and at which item: what the journal keeps of a form.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Logged {
    /// Since the session began [s].
    pub at_s: f64,
    /// The item that was shown.
    pub item: String,
    /// What was done.
    pub act: Act,
}

/// An act that does not fit.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum AnswerError {
    /// The answer is of another kind, or none of the options, or out of range.
    #[error("item {item:?} does not take the answer {answer:?}: {expected}")]
    Unfit {
        /// The item that was shown.
        item: String,
        /// What was given.
        answer: Answer,
        /// What it takes.
        expected: &'static str,
    },
    /// There is nothing before the first item.
    #[error("this is the first item, so there is none to go back to")]
    First,
    /// Every item has been passed.
    #[error("the form is finished: go back to change an answer")]
    Finished,
    /// A log that does not belong to this form.
    #[error(
        "the log has an act at item {logged:?} while the form shows {shown:?}: it belongs to another questionnaire"
    )]
    Foreign {
        /// Item in the log.
        logged: String,
        /// Item that is shown.
        shown: String,
    },
}

/// A form that is being filled in.
#[derive(Debug, Clone)]
pub struct Form {
    stage: Stage,
    items: Vec<Item>,
    /// Index of the item that is shown; the number of items when all have been passed.
    at: usize,
    given: BTreeMap<String, (Option<Answer>, f64)>,
    log: Vec<Logged>,
}

impl Form {
    /// The form of `stage`; `items_after_each_game` is the plan's. A form may be empty, and is then finished.
    pub fn new(questionnaire: &Questionnaire, stage: Stage, items_after_each_game: bool) -> Self {
        let asked = questionnaire.asked_at(stage, items_after_each_game);
        Form {
            stage,
            items: asked.into_iter().cloned().collect(),
            at: 0,
            given: BTreeMap::new(),
            log: Vec::new(),
        }
    }

    /// The item to be shown; `None` when the form is finished.
    pub fn current(&self) -> Option<&Item> {
        self.items.get(self.at)
    }

    /// Number of the item that is shown, from 1, and of all items; conditional items count.
    pub fn position(&self) -> (usize, usize) {
        ((self.at + 1).min(self.items.len()), self.items.len())
    }

    /// What the item that is shown was answered with before, when the participant has come back to it.
    pub fn given(&self) -> Option<&Answer> {
        self.answer_to(&self.current()?.id)
    }

    /// All acts so far.
    pub fn log(&self) -> &[Logged] {
        &self.log
    }

    /// Takes one act at `at_s`, the time since the session began [s].
    ///
    /// # Errors
    /// When it does not fit; the form is then as before.
    pub fn act(&mut self, at_s: f64, act: Act) -> Result<(), AnswerError> {
        if act == Act::Back {
            let before = (0..self.at).rev().find(|index| self.is_due(*index));
            let before = before.ok_or(AnswerError::First)?;
            let left = self.items.get(self.at).unwrap_or(&self.items[before]);
            let item = left.id.clone();
            self.log.push(Logged { at_s, item, act });
            self.at = before;
            return Ok(());
        }
        let shown = self.current().ok_or(AnswerError::Finished)?;
        let item = shown.id.clone();
        let answer = match &act {
            Act::Answer(answer) => Some(shown.checked(answer)?),
            Act::Skip | Act::Back => None,
        };
        self.given.insert(item.clone(), (answer, at_s));
        self.log.push(Logged { at_s, item, act });
        let next = (self.at + 1..self.items.len()).find(|index| self.is_due(*index));
        self.at = next.unwrap_or(self.items.len());
        Ok(())
    }

    /// The form that a log leads to.
    ///
    /// # Errors
    /// When the log belongs to another form.
    pub fn replay(mut self, log: &[Logged]) -> Result<Self, AnswerError> {
        for logged in log {
            let shown = self.current().map_or("", |item| &item.id).to_owned();
            let came_back = logged.act == Act::Back && shown.is_empty();
            if shown != logged.item && !came_back {
                return Err(AnswerError::Foreign {
                    logged: logged.item.clone(),
                    shown,
                });
            }
            self.act(logged.at_s, logged.act.clone())?;
        }
        Ok(self)
    }

    /// What the form has come to so far; items that are not due are left out.
    pub fn answers(&self) -> Answers {
        let due = (0..self.items.len()).filter(|index| self.is_due(*index));
        let entries = due.map(|index| {
            let item = self.items[index].id.clone();
            let given = self.given.get(&item);
            Entry {
                answer: given.and_then(|(answer, _)| answer.clone()),
                at_s: given.map(|(_, at_s)| *at_s),
                item,
            }
        });
        Answers {
            stage: self.stage,
            entries: entries.collect(),
        }
    }

    fn answer_to(&self, item: &str) -> Option<&Answer> {
        self.given.get(item)?.0.as_ref()
    }

    /// Whether the item's condition, if it has one, is met by an item that is due itself.
    fn is_due(&self, index: usize) -> bool {
        let Some(only_if) = &self.items[index].only_if else {
            return true;
        };
        let earlier = self.items[..index]
            .iter()
            .position(|item| item.id == only_if.item);
        earlier.is_some_and(|earlier| self.is_due(earlier))
            && self
                .answer_to(&only_if.item)
                .is_some_and(|answer| answer.is(&only_if.answer))
    }
}

impl Item {
    /// The answer in its usual form, or why it does not fit.
    fn checked(&self, answer: &Answer) -> Result<Answer, AnswerError> {
        let unfit = |expected| AnswerError::Unfit {
            item: self.id.clone(),
            answer: answer.clone(),
            expected,
        };
        match (&self.kind, answer) {
            (Kind::Scale { .. }, Answer::Scale(step)) if (1..=SCALE_STEPS).contains(step) => {
                Ok(answer.clone())
            }
            (Kind::Scale { .. }, _) => Err(unfit("a whole number from 1 to 7")),
            (Kind::YesNo, Answer::YesNo(_)) => Ok(answer.clone()),
            (Kind::YesNo, _) => Err(unfit("yes or no")),
            (Kind::Text, Answer::Text(words)) if words.chars().count() <= LONGEST_TEXT => {
                Ok(answer.clone())
            }
            (Kind::Text, _) => Err(unfit("a text of at most 4000 characters")),
            (Kind::Choice { .. }, Answer::Choice { chosen, other }) => {
                self.checked_choice(chosen, other).ok_or_else(|| {
                    unfit("the ids of options, one unless it allows several, and words only where it has `other`")
                })
            }
            (Kind::Choice { .. }, _) => Err(unfit("the ids of options")),
        }
    }

    fn checked_choice(&self, chosen: &[String], words: &str) -> Option<Answer> {
        let Kind::Choice {
            options,
            several,
            other,
        } = &self.kind
        else {
            return None;
        };
        let known = |id: &String| options.iter().any(|option| option.id == *id);
        let count = chosen.len() + usize::from(!words.is_empty());
        let fits = chosen.iter().all(known)
            && (words.is_empty() || *other)
            && words.chars().count() <= LONGEST_TEXT
            && count >= 1
            && (*several || count == 1);
        let ordered = options.iter().map(|option| &option.id);
        fits.then(|| Answer::Choice {
            chosen: ordered.filter(|id| chosen.contains(id)).cloned().collect(),
            other: words.to_owned(),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::path::Path;

    fn shipped() -> Questionnaire {
        let text = include_str!("../../../../config/questionnaire.toml");
        Questionnaire::parse(text, Path::new("q.toml")).unwrap()
    }

    fn shown(form: &Form) -> &str {
        form.current().map_or("", |item| &item.id)
    }

    fn scale(step: u8) -> Act {
        Act::Answer(Answer::Scale(step))
    }

    #[test]
    fn form_takes_skips_goes_back_and_is_made_again_from_its_log() {
        let questionnaire = shipped();
        let new = || Form::new(&questionnaire, Stage::After, false);
        let mut form = new();
        assert_eq!(form.act(0.0, Act::Back), Err(AnswerError::First));
        form.act(1.0, scale(6)).unwrap();
        form.act(2.0, scale(7)).unwrap();
        form.act(3.0, Act::Back).unwrap();
        assert_eq!(
            (shown(&form), form.given()),
            ("q2", Some(&Answer::Scale(7)))
        );
        form.act(4.0, scale(5)).unwrap();
        for at_s in [5.0, 6.0, 7.0] {
            form.act(at_s, scale(6)).unwrap();
        }
        form.act(8.0, Act::Skip).unwrap();
        form.act(9.0, scale(2)).unwrap();
        form.act(10.0, Act::Answer(Answer::YesNo(false))).unwrap();
        assert_eq!(shown(&form), "comments", "noticed_what is not due");
        form.act(11.0, Act::Skip).unwrap();
        assert_eq!(form.act(12.0, Act::Skip), Err(AnswerError::Finished));
        let answers = form.answers();
        let presence = answers.presence(&questionnaire);
        assert_eq!((presence.count, presence.answered), (4, 5));
        assert_eq!(
            answers.entries[5],
            Entry {
                item: "q6".to_owned(),
                answer: None,
                at_s: Some(8.0)
            }
        );
        let again = new().replay(form.log()).unwrap();
        assert_eq!((again.answers(), shown(&again)), (answers, ""));
    }

    #[test]
    fn condition_that_is_taken_back_takes_its_answer_with_it() {
        let mut form = Form::new(&shipped(), Stage::After, true);
        form.act(0.0, scale(1)).unwrap();
        form.act(1.0, Act::Answer(Answer::YesNo(true))).unwrap();
        let chosen = Answer::Choice {
            chosen: vec!["shape".into(), "bounce".into()],
            other: "x".into(),
        };
        form.act(2.0, Act::Answer(chosen)).unwrap();
        assert_eq!(
            form.answers().get("noticed_what").unwrap().cell(),
            "bounce; shape; other: x"
        );
        form.act(3.0, Act::Back).unwrap();
        form.act(4.0, Act::Back).unwrap();
        form.act(5.0, Act::Answer(Answer::YesNo(false))).unwrap();
        form.act(6.0, Act::Skip).unwrap();
        // Back from the end of the form.
        form.act(7.0, Act::Back).unwrap();
        assert_eq!(shown(&form), "comments");
        assert_eq!(form.answers().get("noticed_what"), None);
        form.act(7.5, Act::Back).unwrap();
        assert_eq!(shown(&form), "noticed", "what is not due is passed over");
        form.act(7.6, Act::Skip).unwrap();
        let again = Form::new(&shipped(), Stage::After, true)
            .replay(form.log())
            .unwrap();
        assert_eq!(again.answers(), form.answers());
        let other = Form::new(&shipped(), Stage::Before, true).replay(form.log());
        assert!(matches!(other, Err(AnswerError::Foreign { .. })));
    }

    #[test]
    fn act_refuses_what_the_item_does_not_take() {
        let mut form = Form::new(&shipped(), Stage::Before, false);
        let one = |id: &str| Answer::Choice {
            chosen: vec![id.to_owned()],
            other: String::new(),
        };
        let two = Answer::Choice {
            chosen: vec!["18-24".into(), "25-34".into()],
            other: String::new(),
        };
        let words = Answer::Choice {
            chosen: vec![],
            other: "old".into(),
        };
        for unfit in [one("7"), two, words, Answer::YesNo(true)] {
            form.act(0.0, Act::Answer(unfit)).unwrap_err();
        }
        form.act(0.0, Act::Answer(one("25-34"))).unwrap();
        form.act(0.0, scale(3)).unwrap_err();
        form.act(0.0, Act::Skip).unwrap();
        for unfit in [0, 8, 255] {
            form.act(0.0, scale(unfit)).unwrap_err();
        }
        assert_eq!((form.position(), form.log().len()), ((3, 3), 2));
    }

    #[test]
    fn stages_share_the_items_as_the_plan_says() {
        let questionnaire = shipped();
        let count = |stage, each| Form::new(&questionnaire, stage, each).position().1;
        let counts = |each| {
            [
                Stage::Before,
                Stage::AfterGame(1),
                Stage::AfterGame(2),
                Stage::After,
            ]
            .map(|stage| count(stage, each))
        };
        assert_eq!(counts(false), [3, 1, 0, 10]);
        assert_eq!(counts(true), [3, 7, 6, 4]);
    }
}
