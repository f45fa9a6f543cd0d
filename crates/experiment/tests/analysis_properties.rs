//! What holds of any fit, whatever the data.
#![allow(clippy::unwrap_used)]

use experiment::analysis::design::Design;
use experiment::analysis::firth;
use experiment::analysis::fit::Fit;
use experiment::analysis::model::{Model, PAPER};
use experiment::analysis::newton::{EXACT, Start};
use experiment::analysis::rows::Rows;
use experiment::analysis::separation::Kind;
use experiment::analysis::subjects::Subjects;
use experiment::analysis::table::Table;
use experiment::random::SplitMix64;

fn rows(model: &str) -> Rows {
    let path = concat!(
        env!("CARGO_MANIFEST_DIR"),
        "/tests/data/statistics/02_sim_table2_n18.csv"
    );
    let subjects = Subjects::new(Table::read(path.as_ref()).unwrap()).unwrap();
    Design::new(&subjects, &model.parse::<Model>().unwrap())
        .unwrap()
        .rows()
}

fn assert_close(a: &[f64], b: &[f64], share: f64) {
    assert_eq!(a.len(), b.len());
    assert!(
        a.iter()
            .zip(b)
            .all(|(a, b)| (a - b).abs() <= share * b.abs().max(1e-3)),
        "{a:?}\n{b:?}"
    );
}

fn penalised(rows: &Rows) -> Vec<f64> {
    firth::maximise(
        rows,
        &(0..rows.columns).collect::<Vec<_>>(),
        Start::Cold,
        EXACT,
    )
    .beta
}

#[test]
fn order_of_rows_does_not_matter() {
    let rows = rows(PAPER);
    let all: Vec<usize> = (0..rows.columns).collect();
    let (fit, firth) = (Fit::of(&rows), penalised(&rows));
    for seed in 0..20 {
        let mut order: Vec<usize> = (0..rows.len()).collect();
        SplitMix64::new(seed).shuffle(&mut order);
        let shuffled = rows.part(&all, order.into_iter());
        let found = Fit::of(&shuffled);
        assert_close(&found.estimate, &fit.estimate, 1e-10);
        assert_close(&found.error, &fit.error, 1e-9);
        assert_close(&penalised(&shuffled), &firth, 1e-9);
    }
}

#[test]
fn order_of_columns_does_not_matter() {
    let rows = rows(PAPER);
    let (fit, firth) = (Fit::of(&rows), penalised(&rows));
    for seed in 0..20 {
        let mut order: Vec<usize> = (0..rows.columns).collect();
        SplitMix64::new(seed).shuffle(&mut order);
        let shuffled = rows.with_columns(&order);
        let pick = |values: &[f64]| order.iter().map(|&j| values[j]).collect::<Vec<f64>>();
        let found = Fit::of(&shuffled);
        assert_close(&found.estimate, &pick(&fit.estimate), 1e-10);
        assert_close(&found.error, &pick(&fit.error), 1e-9);
        assert_close(&penalised(&shuffled), &pick(&firth), 1e-9);
    }
    let other: Model = "E:change + vr + change:S + sick + change + F"
        .parse()
        .unwrap();
    assert!(other.is_paper());
    assert!((Fit::of(&self::rows(&other.to_string())).deviance - fit.deviance).abs() < 1e-11);
}

#[test]
fn scaling_a_column_scales_its_estimate() {
    let rows = rows(PAPER);
    let (fit, firth) = (Fit::of(&rows), penalised(&rows));
    for (j, factor) in [(4, 1e-6), (4, 1e7), (0, -3.0), (9, 250.0)] {
        let mut scaled = rows.clone();
        scaled
            .x
            .iter_mut()
            .skip(j)
            .step_by(rows.columns)
            .for_each(|x| *x *= factor);
        let found = Fit::of(&scaled);
        let back = |values: &[f64], factor: f64| {
            let mut values = values.to_vec();
            values[j] *= factor;
            values
        };
        assert_close(&back(&found.estimate, factor), &fit.estimate, 1e-9);
        assert_close(&back(&found.error, factor.abs()), &fit.error, 1e-9);
        assert!((found.deviance - fit.deviance).abs() < 1e-11);
        assert_close(&back(&penalised(&scaled), factor), &firth, 1e-8);
    }
}

