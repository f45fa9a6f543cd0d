//! Every number that an experimenter may want to change: typed, layered, checked in one function.
//!
//! Layers, weakest first: `default.toml` (complete), a scene, a condition, the command line. Field names are the keys, so
//! they carry their units. An experiment never continues on a guess: an unknown key, a value of the wrong type or out of
//! range ends the program with one sentence that names the file, the line and the key.

mod alley;
mod comfort;
pub(crate) mod coulomb;
mod effects;
mod guidance;
mod layers;
mod origins;
mod practice;
mod session;
mod shows;
mod sound;
mod things;
mod validate;
mod wording;

use serde::{Deserialize, Serialize};

pub use alley::{
    DeskConfig, GutterConfig, KickbackConfig, LaneConfig, PitConfig, RackConfig, RoomConfig,
    StartConfig,
};
pub use comfort::{CalibrationConfig, ComfortConfig};
pub use coulomb::{CoulombConfig, PairConfig};
pub use effects::{EffectName, OilConfig};
pub use guidance::GuidanceConfig;
pub use layers::{ConfigError, Layer};
pub use practice::PracticeConfig;
pub use session::{
    DisplayConfig, DisplayProfile, DisplayProfileName, ParticipantConfig, PinsetterConfig,
    RulesConfig, TrackingConfig,
};
pub use shows::{MarkingsConfig, ShowsConfig};
pub use sound::SoundConfig;
pub use things::{
    BallConfig, HandConfig, PinConfig, PinEllipsoidConfig, PinPartsConfig, ReleaseConfig,
    ReleaseFit, WalkingConfig,
};

/// The complete, checked settings of one condition.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Config {
    /// How the world steps.
    pub physics: PhysicsConfig,
    /// What every object is made of, and which shape it has: Table 1 of the paper.
    pub objects: ObjectsConfig,
    /// How pairs of surfaces meet under Coulomb's law.
    pub coulomb: CoulombConfig,
    /// Oil on the lane.
    pub oil: OilConfig,
    /// What is seen of it all.
    pub shows: ShowsConfig,
    /// The lane and the pin deck.
    pub lane: LaneConfig,
    /// What is painted on lane and approach.
    pub markings: MarkingsConfig,
    /// The gutters on both sides.
    pub gutter: GutterConfig,
    /// The plates on both sides of the pin deck.
    pub kickback: KickbackConfig,
    /// Where ball and pins fall behind the deck.
    pub pit: PitConfig,
    /// The walls, and the line that is painted on the floor.
    pub room: RoomConfig,
    /// Where the participant stands at first.
    pub start: StartConfig,
    /// The rack that the balls lie on.
    pub rack: RackConfig,
    /// The desk with the Red and Blue buttons.
    pub desk: DeskConfig,
    /// The balls on the rack, from the far end to the near one.
    pub balls: Vec<BallConfig>,
    /// The pins.
    pub pin: PinConfig,
    /// The hand.
    pub hand: HandConfig,
    /// Walking with the thumb buttons.
    pub walking: WalkingConfig,
    /// How a release velocity is estimated from poses alone.
    pub release: ReleaseConfig,
    /// What is down, when a throw ends.
    pub rules: RulesConfig,
    /// The machine that clears and sets the pins, and brings the ball back.
    pub pinsetter: PinsetterConfig,
    /// The tracker.
    pub tracking: TrackingConfig,
    /// What the participant sees through.
    pub display: DisplayConfig,
    /// The scripted participant.
    pub participant: ParticipantConfig,
    /// How contacts sound.
    pub sound: SoundConfig,
    /// What helps a newcomer.
    pub guidance: GuidanceConfig,
    /// How height and reach are measured.
    pub calibration: CalibrationConfig,
    /// What makes a stay comfortable.
    pub comfort: ComfortConfig,
    /// Throws without a game.
    pub practice: PracticeConfig,
}

/// How the world steps.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PhysicsConfig {
    /// Fixed physics steps per second [1/s].
    pub step_hz: f64,
    /// Acceleration of gravity [m/s2].
    pub gravity_mps2: f64,
    /// Which collision response.
    pub response: ResponseModel,
    /// Most iterations of one detection (the paper: 20).
    pub iteration_cap: u32,
    /// Interval over which a lasting contact takes the friction rate once [s].
    pub friction_reference_s: f64,
    /// What the steps compute; an effect that is not listed executes nothing.
    pub effects: Vec<EffectName>,
    /// Arm at which a contact's force resists rolling, read with the effect `rolling_resistance` [m].
    pub rolling_resistance_m: f64,
    /// Density of the air, read with the effect `drag` [kg/m3].
    pub air_density_kgpm3: f64,
}

/// The collision response of the world.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum ResponseModel {
    /// Eq. (3)-(9) to the letter.
    UnoSlater,
    /// The same without pull and without hop.
    Guarded,
    /// Restitution with a cone of friction, pair by pair from its own table: the physical reference.
    Coulomb,
}

/// What every object is made of: Table 1 of the paper.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ObjectsConfig {
    /// The paper's elasticity, from 0 to 1; a pair of objects uses the product.
    pub elasticity: f64,
    /// The paper's friction, from 0 to 1; a pair of objects uses the product.
    pub friction_rate: f64,
    /// Which shape objects collide with.
    pub shape: ObjectShape,
}

/// The shape that objects collide with.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum ObjectShape {
    /// The paper's *true shape*: a composite of parametric primitives.
    True,
    /// One ellipsoid for each object that moves.
    Ellipsoid,
}

#[cfg(test)]
pub(crate) mod tests;
