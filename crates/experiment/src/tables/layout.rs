//! Which table lies where.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use serde_json::{Value, json};

use super::{Table, answers, motion, pairs, pretty, sessions};
use crate::files::{self, FileError};
use crate::record::{Run, SessionRecord};
use crate::study::{Lock, Study};

/// Version of the standard that the layout follows.
const BIDS_VERSION: &str = "1.10.0";

/// Writes a study's tables: a session's as soon as it is over, those of all sessions whenever one has changed.
#[derive(Debug)]
pub struct Tables<'a> {
    pub(super) study: &'a Study,
    pub(super) folder: PathBuf,
}

impl<'a> Tables<'a> {
    /// The tables in the study's own `data/`; whoever has the lock may write them from several threads.
    pub fn of(study: &'a Study, lock: &Lock) -> Self {
        lock.belongs_to(study);
        Tables {
            study,
            folder: study.data_folder(),
        }
    }

    /// Writes the tables of one session: motion, channels and events of each run, and when each began.
    ///
    /// # Errors
    /// When a file cannot be written.
    pub fn write_session(&self, record: &SessionRecord) -> Result<(), FileError> {
        self.write_recordings(record, true)?;
        let (folder, stem) = self.session(record);
        let table = sessions::scans(record, |run| {
            format!("motion/{stem}_{}_motion.tsv", suffix(record, run))
        });
        if record.runs.is_empty() {
            // A table of recordings without any is none.
            return files::remove(&folder.join(format!("{stem}_scans.tsv")));
        }
        self.put(&folder.join(format!("{stem}_scans.tsv")), &table.tsv())
    }

    /// Writes the tables of all sessions from their records, which need no motion and no events ([`SessionRecord::summary`]).
    ///
    /// # Errors
    /// When a file cannot be written.
    pub fn write_study(&self, records: &[SessionRecord]) -> Result<(), FileError> {
        let mut records: Vec<SessionRecord> = records.to_vec();
        // The order of arrival is in nothing that is shared.
        records.sort_by_key(|record| (record.participant.clone(), record.session));
        let questionnaire = self.study.questionnaire();
        let each_game = self.study.plan().session.items_after_each_game;
        let participants = answers::participants(questionnaire, &records);
        self.put_with_dictionary(
            "participants",
            &participants,
            Value::Object(participants.dictionary()),
        )?;
        let presence = answers::presence(questionnaire, each_game, &records);
        let dictionary = answers::presence_dictionary(questionnaire, &presence);
        self.put_with_dictionary("phenotype/presence", &presence, dictionary)?;
        self.put(
            &self.folder.join(match self.study.plan().staircase {
                Some(_) => "task-pairs_events.json",
                None => "task-bowling_events.json",
            }),
            &pretty(&motion::events_dictionary()),
        )?;
        if let Some(plan) = &self.study.plan().staircase {
            let thresholds = pairs::thresholds(&records, plan);
            let mut dictionary = thresholds.dictionary();
            dictionary.insert(
                "MeasurementToolMetadata".to_owned(),
                json!({ "Description": "pairs of throws that were called same or different" }),
            );
            self.put_with_dictionary(
                "phenotype/thresholds",
                &thresholds,
                Value::Object(dictionary),
            )?;
        }
        for of_one in records.chunk_by(|a, b| a.participant == b.participant) {
            let id = &of_one[0].participant;
            let table = sessions::sessions(&of_one.iter().collect::<Vec<_>>());
            self.put_with_dictionary(
                &format!("{id}/{id}_sessions"),
                &table,
                Value::Object(table.dictionary()),
            )?;
        }
        self.put(
            &self.folder.join("dataset_description.json"),
            &pretty(&self.description(&records)),
        )?;
        self.put(&self.folder.join("README.md"), &self.readme(records.len()))
    }

    /// Motion, channels and events of each run; without motion the events alone, as behaviour.
    pub(super) fn write_recordings(
        &self,
        record: &SessionRecord,
        with_motion: bool,
    ) -> Result<(), FileError> {
        let (session, stem) = self.session(record);
        let system = system(record);
        if let (Some(plan), Some(pairs)) = (&self.study.plan().staircase, &record.pairs) {
            let table = pairs::compared(pairs, plan);
            let path = |end: &str| session.join(format!("beh/{stem}_task-pairs_beh.{end}"));
            let mut dictionary = table.dictionary();
            dictionary.insert("TaskName".to_owned(), "pairs".into());
            self.put(&path("tsv"), &table.tsv())?;
            self.put(&path("json"), &pretty(&Value::Object(dictionary)))?;
        }
        for run in &record.runs {
            let events = motion::events(run).tsv();
            if !with_motion {
                let name = format!(
                    "beh/{stem}_task-{}_run-{}_events.tsv",
                    run.task.name(),
                    run.number
                );
                self.put(&session.join(name), &events)?;
                continue;
            }
            let path =
                |end: &str| session.join(format!("motion/{stem}_{}_{end}", suffix(record, run)));
            self.put(&path("motion.tsv"), &motion::motion(run))?;
            self.put(
                &path("motion.json"),
                &pretty(&motion::motion_dictionary(record, run, system)),
            )?;
            self.put(&path("channels.tsv"), &motion::channels().tsv())?;
            self.put(
                &path("channels.json"),
                &pretty(&motion::channels_dictionary()),
            )?;
            self.put(&path("events.tsv"), &events)?;
        }
        Ok(())
    }

