//! `bowling study`: an experiment from its plan to its tables.
//!
//! `seat` turns a slot of the plan into the settings of a session, `gate` asks for consent, `run` plays it, `attendant` answers or asks what is
//! due, `experimenter` is what terminal and window say and understand, `tables` makes every table from the journals.

mod approaches;
pub mod attendant;
pub(crate) mod board;
mod console;
pub mod experimenter;
pub(crate) mod folder;
mod form;
mod gate;
mod manage;
mod pane;
mod record;
mod run;
pub mod seat;
mod simulate;
mod tables;

use std::collections::hash_map::RandomState;
use std::hash::{BuildHasher, Hasher};
use std::path::Path;
use std::time::SystemTime;

use anyhow::Result;

use crate::args::{StudyArguments, StudyCommand};
use crate::output;

/// Does with a study what the arguments say, with the data in `root`.
///
/// # Errors
/// One sentence for everything that keeps it from being done.
pub fn study(arguments: &StudyArguments, root: &Path) -> Result<()> {
    match &arguments.command {
        StudyCommand::New(new) => manage::new(new, root),
        StudyCommand::Verify(study) => manage::verify(&study.folder),
        StudyCommand::Run(run) => run::run(run, root),
        StudyCommand::Resume(resume) => run::resume(resume, root),
        StudyCommand::Status(study) => manage::status(&study.folder),
        StudyCommand::Rebuild(study) => tables::rebuild(&study.folder),
        StudyCommand::Unblind(unblind) => manage::unblind(unblind),
        StudyCommand::Erase(erase) => manage::erase(erase),
        StudyCommand::Export(export) => manage::export(export),
        StudyCommand::Simulate(simulate) => simulate::simulate(simulate, root),
    }
}

/// 64 bits that nobody can guess: the system's own, as the standard library draws them for its tables.
fn entropy() -> u64 {
    RandomState::new().build_hasher().finish()
}

/// Now, in Coordinated Universal Time: `YYYY-MM-DDThh:mm:ssZ`.
fn utc_now() -> String {
    output::utc_time(SystemTime::now())
}

/// Today, in Coordinated Universal Time: `YYYY-MM-DD`.
fn today() -> String {
    utc_now().chars().take(10).collect()
}
