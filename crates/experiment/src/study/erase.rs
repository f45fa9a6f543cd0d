//! Erasing a participant: every file, row, journal and draft, until a search of the whole folder finds nothing.

use std::fs;
use std::path::{Path, PathBuf};

use super::register::{ASSIGNMENTS, TOMBSTONES, TOMBSTONES_HEADING};
use super::{Lock, ParticipantId, Study, StudyError};
use crate::files::{self, FileError};

/// What an erasure did.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Erased {
    /// Files and folders that are gone.
    pub removed: Vec<PathBuf>,
    /// Tables and registers that have lost rows.
    pub shortened: Vec<PathBuf>,
    /// The slot that is free again; `None` when an earlier attempt freed it.
    pub slot: Option<u32>,
}

impl Study {
    /// Erases all that the study's folder has of a participant, leaves a tombstone (`when`, a salted hash of the id, `who`), frees the
    /// slot, and proves by a search that nothing is left. One that was interrupted is repeated.
    ///
    /// What disks keep of removed files, backups elsewhere and copies that were exported are out of its reach.
    ///
    /// # Errors
    /// When there is no such participant, nobody is named, a file cannot be changed, or a foreign file names the participant.
    pub fn erase(
        &self,
        lock: &Lock,
        id: &ParticipantId,
        who: &str,
        when: &str,
    ) -> Result<Erased, StudyError> {
        lock.belongs_to(self);
        let unfit = |text: &str| {
            text.trim().is_empty() || text.contains([',', '\n', '\r']) || has(text.as_bytes(), id)
        };
        if unfit(who) || unfit(when) {
            return Err(StudyError::Who("an erasure is written down"));
        }
        let slot = self.slot_of(id).ok();
        let traces = traces(self.root(), id)?;
        if slot.is_none() && traces.is_empty() {
            return Err(StudyError::Unknown(id.to_string()));
        }
        let mut erased = Erased {
            removed: Vec::new(),
            shortened: Vec::new(),
            slot,
        };
        let register = self.plan_folder().join(ASSIGNMENTS);
        for path in traces.into_iter().filter(|path| *path != register) {
            self.erase_from(path, id, &mut erased)?;
        }
        // The register last: as long as it names the participant, an interrupted erasure can be repeated.
        let left = self.left(id, &register)?;
        if !left.is_empty() {
            return Err(StudyError::Traces {
                id: id.clone(),
                files: left,
            });
        }
        let hash = self.id_hash(id);
        if !self.erased()?.contains(&hash) {
            self.append(
                lock,
                TOMBSTONES,
                TOMBSTONES_HEADING,
                &format!("{when},{hash},{who}"),
            )?;
        }
        if register.exists() {
            drop_rows(&register, id)?;
            erased.shortened.push(register.clone());
        }
        match self.left(id, Path::new(""))? {
            left if left.is_empty() => Ok(erased),
            files => Err(StudyError::Traces {
                id: id.clone(),
                files,
            }),
        }
    }

    fn left(&self, id: &ParticipantId, but: &Path) -> Result<Vec<PathBuf>, StudyError> {
        let traces = traces(self.root(), id)?;
        Ok(traces.into_iter().filter(|path| path != but).collect())
    }

    fn erase_from(
        &self,
        path: PathBuf,
        id: &ParticipantId,
        erased: &mut Erased,
    ) -> Result<(), FileError> {
        if named(&path, id) {
            files::remove(&path)?;
            erased.removed.push(path);
        } else if is_table(&path) {
            drop_rows(&path, id)?;
            erased.shortened.push(path);
        }
        Ok(())
    }
}

/// Files and folders below `folder` that name the participant in their name or content, the outermost of each branch.
fn traces(folder: &Path, id: &ParticipantId) -> Result<Vec<PathBuf>, FileError> {
    let mut found = Vec::new();
    let entries = fs::read_dir(folder).map_err(FileError::at("list", folder))?;
    let mut paths = entries
        .map(|entry| entry.map(|entry| entry.path()))
        .collect::<Result<Vec<_>, _>>()
        .map_err(FileError::at("list", folder))?;
    paths.sort();
    for path in paths {
        let kind = fs::symlink_metadata(&path).map_err(FileError::at("look at", &path))?;
        if named(&path, id) {
            found.push(path);
        } else if kind.is_dir() {
            found.extend(traces(&path, id)?);
        } else if kind.is_file() && has(&fs::read(&path).map_err(FileError::at("read", &path))?, id)
        {
            found.push(path);
        }
    }
    Ok(found)
}

