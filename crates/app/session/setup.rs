//! What a session is set up with.

use std::path::PathBuf;

use experiment::protocol::Note;
use game::{Button, Conditions};

use super::course;
use crate::journal::{Continues, Story};

/// How a session is set up.
#[derive(Debug)]
pub struct Setup {
    /// Resolved settings.
    pub conditions: Conditions,
    /// Scene that they came from.
    pub scene: String,
    /// Bowling frames per game.
    pub frames: u32,
    /// Seed of the scripted participant.
    pub seed: u64,
    /// Who bowls: `headset`, `desk` or `script`.
    pub device: &'static str,
    /// Frames per second of the device [Hz].
    pub rate_hz: f64,
    /// Where it is kept, and as what.
    pub keep: Keep,
}

/// Where a session is kept, and as what.
#[derive(Debug)]
pub enum Keep {
    /// As a recording in a folder of its own, with motion table, score sheets and pictures.
    Recording(PathBuf),
    /// As a part of a study: a journal alone, from which the study's tables are made.
    Study(Box<Seat>),
}

impl Keep {
    /// The games that a scripted participant has still to begin, in their order, and its throws before them.
    pub fn script(&self) -> (Vec<Button>, u32) {
        let Self::Study(seat) = self else {
            return (Button::BOTH.to_vec(), 0);
        };
        let first = seat.plan.first;
        let games = [first, first.other()].map(course::button);
        let events = seat.before.iter().flat_map(|(_, story)| &story.events);
        let mut begun = 0;
        let mut training = seat.plan.rules.training_throws;
        let pairs = seat.plan.staircase.as_ref().map(|(plan, _)| plan.trials);
        training += 2 * pairs.unwrap_or(0);
        for (_, event) in events {
            match event["event"].as_str() {
                Some("game_started") => begun += 1,
                Some("settled") if begun == 0 => training = training.saturating_sub(1),
                _ => {}
            }
        }
        match begun {
            _ if pairs.is_some() => (Vec::new(), training),
            0 => (games.to_vec(), training),
            _ => (games[games.len().min(begun)..].to_vec(), 0),
        }
    }
}

/// A session's place in a study.
#[derive(Debug)]
pub struct Seat {
    /// The journal, which must not exist.
    pub journal: PathBuf,
    /// The salted digest of the settings.
    pub settings_digest: String,
    /// What the plan says of the session.
    pub plan: course::Plan,
    /// What is noted before anything else.
    pub notes: Vec<Note>,
    /// The journals so far of a session that was broken off, up to where it is taken up.
    pub before: Option<(Continues, Story)>,
}
