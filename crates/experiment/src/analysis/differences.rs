//! A study of differences: what pairs of throws came to, for each participant and for all together.
//!
//! | file | columns that are used |
//! |---|---|
//! | `data/phenotype/thresholds.tsv` | `participant_id`, `session_id`, `threshold`, `low`, `high` |
//! | `data/sub-*/ses-*/beh/*_task-pairs_beh.tsv` | `difference`, `reply` |
//! | `plan/study.toml` | `[staircase]` |

use std::path::Path;

use serde_json::{Value, json};

use super::exact;
use super::json::number;
use super::study::AnalysisError;
use super::table::Table;
use super::tails;
use crate::staircase::{self, Fitted, Rule, StaircasePlan};
use crate::study::Study;

/// The analysis of a study of differences.
#[derive(Debug, Clone)]
pub struct Differences {
    /// The folder.
    pub source: String,
    /// What was compared.
    pub plan: StaircasePlan,
    /// Who compared, in the order of the table.
    pub observed: Vec<Observed>,
}

/// What one session came to. Differences and thresholds are in the parameter's unit.
#[derive(Debug, Clone, PartialEq)]
pub struct Observed {
    /// The participant's id.
    pub id: String,
    /// Each pair's difference, 0 in a catch trial, and whether it was called different; in their order.
    pub answers: Vec<(f64, bool)>,
    /// Threshold and interval as the plan's rule has them; `None` where its pairs do not tell.
    pub rule: Option<Threshold>,
    /// The function fitted to all pairs; `None` without one that has a difference.
    pub fitted: Option<Fitted>,
}

/// A threshold in the parameter's unit.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Threshold {
    /// The difference that is called different 70.7 % of the time.
    pub value: f64,
    /// Ends of its 95 % interval.
    pub interval: [f64; 2],
}

/// How often pairs without a difference were called different.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FalseAlarms {
    /// Called different.
    pub alarms: u32,
    /// Catch trials.
    pub catches: u32,
}

impl FalseAlarms {
    /// Their share; `None` without catch trials.
    pub fn rate(self) -> Option<f64> {
        (self.catches > 0).then(|| f64::from(self.alarms) / f64::from(self.catches))
    }

    /// Wilson's 95 % interval of the share; `None` without catch trials.
    pub fn interval(self) -> Option<[f64; 2]> {
        (self.catches > 0).then(|| exact::wilson(self.alarms, self.catches))
    }
}

/// What is common to several participants: the mean of logarithms, since thresholds differ by factors.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Common {
    /// Participants.
    pub count: usize,
    /// The geometric mean.
    pub mean: f64,
    /// Ends of its 95 % interval between participants (Student's t on the logarithms); `None` of one participant.
    pub interval: Option<[f64; 2]>,
    /// Standard deviation between participants, as a factor; `None` of one participant.
    pub spread: Option<f64>,
}

impl Common {
    /// Of values above 0; `None` of none.
    pub fn of(values: &[f64]) -> Option<Common> {
        if values.is_empty() {
            return None;
        }
        let count = values.len() as f64;
        let logs: Vec<f64> = values.iter().map(|value| libm::log(*value)).collect();
        let mean = logs.iter().sum::<f64>() / count;
        let squares = logs.iter().map(|log| (log - mean) * (log - mean));
        let deviation = (values.len() > 1).then(|| (squares.sum::<f64>() / (count - 1.0)).sqrt());
        let interval = deviation.map(|deviation| {
            let half = tails::student_beyond(0.025, count - 1.0) * deviation / count.sqrt();
            [libm::exp(mean - half), libm::exp(mean + half)]
        });
        Some(Common {
            count: values.len(),
            mean: libm::exp(mean),
            interval,
            spread: deviation.map(libm::exp),
        })
    }
}

impl Differences {
    /// Reads and analyses a study of differences; `None` where `path` is none: a table, or a study of games.
    ///
    /// # Errors
    /// When a file of the study cannot be used, by row and column.
    pub fn of(path: &Path) -> Result<Option<Differences>, AnalysisError> {
        let thresholds = path.join("data/phenotype/thresholds.tsv");
        if !thresholds.is_file() {
            return Ok(None);
        }
        let study = Study::open(path).map_err(|error| AnalysisError::Study(error.to_string()))?;
        let Some(plan) = study.plan().staircase.clone() else {
            return Ok(None);
        };
        let table = Table::read(&thresholds)?;
        let rows = 0..table.rows.len();
        let observed = rows.map(|row| observed(path, &table, row, &plan));
        Ok(Some(Differences {
            source: path.display().to_string(),
            observed: observed.collect::<Result<_, _>>()?,
            plan,
        }))
    }

    /// From the standard value to the one that is furthest from it, in the parameter's unit.
    pub fn range(&self) -> f64 {
        self.plan.range()
    }

    /// Pairs of all participants.
    pub fn pairs(&self) -> usize {
        self.observed.iter().map(|one| one.answers.len()).sum()
    }

