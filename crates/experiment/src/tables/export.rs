//! A copy for others: only who agreed to it, and motion only of who agreed to that too.

use std::path::{Path, PathBuf};

use super::{Table, Tables, answers, motion, pairs, sessions};
use crate::files::{self, FileError};
use crate::record::{SessionRecord, Task};
use crate::study::{ParticipantId, Study};

/// How a copy is made.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Export {
    /// Motion is copied of who agreed to that; otherwise of nobody.
    pub with_motion: bool,
    /// In which form.
    pub format: Format,
}

/// Form of a copy.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Format {
    /// A BIDS dataset, as in `data/` but without journals.
    Bids,
    /// Flat files with commas and `NA`, keyed by participant, session and run.
    Csv,
}

/// Why there is no copy.
#[derive(Debug, thiserror::Error)]
pub enum ExportError {
    /// A file cannot be written.
    #[error(transparent)]
    File(#[from] FileError),
    /// A copy has a folder of its own.
    #[error("{} is not empty, and nothing in it is overwritten: choose a new or empty folder for the copy", .0.display())]
    NotEmpty(PathBuf),
    /// Within the study an erasure would have to find it.
    #[error("{} lies in the study's own folder: choose one outside it", .0.display())]
    Inside(PathBuf),
}

/// What a copy has.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Exported {
    /// Participants in it.
    pub participants: Vec<ParticipantId>,
    /// Those who did not agree to sharing, and are left out.
    pub left_out: Vec<ParticipantId>,
    /// Those in it without their motion.
    pub without_motion: Vec<ParticipantId>,
}

impl Export {
    /// Writes a copy of these sessions, with motion and events, to a new or empty folder.
    ///
    /// # Errors
    /// When the folder is not fit or a file cannot be written.
    pub fn write(
        self,
        study: &Study,
        records: &[SessionRecord],
        folder: &Path,
    ) -> Result<Exported, ExportError> {
        if lies_in(folder, study.root())? {
            return Err(ExportError::Inside(folder.to_path_buf()));
        }
        files::create_folder(folder)?;
        if std::fs::read_dir(folder)
            .map_err(FileError::at("list", folder))?
            .next()
            .is_some()
        {
            return Err(ExportError::NotEmpty(folder.to_path_buf()));
        }
        let mut shared: Vec<SessionRecord> = records.to_vec();
        shared.sort_by_key(|record| (record.participant.clone(), record.session));
        let mut exported = Exported::default();
        shared.retain(|record| {
            let agreed = record.consent.ticks.share_data;
            note(
                if agreed {
                    &mut exported.participants
                } else {
                    &mut exported.left_out
                },
                record,
            );
            agreed
        });
        let tables = Tables {
            study,
            folder: folder.to_path_buf(),
        };
        for record in &shared {
            let with_motion = self.with_motion && record.consent.ticks.share_motion;
            if !with_motion {
                note(&mut exported.without_motion, record);
            }
            match self.format {
                Format::Bids if with_motion => tables.write_session(record)?,
                Format::Bids => tables.write_recordings(record, false)?,
                Format::Csv if with_motion => tables.write_motion_csv(record)?,
                Format::Csv => {}
            }
        }
        match self.format {
            Format::Bids => tables.write_study(&shared)?,
            Format::Csv => tables.write_csv(&shared)?,
        }
        Ok(exported)
    }
}

/// Whether a folder, which need not be there yet, is another one or lies in it.
fn lies_in(folder: &Path, other: &Path) -> Result<bool, FileError> {
    let place = |path: &Path| path.canonicalize().map_err(FileError::at("find", path));
    let whole = std::path::absolute(folder).map_err(FileError::at("find", folder))?;
    let there = whole.ancestors().find(|path| path.exists());
    Ok(place(there.unwrap_or(folder))?.starts_with(place(other)?))
}

fn note(ids: &mut Vec<ParticipantId>, record: &SessionRecord) {
    if ids.last() != Some(&record.participant) {
        ids.push(record.participant.clone());
    }
}

impl Tables<'_> {
    fn write_motion_csv(&self, record: &SessionRecord) -> Result<(), FileError> {
        for run in &record.runs {
            let mut text = motion::columns().join(",") + "\n";
            text += &motion::motion(run).replace("n/a", "NA").replace('\t', ",");
            let name = format!(
                "motion/{}_ses-{:02}_run-{}.csv",
                record.participant, record.session, run.number
            );
            self.put(&self.folder.join(name), &text)?;
        }
        Ok(())
    }

    fn write_csv(&self, records: &[SessionRecord]) -> Result<(), FileError> {
        let questionnaire = self.study.questionnaire();
        let each_game = self.study.plan().session.items_after_each_game;
        let put = |name: &str, table: &Table| self.put(&self.folder.join(name), &table.csv());
        put(
            "participants.csv",
            &answers::participants(questionnaire, records),
        )?;
        put(
            "presence.csv",
            &answers::presence(questionnaire, each_game, records),
        )?;
        if let Some(plan) = &self.study.plan().staircase {
            put("thresholds.csv", &pairs::thresholds(records, plan))?;
            let mut compared: Option<Table> = None;
            for record in records {
                let Some(pairs) = &record.pairs else { continue };
                let key = [("participant_id", record.participant.to_string())];
                add(&mut compared, pairs::compared(pairs, plan), &key);
            }
            if let Some(compared) = compared {
                put("pairs.csv", &compared)?;
            }
        }
        let mut joined: Option<Table> = None;
        let mut of_sessions: Option<Table> = None;
        for record in records {
            let key = [
                ("participant_id", record.participant.to_string()),
                ("session_id", format!("ses-{:02}", record.session)),
            ];
            add(&mut of_sessions, sessions::sessions(&[record]), &key[..1]);
            for run in &record.runs {
                let game = match run.task {
                    Task::Game { number, .. } => number.to_string(),
                    Task::Pairs => String::new(),
                };
                let run_key = [
                    key[0].clone(),
                    key[1].clone(),
                    ("run", run.number.to_string()),
                    ("game", game),
                ];
                add(&mut joined, motion::events(run), &run_key);
            }
        }
        for (name, table) in [("sessions.csv", of_sessions), ("events.csv", joined)] {
            if let Some(table) = table {
                put(name, &table)?;
            }
        }
        Ok(())
    }
}

/// Adds a table's rows to `all`, with `key` in front of each.
fn add(all: &mut Option<Table>, table: Table, key: &[(&str, String)]) {
    let Table { columns, rows } = table;
    let all = all.get_or_insert_with(|| {
        let front = key.iter().map(|(name, _)| super::Column::new(*name, "key"));
        Table::new(front.chain(columns).collect())
    });
    for row in rows {
        let front = key.iter().map(|(_, value)| value.clone());
        all.push(front.chain(row).collect());
    }
}
