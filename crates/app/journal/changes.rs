//! What a study of differences laid out before which input: a journal of its throws is played again with these.

use std::path::Path;

use anyhow::{Context, Result};
use experiment::protocol::Note;
use experiment::staircase::Staircase;
use game::{Config, Game};
use serde_json::Value;

use super::{Header, settings};
use crate::study::seat;

/// The alley's changes in a session, by the number of inputs before each.
#[derive(Debug, Default)]
pub struct Changes(Vec<(usize, Config)>);

impl Changes {
    /// Those that the notes of `journal` tell of; none in a session of games.
    ///
    /// # Errors
    /// When the study is not there, or its plan does not fit the notes.
    pub fn of(journal: &Path, header: &Header, notes: &[(usize, Value)]) -> Result<Self> {
        let is_throw = |(_, note): &(usize, Value)| note["note"] == "throw";
        if !notes.iter().any(is_throw) {
            return Ok(Self::default());
        }
        let conditions = settings::of(journal, header)?;
        let (study, participant) = settings::study_of(journal)?;
        let plan = study.plan().staircase.as_ref();
        let plan = plan.context("the journal has pairs of throws, and the plan has none")?;
        let seed = seat::staircase_seed(&study, study.slot_of(&participant)?);
        let mut staircase = Staircase::new(plan, seed)?;
        let mut changes = Vec::new();
        for (at, note) in notes {
            match serde_json::from_value(note.clone())? {
                Note::Throw { pair, throw, .. } => {
                    let value = value(&mut staircase, pair, throw)?;
                    let config = seat::with_value(&conditions.lobby, &plan.key, value)?;
                    changes.push((*at, config));
                }
                Note::Reply { reply, .. } => staircase.reply(reply)?,
                _ => {}
            }
        }
        Ok(Self(changes))
    }

    /// Lays out what was laid out before input `index`.
    ///
    /// # Errors
    /// When the game refuses it.
    pub fn before(&self, index: usize, game: &mut Game) -> Result<()> {
        let from = self.0.partition_point(|(at, _)| *at < index);
        let due = self.0[from..].iter().take_while(|(at, _)| *at == index);
        for (_, config) in due {
            game.lay_out(config)
                .context("cannot lay out the recorded alley")?;
        }
        Ok(())
    }
}

/// The parameter in a throw of the pair that is open, or comes next.
fn value(staircase: &mut Staircase, pair: u32, throw: u8) -> Result<f64> {
    let trial = match staircase.open_trial() {
        Some(trial) => Some(trial),
        None => staircase.next_trial()?,
    };
    let trial = trial
        .filter(|trial| trial.number == pair)
        .context("the journal's pairs of throws do not fit the study's plan")?;
    Ok(if throw == 1 {
        trial.first
    } else {
        trial.second
    })
}