    /// False alarms of all participants.
    pub fn false_alarms(&self) -> FalseAlarms {
        let each = self.observed.iter().map(Observed::false_alarms);
        each.fold(
            FalseAlarms {
                alarms: 0,
                catches: 0,
            },
            |sum, one| FalseAlarms {
                alarms: sum.alarms + one.alarms,
                catches: sum.catches + one.catches,
            },
        )
    }

    /// The thresholds of the plan's rule, together.
    pub fn threshold(&self) -> Option<Common> {
        let rules = self.observed.iter().filter_map(|one| one.rule);
        Common::of(&rules.map(|rule| rule.value).collect::<Vec<_>>())
    }

    /// The thresholds of the fits, together, in the parameter's unit.
    pub fn fitted_threshold(&self) -> Option<Common> {
        let fits = self.observed.iter().filter_map(|one| one.fitted);
        Common::of(
            &fits
                .map(|fit| fit.threshold * self.range())
                .collect::<Vec<_>>(),
        )
    }

    /// The slopes of the fits, together.
    pub fn slope(&self) -> Option<Common> {
        let fits = self.observed.iter().filter_map(|one| one.fitted);
        Common::of(&fits.map(|fit| fit.slope).collect::<Vec<_>>())
    }

    /// Every number.
    pub fn json(&self) -> Value {
        let alarms = self.false_alarms();
        json!({
            "source": self.source,
            "parameter": self.plan.key,
            "standard": self.plan.standard,
            "furthest": self.plan.furthest,
            "rule": match self.plan.rule {
                Rule::OneUpTwoDown => "one_up_two_down",
                Rule::Bayesian => "bayesian",
            },
            "called_different_at_threshold": staircase::TARGET,
            "participants": self.observed.iter().map(|one| one.json(self.range())).collect::<Vec<_>>(),
            "together": {
                "participants": self.observed.len(),
                "pairs": self.pairs(),
                "threshold": common(self.threshold()),
                "fitted_threshold": common(self.fitted_threshold()),
                "slope": common(self.slope()),
                "false_alarms": false_alarms(alarms),
            },
        })
    }
}

impl Observed {
    /// How often equal throws were called different.
    pub fn false_alarms(&self) -> FalseAlarms {
        let catches = self
            .answers
            .iter()
            .filter(|(difference, _)| *difference == 0.0);
        let alarms = catches.clone().filter(|(_, is_different)| *is_different);
        FalseAlarms {
            alarms: alarms.count() as u32,
            catches: catches.count() as u32,
        }
    }

    fn json(&self, range: f64) -> Value {
        let rule = self.rule.map(|rule| {
            json!({"threshold": number(rule.value), "low": number(rule.interval[0]), "high": number(rule.interval[1])})
        });
        let fitted = self.fitted.map(|fit| {
            json!({
                "threshold": fit.threshold * range,
                "low": fit.interval[0] * range,
                "high": fit.interval[1] * range,
                "slope": fit.slope,
                "slope_low": fit.slope_interval[0],
                "slope_high": fit.slope_interval[1],
            })
        });
        json!({
            "id": self.id,
            "pairs": self.answers.len(),
            "rule": rule,
            "fitted": fitted,
            "false_alarms": false_alarms(self.false_alarms()),
        })
    }
}

fn common(common: Option<Common>) -> Value {
    common.map_or(Value::Null, |common| {
        json!({
            "participants": common.count,
            "geometric_mean": common.mean,
            "low": common.interval.map(|[low, _]| low),
            "high": common.interval.map(|[_, high]| high),
            "spread_factor": common.spread,
        })
    })
}

fn false_alarms(found: FalseAlarms) -> Value {
    json!({
        "alarms": found.alarms,
        "catches": found.catches,
        "rate": found.rate(),
        "wilson95": found.interval(),
    })
}

/// The session in a row of `thresholds.tsv`, with its pairs.
fn observed(
    folder: &Path,
    thresholds: &Table,
    row: usize,
    plan: &StaircasePlan,
) -> Result<Observed, AnalysisError> {
    let needed = |name: &str| thresholds.needed(&[name], "a study of differences has");
    let id = thresholds.rows[row][needed("participant_id")?].clone();
    let session = &thresholds.rows[row][needed("session_id")?];
    let value = |name: &str| thresholds.number(row, needed(name)?);
    let rule = match (value("threshold")?, value("low")?, value("high")?) {
        (Some(value), Some(low), Some(high)) => Some(Threshold {
            value,
            interval: [low, high],
        }),
        _ => None,
    };
    let name = format!("data/{id}/{session}/beh/{id}_{session}_task-pairs_beh.tsv");
    let answers = answers(&folder.join(name))?;
    let range = plan.range();
    let is_compared = answers.iter().any(|(difference, _)| *difference > 0.0);
    let shares = answers
        .iter()
        .map(|(difference, is)| (difference / range, *is));
    Ok(Observed {
        fitted: is_compared.then(|| staircase::fit(&shares.collect::<Vec<_>>())),
        id,
        answers,
        rule,
    })
}

