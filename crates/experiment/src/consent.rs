//! Consent: the form a study uses, what was ticked, and the gate that no session passes without.
//!
//! The form is a text with the line `Version: ...` and fields in braces, which are filled in when a study is made; after that its
//! SHA-256 says which text a participant agreed to.

use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};

use crate::digest;
use crate::files::{self, FileError};

/// What can be ticked, in the order of the form.
pub const TICKS: [&str; 4] = ["take_part", "share_data", "share_motion", "contact"];

/// A form as participants read it.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct ConsentForm {
    /// What its line `Version:` says.
    pub version: String,
    /// SHA-256 of the whole text, 64 hexadecimal digits.
    pub sha256: String,
    /// The text.
    pub text: String,
}

/// What was ticked.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Ticks {
    /// Takes part; no session begins without.
    pub take_part: bool,
    /// Answers and game data may be shared.
    pub share_data: bool,
    /// Motion may be shared too.
    pub share_motion: bool,
    /// May be asked again for later studies.
    pub contact: bool,
}

/// Consent that was given: proof that the gate was passed.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Consent {
    /// Version of the form.
    pub form_version: String,
    /// SHA-256 of the form.
    pub form_sha256: String,
    /// Day on which it was given, `YYYY-MM-DD`.
    pub date: String,
    /// What was agreed to.
    pub ticks: Ticks,
}

/// Why the gate stays shut.
#[derive(Debug, thiserror::Error)]
pub enum ConsentError {
    /// The form cannot be read.
    #[error(transparent)]
    File(#[from] FileError),
    /// The form has no version.
    #[error("{} has no line \"Version: ...\": give the form a version, so that it is known who agreed to what", .0.display())]
    NoVersion(PathBuf),
    /// The form's text can be read by participants.
    #[error("{} has the word \"presence\", which a participant must not read: say it in other words", .0.display())]
    NamesThePurpose(PathBuf),
    /// Fields in braces are left.
    #[error("the consent form still has the empty fields {}: a study is given them when it is made", .0.join(", "))]
    Unfilled(Vec<String>),
    /// The participant does not take part.
    #[error("\"take part\" is not ticked, so there is no session; nothing has been recorded")]
    NotTakingPart,
    /// Motion is data.
    #[error("motion cannot be shared where data are not: tick \"share data\" as well, or neither")]
    MotionWithoutData,
    /// A date that is none.
    #[error("{0:?} is no date: it has to be YYYY-MM-DD")]
    Date(String),
}

impl ConsentForm {
    /// Reads a form.
    ///
    /// # Errors
    /// When it cannot be read, has no version, or names the study's purpose.
    pub fn read(path: &Path) -> Result<Self, ConsentError> {
        ConsentForm::parse(files::read(path)?, path)
    }

    /// Takes a form's text; `path` is for messages.
    ///
    /// # Errors
    /// As [`ConsentForm::read`].
    pub fn parse(text: String, path: &Path) -> Result<Self, ConsentError> {
        if crate::questionnaire::names_the_purpose(&text) {
            return Err(ConsentError::NamesThePurpose(path.to_path_buf()));
        }
        let version = text
            .lines()
            .find_map(|line| line.strip_prefix("Version:"))
            .map(str::trim)
            .filter(|version| !version.is_empty())
            .ok_or_else(|| ConsentError::NoVersion(path.to_path_buf()))?
            .to_owned();
        let sha256 = digest::sha256(text.as_bytes());
        Ok(ConsentForm {
            version,
            sha256,
            text,
        })
    }

    /// The form with `{name}` replaced by its value for each of `fields`; empty values leave the field as it is.
    #[must_use]
    pub fn filled(&self, fields: &[(&str, &str)]) -> ConsentForm {
        let mut text = self.text.clone();
        for (name, value) in fields.iter().filter(|(_, value)| !value.trim().is_empty()) {
            text = text.replace(&format!("{{{name}}}"), value);
        }
        ConsentForm {
            version: self.version.clone(),
            sha256: digest::sha256(text.as_bytes()),
            text,
        }
    }

    /// The words beside one of [`TICKS`]: of the line `- [ ] words (`name`)`; `None` where the form has no such line.
    pub fn tick(&self, name: &str) -> Option<&str> {
        let end = format!("(`{name}`)");
        let lines = self
            .text
            .lines()
            .filter_map(|line| line.strip_prefix("- [ ]"));
        let words = lines.filter_map(|line| line.trim().strip_suffix(end.as_str()));
        words.map(str::trim).next()
    }

    /// Names of the fields that are still empty.
    pub fn unfilled(&self) -> Vec<String> {
        let mut names: Vec<String> = Vec::new();
        for piece in self.text.split('{').skip(1) {
            let name = piece.split('}').next().unwrap_or_default();
            let is_name = !name.is_empty()
                && name.len() < piece.len()
                && name.chars().all(|c| c.is_ascii_lowercase() || c == '_');
            if is_name && !names.iter().any(|known| known == name) {
                names.push(name.to_owned());
            }
        }
        names
    }

