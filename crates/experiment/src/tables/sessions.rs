//! What each session was recorded with: `sub-*/sub-*_sessions.tsv`, and `*_scans.tsv`, which says when each recording began.

use super::{Column, Table, number};
use crate::record::SessionRecord;

/// A row for each session of one participant.
pub(super) fn sessions(records: &[&SessionRecord]) -> Table {
    let mut table = Table::new(vec![
        Column::new("session_id", "session"),
        Column::new("acq_time", "when the session began, UTC"),
        Column::new("status", "how it ended").with_levels([
            ("complete", "both games and all forms"),
            ("partial", "stopped early"),
        ]),
        Column::new("consent_form", "version of the consent form"),
        Column::new("consent_sha256", "SHA-256 of the form's text"),
        Column::new("software_version", "version of the program"),
        Column::new("software_commit", "commit that it was built from"),
        Column::new("seed", "seed of what is random in the session"),
        Column::new("device", "kind of device").with_levels([
            ("headset", "through OpenXR"),
            ("desk", "a screen"),
            ("script", "a simulated participant"),
        ]),
        Column::new("manufacturer", "who made the device, as it says"),
        Column::new("model", "what the device calls itself"),
        Column::new("runtime", "the OpenXR runtime's name and version"),
        Column::new("refresh_rate", "pictures per second").with_units("Hz"),
        Column::new(
            "settings_sha256",
            "salted digest of the settings; salt and settings are kept outside this dataset",
        ),
        Column::new("immersed", "time with the headset on or at the desk").with_units("s"),
    ]);
    for record in records {
        let made = &record.provenance;
        table.push(vec![
            format!("ses-{:02}", record.session),
            record.began.clone(),
            record.status.name().to_owned(),
            record.consent.form_version.clone(),
            record.consent.form_sha256.clone(),
            made.version.clone(),
            made.commit.clone(),
            made.seed.to_string(),
            made.device.clone(),
            made.manufacturer.clone(),
            made.model.clone(),
            made.runtime.clone(),
            number(made.refresh_hz),
            made.settings_digest.clone(),
            number(record.immersed_s),
        ]);
    }
    table
}

/// When each recording of a session began; `file` names a run's recording relative to the session's folder.
pub(super) fn scans(record: &SessionRecord, file: impl Fn(&crate::record::Run) -> String) -> Table {
    let mut table = Table::new(vec![
        Column::new("filename", "recording"),
        Column::new("acq_time", "when it began, UTC"),
    ]);
    for run in &record.runs {
        table.push(vec![file(run), run.began.clone()]);
    }
    table
}
