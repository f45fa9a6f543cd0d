//! A study's folder: what was decided, who has which slot, and where data go.
//!
//! `plan/` is for the experimenter's eyes: allocation, who has which slot, consents, logs. `data/` can be shared: nothing in it says
//! which condition a button meant. What the plan decided is fixed when the study is made, and `plan/SHA256SUMS` shows a changed byte.

mod erase;
mod error;
mod fixed;
mod ids;
mod lock;
mod register;

use std::fs;
use std::path::{Path, PathBuf};

use crate::consent::ConsentForm;
use crate::digest;
use crate::files::{self, FileError};
use crate::plan::{Plan, Row, allocation_csv};
use crate::questionnaire::Questionnaire;
use crate::random::SplitMix64;

pub use erase::Erased;
pub use error::StudyError;
use fixed::FIXED;
pub use ids::{ParticipantId, fresh_id};
pub use lock::Lock;
pub use register::Assignment;

/// An opened study.
#[derive(Debug, Clone)]
pub struct Study {
    root: PathBuf,
    plan: Plan,
    rows: Vec<Row>,
    questionnaire: Questionnaire,
    consent_form: ConsentForm,
    salt: String,
}

impl Study {
    /// Makes a study in `root`, which is new or empty. `consent` is the form with its fields filled in as far as they are known;
    /// `entropy` is 64 bits that nobody can guess.
    ///
    /// # Errors
    /// When the folder holds anything, cannot be written, or a text cannot be used; nothing is left behind then.
    pub fn create(
        root: &Path,
        plan: &Plan,
        rows: &[Row],
        questionnaire: &str,
        consent: &str,
        entropy: u64,
    ) -> Result<Study, StudyError> {
        // What cannot be used later must not begin.
        Questionnaire::parse(questionnaire, Path::new("the questionnaire"))?;
        ConsentForm::parse(consent.to_owned(), Path::new("the consent form"))?;
        let csv = allocation_csv(&plan.design(), rows);
        plan.parse_allocation(&csv)?;
        let is_new = !root.exists();
        if !is_new
            && fs::read_dir(root)
                .map_err(FileError::at("list", root))?
                .next()
                .is_some()
        {
            return Err(StudyError::NotEmpty(root.to_path_buf()));
        }
        let salt = format!("{:016x}", SplitMix64::new(entropy).next_u64());
        let texts = [
            plan.to_toml(),
            csv,
            questionnaire.to_owned(),
            consent.to_owned(),
            salt,
        ];
        if let Err(error) = fixed::write(root, &texts) {
            // Only what was just made is in the folder.
            let made = if is_new {
                vec![root.to_path_buf()]
            } else {
                vec![root.join("plan"), root.join("data")]
            };
            for folder in made {
                files::remove(&folder).ok();
            }
            return Err(error.into());
        }
        Study::open(root)
    }

    /// Opens a study for reading; what changes it asks for a [`Lock`].
    ///
    /// # Errors
    /// When there is none, another version made it, or a file that never changes was changed.
    pub fn open(root: &Path) -> Result<Study, StudyError> {
        let folder = root.join("plan");
        if !folder.join("study.toml").is_file() {
            return Err(StudyError::NotAStudy(root.to_path_buf()));
        }
        let texts = fixed::read(&folder)?;
        let [plan, allocation, questionnaire, consent, salt] = texts;
        let plan = Plan::parse(&plan, &folder.join(FIXED[0]))?;
        Ok(Study {
            rows: plan.parse_allocation(&allocation)?,
            questionnaire: Questionnaire::parse(&questionnaire, &folder.join(FIXED[2]))?,
            consent_form: ConsentForm::parse(consent, &folder.join(FIXED[3]))?,
            root: root.to_path_buf(),
            plan,
            salt,
        })
    }

    /// The study's folder.
    pub fn root(&self) -> &Path {
        &self.root
    }

    /// What can be shared: a dataset in BIDS.
    pub fn data_folder(&self) -> PathBuf {
        self.root.join("data")
    }

    /// What cannot: allocation, register, consents, logs.
    pub fn plan_folder(&self) -> PathBuf {
        self.root.join("plan")
    }

