//! The backend with a card, on kira: its audio thread pulls from the mixer.
//!
//! Events go through a queue that neither locks nor allocates. A game's clock and a card's run apart, so that each frame says what
//! time it is ([`Live::frame`]) and [`Timeline`] keeps the two together.

mod card;
mod timeline;

use kira::backend::cpal::{CpalBackend, CpalBackendSettings};
use kira::info::Info;
use kira::sound::{Sound, SoundData};
use kira::{AudioManager, AudioManagerSettings, Frame};
use rtrb::{Consumer, Producer, RingBuffer};

pub use timeline::Timeline;

use crate::event::Event;
use crate::mixer::{Mixer, QUANTUM, Settings};

/// Messages that may be under way to the audio thread: a crash of all pins in one frame is a hundred.
const QUEUE: usize = 4096;
/// Samples that are taken from the mixer at once.
const BLOCK: usize = 256;

/// Why there is no sound. The game goes on without; whether a person is told is the caller's choice.
#[derive(Debug, thiserror::Error)]
pub enum NoSound {
    /// There is no card, or none that may be used.
    #[error("this machine has no sound card that can be used")]
    NoCard,
    /// There is one that does not play.
    #[error("the sound card does not play: {0}")]
    Refused(String),
}

/// What the audio thread is told.
#[derive(Debug, Clone, Copy)]
enum Message {
    Event(Event),
    /// The game has come to this time [s].
    Now(f64),
}

/// A card that plays.
pub struct Live {
    queue: Producer<Message>,
    /// Dropping it ends the sound.
    _manager: AudioManager<CpalBackend>,
    sample_rate: u32,
    period: u32,
    lookahead_s: f64,
    lost: u64,
}

impl Live {
    /// Opens the system's default card and plays silence. `settings.sample_rate` gives way to what the card can do.
    ///
    /// `lookahead_s` is how long before it is heard an event may still come [s]: a frame of the game and its jitter.
    ///
    /// # Errors
    /// When there is no card or it does not play. Nothing is written to the terminal then.
    pub fn open(settings: Settings, lookahead_s: f64) -> Result<Self, NoSound> {
        // A thread of its own: ALSA's messages are caught for the thread that asks for it, see `card`.
        let opening = std::thread::Builder::new()
            .name("sound card".into())
            .spawn(move || open_here(settings, lookahead_s))
            .map_err(|error| NoSound::Refused(error.to_string()))?;
        let opened = opening.join();
        opened.unwrap_or_else(|_| Err(NoSound::Refused("its driver failed".into())))
    }

    /// Tells the audio thread that the game has come to `time_s`, and of what happened up to then.
    pub fn frame(&mut self, time_s: f64, events: impl IntoIterator<Item = Event>) {
        // The clock first, so that the events of the first frame have a time.
        let now = std::iter::once(Message::Now(time_s));
        for message in now.chain(events.into_iter().map(Message::Event)) {
            if self.queue.push(message).is_err() {
                self.lost += 1;
            }
        }
    }

    /// Events that found the queue full: the audio thread stands still.
    pub fn lost(&self) -> u64 {
        self.lost
    }

    /// Time from an event's [`frame`](Live::frame) to the card's output [ms]: what an event may be late, two of the card's
    /// periods, and one quantum. The converter and the air come on top, 1 ms and 3 ms a metre.
    pub fn latency_ms(&self) -> f64 {
        let buffered = f64::from(2 * self.period) + QUANTUM as f64;
        1000.0 * (self.lookahead_s + buffered / f64::from(self.sample_rate))
    }

    /// Samples per second that the card plays [Hz].
    pub fn sample_rate(&self) -> u32 {
        self.sample_rate
    }
}

fn open_here(settings: Settings, lookahead_s: f64) -> Result<Live, NoSound> {
    let card = card::find(settings.sample_rate)?;
    let (sample_rate, period) = (card.sample_rate, card.period);
    let mut manager = AudioManager::<CpalBackend>::new(AudioManagerSettings {
        backend_settings: CpalBackendSettings {
            device: Some(card.device),
            config: Some(card.config),
        },
        ..AudioManagerSettings::default()
    })
    .map_err(|error| NoSound::Refused(error.to_string()))?;
    let (queue, messages) = RingBuffer::new(QUEUE);
    let source = Source {
        pull: Pull::new(
            Mixer::new(&Settings {
                sample_rate,
                ..settings
            }),
            messages,
            lookahead_s,
        ),
    };
    manager
        .play(source)
        .map_err(|error| NoSound::Refused(error.to_string()))?;
    Ok(Live {
        queue,
        _manager: manager,
        sample_rate,
        period,
        lookahead_s,
        lost: 0,
    })
}

