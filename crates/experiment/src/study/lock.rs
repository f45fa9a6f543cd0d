//! One program at a time changes a study.

use std::fs::{File, OpenOptions, TryLockError};
use std::io::{Read, Seek, Write};
use std::path::PathBuf;

use super::{Study, StudyError};
use crate::files::{self, FileError};

const NAME: &str = "study.lock";

/// The right to change a study, until it is dropped or the program ends, however it ends: the system holds it.
#[derive(Debug)]
pub struct Lock {
    root: PathBuf,
    /// The lock lasts as long as this is open.
    _file: File,
}

impl Study {
    /// Takes the study for this program, and removes drafts that a killed one has left.
    ///
    /// # Errors
    /// When another program has it, or the folder cannot be written.
    pub fn lock(&self) -> Result<Lock, StudyError> {
        let path = self.root.join(NAME);
        let mut options = OpenOptions::new();
        options.read(true).write(true).create(true).truncate(false);
        let mut file = files::private(&mut options)
            .open(&path)
            .map_err(FileError::at("open", &path))?;
        match file.try_lock() {
            Ok(()) => {}
            Err(TryLockError::WouldBlock) => {
                let mut holder = String::new();
                // The number is a help; that there is a holder is certain without it.
                file.read_to_string(&mut holder).ok();
                if holder.trim().is_empty() {
                    holder.push_str("unknown");
                }
                return Err(StudyError::InUse {
                    root: self.root.clone(),
                    holder: holder.trim().to_owned(),
                });
            }
            Err(TryLockError::Error(error)) => {
                return Err(FileError::at("lock", &path)(error).into());
            }
        }
        let note = |file: &mut File| -> std::io::Result<()> {
            file.set_len(0)?;
            file.rewind()?;
            writeln!(file, "{}", std::process::id())
        };
        note(&mut file).map_err(FileError::at("write", &path))?;
        remove_drafts(&self.root)?;
        Ok(Lock {
            root: self.root.clone(),
            _file: file,
        })
    }
}

impl Lock {
    /// # Panics
    /// When it was taken for another study, which is a mistake in the program.
    pub(crate) fn belongs_to(&self, study: &Study) {
        assert_eq!(self.root, study.root, "a lock opens one study");
    }
}

fn remove_drafts(root: &std::path::Path) -> Result<(), FileError> {
    for path in files::list(root)? {
        let name = path
            .file_name()
            .unwrap_or_default()
            .to_string_lossy()
            .into_owned();
        if name.starts_with('.') && name.ends_with(files::DRAFT) {
            files::remove(&path)?;
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::super::tests::create;
    use super::*;

    #[test]
    fn lock_lets_one_in_and_opens_again() {
        let folder = tempfile::tempdir().unwrap();
        let study = create(folder.path(), 18);
        let lock = study.lock().unwrap();
        let error = Study::open(folder.path())
            .unwrap()
            .lock()
            .unwrap_err()
            .to_string();
        assert!(
            error.contains(&format!("(process {})", std::process::id())),
            "{error}"
        );
        drop(lock);
        study.lock().unwrap();
    }

    #[test]
    fn lock_is_not_left_by_a_program_that_was_killed() {
        let folder = tempfile::tempdir().unwrap();
        let study = create(folder.path(), 18);
        // As a killed program leaves them: its number in the file that the system has unlocked, and a draft.
        std::fs::write(folder.path().join(NAME), "4194304000\n").unwrap();
        let draft = files::draft_of(&folder.path().join("data/participants.tsv"));
        std::fs::write(&draft, "torn").unwrap();
        let _lock = study.lock().unwrap();
        assert!(!draft.exists());
        let number = std::fs::read_to_string(folder.path().join(NAME)).unwrap();
        assert_eq!(number.trim(), std::process::id().to_string());
    }
}
