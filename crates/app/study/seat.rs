//! A slot of the plan as the settings of a session.

use std::path::Path;

use anyhow::Result;
use experiment::plan::Button as Colour;
use experiment::protocol::Note;
use experiment::study::{Lock, ParticipantId, Study};
use game::{Conditions, Config};

use super::folder::{self, SESSION};
use crate::journal::{Continues, Story};
use crate::session::course;
use crate::session::{Keep, Seat, Setup};

/// The scene of every study.
const SCENE: &str = "alley";
/// Nobody sees a throw twice: whoever looks longer would be told more of what the conditions differ in.
const NO_REPLAY: &str = "shows.replay=false";

/// What a plan says of the session in `slot`.
pub fn plan(study: &Study, slot: u32) -> course::Plan {
    course::Plan {
        rules: study.plan().session.clone(),
        first: study.row(slot).button(1),
        questionnaire: study.questionnaire().clone(),
    }
}

/// The settings of the session in `slot`: what Red and Blue stand for, and the room before the first game.
///
/// # Errors
/// When the configuration cannot be read, or the plan sets what it does not have.
pub fn conditions(study: &Study, slot: u32, root: &Path) -> Result<Conditions> {
    let row = study.row(slot);
    let design = study.plan().design();
    let load = |colour: Option<Colour>| {
        let varied = colour.map(|colour| row.settings(&design, colour));
        let varied = varied.unwrap_or_default().into_iter();
        let mut settings = vec![NO_REPLAY.to_owned()];
        settings.extend(varied.map(|(key, value)| format!("{key}={value}")));
        Config::load(&root.join("config"), SCENE, None, &settings)
    };
    let first = study.plan().session.training_in_first_condition;
    Ok(Conditions {
        lobby: load(first.then(|| row.button(1)))?,
        red: load(Some(Colour::Red))?,
        blue: load(Some(Colour::Blue))?,
    })
}

/// Who sits down, and with what.
#[derive(Debug)]
pub struct Guest<'a> {
    /// Who.
    pub participant: &'a ParticipantId,
    /// The participant's slot.
    pub slot: u32,
    /// `headset`, `desk` or `script`.
    pub device: &'static str,
    /// Seed of the scripted participant.
    pub seed: u64,
    /// What is noted first.
    pub notes: Vec<Note>,
    /// Where a session that was broken off is taken up.
    pub before: Option<(Continues, Story)>,
}

/// How the guest's session is set up; keeps its settings with the plan.
///
/// # Errors
/// When the settings cannot be read or kept.
pub fn setup(study: &Study, lock: &Lock, guest: Guest, root: &Path) -> Result<Setup> {
    // A session that is taken up goes on with the settings that it began with.
    let conditions = match &guest.before {
        Some((continues, story)) => {
            let folder = study.journal_folder(guest.participant, SESSION);
            crate::journal::settings::of(&folder.join(&continues.journal), &story.header)?
        }
        None => conditions(study, guest.slot, root)?,
    };
    let settings = serde_json::to_string(&conditions)?;
    study.keep_settings(lock, &settings)?;
    let parts = folder::journals(study, guest.participant)?.len();
    let folder = study.journal_folder(guest.participant, SESSION);
    experiment::files::create_folder(&folder)?;
    let seat = Seat {
        journal: folder.join(folder::name(parts + 1)),
        settings_digest: study.settings_digest(guest.participant, SESSION, &settings),
        plan: plan(study, guest.slot),
        notes: guest.notes,
        before: guest.before,
    };
    Ok(Setup {
        rate_hz: conditions.lobby.tracking.rate_hz,
        conditions,
        scene: SCENE.to_owned(),
        frames: study.plan().session.frames_per_game,
        seed: guest.seed,
        device: guest.device,
        keep: Keep::Study(Box::new(seat)),
    })
}
