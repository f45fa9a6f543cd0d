//! A bank of damped oscillations: what rings.

use std::f64::consts::{PI, TAU};

/// Oscillations in one bank; two bodies' modes fit, and a power of two suits the processor.
pub(crate) const MODES: usize = 16;
/// Ring this far below the first sample is not heard, and its numbers would become ever smaller [Pa at 1 m].
const SILENT: f32 = 2e-6;

/// Damped oscillations that one force drives.
///
/// Each is a complex number that turns and shrinks once a sample. Unlike the usual recursion of two samples it is as
/// exact at 60 Hz as at 6 kHz in single precision.
#[derive(Debug, Clone)]
pub(crate) struct Bank {
    re: [f32; MODES],
    im: [f32; MODES],
    turn_re: [f32; MODES],
    turn_im: [f32; MODES],
    gain: [f32; MODES],
    count: usize,
}

impl Bank {
    /// A bank without an oscillation.
    pub const EMPTY: Bank = Bank {
        re: [0.0; MODES],
        im: [0.0; MODES],
        turn_re: [0.0; MODES],
        turn_im: [0.0; MODES],
        gain: [0.0; MODES],
        count: 0,
    };

    /// Adds an oscillation; one above a half of the sample rate, or more than fit, are left out.
    pub fn add(&mut self, frequency_hz: f64, loss_factor: f64, gain: f64, sample_rate: f64) {
        if self.count == MODES || frequency_hz > 0.45 * sample_rate {
            return;
        }
        // The amplitude falls by exp(-pi f eta t) (Cremer and Heckl, ch. 3).
        let shrink = libm::exp(-PI * frequency_hz * loss_factor / sample_rate);
        let angle = TAU * frequency_hz / sample_rate;
        self.turn_re[self.count] = (shrink * libm::cos(angle)) as f32;
        self.turn_im[self.count] = (shrink * libm::sin(angle)) as f32;
        self.gain[self.count] = gain as f32;
        self.count += 1;
    }

    /// Lets `force` act for one sample; returns the sum of all oscillations.
    pub fn next(&mut self, force: f32) -> f32 {
        for i in 0..MODES {
            let re = self.re[i] + self.gain[i] * force;
            let im = self.im[i];
            self.re[i] = self.turn_re[i] * re - self.turn_im[i] * im;
            self.im[i] = self.turn_im[i] * re + self.turn_re[i] * im;
        }
        // Added by halves, in an order that the processor can keep side by side.
        let mut sum = [0.0; MODES / 2];
        for (i, half) in sum.iter_mut().enumerate() {
            *half = self.im[i] + self.im[i + MODES / 2];
        }
        (sum[0] + sum[4]) + (sum[1] + sum[5]) + ((sum[2] + sum[6]) + (sum[3] + sum[7]))
    }

    /// Sum of the oscillations' sizes: a bound on what is still to come [Pa at 1 m].
    pub fn level(&self) -> f32 {
        let sizes = self.re.iter().zip(&self.im);
        sizes.map(|(re, im)| re.abs() + im.abs()).sum()
    }

    /// Ends oscillations that are not heard, before their numbers become too small to be normal.
    pub fn hush(&mut self) {
        for i in 0..MODES {
            if self.re[i].abs() + self.im[i].abs() < SILENT {
                self.re[i] = 0.0;
                self.im[i] = 0.0;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn next_is_the_closed_form_of_a_damped_oscillation() {
        let (frequency, loss, rate) = (106.0, 0.08, 48_000.0);
        let mut bank = Bank::EMPTY;
        bank.add(frequency, loss, 3.0, rate);
        for n in 1..=9600 {
            let t = f64::from(n) / rate;
            let expected = 3.0 * (-PI * frequency * loss * t).exp() * (TAU * frequency * t).sin();
            let got = f64::from(bank.next(if n == 1 { 1.0 } else { 0.0 }));
            assert!((got - expected).abs() < 3e-4, "{n}: {got} {expected}");
        }
    }

    #[test]
    fn hush_ends_in_zeros_without_a_number_that_is_not_normal() {
        let mut bank = Bank::EMPTY;
        bank.add(1000.0, 0.05, 1.0, 48_000.0);
        bank.next(1.0);
        for _ in 0..2000 {
            for _ in 0..32 {
                bank.next(0.0);
            }
            bank.hush();
            assert!(
                bank.re
                    .iter()
                    .chain(&bank.im)
                    .all(|x| *x == 0.0 || x.is_normal())
            );
        }
        assert_eq!(bank.level(), 0.0);
    }
}
