//! Settings of a session: rules, machine, tracker, display, scripted participant.

use serde::{Deserialize, Serialize};

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
    /// Standard deviation of the wrist's turn about the way ahead at the lowest point [revolutions/min]: side spin.
    pub side_spin_scatter_rpm: f64,
    /// Standard deviation of its turn about the vertical there [revolutions/min]: tilted spin.
    pub tilt_spin_scatter_rpm: f64,
    /// How far behind the foul line the swing takes place [m].
    pub stand_behind_foul_line_m: f64,
    /// Where on the pin deck the ball is meant to arrive, to the right of the head pin [m].
    pub target_x_m: f64,
}
