//! Just-noticeable differences: how far a parameter has to be from its standard value until two throws feel different.
//!
//! A **trial** is a pair of throws, one at the standard value and one that is off by a *difference*, in either order; the answer is
//! 'same' or 'different'. A **catch trial** has the standard value twice: what is called different there is a false alarm. A
//! difference is a part of the range from `standard` to `furthest`, above 0 and at most 1. Both rules look for the
//! difference that is called different 70.7 % of the time, where one-up two-down settles (H. Levitt 1971, *Transformed up-down methods
//! in psychoacoustics*, J. Acoust. Soc. Am. 49).

mod observer;
mod posterior;
mod up_down;

pub use observer::Observer;

use serde::{Deserialize, Serialize};

use crate::random::SplitMix64;
use posterior::Posterior;
use up_down::UpDown;

/// Share of 'different' that is looked for: two in a row come as often as not.
pub const TARGET: f64 = std::f64::consts::FRAC_1_SQRT_2;
/// Smallest difference that is tried, as a part of the range.
const SMALLEST: f64 = 0.01;
/// Most trials of one participant: nobody throws more.
const MOST_TRIALS: u32 = 1000;

/// Trials as the plan has them.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct StaircasePlan {
    /// Configuration key of the parameter.
    pub key: String,
    /// Its value in the one throw of every pair.
    pub standard: f64,
    /// Its value at the largest difference.
    pub furthest: f64,
    /// How the next difference is chosen.
    pub rule: Rule,
    /// Trials of a participant, catch trials included.
    pub trials: u32,
    /// Share of catch trials, from 0 to 0.5.
    pub catch_share: f64,
}

/// How the next difference is chosen.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Rule {
    /// Larger after 'same', smaller after two 'different' in a row.
    OneUpTwoDown,
    /// The one whose answer is expected to tell most about the observer.
    Bayesian,
}

/// Why a staircase cannot be run.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum StaircaseError {
    /// A value is out of range.
    #[error("staircase.{0}")]
    Content(String),
    /// An answer came when no trial was open, or a trial was asked for while one was.
    #[error("an answer belongs to one trial and a trial gets one answer: this is the wrong turn")]
    Turn,
}

/// One pair of throws.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Trial {
    /// From 1.
    pub number: u32,
    /// The parameter in the first throw.
    pub first: f64,
    /// The parameter in the second.
    pub second: f64,
    /// Difference, as a part of the range; 0 in a catch trial.
    pub difference: f64,
}

/// What was answered.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Reply {
    /// The two throws felt alike.
    Same,
    /// They did not.
    Different,
}

/// What the trials have shown so far.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Estimate {
    /// The difference that is called different 70.7 % of the time, in the parameter's unit.
    pub threshold: f64,
    /// Ends of its nominal 95 % interval, the smaller first: of stretches of turns, or of the posterior. Against observers that are
    /// known it has the truth about nine times in ten.
    pub interval: [f64; 2],
    /// Catch trials that were called different.
    pub false_alarms: u32,
    /// Catch trials.
    pub catches: u32,
}

/// The function of known form that answers to pairs fit best, whatever rule chose the pairs.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Fitted {
    /// The difference that is called different 70.7 % of the time, as a part of the range.
    pub threshold: f64,
    /// Ends of its 95 % interval.
    pub interval: [f64; 2],
    /// Exponent b of the Weibull function `1 - exp(-(d / a)^b)`, from 1, shallow, to 5, steep: nothing else is looked for.
    pub slope: f64,
    /// Ends of its 95 % interval.
    pub slope_interval: [f64; 2],
}

/// Fits a Weibull function with false alarms to pairs: their differences as a part of the range, 0 in a catch trial, and whether they
/// were called different. It is the Bayesian rule's own posterior, so that after this rule threshold and interval are the rule's.
pub fn fit(answers: &[(f64, bool)]) -> Fitted {
    let mut posterior = Posterior::new();
    for (difference, is_different) in answers {
        posterior.answered(*difference, *is_different);
    }
    let (threshold, interval) = posterior.estimate();
    let (slope, slope_interval) = posterior.slope();
    Fitted {
        threshold,
        interval,
        slope,
        slope_interval,
    }
}

#[derive(Debug, Clone)]
enum Chooser {
    UpDown(UpDown),
    Posterior(Box<Posterior>),
}

/// Trials of one participant.
#[derive(Debug, Clone)]
pub struct Staircase {
    plan: StaircasePlan,
    random: SplitMix64,
    chooser: Chooser,
    /// Number of the catch trial in the current stretch of trials that has one.
    catch_at: u32,
    open: Option<Trial>,
    done: Vec<(Trial, Reply)>,
}

impl StaircasePlan {
    /// From the standard value to the one that is furthest from it, in the parameter's unit.
    pub fn range(&self) -> f64 {
        (self.furthest - self.standard).abs()
    }

