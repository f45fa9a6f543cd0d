//! Settings of what makes a stay comfortable: measures of the body, the edge of the tracked space, walking.

use serde::{Deserialize, Serialize};

/// How height and reach are measured by one gesture: the arm stretched forward, the trigger closed on nothing.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct CalibrationConfig {
    /// Whether the gesture means anything.
    pub gesture: bool,
    /// How long it is held [s].
    pub hold_s: f64,
    /// How far the hand may move meanwhile [m].
    pub still_m: f64,
    /// Who has the eyes lower than this sits [m].
    pub seated_below_m: f64,
    /// Height of the eyes that rack and desk are made for, and to which somebody who sits is lifted [m].
    pub eye_height_m: f64,
}

/// What makes a stay comfortable.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ComfortConfig {
    /// A fence where the tracked space ends, seen when head or hands come near.
    pub fence: bool,
    /// From how near it is seen [m].
    pub fence_from_m: f64,
    /// Width and depth of the tracked space about its middle, where no runtime gives them; zeros for a space without an end [m].
    pub space_m: [f64; 2],
    /// The edge of the picture darkens while the participant walks by button.
    pub vignette: bool,
    /// Half angle that stays clear at full speed [degrees].
    pub vignette_clear_deg: f64,
}
