//! Every number of the reference results in `tests/data/statistics`, made with R 4.2, brglm2, numpy and statsmodels.
#![allow(clippy::unwrap_used)]

use std::path::PathBuf;

use experiment::analysis::design::Design;
use experiment::analysis::fit::saturated;
use experiment::analysis::model::{Model, PAPER};
use experiment::analysis::regression::Regression;
use experiment::analysis::rows::Sums;
use experiment::analysis::subjects::Subjects;
use experiment::analysis::table::Table;
use experiment::analysis::{firth, json, newton, noticed};
use serde_json::Value;

const SETS: [&str; 10] = [
    "01a_uno_slater_reconstructed",
    "02_sim_table2_n18",
    "03_sim_table2_n3600",
    "05_quasi_separation",
    "06_all_zero",
    "08_one_per_cell_n12",
    "09a_aliased_vr_all_no",
    "10_missing_items",
    "12_closed_form_F_only",
    "13_endometrial",
];

/// What the reference says of itself and its makers, and what R prints of estimates that do not exist.
const WORDS: [&str; 9] = [
    "dataset",
    "description",
    "csv",
    "computed_by",
    "crosscheck",
    "ml_note",
    "delete_groups_note",
    "what_R_glm_prints",
    "definition",
];

fn data(name: &str) -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR"))
        .join("tests/data/statistics")
        .join(name)
}

fn reference(name: &str) -> Value {
    let text = std::fs::read_to_string(data(&format!("{name}.json"))).unwrap();
    serde_json::from_str(&text).unwrap()
}

/// The model with the reference's columns: the paper's, or a constant and what follows it.
fn model_of(reference: &Value) -> Model {
    let columns: Vec<&str> = reference["columns"]
        .as_array()
        .unwrap()
        .iter()
        .map(|c| c.as_str().unwrap())
        .collect();
    if columns[0] == "constant" {
        columns.join("+").replace("constant", "1")
    } else {
        PAPER.to_owned()
    }
    .parse()
    .unwrap()
}

fn regression(name: &str) -> (Value, Regression) {
    let reference = reference(name);
    let table = Table::read(&data(&format!("{name}.csv"))).unwrap();
    let design = Design::new(&Subjects::new(table).unwrap(), &model_of(&reference)).unwrap();
    (reference, Regression::new(design))
}

/// Collects where `found` is not what `expected` says.
fn compare(path: &str, expected: &Value, found: &Value, lag: f64, wrong: &mut Vec<String>) {
    match (expected, found) {
        (Value::Object(expected), found) => {
            for (key, value) in expected
                .iter()
                .filter(|(key, _)| !WORDS.contains(&key.as_str()))
            {
                match found.get(key) {
                    Some(found) => compare(&format!("{path}/{key}"), value, found, lag, wrong),
                    None => wrong.push(format!("{path}/{key}: not there")),
                }
            }
        }
        // R words its warnings otherwise; whether there is one is what counts.
        (Value::Array(expected), Value::Array(found)) if path.ends_with("/warnings") => {
            if expected.is_empty() != found.is_empty() {
                wrong.push(format!("{path}: {expected:?}, found {found:?}"));
            }
        }
        (Value::Array(expected), Value::Array(found)) => {
            if expected.len() != found.len() {
                wrong.push(format!(
                    "{path}: {} values, found {}",
                    expected.len(),
                    found.len()
                ));
            }
            for (i, (expected, found)) in expected.iter().zip(found).enumerate() {
                compare(&format!("{path}/{i}"), expected, found, lag, wrong);
            }
        }
        (Value::Number(expected), Value::Number(found)) => {
            let (expected, found) = (expected.as_f64().unwrap(), found.as_f64().unwrap());
            if !is_close(path, expected, found, lag) {
                wrong.push(format!(
                    "{path}: {expected:e}, found {found:e}, off by {:e}",
                    (found / expected - 1.0).abs()
                ));
            }
        }
        (expected, found) if expected == found => {}
        (expected, found) => wrong.push(format!("{path}: {expected}, found {found}")),
    }
}