    /// The gate: consent to this form with these ticks on `date` (`YYYY-MM-DD`).
    ///
    /// # Errors
    /// When the participant does not take part, or the form or the date are not fit to be agreed to.
    pub fn agree(&self, ticks: Ticks, date: &str) -> Result<Consent, ConsentError> {
        let unfilled = self.unfilled();
        if !unfilled.is_empty() {
            return Err(ConsentError::Unfilled(unfilled));
        }
        if !ticks.take_part {
            return Err(ConsentError::NotTakingPart);
        }
        if ticks.share_motion && !ticks.share_data {
            return Err(ConsentError::MotionWithoutData);
        }
        if !is_date(date) {
            return Err(ConsentError::Date(date.to_owned()));
        }
        Ok(Consent {
            form_version: self.version.clone(),
            form_sha256: self.sha256.clone(),
            date: date.to_owned(),
            ticks,
        })
    }
}

/// Whether `text` is a day of the Gregorian calendar, `YYYY-MM-DD`.
pub fn is_date(text: &str) -> bool {
    let parts: Vec<&str> = text.split('-').collect();
    let [year, month, day] = parts[..] else {
        return false;
    };
    let number = |part: &str, digits: usize| -> Option<u32> {
        let plain = part.len() == digits && part.bytes().all(|byte| byte.is_ascii_digit());
        plain.then(|| part.parse().ok()).flatten()
    };
    let (Some(year), Some(month), Some(day)) = (number(year, 4), number(month, 2), number(day, 2))
    else {
        return false;
    };
    let leap = year % 4 == 0 && (year % 100 != 0 || year % 400 == 0);
    let days = match month {
        2 => 28 + u32::from(leap),
        4 | 6 | 9 | 11 => 30,
        1..=12 => 31,
        _ => 0,
    };
    (1..=days).contains(&day)
}

#[cfg(test)]
mod tests {
    use super::*;

    const SHIPPED: &str = include_str!("../../../config/consent.md");

    fn shipped() -> ConsentForm {
        ConsentForm::parse(SHIPPED.to_owned(), Path::new("consent.md")).unwrap()
    }

    fn filled() -> ConsentForm {
        shipped().filled(&[
            ("laboratory", "A laboratory"),
            ("contact", "somebody"),
            ("retention_until", "2036-12-31"),
            ("withdrawal_until", "2027-06-30"),
        ])
    }

    const ALL: Ticks = Ticks {
        take_part: true,
        share_data: true,
        share_motion: true,
        contact: true,
    };

    #[test]
    fn shipped_form_says_what_it_has_to() {
        let form = shipped();
        let fields = [
            "laboratory",
            "contact",
            "retention_until",
            "withdrawal_until",
        ];
        assert_eq!(form.unfilled(), fields);
        assert_eq!(form.version, "template-1");
        for needed in [
            "template",
            "epilepsy",
            "balance",
            "Stop",
            "network",
            "health",
            "fingerprint",
        ] {
            assert!(SHIPPED.contains(needed), "{needed}");
        }
        for tick in TICKS {
            let words = form.tick(tick).expect(tick);
            assert!(words.ends_with('.') && !words.contains('`'), "{words}");
        }
        assert!(form.tick("share_data").unwrap().starts_with("My game data"));
        assert_eq!(form.tick("share"), None);
    }

    #[test]
    fn agree_opens_only_to_who_takes_part() {
        let form = filled();
        let refusal = |ticks, date| form.agree(ticks, date).unwrap_err().to_string();
        let not = Ticks {
            take_part: false,
            ..ALL
        };
        assert!(refusal(not, "2026-11-22").contains("\"take part\" is not ticked"));
        let motion = Ticks {
            share_data: false,
            ..ALL
        };
        assert!(refusal(motion, "2026-11-22").contains("motion cannot be shared"));
        for date in [
            "2026-02-29",
            "2100-02-29",
            "2026-13-01",
            "22.11.2026",
            "2026-1-1",
            "2026-11-00",
            "",
        ] {
            assert!(refusal(ALL, date).contains("is no date"), "{date}");
        }
        let consent = form.agree(ALL, "2028-02-29").unwrap();
        assert_eq!(consent.form_sha256, digest::sha256(form.text.as_bytes()));
        let json = serde_json::to_string(&consent).unwrap();
        assert_eq!(serde_json::from_str::<Consent>(&json).unwrap(), consent);
        let only = Ticks {
            take_part: true,
            ..Ticks::default()
        };
        assert!(form.agree(only, "2026-11-22").is_ok());
    }

    #[test]
    fn agree_refuses_a_form_with_empty_fields() {
        let form = shipped().filled(&[("laboratory", "A laboratory"), ("contact", " ")]);
        let error = form.agree(ALL, "2026-11-22").unwrap_err().to_string();
        assert!(
            error.contains("fields contact, retention_until, withdrawal_until"),
            "{error}"
        );
    }

    #[test]
    fn parse_refuses_a_form_without_version_or_with_the_word() {
        let parse = |text: &str| {
            ConsentForm::parse(text.to_owned(), Path::new("c.md"))
                .unwrap_err()
                .to_string()
        };
        assert!(parse("# Form\n").starts_with("c.md has no line \"Version: ...\""));
        assert!(parse("Version: 1\nYour Presence counts.").contains("must not read"));
    }
}
