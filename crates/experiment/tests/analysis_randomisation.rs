//! The randomisation tests against the reference's, and against what is true of any randomisation test.
#![allow(clippy::unwrap_used)]

use std::path::PathBuf;

use experiment::analysis::design::Design;
use experiment::analysis::model::{Model, PAPER};
use experiment::analysis::randomisation::{Plan, Randomisation};
use experiment::analysis::regression::Regression;
use experiment::analysis::subjects::Subjects;
use experiment::analysis::table::Table;
use experiment::random::SplitMix64;
use serde_json::Value;

fn data(name: &str) -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR"))
        .join("tests/data/statistics")
        .join(name)
}

fn regression(text: &str, model: &str) -> Regression {
    let subjects = Subjects::new(Table::parse("test", text).unwrap()).unwrap();
    Regression::new(Design::new(&subjects, &model.parse::<Model>().unwrap()).unwrap())
}

/// 10,000 draws on either side: a difference beyond four standard errors of it is none of chance.
#[test]
fn reconstructed_study_agrees_with_the_reference() {
    let text = std::fs::read_to_string(data("reanalysis_randomisation.json")).unwrap();
    let reference: Value = serde_json::from_str(&text).unwrap();
    let expected = &reference["01a"];
    let text = std::fs::read_to_string(data("01a_uno_slater_reconstructed.csv")).unwrap();
    let found = Randomisation::of(
        &regression(&text, PAPER),
        Plan {
            draws: 10_000,
            seed: 7,
        },
    )
    .unwrap();
    assert!(!found.is_exact && found.tried == 10_000 && found.possible > 1e12 && found.blocks == 1);
    let close = |name: &str, p: f64, found: f64| {
        let error = (2.0 * p * (1.0 - p) / 10_000.0).sqrt();
        assert!(
            (p - found).abs() < 4.0 * error,
            "{name}: {p}, found {found}"
        );
    };
    for test in &found.tests {
        let expected = &expected[&test.name];
        assert_eq!(
            test.df as u64,
            expected["df"].as_u64().unwrap(),
            "{}",
            test.name
        );
        let ratio = expected["LR"].as_f64().unwrap();
        assert!(
            (test.ratio - ratio).abs() < 1e-6,
            "{}: {ratio}, found {}",
            test.name,
            test.ratio
        );
        close(
            &test.name,
            expected["p_randomisation"].as_f64().unwrap(),
            test.p,
        );
    }
    assert_eq!(found.tests.len(), 5);
    close(
        "goodness of fit",
        expected["gof_p_parametric_bootstrap"].as_f64().unwrap(),
        found.goodness_of_fit.unwrap(),
    );
}

#[test]
fn same_seed_gives_the_same_probabilities() {
    let text = std::fs::read_to_string(data("02_sim_table2_n18.csv")).unwrap();
    let regression = regression(&text, PAPER);
    let p = |seed| Randomisation::of(&regression, Plan { draws: 300, seed }).unwrap();
    assert_eq!(p(3), p(3));
    assert_ne!(p(3).tests, p(4).tests);
}

/// Six subjects, three at each level: 20 allocations, of which two separate high from low as the observed one does.
#[test]
fn few_subjects_are_tested_exactly() {
    let text = "F,y,n\n0,0,6\n0,1,6\n0,2,6\n1,4,6\n1,5,6\n1,6,6\n";
    let found = Randomisation::of(
        &regression(text, "1 + F"),
        Plan {
            draws: 1_000,
            seed: 1,
        },
    )
    .unwrap();
    assert!(found.is_exact);
    assert_eq!((found.tried, found.possible), (20, 20.0));
    assert!((found.tests[0].p - 0.1).abs() < 1e-12, "{:?}", found.tests);
}

/// In blocks of two, four subjects have four allocations instead of six.
#[test]
fn subjects_stay_in_their_block() {
    let text = "block,F,y,n\n1,0,1,6\n1,1,5,6\n2,1,3,6\n2,0,2,6\n";
    let found = Randomisation::of(
        &regression(text, "1 + F"),
        Plan {
            draws: 1_000,
            seed: 1,
        },
    )
    .unwrap();
    assert_eq!((found.tried, found.blocks), (4, 2));
}

#[test]
fn model_without_design_has_nothing_to_re_allocate() {
    let text = "sick,y,n\n1,1,6\n2,5,6\n3,3,6\n7,2,6\n";
    assert_eq!(
        Randomisation::of(&regression(text, "1 + sick"), Plan { draws: 10, seed: 1 }),
        None
    );
}

/// Labels drawn without regard to the answers: the probabilities are uniform (Kolmogorov and Smirnov's distance).
#[test]
fn probabilities_of_permuted_labels_are_uniform() {
    let seed = 20_260;
    println!("seed {seed}");
    let mut random = SplitMix64::new(seed);
    let studies = 400;
    let mut p: Vec<f64> = (0..studies)
        .map(|study| {
            let mut levels = [0, 0, 0, 0, 0, 0, 0, 1, 1, 1, 1, 1, 1, 1];
            random.shuffle(&mut levels);
            // Sickness makes every allocation's statistic another one, so that there are no ties.
            let mut row =
                |level: &i32| format!("{level},{},{},6\n", random.below(7) + 1, random.below(7));
            let rows: String = levels.iter().map(&mut row).collect();
            let regression = regression(&format!("F,sick,y,n\n{rows}"), "1 + F + sick");
            Randomisation::of(
                &regression,
                Plan {
                    draws: 199,
                    seed: study,
                },
            )
            .unwrap()
            .tests[0]
                .p
        })
        .collect();
    p.sort_by(f64::total_cmp);
    let distance = p
        .iter()
        .enumerate()
        .map(|(i, p)| (p - (i as f64 + 0.5) / studies as f64).abs())
        .fold(0.0, f64::max);
    // 1.63 / sqrt(400) is exceeded once in a hundred; probabilities come in steps of 1 / 200.
    assert!(distance < 0.0815 + 0.005, "{distance}");
}
