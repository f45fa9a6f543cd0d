//! All that is said about one model: the fit, what deleting each group costs, and the penalised fit beside it.

use super::design::{Design, Group};
use super::firth::{self, Penalised};
use super::fit::{Fit, null_deviance};
use super::linear::{Cholesky, aliases};
use super::model::Term;
use super::newton::{EXACT, Start};
use super::profile::{Interval, likelihood_intervals, penalised_intervals};
use super::rows::Rows;
use super::tails;

/// A regression.
#[derive(Debug, Clone)]
pub struct Regression {
    /// Columns and rows.
    pub design: Design,
    /// Maximum likelihood.
    pub fit: Fit,
    /// Its profile intervals.
    pub intervals: Vec<Interval>,
    /// The model with a constant alone.
    pub null: Null,
    /// The cost of deleting each term.
    pub deletions: Vec<Deletion>,
    /// Firth's estimates; `None` where their information is singular.
    pub firth: Option<Firth>,
}

/// The model with a constant alone.
#[derive(Debug, Clone, Copy)]
pub struct Null {
    /// Its deviance.
    pub deviance: f64,
    /// Its log-likelihood.
    pub log_likelihood: f64,
    /// Whether the model contains it.
    pub is_nested: bool,
}

/// What deleting a group of columns costs.
#[derive(Debug, Clone)]
pub struct Deletion {
    /// Name of the group.
    pub group: String,
    /// Names of its columns.
    pub deleted: Vec<String>,
    /// Deviance without them.
    pub deviance: f64,
    /// Residual degrees of freedom without them.
    pub df: usize,
    /// How much the deviance rises.
    pub change: f64,
    /// By how many parameters.
    pub change_df: usize,
    /// The paper's chi-squared test; `None` where nothing is deleted.
    pub p: Option<f64>,
    /// The quasi-binomial F test: its value and probability.
    pub quasi: Option<(f64, f64)>,
    /// Whether the smaller model is separated.
    pub is_separated: bool,
}

/// The penalised fit.
#[derive(Debug, Clone)]
pub struct Firth {
    /// Estimates, objective and score.
    pub maximum: Penalised,
    /// Standard errors from the information at the estimates.
    pub errors: Vec<f64>,
    /// Penalised likelihood-ratio test of each fitted column.
    pub single: Vec<PenalisedTest>,
    /// Penalised likelihood-ratio tests of terms, with the place of each among the groups.
    pub groups: Vec<(usize, PenalisedTest)>,
    /// Profile intervals.
    pub intervals: Vec<Interval>,
}

/// A penalised likelihood-ratio test.
#[derive(Debug, Clone, Copy)]
pub struct PenalisedTest {
    /// Twice the loss.
    pub ratio: f64,
    /// Coefficients held at 0.
    pub df: usize,
    /// The probability of a larger one.
    pub p: f64,
}

impl Regression {
    /// Fits `design`.
    pub fn new(design: Design) -> Regression {
        let rows = design.rows();
        let fit = Fit::of(&rows);
        let null = null(&rows, &fit);
        let dispersion = dispersion(&fit);
        let groups = design
            .groups
            .iter()
            .filter(|group| group.term != Term::Constant);
        let deletions = groups
            .map(|group| deletion(&design, &rows, &fit, group, dispersion))
            .collect();
        let intervals = likelihood_intervals(&fit);
        let firth = firth_of(&design, &fit);
        Regression {
            design,
            fit,
            intervals,
            null,
            deletions,
            firth,
        }
    }

    /// Pearson's chi-squared over its degrees of freedom: 1 where answers vary as the binomial says.
    pub fn dispersion(&self) -> Option<f64> {
        dispersion(&self.fit)
    }
}

fn dispersion(fit: &Fit) -> Option<f64> {
    (fit.df() > 0 && fit.converged).then(|| fit.pearson() / fit.df() as f64)
}

fn null(rows: &Rows, fit: &Fit) -> Null {
    let deviance = null_deviance(rows);
    let with_constant = with_constant(rows, &(0..rows.columns).collect::<Vec<_>>());
    Null {
        deviance,
        log_likelihood: super::fit::saturated(rows) + super::fit::log_coefficients(rows)
            - 0.5 * deviance,
        is_nested: aliases(&with_constant.x, with_constant.columns).kept.len() == fit.rank(),
    }
}

