//! The system's sound card, found without a word on the terminal.
//!
//! Where there is no card ALSA itself writes eight lines to the standard error stream as soon as its default device is
//! opened. Whether there is one cannot be told from `/proc/asound/cards` alone: under WSL, in containers and on
//! thin clients the default device leads to a sound server, without a card of the kernel's. An own configuration would
//! hide a user's. So the device is tried once, by a thread that has ALSA keep its messages in memory, and kira opens only
//! what opened then.

use kira::backend::cpal::cpal::traits::{DeviceTrait, HostTrait};
use kira::backend::cpal::cpal::{
    BufferSize, Device, SampleFormat, StreamConfig, SupportedBufferSize, default_host,
};

use super::NoSound;

/// Samples between two calls of the audio thread: 5 ms at 48 kHz.
const PERIOD: u32 = 256;

/// A card, and how it is to be played.
pub(super) struct Card {
    pub device: Device,
    pub config: StreamConfig,
    pub sample_rate: u32,
    /// Samples that the card takes at once.
    pub period: u32,
}

/// The default card, at `wanted_rate` [Hz] where it can do that.
pub(super) fn find(wanted_rate: u32) -> Result<Card, NoSound> {
    #[cfg(target_os = "linux")]
    let _messages = opens_quietly()?;
    let refused = |error: kira::backend::cpal::cpal::Error| NoSound::Refused(error.to_string());
    let device = default_host()
        .default_output_device()
        .ok_or(NoSound::NoCard)?;
    let fallback = device.default_output_config().map_err(refused)?;
    let wanted = device
        .supported_output_configs()
        .map_err(refused)?
        .filter(|range| range.channels() == 2 && range.sample_format() == SampleFormat::F32)
        .find_map(|range| range.try_with_sample_rate(wanted_rate));
    let supported = wanted.unwrap_or(fallback);
    let period = match supported.buffer_size() {
        SupportedBufferSize::Range { min, max } => PERIOD.clamp(*min, (*max).max(*min)),
        SupportedBufferSize::Unknown => PERIOD,
    };
    let config = StreamConfig {
        buffer_size: BufferSize::Fixed(period),
        ..supported.config()
    };
    Ok(Card {
        device,
        sample_rate: config.sample_rate,
        config,
        period,
    })
}

/// Opens ALSA's default device and closes it again; as long as the result lives ALSA's messages from this thread go there.
#[cfg(target_os = "linux")]
fn opens_quietly() -> Result<impl Sized, NoSound> {
    let messages = alsa::Output::local_error_handler().map_err(|_| NoSound::NoCard)?;
    alsa::PCM::new("default", alsa::Direction::Playback, true).map_err(|_| NoSound::NoCard)?;
    Ok(messages)
}
