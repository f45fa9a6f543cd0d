//! What a participant is asked: items from a file, checked before anybody reads one.

mod answers;
mod file;
mod form;

use std::path::PathBuf;

use serde::Deserialize;

pub use answers::{Answer, Answers, Entry, Presence};
pub(crate) use file::line_of;
pub use file::names_the_purpose;
pub use form::{Act, AnswerError, Form, Logged, Stage};

use crate::files::FileError;

/// Version of the file's meaning.
pub const SCHEMA: u32 = 1;
/// Steps of a scale, from 1.
pub const SCALE_STEPS: u8 = 7;

/// A checked questionnaire.
#[derive(Debug, Clone, PartialEq)]
pub struct Questionnaire {
    /// Its name, which every table repeats.
    pub version: String,
    /// Language of its texts, as a BCP 47 tag.
    pub language: String,
    /// The items that the presence count is made of.
    pub score_items: Vec<String>,
    /// Smallest answer that counts as high: the paper's 6.
    pub high_from: u8,
    /// All items in the order in which they are asked.
    pub items: Vec<Item>,
}

/// One question.
#[derive(Debug, Clone, PartialEq)]
pub struct Item {
    /// Name of its column.
    pub id: String,
    /// What the participant reads.
    pub text: String,
    /// Which answers there are.
    pub kind: Kind,
    /// When it is asked.
    pub when: When,
    /// Asked after each game instead, in a study that says so.
    pub each_game: bool,
    /// Asked only after this answer.
    pub only_if: Option<OnlyIf>,
}

/// Which answers an item takes.
#[derive(Debug, Clone, PartialEq)]
pub enum Kind {
    /// A whole number from 1 to [`SCALE_STEPS`].
    Scale {
        /// The words at 1.
        low: String,
        /// The words at 7.
        high: String,
    },
    /// Yes or no.
    YesNo,
    /// One of some options.
    Choice {
        /// What may be chosen.
        options: Vec<ChoiceOption>,
        /// More than one may be chosen.
        several: bool,
        /// Words of one's own may be added.
        other: bool,
    },
    /// Words of one's own.
    Text,
}

/// One option of a choice.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ChoiceOption {
    /// What the table says.
    pub id: String,
    /// What the participant reads.
    pub text: String,
}

/// When an item is asked.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum When {
    /// Before the first throw.
    Before,
    /// Between the two games.
    Between,
    /// After both games.
    After,
}

/// An answer that another item waits for.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct OnlyIf {
    /// The earlier item.
    pub item: String,
    /// `yes`, `no` or an option's id.
    pub answer: String,
}

/// Why a questionnaire's file cannot be used.
#[derive(Debug, thiserror::Error)]
pub enum QuestionnaireError {
    /// The file cannot be read.
    #[error(transparent)]
    File(#[from] FileError),
    /// It is not TOML of the right form.
    #[error("{} is no questionnaire: line {line}: {message}; config/questionnaire.toml shows the form", path.display())]
    Syntax {
        /// Which file.
        path: PathBuf,
        /// Line, from 1.
        line: usize,
        /// What the reader of TOML says.
        message: String,
    },
    /// What it says cannot be asked.
    #[error("{} cannot be used: {problem}", path.display())]
    Content {
        /// Which file.
        path: PathBuf,
        /// What is wrong and what to do.
        problem: String,
    },
}

impl Questionnaire {
    /// The item of this name.
    pub fn item(&self, id: &str) -> Option<&Item> {
        self.items.iter().find(|item| item.id == id)
    }

    /// The items that are asked at `stage`; `items_after_each_game` is the plan's.
    pub fn asked_at(&self, stage: Stage, items_after_each_game: bool) -> Vec<&Item> {
        let asked = |item: &&Item| {
            let moved = item.each_game && items_after_each_game;
            match stage {
                Stage::Before => item.when == When::Before,
                Stage::AfterGame(game) => moved || (item.when == When::Between && game == 1),
                Stage::After => item.when == When::After && !moved,
            }
        };
        self.items.iter().filter(asked).collect()
    }

    /// Every text that a participant can read.
    pub fn readable(&self) -> Vec<&str> {
        self.items.iter().flat_map(Item::readable).collect()
    }
}

impl Item {
    /// Every text of this item that a participant can read.
    pub fn readable(&self) -> Vec<&str> {
        let mut texts = vec![self.text.as_str()];
        match &self.kind {
            Kind::Scale { low, high } => texts.extend([low.as_str(), high.as_str()]),
            Kind::Choice { options, .. } => {
                texts.extend(options.iter().map(|option| option.text.as_str()));
            }
            Kind::YesNo | Kind::Text => {}
        }
        texts
    }
}
