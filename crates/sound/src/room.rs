//! The alley's box as it answers: first reflections, then a decay that fills it.

use glam::DVec3;

use crate::QUANTUM;
use crate::ear::SPEED_OF_SOUND;

/// A closed room with one time of reverberation.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Room {
    /// Width, height and length [m].
    pub size_m: DVec3,
    /// Time in which a sound at 500 Hz falls by 60 dB [s].
    pub reverberation_s: f64,
}

impl Default for Room {
    /// A bowling centre of ten lanes with carpet and a ceiling of tiles: 2400 m3 that ring for 0.8 s.
    fn default() -> Self {
        Room {
            size_m: DVec3::new(20.0, 4.0, 30.0),
            reverberation_s: 0.8,
        }
    }
}

impl Room {
    /// Distance at which the room is as loud as the source itself [m]: `0.057 sqrt(V / T)` (H. Kuttruff, *Room
    /// Acoustics*, ch. 5).
    pub fn critical_distance(&self) -> f64 {
        0.057 * libm::sqrt(self.volume() / self.reverberation_s)
    }

    /// How much of a source at `distance` [m] the decay holds: farther back it begins later and so is weaker, `exp(-0.04 r / T)`
    /// in energy (M. Barron, L.-J. Lee, J. Acoust. Soc. Am. 84(2), 1988).
    pub(crate) fn share_at(&self, distance: f64) -> f64 {
        libm::exp(-0.02 * distance / self.reverberation_s)
    }

    fn volume(&self) -> f64 {
        self.size_m.x * self.size_m.y * self.size_m.z
    }

    /// Mean way between two walls [m], 4 V / S.
    fn mean_free_path(&self) -> f64 {
        let DVec3 { x, y, z } = self.size_m;
        2.0 * self.volume() / (x * y + y * z + z * x)
    }
}

const LINES: usize = 8;
/// Lengths of the lines against the mean way between walls: unequal, so that no two echoes fall together.
const LENGTHS: [f64; LINES] = [0.63, 0.74, 0.87, 0.98, 1.13, 1.29, 1.47, 1.66];
/// Which lines each ear hears with which sign: orthogonal, so that the decay has no direction.
const SIGNS: [[f32; LINES]; 2] = [
    [1.0, 1.0, -1.0, -1.0, 1.0, 1.0, -1.0, -1.0],
    [1.0, -1.0, 1.0, -1.0, -1.0, 1.0, -1.0, 1.0],
];
/// High frequencies ring for this share of the time of low ones.
const TREBLE: f64 = 0.45;
/// Reflections of first order that are told apart: floor, ceiling, both side walls, the wall behind each end.
const TAPS: usize = 6;
/// Part of the pressure that a wall sends back.
const REFLECTED: f64 = 0.75;

/// One line of the decay.
#[derive(Debug, Clone)]
struct Line {
    samples: Vec<f32>,
    at: usize,
    gain: f32,
    keep: f32,
    state: f32,
}

/// One early reflection.
#[derive(Debug, Clone, Copy, Default)]
struct Tap {
    delay: usize,
    gains: [f32; 2],
}

/// The room at work.
///
/// First order from images of the deck (J. B. Allen, D. A. Berkley, J. Acoust. Soc. Am. 65(4), 1979) at a listener at the foul
/// line: all sources share these six, because what a reflection's own direction adds within 50 ms is not told apart.
/// The decay is a network of delays whose outputs are mixed and fed back (J.-M. Jot, A. Chaigne, AES 90th Convention,
/// 1991), and its strength is that of a diffuse field.
#[derive(Debug, Clone)]
pub(crate) struct Reverberation {
    room: Room,
    early: Vec<f32>,
    early_at: usize,
    taps: [Tap; TAPS],
    lines: [Line; LINES],
    gain: f32,
    /// Quanta without input after which all is silent.
    quiet_after: u32,
    quiet: u32,
}

impl Reverberation {
    pub fn new(room: Room, sample_rate: f64) -> Self {
        let mean = room.mean_free_path() / SPEED_OF_SOUND;
        let lines =
            LENGTHS.map(|length| Line::new(length * mean, room.reverberation_s, sample_rate));
        let taps = taps(&room, sample_rate);
        let longest = taps.iter().map(|tap| tap.delay).max().unwrap_or(0) + 1;
        let mut reverberation = Reverberation {
            room,
            early: vec![0.0; longest],
            early_at: 0,
            taps: [Tap::default(); TAPS],
            lines,
            gain: 1.0,
            quiet_after: (2.0 * room.reverberation_s * sample_rate) as u32 / QUANTUM as u32,
            quiet: u32::MAX,
        };
        // What the network does to a click is measured rather than derived, once, while it is set up: its energy becomes that
        // of the field at the critical distance.
        let energy = reverberation.energy_of_a_click(sample_rate);
        let distance = room.critical_distance();
        reverberation.gain = (1.0 / (libm::sqrt(energy.max(1e-12)) * distance)) as f32;
        reverberation.taps = taps;
        reverberation
    }

    /// The room that it is.
    pub fn room(&self) -> &Room {
        &self.room
    }

    /// Energy in one ear for each unit of energy of a click at 1 m, with a gain of 1 and no early reflections.
    ///
    /// The click takes a millisecond: a shorter one would weigh all frequencies alike, and most of those are high ones that
    /// ring for less than the room's time.
    fn energy_of_a_click(&mut self, sample_rate: f64) -> f64 {
        let quanta = (self.room.reverberation_s * sample_rate) as usize / QUANTUM + 1;
        let length = sample_rate / 1000.0;
        let (mut given, mut heard) = (0.0, 0.0);
        for quantum in 0..quanta {
            let input: [f32; QUANTUM] = std::array::from_fn(|i| {
                let t = (quantum * QUANTUM + i) as f64;
                let is_click = t < length;
                let click = 1.0 - libm::cos(std::f64::consts::TAU * t / length);
                if is_click { click as f32 } else { 0.0 }
            });
            let mut out = [[0.0; 2]; QUANTUM];
            self.add(&input, &mut out);
            given += input.iter().map(|x| f64::from(x * x)).sum::<f64>();
            heard += out
                .iter()
                .map(|[left, _]| f64::from(left * left))
                .sum::<f64>();
        }
        self.silence();
        heard / given
    }

