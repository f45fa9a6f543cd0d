//! Devices: what bowls. Each yields one [`Input`] per displayed frame.

pub mod desk;
pub mod gamepad;
pub mod headset;
pub mod script;

use game::{Game, Input};

/// Longest time that one frame makes up for [s]: after a longer stall the alley goes on from where it was.
pub const LONGEST_CATCH_UP_S: f64 = 0.25;

/// Something that a participant holds or is.
pub trait Device {
    /// The input of the next frame; `game` is as the last frame left it, and is what can be seen.
    fn next(&mut self, game: &Game) -> Input;

    /// The input of a frame in which the participant is asked something; people do then as they like.
    fn wait(&mut self, game: &Game) -> Input {
        self.next(game)
    }

    /// True when there is nothing left to do for it, or it wants to stop.
    fn is_done(&self) -> bool;
}
