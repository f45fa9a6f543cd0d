//! A regression as JSON, with the names that the reference results have.

use serde_json::{Map, Value, json};

use super::newton;
use super::profile::Interval;
use super::regression::{Deletion, Firth, Regression};
use super::separation::{Kind, Reach};
use super::tails::{self, NORMAL_95};

/// What is said of infinite estimates.
const INFINITE: &str = "maximum-likelihood estimates do not exist (infinite) for the columns marked Inf; the deviance is an infimum and is valid; standard errors, Wald tests and odds ratios are not given for those columns";
/// What is said of tests under separation.
const POOR: &str = "changes in deviance are valid likelihood-ratio statistics (finite limits); their chi-squared reference is poor under separation: use Firth's penalised likelihood-ratio test";
/// What Firth's estimates are.
const FIRTH: &str = "maximises sum(y eta - n log(1 + exp eta)) + 0.5 log det(X'WX), W = n p (1 - p); errors from the inverse information at the estimate; tests keep the penalty of the full model and hold the tested coefficients at 0; the group change tests whether its indicators are equal";

/// The regression, every number of it.
pub fn regression(regression: &Regression) -> Value {
    let (design, fit) = (&regression.design, &regression.fit);
    let names = design.names(&fit.aliases.kept);
    let mut object = Map::new();
    let mut put = |key: &str, value: Value| object.insert(key.to_owned(), value);
    put("model", json!(design.model.to_string()));
    put(
        "columns",
        json!(
            design
                .columns
                .iter()
                .map(|column| &column.name)
                .collect::<Vec<_>>()
        ),
    );
    put("n_used", json!(design.used.len()));
    put("n_excluded", json!(design.excluded.len()));
    let excluded = design
        .excluded
        .iter()
        .map(|e| json!({"id": e.id, "reason": e.reason}));
    put("excluded", excluded.collect());
    put("n_parameters", json!(design.columns.len()));
    put("rank", json!(fit.rank()));
    put("aliased", json!(design.names(&fit.aliases.aliased)));
    put("separation", separation(regression, &names));
    put("ml_valid", json!(fit.is_valid()));
    if fit.is_valid() {
        put("ml", ml(regression, &names));
        put("gof", gof(regression));
        put("early_cycle", early_cycle(regression, &names));
    } else {
        put("ml_note", json!(INFINITE));
        put(
            "ml_limit",
            json!({
                "deviance_infimum": fit.deviance,
                "loglik_supremum": fit.log_likelihood(),
                "df_residual": fit.df(),
                "pearson_chi2": number(fit.pearson()),
            }),
        );
        put("finite_ml_columns", finite(regression, &names));
        put("one_sided_profile_ci95", intervals(&regression.intervals));
        put("delete_groups_note", json!(POOR));
    }
    let (nothing, rows) = (regression.null, design.used.len());
    put(
        "null",
        json!({"deviance": nothing.deviance, "df": rows - 1, "loglik": nothing.log_likelihood}),
    );
    put("lr_vs_null", against_null(regression));
    let groups = regression.deletions.iter();
    put(
        "delete_groups",
        groups
            .map(|d| (d.group.clone(), deletion(d)))
            .collect::<Map<_, _>>()
            .into(),
    );
    put(
        "fitted_mu",
        numbers(&product(&fit.probabilities(), &fit.rows.asked)),
    );
    put("leverage", numbers(&fit.leverage()));
    put("pearson_residual", numbers(&fit.pearson_residuals()));
    put("deviance_residual", numbers(&fit.deviance_residuals()));
    if let (true, Some(dispersion)) = (fit.is_valid(), regression.dispersion()) {
        put("quasibinomial", quasi(regression, dispersion));
    }
    if let Some(firth) = &regression.firth {
        put("firth", penalised(regression, firth, &names));
    }
    Value::Object(object)
}

/// A number, or null where it is none or infinite.
pub fn number(value: f64) -> Value {
    if value.is_finite() {
        json!(value)
    } else {
        Value::Null
    }
}

/// Numbers, null where they are none or infinite.
pub fn numbers(values: &[f64]) -> Value {
    values.iter().map(|&value| number(value)).collect()
}

fn product(a: &[f64], b: &[f64]) -> Vec<f64> {
    a.iter().zip(b).map(|(a, b)| a * b).collect()
}

fn intervals(intervals: &[Interval]) -> Value {
    let low: Vec<f64> = intervals.iter().map(|interval| interval.low).collect();
    let high: Vec<f64> = intervals.iter().map(|interval| interval.high).collect();
    json!({"lo": numbers(&low), "hi": numbers(&high)})
}

fn separation(regression: &Regression, names: &[String]) -> Value {
    let separation = &regression.fit.separation;
    let kind = match separation.kind {
        Kind::None => "none",
        Kind::Quasi => "quasi",
        Kind::Complete => "complete",
    };
    let word = |reach: &Reach| match reach {
        Reach::Finite => "finite",
        Reach::Plus => "+Inf",
        Reach::Minus => "-Inf",
        Reach::Either => "Inf(sign not determined)",
    };
    let columns = names.iter().zip(&separation.per_column);
    let per_column: Map<String, Value> = columns
        .map(|(name, reach)| (name.clone(), json!(word(reach))))
        .collect();
    json!({"kind": kind, "per_column": per_column})
}

