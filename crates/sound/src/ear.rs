//! A source as both ears hear it: a rigid ball for a head.
//!
//! Delay: R. S. Woodworth, *Experimental Psychology*, 1938: a ray goes straight to an ear on the near side and bends round
//! the head to one on the far side. Shadow: C. P. Brown, R. O. Duda, *A Structural Model for Binaural Sound Synthesis*,
//! IEEE Trans. Speech Audio Processing 6(5), 1998: one pole, and a zero that moves with the angle.

use std::f64::consts::{FRAC_PI_2, PI};

use glam::DVec3;

use crate::QUANTUM;
use crate::event::Listener;

/// Speed of sound at 20 degrees Celsius [m/s].
pub const SPEED_OF_SOUND: f64 = 343.2;
/// Radius of a mean adult's head [m] (Brown and Duda).
pub const HEAD_RADIUS: f64 = 0.0875;
/// A source is never nearer than this [m]: 1/r would have no end.
pub(crate) const NEAREST: f64 = 0.25;

/// Samples that the delay between the ears takes at most: 0.66 ms at 192 kHz.
const DELAY_LINE: usize = 128;

/// What one ear makes of a source.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct EarPath {
    /// Delay behind an ear that faces the source [s].
    pub delay_s: f64,
    /// Gain at high frequencies, where the head's shadow is whole; at low ones it is 1.
    pub shadow: f64,
}

/// The path to an ear whose axis makes `angle` [rad, 0 to pi] with the direction of the source.
pub fn ear_path(angle: f64) -> EarPath {
    let ratio = if angle < FRAC_PI_2 {
        1.0 - libm::cos(angle)
    } else {
        1.0 + angle - FRAC_PI_2
    };
    // Brown and Duda (5): 0.1 at the darkest angle, 150 degrees.
    let darkest = 150.0 / 180.0 * PI;
    EarPath {
        delay_s: ratio * HEAD_RADIUS / SPEED_OF_SOUND,
        shadow: 1.05 + 0.95 * libm::cos(angle / darkest * PI),
    }
}

/// Distance [m] and both ears' paths, left first, from `listener` to `point`.
pub fn hear(listener: &Listener, point: DVec3) -> (f64, [EarPath; 2]) {
    let way = point - listener.position;
    let distance = way.length();
    // A source inside the head is ahead of it.
    let direction = way.try_normalize().unwrap_or(DVec3::NEG_Z);
    let right = listener.orientation * DVec3::X;
    let cosine = direction.dot(right).clamp(-1.0, 1.0);
    let to_right = libm::acos(cosine);
    (
        distance.max(NEAREST),
        [ear_path(PI - to_right), ear_path(to_right)],
    )
}

/// What changes from sample to sample while a source or the head moves.
#[derive(Debug, Clone, Copy, Default)]
struct Target {
    /// [samples]
    delay: f32,
    gain: f32,
    shadow: f32,
}

/// One source's way to both ears.
#[derive(Debug, Clone)]
pub(crate) struct Placement {
    line: [f32; DELAY_LINE],
    head: usize,
    now: [Target; 2],
    next: [Target; 2],
    /// Last input and output of each ear's shadow.
    memory: [[f32; 2]; 2],
    is_placed: bool,
}

/// The shadow's coefficients that do not move, for one sample rate.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Shadow {
    sample_rate: f64,
    constant: f32,
    slope: f32,
    feedback: f32,
}

impl Shadow {
    pub fn new(sample_rate: f64) -> Self {
        // H(s) = (1 + a s / 2 w) / (1 + s / 2 w) with w = c / radius, by the bilinear transform.
        let w = SPEED_OF_SOUND / HEAD_RADIUS;
        let scale = 1.0 / (w + sample_rate);
        Shadow {
            sample_rate,
            constant: (w * scale) as f32,
            slope: (sample_rate * scale) as f32,
            feedback: ((w - sample_rate) * scale) as f32,
        }
    }
}

impl Placement {
    /// No source yet.
    pub const SILENT: Placement = Placement {
        line: [0.0; DELAY_LINE],
        head: 0,
        now: [Target {
            delay: 0.0,
            gain: 0.0,
            shadow: 1.0,
        }; 2],
        next: [Target {
            delay: 0.0,
            gain: 0.0,
            shadow: 1.0,
        }; 2],
        memory: [[0.0; 2]; 2],
        is_placed: false,
    };