    /// Where a session's journal lies.
    pub fn journal_folder(&self, participant: &ParticipantId, session: u32) -> PathBuf {
        let folder = self.data_folder().join("sourcedata");
        folder
            .join(participant.to_string())
            .join(format!("ses-{session:02}"))
    }

    /// What was decided.
    pub fn plan(&self) -> &Plan {
        &self.plan
    }

    /// What is asked.
    pub fn questionnaire(&self) -> &Questionnaire {
        &self.questionnaire
    }

    /// What participants agree to.
    pub fn consent_form(&self) -> &ConsentForm {
        &self.consent_form
    }

    /// The row of a slot, for the program that runs the session and tells nobody. Whoever wants to read it uses [`Study::unblind`].
    ///
    /// # Panics
    /// When the plan has no such slot.
    pub fn row(&self, slot: u32) -> &Row {
        &self.rows[slot as usize - 1]
    }

    /// Every row, for counting the balance; see [`Study::row`].
    pub fn rows(&self) -> &[Row] {
        &self.rows
    }

    /// What a session records of its resolved settings: SHA-256 over the study's salt, the session and the text.
    ///
    /// The session is part of it, or equal digests would tell which participants met the same conditions.
    pub fn settings_digest(
        &self,
        participant: &ParticipantId,
        session: u32,
        settings: &str,
    ) -> String {
        digest::salted(
            &self.salt,
            &format!("\n{participant} {session}\n{settings}"),
        )
    }

    /// Keeps resolved settings with the allocation, once however many sessions use them; returns their file.
    ///
    /// # Errors
    /// When it cannot be written.
    pub fn keep_settings(&self, lock: &Lock, settings: &str) -> Result<PathBuf, StudyError> {
        lock.belongs_to(self);
        let folder = self.settings_folder();
        files::create_folder(&folder)?;
        let path = folder.join(format!("{}.json", digest::sha256(settings.as_bytes())));
        if !path.exists() {
            files::write(&path, settings.as_bytes())?;
        }
        Ok(path)
    }

    /// The settings that a session's digest belongs to; `None` when none of those that are kept fit.
    ///
    /// # Errors
    /// When they cannot be read.
    pub fn settings_of(
        &self,
        participant: &ParticipantId,
        session: u32,
        digest: &str,
    ) -> Result<Option<String>, StudyError> {
        for path in files::list(&self.settings_folder())? {
            let settings = files::read(&path)?;
            if self.settings_digest(participant, session, &settings) == digest {
                return Ok(Some(settings));
            }
        }
        Ok(None)
    }

    fn settings_folder(&self) -> PathBuf {
        self.plan_folder().join("settings")
    }

    /// What a tombstone and nothing else says of a participant.
    fn id_hash(&self, id: &ParticipantId) -> String {
        digest::salted(&self.salt, &format!("\n{id}"))
    }
}

#[cfg(test)]
pub(crate) mod tests {
    use super::fixed::SUMS;
    use super::*;
    use crate::plan::{Scheme, SessionRules};
    use std::os::unix::fs::PermissionsExt;

    pub(crate) const QUESTIONNAIRE: &str = include_str!("../../../config/questionnaire.toml");
    pub(crate) const CONSENT: &str = include_str!("../../../config/consent.md");

    pub(crate) fn create(root: &Path, subjects: u32) -> Study {
        create_with(root, subjects, SessionRules::default()).unwrap()
    }

    pub(crate) fn create_with(
        root: &Path,
        subjects: u32,
        rules: SessionRules,
    ) -> Result<Study, StudyError> {
        let about = crate::plan::about_for_tests();
        let fields = [
            ("laboratory", about.laboratory.as_str()),
            ("contact", &about.contact),
            ("retention_until", &about.retention_until),
            ("withdrawal_until", &about.withdrawal_until),
        ];
        let form = ConsentForm::parse(CONSENT.to_owned(), Path::new("consent.md"))
            .unwrap()
            .filled(&fields);
        let (plan, rows) =
            Plan::new(&Scheme::Table2, subjects, 1997, about.clone(), rules).unwrap();
        Study::create(root, &plan, &rows, QUESTIONNAIRE, &form.text, 7)
    }

