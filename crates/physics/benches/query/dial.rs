//! The paper's dial: accuracy and time against the cap on iterations.

use std::hint::black_box;
use std::time::Instant;

use physics::query::{Limits, separation};
use physics::{Pose, Shape};

use crate::accuracy::SEED;
use crate::judge::built::drawn;
use crate::judge::cases::{Class, parametric_pairs};

/// Poses of each pair.
const POSES: usize = 40;
/// Rounds of which the table holds the median time.
const ROUNDS: usize = 9;
/// Poses of which the time is taken together.
const BATCH: usize = 25;

/// Two placed shapes and their true gap.
type Trial = (Shape, Pose, Shape, Pose, f64);

/// Head of the table.
pub const HEAD: &str = "\
| cap | time [ns] | median error [m] | 99 % below | worst | capped |
|--:|--:|--:|--:|--:|--:|";

/// A line of the table for each cap.
pub fn lines() -> impl Iterator<Item = String> {
    let cases: Vec<Trial> = parametric_pairs()
        .into_iter()
        .filter(|pair| pair.0 != "plane" && pair.0 != "ball")
        // Every other near case is built, and its truth known.
        .flat_map(|pair| (0..POSES).map(move |index| drawn(pair, Class::Near, SEED, 2 * index)))
        .filter_map(|(case, truth)| {
            let (gap, _) = truth?;
            Some((
                case.a.shape(),
                case.pose_a,
                case.b.shape(),
                case.pose_b,
                gap,
            ))
        })
        .collect();
    [1, 2, 3, 5, 7, 10, 15, 20].into_iter().map(move |cap| {
        let limits = Limits {
            iteration_cap: cap,
            ..Limits::default()
        };
        let ask = |(a, pose_a, b, pose_b, _): &Trial| {
            black_box(separation((a, pose_a), (b, pose_b), None, limits))
        };
        // Batches, of each the median over the rounds: another process seldom falls into most of a batch's.
        let time = cases.chunks(BATCH).map(|batch| {
            let mut times = [(); ROUNDS].map(|()| {
                let started = Instant::now();
                for case in batch {
                    ask(case);
                }
                started.elapsed().as_nanos() as f64
            });
            times.sort_by(f64::total_cmp);
            times[ROUNDS / 2]
        });
        let time = time.sum::<f64>() / cases.len() as f64;
        let answers: Vec<_> = cases.iter().map(ask).collect();
        let mut errors: Vec<f64> = answers
            .iter()
            .zip(&cases)
            .map(|(answer, case)| (case.4 - answer.gap).abs())
            .collect();
        errors.sort_by(f64::total_cmp);
        let share = |p: f64| errors[((errors.len() - 1) as f64 * p) as usize];
        let capped = answers.iter().filter(|answer| answer.capped).count();
        format!(
            "| {cap} | {time:.0} | {:.1e} | {:.1e} | {:.1e} | {:.1} % |",
            share(0.5),
            share(0.99),
            share(1.0),
            100.0 * capped as f64 / answers.len() as f64,
        )
    })
}
