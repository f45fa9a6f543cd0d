//! One impact while it is heard: the blow's force drives the modes of both bodies and pushes the air aside. A refusal is a
//! voice as well: two notes that nothing in the alley has.

use std::f64::consts::{SQRT_2, TAU};

use glam::DVec3;

use crate::QUANTUM;
use crate::bank::Bank;
use crate::contact::{Pulse, contact_time};
use crate::ear::{Placement, SPEED_OF_SOUND};
use crate::event::Impact;
use crate::noise::Noise;

/// Density of air [kg/m3].
const AIR: f64 = 1.204;
/// Pins and boards are not twins, and where one is struck decides which of its modes ring: how far a mode's frequency
/// (as a share) and its gain may differ from the table. [D]
const DETUNED: f32 = 0.01;
const REGAINED: f32 = 0.25;

/// A refusal's notes: frequency [Hz] and gain [Pa m / (N s)]. A tritone apart and low, they say no without frightening: 0.1 Pa at
/// 1 m. [D]
const REFUSAL: [(f64, f64); 2] = [(233.1, 0.12), (329.6, 0.08)];
/// How fast they die away, and how long the push takes that begins them [s]: it makes their beginning soft. [D]
const REFUSAL_LOSS: f64 = 0.04;
const REFUSAL_PUSH_S: f64 = 0.003;

/// The click of two bodies that are suddenly moved, which small bodies' impacts consist of for the most part.
///
/// A ball of radius a and mass m that a force F moves sounds at r as `rho a^3 / (2 c m r) dF/dt` as long as it is small
/// against the wave, and as `rho a^2 / (2 m r) F` when it is large (J. N. Chadwick, C. Zheng, D. L. James, *Precomputed
/// Acceleration Noise for Improved Rigid-Body Sound*, SIGGRAPH 2012): a high-pass of first order between the two.
#[derive(Debug, Clone, Copy, Default)]
struct Click {
    /// Pressure at 1 m for each N s per sample [Pa m / (N s)].
    gain: f32,
    keep: f32,
    last: f32,
    state: f32,
}

impl Click {
    fn new(radius: f64, mass: f64, sample_rate: f64) -> Self {
        if radius <= 0.0 || !mass.is_finite() || mass <= 0.0 {
            return Click::default();
        }
        let corner = SPEED_OF_SOUND / (TAU * radius);
        Click {
            // One source in each direction and none across: the mean over all directions is 1 / sqrt 3 of the largest; the
            // two bodies move against each other and are added below as if alone.
            gain: (AIR * radius * radius / (2.0 * mass * SQRT_2) * sample_rate) as f32,
            keep: libm::exp(-TAU * corner / sample_rate) as f32,
            last: 0.0,
            state: 0.0,
        }
    }

    fn next(&mut self, force: f32) -> f32 {
        self.state = self.keep * (self.state + force - self.last);
        self.last = force;
        self.gain * self.state
    }
}

/// One impact.
#[derive(Debug, Clone)]
pub(crate) struct Voice {
    bank: Bank,
    clicks: [Click; 2],
    pulse: Pulse,
    impulse: f32,
    pub point: DVec3,
    pub placement: Placement,
    /// False when it may be used for another impact.
    pub is_sounding: bool,
}

impl Voice {
    /// No impact.
    pub const SILENT: Voice = Voice {
        bank: Bank::EMPTY,
        clicks: [Click {
            gain: 0.0,
            keep: 0.0,
            last: 0.0,
            state: 0.0,
        }; 2],
        pulse: Pulse::DONE,
        impulse: 0.0,
        point: DVec3::ZERO,
        placement: Placement::SILENT,
        is_sounding: false,
    };

    /// Begins with `impact`, `delay` [samples] after the first sample of the next quantum.
    pub fn strike(&mut self, impact: &Impact, delay: f64, noise: &mut Noise, sample_rate: f64) {
        *self = Voice::SILENT;
        self.pulse = Pulse::new(delay, contact_time(impact) * sample_rate);
        self.impulse = impact.impulse as f32;
        self.point = impact.point;
        self.is_sounding = true;
        for (slot, material) in impact.materials.into_iter().enumerate() {
            let radius = material.air_radius();
            self.clicks[slot] = Click::new(radius, impact.masses[slot], sample_rate);
            for mode in material.modes() {
                let frequency = mode.frequency_hz * f64::from(1.0 + DETUNED * noise.next());
                let gain = mode.gain * f64::from(1.0 + REGAINED * noise.next());
                self.bank
                    .add(frequency, material.loss_factor(), gain, sample_rate);
            }
        }
    }

    /// Begins with a refusal at `point`, `delay` [samples] after the first sample of the next quantum.
    pub fn refuse(&mut self, point: DVec3, delay: f64, sample_rate: f64) {
        *self = Voice::SILENT;
        self.pulse = Pulse::new(delay, REFUSAL_PUSH_S * sample_rate);
        self.impulse = 1.0;
        self.point = point;
        self.is_sounding = true;
        for (frequency, gain) in REFUSAL {
            self.bank.add(frequency, REFUSAL_LOSS, gain, sample_rate);
        }
    }

    /// One quantum, as pressure at 1 m [Pa].
    pub fn render(&mut self) -> [f32; QUANTUM] {
        let mut out = [0.0; QUANTUM];
        for sample in &mut out {
            let force = self.impulse * self.pulse.next();
            let [a, b] = &mut self.clicks;
            *sample = self.bank.next(force) + a.next(force) + b.next(force);
        }
        self.bank.hush();
        if self.pulse.is_over() {
            for click in &mut self.clicks {
                // A twentieth of a hearing threshold; soon after it the numbers would be too small to be normal.
                if (click.gain * click.state).abs() < 1e-6 {
                    click.state = 0.0;
                }
            }
        }
        if self.pulse.is_over() && self.level() == 0.0 {
            self.is_sounding = false;
        }
        out
    }

    /// A bound on what is still to come [Pa at 1 m].
    pub fn level(&self) -> f32 {
        if !self.pulse.is_over() {
            return f32::MAX;
        }
        let left: f32 = self.clicks.iter().map(|c| (c.gain * c.state).abs()).sum();
        self.bank.level() + left
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::material::Material;

    #[test]
    fn render_ends_without_a_number_that_is_not_normal() {
        let mut voice = Voice::SILENT;
        let impact = Impact {
            point: DVec3::ZERO,
            materials: [Material::Ball, Material::Pin],
            masses: [6.8, 1.59],
            impulse: 14.0,
            approach_speed: 7.0,
        };
        voice.strike(&impact, 3.5, &mut Noise::new(1), 48_000.0);
        let mut quanta = 0;
        while voice.is_sounding {
            voice.render();
            quanta += 1;
            for state in voice.clicks.map(|click| click.state) {
                assert!(state == 0.0 || state.is_normal(), "{state} after {quanta}");
            }
        }
        // A pin's lowest mode falls from 36 Pa to 2 uPa with 60 1/s: 0.28 s.
        assert!((300..500).contains(&quanta), "{quanta}");
    }
}
