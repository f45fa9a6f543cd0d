//! A participant's journals: where they lie, and how far the session in them got.

use std::fs::File;
use std::io::{BufRead, BufReader};
use std::path::{Path, PathBuf};

use anyhow::{Context, Result, bail};
use experiment::protocol::{Place, Protocol};
use experiment::record::Pairs;
use experiment::study::{ParticipantId, Study};
use game::Game;

use super::seat;
use crate::journal::{self, Changes, Continues, Story};
use crate::session::course::Course;

/// Every participant has one session.
pub const SESSION: u32 = 1;
/// The journal that a session begins with.
const FIRST: &str = "session.jsonl";

/// The journals of a participant's session, in their order.
///
/// # Errors
/// When the folder cannot be read.
pub fn journals(study: &Study, participant: &ParticipantId) -> Result<Vec<PathBuf>> {
    let folder = study.journal_folder(participant, SESSION);
    let parts = (1..).map(|part| folder.join(name(part)));
    Ok(parts.take_while(|path| path.exists()).collect())
}

/// The name of a session's journal `part`, from 1.
pub fn name(part: usize) -> String {
    if part == 1 {
        FIRST.to_owned()
    } else {
        format!("session_part-{part}.jsonl")
    }
}

/// How far a session got.
#[derive(Debug)]
pub struct Progress {
    /// Its journals, as one.
    pub story: Story,
    /// The last of them.
    pub path: PathBuf,
    /// Where it is.
    pub protocol: Protocol,
    /// Its pairs of throws, in a study of differences.
    pub pairs: Option<Pairs>,
}

/// Whether a program lived long enough to write the journal's header and, where it is a session's first, the consent.
fn has_begun(journal: &Path) -> Result<bool> {
    let failed = || format!("cannot read {}", journal.display());
    let mut file = BufReader::new(File::open(journal).with_context(failed)?);
    let mut line = || {
        let mut line = Vec::new();
        file.read_until(b'\n', &mut line).with_context(failed)?;
        anyhow::Ok(line)
    };
    let (header, second) = (line()?, line()?);
    // What is no journal at all is no trace of a program that was killed: who reads it says so.
    if header.ends_with(b"\n") && !header.starts_with(BEGINNING) {
        return Ok(true);
    }
    let goes_on = header
        .windows(CONTINUES.len())
        .any(|part| part == CONTINUES);
    Ok(if goes_on { header } else { second }.ends_with(b"\n"))
}

/// How every journal begins.
const BEGINNING: &[u8] = b"{\"line\":1,";
/// What a header has that takes up an earlier journal.
const CONTINUES: &[u8] = b"\"continues\":";

/// Reads a participant's session; `None` before it began.
///
/// # Errors
/// When a journal is damaged, or does not fit the plan.
pub fn progress(study: &Study, participant: &ParticipantId) -> Result<Option<Progress>> {
    let mut last = None;
    for path in journals(study, participant)? {
        // One without these is a program that was killed before it did anything.
        if has_begun(&path)? {
            last = Some(path);
        }
    }
    let Some(path) = last else {
        return Ok(None);
    };
    let story = journal::read_open(&path)?;
    let slot = study.slot_of(participant)?;
    let mut course = Course::new(seat::plan(study, slot))?;
    course
        .catch_up(&story)
        .with_context(|| path.display().to_string())?;
    Ok(Some(Progress {
        story,
        path,
        protocol: course.protocol().clone(),
        pairs: course.pairs(),
    }))
}

impl Progress {
    /// Whether there is something left to play or to ask.
    pub fn is_open(&self) -> bool {
        !self.protocol.is_over()
    }

    /// Cuts the story behind the last complete bowling frame, game or training throw, and says where that is. One of whose events
    /// some were not written any more is not complete: the session would go on as if they had never happened.
    ///
    /// # Errors
    /// When the settings are not there, or the game cannot be set up with them.
    pub fn cut(mut self) -> Result<(Continues, Story)> {
        let whole = self.story.whole;
        let events = self.story.events.iter().filter(|(at, _)| *at < whole);
        let has_begun = events
            .clone()
            .any(|(_, event)| event["event"] == "game_started");
        let is_mark = |event: &serde_json::Value| match event["event"].as_str() {
            Some("frame_scored" | "game_started" | "game_over") => true,
            // A training throw; those of a game end with the frame.
            Some("settled") => !has_begun,
            _ => false,
        };
        let marks = events.filter(|(_, event)| is_mark(event));
        let count = marks.map(|(at, _)| at + 1).max().unwrap_or(0);
        self.story.inputs.truncate(count);
        self.story.events.retain(|(at, _)| *at < count);
        let conditions = journal::settings::of(&self.path, &self.story.header)?;
        let mut game = Game::new(conditions, self.story.header.frames)
            .context("cannot set up the recorded alley")?;
        let changes = Changes::of(&self.path, &self.story.header, &self.story.notes)?;
        for (index, input) in self.story.inputs.iter().enumerate() {
            changes.before(index, &mut game)?;
            game.step(input);
        }
        self.story.notes = journal::kept(self.story.notes, count);
        let continues = Continues {
            journal: file_name(&self.path)?,
            inputs: count as u64,
            hash: journal::hash_text(game.hash()),
        };
        Ok((continues, self.story))
    }
}

fn file_name(path: &Path) -> Result<String> {
    let name = path.file_name().and_then(|name| name.to_str());
    Ok(name.context("a journal has a name")?.to_owned())
}

/// The only participant whose session was broken off.
///
/// # Errors
/// When there is none, or more than one.
pub fn broken_off(study: &Study) -> Result<ParticipantId> {
    let mut open = Vec::new();
    for assignment in study.assignments()? {
        let progress = progress(study, &assignment.participant)?;
        if progress.is_some_and(|progress| progress.is_open()) {
            open.push(assignment.participant);
        }
    }
    match &open[..] {
        [] => bail!("no session of this study was broken off: there is nothing to resume"),
        [one] => Ok(one.clone()),
        several => {
            let names: Vec<String> = several.iter().map(ToString::to_string).collect();
            bail!(
                "the sessions of {} were broken off: say whose with --participant",
                names.join(", ")
            )
        }
    }
}

/// In words where a session is.
pub fn place_text(place: Place) -> String {
    match place {
        Place::Form(_) => "in the questions".to_owned(),
        Place::Training { .. } => "in the training throws".to_owned(),
        Place::Waiting(game) => format!("before game {game}"),
        Place::Playing(game) => format!("in game {game}"),
        Place::Pair { number, .. } | Place::Comparing(number) => format!("at pair {number}"),
        Place::Debriefing => "before the debriefing".to_owned(),
        Place::Complete => "complete".to_owned(),
        Place::Stopped => "stopped".to_owned(),
    }
}
