//! An observer whose threshold is known, against whom both rules are run and studies are simulated.

use super::{Reply, TARGET};
use crate::random::SplitMix64;

/// Steepness per factor e of the difference. [D]
const STEEPNESS: f64 = 4.0;

/// Says 'different' with a chance that rises with the difference: a logistic in its logarithm, no shape that the rules assume.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Observer {
    /// Difference, as a part of the range, that is called different 70.7 % of the time.
    pub target: f64,
    /// Chance that two throws at the standard value are called different; below [`TARGET`].
    pub false_alarms: f64,
}

impl Observer {
    /// The chance that a difference, as a part of the range, is called different.
    pub fn chance(&self, difference: f64) -> f64 {
        let guessed = self.false_alarms;
        if difference <= 0.0 {
            return guessed;
        }
        // Shifted so that the chance at the target is the one that is looked for.
        let seen = (TARGET - guessed) / (1.0 - guessed);
        let shift = libm::log(seen / (1.0 - seen));
        let height = STEEPNESS * libm::log(difference / self.target) + shift;
        guessed + (1.0 - guessed) / (1.0 + libm::exp(-height))
    }

    /// The answer to a pair that is off by `difference`, as a part of the range.
    pub fn reply(&self, difference: f64, random: &mut SplitMix64) -> Reply {
        if random.uniform() < self.chance(difference) {
            Reply::Different
        } else {
            Reply::Same
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn chance_is_what_it_is_at_the_target_and_rises() {
        let observer = Observer {
            target: 0.2,
            false_alarms: 0.08,
        };
        assert_eq!(observer.chance(0.0), 0.08);
        assert!((observer.chance(0.2) - 0.5f64.sqrt()).abs() < 1e-12);
        // By hand: seen 0.6813 there, so 1 / (1 + 0.4677 / 16) at twice the target.
        let twice = 0.08 + 0.92 / (1.0 + 0.4677 / 16.0);
        assert!((observer.chance(0.4) - twice).abs() < 1e-4);
        assert!(observer.chance(0.1) < observer.chance(0.11));
    }
}