    fn silence(&mut self) {
        self.early.fill(0.0);
        for line in &mut self.lines {
            line.samples.fill(0.0);
            line.state = 0.0;
        }
        self.quiet = u32::MAX;
    }

    /// True when nothing is left to hear.
    pub fn is_silent(&self) -> bool {
        self.quiet >= self.quiet_after
    }

    /// Adds one quantum of the room's answer to `input`, pressure at 1 m, to both ears.
    pub fn add(&mut self, input: &[f32; QUANTUM], out: &mut [[f32; 2]; QUANTUM]) {
        let is_fed = input.iter().any(|sample| *sample != 0.0);
        if !is_fed && self.is_silent() {
            return;
        }
        self.quiet = if is_fed { 0 } else { self.quiet + 1 };
        if self.is_silent() {
            self.silence();
            return;
        }
        for (sample, ears) in input.iter().zip(out) {
            self.step(*sample, ears);
        }
        for line in &mut self.lines {
            if line.state.abs() < 1e-15 {
                line.state = 0.0;
            }
        }
    }

    fn step(&mut self, input: f32, ears: &mut [f32; 2]) {
        let longest = self.early.len();
        self.early_at = (self.early_at + 1) % longest;
        self.early[self.early_at] = input;
        for tap in &self.taps {
            let late = self.early[(self.early_at + longest - tap.delay) % longest];
            ears[0] += tap.gains[0] * late;
            ears[1] += tap.gains[1] * late;
        }
        let mut heard = [0.0; LINES];
        for (heard, line) in heard.iter_mut().zip(&mut self.lines) {
            let raw = line.samples[line.at] * line.gain;
            line.state = raw + line.keep * (line.state - raw);
            // Twenty decibels below what single precision keeps of a loud sound; smaller numbers are slow to compute with.
            *heard = if line.state.abs() < 1e-12 {
                0.0
            } else {
                line.state
            };
        }
        // Each line gets itself less a quarter of all (a Householder reflection): nothing is lost but by the lines' gains.
        let all = heard.iter().sum::<f32>() * (2.0 / LINES as f32);
        for (heard, line) in heard.iter().zip(&mut self.lines) {
            line.samples[line.at] = input + heard - all;
            line.at = (line.at + 1) % line.samples.len();
        }
        for (ear, signs) in ears.iter_mut().zip(&SIGNS) {
            let sum: f32 = heard.iter().zip(signs).map(|(x, sign)| x * sign).sum();
            *ear += self.gain * sum;
        }
    }
}

impl Line {
    fn new(delay_s: f64, reverberation_s: f64, sample_rate: f64) -> Self {
        let length = prime_from((delay_s * sample_rate) as usize);
        let seconds = length as f64 / sample_rate;
        let decibels = -60.0 * seconds / reverberation_s;
        // Jot and Chaigne: a one-pole low-pass whose gain at high frequencies belongs to their own time.
        let keep =
            (decibels / 20.0 * std::f64::consts::LN_10 / 4.0) * (1.0 - 1.0 / (TREBLE * TREBLE));
        Line {
            samples: vec![0.0; length],
            at: 0,
            gain: libm::pow(10.0, decibels / 20.0) as f32,
            keep: keep.clamp(0.0, 0.95) as f32,
            state: 0.0,
        }
    }
}

/// The first prime from `start` on: lines without a common divisor do not echo together.
fn prime_from(start: usize) -> usize {
    let is_prime = |n: usize| {
        (2..)
            .take_while(|d| d * d <= n)
            .all(|d| !n.is_multiple_of(d))
    };
    (start.max(2)..).find(|n| is_prime(*n)).unwrap_or(start)
}

/// The six images of a click at the pin deck, as the foul line hears them, relative to the click itself.
fn taps(room: &Room, sample_rate: f64) -> [Tap; TAPS] {
    let source = DVec3::new(0.0, 0.2, -18.8);
    let ear = DVec3::new(0.0, 1.6, 0.5);
    let direct = (source - ear).length();
    // The approach takes the last 5 m of the room's length.
    let (near_end, far_end) = (5.0, 5.0 - room.size_m.z);
    let half = room.size_m.x / 2.0;
    let images = [
        DVec3::new(source.x, -source.y, source.z),
        DVec3::new(source.x, 2.0 * room.size_m.y - source.y, source.z),
        DVec3::new(-2.0 * half - source.x, source.y, source.z),
        DVec3::new(2.0 * half - source.x, source.y, source.z),
        DVec3::new(source.x, source.y, 2.0 * near_end - source.z),
        DVec3::new(source.x, source.y, 2.0 * far_end.min(source.z) - source.z),
    ];
    images.map(|image| {
        let way = image - ear;
        let length = way.length();
        let side = way.x / length;
        // Pressure at 1 m times the share that is left here; the far ear gets less.
        let gain = REFLECTED / length;
        Tap {
            delay: libm::round((length - direct).max(0.0) / SPEED_OF_SOUND * sample_rate) as usize,
            gains: [1.0 - 0.5 * side, 1.0 + 0.5 * side].map(|share| (gain * share.min(1.0)) as f32),
        }
    })
}