    #[test]
    fn create_makes_what_open_reads() {
        let folder = tempfile::tempdir().unwrap();
        let root = folder.path().join("a/study");
        let made = create(&root, 18);
        let opened = Study::open(&root).unwrap();
        assert_eq!((opened.plan(), opened.rows()), (made.plan(), made.rows()));
        assert_eq!(opened.consent_form().unfilled(), Vec::<String>::new());
        for path in files::list(&root).unwrap() {
            let mode = fs::metadata(&path).unwrap().permissions().mode();
            assert_eq!(mode & 0o777, 0o600, "{}", path.display());
        }
        let mode = fs::metadata(root.join("plan"))
            .unwrap()
            .permissions()
            .mode();
        assert_eq!(mode & 0o777, 0o700);
        let error = create_with(&root, 18, SessionRules::default())
            .unwrap_err()
            .to_string();
        assert!(error.contains("nothing in it is overwritten"), "{error}");
    }

    #[test]
    fn open_names_every_changed_byte() {
        let folder = tempfile::tempdir().unwrap();
        create(folder.path(), 18);
        for name in FIXED.iter().chain([&SUMS]) {
            let path = folder.path().join("plan").join(name);
            let whole = fs::read(&path).unwrap();
            // Every byte of the plan, and a seventh of the others: prime to any line length.
            let stride = if *name == "study.toml" { 1 } else { 7 };
            for at in (0..whole.len()).step_by(stride) {
                let mut bytes = whole.clone();
                bytes[at] ^= 1 << (at % 8);
                fs::write(&path, &bytes).unwrap();
                let error = Study::open(folder.path()).unwrap_err().to_string();
                assert!(
                    error.contains("was changed since the study was made"),
                    "{name} {at}: {error}"
                );
            }
            fs::write(&path, &whole).unwrap();
        }
        Study::open(folder.path()).unwrap();
        fs::remove_file(folder.path().join("plan/salt")).unwrap();
        let error = Study::open(folder.path()).unwrap_err().to_string();
        assert!(
            error.starts_with("cannot read ") && error.contains("salt"),
            "{error}"
        );
    }

    #[test]
    fn open_refuses_folders_that_are_none() {
        let folder = tempfile::tempdir().unwrap();
        let error = Study::open(folder.path()).unwrap_err().to_string();
        assert!(error.contains("is no study"), "{error}");
        let error = Study::open(&folder.path().join("none"))
            .unwrap_err()
            .to_string();
        assert!(error.contains("is no study"), "{error}");
    }

    #[test]
    fn create_that_fails_leaves_nothing() {
        let folder = tempfile::tempdir().unwrap();
        let root = folder.path().join("file/study");
        fs::write(
            folder.path().join("file"),
            "a file where a folder should be",
        )
        .unwrap();
        create_with(&root, 18, SessionRules::default()).unwrap_err();
        assert_eq!(
            files::list(folder.path()).unwrap(),
            [folder.path().join("file")]
        );
    }

    #[test]
    fn settings_are_found_by_a_digest_that_does_not_tell_who_met_the_same() {
        let folder = tempfile::tempdir().unwrap();
        let study = create(folder.path(), 18);
        let [a, b] = ["sub-p7k2", "sub-q4zx"].map(|id| ParticipantId::parse(id).unwrap());
        let digest = |id| study.settings_digest(id, 1, "{}");
        assert_eq!(digest(&a), digest(&a));
        assert_ne!(digest(&a), digest(&b));
        assert_ne!(digest(&a), study.settings_digest(&a, 2, "{}"));
        let lock = study.lock().unwrap();
        let first = study.keep_settings(&lock, "{}").unwrap();
        assert_eq!(study.keep_settings(&lock, "{}").unwrap(), first);
        study.keep_settings(&lock, "[]").unwrap();
        let found = |id| study.settings_of(id, 1, &digest(&b)).unwrap();
        assert_eq!(
            (found(&b).as_deref(), found(&a).as_deref()),
            (Some("{}"), None)
        );
    }
}
