//! What there is to see, by name: the app chooses the meshes.

use glam::DVec3;
use physics::Pose;
use serde::{Deserialize, Serialize};

/// The name of a thing in the room, and the frame that its mesh is made in.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Model {
    /// A pin: origin at the middle of its base, axis +y. The number is that of its spot, from 1.
    Pin(u8),
    /// A ball: origin at its centre. The number is its place on the rack, from 0.
    Ball(u8),
    /// The hand: origin at the middle of the palm, -z along the fingers.
    Hand,
    /// The Red button: origin at the middle of its body, axis +y.
    RedButton,
    /// The Blue button: origin at the middle of its body, axis +y.
    BlueButton,
    /// The lane with the pin deck, a box.
    Lane,
    /// The floor that the participant walks on, boxes.
    Approach,
    /// The line that a throw must be made behind, a thin box that is painted on.
    FoulLine,
    /// A strip of a gutter, a box.
    Gutter,
    /// A kickback, a box.
    Kickback,
    /// The pit's floor, a box.
    Pit,
    /// The cushion behind the pit, a box.
    Cushion,
    /// The floor beside the gutters, a box.
    SideFloor,
    /// A wall of the room, a box.
    Wall,
    /// The ceiling, a box.
    Ceiling,
    /// A part of the ball rack, a box.
    Rack,
    /// The desk that the buttons stand on, a box.
    Desk,
    /// The pinsetter's sweep bar, a box.
    SweepBar,
    /// The pinsetter's rack, which carries pins by their heads: a box above them.
    SettingTable,
}

/// One thing to draw.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Visible {
    /// What it is.
    pub model: Model,
    /// `world_from_model`.
    pub pose: Pose,
    /// Full extent along the model's own axes [m]: what a unit box or a unit sphere is scaled by.
    pub size: DVec3,
    /// True while the hand could grab it or holds it, and while a button is pressed.
    pub is_highlighted: bool,
}
