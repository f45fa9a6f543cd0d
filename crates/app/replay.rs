//! `bowling replay`: plays a recording again from its inputs and checks that the same came out.

use std::fs;
use std::path::{Path, PathBuf};

use anyhow::{Context, Result, anyhow, bail};
use game::{Button, Conditions, EventKind, Game, Input};
use serde_json::Value;

use crate::journal::{self, Recording};
use crate::motion::{Comparison, Row};
use crate::output::{JOURNAL, MOTION};
use crate::session::sheet_text;
use crate::study;

/// Replays the recording in `folder`, or the session of a study, and prints the score sheets and the hash.
///
/// # Errors
/// When the recording is damaged, or the hash, a score, an event or the motion table differs.
pub fn replay(folder: &Path) -> Result<()> {
    let path = journal_in(folder);
    let recording = journal::read(&path)?;
    // A study's tables are made from its journals; only a recording has one of its own.
    let has_table = recording.header.conditions.is_some();
    let motion_path = folder.join(MOTION);
    let table = has_table
        .then(|| fs::read_to_string(&motion_path))
        .transpose()
        .with_context(|| {
            format!(
                "cannot read {}: it belongs to the recording",
                motion_path.display()
            )
        })?;
    let in_table = |problem: String| anyhow!("{} {problem}", motion_path.display());
    let comparison = table.as_deref().map(Comparison::new).transpose();
    let mut comparison = comparison.map_err(in_table)?;
    check_inputs(&recording.conditions, &recording.inputs)?;
    let mut game = Game::new(recording.conditions.clone(), recording.header.frames)
        .context("cannot set up the recorded alley")?;
    let mut started = Vec::new();
    let mut table_problem = None;
    let mut events = Vec::new();
    for (index, input) in recording.inputs.iter().enumerate() {
        recording.changes.before(index, &mut game)?;
        game.step(input);
        for event in game.events() {
            if let EventKind::GameStarted { button } = event.kind {
                started.push(button);
            }
            events.push((index, serde_json::to_value(event)?));
        }
        if let (Some(comparison), None) = (&mut comparison, &table_problem) {
            let row = Row::new(&game, input).to_string();
            table_problem = comparison.expect_line(&row).err();
        }
    }
    check_result(&game, &started, &recording, &path)?;
    // Only now: when the simulation itself went another way, that is the finding, not what follows from it.
    if let Some(problem) = event_difference(&recording.events, &events) {
        bail!("{}: {problem}", path.display());
    }
    if let Some(problem) = table_problem {
        return Err(in_table(problem));
    }
    if let Some(comparison) = comparison {
        comparison.expect_end().map_err(in_table)?;
    }
    print_result(&game, &started, &recording);
    Ok(())
}

/// The journal in a folder: a recording's, or the last of a study's session.
pub fn journal_in(folder: &Path) -> PathBuf {
    let parts = (1..).map(|part| folder.join(study::folder::name(part)));
    let last = parts.take_while(|path| path.exists()).last();
    last.unwrap_or_else(|| folder.join(JOURNAL))
}

/// Refuses what no session records, before it can stall or break the simulation.
///
/// # Errors
/// A sentence with what was changed.
pub fn check_inputs(conditions: &Conditions, inputs: &[Input]) -> Result<()> {
    conditions.lobby.check()?;
    for button in Button::BOTH {
        conditions.of(button).check()?;
    }
    let longest = conditions.lobby.physics.step_hz;
    for (index, input) in inputs.iter().enumerate() {
        let mut admitted = *input;
        if admitted.refuse_unusable() > 0 || f64::from(input.steps) > longest {
            bail!(
                "input {} of the recording holds numbers that no session records: it was changed",
                index + 1
            );
        }
    }
    Ok(())
}

fn check_result(game: &Game, started: &[Button], recording: &Recording, path: &Path) -> Result<()> {
    let (end, count) = (&recording.end, recording.inputs.len());
    if end.inputs != count as u64 {
        bail!(
            "{}: the end says {} inputs, but there are {count}",
            path.display(),
            end.inputs
        );
    }
    for (button, recorded) in [(Button::Red, end.red), (Button::Blue, end.blue)] {
        let replayed = started
            .contains(&button)
            .then(|| game.score_sheet(button).total());
        if replayed != recorded {
            bail!(
                "{}: the replay gives {} under {button}, the recording says {}: {}",
                path.display(),
                score_text(replayed),
                score_text(recorded),
                origin(recording)
            );
        }
    }
    let hash = journal::hash_text(game.hash());
    if hash != end.hash {
        bail!(
            "{}: the replay ends with state hash {hash}, the recording with {}: {}",
            path.display(),
            end.hash,
            origin(recording)
        );
    }
    Ok(())
}

/// The first event that is not the same in the recording and in its replay, in a sentence.
fn event_difference(recorded: &[(usize, Value)], replayed: &[(usize, Value)]) -> Option<String> {
    let length = recorded.len().max(replayed.len());
    let first = (0..length).find(|index| recorded.get(*index) != replayed.get(*index))?;
    let (recorded, replayed) = (recorded.get(first), replayed.get(first));
    let key = first_differing_key(recorded, replayed);
    let says = |event: Option<&(usize, Value)>| match event {
        None => "no further event".to_owned(),
        Some((input, event)) => {
            let detail = key.as_ref().map(|key| format!(", {key} {}", event[key]));
            let (name, step) = (&event["event"], &event["step"]);
            let detail = detail.unwrap_or_default();
            format!("{name} at step {step} after input {}{detail}", input + 1)
        }
    };
    Some(format!(
        "event {} differs, so one was changed after it was recorded: the recording has {}, the replay {}",
        first + 1,
        says(recorded),
        says(replayed)
    ))
}

/// The first field, beside name and step, in which two events differ.
fn first_differing_key(
    recorded: Option<&(usize, Value)>,
    replayed: Option<&(usize, Value)>,
) -> Option<String> {
    let fields = |event: Option<&(usize, Value)>| Some(event?.1.as_object()?.clone());
    let (recorded, replayed) = (fields(recorded)?, fields(replayed)?);
    let differs = |key: &&String| recorded.get(*key) != replayed.get(*key);
    let is_detail = |key: &&String| !["event", "step"].contains(&key.as_str());
    let mut keys = recorded.keys().chain(replayed.keys());
    keys.find(|key| is_detail(key) && differs(key)).cloned()
}

fn score_text(score: Option<u32>) -> String {
    score.map_or("no game".to_owned(), |score| format!("{score} pins"))
}

/// Where a difference may come from.
fn origin(recording: &Recording) -> String {
    let header = &recording.header;
    format!(
        "it was made by version {} at commit {}, this is {} at {}",
        header.program,
        header.commit,
        env!("CARGO_PKG_VERSION"),
        env!("BOWLING_COMMIT")
    )
}

fn print_result(game: &Game, started: &[Button], recording: &Recording) {
    for button in Button::BOTH
        .into_iter()
        .filter(|button| started.contains(button))
    {
        println!("{}\n", sheet_text(game, button));
    }
    let refused = recording.end.refused;
    if !refused.is_none() {
        println!("Readings of the device that were refused when it was recorded: {refused}.");
    }
    if !recording.end.complete {
        println!("The session was ended before both games were over.");
    }
    println!(
        "{} frames replayed: scores, events{} and state agree.",
        recording.inputs.len(),
        if recording.header.conditions.is_some() {
            ", motion table"
        } else {
            ""
        }
    );
    println!("State hash {}", recording.end.hash);
}
