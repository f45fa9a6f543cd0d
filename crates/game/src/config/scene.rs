//! Settings of what a scene shows and lets be heard.

use serde::{Deserialize, Serialize};

/// What a scene lists; what is not listed is not built and costs nothing.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SceneConfig {
    /// What is shown and heard.
    pub effects: Vec<SceneEffect>,
}

/// Something that a scene may list.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum SceneEffect {
    /// What contacts sound like, on the card and in videos.
    Sound,
}

/// How it sounds; read with the scene's effect `sound`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SoundConfig {
    /// Pressure at the ears that the loudest sample stands for [Pa]: less is louder.
    pub full_scale_pa: f64,
    /// Width of the hall whose reverberation is heard, neighbouring lanes included [m].
    pub hall_width_m: f64,
    /// Its height [m].
    pub hall_height_m: f64,
    /// Its length [m].
    pub hall_length_m: f64,
    /// Time in which a sound in it falls by 60 dB [s].
    pub reverberation_s: f64,
    /// How long before it is heard a contact may still be reported [s]: a frame and its jitter. It is part of the latency.
    pub lookahead_s: f64,
    /// Whether sound takes its time to the ears.
    pub is_delayed_by_distance: bool,
}

impl SceneConfig {
    /// Whether `effect` is listed.
    pub fn lists(&self, effect: SceneEffect) -> bool {
        self.effects.contains(&effect)
    }
}
