//! Settings of what helps a newcomer. None of them reaches a game's results.

use serde::{Deserialize, Serialize};

/// What helps a newcomer, and in which words.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct GuidanceConfig {
    /// File of every word that a participant can see, in the folder of the configuration.
    pub words: String,
    /// What the hand could take, or holds, glows.
    pub glow: bool,
    /// Three hints in the room until the first throw is over.
    pub hints: bool,
    /// How a ball was let go, on the scoreboard and over the window.
    pub feedback: bool,
}
