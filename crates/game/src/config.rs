//! Every number that an experimenter may want to change: typed, layered, checked in one function.
//!
//! Layers, weakest first: `default.toml` (complete), a scene, a condition, the command line. Field names are the keys, so
//! they carry their units. An experiment never continues on a guess: an unknown key, a value of the wrong type or out of
//! range ends the program with one sentence that names the file, the line and the key.

mod layers;
mod validate;

use serde::{Deserialize, Serialize};

pub use layers::{ConfigError, Layer};

/// The complete, checked settings of one condition.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Config {
    /// How the world steps.
    pub physics: PhysicsConfig,
    /// What every object is made of, and which shape it has: Table 1 of the paper.
    pub objects: ObjectsConfig,
    /// The lane and the pin deck.
    pub lane: LaneConfig,
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
    /// Whether bodies at rest are left out of the work.
    pub sleeping: bool,
}

/// The collision response of the world.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum ResponseModel {
    /// Eq. (3)-(9) to the letter.
    UnoSlater,
    /// The same without pull and without hop.
    Guarded,
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

/// The lane and the pin deck; the origin is the centre of the foul line, the lane runs along -z.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct LaneConfig {
    /// Width without gutters [m].
    pub width_m: f64,
    /// Boards across the width, for the picture.
    pub boards: u32,
    /// Thickness of the boards [m].
    pub thickness_m: f64,
    /// Centre of the head pin's spot [m].
    pub headpin_z_m: f64,
    /// Rear end of the pin deck [m].
    pub deck_end_z_m: f64,
    /// Distance between neighbouring pin spots [m].
    pub pin_spacing_m: f64,
    /// Distance between the rows of pin spots [m].
    pub row_pitch_m: f64,
}

/// The gutters.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct GutterConfig {
    /// Width [m].
    pub width_m: f64,
    /// Depth of the round part at its middle [m].
    pub depth_m: f64,
    /// Flat strips that stand for the round part.
    pub facets: u32,
    /// Depth of the flat part beside the deck [m].
    pub depth_at_deck_m: f64,
    /// How far before the head pin the flat part begins [m].
    pub flat_starts_before_headpin_m: f64,
}

/// The kickbacks: plates on both sides of the deck and the pit.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct KickbackConfig {
    /// Height above the deck [m].
    pub height_m: f64,
    /// Thickness [m].
    pub thickness_m: f64,
    /// How far before the head pin they begin [m].
    pub starts_before_headpin_m: f64,
}

/// The pit behind the deck, and the cushion that stops what comes.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PitConfig {
    /// How far its floor lies below the deck [m].
    pub floor_below_deck_m: f64,
    /// Distance from the deck's end to the cushion's face [m].
    pub cushion_behind_deck_m: f64,
    /// Thickness of the cushion [m].
    pub cushion_thickness_m: f64,
    /// Height of the cushion above the deck [m].
    pub cushion_height_m: f64,
}

/// The room around the lane.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RoomConfig {
    /// Distance from the lane's middle to each side wall [m].
    pub half_width_m: f64,
    /// Distance from the foul line to the wall behind the participant [m].
    pub depth_m: f64,
    /// Height of the ceiling [m].
    pub height_m: f64,
    /// How close the head may walk to a wall [m].
    pub walk_margin_m: f64,
    /// Length of the approach behind the foul line, for the picture [m].
    pub approach_length_m: f64,
    /// Width of the foul line [m].
    pub foul_line_width_m: f64,
}

/// Where the tracking space lies at first.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct StartConfig {
    /// To the right of the lane's middle [m].
    pub x_m: f64,
    /// Behind the foul line [m].
    pub z_m: f64,
}

/// The rack: a tray with a cell for each ball, in a row along the lane's direction.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RackConfig {
    /// Middle of the row, to the right of the lane's middle [m].
    pub x_m: f64,
    /// Middle of the row, behind the foul line [m].
    pub z_m: f64,
    /// Height of the tray that the balls lie on [m].
    pub tray_height_m: f64,
    /// Height of the rims above the tray [m].
    pub rim_height_m: f64,
    /// Thickness of the rims between cells and around them [m].
    pub rim_thickness_m: f64,
    /// Gap between a ball and the rims around it [m].
    pub clearance_m: f64,
}

/// The desk with the Red and Blue buttons.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct DeskConfig {
    /// Middle of the desk, to the right of the lane's middle [m].
    pub x_m: f64,
    /// Middle of the desk, behind the foul line [m].
    pub z_m: f64,
    /// Height of its top [m].
    pub height_m: f64,
    /// Width along x [m].
    pub width_m: f64,
    /// Depth along z [m].
    pub depth_m: f64,
    /// Distance between the two buttons' middles [m].
    pub button_spacing_m: f64,
    /// Radius of a button [m].
    pub button_radius_m: f64,
    /// How high a button stands above the desk when nothing presses it [m].
    pub button_travel_m: f64,
    /// Part of its travel at which a button counts as pressed, from 0 to 1.
    pub button_press_at: f64,
}