/// These columns, and a constant before them.
fn with_constant(rows: &Rows, columns: &[usize]) -> Rows {
    let mut with = Rows {
        columns: columns.len() + 1,
        high: rows.high.clone(),
        asked: rows.asked.clone(),
        x: Vec::new(),
    };
    for i in 0..rows.len() {
        with.x.push(1.0);
        with.x.extend(columns.iter().map(|&j| rows.row(i)[j]));
    }
    with
}

/// The rows without a group. The indicators of `change` stand in place of a constant, which stays when they go.
pub fn without(design: &Design, rows: &Rows, groups: &[&Group]) -> Rows {
    let gone = |j: usize| groups.iter().any(|group| group.columns.contains(&j));
    let left: Vec<usize> = (0..rows.columns).filter(|&j| !gone(j)).collect();
    let has_constant = design
        .groups
        .iter()
        .any(|group| group.term == Term::Constant);
    let takes_change = groups.iter().any(|group| group.term == Term::Change);
    if takes_change && !has_constant {
        with_constant(rows, &left)
    } else {
        rows.with_columns(&left)
    }
}

fn deletion(
    design: &Design,
    rows: &Rows,
    full: &Fit,
    group: &Group,
    dispersion: Option<f64>,
) -> Deletion {
    let fit = Fit::of(&without(design, rows, &[group]));
    let change_df = full.rank() - fit.rank();
    let change = if change_df == 0 {
        0.0
    } else {
        (fit.deviance - full.deviance).max(0.0)
    };
    let quasi = dispersion
        .filter(|d| change_df > 0 && *d > 0.0)
        .map(|dispersion| {
            let value = change / change_df as f64 / dispersion;
            (
                value,
                tails::fisher(value, change_df as f64, full.df() as f64),
            )
        });
    Deletion {
        group: group.term.group(),
        deleted: design.names(&group.columns),
        deviance: fit.deviance,
        df: fit.df(),
        change,
        change_df,
        p: tails::chi_squared(change, change_df),
        quasi,
        is_separated: !fit.is_valid(),
    }
}

fn firth_of(design: &Design, fit: &Fit) -> Option<Firth> {
    let rows = &fit.rows;
    let all: Vec<usize> = (0..rows.columns).collect();
    let maximum = firth::maximise(rows, &all, Start::Cold, EXACT);
    let mut cholesky = Cholesky::default();
    if !maximum.converged || !cholesky.factor(&maximum.information, rows.columns) {
        return None;
    }
    let inverse = cholesky.inverse();
    let errors = all
        .iter()
        .map(|&j| inverse[j * rows.columns + j].sqrt())
        .collect();
    let single = all.iter().map(|&j| test(rows, &maximum, &[j])).collect();
    let mut groups = Vec::new();
    for (g, group) in design.groups.iter().enumerate() {
        // Places of the group's columns among those that are fitted.
        let held: Vec<usize> = all
            .iter()
            .copied()
            .filter(|&k| group.columns.contains(&fit.aliases.kept[k]))
            .collect();
        if held.is_empty() || group.term == Term::Constant {
            continue;
        }
        let result = if group.term == Term::Change {
            equal_indicators(rows, &maximum, &held)
        } else {
            Some(test(rows, &maximum, &held))
        };
        groups.extend(result.map(|result| (g, result)));
    }
    let intervals = penalised_intervals(rows, &maximum);
    Some(Firth {
        maximum,
        errors,
        single,
        groups,
        intervals,
    })
}

fn test(rows: &Rows, full: &Penalised, held: &[usize]) -> PenalisedTest {
    let free: Vec<usize> = (0..rows.columns).filter(|j| !held.contains(j)).collect();
    let mut begin = full.beta.clone();
    held.iter().for_each(|&j| begin[j] = 0.0);
    let restricted = firth::maximise_held(rows, &free, &begin, EXACT);
    let ratio = (2.0 * (full.objective - restricted.objective)).max(0.0);
    PenalisedTest {
        ratio,
        df: held.len(),
        p: tails::chi_squared(ratio, held.len()).unwrap_or(1.0),
    }
}

/// Whether all indicators have one coefficient: the first takes the sum of all in its place, which leaves the penalty
/// as it is, and the others are held at 0.
fn equal_indicators(rows: &Rows, full: &Penalised, indicators: &[usize]) -> Option<PenalisedTest> {
    let (&first, others) = indicators.split_first()?;
    if others.is_empty() {
        return None;
    }
    let mut turned = rows.clone();
    for row in turned.x.chunks_exact_mut(rows.columns) {
        row[first] += others.iter().map(|&j| row[j]).sum::<f64>();
    }
    Some(test(&turned, full, others))
}
