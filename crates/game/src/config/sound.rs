//! Settings of what is heard.

use serde::{Deserialize, Serialize};

/// How contacts sound; read where the scene shows `sound`.
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
