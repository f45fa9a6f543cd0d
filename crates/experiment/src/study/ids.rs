//! Participants' ids: random, short, and never a word.

use std::fmt;

use serde::{Deserialize, Serialize};

use super::StudyError;
use crate::random::SplitMix64;

/// Begins an id: no digit and none of a to f, so that no id is a number or part of a digest.
const FIRST: &[u8] = b"ghjkmnpqrstvwxz";
/// Continues it: no vowel, so that it is no word, and nothing that looks like something else.
const REST: &[u8] = b"bcdfghjkmnpqrstvwxz23456789";

/// A participant's id, `sub-` and four letters or digits.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(try_from = "String", into = "String")]
pub struct ParticipantId(String);

impl ParticipantId {
    /// Reads an id with or without its `sub-`.
    ///
    /// # Errors
    /// When it is none; it becomes part of a path, so that nothing else passes.
    pub fn parse(text: &str) -> Result<Self, StudyError> {
        let label = text.strip_prefix("sub-").unwrap_or(text);
        let plain = |byte: u8| byte.is_ascii_lowercase() || byte.is_ascii_digit();
        if label.len() == 4 && label.bytes().all(plain) {
            Ok(ParticipantId(label.to_owned()))
        } else {
            Err(StudyError::NotAnId(text.to_owned()))
        }
    }

    /// The id without its `sub-`.
    pub fn label(&self) -> &str {
        &self.0
    }
}

impl fmt::Display for ParticipantId {
    fn fmt(&self, formatter: &mut fmt::Formatter) -> fmt::Result {
        write!(formatter, "sub-{}", self.0)
    }
}

impl TryFrom<String> for ParticipantId {
    type Error = StudyError;

    fn try_from(text: String) -> Result<Self, StudyError> {
        ParticipantId::parse(&text)
    }
}

impl From<ParticipantId> for String {
    fn from(id: ParticipantId) -> String {
        id.to_string()
    }
}

/// An id that is not `taken`, from `entropy` that nobody can guess; the order of arrival cannot be read from it.
///
/// # Panics
/// When all 282,000 are taken.
pub fn fresh_id(entropy: u64, taken: impl Fn(&ParticipantId) -> bool) -> ParticipantId {
    let mut random = SplitMix64::new(entropy);
    for _ in 0..100_000_000 {
        let mut letter =
            |letters: &[u8]| char::from(letters[random.below(letters.len() as u64) as usize]);
        let label: String = [letter(FIRST), letter(REST), letter(REST), letter(REST)]
            .into_iter()
            .collect();
        let id = ParticipantId(label);
        // With a digit it is no abbreviation either.
        if id.0.bytes().any(|byte| byte.is_ascii_digit()) && !taken(&id) {
            return id;
        }
    }
    panic!("all ids are taken");
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeSet;

    #[test]
    fn fresh_ids_are_distinct_and_not_in_order() {
        let mut taken = BTreeSet::new();
        let mut arrived = Vec::new();
        for participant in 0..2000 {
            // The same entropy each time: what is taken alone keeps them apart.
            let id = fresh_id(participant % 10, |id| taken.contains(id));
            assert!(taken.insert(id.clone()));
            assert_eq!(ParticipantId::parse(&id.to_string()).unwrap(), id);
            arrived.push(id);
        }
        let rises = arrived.windows(2).filter(|pair| pair[0] < pair[1]).count();
        // Half of 1999, and four standard errors of a random order (13).
        assert!((947..1053).contains(&rises), "{rises}");
    }

    #[test]
    fn parse_takes_no_path() {
        for text in [
            "",
            "sub-",
            "p7k",
            "p7k22",
            "../x",
            "sub-P7K2",
            "p7/2",
            "sub-sub-p7k2",
            "p7é",
        ] {
            assert!(ParticipantId::parse(text).is_err(), "{text}");
        }
        let id: ParticipantId = serde_json::from_str("\"sub-p7k2\"").unwrap();
        assert_eq!(
            (id.label(), serde_json::to_string(&id).unwrap().as_str()),
            ("p7k2", "\"sub-p7k2\"")
        );
    }
}
