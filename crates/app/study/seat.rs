//! A slot of the plan as the settings of a session.

use std::collections::BTreeMap;
use std::path::Path;

use anyhow::{Context, Result};
use experiment::plan::{Button as Colour, Cell, Condition, Design, SessionRules};
use experiment::protocol::Note;
use experiment::random::SplitMix64;
use experiment::staircase::StaircasePlan;
use experiment::study::{Lock, ParticipantId, Study};
use game::{Conditions, Config, ConfigError, Game};

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
    let base = load(&[], root)?;
    let end = |value| with_value(&base, &plan.key, value);
    let conditions = Conditions {
        lobby: end(plan.standard)?,
        red: end(plan.furthest)?,
        blue: end(plan.furthest)?,
    };
    Game::new(conditions, 1).with_context(|| format!("{} cannot be compared", plan.key))?;
    Ok(())
}

/// Whether each pair of conditions that a design has can be played.
///
/// # Errors
/// One sentence for the first that cannot.
pub fn check_design(design: &Design, rules: &SessionRules, root: &Path) -> Result<()> {
    let mut loaded: BTreeMap<&Condition, Config> = BTreeMap::new();
    for condition in design.cells.iter().flat_map(|cell| [&cell.low, &cell.high]) {
        if !loaded.contains_key(condition) {
            let settings = texts(design.settings(condition));
            let config = load(&settings, root)
                .with_context(|| format!("the scheme's condition {condition} cannot be played"))?;
            loaded.insert(condition, config);
        }
    }
    let scene = load(&[], root)?;
    for Cell { low, high, .. } in &design.cells {
        let lobby = match rules.training_in_first_condition {
            true => &loaded[low],
            false => &scene,
        };
        let conditions = Conditions {
            lobby: lobby.clone(),
            red: loaded[low].clone(),
            blue: loaded[high].clone(),
        };
        Game::new(conditions, rules.frames_per_game).with_context(|| {
            format!("the scheme's conditions {low} and {high} cannot be played in one session")
        })?;
    }
    Ok(())
}

/// The scene of a study with some settings of its own.
fn load(own: &[(&str, String)], root: &Path) -> Result<Config, ConfigError> {
    let mut settings = vec![NO_REPLAY.to_owned()];
    settings.extend(own.iter().map(|(key, value)| format!("{key}={value}")));
    Config::load(&root.join("config"), SCENE, None, &settings)
}

/// Keys and values as the command line has them.
fn texts<'a, V: ToString>(
    settings: impl IntoIterator<Item = (&'a str, V)>,
) -> Vec<(&'a str, String)> {
    let settings = settings.into_iter();
    settings
        .map(|(key, value)| (key, value.to_string()))
        .collect()
}

/// The settings of the session in `slot`: what Red and Blue stand for, and the room before the first game.
///
/// # Errors
/// When the configuration cannot be read, or the plan sets what it does not have.
pub fn conditions(study: &Study, slot: u32, root: &Path) -> Result<Conditions> {
    let guidance = study.plan().session.guidance.settings();
    if let Some(plan) = &study.plan().staircase {
        let base = load(&texts(guidance), root)?;
        let standard = with_value(&base, &plan.key, plan.standard)?;
        return Ok(Conditions {
            lobby: standard.clone(),
            red: standard.clone(),
            blue: standard,
        });
    }
    let row = study.row(slot);
    let design = study.plan().design();
    let of = |colour: Option<Colour>| {
        let varied = colour.map(|colour| row.settings(&design, colour));
        let mut settings = texts(varied.unwrap_or_default());
        settings.extend(texts(guidance));
        load(&settings, root)
    };
    let first = study.plan().session.training_in_first_condition;
    Ok(Conditions {
        lobby: of(first.then(|| row.button(1)))?,
        red: of(Some(Colour::Red))?,
        blue: of(Some(Colour::Blue))?,
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
