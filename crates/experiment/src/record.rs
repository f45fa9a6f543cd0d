//! What one session came to: everything that its tables are made of. The app makes it from the session's journal.

use crate::consent::Consent;
use crate::plan::Button;
use crate::protocol::AnsweredIn;
use crate::questionnaire::{Answer, Answers, Stage};
use crate::staircase::{Estimate, Reply, Trial};
use crate::study::ParticipantId;

/// A session.
#[derive(Debug, Clone, PartialEq)]
pub struct SessionRecord {
    /// Whose.
    pub participant: ParticipantId,
    /// Number of the participant's session, from 1.
    pub session: u32,
    /// The participant's slot.
    pub slot: u32,
    /// How it ended.
    pub status: Status,
    /// What was agreed to.
    pub consent: Consent,
    /// The forms that were filled in, in the order in which they were begun.
    pub forms: Vec<FilledForm>,
    /// The games that were begun; in a study of differences one run with all pairs.
    pub runs: Vec<Run>,
    /// The pairs of throws that were compared, in a study of differences.
    pub pairs: Option<Pairs>,
    /// What it was recorded with.
    pub provenance: Provenance,
    /// When it began, UTC, RFC 3339.
    pub began: String,
    /// Time with the headset on, or at the desk [s].
    pub immersed_s: f64,
}

/// The pairs of throws of a session.
#[derive(Debug, Clone, PartialEq)]
pub struct Pairs {
    /// The pairs and what was said of them.
    pub compared: Vec<Compared>,
    /// What they came to; `None` as long as they tell nothing.
    pub estimate: Option<Estimate>,
}

/// A pair of throws and what was said of it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Compared {
    /// The pair.
    pub trial: Trial,
    /// What was said.
    pub reply: Reply,
    /// When, since the session began [s].
    pub at_s: f64,
    /// Where.
    pub answered_in: AnsweredIn,
}

/// How a session ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Status {
    /// Both games and the questions.
    Complete,
    /// Stopped before that, or not ended yet.
    Partial,
}

/// A form and where it was filled in.
#[derive(Debug, Clone, PartialEq)]
pub struct FilledForm {
    /// Where.
    pub answered_in: AnsweredIn,
    /// What.
    pub answers: Answers,
}

/// What a session was recorded with.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Provenance {
    /// Version of the program.
    pub version: String,
    /// Commit that it was built from.
    pub commit: String,
    /// Seed of what is random in the session.
    pub seed: u64,
    /// The kind of device: `headset`, `desk` or `script`.
    pub device: String,
    /// Who made it, as it says itself; empty when it does not.
    pub manufacturer: String,
    /// What it calls itself; empty when it does not.
    pub model: String,
    /// The runtime's name and version; empty where there is none.
    pub runtime: String,
    /// Pictures per second [Hz].
    pub refresh_hz: f64,
    /// Salted digest of what Red and Blue meant: `Study::settings_digest`.
    pub settings_digest: String,
}

/// One game, or a session's pairs of throws, as the tracker saw it.
#[derive(Debug, Clone, PartialEq)]
pub struct Run {
    /// Number of the run, from 1: a game that was begun anew after an interruption is another run.
    pub number: u32,
    /// What was done in it.
    pub task: Task,
    /// When it began, UTC, RFC 3339.
    pub began: String,
    /// Rows per second that were intended [Hz].
    pub sampling_hz: f64,
    /// Head and hand, one row per picture.
    pub motion: Vec<MotionRow>,
    /// What happened.
    pub events: Vec<EventRow>,
}

/// What is done in a run.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Task {
    /// A game.
    Game {
        /// Which, 1 or 2.
        number: u8,
        /// Its button.
        button: Button,
    },
    /// Pairs of throws.
    Pairs,
}

impl Task {
    /// As the names of files have it.
    pub fn name(self) -> &'static str {
        match self {
            Task::Game { .. } => "bowling",
            Task::Pairs => "pairs",
        }
    }
}

/// Head and hand at one instant, in the world frame.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MotionRow {
    /// Since the run began [s].
    pub time_s: f64,
    /// Position [m] and unit quaternion x, y, z, w; `None` while not tracked.
    pub head: Option<[f64; 7]>,
    /// The same of the hand.
    pub hand: Option<[f64; 7]>,
}