/// One ball.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct BallConfig {
    /// Diameter [m].
    pub diameter_m: f64,
    /// Mass [kg].
    pub mass_kg: f64,
    /// Radius of gyration about every axis [m].
    pub rg_m: f64,
}

impl BallConfig {
    /// Radius [m].
    pub fn radius_m(&self) -> f64 {
        self.diameter_m / 2.0
    }
}

/// The pins: what they weigh is the same for both shapes.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PinConfig {
    /// Mass [kg].
    pub mass_kg: f64,
    /// Height of the whole pin [m].
    pub height_m: f64,
    /// Centre of gravity above the base [m].
    pub cg_height_m: f64,
    /// Moment of inertia about the long axis [kg m2].
    pub i_axial_kgm2: f64,
    /// Moment of inertia about any axis across it, through the centre of gravity [kg m2].
    pub i_transverse_kgm2: f64,
    /// The composite of the true shape.
    pub parts: PinPartsConfig,
    /// The single ellipsoid.
    pub ellipsoid: PinEllipsoidConfig,
}

/// The primitives of a pin's true shape; heights above the base.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PinPartsConfig {
    /// Radius of the flat base [m].
    pub base_radius_m: f64,
    /// Height at which the foot's cone ends [m].
    pub foot_height_m: f64,
    /// Radius of the foot's cone there [m].
    pub foot_radius_m: f64,
    /// Height of the belly ellipsoid's middle [m].
    pub belly_height_m: f64,
    /// Semi-axis of the belly across [m].
    pub belly_radius_m: f64,
    /// Semi-axis of the belly along the pin [m].
    pub belly_half_length_m: f64,
    /// Height at which the shoulder's cone begins [m].
    pub shoulder_height_m: f64,
    /// Radius of the shoulder's cone there [m].
    pub shoulder_radius_m: f64,
    /// Height of the narrowest place [m].
    pub neck_height_m: f64,
    /// Radius there [m].
    pub neck_radius_m: f64,
    /// Height at which the throat's cone ends, within the head [m].
    pub throat_height_m: f64,
    /// Radius of the throat's cone there [m].
    pub throat_radius_m: f64,
    /// Height of the head's middle [m].
    pub head_height_m: f64,
    /// Radius of the head [m].
    pub head_radius_m: f64,
}

/// The single ellipsoid, cut flat at the base so that it stands.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PinEllipsoidConfig {
    /// Semi-axis across [m].
    pub radius_m: f64,
    /// Semi-axis along the pin; the top of the ellipsoid is the top of the pin [m].
    pub half_length_m: f64,
}

/// The hand: a sphere that pushes what it touches.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct HandConfig {
    /// Radius [m].
    pub radius_m: f64,
    /// Farthest distance from the hand's middle to the surface of what it grabs [m].
    pub reach_m: f64,
    /// Trigger at which an open hand closes, from 0 to 1.
    pub trigger_close: f64,
    /// Trigger at which a closed hand opens, from 0 to 1.
    pub trigger_open: f64,
    /// Faster than this between two frames, the tracker has jumped and pushes nothing [m/s].
    pub jump_speed_mps: f64,
}

/// Walking with the thumb buttons.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct WalkingConfig {
    /// Full speed [m/s].
    pub speed_mps: f64,
    /// Time from standing to full speed, and back [s].
    pub ramp_s: f64,
}

/// How a release velocity is estimated from poses alone.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ReleaseConfig {
    /// Poses no older than this at the release are fitted [s].
    pub window_s: f64,
    /// The curve that is fitted.
    pub fit: ReleaseFit,
}

/// The curve that is fitted to the last poses.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum ReleaseFit {
    /// A straight line: robust against noise, late by half the window.
    Linear,
    /// A parabola: follows a swing that gathers speed.
    Quadratic,
    /// A cubic: follows a swing past its fastest place.
    Cubic,
}

/// What is down, and when a throw ends.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RulesConfig {
    /// A pin that leans more than this is down [degrees].
    pub down_lean_deg: f64,
    /// A pin whose base is farther below the deck than this has left it [m].
    pub left_deck_below_m: f64,
    /// A pin closer to a kickback than this lies against it [m].
    pub against_kickback_m: f64,
    /// Slower than this at its fastest point, a thing is still [m/s].
    pub still_speed_mps: f64,
    /// A pin that leans less than this and turns slower than `rocking_turn_radps` only rocks: it cannot fall any more and
    /// counts as still [degrees].
    pub rocking_lean_deg: f64,
    /// See `rocking_lean_deg`; a pin tips from about 1.2 rad/s [rad/s].
    pub rocking_turn_radps: f64,
    /// How long everything must be still before the throw ends [s].
    pub still_for_s: f64,
    /// A throw ends this long after the ball passes the head pin, still or not [s].
    pub end_after_headpin_s: f64,
    /// A throw ends this long after the ball crosses the foul line, wherever the ball is [s].
    pub end_after_foul_line_s: f64,
    /// A second press counts as the confirmation for this long [s].
    pub confirm_within_s: f64,
    /// A pin farther than this from its spot, with no ball delivered, is put back [m].
    pub disturbed_pin_m: f64,
    /// A ball that lies on the floor this long goes back to the rack [s].
    pub stray_ball_s: f64,
    /// Impacts slower than this are not reported [m/s].
    pub impact_reported_from_mps: f64,
}

