//! The settings of a study's session: they lie with the plan, outside the data, because they would tell the conditions.

use std::fs;
use std::path::{Path, PathBuf};

use anyhow::{Context, Result, bail};
use experiment::digest;
use game::Conditions;
use serde::{Deserialize, Serialize};

use super::Header;

/// What a plan keeps of one session's settings.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct KeptSettings {
    /// Drawn once for each session, so that equal settings have different digests.
    pub salt: String,
    /// Resolved settings of the room and of both conditions.
    pub conditions: Conditions,
}

impl KeptSettings {
    /// Salted SHA-256 of the settings, as a journal's header gives it.
    ///
    /// # Errors
    /// When the settings cannot be written as JSON.
    pub fn digest(&self) -> Result<String> {
        let text = serde_json::to_string(&self.conditions)
            .context("the settings cannot be written as JSON")?;
        Ok(digest::salted(&self.salt, &text))
    }
}

/// The plan's file for the session whose journal is `journal`: STUDY/data/sourcedata/SUB/SES/JOURNAL.
fn kept_at(journal: &Path) -> Option<PathBuf> {
    let journal = journal.canonicalize().ok()?;
    let mut folders = journal.ancestors().skip(1);
    let session = folders.next()?.file_name()?.to_str()?;
    let participant = folders.next()?.file_name()?.to_str()?;
    let study = folders.nth(2)?;
    Some(kept_in(study, participant, session))
}

/// The file in a study's plan for one session.
pub fn kept_in(study: &Path, participant: &str, session: &str) -> PathBuf {
    let name = format!("{participant}_{session}.json");
    study.join("plan").join("settings").join(name)
}

/// The settings that a journal was played with: its own, or those that its study keeps.
///
/// # Errors
/// When the study's are not there, or are not those that were played.
pub fn of(journal: &Path, header: &Header) -> Result<Conditions> {
    if let Some(conditions) = &header.conditions {
        return Ok(conditions.clone());
    }
    let Some(digest) = &header.settings_digest else {
        bail!(
            "{} line 1: neither settings nor their digest",
            journal.display()
        );
    };
    let path = kept_at(journal).with_context(|| {
        format!(
            "{}: the settings of a study's session lie with its plan: leave the journal inside the study's folder",
            journal.display()
        )
    })?;
    let text = fs::read_to_string(&path).with_context(|| {
        format!(
            "cannot read {}, which holds the settings of {}",
            path.display(),
            journal.display()
        )
    })?;
    let kept: KeptSettings = serde_json::from_str(&text)
        .with_context(|| format!("{} cannot be understood", path.display()))?;
    if kept.digest()? != *digest {
        bail!(
            "{} was changed: its digest is not the one in {}",
            path.display(),
            journal.display()
        );
    }
    Ok(kept.conditions)
}
