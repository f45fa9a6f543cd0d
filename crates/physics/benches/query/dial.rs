//! The paper's dial: accuracy and time against the cap on iterations.

use std::hint::black_box;
use std::time::Instant;

use physics::query::{Limits, separation};

use crate::accuracy::SEED;
use crate::judge::built::drawn;
use crate::judge::cases::{Class, all_pairs};

/// Poses of each pair.
const POSES: usize = 40;
/// Rounds of which the table holds the median time.
const ROUNDS: usize = 9;

/// Head of the table.
pub const HEAD: &str = "\
| cap | time [ns] | median error [m] | 99 % below | worst | capped |
|--:|--:|--:|--:|--:|--:|";

/// A line of the table for each cap.
pub fn lines() -> impl Iterator<Item = String> {
    let cases: Vec<_> = all_pairs()
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
        let ask = || -> Vec<_> {
            cases
                .iter()
                .map(|(a, pose_a, b, pose_b, _)| {
                    black_box(separation((a, pose_a), (b, pose_b), None, limits))
                })
                .collect()
        };
        let mut times = [(); ROUNDS].map(|()| {
            let started = Instant::now();
            black_box(ask());
            started.elapsed().as_nanos() as f64 / cases.len() as f64
        });
        times.sort_by(f64::total_cmp);
        let (time, answers) = (times[ROUNDS / 2], ask());
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
