//! The backend without a card: a list of events becomes samples.

use crate::event::Event;
use crate::mixer::{Mixer, Settings};

/// What is heard from time zero to `duration_s`, left ear first.
///
/// The same events give the same samples, on every machine: all that is not exact arithmetic comes from `libm`.
pub fn render(settings: &Settings, events: &[Event], duration_s: f64) -> Vec<[f32; 2]> {
    let mut mixer = Mixer::new(settings);
    let length = (duration_s.max(0.0) * mixer.sample_rate()) as usize;
    let mut samples = vec![[0.0; 2]; length];
    let mut waiting: Vec<Event> = events.to_vec();
    waiting.sort_by(|a, b| a.time_s.total_cmp(&b.time_s));
    let mut waiting = waiting.into_iter().peekable();
    // A quarter of a second at a time: a long session has more events than a mixer lets wait.
    for block in samples.chunks_mut(mixer.sample_rate() as usize / 4) {
        let end = mixer.time() + 0.3;
        while let Some(event) = waiting.next_if(|event| event.time_s < end) {
            mixer.submit(event);
        }
        mixer.render(block);
    }
    samples
}
