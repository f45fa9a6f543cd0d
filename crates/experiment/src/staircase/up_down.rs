//! One-up two-down in steps of the difference's logarithm.

use statrs::distribution::{ContinuousCDF, StudentsT};

use super::SMALLEST;

/// Factors of the difference from one trial to the next: coarse to the first turn, then finer.
const STEPS: [(usize, f64); 3] = [
    (1, 2.0),
    (3, std::f64::consts::SQRT_2),
    (usize::MAX, 1.189_207_115_002_721),
];
/// Turns that are too early to say something.
const EARLY: usize = 2;

#[derive(Debug, Clone)]
pub(super) struct UpDown {
    difference: f64,
    in_a_row: u32,
    /// Whether the last change was to a smaller difference.
    falling: Option<bool>,
    /// Differences at which the direction changed.
    turns: Vec<f64>,
}

impl UpDown {
    pub(super) fn new() -> Self {
        UpDown {
            difference: 1.0,
            in_a_row: 0,
            falling: None,
            turns: Vec::new(),
        }
    }

    pub(super) fn difference(&self) -> f64 {
        self.difference
    }

    pub(super) fn answered(&mut self, different: bool) {
        self.in_a_row = if different { self.in_a_row + 1 } else { 0 };
        let falls = match (different, self.in_a_row) {
            (false, _) => false,
            (true, 2) => true,
            (true, _) => return,
        };
        self.in_a_row = 0;
        if self.falling.is_some_and(|falling| falling != falls) {
            self.turns.push(self.difference);
        }
        self.falling = Some(falls);
        let turns = self.turns.len();
        let (_, step) = STEPS
            .into_iter()
            .find(|(until, _)| turns < *until)
            .expect("the last is for any number");
        let next = if falls {
            self.difference / step
        } else {
            self.difference * step
        };
        self.difference = next.clamp(SMALLEST, 1.0);
    }

    /// The mean of the turns' logarithms, and a 95 % interval from the means of stretches of four turns, two high and two low;
    /// `None` before two such stretches. Pairs of turns (G. B. Wetherill and H. Levitt 1965) hang together so much that
    /// their interval has the truth 79 times in 100.
    pub(super) fn estimate(&self) -> Option<(f64, [f64; 2])> {
        let late = self.turns.get(EARLY..)?;
        let mean_of = |turns: &[f64]| {
            turns.iter().map(|turn| libm::log(*turn)).sum::<f64>() / turns.len() as f64
        };
        let stretches: Vec<f64> = late.chunks_exact(4).map(mean_of).collect();
        if stretches.len() < 2 {
            return None;
        }
        let count = stretches.len() as f64;
        let mean = mean_of(&late[..stretches.len() * 4]);
        let variance = stretches
            .iter()
            .map(|own| (own - mean).powi(2))
            .sum::<f64>()
            / (count - 1.0);
        let student = StudentsT::new(0.0, 1.0, count - 1.0).expect("one degree of freedom or more");
        let half = student.inverse_cdf(0.975) * (variance / count).sqrt();
        Some((
            libm::exp(mean),
            [libm::exp(mean - half), libm::exp(mean + half)],
        ))
    }
}
