//! The settings of a study's session: they lie with the plan, outside the data, because they would tell the conditions.

use std::path::Path;

use anyhow::{Context, Result, bail};
use experiment::study::{ParticipantId, Study};
use game::Conditions;

use super::{Header, older};

/// The settings that a journal was played with: its own, or those that its study keeps.
///
/// # Errors
/// When the study's are not there.
pub fn of(journal: &Path, header: &Header) -> Result<Conditions> {
    match (&header.conditions, &header.settings_digest) {
        (Some(conditions), _) => Ok(conditions.clone()),
        (None, Some(digest)) => kept(journal, digest),
        (None, None) => bail!(
            "{} line 1: neither settings nor their digest",
            journal.display()
        ),
    }
}

/// What the plan keeps for STUDY/data/sourcedata/PARTICIPANT/SESSION/JOURNAL.
fn kept(journal: &Path, digest: &str) -> Result<Conditions> {
    let (study, participant, session) = place(journal)?;
    let text = study
        .settings_of(&participant, session, digest)?
        .with_context(|| {
            format!(
                "{}: none of the settings in {} has its digest: restore them from a backup",
                journal.display(),
                study.plan_folder().display()
            )
        })?;
    serde_json::from_str(&text)
        .and_then(older::conditions)
        .context("settings that a study keeps cannot be understood")
}

/// The study that a journal lies in, and whose session it is.
///
/// # Errors
/// When it lies in none.
pub fn study_of(journal: &Path) -> Result<(Study, ParticipantId)> {
    let (study, participant, _) = place(journal)?;
    Ok((study, participant))
}

fn place(journal: &Path) -> Result<(Study, ParticipantId, u32)> {
    let (study, participant, session) = folders(journal).with_context(|| {
        format!(
            "{}: the settings of a study's session lie with its plan: leave the journal inside the study's folder",
            journal.display()
        )
    })?;
    Ok((Study::open(&study)?, participant, session))
}

/// The study, participant and session of a journal in a study's folder.
fn folders(journal: &Path) -> Option<(std::path::PathBuf, ParticipantId, u32)> {
    let journal = journal.canonicalize().ok()?;
    let mut folders = journal.ancestors().skip(1);
    let session = folders.next()?.file_name()?.to_str()?;
    let participant = folders.next()?.file_name()?.to_str()?;
    let study = folders.nth(2)?;
    Some((
        study.to_owned(),
        ParticipantId::parse(participant).ok()?,
        session.strip_prefix("ses-")?.parse().ok()?,
    ))
}
