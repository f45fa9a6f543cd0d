//! What sounds for as long as it lasts: balls that roll, and the pinsetter's machine.

use std::f64::consts::{PI, TAU};

use glam::DVec3;

use crate::QUANTUM;
use crate::bank::Bank;
use crate::ear::Placement;
use crate::event::Rolling;
use crate::material::Material;
use crate::noise::Noise;

/// A ball that is not told of for this long has stopped [s]: three frames at 30 Hz.
const FORGOTTEN_S: f64 = 0.1;
/// Time in which speed and strength follow what is told [s]: longer than a frame at 72 Hz.
const FOLLOW_S: f64 = 0.02;
/// Pressure at 1 m of a ball that rolls on a lane at 1 m/s [Pa]: 57 dB, so that it has 82 dB at 7 m/s. [D]
const ROLLING_PA: f64 = 0.014;
/// How pressure grows with speed: 30 dB for ten times the speed, as wheels on rails do (D. Thompson, *Railway Noise and
/// Vibration*, 2009, ch. 2).
const ROLLING_POWER: f64 = 1.5;
/// Radius of the face with which a ball of 6.8 kg rests on a lane [m]: Hertz, `(3 F R / 4 E)^(1/3)`. Roughness that is finer is
/// not felt, so that the noise ends near `speed / (2 pi radius)` (Thompson, ch. 5, the contact filter).
const FOOTPRINT: f64 = 1.76e-3;
/// Pressure at 1 m of the machine [Pa]: 78 dB; ball returns and pinsetters are given as 75 to 85 dB.
const MACHINE_PA: f32 = 0.16;
/// Shares of the roughness that are heard directly and through what is rolled on; together they have [`ROLLING_PA`]. [D]
const AIRBORNE: f32 = 0.5;
const THROUGH_SURFACE: f32 = 0.35;
/// Turns per second of a four-pole motor at 60 Hz [Hz], as the plate says: 1750 a minute.
const MOTOR_HZ: f64 = 29.2;
/// Links of the machine's chain that meet a sprocket each second [Hz]. [D]
const CHAIN_HZ: f64 = 11.0;
/// What is quieter than this is over [Pa at 1 m].
const SILENT: f32 = 1e-5;

/// A one-pole low-pass, twice.
#[derive(Debug, Clone, Copy, Default)]
struct LowPass {
    keep: f32,
    state: [f32; 2],
}

impl LowPass {
    fn tune(&mut self, corner_hz: f64, sample_rate: f64) {
        self.keep = libm::exp(-TAU * corner_hz.min(0.4 * sample_rate) / sample_rate) as f32;
    }

    fn next(&mut self, input: f32) -> f32 {
        let [first, second] = &mut self.state;
        *first = input + self.keep * (*first - input);
        *second = *first + self.keep * (*second - *first);
        *second
    }

    fn hush(&mut self) {
        for value in &mut self.state {
            if value.abs() < 1e-15 {
                *value = 0.0;
            }
        }
    }
}

/// A ball that rolls: noise up to the footprint's corner, by itself and through what it rolls on.
#[derive(Debug, Clone)]
pub(crate) struct Roller {
    noise: Noise,
    low: LowPass,
    bank: Bank,
    surface: Option<Material>,
    told: Rolling,
    told_at: f64,
    /// What is followed with a lag [m/s].
    speed: f64,
    strength: f32,
    pub placement: Placement,
    pub is_sounding: bool,
}

/// How loud rolling on a surface is against rolling on a lane.
fn surface_gain(surface: Material) -> f64 {
    match surface {
        // A thin pipe speaks more easily than a floor.
        Material::Gutter => 1.8,
        Material::Metal => 1.2,
        Material::Pit | Material::Cushion | Material::Hand => 0.2,
        _ => 1.0,
    }
}

impl Roller {
    pub fn new(seed: u64) -> Self {
        Roller {
            noise: Noise::new(seed),
            low: LowPass::default(),
            bank: Bank::EMPTY,
            surface: None,
            told: Rolling {
                body: 0,
                point: DVec3::ZERO,
                speed: 0.0,
                surface: Material::Lane,
            },
            told_at: 0.0,
            speed: 0.0,
            strength: 0.0,
            placement: Placement::SILENT,
            is_sounding: false,
        }
    }

