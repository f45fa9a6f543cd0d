//! The questionnaire's file: read, then checked in one function.

use std::collections::BTreeSet;
use std::path::Path;

use serde::Deserialize;

use super::{
    ChoiceOption, Item, Kind, OnlyIf, Questionnaire, QuestionnaireError, SCALE_STEPS, SCHEMA, When,
};
use crate::files;

/// Columns that the tables have anyway.
const TAKEN: [&str; 9] = [
    "participant_id",
    "session_id",
    "slot",
    "status",
    "presence_count",
    "presence_n",
    "answered_in",
    "game",
    "questionnaire",
];
/// What the analysis cannot do without, and of which kind and time it is.
const NEEDED: [(&str, &str, When); 3] = [
    ("vr_before", "yes_no", When::Before),
    ("sick", "scale", When::After),
    ("noticed", "yes_no", When::After),
];

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Document {
    schema: u32,
    version: String,
    language: String,
    score: Score,
    item: Vec<RawItem>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Score {
    items: Vec<String>,
    high_from: u8,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct RawItem {
    id: String,
    text: String,
    kind: String,
    when: When,
    low: Option<String>,
    high: Option<String>,
    options: Option<Vec<ChoiceOption>>,
    several: Option<bool>,
    other: Option<bool>,
    #[serde(default)]
    each_game: bool,
    only_if: Option<OnlyIf>,
}

impl Questionnaire {
    /// Reads and checks a file.
    ///
    /// # Errors
    /// One sentence with the file, the place and what to do.
    pub fn read(path: &Path) -> Result<Self, QuestionnaireError> {
        Questionnaire::parse(&files::read(path)?, path)
    }

    /// Checks the text of a file; `path` is for messages.
    ///
    /// # Errors
    /// As [`Questionnaire::read`].
    pub fn parse(text: &str, path: &Path) -> Result<Self, QuestionnaireError> {
        let document: Document =
            toml::from_str(text).map_err(|error| QuestionnaireError::Syntax {
                path: path.to_path_buf(),
                line: line_of(text, error.span()),
                message: error.message().trim().replace('\n', " "),
            })?;
        document
            .check()
            .map_err(|problem| QuestionnaireError::Content {
                path: path.to_path_buf(),
                problem,
            })
    }
}

/// Line in which a span begins, from 1.
pub(crate) fn line_of(text: &str, span: Option<std::ops::Range<usize>>) -> usize {
    let start = span.map_or(0, |span| span.start).min(text.len());
    1 + text.as_bytes()[..start]
        .iter()
        .filter(|byte| **byte == b'\n')
        .count()
}

impl Document {
    fn check(self) -> Result<Questionnaire, String> {
        if self.schema != SCHEMA {
            return Err(format!(
                "it is of schema {}, and this program reads {SCHEMA}: use the program that it was written for",
                self.schema
            ));
        }
        if !(2..=SCALE_STEPS).contains(&self.score.high_from) {
            return Err(format!(
                "score.high_from is {}, and has to be from 2 to {SCALE_STEPS}",
                self.score.high_from
            ));
        }
        let items = self
            .item
            .into_iter()
            .map(RawItem::check)
            .collect::<Result<Vec<_>, _>>()?;
        let questionnaire = Questionnaire {
            version: self.version,
            language: self.language,
            score_items: self.score.items,
            high_from: self.score.high_from,
            items,
        };
        questionnaire.check_names()?;
        questionnaire.check_references()?;
        questionnaire.check_needed()?;
        Ok(questionnaire)
    }
}

impl RawItem {
    fn check(self) -> Result<Item, String> {
        let id = self.id;
        let wrong = |problem: &str| Err(format!("item {id:?}: {problem}"));
        let kind = match (self.kind.as_str(), self.low, self.high, self.options) {
            ("scale", Some(low), Some(high), None) => Kind::Scale { low, high },
            ("scale", ..) => {
                return wrong(
                    "a scale needs `low` and `high`, the words at its ends, and no options",
                );
            }
            ("yes_no", None, None, None) => Kind::YesNo,
            ("text", None, None, None) => Kind::Text,
            ("choice", None, None, Some(options)) if options.len() >= 2 => Kind::Choice {
                options,
                several: self.several.unwrap_or(false),
                other: self.other.unwrap_or(false),
            },
            ("choice", ..) => {
                return wrong("a choice needs two `options` or more, and no `low` or `high`");
            }
            ("yes_no" | "text", ..) => {
                return wrong("yes_no and text have no `low`, `high` or `options`");
            }
            _ => return wrong("`kind` has to be scale, yes_no, choice or text"),
        };
        if !matches!(kind, Kind::Choice { .. }) && (self.several.is_some() || self.other.is_some())
        {
            return wrong("`several` and `other` belong to a choice");
        }
        if self.each_game && self.when != When::After {
            return wrong("`each_game` belongs to an item that is asked \"after\" the games");
        }
        Ok(Item {
            text: self.text,
            kind,
            when: self.when,
            each_game: self.each_game,
            only_if: self.only_if,
            id,
        })
    }
}

impl Questionnaire {
    fn check_names(&self) -> Result<(), String> {
        let mut seen = BTreeSet::new();
        for item in &self.items {
            let id = &item.id;
            let letters = |c: char| c.is_ascii_lowercase() || c.is_ascii_digit() || c == '_';
            if !id.starts_with(|c: char| c.is_ascii_lowercase()) || !id.chars().all(letters) {
                return Err(format!(
                    "item {id:?}: an id names a column: a small letter, then small letters, digits and _"
                ));
            }
            if TAKEN.contains(&id.as_str()) || !seen.insert(id) {
                return Err(format!("item {id:?}: this id is taken, choose another"));
            }
            if item.readable().iter().any(|text| text.trim().is_empty()) {
                return Err(format!("item {id:?}: a text is empty"));
            }
            if let Some(text) = item.readable().iter().find(|text| names_the_purpose(text)) {
                return Err(format!(
                    "item {id:?}: a participant must not read the word \"presence\", and {text:?} has it: say it in other words"
                ));
            }
            item.check_options()?;
        }
        Ok(())
    }

    fn check_references(&self) -> Result<(), String> {
        for id in &self.score_items {
            match self.item(id) {
                Some(item)
                    if matches!(item.kind, Kind::Scale { .. }) && item.when == When::After => {}
                _ => {
                    return Err(format!(
                        "score.items names {id:?}, which is no scale that is asked \"after\" the games"
                    ));
                }
            }
        }
        if self.score_items.is_empty() {
            return Err("score.items is empty, so that nothing would be counted".to_owned());
        }
        for (index, item) in self.items.iter().enumerate() {
            let Some(only_if) = &item.only_if else {
                continue;
            };
            let earlier = self.items[..index]
                .iter()
                .find(|earlier| earlier.id == only_if.item);
            let fits = earlier.is_some_and(|earlier| {
                earlier.when == item.when
                    && earlier.each_game == item.each_game
                    && earlier.can_be(&only_if.answer)
            });
            if !fits {
                return Err(format!(
                    "item {:?}: only_if names {:?} = {:?}, which is no earlier yes_no or choice of the same time with that answer",
                    item.id, only_if.item, only_if.answer
                ));
            }
        }
        Ok(())
    }

    fn check_needed(&self) -> Result<(), String> {
        for (id, kind, when) in NEEDED {
            let fits = self
                .item(id)
                .is_some_and(|item| item.kind.name() == kind && item.when == when);
            if !fits {
                return Err(format!(
                    "the analysis needs an item {id:?} of kind {kind:?} asked {when:?}: see config/questionnaire.toml"
                ));
            }
        }
        Ok(())
    }
}

impl Item {
    fn check_options(&self) -> Result<(), String> {
        let Kind::Choice { options, .. } = &self.kind else {
            return Ok(());
        };
        let mut seen = BTreeSet::new();
        for option in options {
            let plain = |c: char| c.is_ascii_alphanumeric() || "-_+".contains(c);
            if option.id.is_empty() || !option.id.chars().all(plain) || !seen.insert(&option.id) {
                return Err(format!(
                    "item {:?}: option {:?} needs an id of its own of letters, digits, -, _ and +",
                    self.id, option.id
                ));
            }
        }
        Ok(())
    }

    fn can_be(&self, answer: &str) -> bool {
        match &self.kind {
            Kind::YesNo => ["yes", "no"].contains(&answer),
            Kind::Choice { options, .. } => options.iter().any(|option| option.id == answer),
            Kind::Scale { .. } | Kind::Text => false,
        }
    }
}

impl Kind {
    fn name(&self) -> &'static str {
        match self {
            Kind::Scale { .. } => "scale",
            Kind::YesNo => "yes_no",
            Kind::Choice { .. } => "choice",
            Kind::Text => "text",
        }
    }
}

/// Whether a text has the word that a participant must not read.
pub fn names_the_purpose(text: &str) -> bool {
    text.to_lowercase().contains("presence")
}

#[cfg(test)]
mod tests {
    use super::*;

    const SHIPPED: &str = include_str!("../../../../config/questionnaire.toml");

    fn parse(text: &str) -> Result<Questionnaire, String> {
        Questionnaire::parse(text, Path::new("q.toml")).map_err(|error| error.to_string())
    }

    #[test]
    fn shipped_questionnaire_is_the_papers_in_content() {
        let shipped = parse(SHIPPED).unwrap();
        // Section 3: six presence items, the count of answers 6 and 7.
        assert_eq!((shipped.score_items.len(), shipped.high_from), (6, 6));
        assert!(shipped.readable().len() > 30);
        for text in shipped.readable() {
            assert!(!names_the_purpose(text), "{text}");
        }
    }

    #[test]
    fn shipped_wording_is_not_the_papers() {
        // Runs of five words of Appendix A and of the questions quoted in sections 3 and 4.
        let paper = [
            "sense of being there",
            "on the following scale",
            "to what extent were there",
            "became reality for you",
            "almost forgot about the real world",
            "think back about your experience",
            "images that you saw",
            "somewhere that you visited",
            "strongest on the whole",
            "similar way that you are thinking",
            "standing in a laboratory wearing a helmet",
            "overwhelm",
            "dizzy, sick or nauseous",
            "could you distinguish any differences",
            "have you experienced",
        ];
        for text in parse(SHIPPED).unwrap().readable() {
            for phrase in paper {
                assert!(
                    !text.to_lowercase().contains(phrase),
                    "{text:?} has {phrase:?}"
                );
            }
        }
    }

    #[test]
    fn parse_refuses_with_one_sentence() {
        let cases = [
            ("schema = 1", "schema = 2", "this program reads 1"),
            ("high_from = 6", "high_from = 8", "score.high_from is 8"),
            (
                "inside the bowling hall?\"",
                "inside? Your Presence\"",
                "must not read the word",
            ),
            (
                "id = \"q2\"",
                "id = \"q1\"",
                "item \"q1\": this id is taken",
            ),
            ("id = \"q2\"", "id = \"Q 2\"", "an id names a column"),
            ("id = \"q2\"", "id = \"slot\"", "is taken"),
            (
                "id = \"sick\"",
                "id = \"ill\"",
                "the analysis needs an item \"sick\"",
            ),
            (
                "\"q6\"]",
                "\"q6\", \"comments\"]",
                "names \"comments\", which is no scale",
            ),
            (
                "answer = \"yes\" }",
                "answer = \"maybe\" }",
                "only_if names \"noticed\" = \"maybe\"",
            ),
            ("kind = \"text\"", "kind = \"song\"", "`kind` has to be"),
            (
                "kind = \"text\"",
                "kind = \"text\"\nlow = \"x\"",
                "have no `low`",
            ),
            (
                "low = \"not at all\"\n",
                "",
                "a scale needs `low` and `high`",
            ),
            (
                "text = \"What was different?\"",
                "text = \" \"",
                "a text is empty",
            ),
            (
                "id = \"slide\"",
                "id = \"bounce\"",
                "needs an id of its own",
            ),
            (
                "version = \"bowling-1\"",
                "version = \"bowling-1\"\ncolour = 3",
                "line 4: unknown field `colour`",
            ),
        ];
        // The comment shows keys too.
        let plain = SHIPPED.lines().filter(|line| !line.starts_with('#'));
        let plain: String = plain.map(|line| format!("{line}\n")).collect();
        for (from, to, expected) in cases {
            assert!(plain.contains(from), "{from}");
            let error = parse(&plain.replacen(from, to, 1)).unwrap_err();
            assert!(error.contains(expected), "{error}");
            assert!(
                error.starts_with("q.toml ") && error.lines().count() == 1,
                "{error}"
            );
        }
    }
}