    /// Whether it can be run.
    ///
    /// # Errors
    /// One sentence that names the key.
    pub fn check(&self) -> Result<(), StaircaseError> {
        let wrong = |what: String| Err(StaircaseError::Content(what));
        if self.key.trim().is_empty() {
            return wrong("key is empty: name the parameter".to_owned());
        }
        if !self.standard.is_finite()
            || !self.furthest.is_finite()
            || self.standard == self.furthest
        {
            return wrong(format!(
                "standard and furthest are {} and {}: they have to be two different numbers",
                self.standard, self.furthest
            ));
        }
        if !(1..=MOST_TRIALS).contains(&self.trials) {
            return wrong(format!(
                "trials is {}, and has to be 1 to {MOST_TRIALS}",
                self.trials
            ));
        }
        if !(0.0..=0.5).contains(&self.catch_share) {
            return wrong(format!(
                "catch_share is {}, and has to be from 0 to 0.5",
                self.catch_share
            ));
        }
        Ok(())
    }

    /// A stretch of so many trials has one catch trial; `None` without any.
    fn stretch(&self) -> Option<u32> {
        (self.catch_share > 0.0).then(|| {
            (1.0 / self.catch_share)
                .round()
                .clamp(2.0, f64::from(MOST_TRIALS) + 1.0) as u32
        })
    }
}

impl Staircase {
    /// A participant's trials; the same plan, seed and answers give the same trials.
    ///
    /// # Errors
    /// When the plan cannot be run.
    pub fn new(plan: &StaircasePlan, seed: u64) -> Result<Self, StaircaseError> {
        plan.check()?;
        let chooser = match plan.rule {
            Rule::OneUpTwoDown => Chooser::UpDown(UpDown::new()),
            Rule::Bayesian => Chooser::Posterior(Box::new(Posterior::new())),
        };
        Ok(Staircase {
            plan: plan.clone(),
            random: SplitMix64::new(seed),
            chooser,
            catch_at: 0,
            open: None,
            done: Vec::new(),
        })
    }

    /// The trials that answers have led to, for taking a session up again.
    ///
    /// # Errors
    /// When the plan cannot be run or there are more answers than trials.
    pub fn replay(
        plan: &StaircasePlan,
        seed: u64,
        replies: &[Reply],
    ) -> Result<Self, StaircaseError> {
        let mut staircase = Staircase::new(plan, seed)?;
        for reply in replies {
            staircase.next_trial()?;
            staircase.reply(*reply)?;
        }
        Ok(staircase)
    }

    /// The next pair of throws; `None` when all trials are done.
    ///
    /// # Errors
    /// When the last trial has no answer yet.
    pub fn next_trial(&mut self) -> Result<Option<Trial>, StaircaseError> {
        if self.open.is_some() {
            return Err(StaircaseError::Turn);
        }
        let number = self.done.len() as u32 + 1;
        if number > self.plan.trials {
            return Ok(None);
        }
        let difference = if self.is_catch(number) {
            0.0
        } else {
            match &self.chooser {
                Chooser::UpDown(rule) => rule.difference(),
                Chooser::Posterior(rule) => rule.most_telling(),
            }
        };
        let other = self.plan.standard + difference * (self.plan.furthest - self.plan.standard);
        let pair = if self.random.below(2) == 0 {
            [self.plan.standard, other]
        } else {
            [other, self.plan.standard]
        };
        let trial = Trial {
            number,
            first: pair[0],
            second: pair[1],
            difference,
        };
        self.open = Some(trial);
        Ok(Some(trial))
    }

    /// Takes the answer to the open trial.
    ///
    /// # Errors
    /// When no trial is open.
    pub fn reply(&mut self, reply: Reply) -> Result<(), StaircaseError> {
        let trial = self.open.take().ok_or(StaircaseError::Turn)?;
        let different = reply == Reply::Different;
        match &mut self.chooser {
            // A catch trial says nothing about where the staircase is.
            Chooser::UpDown(rule) if trial.difference > 0.0 => rule.answered(different),
            Chooser::UpDown(_) => {}
            Chooser::Posterior(rule) => rule.answered(trial.difference, different),
        }
        self.done.push((trial, reply));
        Ok(())
    }

    /// The trial that waits for its answer.
    pub fn open_trial(&self) -> Option<Trial> {
        self.open
    }

    /// The trials with their answers.
    pub fn done(&self) -> &[(Trial, Reply)] {
        &self.done
    }

    /// What is known so far; `None` as long as it is nothing: one-up two-down needs ten turns.
    pub fn estimate(&self) -> Option<Estimate> {
        let (threshold, interval) = match &self.chooser {
            Chooser::UpDown(rule) => rule.estimate()?,
            Chooser::Posterior(rule) => rule.estimate(),
        };
        let range = self.plan.range();
        let catches = self
            .done
            .iter()
            .filter(|(trial, _)| trial.difference == 0.0);
        let alarms = catches
            .clone()
            .filter(|(_, reply)| *reply == Reply::Different);
        Some(Estimate {
            threshold: threshold * range,
            interval: interval.map(|end| end * range),
            false_alarms: alarms.count() as u32,
            catches: catches.count() as u32,
        })
    }

    /// Whether trial `number` is the one of its stretch that is a catch; drawn when the stretch begins.
    fn is_catch(&mut self, number: u32) -> bool {
        let Some(stretch) = self.plan.stretch() else {
            return false;
        };
        if (number - 1).is_multiple_of(stretch) {
            // Never the first: a participant begins with a difference to be heard.
            let first = u64::from(number == 1);
            self.catch_at = number + (first + self.random.below(u64::from(stretch) - first)) as u32;
        }
        number == self.catch_at
    }
}

#[cfg(test)]
mod tests;
