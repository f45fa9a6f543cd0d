//! What the analysis costs.
//!
//! Budgets on two cores, ten columns: a fit of 18 rows 50 us, of 3,600 rows 2 ms, Firth's at most five times the fit's,
//! a million rows 1 s; 10,000 randomisations of the study of 1997 1 s; the default power curve 60 s.
#![allow(missing_docs, clippy::unwrap_used)]

use std::hint::black_box;
use std::time::Duration;

use criterion::{Criterion, criterion_group, criterion_main};
use experiment::analysis::design::Design;
use experiment::analysis::firth;
use experiment::analysis::fit::Fit;
use experiment::analysis::model::Model;
use experiment::analysis::newton::{EXACT, Start};
use experiment::analysis::power::{CORRELATION, Effort, PUBLISHED, World, curve};
use experiment::analysis::randomisation::{Plan, Randomisation};
use experiment::analysis::regression::Regression;
use experiment::analysis::rows::Rows;
use experiment::analysis::subjects::Subjects;
use experiment::analysis::table::Table;
use experiment::random::SplitMix64;

fn design(name: &str) -> Design {
    let path = format!(
        "{}/tests/data/statistics/{name}.csv",
        env!("CARGO_MANIFEST_DIR")
    );
    let subjects = Subjects::new(Table::read(path.as_ref()).unwrap()).unwrap();
    Design::new(&subjects, &Model::paper()).unwrap()
}

/// A million rows with a continuous column, so that no two are alike.
fn million() -> Rows {
    let small = design("03_sim_table2_n3600").rows();
    let all: Vec<usize> = (0..small.columns).collect();
    let mut rows = small.part(&all, (0..1_000_000).map(|i| i % small.len()));
    let mut random = SplitMix64::new(1);
    rows.x
        .iter_mut()
        .skip(4)
        .step_by(small.columns)
        .for_each(|x| *x += random.uniform() - 0.5);
    rows
}

fn fits(c: &mut Criterion) {
    for (name, set) in [
        ("18 rows", "01a_uno_slater_reconstructed"),
        ("3600 rows", "03_sim_table2_n3600"),
    ] {
        let rows = design(set).rows();
        let all: Vec<usize> = (0..rows.columns).collect();
        c.bench_function(&format!("fit, {name}"), |b| {
            b.iter(|| Fit::of(black_box(&rows)))
        });
        c.bench_function(&format!("firth, {name}"), |b| {
            b.iter(|| firth::maximise(black_box(&rows), &all, Start::Cold, EXACT))
        });
    }
}

fn large(c: &mut Criterion) {
    let mut group = c.benchmark_group("large");
    group
        .sample_size(10)
        .measurement_time(Duration::from_secs(8));
    let rows = million();
    group.bench_function("fit, a million rows", |b| {
        b.iter(|| Fit::of(black_box(&rows)))
    });
    let regression = Regression::new(design("01a_uno_slater_reconstructed"));
    group.bench_function("10,000 randomisations", |b| {
        b.iter(|| {
            Randomisation::of(
                black_box(&regression),
                Plan {
                    draws: 10_000,
                    seed: 1,
                },
            )
        })
    });
    let world = World {
        coefficients: PUBLISHED,
        correlation: CORRELATION,
    };
    let effort = Effort {
        studies: 100,
        seed: 1,
    };
    group.bench_function("power curve, a tenth of the default", |b| {
        b.iter(|| {
            let sizes = [18, 36, 54, 72, 90, 108, 144, 180];
            for effect in [1.0, 0.0] {
                curve(&world.with_effect(effect), &sizes, effort, &|_| {}).unwrap();
            }
        })
    });
    group.finish();
}

criterion_group!(benches, fits, large);
criterion_main!(benches);
