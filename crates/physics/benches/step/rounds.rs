//! Times of contenders that take turns, and what is told about them.

use crate::clock::thread_seconds;

/// A contender's time per simulated second in every round [s].
#[derive(Clone, Debug, Default)]
pub struct Times(pub Vec<f64>);

impl Times {
    /// Median and quartiles.
    pub fn quartiles(&self) -> [f64; 3] {
        quartiles(self.0.clone())
    }

    /// Median and quartiles of how many times as long another contender took, round by round.
    pub fn times_faster_than(&self, other: &Times) -> [f64; 3] {
        let ratios = self
            .0
            .iter()
            .zip(&other.0)
            .map(|(ours, theirs)| theirs / ours);
        quartiles(ratios.collect())
    }
}

/// Lower quartile, median, upper quartile.
pub fn quartiles(mut values: Vec<f64>) -> [f64; 3] {
    values.sort_by(f64::total_cmp);
    [1, 2, 3].map(|quarter| values[quarter * (values.len() - 1) / 4])
}

/// The value that so large a share of all does not exceed.
pub fn percentile(values: &mut [f64], share: f64) -> f64 {
    values.sort_by(f64::total_cmp);
    values[(share * (values.len() - 1) as f64).round() as usize]
}

/// Processor time of a piece of work [s].
pub fn seconds(work: impl FnOnce()) -> f64 {
    let start = thread_seconds();
    work();
    thread_seconds() - start
}
