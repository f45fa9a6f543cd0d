//! One frame as the runtime wants it.

use std::time::Instant;

use openxr as xr;

/// One frame between [`super::HeadsetSession::wait`] and [`super::HeadsetSession::show`].
#[derive(Debug)]
pub struct Frame {
    pub(super) time: xr::Time,
    pub(super) period: xr::Duration,
    pub(super) should_render: bool,
    pub(super) prediction_s: Option<f64>,
    pub(super) woken: Instant,
}

impl Frame {
    /// When the picture will be seen, on the runtime's clock [ns].
    pub fn display_time_ns(&self) -> i64 {
        self.time.as_nanos()
    }

    /// Time between two pictures [s].
    pub fn period_s(&self) -> f64 {
        self.period.as_nanos() as f64 * 1e-9
    }

    /// Whether the picture would be seen.
    pub fn should_render(&self) -> bool {
        self.should_render
    }

    /// How far ahead of its waking the frame was predicted [s]; `None` where the runtime's clock cannot be read.
    pub fn prediction_s(&self) -> Option<f64> {
        self.prediction_s
    }

    /// When the runtime let the frame begin.
    pub fn woken(&self) -> Instant {
        self.woken
    }
}
