//! Who has which slot, who agreed to what, and who looked into the allocation: files of `plan/`.

use std::path::PathBuf;

use super::{Lock, ParticipantId, Study, StudyError, fresh_id};
use crate::consent::{Consent, Ticks};
use crate::files;
use crate::plan::Row;

pub(super) const ASSIGNMENTS: &str = "assignments.csv";
const ASSIGNMENTS_HEADING: &str = "slot,participant_id";
const CONSENTS: &str = "consents.csv";
const CONSENTS_HEADING: &str =
    "participant_id,date,form_version,form_sha256,take_part,share_data,share_motion,contact";
const UNBLINDING: &str = "unblinding.csv";
const UNBLINDING_HEADING: &str = "when,who,why";
pub(super) const TOMBSTONES: &str = "tombstones.csv";
pub(super) const TOMBSTONES_HEADING: &str = "when,id_sha256,who";

/// One participant's place.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Assignment {
    /// Number of the slot, from 1.
    pub slot: u32,
    /// Who has it.
    pub participant: ParticipantId,
}

impl Study {
    /// Who has which slot, by slot.
    ///
    /// # Errors
    /// When the register cannot be read.
    pub fn assignments(&self) -> Result<Vec<Assignment>, StudyError> {
        let mut assignments = Vec::new();
        for (line, cells) in self.register(ASSIGNMENTS, ASSIGNMENTS_HEADING)? {
            let assignment = match &cells[..] {
                [slot, id] => slot.parse().ok().zip(ParticipantId::parse(id).ok()),
                _ => None,
            };
            let valid = assignment.filter(|(slot, id)| {
                let known = |other: &Assignment| other.slot == *slot || other.participant == *id;
                (1..=self.plan().subjects).contains(slot) && !assignments.iter().any(known)
            });
            let (slot, participant) = valid.ok_or_else(|| self.broken(ASSIGNMENTS, line))?;
            assignments.push(Assignment { slot, participant });
        }
        assignments.sort_by_key(|assignment| assignment.slot);
        Ok(assignments)
    }

    /// The slot of a participant.
    ///
    /// # Errors
    /// When there is no such participant, or the register cannot be read.
    pub fn slot_of(&self, participant: &ParticipantId) -> Result<u32, StudyError> {
        let assignments = self.assignments()?;
        let found = assignments
            .iter()
            .find(|assignment| assignment.participant == *participant);
        found
            .map(|found| found.slot)
            .ok_or_else(|| StudyError::Unknown(participant.to_string()))
    }

    /// A new participant: a random id that nobody has or had, and the first free slot, so that blocks stay whole.
    ///
    /// # Errors
    /// When no slot is free, or a register cannot be read or written.
    pub fn admit(&self, lock: &Lock, entropy: u64) -> Result<Assignment, StudyError> {
        lock.belongs_to(self);
        let mut assignments = self.assignments()?;
        let is_free = |slot: &u32| {
            !assignments
                .iter()
                .any(|assignment| assignment.slot == *slot)
        };
        let slot = (1..=self.plan().subjects)
            .find(is_free)
            .ok_or(StudyError::Full(self.plan().subjects))?;
        let erased = self.erased()?;
        let participant = fresh_id(entropy, |id| {
            assignments
                .iter()
                .any(|assignment| assignment.participant == *id)
                || erased.contains(&self.id_hash(id))
        });
        let new = Assignment { slot, participant };
        assignments.push(new.clone());
        assignments.sort_by_key(|assignment| assignment.slot);
        let lines = assignments
            .iter()
            .map(|assignment| format!("{},{}", assignment.slot, assignment.participant));
        let text: String = std::iter::once(ASSIGNMENTS_HEADING.to_owned())
            .chain(lines)
            .map(|line| line + "\n")
            .collect();
        files::write(&self.plan_folder().join(ASSIGNMENTS), text.as_bytes())?;
        Ok(new)
    }

    /// Writes down what a participant agreed to, before anything else is recorded.
    ///
    /// # Errors
    /// When there is no such participant, or the register cannot be written.
    pub fn record_consent(
        &self,
        lock: &Lock,
        participant: &ParticipantId,
        consent: &Consent,
    ) -> Result<(), StudyError> {
        self.slot_of(participant)?;
        let Ticks {
            take_part,
            share_data,
            share_motion,
            contact,
        } = consent.ticks;
        let version = consent.form_version.replace(',', ";");
        let (date, sha256) = (&consent.date, &consent.form_sha256);
        let line = format!(
            "{participant},{date},{version},{sha256},{take_part},{share_data},{share_motion},{contact}"
        );
        self.append(lock, CONSENTS, CONSENTS_HEADING, &line)
    }