    pub fn tell(&mut self, rolling: Rolling, time: f64, sample_rate: f64) {
        if !self.is_sounding {
            self.placement = Placement::SILENT;
            self.strength = 0.0;
            // It begins at its own speed: a ball does not start from rest where it is first heard.
            self.speed = rolling.speed.abs();
            self.is_sounding = true;
        }
        if self.surface != Some(rolling.surface) {
            self.surface = Some(rolling.surface);
            self.bank = Bank::EMPTY;
            for mode in rolling.surface.modes() {
                // A force that lasts meets each mode for as long as it rings: divided by that, all are as loud.
                let loss = rolling.surface.loss_factor();
                let ring = PI * mode.frequency_hz * loss / sample_rate;
                let gain = mode.gain * libm::sqrt(ring);
                self.bank.add(mode.frequency_hz, loss, gain, sample_rate);
            }
        }
        self.told = rolling;
        self.told_at = time;
    }

    /// Where it is heard from.
    pub fn point(&self) -> DVec3 {
        self.told.point
    }

    /// One quantum from `time` on, as pressure at 1 m [Pa].
    pub fn render(&mut self, time: f64, sample_rate: f64) -> [f32; QUANTUM] {
        let is_known = time - self.told_at < FORGOTTEN_S;
        let told = if is_known { self.told.speed.abs() } else { 0.0 };
        let told = if told.is_finite() {
            told.min(30.0)
        } else {
            0.0
        };
        let share = 1.0 - libm::exp(-(QUANTUM as f64) / sample_rate / FOLLOW_S);
        self.speed += share * (told - self.speed);
        let corner = (self.speed / (TAU * FOOTPRINT)).max(40.0);
        self.low.tune(corner, sample_rate);
        // The noise keeps its power whatever the corner lets through: a pole twice has pi/4 of its corner as bandwidth.
        let bandwidth = corner * PI / 4.0 / (sample_rate / 2.0);
        let level = ROLLING_PA
            * surface_gain(self.told.surface)
            * libm::pow(self.speed, ROLLING_POWER)
            * libm::sqrt(3.0 / bandwidth.min(1.0));
        let step = (level as f32 - self.strength) / QUANTUM as f32;
        let mut out = [0.0; QUANTUM];
        for sample in &mut out {
            self.strength += step;
            let rough = self.low.next(self.noise.next()) * self.strength;
            *sample = AIRBORNE * rough + THROUGH_SURFACE * self.bank.next(rough);
        }
        self.low.hush();
        self.bank.hush();
        if self.strength < SILENT && self.bank.level() < SILENT {
            self.is_sounding = false;
        }
        out
    }
}

/// The pinsetter's machine: a motor's hum, a chain, and noise through a steel frame.
#[derive(Debug, Clone)]
pub(crate) struct Machine {
    noise: Noise,
    frame: Bank,
    phase: f64,
    chain: f64,
    strength: f32,
    is_running: bool,
    pub point: DVec3,
    pub placement: Placement,
}

impl Machine {
    pub fn new(seed: u64, sample_rate: f64) -> Self {
        let mut frame = Bank::EMPTY;
        for frequency in [183.0, 310.0, 545.0, 870.0, 1460.0] {
            frame.add(frequency, 0.1, 0.02, sample_rate);
        }
        Machine {
            noise: Noise::new(seed),
            frame,
            phase: 0.0,
            chain: 0.0,
            strength: 0.0,
            is_running: false,
            point: DVec3::ZERO,
            placement: Placement::SILENT,
        }
    }

    pub fn switch(&mut self, is_running: bool, point: DVec3) {
        self.is_running = is_running;
        self.point = point;
    }

    pub fn is_sounding(&self) -> bool {
        self.is_running || self.strength > SILENT
    }

    /// One quantum, as pressure at 1 m [Pa].
    pub fn render(&mut self, sample_rate: f64) -> [f32; QUANTUM] {
        let target = if self.is_running { MACHINE_PA } else { 0.0 };
        // A motor comes up and runs down in a third of a second.
        let share = 1.0 - libm::exp(-1.0 / sample_rate / 0.1) as f32;
        let mut out = [0.0; QUANTUM];
        for sample in &mut out {
            self.strength += share * (target - self.strength);
            self.phase = (self.phase + MOTOR_HZ / sample_rate).fract();
            self.chain += CHAIN_HZ / sample_rate;
            let link = if self.chain >= 1.0 {
                self.chain -= 1.0;
                12.0
            } else {
                0.0
            };
            // Twice and four times the turns, and the mains' hum between them.
            let hum = libm::sin(2.0 * TAU * self.phase) + 0.5 * libm::sin(4.0 * TAU * self.phase);
            let rattle = self.frame.next(self.noise.next() + link);
            *sample = self.strength * (0.7 * hum as f32 + 3.0 * rattle);
        }
        self.frame.hush();
        out
    }
}
