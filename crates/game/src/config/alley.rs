//! Settings of the building: lane, gutters, pit, room, rack and desk.

use serde::{Deserialize, Serialize};

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
    /// From the middle of one lane to that of the next, for the picture [m].
    pub lane_pitch_m: f64,
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