/// The audio thread's side: mixer, queue and clock.
struct Pull {
    mixer: Mixer,
    messages: Consumer<Message>,
    timeline: Timeline,
    block: [[f32; 2]; BLOCK],
}

impl Pull {
    fn new(mixer: Mixer, messages: Consumer<Message>, lookahead_s: f64) -> Self {
        Pull {
            mixer,
            messages,
            timeline: Timeline::new(lookahead_s),
            block: [[0.0; 2]; BLOCK],
        }
    }

    fn hear(&mut self) {
        while let Ok(message) = self.messages.pop() {
            match message {
                Message::Now(time_s) => self.timeline.meet(time_s, self.mixer.time()),
                Message::Event(event) => self.mixer.submit(Event {
                    time_s: self.timeline.mixer_time(event.time_s),
                    ..event
                }),
            }
        }
    }
}

/// The sound as kira takes it.
struct Source {
    pull: Pull,
}

impl SoundData for Source {
    type Error = std::convert::Infallible;
    type Handle = ();

    fn into_sound(self) -> Result<(Box<dyn Sound>, ()), Self::Error> {
        Ok((Box::new(self), ()))
    }
}

impl Sound for Source {
    fn on_start_processing(&mut self) {
        self.pull.hear();
    }

    fn process(&mut self, out: &mut [Frame], _dt: f64, _info: &Info) {
        for chunk in out.chunks_mut(BLOCK) {
            let block = &mut self.pull.block[..chunk.len()];
            self.pull.mixer.render(block);
            for (frame, [left, right]) in chunk.iter_mut().zip(block) {
                *frame = Frame::new(*left, *right);
            }
        }
    }

    fn finished(&self) -> bool {
        self.pull.messages.is_abandoned()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::event::{Impact, Sounding};
    use crate::material::Material;
    use glam::DVec3;

    fn blow(time_s: f64) -> Event {
        Event {
            time_s,
            sounding: Sounding::Impact(Impact {
                point: DVec3::new(0.0, 0.1, -18.0),
                materials: [Material::Ball, Material::Pin],
                masses: [6.8, 1.59],
                impulse: 12.0,
                approach_speed: 7.0,
            }),
        }
    }

    /// As [`Source::process`] without kira.
    fn pull(source: &mut Source, samples: usize) -> Vec<f32> {
        source.on_start_processing();
        let mut out = vec![[0.0; 2]; samples];
        source.pull.mixer.render(&mut out);
        out.iter().map(|[left, _]| left.abs()).collect()
    }

    #[test]
    fn an_event_is_heard_the_lookahead_after_its_frame() {
        let (mut queue, messages) = RingBuffer::new(QUEUE);
        let mixer = Mixer::new(&Settings::default());
        let mut source = Source {
            pull: Pull::new(mixer, messages, 0.015),
        };
        pull(&mut source, 4800);
        // The game is at 40 s when the mixer is at 0.1 s; the blow was 4 ms ago.
        queue.push(Message::Now(40.0)).expect("room");
        queue.push(Message::Event(blow(39.996))).expect("room");
        let heard = pull(&mut source, 4800);
        let first = heard.iter().position(|x| *x > 1e-3).expect("a sound");
        let expected = 0.011 * 48_000.0;
        assert!((first as f64 - expected).abs() < 48.0, "{first} {expected}");
    }

    #[test]
    fn the_audio_thread_does_not_allocate() {
        let (mut queue, messages) = RingBuffer::new(QUEUE);
        let mixer = Mixer::new(&Settings::default());
        let mut source = Source {
            pull: Pull::new(mixer, messages, 0.0),
        };
        let mut out = [[0.0; 2]; 512];
        let counted = allocation_counter::measure(|| {
            for frame in 0..100 {
                let now = f64::from(frame) * 0.011;
                let _ = queue.push(Message::Now(now));
                for i in 0..20 {
                    let _ = queue.push(Message::Event(blow(now - 0.0005 * f64::from(i))));
                }
                source.on_start_processing();
                source.pull.mixer.render(&mut out);
            }
        });
        assert_eq!(counted.count_total, 0);
        assert!(source.pull.mixer.sounding() > 10);
    }

    #[test]
    fn a_machine_without_a_card_is_told_so() {
        // Where there is a card this plays 0 s of silence; both are right, neither may panic.
        match Live::open(Settings::default(), 0.015) {
            Ok(live) => assert!(live.latency_ms() > 15.0),
            Err(error) => assert!(error.to_string().contains("sound card")),
        }
    }
}
