//! The rules of the alley: hands, balls, pins, pinsetter, conditions and scores. No graphics, no headset, no clock.
//!
//! [`Game::step`] consumes one [`Input`] and advances the alley by whole physics steps. The same inputs give the same bits,
//! which [`Game::hash`] checks. World frame: origin at the middle of the foul line on the lane's surface, x to the bowler's
//! right, y up, the lane runs along -z; SI units and radians.
#![cfg_attr(test, allow(clippy::disallowed_methods))]

mod alley;
mod assist;
mod ball_return;
mod bare_alley;
mod bodies;
mod buttons;
mod calibrate;
mod components;
mod condition;
mod config;
mod contacts;
mod contest;
mod event;
mod grab;
mod hand;
mod holes;
mod input;
mod observe;
mod pause;
mod pin_shape;
mod pinsetter;
mod release;
mod room;
mod score;
mod throw;
mod visible;
mod walk;

use glam::DVec3;
use physics::{Pose, Stopwatch, Unwatched};

pub use bare_alley::{BareAlley, BareAlleyError};
pub use condition::{Button, Conditions};
pub use config::{
    BallConfig, CalibrationConfig, ComfortConfig, Config, ConfigError, CoulombConfig, DeskConfig,
    DisplayConfig, DisplayProfile, DisplayProfileName, EffectName, GuidanceConfig, GutterConfig,
    HandConfig, KickbackConfig, LaneConfig, Layer, MarkingsConfig, ObjectShape, ObjectsConfig,
    OilConfig, PairConfig, ParticipantConfig, PhysicsConfig, PinConfig, PinEllipsoidConfig,
    PinPartsConfig, PinsetterConfig, PitConfig, PracticeConfig, RackConfig, ReleaseConfig,
    ReleaseFit, ResponseModel, RoomConfig, RulesConfig, ShowsConfig, SoundConfig, StartConfig,
    TrackingConfig, WalkingConfig,
};
pub use contacts::{Contact, RollingBall};
pub use event::{
    Assist, EndReason, Event, EventKind, Release, ReleaseSource, ReleaseVelocity, TrackedPart,
};
pub use holes::{FINGERS_IN_HAND, HALF_SPAN, THUMB_IN_HAND, hand_on_ball};
pub use input::{Input, Tracked, TriggerChange, Velocity};
pub use observe::{BallSeen, ButtonSeen, Observation, Phase, PinSeen, ThrowSeen};
pub use score::{Delivery, PINS, Roll, ScoreError, ScoreSheet};
pub use visible::{Model, Visible};

use calibrate::{Fitted, HeldOut};
use contest::Pending;
use hand::Hand;
use room::Room;
use throw::Stage;

/// Most frames that a game can have.
pub const MAX_FRAMES: u32 = 10;