fn ml(regression: &Regression, names: &[String]) -> Value {
    let fit = &regression.fit;
    let z: Vec<f64> = fit
        .estimate
        .iter()
        .zip(&fit.error)
        .map(|(b, s)| b / s)
        .collect();
    let p: Vec<f64> = z.iter().map(|z| tails::normal_both(*z)).collect();
    let odds = |errors: f64| -> Vec<f64> {
        let pairs = fit.estimate.iter().zip(&fit.error);
        pairs.map(|(b, s)| libm::exp(b + errors * s)).collect()
    };
    let log_likelihood = fit.log_likelihood();
    json!({
        "terms": names,
        "estimate": numbers(&fit.estimate),
        "se": numbers(&fit.error),
        "z": numbers(&z),
        "p_wald": numbers(&p),
        "odds_ratio": numbers(&odds(0.0)),
        "or_lo95": numbers(&odds(-NORMAL_95)),
        "or_hi95": numbers(&odds(NORMAL_95)),
        "deviance": fit.deviance,
        "df_residual": fit.df(),
        "loglik": log_likelihood,
        "aic": 2.0 * fit.rank() as f64 - 2.0 * log_likelihood,
        "pearson_chi2": fit.pearson(),
        "profile_ci95": intervals(&regression.intervals),
    })
}

fn gof(regression: &Regression) -> Value {
    let fit = &regression.fit;
    let (pearson, df) = (fit.pearson(), fit.df());
    json!({
        "deviance": fit.deviance,
        "df": df,
        "p_deviance": tails::chi_squared(fit.deviance, df),
        "pearson": pearson,
        "p_pearson": tails::chi_squared(pearson, df),
        "dispersion": regression.dispersion(),
    })
}

/// The cycle whose standard errors the paper prints.
pub const PAPERS_CYCLE: usize = 4;

fn early_cycle(regression: &Regression, names: &[String]) -> Value {
    let cycles = newton::cycles(&regression.fit.rows, PAPERS_CYCLE);
    let Some(last) = cycles.last() else {
        return Value::Null;
    };
    json!({"cycle": cycles.len(), "terms": names, "estimate": numbers(&last.beta), "se": numbers(&last.errors)})
}

fn finite(regression: &Regression, names: &[String]) -> Value {
    let fit = &regression.fit;
    let columns = names.iter().zip(fit.estimate.iter().zip(&fit.error));
    let finite = columns.filter(|(_, (estimate, _))| estimate.is_finite());
    let pairs = finite.map(|(name, (estimate, error))| {
        (name.clone(), json!([number(*estimate), number(*error)]))
    });
    Value::Object(pairs.collect())
}

fn against_null(regression: &Regression) -> Value {
    let fit = &regression.fit;
    if !regression.null.is_nested {
        return json!({"change": null, "df": null, "p": null, "note": "the model does not contain a constant"});
    }
    let (change, df) = (
        (regression.null.deviance - fit.deviance).max(0.0),
        fit.rank() - 1,
    );
    json!({"change": change, "df": df, "p": tails::chi_squared(change, df)})
}

fn deletion(deletion: &Deletion) -> Value {
    let warnings: &[&str] = if deletion.is_separated {
        &["separated without these columns: fitted probabilities are 0 or 1 in the limit"]
    } else {
        &[]
    };
    json!({
        "deleted": deletion.deleted,
        "deviance": deletion.deviance,
        "df": deletion.df,
        "change": deletion.change,
        "change_df": deletion.change_df,
        "p": deletion.p,
        "quasi_f": deletion.quasi.map(|(value, _)| value),
        "p_quasi_f": deletion.quasi.map(|(_, p)| p),
        "warnings": warnings,
    })
}

fn quasi(regression: &Regression, dispersion: f64) -> Value {
    let fit = &regression.fit;
    let df = fit.df() as f64;
    let errors: Vec<f64> = fit
        .error
        .iter()
        .map(|error| error * dispersion.sqrt())
        .collect();
    let t: Vec<f64> = fit
        .estimate
        .iter()
        .zip(&errors)
        .map(|(b, s)| b / s)
        .collect();
    let p: Vec<f64> = t.iter().map(|t| tails::student_both(*t, df)).collect();
    json!({"dispersion": dispersion, "se": numbers(&errors), "t": numbers(&t), "p": numbers(&p)})
}

fn penalised(regression: &Regression, firth: &Firth, names: &[String]) -> Value {
    let beta = &firth.maximum.beta;
    let odds: Vec<f64> = beta.iter().map(|b| libm::exp(*b)).collect();
    let score = firth
        .maximum
        .score
        .iter()
        .fold(0.0_f64, |most, s| most.max(s.abs()));
    let single = names.iter().zip(&firth.single);
    let single: Vec<Value> = single
        .map(|(name, test)| json!({"term": name, "penalised_lr": test.ratio, "p": test.p}))
        .collect();
    let groups = firth.groups.iter().map(|(g, test)| {
        let name = regression.design.groups[*g].term.group();
        (
            name,
            json!({"penalised_lr": test.ratio, "df": test.df, "p": test.p}),
        )
    });
    json!({
        "terms": names,
        "estimate": numbers(beta),
        "se": numbers(&firth.errors),
        "penalised_loglik_no_constant": firth.maximum.objective,
        "odds_ratio": numbers(&odds),
        "max_abs_modified_score": score,
        "single_term_tests": single,
        "group_tests": groups.collect::<Map<_, _>>(),
        "profile_ci95": intervals(&firth.intervals),
        "definition": FIRTH,
    })
}