    /// Moves towards where `listener` hears `point` over the next quantum; the first call puts it there at once.
    pub fn aim(&mut self, listener: &Listener, point: DVec3, shadow: &Shadow) {
        let (distance, ears) = hear(listener, point);
        self.next = ears.map(|ear| Target {
            delay: (ear.delay_s * shadow.sample_rate).min((DELAY_LINE - 2) as f64) as f32,
            gain: (1.0 / distance) as f32,
            shadow: ear.shadow as f32,
        });
        if !self.is_placed {
            self.now = self.next;
            self.is_placed = true;
        }
    }

    /// Adds one quantum of `source`, pressure at 1 m, to both ears in `out`.
    pub fn add(&mut self, source: &[f32; QUANTUM], shadow: &Shadow, out: &mut [[f32; 2]; QUANTUM]) {
        const PART: f32 = 1.0 / QUANTUM as f32;
        let step = |now: f32, next: f32| (next - now) * PART;
        let steps: [Target; 2] = std::array::from_fn(|ear| Target {
            delay: step(self.now[ear].delay, self.next[ear].delay),
            gain: step(self.now[ear].gain, self.next[ear].gain),
            shadow: step(self.now[ear].shadow, self.next[ear].shadow),
        });
        for (input, out) in source.iter().zip(out) {
            self.head = (self.head + 1) % DELAY_LINE;
            self.line[self.head] = *input;
            for ear in 0..2 {
                let at = &mut self.now[ear];
                let whole = at.delay as usize;
                let part = at.delay - whole as f32;
                let tap = |back: usize| self.line[(self.head + DELAY_LINE - back) % DELAY_LINE];
                let late = tap(whole) * (1.0 - part) + tap(whole + 1) * part;
                let [last_in, last_out] = &mut self.memory[ear];
                let turned = shadow.slope * at.shadow;
                let shaded = (shadow.constant + turned) * late
                    + (shadow.constant - turned) * *last_in
                    - shadow.feedback * *last_out;
                *last_in = late;
                *last_out = shaded;
                out[ear] += at.gain * shaded;
                at.delay += steps[ear].delay;
                at.gain += steps[ear].gain;
                at.shadow += steps[ear].shadow;
            }
        }
        // Small errors of the steps do not add up.
        self.now = self.next;
        for value in self.memory.iter_mut().flatten() {
            if value.abs() < 1e-15 {
                *value = 0.0;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ear_path_differs_by_woodworth_between_the_ears() {
        // Published for a head of 87.5 mm and 343 m/s: 0 at the front, 0.38 ms at 45 degrees, 0.66 ms at the side.
        for (azimuth, expected) in [(0.0, 0.0), (45.0, 0.000_381), (90.0, 0.000_656)] {
            let theta = f64::to_radians(azimuth);
            let near = ear_path(FRAC_PI_2 - theta);
            let far = ear_path(FRAC_PI_2 + theta);
            let difference = far.delay_s - near.delay_s;
            assert!(
                (difference - expected).abs() < 2e-6,
                "{azimuth}: {difference}"
            );
        }
    }

    #[test]
    fn hear_knows_right_from_left_whichever_way_the_head_looks() {
        let mut listener = Listener::default();
        let point = listener.position + DVec3::new(2.0, 0.0, 0.0);
        let (distance, [left, right]) = hear(&listener, point);
        assert!((distance - 2.0).abs() < 1e-12);
        assert!(left.delay_s > right.delay_s && left.shadow < right.shadow);
        // Facing +x the source is straight ahead; facing +z it is at the left.
        listener.orientation = glam::DQuat::from_rotation_y(-FRAC_PI_2);
        let (_, [left, right]) = hear(&listener, point);
        assert!((left.delay_s - right.delay_s).abs() < 1e-9);
        listener.orientation = glam::DQuat::from_rotation_y(PI);
        let (_, [left, right]) = hear(&listener, point);
        assert!(left.delay_s < right.delay_s && left.shadow > right.shadow);
    }
}