    /// The session's folder, and what its files' names begin with.
    fn session(&self, record: &SessionRecord) -> (PathBuf, String) {
        let (id, session) = (&record.participant, format!("ses-{:02}", record.session));
        let folder = self.folder.join(id.to_string()).join(&session);
        (folder, format!("{id}_{session}"))
    }

    fn put_with_dictionary(
        &self,
        stem: &str,
        table: &Table,
        dictionary: Value,
    ) -> Result<(), FileError> {
        self.put(&self.folder.join(format!("{stem}.tsv")), &table.tsv())?;
        self.put(
            &self.folder.join(format!("{stem}.json")),
            &pretty(&dictionary),
        )
    }

    pub(super) fn put(&self, path: &Path, text: &str) -> Result<(), FileError> {
        files::create_folder(path.parent().expect("a table lies in a folder"))?;
        files::write(path, text.as_bytes())
    }

    fn description(&self, records: &[SessionRecord]) -> Value {
        let programs: BTreeSet<(&str, &str)> = records
            .iter()
            .map(|record| {
                (
                    record.provenance.version.as_str(),
                    record.provenance.commit.as_str(),
                )
            })
            .collect();
        let programs: Vec<Value> = programs
            .into_iter()
            .map(|(version, commit)| json!({ "Name": "bowling", "Version": version, "Description": format!("commit {commit}") }))
            .collect();
        let about = &self.study.plan().about;
        let mut description = json!({
            "Name": about.title,
            "BIDSVersion": BIDS_VERSION,
            "DatasetType": "raw",
        });
        if !about.laboratory.is_empty() {
            description["Authors"] = json!([about.laboratory]);
        }
        if !programs.is_empty() {
            description["GeneratedBy"] = Value::Array(programs);
        }
        description
    }

    fn readme(&self, sessions: usize) -> String {
        let plan = self.study.plan();
        let runs = match plan.staircase {
            Some(_) => "one run for all pairs",
            None => "one run for each game",
        };
        let what = if plan.staircase.is_some() {
            "Each participant compared pairs of throws that differ in one parameter of how objects collide, and\n\
             said whether they felt the same; what they came to is in phenotype/thresholds.tsv, the pairs in sub-*/ses-*/beh."
        } else {
            "Each participant played two games, one after pressing the Red button and one after the Blue, under two\n\
             conditions that differ in how objects collide. Which condition a button meant is in the study's allocation, which is kept\n\
             outside this dataset; `slot` in participants.tsv joins the two."
        };
        format!(
            "# {}\n\n\
             {sessions} sessions of a bowling experiment in a virtual room, after S. Uno and M. Slater (1997), *The Sensitivity of Presence to\n\
             Collision Response*. {what}\n\n\
             - participants.tsv: a row for each participant; what was asked before the games.\n\
             - phenotype/presence.tsv: a row for each session; what was asked between and after the games.\n\
             - sub-*/sub-*_sessions.tsv: what each session was recorded with.\n\
             - sub-*/ses-*/motion: head and hand at the rate of the display, and what happened; {runs}.\n\
             - sourcedata: the journals that all tables were made from.\n\n\
             Column names are explained in the .json file beside each table or at the top of the dataset. Missing values are `n/a`. World\n\
             frame: +x to the bowler's right, +y up, the lane along -z, origin at the middle of the foul line; metres, seconds, unit\n\
             quaternions x, y, z, w. Ids are random and no names were recorded. Recordings of motion can identify a person to somebody\n\
             who has another recording of the same person: handle them as personal data.\n\n\
             Games had {} bowling frames. Journals are told from tables by being exact: tables can be made again from them.\n",
            plan.about.title, plan.session.frames_per_game
        )
    }
}

/// The tracking system as names have it.
fn system(record: &SessionRecord) -> &'static str {
    match record.provenance.device.as_str() {
        "headset" => "hmd",
        "desk" => "desk",
        _ => "script",
    }
}

fn suffix(record: &SessionRecord, run: &Run) -> String {
    format!(
        "task-{}_tracksys-{}_run-{}",
        run.task.name(),
        system(record),
        run.number
    )
}
