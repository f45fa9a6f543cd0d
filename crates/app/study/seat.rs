//! A slot of the plan as the settings of a session.

use std::path::Path;

use anyhow::{Context, Result};
use experiment::plan::Button as Colour;
use experiment::protocol::Note;
use experiment::random::SplitMix64;
use experiment::staircase::StaircasePlan;
use experiment::study::{Lock, ParticipantId, Study};
use game::{Conditions, Config, Game};

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
        staircase: study
            .plan()
            .staircase
            .clone()
            .map(|plan| (plan, staircase_seed(study, slot))),
    }
}

/// Seed of the pairs of throws in `slot`: not that of the participant who is simulated there.
pub fn staircase_seed(study: &Study, slot: u32) -> u64 {
    SplitMix64::for_index(!study.plan().seed, u64::from(slot)).next_u64()
}

/// Settings in which the number at `key` is `value`.
///
/// # Errors
/// When there is no such number, or it cannot have this value.
pub fn with_value(config: &Config, key: &str, value: f64) -> Result<Config> {
    let mut tree = serde_json::to_value(config)?;
    let place = format!("/{}", key.replace('.', "/"));
    let number = tree
        .pointer_mut(&place)
        .filter(|found| found.is_number())
        .with_context(|| {
            format!("{key} is no number of config/default.toml: name one, like objects.elasticity")
        })?;
    // What is counted stays a whole number.
    *number = if number.is_f64() {
        value.into()
    } else {
        (value.round() as i64).into()
    };
    let config: Config = serde_json::from_value(tree)
        .with_context(|| format!("{key} = {value} is no value of this setting"))?;
    config.check()?;
    Ok(config)
}

/// Whether both ends of a study of differences can be played.
///
/// # Errors
/// One sentence when they cannot.
pub fn check_staircase(plan: &StaircasePlan, root: &Path) -> Result<()> {
    let base = Config::load(&root.join("config"), SCENE, None, &[NO_REPLAY.to_owned()])?;
    let end = |value| with_value(&base, &plan.key, value);
    let conditions = Conditions {
        lobby: end(plan.standard)?,
        red: end(plan.furthest)?,
        blue: end(plan.furthest)?,
    };
    Game::new(conditions, 1).with_context(|| format!("{} cannot be compared", plan.key))?;
    Ok(())
}

/// The settings of the session in `slot`: what Red and Blue stand for, and the room before the first game.
///
/// # Errors
/// When the configuration cannot be read, or the plan sets what it does not have.
pub fn conditions(study: &Study, slot: u32, root: &Path) -> Result<Conditions> {
    let guidance = study.plan().session.guidance.settings();
    if let Some(plan) = &study.plan().staircase {
        let mut settings = vec![NO_REPLAY.to_owned()];
        settings.extend(guidance.map(|(key, is_on)| format!("{key}={is_on}")));
        let base = Config::load(&root.join("config"), SCENE, None, &settings)?;
        let standard = with_value(&base, &plan.key, plan.standard)?;
        return Ok(Conditions {
            lobby: standard.clone(),
            red: standard.clone(),
            blue: standard,
        });
    }
    let row = study.row(slot);
    let design = study.plan().design();
    let load = |colour: Option<Colour>| {
        let varied = colour.map(|colour| row.settings(&design, colour));
        let varied = varied.unwrap_or_default().into_iter();
        let mut settings = vec![NO_REPLAY.to_owned()];
        settings.extend(varied.map(|(key, value)| format!("{key}={value}")));
        settings.extend(guidance.map(|(key, is_on)| format!("{key}={is_on}")));
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
