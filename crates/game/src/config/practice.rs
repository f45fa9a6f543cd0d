//! Settings of practice: throws at any pins, as often as one likes, without a game.

use serde::{Deserialize, Serialize};

/// Throws without a game.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PracticeConfig {
    /// No game can be begun.
    pub only: bool,
    /// Numbers of the pins that stand before each throw outside a game; empty for all ten.
    pub leave: Vec<u8>,
    /// The oil is seen on the lane, and the way of the last ball.
    pub shows_lane: bool,
}

impl PracticeConfig {
    /// Whether a pin stands before a throw.
    pub(crate) fn stands(&self, pin: u8) -> bool {
        self.leave.is_empty() || self.leave.contains(&pin)
    }
}
