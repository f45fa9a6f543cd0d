//! How many pins fall: means, deviations, shares, and how sure they are.

use std::fmt::{self, Display, Formatter};

/// Standard normal deviate of a two-sided 95 % interval.
pub const NORMAL_95: f64 = 1.959_963_984_540_054;
/// The same of 99 %.
pub const NORMAL_99: f64 = 2.575_829_303_548_901;

/// Longest bar of a histogram [characters].
const BAR: f64 = 50.0;

/// Counts of fallen pins.
#[derive(Clone, Debug, PartialEq)]
pub struct Distribution {
    /// Throws by the number of pins that fell.
    counts: Vec<u64>,
    cost: f64,
}

impl Distribution {
    /// Of throws at so many pins.
    pub fn new(pins: usize) -> Self {
        Self {
            counts: vec![0; pins + 1],
            cost: 0.0,
        }
    }

    /// Adds a throw that felled so many pins and cost so much [ms/s].
    pub fn add(&mut self, fallen: usize, cost: f64) {
        self.counts[fallen] += 1;
        self.cost += cost;
    }

    /// Throws.
    pub fn throws(&self) -> u64 {
        self.counts.iter().sum()
    }

    /// Mean number of fallen pins.
    pub fn mean(&self) -> f64 {
        let pins = self.counts.iter().zip(0u64..);
        pins.map(|(count, pins)| count * pins).sum::<u64>() as f64 / self.throws() as f64
    }

    /// Standard deviation of the number of fallen pins; 0 for one throw.
    pub fn deviation(&self) -> f64 {
        let mean = self.mean();
        let square = |(count, pins): (&u64, f64)| *count as f64 * (pins - mean).powi(2);
        let pins = (0u32..).map(f64::from);
        let sum: f64 = self.counts.iter().zip(pins).map(square).sum();
        (sum / (self.throws() - 1).max(1) as f64).sqrt()
    }

    /// Standard error of the mean.
    pub fn error(&self) -> f64 {
        self.deviation() / (self.throws() as f64).sqrt()
    }

    /// The mean's 95 % interval, within what is possible.
    pub fn mean_interval(&self) -> [f64; 2] {
        let (mean, half) = (self.mean(), NORMAL_95 * self.error());
        let all = (self.counts.len() - 1) as f64;
        [(mean - half).max(0.0), (mean + half).min(all)]
    }

    /// Throws that felled every pin.
    pub fn strikes(&self) -> u64 {
        self.counts[self.counts.len() - 1]
    }

    /// Share of throws that felled every pin, and its 95 % interval.
    pub fn strike_share(&self) -> (f64, [f64; 2]) {
        let (strikes, throws) = (self.strikes(), self.throws());
        let share = strikes as f64 / throws as f64;
        (share, wilson(strikes, throws, NORMAL_95))
    }
}

/// Interval of a share of which `hits` in `trials` were seen.
///
/// E. B. Wilson, *Probable Inference, the Law of Succession, and Statistical Inference*, J. Am. Stat. Assoc. 22 (1927),
/// 209-212: unlike the usual one it holds near 0 and 1 and for few trials.
pub fn wilson(hits: u64, trials: u64, deviate: f64) -> [f64; 2] {
    if trials == 0 {
        return [0.0, 1.0];
    }
    let (n, z2) = (trials as f64, deviate * deviate);
    let share = hits as f64 / n;
    let middle = (share + z2 / (2.0 * n)) / (1.0 + z2 / n);
    let half = deviate / (1.0 + z2 / n) * (share * (1.0 - share) / n + z2 / (4.0 * n * n)).sqrt();
    [(middle - half).max(0.0), (middle + half).min(1.0)]
}

impl Display for Distribution {
    fn fmt(&self, f: &mut Formatter) -> fmt::Result {
        let throws = self.throws();
        let (share, [low, high]) = self.strike_share();
        let half = NORMAL_95 * self.error();
        writeln!(f, "{throws} throws at {} pins", self.counts.len() - 1)?;
        writeln!(
            f,
            "fallen    mean {:.3} +- {half:.3} (95 %), standard deviation {:.3}",
            self.mean(),
            self.deviation()
        )?;
        writeln!(
            f,
            "all       {:.2} %, 95 % interval {:.2} to {:.2} %",
            1e2 * share,
            1e2 * low,
            1e2 * high
        )?;
        let most = self.counts.iter().copied().max().unwrap_or(0).max(1);
        for (pins, count) in self.counts.iter().enumerate() {
            let bar = (BAR * *count as f64 / most as f64).round() as usize;
            let line = format!("{pins:>6} {count:>9}  {}", "#".repeat(bar));
            writeln!(f, "{}", line.trim_end())?;
        }
        let cost = self.cost / throws as f64;
        writeln!(f, "cost      {cost:.3} ms of one core per simulated second")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn wilson_agrees_with_published_intervals() {
        // R. G. Newcombe, Statistics in Medicine 17 (1998), 857-872, Table I, method 3.
        for (hits, trials, low, high) in [
            (81, 263, 0.2553, 0.3662),
            (15, 148, 0.0624, 0.1605),
            (0, 20, 0.0000, 0.1611),
            (1, 29, 0.0061, 0.1718),
        ] {
            let [a, b] = wilson(hits, trials, NORMAL_95);
            assert!((a - low).abs() < 6e-5 && (b - high).abs() < 6e-5, "{a} {b}");
        }
        assert_eq!(wilson(0, 0, NORMAL_95), [0.0, 1.0]);
    }

    #[test]
    fn mean_and_deviation_of_few() {
        let mut seen = Distribution::new(10);
        for fallen in [10, 10, 7, 9, 4] {
            seen.add(fallen, 2.0);
        }
        assert_eq!((seen.throws(), seen.strikes()), (5, 2));
        assert!((seen.mean() - 8.0).abs() < 1e-12);
        // Squares 4, 4, 1, 1, 16 over 4.
        assert!((seen.deviation() - 6.5f64.sqrt()).abs() < 1e-12);
        let text = seen.to_string();
        assert!(
            text.contains("mean 8.000") && text.contains("all       40.00 %"),
            "{text}"
        );
    }
}