fn named(path: &Path, id: &ParticipantId) -> bool {
    let name = path.file_name().unwrap_or_default();
    has(name.to_string_lossy().as_bytes(), id)
}

/// Whether the id's four characters stand there as a word, with or without `sub-`.
fn has(bytes: &[u8], id: &ParticipantId) -> bool {
    let label = id.label().as_bytes();
    let is_word = |at: usize| {
        let before = at.checked_sub(1).map(|before| bytes[before]);
        let after = bytes.get(at + label.len()).copied();
        [before, after]
            .into_iter()
            .flatten()
            .all(|byte| !byte.is_ascii_alphanumeric())
    };
    bytes
        .windows(label.len())
        .enumerate()
        .any(|(at, window)| window == label && is_word(at))
}

/// Whether a file has a row for each thing, so that rows can go: `.tsv`, `.csv`, and what editors keep of such.
fn is_table(path: &Path) -> bool {
    let name = path
        .file_name()
        .unwrap_or_default()
        .to_string_lossy()
        .into_owned();
    [".tsv", ".csv"].iter().any(|end| name.contains(end))
}

fn drop_rows(path: &Path, id: &ParticipantId) -> Result<(), FileError> {
    let bytes = fs::read(path).map_err(FileError::at("read", path))?;
    let lines = bytes.split_inclusive(|byte| *byte == b'\n');
    let kept: Vec<u8> = lines
        .filter(|line| !has(line, id))
        .flatten()
        .copied()
        .collect();
    files::write(path, &kept)
}

#[cfg(test)]
mod tests {
    use super::super::tests::create;
    use super::*;
    use crate::consent::Ticks;

    fn text(path: &Path) -> String {
        fs::read_to_string(path).unwrap()
    }

    /// A study with two participants and something of both everywhere.
    fn study_of_two(root: &Path) -> (Study, Vec<ParticipantId>) {
        let study = create(root, 18);
        let lock = study.lock().unwrap();
        let ids: Vec<ParticipantId> = (1..3)
            .map(|entropy| study.admit(&lock, entropy).unwrap().participant)
            .collect();
        let ticks = Ticks {
            take_part: true,
            ..Ticks::default()
        };
        let consent = study.consent_form().agree(ticks, "2026-11-22").unwrap();
        let data = study.data_folder();
        for id in &ids {
            study.record_consent(&lock, id, &consent).unwrap();
            let folder = study.journal_folder(id, 1);
            files::create_folder(&folder).unwrap();
            files::append_line(
                &folder.join("session.jsonl"),
                &format!("{{\"sub\":\"{id}\"}}"),
            )
            .unwrap();
            let motion = data.join(format!("{id}/ses-01/motion"));
            files::create_folder(&motion).unwrap();
            files::append_line(&motion.join(format!("{id}_ses-01_motion.tsv")), "0.0").unwrap();
            for table in ["participants.tsv", "participants.tsv~"] {
                files::append_line(&data.join(table), &format!("{id}\t1")).unwrap();
            }
        }
        (study, ids)
    }

