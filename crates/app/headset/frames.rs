//! How long frames take, and how many were missed: a line in the journal each, and a summary.

use std::time::Duration;

use renderer::headset::Frame;
use serde_json::{Value, json};

/// Frames so far.
#[derive(Debug, Default)]
pub struct FrameTimes {
    last_display_ns: Option<i64>,
    missed: u64,
    /// Time from waking to the end of the frame [ms].
    taken_ms: Vec<f32>,
}

/// A frame between its simulation and its end.
#[derive(Debug)]
pub struct Timing {
    display_ns: i64,
    period_s: f64,
    prediction_s: Option<f64>,
    missed: u64,
    woken: std::time::Instant,
    simulated: Duration,
}

impl FrameTimes {
    /// Takes down a frame that was simulated in `simulated` after it woke.
    pub fn of(&mut self, frame: &Frame, simulated: Duration) -> Timing {
        let display_ns = frame.display_time_ns();
        let missed = self.last_display_ns.map_or(0, |last| {
            missed_between(display_ns - last, frame.period_s())
        });
        self.last_display_ns = Some(display_ns);
        self.missed += missed;
        Timing {
            display_ns,
            period_s: frame.period_s(),
            prediction_s: frame.prediction_s(),
            missed,
            woken: frame.woken(),
            simulated,
        }
    }

    /// What passes until the next frame was not missed: the runtime wanted none.
    pub fn pause(&mut self) {
        self.last_display_ns = None;
    }

    /// The frame's line for the journal.
    pub fn finish(&mut self, timing: Timing) -> Value {
        let taken = timing.woken.elapsed().as_secs_f64() * 1e3;
        self.taken_ms.push(taken as f32);
        let rounded = |milliseconds: f64| (milliseconds * 1e3).round() / 1e3;
        json!({ "frame": {
            "xr_time_ns": timing.display_ns,
            "period_ms": rounded(timing.period_s * 1e3),
            "prediction_ms": timing.prediction_s.map(|seconds| rounded(seconds * 1e3)),
            "simulated_ms": rounded(timing.simulated.as_secs_f64() * 1e3),
            "taken_ms": rounded(taken),
            "missed": timing.missed,
        }})
    }

    /// Frames, missed ones, and the median and the 99th percentile of the time that they took.
    pub fn summary(&self) -> Value {
        let mut taken = self.taken_ms.clone();
        taken.sort_by(f32::total_cmp);
        let at = |share: f64| taken.get((share * (taken.len().max(1) - 1) as f64) as usize);
        json!({ "frames": {
            "count": taken.len(),
            "missed": self.missed,
            "taken_median_ms": at(0.5),
            "taken_p99_ms": at(0.99),
        }})
    }
}

/// Pictures that the display showed a second time between two frames.
fn missed_between(elapsed_ns: i64, period_s: f64) -> u64 {
    if period_s <= 0.0 {
        return 0;
    }
    ((elapsed_ns as f64 * 1e-9 / period_s).round() as i64 - 1).max(0) as u64
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn missed_counts_the_pictures_between() {
        let period_s = 1.0 / 90.0;
        assert_eq!(missed_between(11_111_111, period_s), 0);
        assert_eq!(missed_between(11_900_000, period_s), 0, "jitter");
        assert_eq!(missed_between(33_333_333, period_s), 2);
        assert_eq!(missed_between(0, period_s), 0);
        assert_eq!(missed_between(5, 0.0), 0);
    }
}