/// Something that happened in a run. What does not apply is `None`.
#[derive(Debug, Clone, PartialEq)]
pub struct EventRow {
    /// Since the run began [s].
    pub onset_s: f64,
    /// How long [s].
    pub duration_s: Option<f64>,
    /// What.
    pub trial_type: TrialType,
    /// The button that it belongs to.
    pub button: Option<Button>,
    /// Bowling frame, 1 to 10; in a run of pairs the pair, from 1.
    pub frame: Option<u32>,
    /// Ball in the frame, 1 to 3; in a run of pairs the throw of the pair, 1 or 2.
    pub ball: Option<u32>,
    /// Pins knocked down by this ball.
    pub pins_down: Option<u32>,
    /// What came towards the head, as `ball` or `pin 7`.
    pub object: Option<String>,
    /// How the head answered what came towards it.
    pub response: Option<HeadResponse>,
}

impl EventRow {
    /// An event of which only time and kind are known.
    pub fn new(onset_s: f64, trial_type: TrialType) -> Self {
        EventRow {
            onset_s,
            duration_s: None,
            trial_type,
            button: None,
            frame: None,
            ball: None,
            pins_down: None,
            object: None,
            response: None,
        }
    }
}

/// Something came towards the head, and what the head did; see `behaviour` and `docs/behaviour.md`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct HeadResponse {
    /// From the event's onset to the closest approach that was foreseen at the onset [s].
    pub time_to_contact_s: f64,
    /// Distance of that closest approach, surface to head centre [m].
    pub miss_distance_m: f64,
    /// From the event's onset to the head's answer [s]; `None` when the head did nothing beyond its sway.
    pub onset_s: Option<f64>,
    /// Largest way of the head off its place [m].
    pub displacement_m: f64,
    /// Largest speed of the head off its place [m/s].
    pub speed_mps: f64,
    /// How much farther it passed than it would have passed a head that went on as before [m].
    pub gain_m: f64,
    /// The largest way in standard deviations of the head's own sway.
    pub score: f64,
}

/// Kinds of events.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum TrialType {
    /// The game's button was pressed.
    GameStart,
    /// A training throw, from release to rest.
    TrainingThrow,
    /// A throw, from release to rest.
    BallRoll,
    /// The game is over.
    GameEnd,
    /// A button was pressed that was not due.
    RefusedPress,
    /// A ball or pin came towards the head.
    TowardHead,
    /// Head or hand were not tracked.
    TrackingLost,
    /// The headset was taken off or the game paused.
    Pause,
    /// Somebody pressed Stop.
    Stop,
}

impl TrialType {
    /// All kinds.
    pub const ALL: [TrialType; 9] = [
        TrialType::GameStart,
        TrialType::TrainingThrow,
        TrialType::BallRoll,
        TrialType::GameEnd,
        TrialType::RefusedPress,
        TrialType::TowardHead,
        TrialType::TrackingLost,
        TrialType::Pause,
        TrialType::Stop,
    ];

    /// As tables name it.
    pub fn name(self) -> &'static str {
        match self {
            TrialType::GameStart => "game_start",
            TrialType::TrainingThrow => "training_throw",
            TrialType::BallRoll => "ball_roll",
            TrialType::GameEnd => "game_end",
            TrialType::RefusedPress => "refused_press",
            TrialType::TowardHead => "toward_head",
            TrialType::TrackingLost => "tracking_lost",
            TrialType::Pause => "pause",
            TrialType::Stop => "stop",
        }
    }

    /// What it is, for the tables' dictionary.
    pub fn description(self) -> &'static str {
        match self {
            TrialType::GameStart => "the game's button was pressed",
            TrialType::TrainingThrow => "a throw that does not count, from release to rest",
            TrialType::BallRoll => "a throw, from release to rest",
            TrialType::GameEnd => "the game was over",
            TrialType::RefusedPress => "a button was pressed that was not due; nothing happened",
            TrialType::TowardHead => "a ball or pin came towards the head",
            TrialType::TrackingLost => "head or hand were not tracked",
            TrialType::Pause => "the headset was off or the game paused",
            TrialType::Stop => "the participant or the experimenter stopped the session",
        }
    }
}

impl Status {
    /// As tables name it.
    pub fn name(self) -> &'static str {
        match self {
            Status::Complete => "complete",
            Status::Partial => "partial",
        }
    }
}

impl SessionRecord {
    /// The last form of a stage.
    pub fn form(&self, stage: Stage) -> Option<&FilledForm> {
        self.forms
            .iter()
            .rev()
            .find(|form| form.answers.stage == stage)
    }

    /// The answer to an item at a stage.
    pub fn answer(&self, stage: Stage, item: &str) -> Option<&Answer> {
        self.form(stage)?.answers.get(item)
    }

    /// The record for the tables that have a row per session, which need no motion and no events.
    #[must_use]
    pub fn summary(&self) -> SessionRecord {
        let mut summary = self.clone();
        for run in &mut summary.runs {
            run.motion = Vec::new();
            run.events = Vec::new();
        }
        summary
    }
}
