//! The mixer: takes events with their times, and renders what both ears hear.

use std::collections::VecDeque;

use glam::DVec3;

use crate::continuous::{Machine, Roller};
use crate::ear::{Placement, SPEED_OF_SOUND, Shadow, hear};
use crate::event::{Event, Impact, Listener, Sounding};
use crate::limiter::limit;
use crate::noise::Noise;
use crate::room::{Reverberation, Room};
use crate::voice::Voice;

/// Samples that are rendered at once: 0.7 ms at 48 kHz, in which nothing that moves is heard to step.
pub const QUANTUM: usize = 32;
/// Impacts that are heard at once; another takes the place of the quietest.
pub const VOICES: usize = 64;
/// Balls that may roll at once.
pub const ROLLERS: usize = 8;
/// Events that may wait at once.
const WAITING: usize = 2048;
/// Impulse below which a touch makes no sound [N s].
const LIGHTEST: f64 = 1e-3;
/// Impulse beyond which no body of an alley can be struck [N s]; a number from a fault must not deafen.
const HEAVIEST: f64 = 500.0;

/// How a mixer is built.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Settings {
    /// Samples per second of each ear [Hz].
    pub sample_rate: u32,
    /// Pressure at the ears that a sample of 1 stands for [Pa].
    pub full_scale_pa: f64,
    /// The room that answers; without one nothing of it is built.
    pub room: Option<Room>,
    /// True when a sound takes its time to the ears: 53 ms from the pins to the foul line. Else it begins with the
    /// contact, which headset and sound card delay enough.
    pub is_delayed_by_distance: bool,
    /// Seed of the noise.
    pub seed: u64,
}

impl Default for Settings {
    fn default() -> Self {
        Settings {
            sample_rate: 48_000,
            full_scale_pa: 6.0,
            room: Some(Room::default()),
            is_delayed_by_distance: false,
            seed: 1,
        }
    }
}

/// An event whose sample is known.
#[derive(Debug, Clone, Copy)]
struct Due {
    /// Samples since the sound began; between two samples for an impact.
    at: f64,
    sounding: Sounding,
}

/// Makes stereo sound of events.
///
/// The same events give the same samples, in blocks of whatever size they are asked for: it renders quanta of
/// [`QUANTUM`] samples that begin at multiples of that, and hands them out as asked. After it is built it does not allocate.
#[derive(Debug)]
pub struct Mixer {
    sample_rate: f64,
    gain: f32,
    is_delayed: bool,
    noise: Noise,
    shadow: Shadow,
    listener: Listener,
    /// True when the head has moved since the voices were aimed.
    is_turned: bool,
    waiting: VecDeque<Due>,
    lost: u64,
    voices: Box<[Voice]>,
    rollers: Box<[Roller]>,
    machine: Machine,
    room: Option<Reverberation>,
    /// First sample of the next quantum.
    clock: u64,
    ready: [[f32; 2]; QUANTUM],
    handed_out: usize,
}

impl Mixer {
    /// A silent mixer whose first sample is at time zero.
    pub fn new(settings: &Settings) -> Self {
        let sample_rate = f64::from(settings.sample_rate);
        let rollers = (0..ROLLERS as u64).map(|i| Roller::new(settings.seed ^ (i + 1) << 32));
        Mixer {
            sample_rate,
            gain: (1.0 / settings.full_scale_pa) as f32,
            is_delayed: settings.is_delayed_by_distance,
            noise: Noise::new(settings.seed),
            shadow: Shadow::new(sample_rate),
            listener: Listener::default(),
            is_turned: false,
            waiting: VecDeque::with_capacity(WAITING),
            lost: 0,
            voices: vec![Voice::SILENT; VOICES].into_boxed_slice(),
            rollers: rollers.collect(),
            machine: Machine::new(!settings.seed, sample_rate),
            room: settings
                .room
                .map(|room| Reverberation::new(room, sample_rate)),
            clock: 0,
            ready: [[0.0; 2]; QUANTUM],
            handed_out: QUANTUM,
        }
    }

    /// Samples per second [Hz].
    pub fn sample_rate(&self) -> f64 {
        self.sample_rate
    }

    /// Time of the next sample that can still be changed [s].
    pub fn time(&self) -> f64 {
        self.clock as f64 / self.sample_rate
    }

    /// Events that came when too many were waiting, or whose time was no number.
    pub fn lost(&self) -> u64 {
        self.lost
    }

    /// Impacts that are heard now.
    pub fn sounding(&self) -> usize {
        self.voices.iter().filter(|voice| voice.is_sounding).count()
    }

    /// Takes an event; one of the past happens now.
    pub fn submit(&mut self, event: Event) {
        let at = event.time_s * self.sample_rate;
        if self.waiting.len() == WAITING || !at.is_finite() {
            self.lost += 1;
            return;
        }
        // Most come in the order of their times: looking from the end finds the place at once.
        let after = self
            .waiting
            .iter()
            .rev()
            .take_while(|due| due.at > at)
            .count();
        let due = Due {
            at,
            sounding: event.sounding,
        };
        self.waiting.insert(self.waiting.len() - after, due);
    }

    /// Fills `out` with the next samples, left ear first, between -1 and 1.
    pub fn render(&mut self, out: &mut [[f32; 2]]) {
        for sample in out {
            if self.handed_out == QUANTUM {
                self.render_quantum();
                self.handed_out = 0;
            }
            *sample = self.ready[self.handed_out];
            self.handed_out += 1;
        }
    }

