//! What a scene shows, and where its paint is: pictures only, nothing of it reaches the physics.

use serde::{Deserialize, Serialize};

/// What a scene shows; what is off costs nothing.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ShowsConfig {
    /// Filtered shadows of the light over lane and approach.
    pub shadows: bool,
    /// Lamps, pins and balls mirrored in the lanes' varnish.
    pub reflection: bool,
    /// Less light where things stand close and where walls meet.
    pub ambient_occlusion: bool,
    /// The lanes on both sides, with their pins.
    pub neighbouring_lanes: bool,
    /// Seats, scoreboards, and what else only belongs to an alley.
    pub furnishings: bool,
    /// Textures, patterns and gloss; without them every face has one colour.
    pub materials: bool,
    /// Four samples a pixel, textures with smaller copies, and highlights as wide as a pixel needs.
    pub smooth_edges: bool,
    /// Round things of few corners.
    pub low_polygon: bool,
    /// The last throw again, from behind the pins, on the screen over the lane.
    pub replay: bool,
    /// What contacts sound like, on the card and in videos.
    pub sound: bool,
}

/// What is painted on lane and approach; boards are counted from the right edge, 39 to a lane.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct MarkingsConfig {
    /// Board of each arrow.
    pub arrow_boards: Vec<u32>,
    /// Tip of each arrow, behind it the lane's end is farther [m].
    pub arrow_z_m: Vec<f64>,
    /// Boards of the dots on the lane.
    pub lane_dot_boards: Vec<u32>,
    /// Where they are [m].
    pub lane_dots_z_m: f64,
    /// Boards of the dots on the approach.
    pub approach_dot_boards: Vec<u32>,
    /// Rows of them [m].
    pub approach_dots_z_m: Vec<f64>,
}
