//! Why something with a study cannot be done.

use std::path::PathBuf;

use super::ParticipantId;
use crate::consent::ConsentError;
use crate::files::FileError;
use crate::plan::PlanError;
use crate::questionnaire::QuestionnaireError;

/// Why something with a study cannot be done.
#[derive(Debug, thiserror::Error)]
pub enum StudyError {
    /// A file or folder cannot be read or written.
    #[error(transparent)]
    File(#[from] FileError),
    /// The plan cannot be used.
    #[error(transparent)]
    Plan(#[from] PlanError),
    /// The questionnaire cannot be used.
    #[error(transparent)]
    Questionnaire(#[from] QuestionnaireError),
    /// The consent form cannot be used.
    #[error(transparent)]
    Consent(#[from] ConsentError),
    /// There is no study in the folder.
    #[error("{} is no study: it has no plan/study.toml; make one with `bowling study new`", .0.display())]
    NotAStudy(PathBuf),
    /// A new study needs a folder of its own.
    #[error("{} is not empty, and nothing in it is overwritten: choose a new or empty folder", .0.display())]
    NotEmpty(PathBuf),
    /// A file that never changes was changed.
    #[error("{} was changed since the study was made: restore it from a backup, or make a new study for a new plan", .0.display())]
    Changed(PathBuf),
    /// Another program has the study.
    #[error("the study in {} is in use by another program (process {holder}): wait until it has ended, or end it", root.display())]
    InUse {
        /// The study's folder.
        root: PathBuf,
        /// Number of that process, as it wrote it down.
        holder: String,
    },
    /// No slot is free.
    #[error(
        "all {0} slots of the plan are taken: make a study with more participants, or erase one who withdrew"
    )]
    Full(u32),
    /// There is no such participant.
    #[error("no participant of this study is called {0}: `bowling study status` lists them")]
    Unknown(String),
    /// A text that is no id.
    #[error("{0:?} is no participant's id: it looks like sub-p7k2")]
    NotAnId(String),
    /// A register has a line that is none.
    #[error("{} line {line} is not as this program writes it: restore the file from a backup", path.display())]
    Register {
        /// Which file.
        path: PathBuf,
        /// Line, from 1.
        line: usize,
    },
    /// Somebody has to be named.
    #[error(
        "{0}: say who it is with a word or name, without commas and line breaks, and without a participant's id"
    )]
    Who(&'static str),
    /// Something of an erased participant is left in files that this program did not write.
    #[error(
        "{id} is still named in {}: this program did not write these files and does not edit them, so remove it there and erase again",
        paths(files)
    )]
    Traces {
        /// The participant.
        id: ParticipantId,
        /// The files.
        files: Vec<PathBuf>,
    },
}

fn paths(files: &[PathBuf]) -> String {
    let names: Vec<String> = files
        .iter()
        .map(|path| path.display().to_string())
        .collect();
    names.join(", ")
}