    fn render_quantum(&mut self) {
        let end = (self.clock + QUANTUM as u64) as f64;
        while let Some(due) = self.waiting.front().copied() {
            if due.at >= end {
                break;
            }
            self.waiting.pop_front();
            self.begin(due);
        }
        let mut heard = self.render_sources();
        if let Some(room) = &mut self.room {
            room.add(&heard.sent, &mut heard.ears);
        }
        for (ready, ears) in self.ready.iter_mut().zip(&heard.ears) {
            *ready = ears.map(|pressure| limit(pressure * self.gain));
        }
        self.clock += QUANTUM as u64;
    }

    /// Lets an event happen in the quantum that is about to be rendered.
    fn begin(&mut self, due: Due) {
        match due.sounding {
            Sounding::Impact(impact) => self.strike(&impact, due.at),
            Sounding::Rolling(rolling) => {
                let is_somewhere = rolling.point.is_finite() && rolling.speed.is_finite();
                match self.rollers.get_mut(usize::from(rolling.body)) {
                    Some(roller) if is_somewhere => {
                        let time = self.clock as f64 / self.sample_rate;
                        roller.tell(rolling, time, self.sample_rate);
                    }
                    _ => self.lost += 1,
                }
            }
            Sounding::Machine { is_running, point } => self.machine.switch(is_running, point),
            Sounding::Refusal { point } if point.is_finite() => {
                let rate = self.sample_rate;
                self.speak(point, due.at, |voice, delay, _| {
                    voice.refuse(point, delay, rate);
                });
            }
            Sounding::Refusal { .. } => self.lost += 1,
            Sounding::Listener(listener) => {
                if listener.position.is_finite() && listener.orientation.is_finite() {
                    self.is_turned |= listener != self.listener;
                    self.listener = listener;
                } else {
                    self.lost += 1;
                }
            }
        }
    }

    fn strike(&mut self, impact: &Impact, at: f64) {
        if !impact.impulse.is_finite() || !impact.point.is_finite() {
            self.lost += 1;
            return;
        }
        if impact.impulse < LIGHTEST {
            return;
        }
        let impact = Impact {
            impulse: impact.impulse.min(HEAVIEST),
            ..*impact
        };
        let rate = self.sample_rate;
        self.speak(impact.point, at, |voice, delay, noise| {
            voice.strike(&impact, delay, noise, rate);
        });
    }

    /// Lets something begin at `point`, with the voice that is missed least.
    fn speak(&mut self, point: DVec3, at: f64, begin: impl FnOnce(&mut Voice, f64, &mut Noise)) {
        let (distance, _) = hear(&self.listener, point);
        let way = if self.is_delayed { distance } else { 0.0 };
        let delay = way / SPEED_OF_SOUND * self.sample_rate + (at - self.clock as f64).max(0.0);
        // The quietest is the first of those that are silent, where there is one.
        let quietest = self
            .voices
            .iter_mut()
            .min_by(|a, b| loudness(a).total_cmp(&loudness(b)));
        if let Some(voice) = quietest {
            begin(voice, delay, &mut self.noise);
            voice.placement.aim(&self.listener, point, &self.shadow);
        }
    }

    fn render_sources(&mut self) -> Heard {
        let mut heard = Heard {
            ears: [[0.0; 2]; QUANTUM],
            sent: [0.0; QUANTUM],
        };
        let air = Air {
            listener: &self.listener,
            shadow: &self.shadow,
            room: self.room.as_ref().map(Reverberation::room),
        };
        for voice in self.voices.iter_mut().filter(|voice| voice.is_sounding) {
            if self.is_turned {
                voice.placement.aim(air.listener, voice.point, air.shadow);
            }
            let source = voice.render();
            air.carry(&source, voice.point, &mut voice.placement, &mut heard);
        }
        let time = self.clock as f64 / self.sample_rate;
        for roller in self.rollers.iter_mut().filter(|roller| roller.is_sounding) {
            let point = roller.point();
            roller.placement.aim(air.listener, point, air.shadow);
            let source = roller.render(time, self.sample_rate);
            air.carry(&source, point, &mut roller.placement, &mut heard);
        }
        let machine = &mut self.machine;
        if machine.is_sounding() {
            machine
                .placement
                .aim(air.listener, machine.point, air.shadow);
            let source = machine.render(self.sample_rate);
            air.carry(&source, machine.point, &mut machine.placement, &mut heard);
        }
        self.is_turned = false;
        heard
    }

    /// True when nothing sounds, nothing waits and the room has died away.
    pub fn is_silent(&self) -> bool {
        self.waiting.is_empty()
            && self.voices.iter().all(|voice| !voice.is_sounding)
            && self.rollers.iter().all(|roller| !roller.is_sounding)
            && !self.machine.is_sounding()
            && self.room.as_ref().is_none_or(Reverberation::is_silent)
    }
}

/// How much a voice would be missed.
fn loudness(voice: &Voice) -> f32 {
    if voice.is_sounding {
        voice.level()
    } else {
        -1.0
    }
}

/// One quantum on its way.
struct Heard {
    /// Pressure at both ears [Pa].
    ears: [[f32; 2]; QUANTUM],
    /// What the room answers to, pressure at 1 m [Pa].
    sent: [f32; QUANTUM],
}

/// What lies between a source and the ears.
struct Air<'a> {
    listener: &'a Listener,
    shadow: &'a Shadow,
    room: Option<&'a Room>,
}

impl Air<'_> {
    /// Adds one quantum of a source at `point` to what is heard.
    fn carry(
        &self,
        source: &[f32; QUANTUM],
        point: DVec3,
        placement: &mut Placement,
        heard: &mut Heard,
    ) {
        placement.add(source, self.shadow, &mut heard.ears);
        if let Some(room) = self.room {
            let share = room.share_at(point.distance(self.listener.position)) as f32;
            for (sent, sample) in heard.sent.iter_mut().zip(source) {
                *sent += share * sample;
            }
        }
    }
}
