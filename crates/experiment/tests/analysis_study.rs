//! A simulated study in, its analysis out: the coefficients put into the answers come back.
#![allow(clippy::unwrap_used)]

use std::fmt::Write;
use std::path::Path;

use experiment::analysis::model::Model;
use experiment::analysis::power::{COLUMNS, PUBLISHED};
use experiment::analysis::randomisation::Plan;
use experiment::analysis::study::Analysis;
use experiment::plan::{Scheme, allocate, allocation_csv};
use experiment::random::SplitMix64;

/// Writes a study's folder with answers drawn from `truth`, item by item.
fn simulate(folder: &Path, subjects: u32, truth: &[f64; 10], seed: u64) {
    let design = Scheme::Table2.design().unwrap();
    let rows = allocate(&design, subjects, seed);
    let mut random = SplitMix64::new(seed);
    let mut participants = "participant_id\tslot\tvr_before\tstatus\n".to_owned();
    let mut presence =
        "participant_id\tsession_id\tq1\tq2\tq3\tq4\tq5\tq6\tsick\tnoticed\tnoticed_what\n"
            .to_owned();
    for row in &rows {
        let level = |i: usize| f64::from(row.low.0[i]);
        let (sick, vr) = (1 + random.below(7), random.below(2));
        let is = |name: &str| f64::from(u8::from(row.changed == name));
        let (elasticity, friction, shape) = (is("elasticity"), is("friction"), is("shape"));
        let x = [
            elasticity,
            friction,
            shape,
            level(1),
            sick as f64,
            vr as f64,
            elasticity * level(2),
            friction * level(2),
            friction * level(0),
            shape * level(0),
        ];
        let eta: f64 = x.iter().zip(truth).map(|(x, b)| x * b).sum();
        let p = 1.0 / (1.0 + (-eta).exp());
        let id = format!("sub-{:05}", 7 * row.slot);
        let answered = if vr == 1 { "yes" } else { "no" };
        writeln!(participants, "{id}\t{}\t{answered}\tcomplete", row.slot).unwrap();
        write!(presence, "{id}\tses-01").unwrap();
        for _ in 0..6 {
            let answer = if random.uniform() < p {
                6 + random.below(2)
            } else {
                1 + random.below(5)
            };
            write!(presence, "\t{answer}").unwrap();
        }
        let noticed = if row.changed == "friction" {
            "yes\tthe floor"
        } else {
            "no\tn/a"
        };
        writeln!(presence, "\t{sick}\t{noticed}").unwrap();
    }
    for (name, text) in [
        ("data/participants.tsv", participants),
        ("data/phenotype/presence.tsv", presence),
        ("plan/allocation.csv", allocation_csv(&design, &rows)),
    ] {
        let path = folder.join(name);
        std::fs::create_dir_all(path.parent().unwrap()).unwrap();
        std::fs::write(path, text).unwrap();
    }
}

#[test]
fn coefficients_put_into_a_study_come_back() {
    let folder = tempfile::tempdir().unwrap();
    let seed = 1997;
    println!("seed {seed}");
    simulate(folder.path(), 1_800, &PUBLISHED, seed);
    let analysis = Analysis::of(folder.path(), &Model::paper(), Plan { draws: 100, seed }).unwrap();
    let fit = &analysis.regression.fit;
    assert!(fit.is_valid() && analysis.regression.design.used.len() == 1_800);
    assert_eq!(analysis.regression.design.names(&fit.aliases.kept), COLUMNS);
    for ((found, error), truth) in fit.estimate.iter().zip(&fit.error).zip(PUBLISHED) {
        assert!(
            (found - truth).abs() < 4.0 * error,
            "{truth}: {found} +- {error}"
        );
    }
    // Answers were independent: the dispersion is 1 within four standard errors of Pearson's chi-squared.
    let dispersion = analysis.regression.dispersion().unwrap();
    assert!(
        (dispersion - 1.0).abs() < 4.0 * (2.0 / 1_790.0_f64).sqrt() * 1.5,
        "{dispersion}"
    );
    let noticed = analysis.noticed.as_ref().unwrap();
    assert_eq!(noticed.rows, [(0, [600, 0]), (1, [0, 600]), (2, [600, 0])]);
    assert_eq!(noticed.said.len(), 600);
    // Blocks of 18, as the plan drew them.
    let randomisation = analysis.randomisation.as_ref().unwrap();
    assert_eq!(randomisation.blocks, 100);
    assert!(
        randomisation.tests.iter().all(|test| test.p < 0.02),
        "{:?}",
        randomisation.tests
    );
    assert_eq!(analysis.sickness().iter().sum::<usize>(), 1_800);
}
