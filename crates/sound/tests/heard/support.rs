//! Settings, blows and measures that the tests share.

use glam::DVec3;
use rustfft::FftPlanner;
use rustfft::num_complex::Complex;
use sound::{Event, Impact, Listener, Material, Settings, Sounding, offline};

pub const RATE: f64 = 48_000.0;

/// Without a room, and so far below full scale that nothing is limited: samples times this are pressures [Pa].
pub const FULL_SCALE: f64 = 1000.0;

pub fn dry() -> Settings {
    Settings {
        room: None,
        full_scale_pa: FULL_SCALE,
        ..Settings::default()
    }
}

/// A head at the origin that looks along -z.
pub fn head_at_origin() -> Event {
    Event {
        time_s: 0.0,
        sounding: Sounding::Listener(Listener {
            position: DVec3::ZERO,
            ..Listener::default()
        }),
    }
}

/// A ball at 7 m/s against a pin, at `point`.
pub fn ball_on_pin(point: DVec3) -> Impact {
    Impact {
        point,
        materials: [Material::Ball, Material::Pin],
        masses: [6.8, 1.59],
        impulse: 14.0,
        approach_speed: 7.0,
    }
}

pub fn at(time_s: f64, impact: Impact) -> Event {
    Event {
        time_s,
        sounding: Sounding::Impact(impact),
    }
}

/// Both ears' pressure [Pa] after `events` for a head at the origin, without a room.
pub fn dry_pressure(events: &[Event], duration_s: f64) -> [Vec<f64>; 2] {
    let mut all = vec![head_at_origin()];
    all.extend(events);
    let samples = offline::render(&dry(), &all, duration_s);
    [0, 1].map(|ear| {
        samples
            .iter()
            .map(|sample| f64::from(sample[ear]) * FULL_SCALE)
            .collect()
    })
}

pub fn peak(signal: &[f64]) -> f64 {
    signal.iter().fold(0.0, |peak, x| peak.max(x.abs()))
}

pub fn rms(signal: &[f64]) -> f64 {
    (signal.iter().map(|x| x * x).sum::<f64>() / signal.len() as f64).sqrt()
}

pub fn decibels(ratio: f64) -> f64 {
    20.0 * ratio.log10()
}

/// Power in bins of `RATE / length`, after a Hann window and zeros up to `length`.
pub fn spectrum(signal: &[f64], length: usize) -> Vec<f64> {
    let n = signal.len() as f64;
    let mut bins: Vec<Complex<f64>> = signal
        .iter()
        .enumerate()
        .map(|(i, x)| {
            let window = 0.5 - 0.5 * (std::f64::consts::TAU * i as f64 / n).cos();
            Complex::new(x * window, 0.0)
        })
        .collect();
    bins.resize(length, Complex::new(0.0, 0.0));
    FftPlanner::new()
        .plan_fft_forward(length)
        .process(&mut bins);
    bins[..length / 2]
        .iter()
        .map(|bin| bin.norm_sqr())
        .collect()
}

/// Middle of a signal's power over frequency [Hz].
pub fn centroid(signal: &[f64]) -> f64 {
    let length = signal.len().next_power_of_two();
    let power = spectrum(signal, length);
    let weighted: f64 = power.iter().enumerate().map(|(i, p)| i as f64 * p).sum();
    weighted / power.iter().sum::<f64>() * RATE / length as f64
}
