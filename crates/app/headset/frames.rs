//! How long frames take, and how many were missed: a line in the journal each, and a summary.

use std::time::Duration;

use renderer::headset::Frame;
use serde::Serialize;
use serde_json::{Value, json};

use crate::journal::Said;

/// Frames so far, of the session and of the game that is played.
#[derive(Debug, Default)]
pub struct FrameTimes {
    last_display_ns: Option<i64>,
    session: Totals,
    game: Totals,
}

/// What is kept of a stretch of frames.
#[derive(Debug, Default)]
struct Totals {
    missed: u64,
    /// Time from waking to the end of the frame [ms].
    taken_ms: Vec<f32>,
    /// How far ahead of its waking a frame was predicted [ms].
    predicted_ms: Vec<f32>,
}

/// What the journal keeps of a frame.
#[derive(Debug, Clone, Copy, Serialize)]
pub struct FrameLine {
    xr_time_ns: i64,
    period_ms: f64,
    prediction_ms: Option<f64>,
    simulated_ms: f64,
    taken_ms: f64,
    missed: u64,
    shown: bool,
}

impl FrameLine {
    /// Pictures that the display showed a second time before this one; `None` where it was not shown itself.
    pub fn missed_before_it(&self) -> Option<u64> {
        self.shown.then_some(self.missed)
    }
}

impl From<FrameLine> for Said {
    fn from(line: FrameLine) -> Self {
        Self::later(move || json!({ "frame": line }))
    }
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

impl Timing {
    /// Pictures that the display showed a second time before this one.
    pub fn missed(&self) -> u64 {
        self.missed
    }

    /// Time between two pictures [s], as the runtime has it.
    pub fn period_s(&self) -> f64 {
        self.period_s
    }
}

impl FrameTimes {
    /// Takes down a frame that was simulated in `simulated` after it woke.
    pub fn of(&mut self, frame: &Frame, simulated: Duration) -> Timing {
        let display_ns = frame.display_time_ns();
        let missed = self.last_display_ns.map_or(0, |last| {
            missed_between(display_ns - last, frame.period_s())
        });
        self.last_display_ns = Some(display_ns);
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

    /// The frame's line; `is_shown` when both eyes were located, drawn and handed over.
    pub fn finish(&mut self, timing: Timing, is_shown: bool) -> FrameLine {
        let taken = timing.woken.elapsed().as_secs_f64() * 1e3;
        for totals in [&mut self.session, &mut self.game] {
            totals.add(&timing, taken);
        }
        let rounded = |milliseconds: f64| (milliseconds * 1e3).round() / 1e3;
        FrameLine {
            xr_time_ns: timing.display_ns,
            period_ms: rounded(timing.period_s * 1e3),
            prediction_ms: timing.prediction_s.map(|seconds| rounded(seconds * 1e3)),
            simulated_ms: rounded(timing.simulated.as_secs_f64() * 1e3),
            taken_ms: rounded(taken),
            missed: timing.missed,
            shown: is_shown,
        }
    }

    /// A game begins: what was before is not its.
    pub fn begin_game(&mut self) {
        self.game = Totals::default();
    }

    /// The session's frames, missed ones, and how long they took and were predicted ahead: medians and tails.
    pub fn summary(&self) -> Value {
        json!({ "frames": self.session.summary() })
    }

    /// The same of the frames since the game began.
    pub fn game_summary(&self) -> Value {
        json!({ "game_frames": self.game.summary() })
    }
}

impl Totals {
    fn add(&mut self, timing: &Timing, taken_ms: f64) {
        self.missed += timing.missed;
        self.taken_ms.push(taken_ms as f32);
        let predicted = timing.prediction_s.map(|seconds| (seconds * 1e3) as f32);
        self.predicted_ms.extend(predicted);
    }

    fn summary(&self) -> Value {
        let at = |times: &[f32], share: f64| {
            let mut sorted = times.to_vec();
            sorted.sort_by(f32::total_cmp);
            let last = sorted.len().checked_sub(1)?;
            Some(sorted[(share * last as f64) as usize])
        };
        json!({
            "count": self.taken_ms.len(),
            "missed": self.missed,
            "taken_median_ms": at(&self.taken_ms, 0.5),
            "taken_p99_ms": at(&self.taken_ms, 0.99),
            "prediction_median_ms": at(&self.predicted_ms, 0.5),
            "prediction_longest_ms": at(&self.predicted_ms, 1.0),
        })
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

    #[test]
    fn a_game_counts_its_own_frames_and_the_session_all() {
        let mut times = FrameTimes::default();
        let timing = |missed, prediction_s| Timing {
            display_ns: 0,
            period_s: 0.01,
            prediction_s,
            missed,
            woken: std::time::Instant::now(),
            simulated: Duration::ZERO,
        };
        let shown = times.finish(timing(3, Some(0.5)), true);
        assert_eq!(shown.missed_before_it(), Some(3));
        times.begin_game();
        for ahead in [0.01, 0.03, 0.02] {
            times.finish(timing(1, Some(ahead)), true);
        }
        let unseen = times.finish(timing(0, None), false);
        assert_eq!(unseen.missed_before_it(), None);
        let game = times.game_summary()["game_frames"].clone();
        assert_eq!((&game["count"], &game["missed"]), (&json!(4), &json!(3)));
        assert_eq!(game["prediction_median_ms"], json!(20.0_f32));
        assert_eq!(game["prediction_longest_ms"], json!(30.0_f32));
        let all = times.summary()["frames"].clone();
        assert_eq!((&all["count"], &all["missed"]), (&json!(5), &json!(6)));
        assert_eq!(all["prediction_longest_ms"], json!(500.0_f32));
        let none = FrameTimes::default().game_summary()["game_frames"].clone();
        assert!(none["taken_p99_ms"].is_null() && none["count"] == 0);
    }
}