/// The machine that clears and sets the pins; how long each of its movements takes.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PinsetterConfig {
    /// Pause between the end of a throw and the first movement [s].
    pub pause_s: f64,
    /// Lifting the standing pins [s].
    pub lift_s: f64,
    /// Height that they are lifted to [m].
    pub lift_height_m: f64,
    /// Lowering the sweep bar in front of the pins [s].
    pub bar_drop_s: f64,
    /// Sweeping the deck [s].
    pub sweep_s: f64,
    /// Setting the pins down [s].
    pub set_s: f64,
    /// Height of the sweep bar itself [m].
    pub bar_height_m: f64,
    /// Height at which the sweep bar waits, above the deck [m].
    pub bar_rest_height_m: f64,
    /// A pin that has lain in the pit this long is taken away [s].
    pub pit_clears_after_s: f64,
    /// Time from the pit to the rack [s].
    pub ball_return_s: f64,
    /// Time the lift takes to raise the ball into its cell [s].
    pub ball_lift_s: f64,
}

/// The tracker.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct TrackingConfig {
    /// Poses per second, when no display gives the rate [1/s].
    pub rate_hz: f64,
}

/// What the participant sees through.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct DisplayConfig {
    /// Which of the two profiles is used.
    pub profile: DisplayProfileName,
    /// Distance between the eyes [m].
    pub eye_distance_m: f64,
    /// A headset of today.
    pub modern: DisplayProfile,
    /// The headset of the experiment.
    #[serde(rename = "1996")]
    pub of_1996: DisplayProfile,
}

impl DisplayConfig {
    /// The profile that is used.
    pub fn current(&self) -> &DisplayProfile {
        match self.profile {
            DisplayProfileName::Modern => &self.modern,
            DisplayProfileName::Of1996 => &self.of_1996,
        }
    }
}

/// Names of the display profiles.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum DisplayProfileName {
    /// A headset of today.
    #[serde(rename = "modern")]
    Modern,
    /// The headset of the experiment.
    #[serde(rename = "1996")]
    Of1996,
}

/// One eye's image: its angles are what holds, its pixels need not be square.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct DisplayProfile {
    /// Angle from straight ahead to the edge away from the nose [degrees].
    pub outer_deg: f64,
    /// Angle from straight ahead to the edge at the nose [degrees].
    pub inner_deg: f64,
    /// Angle from straight ahead to the upper edge [degrees].
    pub up_deg: f64,
    /// Angle from straight ahead to the lower edge [degrees].
    pub down_deg: f64,
    /// Width of the image that is drawn [pixels].
    pub width_px: u32,
    /// Height of the image that is drawn [pixels].
    pub height_px: u32,
    /// Width of the panel that it is relayed to [pixels].
    pub relayed_width_px: u32,
    /// Height of the panel that it is relayed to [pixels].
    pub relayed_height_px: u32,
}

/// The scripted participant: measures, intentions and scatter.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ParticipantConfig {
    /// Height of the eyes above the floor [m].
    pub eye_height_m: f64,
    /// Height of the shoulder above the floor at the release [m].
    pub shoulder_height_m: f64,
    /// From the shoulder to the middle of the hand [m].
    pub arm_length_m: f64,
    /// Distance of the shoulder from the middle of the body [m].
    pub shoulder_offset_m: f64,
    /// Angle of the arm behind the vertical where the swing turns [degrees].
    pub backswing_deg: f64,
    /// Mean speed of the ball at the release [m/s].
    pub ball_speed_mps: f64,
    /// Standard deviation of that speed [m/s].
    pub ball_speed_scatter_mps: f64,
    /// Standard deviation of the direction [degrees].
    pub aim_scatter_deg: f64,
    /// Standard deviation of the place that the ball leaves the hand at, across the lane [m].
    pub place_scatter_m: f64,
    /// Standard deviation of the instant at which the hand opens [s].
    pub timing_scatter_s: f64,
    /// How far behind the foul line the swing takes place [m].
    pub stand_behind_foul_line_m: f64,
    /// Where on the pin deck the ball is meant to arrive, to the right of the head pin [m].
    pub target_x_m: f64,
}

#[cfg(test)]
pub(crate) mod tests;
