//! Tables from journals: every session is played again, checked to its last bit, and written down as rows.

use std::path::Path;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Mutex, PoisonError};

use anyhow::{Context, Result, bail};
use experiment::record::SessionRecord;
use experiment::study::{Assignment, Lock, ParticipantId, Study};
use experiment::tables::Tables;
use game::Game;

use super::folder::{self, Progress, SESSION};
use super::record::Scribe;
use crate::journal::{self, Changes};

/// Makes every table of a study anew.
///
/// # Errors
/// When a journal is damaged or does not lead to the state that it recorded; no table is changed by it then.
pub fn rebuild(folder: &Path) -> Result<()> {
    let study = Study::open(folder)?;
    let lock = study.lock()?;
    let count = write(&study, &lock)?;
    println!(
        "{count} sessions played again and written to {}.",
        study.data_folder().display()
    );
    Ok(())
}

/// The same for a study that is open; returns how many sessions there are.
///
/// # Errors
/// As [`rebuild`].
pub fn write(study: &Study, lock: &Lock) -> Result<usize> {
    let tables = Tables::of(study, lock);
    let assignments = study.assignments()?;
    let records = each(&assignments, |assignment| {
        let Some(record) = record(study, &assignment.participant)? else {
            return Ok(None);
        };
        tables.write_session(&record)?;
        Ok(Some(record.summary()))
    })?;
    let records: Vec<SessionRecord> = records.into_iter().flatten().collect();
    tables.write_study(&records)?;
    Ok(records.len())
}

/// What every session of a study came to.
///
/// # Errors
/// As [`rebuild`].
pub fn records(study: &Study) -> Result<Vec<SessionRecord>> {
    let assignments = study.assignments()?;
    let records = each(&assignments, |assignment| {
        record(study, &assignment.participant)
    })?;
    Ok(records.into_iter().flatten().collect())
}

/// Does something for every participant, as many at a time as there are cores; the results in the participants' order.
fn each<T: Send>(
    assignments: &[Assignment],
    act: impl Fn(&Assignment) -> Result<T> + Sync,
) -> Result<Vec<T>> {
    let next = AtomicUsize::new(0);
    let results = Mutex::new(Vec::new());
    let worker = || {
        loop {
            let index = next.fetch_add(1, Ordering::Relaxed);
            let Some(assignment) = assignments.get(index) else {
                return;
            };
            let result = act(assignment);
            let mut results = results.lock().unwrap_or_else(PoisonError::into_inner);
            results.push((index, result));
        }
    };
    std::thread::scope(|scope| {
        let cores = std::thread::available_parallelism().map_or(1, usize::from);
        for _ in 0..cores.min(assignments.len()) {
            scope.spawn(worker);
        }
    });
    let mut results = results.into_inner().unwrap_or_else(PoisonError::into_inner);
    results.sort_by_key(|(index, _)| *index);
    results.into_iter().map(|(_, result)| result).collect()
}

/// What a participant's session came to; `None` before it began.
///
/// # Errors
/// As [`rebuild`].
pub fn record(study: &Study, participant: &ParticipantId) -> Result<Option<SessionRecord>> {
    let Some(progress) = folder::progress(study, participant)? else {
        return Ok(None);
    };
    let slot = study.slot_of(participant)?;
    let place = progress.path.display().to_string();
    let record = played_again(study, participant, slot, &progress).context(place)?;
    Ok(Some(record))
}

fn played_again(
    study: &Study,
    participant: &ParticipantId,
    slot: u32,
    progress: &Progress,
) -> Result<SessionRecord> {
    let story = &progress.story;
    let conditions = journal::settings::of(&progress.path, &story.header)?;
    let mut game =
        Game::new(conditions, story.header.frames).context("cannot set up the recorded alley")?;
    let mut scribe = Scribe::new(story);
    let changes = Changes::of(&progress.path, &story.header, &story.notes)?;
    for (index, input) in story.inputs.iter().enumerate() {
        changes.before(index, &mut game)?;
        game.step(input);
        scribe.frame(&game);
    }
    if let Some(end) = &story.end {
        let hash = journal::hash_text(game.hash());
        if hash != end.hash {
            bail!(
                "playing the session again leads to state {hash}, and it ended in {}: it was recorded by version {} at commit {}",
                end.hash,
                story.header.program,
                story.header.commit
            );
        }
    }
    scribe.finish(study, (participant, SESSION, slot), progress, game.time())
}