/// How far R's standard errors are from the converged ones, relative: it takes them from the weights before its last
/// cycle. The cycle is the one at which R's criterion, with the epsilon of 1e-14 that the reference names, ends.
fn lag_of_r(regression: &Regression, reference: &Value) -> f64 {
    let Some(printed) = reference["ml"]["se"].as_array() else {
        return 0.0;
    };
    let printed: Vec<f64> = printed.iter().map(|se| se.as_f64().unwrap()).collect();
    let fit = &regression.fit;
    let cycles = newton::cycles(&fit.rows, 25);
    let kernel = |beta: &[f64]| {
        let mut sums = Sums::default();
        fit.rows.sums(beta, &mut sums);
        sums.kernel
    };
    let deviances: Vec<f64> = cycles
        .iter()
        .map(|cycle| 2.0 * (saturated(&fit.rows) - kernel(&cycle.beta)))
        .collect();
    let ended = deviances
        .windows(2)
        .position(|two| (two[1] - two[0]).abs() / (two[1].abs() + 0.1) < 1e-13)
        .unwrap()
        + 1;
    // Rounding decides about the last cycle; one of these three is R's, to the reference's digits.
    let off = |errors: &[f64]| {
        errors
            .iter()
            .zip(&printed)
            .map(|(a, b)| (a / b - 1.0).abs())
            .fold(0.0, f64::max)
    };
    let (errors, distance) = cycles[ended - 1..=ended + 1]
        .iter()
        .map(|c| (&c.errors, off(&c.errors)))
        .min_by(|a, b| a.1.total_cmp(&b.1))
        .unwrap();
    assert!(
        distance < 1e-8,
        "R's standard errors of no cycle: {distance:e}"
    );
    errors
        .iter()
        .zip(&fit.error)
        .map(|(a, b)| (a / b - 1.0).abs())
        .fold(0.0, f64::max)
}

/// 1e-8 relative, as the reference's description says, but for:
/// the residue of an iteration, which only has to be small; sums that cancel to zero, held against one answer; what R
/// takes from weights that lag by `lag`; bounds of odds, which R finds to 1e-4; profile bounds, which R interpolates by a spline (`profile_bounds_are_exact`).
fn is_close(path: &str, expected: f64, found: f64, lag: f64) -> bool {
    let has = |word: &str| path.contains(word);
    if has("max_abs_modified_score") {
        return found < 1e-8;
    }
    if has("pairwise_odds_ratio") {
        // R's `uniroot` stops 1e-4 short of the bound.
        return (found - expected).abs() <= 2e-4 * expected.abs();
    }
    if has("/ml/profile_ci95") {
        return (found - expected).abs() < 1e-3 * (1.0 + expected.abs());
    }
    let lagging = if has("/ml/p_wald") || has("quasibinomial/p") {
        // The relative change of a tail beyond z is z^2 + 1 times that of z.
        lag * (2.0 - 2.0 * expected.max(1e-320).ln())
    } else if has("/ml/se") || has("/ml/z") || has("/ml/or_") || has("quasibinomial") {
        2.0 * lag
    } else if has("leverage") {
        5.0 * lag
    } else {
        0.0
    };
    // The root of a part of the deviance that has cancelled.
    let floor = if has("deviance_residual") {
        1e-10
    } else {
        1e-12
    };
    (found - expected).abs() <= (1e-8 + lagging) * expected.abs() + floor
}

#[test]
fn every_set_agrees_with_its_reference() {
    let mut wrong = Vec::new();
    for name in SETS {
        let (reference, regression) = regression(name);
        let lag = lag_of_r(&regression, &reference);
        compare(
            name,
            &reference,
            &json::regression(&regression),
            lag,
            &mut wrong,
        );
    }
    assert!(
        wrong.is_empty(),
        "{} differ:\n{}",
        wrong.len(),
        wrong.join("\n")
    );
}

/// The loss of likelihood at each bound is the 95 % quantile of chi-squared with one degree of freedom, by a fit of its own.
#[test]
fn profile_bounds_are_exact() {
    let quantile = 3.841_458_820_694_124;
    for name in SETS {
        let (_, regression) = regression(name);
        let (fit, firth) = (&regression.fit, regression.firth.as_ref().unwrap());
        for j in 0..fit.rows.columns {
            let others: Vec<usize> = (0..fit.rows.columns).filter(|&k| k != j).collect();
            let held = |value: f64| {
                (0..fit.rows.columns)
                    .map(|k| if k == j { value } else { 0.0 })
                    .collect::<Vec<_>>()
            };
            let (likely, penalised) = (regression.intervals[j], firth.intervals[j]);
            for bound in [likely.low, likely.high]
                .into_iter()
                .filter(|bound| bound.is_finite())
            {
                let there = newton::maximise(
                    &fit.rows,
                    &others,
                    newton::Start::At(&held(bound)),
                    newton::EXACT,
                );
                let loss = 2.0 * (fit.kernel - there.sums.kernel);
                assert!(
                    (loss - quantile).abs() < 1e-8,
                    "{name}, column {j}: {loss} at {bound}"
                );
            }
            for bound in [penalised.low, penalised.high] {
                let there = firth::maximise(
                    &fit.rows,
                    &others,
                    newton::Start::At(&held(bound)),
                    newton::EXACT,
                );
                let loss = 2.0 * (firth.maximum.objective - there.objective);
                assert!(
                    (loss - quantile).abs() < 1e-8,
                    "{name}, column {j}, penalised: {loss} at {bound}"
                );
            }
        }
    }
}