/// Why a session cannot begin.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum GameError {
    /// The number of frames is impossible.
    #[error("a game has from 1 to {MAX_FRAMES} frames, not {0}; give another number of frames")]
    Frames(u32),
    /// Something that one session has once differs between the conditions.
    #[error(
        "{0} must be the same under Red and Blue; set it in default.toml or the scene instead of a condition"
    )]
    DifferingCondition(&'static str),
    /// Physics refuses its settings.
    #[error(transparent)]
    Settings(#[from] physics::SettingsError),
    /// Physics refuses a size.
    #[error(transparent)]
    Shape(#[from] physics::ShapeError),
    /// Physics refuses the lane's oil.
    #[error(transparent)]
    Oil(#[from] physics::OilError),
}

/// A session: the room, the participant in it, and the games that are played.
pub struct Game {
    conditions: Conditions,
    frames: u32,
    room: Room,
    steps: u64,
    /// The head as it is tracked; `None` while it is not.
    head: Option<Tracked>,
    world_from_tracking: Pose,
    walking_speed: f64,
    rig_velocity: DVec3,
    hand: Hand,
    /// Whether the head's ground point was beyond the foul line when it was last tracked.
    head_was_beyond: bool,
    stage: Stage,
    playing: Option<Button>,
    sheets: [ScoreSheet; 2],
    pending: Option<Pending>,
    /// What the hand let go last, and how.
    let_go: Option<(hecs::Entity, ReleaseVelocity)>,
    /// The last throw, to look at.
    last_throw: Option<ThrowSeen>,
    throws_over: u32,
    is_paused: bool,
    held_out: Option<HeldOut>,
    /// Heights of rack and desk before anybody was measured.
    furniture: Fitted,
    pressed: Vec<Button>,
    keys: [bool; 2],
    impacts: Vec<Contact>,
    contacts: Vec<Contact>,
    events: Vec<Event>,
}

/// What the room and the session have once, whichever button is pressed, and a condition set to something else.
///
/// The building is drawn once, and a session has one display, one tracker and one participant.
fn differing(condition: &Config, lobby: &Config) -> Option<&'static str> {
    let once = [
        (
            "physics.step_hz",
            condition.physics.step_hz != lobby.physics.step_hz,
        ),
        ("shows", condition.shows != lobby.shows),
        ("lane", condition.lane != lobby.lane),
        ("markings", condition.markings != lobby.markings),
        ("gutter", condition.gutter != lobby.gutter),
        ("kickback", condition.kickback != lobby.kickback),
        ("pit", condition.pit != lobby.pit),
        ("room", condition.room != lobby.room),
        ("start", condition.start != lobby.start),
        ("rack", condition.rack != lobby.rack),
        ("desk", condition.desk != lobby.desk),
        (
            "the diameter of the balls",
            !condition
                .balls
                .iter()
                .map(|ball| ball.diameter_m)
                .eq(lobby.balls.iter().map(|ball| ball.diameter_m)),
        ),
        ("tracking", condition.tracking != lobby.tracking),
        ("display", condition.display != lobby.display),
        ("participant", condition.participant != lobby.participant),
        ("sound", condition.sound != lobby.sound),
        ("guidance", condition.guidance != lobby.guidance),
        ("calibration", condition.calibration != lobby.calibration),
        ("comfort", condition.comfort != lobby.comfort),
        ("practice", condition.practice != lobby.practice),
    ];
    once.into_iter()
        .find(|(_, differs)| *differs)
        .map(|(name, _)| name)
}

impl Game {
    /// A session in the lobby: the room of the scene, nobody playing.
    ///
    /// # Errors
    /// When the number of frames is not from 1 to [`MAX_FRAMES`], or a condition's room cannot be built.
    pub fn new(conditions: Conditions, frames: u32) -> Result<Self, GameError> {
        if !(1..=MAX_FRAMES).contains(&frames) {
            return Err(GameError::Frames(frames));
        }
        for button in Button::BOTH {
            let config = conditions.of(button);
            if let Some(setting) = differing(config, &conditions.lobby) {
                return Err(GameError::DifferingCondition(setting));
            }
            Room::new(config)?;
        }
        let start = &conditions.lobby.start;
        let world_from_tracking = Pose::from_position(DVec3::new(start.x_m, 0.0, start.z_m));
        Ok(Self {
            room: Room::new(&conditions.lobby)?,
            furniture: Fitted::as_set(&conditions.lobby),
            conditions,
            frames,
            steps: 0,
            head: None,
            world_from_tracking,
            walking_speed: 0.0,
            rig_velocity: DVec3::ZERO,
            hand: Hand::default(),
            head_was_beyond: false,
            stage: Stage::Ready {
                disturbed_since: None,
            },
            playing: None,
            sheets: [ScoreSheet::new(frames), ScoreSheet::new(frames)],
            pending: None,
            let_go: None,
            last_throw: None,
            throws_over: 0,
            is_paused: false,
            held_out: None,
            pressed: Vec::new(),
            keys: [false; 2],
            impacts: Vec::new(),
            contacts: Vec::new(),
            events: Vec::new(),
        })
    }

    /// Consumes one frame's input and advances the alley by `input.steps` physics steps.
    pub fn step(&mut self, input: &Input) {
        self.step_watched(input, &mut Unwatched);
    }

    /// The same, while `watch` is told the stages of the physics; the game is the same with every watch.
    pub fn step_watched(&mut self, input: &Input, watch: &mut impl Stopwatch) {
        self.events.clear();
        let input = &self.heed_pause(input);
        self.track_head(input);
        self.go_to_start(input);
        self.walk(input);
        self.track_hand(input);
        let let_go = self.let_go_within(input);
        for step in 1..=input.steps {
            let share = f64::from(step) / f64::from(input.steps);
            if let Some(moment) = let_go.filter(|moment| moment.before_step == step) {
                self.release(moment);
            }
            self.reach(share);
            self.push_buttons(share);
            self.clear_pit();
            self.run_pinsetter();
            self.return_strays();
            if step == input.steps {
                self.room.keep_poses();
            }
            self.room.world.step_watched(watch);
            self.steps += 1;
            self.notice_impacts();
            self.watch_foul_line();
            self.follow_throw();
            self.watch_pins();
        }
        self.report_impacts();
        self.feel();
        self.grip(input, let_go);
        self.press_keys(input);
        self.press(input.locked);
        self.watch_gesture(input);
    }

    /// Adds a fact of this instant.
    fn record(&mut self, kind: EventKind) {
        self.events.push(Event {
            step: self.steps,
            kind,
        });
    }

    /// Keys press on the way down, as the buttons in the room do.
    fn press_keys(&mut self, input: &Input) {
        let keys = [input.press_red, input.press_blue];
        for (button, (is_down, was_down)) in Button::BOTH
            .into_iter()
            .zip(keys.into_iter().zip(self.keys))
        {
            if is_down && !was_down {
                self.pressed.push(button);
            }
        }
        self.keys = keys;
    }
}