    #[test]
    fn erase_leaves_no_trace_and_frees_the_slot() {
        let folder = tempfile::tempdir().unwrap();
        let (study, ids) = study_of_two(folder.path());
        let lock = study.lock().unwrap();
        let erased = study
            .erase(&lock, &ids[0], "the experimenter", "2026-11-23T09:00:00Z")
            .unwrap();
        assert_eq!(erased.slot, Some(1));
        // The search of another hand: the four characters anywhere, in names and bytes.
        let needle = ids[0].label().as_bytes();
        for path in files::list(folder.path()).unwrap() {
            assert!(
                !path.to_string_lossy().contains(ids[0].label()),
                "{}",
                path.display()
            );
            let bytes = fs::read(&path).unwrap();
            assert!(
                !bytes.windows(4).any(|window| window == needle),
                "{}",
                path.display()
            );
        }
        let participants = text(&study.data_folder().join("participants.tsv"));
        assert_eq!(participants, format!("{}\t1\n", ids[1]));
        let tombstones = text(&study.plan_folder().join(TOMBSTONES));
        let line = tombstones.lines().nth(1).unwrap();
        assert!(
            line.starts_with("2026-11-23T09:00:00Z,") && line.ends_with(",the experimenter"),
            "{line}"
        );
        assert_eq!(tombstones.lines().count(), 2);
        assert_eq!(study.admit(&lock, 9).unwrap().slot, 1);
        let again = study
            .erase(&lock, &ids[0], "x", "2026-11-23T09:00:00Z")
            .unwrap_err();
        assert!(matches!(again, StudyError::Unknown(_)));
    }

    #[test]
    fn erased_id_is_given_to_nobody_else() {
        let folder = tempfile::tempdir().unwrap();
        let study = create(folder.path(), 18);
        let lock = study.lock().unwrap();
        let first = study.admit(&lock, 5).unwrap().participant;
        study.erase(&lock, &first, "x", "2026-11-23").unwrap();
        assert_ne!(study.admit(&lock, 5).unwrap().participant, first);
    }

    #[test]
    fn erase_names_foreign_files_and_is_repeated() {
        let folder = tempfile::tempdir().unwrap();
        let (study, ids) = study_of_two(folder.path());
        let lock = study.lock().unwrap();
        let notes = folder.path().join("notes.txt");
        fs::write(&notes, format!("{}: tall", ids[0])).unwrap();
        let error = study
            .erase(&lock, &ids[0], "x", "2026-11-23")
            .unwrap_err()
            .to_string();
        assert!(
            error.contains("notes.txt") && error.contains("erase again"),
            "{error}"
        );
        // Not freed yet, and no tombstone: it is not done.
        assert_eq!(study.slot_of(&ids[0]).unwrap(), 1);
        assert!(!study.plan_folder().join(TOMBSTONES).exists());
        assert_eq!(text(&notes), format!("{}: tall", ids[0]));
        fs::remove_file(&notes).unwrap();
        study.erase(&lock, &ids[0], "x", "2026-11-23").unwrap();
        for who in ["", "a,b", ids[1].label()] {
            assert!(matches!(
                study.erase(&lock, &ids[1], who, "2026-11-23"),
                Err(StudyError::Who(_))
            ));
        }
    }

    /// As after a crash between the tombstone and the register.
    #[test]
    fn an_erasure_that_is_repeated_leaves_one_tombstone() {
        let folder = tempfile::tempdir().unwrap();
        let (study, ids) = study_of_two(folder.path());
        let lock = study.lock().unwrap();
        let register = study.plan_folder().join(ASSIGNMENTS);
        let before = fs::read(&register).unwrap();
        study.erase(&lock, &ids[0], "x", "2026-11-23").unwrap();
        fs::write(&register, before).unwrap();
        let erased = study.erase(&lock, &ids[0], "x", "2026-11-24").unwrap();
        assert_eq!(erased.slot, Some(1));
        assert!(!text(&register).contains(ids[0].label()));
        let tombstones = text(&study.plan_folder().join(TOMBSTONES));
        assert_eq!(tombstones.lines().count(), 2, "{tombstones}");
        assert!(!tombstones.contains("2026-11-24"), "{tombstones}");
    }

    #[test]
    fn has_finds_words_only() {
        let id = ParticipantId::parse("p7k2").unwrap();
        for (bytes, expected) in [
            ("sub-p7k2_ses", true),
            ("\"p7k2\"", true),
            ("p7k2", true),
            ("xp7k2", false),
            ("p7k22 p7k2", true),
            ("p7k", false),
        ] {
            assert_eq!(has(bytes.as_bytes(), &id), expected, "{bytes}");
        }
    }
}