#[test]
fn doubling_the_data_halves_variances() {
    let rows = rows(PAPER);
    let fit = Fit::of(&rows);
    let all: Vec<usize> = (0..rows.columns).collect();
    let twice = Fit::of(&rows.part(&all, (0..rows.len()).chain(0..rows.len())));
    assert_close(&twice.estimate, &fit.estimate, 1e-10);
    let half: Vec<f64> = fit
        .error
        .iter()
        .map(|error| error / 2.0_f64.sqrt())
        .collect();
    assert_close(&twice.error, &half, 1e-10);
    assert!((twice.deviance - 2.0 * fit.deviance).abs() < 1e-10);
}

/// 100,000 subjects with answers drawn from known coefficients.
#[test]
fn many_subjects_bring_the_coefficients_back() {
    let truth = [0.8, -1.2, 0.4, 1.5, -0.5, -0.9, 0.3, 1.1, -1.4, 0.2];
    let small = rows(PAPER);
    let all: Vec<usize> = (0..small.columns).collect();
    let seed = 4711;
    println!("seed {seed}");
    let mut random = SplitMix64::new(seed);
    let mut many = small.part(&all, (0..100_000).map(|i| i % small.len()));
    for i in 0..many.len() {
        many.x[i * small.columns + 4] = 1.0 + random.below(7) as f64;
        many.x[i * small.columns + 5] = random.below(2) as f64;
        let eta: f64 = many.row(i).iter().zip(truth).map(|(x, b)| x * b).sum();
        let p = 1.0 / (1.0 + (-eta).exp());
        many.high[i] = (0..6).filter(|_| random.uniform() < p).count() as f64;
    }
    let fit = Fit::of(&many);
    assert!(fit.is_valid());
    for ((found, error), truth) in fit.estimate.iter().zip(&fit.error).zip(truth) {
        assert!(
            (found - truth).abs() < 4.0 * error,
            "{truth}: {found} +- {error}"
        );
    }
    // The penalty is nothing beside so many answers.
    for ((a, b), error) in penalised(&many).iter().zip(&fit.estimate).zip(&fit.error) {
        assert!((a - b).abs() < 0.05 * error);
    }
}

/// Fewer rows than columns: what cannot be told apart is named, the rest is fitted exactly.
#[test]
fn fewer_rows_than_columns_leave_aliases() {
    let rows = rows(PAPER);
    let few = rows.part(&(0..rows.columns).collect::<Vec<_>>(), 0..6);
    let fit = Fit::of(&few);
    assert!(fit.rank() <= 6 && fit.rank() + fit.aliases.aliased.len() == 10);
    assert!(fit.deviance.abs() < 1e-8 || fit.separation.kind != Kind::None || fit.df() > 0);
    assert_eq!(fit.df(), 6 - fit.rank());
}

/// Random small data sets: the linear programme's verdict against what the likelihood does.
#[test]
fn separation_is_where_the_estimates_run_away() {
    let mut kinds = [0; 3];
    for seed in 0..2_000 {
        let mut random = SplitMix64::new(seed);
        let many = 6 + random.below(10) as usize;
        let mut rows = Rows {
            columns: 3,
            ..Rows::default()
        };
        for _ in 0..many {
            rows.x
                .extend([1.0, random.below(4) as f64, random.below(2) as f64]);
            rows.asked.push(1.0 + random.below(2) as f64);
            rows.high
                .push(random.below(*rows.asked.last().unwrap() as u64 + 1) as f64);
        }
        let fit = Fit::of(&rows);
        kinds[fit.separation.kind as usize] += 1;
        // Twenty plain cycles: a finite maximum is reached, an infinite one is not.
        let cycles = experiment::analysis::newton::cycles(&fit.rows, 20);
        let last = cycles.last().unwrap();
        let farthest = last
            .errors
            .iter()
            .fold(0.0_f64, |most, error| most.max(*error));
        let runs_away = farthest > 100.0 || cycles.len() < 20;
        assert_eq!(
            fit.separation.kind != Kind::None,
            runs_away,
            "seed {seed}: {:?}",
            fit.separation
        );
    }
    assert!(kinds.iter().all(|count| *count > 20), "{kinds:?}");
}