/// What is infinite is bounded on one side alone, and what is not on both.
#[test]
fn profile_of_an_infinite_estimate_has_one_bound() {
    let (_, regression) = regression("13_endometrial");
    let nv = regression.intervals[1];
    assert!(nv.low.is_finite() && nv.high == f64::INFINITY, "{nv:?}");
    assert!(
        regression
            .intervals
            .iter()
            .enumerate()
            .all(|(j, i)| j == 1 || (i.low.is_finite() && i.high.is_finite()))
    );
}

/// R's `fisher.test`, `p.adjust`, `binom.test` and intervals on Table 4.
#[test]
fn noticed_agrees_with_its_reference() {
    let reference = reference("table4_noticed");
    let table = Table::read(&data("01a_uno_slater_reconstructed.csv")).unwrap();
    let subjects = Subjects::new(table).unwrap();
    let papers = noticed::Noticed::of(&subjects).unwrap();
    assert!(papers.is_papers);
    let mut found = papers.json();
    // Odds ratios are written as text with ten digits, because they may be infinite.
    let as_numbers = |value: &Value| -> Value {
        let number = |text: &Value| -> Value {
            match text.as_str().unwrap() {
                "Inf" => "Inf".into(),
                digits => digits.parse::<f64>().unwrap().into(),
            }
        };
        let pairs = value.as_object().unwrap().iter();
        pairs
            .map(|(k, v)| {
                (
                    k.clone(),
                    v.as_array().unwrap().iter().map(number).collect::<Value>(),
                )
            })
            .collect()
    };
    let odds = "pairwise_odds_ratio_conditional_mle";
    let mut expected = reference.clone();
    expected[odds] = as_numbers(&reference[odds]);
    found[odds] = as_numbers(&found[odds]);
    let mut wrong = Vec::new();
    compare("table4", &expected, &found, 0.0, &mut wrong);
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

/// What the paper prints, to its digits: Tables 5 and 6. Its change(3).E is the fourth cycle's, and the standard errors
/// are between those of the fourth cycle and the converged ones.
#[test]
fn reconstructed_study_has_the_papers_figures() {
    let (_, regression) = regression("01a_uno_slater_reconstructed");
    let fit = &regression.fit;
    assert!((fit.deviance - 12.727).abs() < 5e-4 && fit.df() == 8);
    let printed = [
        1.501, -0.9969, 0.7149, 2.112, -0.6980, -1.580, -1.496, 3.786, -3.836, -0.5273,
    ];
    let half_a_digit = [5e-4, 5e-5, 5e-5, 5e-4, 5e-5, 5e-4, 5e-4, 5e-4, 5e-4, 5e-5];
    let fourth = &newton::cycles(&fit.rows, json::PAPERS_CYCLE)[json::PAPERS_CYCLE - 1];
    for (j, (printed, half)) in printed.into_iter().zip(half_a_digit).enumerate() {
        let found = if j == 9 {
            fourth.beta[j]
        } else {
            fit.estimate[j]
        };
        assert!(
            (found - printed).abs() <= half,
            "column {j}: {printed} as {found}"
        );
    }
    assert!((fit.estimate[9] + 0.5274).abs() < 5e-5);
    let printed = [
        1.216, 1.125, 0.8994, 0.9312, 0.2461, 0.7133, 1.213, 1.440, 1.443, 1.116,
    ];
    for (j, printed) in printed.into_iter().enumerate() {
        let (early, converged) = (fourth.errors[j], fit.error[j]);
        assert!(
            early < printed && printed < converged,
            "column {j}: {early}, {printed}, {converged}"
        );
    }
}
