//! A Bayesian staircase: a posterior over observers on a grid, and the difference that is expected to narrow it most.
//!
//! After L. L. Kontsevich and C. W. Tyler (1999), *Bayesian adaptive estimation of psychometric slope and threshold*, Vision Research 39,
//! and A. B. Watson (2017), *QUEST+*, J. Vision 17. An observer says 'different' with the chance
//! `g + (1 - g - LAPSES) (1 - exp(-(d / a)^b))`: threshold a, slope b, false alarms g. Catch trials, d = 0, tell g.

use super::{SMALLEST, TARGET};

/// Share of slips at a difference that nobody misses.
const LAPSES: f64 = 0.02;
/// Thresholds of the grid, evenly spaced logarithms from `SMALLEST` to twice the range.
const THRESHOLDS: usize = 48;
const LARGEST_THRESHOLD: f64 = 2.0;
const SLOPES: [f64; 5] = [1.0, 1.5, 2.2, 3.3, 5.0];
const FALSE_ALARMS: [f64; 5] = [0.02, 0.06, 0.12, 0.2, 0.3];
/// Differences among which the next is chosen, evenly spaced logarithms from `SMALLEST` to 1.
const CANDIDATES: usize = 32;

#[derive(Debug, Clone)]
pub(super) struct Posterior {
    observers: Vec<Observer>,
    /// Probability of each observer.
    weights: Vec<f64>,
    candidates: Vec<f64>,
    /// Candidate by candidate, each observer's chance of 'different' and its entropy, which would be half of all the work.
    chances: Vec<Vec<(f64, f64)>>,
}

#[derive(Debug, Clone, Copy)]
struct Observer {
    threshold: f64,
    slope: f64,
    false_alarms: f64,
}

impl Observer {
    fn chance(self, difference: f64) -> f64 {
        let seen = 1.0 - libm::exp(-libm::pow(difference / self.threshold, self.slope));
        self.false_alarms + (1.0 - self.false_alarms - LAPSES) * seen
    }

    /// The difference that is called different with the chance `TARGET`.
    fn target(self) -> f64 {
        let seen = (TARGET - self.false_alarms) / (1.0 - self.false_alarms - LAPSES);
        self.threshold * libm::pow(-libm::log(1.0 - seen), 1.0 / self.slope)
    }
}

fn spaced(from: f64, to: f64, count: usize) -> impl Iterator<Item = f64> {
    let step = libm::log(to / from) / (count - 1) as f64;
    (0..count).map(move |index| from * libm::exp(step * index as f64))
}

impl Posterior {
    pub(super) fn new() -> Self {
        let mut observers = Vec::new();
        for threshold in spaced(SMALLEST, LARGEST_THRESHOLD, THRESHOLDS) {
            for slope in SLOPES {
                observers.extend(FALSE_ALARMS.map(|false_alarms| Observer {
                    threshold,
                    slope,
                    false_alarms,
                }));
            }
        }
        let candidates: Vec<f64> = spaced(SMALLEST, 1.0, CANDIDATES)
            .map(|difference| difference.min(1.0))
            .collect();
        let row = |difference: &f64| {
            let chances = observers
                .iter()
                .map(|observer| observer.chance(*difference));
            chances
                .map(|chance| (chance, binary_entropy(chance)))
                .collect()
        };
        Posterior {
            weights: vec![1.0 / observers.len() as f64; observers.len()],
            chances: candidates.iter().map(row).collect(),
            candidates,
            observers,
        }
    }

    /// The candidate after whose answer the posterior's entropy is expected to be smallest; of equals the largest.
    pub(super) fn most_telling(&self) -> f64 {
        let mut best = (f64::INFINITY, 1.0);
        for (difference, chances) in self.candidates.iter().zip(&self.chances).rev() {
            let expected = self.expected_entropy(chances);
            if expected < best.0 {
                best = (expected, *difference);
            }
        }
        best.1
    }

    /// Up to a term that is the same for all candidates: minus the information of the answer about the observer.
    fn expected_entropy(&self, chances: &[(f64, f64)]) -> f64 {
        let (mut share, mut own) = (0.0, 0.0);
        for (weight, (chance, entropy)) in self.weights.iter().zip(chances) {
            share += weight * chance;
            own += weight * entropy;
        }
        own - binary_entropy(share)
    }

    pub(super) fn answered(&mut self, difference: f64, different: bool) {
        let mut sum = 0.0;
        for (weight, observer) in self.weights.iter_mut().zip(&self.observers) {
            let chance = observer.chance(difference);
            *weight *= if different { chance } else { 1.0 - chance };
            sum += *weight;
        }
        // Every chance lies from 0.02 to 0.98, so that some weight is left.
        self.weights.iter_mut().for_each(|weight| *weight /= sum);
    }

    /// Posterior mean of the target's logarithm, and its 2.5 % and 97.5 % quantiles.
    pub(super) fn estimate(&self) -> (f64, [f64; 2]) {
        self.mean_and_interval(Observer::target)
    }

    /// The same of the slope, which lies between the ends of [`SLOPES`] whatever the answers.
    pub(super) fn slope(&self) -> (f64, [f64; 2]) {
        self.mean_and_interval(|observer| observer.slope)
    }

    /// The mean of a logarithm, and its quantiles, over the posterior.
    fn mean_and_interval(&self, of: impl Fn(Observer) -> f64) -> (f64, [f64; 2]) {
        let observers = self.observers.iter().zip(&self.weights);
        let mut values: Vec<(f64, f64)> = observers
            .map(|(observer, weight)| (libm::log(of(*observer)), *weight))
            .collect();
        values.sort_by(|a, b| a.0.total_cmp(&b.0));
        let mean = values
            .iter()
            .map(|(value, weight)| value * weight)
            .sum::<f64>();
        let quantile = |share: f64| {
            let mut below = 0.0;
            let found = values.iter().find(|(_, weight)| {
                below += weight;
                below >= share
            });
            libm::exp(found.or(values.last()).map_or(0.0, |(value, _)| *value))
        };
        (libm::exp(mean), [quantile(0.025), quantile(0.975)])
    }
}

fn binary_entropy(p: f64) -> f64 {
    -(p * libm::log(p) + (1.0 - p) * libm::log(1.0 - p))
}