/// The pairs of a session: difference and whether it was called different; none where a session was stopped before the first.
fn answers(path: &Path) -> Result<Vec<(f64, bool)>, AnalysisError> {
    let table = match Table::read(path) {
        Ok(table) => table,
        Err(super::table::TableError::Empty { .. }) => return Ok(Vec::new()),
        Err(error) => return Err(error.into()),
    };
    let difference = table.needed(&["difference"], "a table of pairs has")?;
    let reply = table.needed(&["reply"], "a table of pairs has")?;
    let answer = |row: usize| -> Result<(f64, bool), AnalysisError> {
        let off = table.number(row, difference)?.filter(|off| *off >= 0.0);
        let off = off.ok_or_else(|| table.refuse(row, difference, "a number of 0 or more"))?;
        match table.cell(row, reply) {
            Some("same") => Ok((off, false)),
            Some("different") => Ok((off, true)),
            _ => Err(table.refuse(row, reply, "same or different").into()),
        }
    };
    (0..table.rows.len()).map(answer).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::SplitMix64;
    use crate::staircase::{Observer, Staircase};

    #[test]
    fn common_is_the_mean_of_logarithms_with_students_interval() {
        // Logarithms 0, 1, 2: mean 1, deviation 1, t(0.975, 2) = 4.302653.
        let e = std::f64::consts::E;
        let common = Common::of(&[1.0, e, e * e]).unwrap();
        assert!((common.mean - e).abs() < 1e-12 && common.count == 3);
        let [low, high] = common.interval.unwrap();
        let half = 4.302_652_73 / 3.0_f64.sqrt();
        assert!((low.ln() - (1.0 - half)).abs() < 1e-6 && (high.ln() - (1.0 + half)).abs() < 1e-6);
        assert!((common.spread.unwrap() - e).abs() < 1e-12);
        let one = Common::of(&[0.2]).unwrap();
        assert!((one.mean - 0.2).abs() < 1e-15 && one.interval.is_none() && one.spread.is_none());
        assert_eq!(Common::of(&[]), None);
    }

    /// After the Bayesian rule the fit is the rule's own estimate; after the other one it finds the same observer.
    #[test]
    fn fit_is_the_bayesian_rules_estimate_and_finds_the_observer_of_the_other() {
        let observer = Observer {
            target: 0.2,
            false_alarms: 0.08,
        };
        for (rule, tolerance) in [(Rule::Bayesian, 1e-12), (Rule::OneUpTwoDown, 0.15)] {
            let plan = StaircasePlan {
                key: "objects.elasticity".to_owned(),
                standard: 1.0,
                furthest: 0.5,
                rule,
                trials: 80,
                catch_share: 0.2,
            };
            let mut off = 0.0;
            for seed in 0..20 {
                let mut staircase = Staircase::new(&plan, seed).unwrap();
                let mut random = SplitMix64::for_index(seed, 5);
                while let Some(trial) = staircase.next_trial().unwrap() {
                    let reply = observer.reply(trial.difference, &mut random);
                    staircase.reply(reply).unwrap();
                }
                let answers: Vec<(f64, bool)> = staircase
                    .done()
                    .iter()
                    .map(|(trial, reply)| (trial.difference, *reply == staircase::Reply::Different))
                    .collect();
                let truth = match rule {
                    Rule::Bayesian => staircase.estimate().unwrap().threshold / 0.5,
                    Rule::OneUpTwoDown => 0.2,
                };
                off += (staircase::fit(&answers).threshold / truth).ln() / 20.0;
            }
            assert!(off.abs() < tolerance, "{rule:?}: {off}, seeds 0 to 19");
        }
    }

    /// Answers of Weibull observers with a shallow and a steep slope, at differences all over the range: the fit tells them apart.
    #[test]
    fn fit_tells_a_steep_observer_from_a_shallow_one() {
        for (slope, low, high) in [(1.5, 1.2, 1.9), (4.0, 3.0, 5.0)] {
            let mut random = SplitMix64::new(3);
            let answers: Vec<(f64, bool)> = (0..600)
                .map(|index| {
                    let difference = f64::from(index % 30) / 60.0;
                    let seen = 1.0 - (-(difference / 0.2_f64).powf(slope)).exp();
                    (difference, random.uniform() < 0.06 + 0.92 * seen)
                })
                .collect();
            let fit = staircase::fit(&answers);
            assert!((low..high).contains(&fit.slope), "{slope}: {fit:?}, seed 3");
            // Where 70.7 % are called different: 1 - exp(-(d / 0.2)^b) = (0.7071 - 0.06) / 0.92.
            let truth = 0.2 * (-(1.0 - 0.647_107 / 0.92_f64).ln()).powf(1.0 / slope);
            assert!((fit.threshold / truth).ln().abs() < 0.1, "{truth}: {fit:?}");
            assert!(
                (fit.interval[0]..=fit.interval[1]).contains(&truth),
                "{fit:?}"
            );
        }
    }
}