    /// The allocation for a person's eyes; who asked, when (UTC, RFC 3339) and why is written down before anything is shown.
    ///
    /// # Errors
    /// When nobody is named, or it cannot be written down.
    pub fn unblind(
        &self,
        lock: &Lock,
        who: &str,
        when: &str,
        why: &str,
    ) -> Result<&[Row], StudyError> {
        let plain = |text: &str| !text.trim().is_empty() && !text.contains([',', '\n', '\r']);
        if !plain(who) || !plain(why) || !plain(when) {
            return Err(StudyError::Who("opening the allocation is written down"));
        }
        self.append(
            lock,
            UNBLINDING,
            UNBLINDING_HEADING,
            &format!("{when},{who},{why}"),
        )?;
        Ok(self.rows())
    }

    /// Hashes of the ids that were erased.
    pub(super) fn erased(&self) -> Result<Vec<String>, StudyError> {
        let register = self.register(TOMBSTONES, TOMBSTONES_HEADING)?;
        Ok(register
            .into_iter()
            .filter_map(|(_, mut cells)| (cells.len() == 3).then(|| cells.remove(1)))
            .collect())
    }

    pub(super) fn append(
        &self,
        lock: &Lock,
        name: &str,
        heading: &str,
        line: &str,
    ) -> Result<(), StudyError> {
        lock.belongs_to(self);
        let path = self.plan_folder().join(name);
        if !path.exists() {
            files::write(&path, format!("{heading}\n").as_bytes())?;
        }
        Ok(files::append_line(&path, line)?)
    }

    /// The lines of a register after its heading, each with its number; one that is not there is empty.
    fn register(&self, name: &str, heading: &str) -> Result<Vec<(usize, Vec<String>)>, StudyError> {
        let path = self.plan_folder().join(name);
        if !path.exists() {
            return Ok(Vec::new());
        }
        let text = files::read(&path)?;
        let mut lines = (1..).zip(text.lines());
        if lines.next().is_none_or(|(_, first)| first != heading) {
            return Err(self.broken(name, 1));
        }
        let cells = |line: &str| line.split(',').map(str::to_owned).collect();
        Ok(lines.map(|(number, line)| (number, cells(line))).collect())
    }

    fn broken(&self, name: &str, line: usize) -> StudyError {
        let path: PathBuf = self.plan_folder().join(name);
        StudyError::Register { path, line }
    }
}

#[cfg(test)]
mod tests {
    use super::super::tests::create;
    use super::*;
    use std::fs;

    #[test]
    fn admit_fills_slots_in_order_and_then_refuses() {
        let folder = tempfile::tempdir().unwrap();
        let study = create(folder.path(), 3);
        let lock = study.lock().unwrap();
        let admitted: Vec<Assignment> = (0..3)
            .map(|entropy| study.admit(&lock, entropy).unwrap())
            .collect();
        let slots: Vec<u32> = admitted.iter().map(|assignment| assignment.slot).collect();
        assert_eq!(slots, [1, 2, 3]);
        assert_eq!(study.assignments().unwrap(), admitted);
        assert_eq!(study.slot_of(&admitted[1].participant).unwrap(), 2);
        let error = study.admit(&lock, 4).unwrap_err().to_string();
        assert!(error.starts_with("all 3 slots"), "{error}");
        let nobody = ParticipantId::parse("aaaa").unwrap();
        assert!(
            study
                .slot_of(&nobody)
                .unwrap_err()
                .to_string()
                .contains("sub-aaaa")
        );
    }

    #[test]
    fn registers_that_were_edited_are_named() {
        let folder = tempfile::tempdir().unwrap();
        let study = create(folder.path(), 3);
        let lock = study.lock().unwrap();
        study.admit(&lock, 1).unwrap();
        let path = study.plan_folder().join(ASSIGNMENTS);
        let text = fs::read_to_string(&path).unwrap();
        for (broken, line) in [
            (text.replace("slot", "Slot"), 1),
            (text.replace("1,sub", "4,sub"), 2),
            (text.replace("1,sub", "x,sub"), 2),
            (format!("{text}1,sub-p7k2\n"), 3),
            (format!("{text}2,sub-p7\n"), 3),
        ] {
            fs::write(&path, broken).unwrap();
            let error = study.admit(&lock, 2).unwrap_err().to_string();
            assert!(
                error.contains(&format!("assignments.csv line {line} is not as")),
                "{error}"
            );
        }
    }

    #[test]
    fn unblind_is_written_down_first() {
        let folder = tempfile::tempdir().unwrap();
        let study = create(folder.path(), 3);
        let lock = study.lock().unwrap();
        study
            .unblind(&lock, " ", "2026-11-22T10:00:00Z", "analysis")
            .unwrap_err();
        study
            .unblind(&lock, "a\nb", "2026-11-22T10:00:00Z", "analysis")
            .unwrap_err();
        assert!(!study.plan_folder().join(UNBLINDING).exists());
        let rows = study
            .unblind(&lock, "the analyst", "2026-11-22T10:00:00Z", "analysis")
            .unwrap();
        assert_eq!(rows.len(), 3);
        let log = fs::read_to_string(study.plan_folder().join(UNBLINDING)).unwrap();
        assert_eq!(
            log,
            "when,who,why\n2026-11-22T10:00:00Z,the analyst,analysis\n"
        );
    }
}
