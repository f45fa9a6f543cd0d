//! What an answer claims of itself: its interval, its budget, its certificates.

use physics::query::{Limits, apart};

use crate::judge::built::{drawn, surface_point};
use crate::judge::cases::{Class, all_pairs};
use crate::judge::oracle::Oracle;
use crate::judge::verdict::judge;
use crate::support::Random;
use crate::{Wrong, answer, ask};

const SEED: u64 = 419;

#[test]
fn every_interval_holds_at_every_cap() {
    let mut wrong = Wrong::default();
    let oracle = Oracle::new(600, 4);
    for pair in all_pairs() {
        for class in Class::ALL {
            for index in 0..6 {
                let (case, truth) = drawn(pair, class, SEED, index);
                for iteration_cap in [1, 2, 3, 5, 8, 20] {
                    let limits = Limits {
                        iteration_cap,
                        ..Limits::default()
                    };
                    let found = ask(&case, None, limits);
                    let verdict = judge(&case, &found, truth, &oracle);
                    let name = format!("{pair:?} {} {index} cap {iteration_cap}", class.name());
                    wrong.unless(verdict.outside == 0.0, || {
                        format!(
                            "{name}: {found:?} misses {:?} by {:.1e}",
                            verdict.truth, verdict.outside
                        )
                    });
                    wrong.unless(found.iterations <= iteration_cap, || {
                        format!("{name}: {found:?}")
                    });
                    wrong.unless((found.normal.length() - 1.0).abs() < 1e-12, || {
                        format!("{name}: {found:?}")
                    });
                }
            }
        }
    }
    wrong.end();
}

#[test]
fn a_converged_interval_is_narrow() {
    let mut wrong = Wrong::default();
    for pair in all_pairs() {
        for class in [Class::Far, Class::Near, Class::Touching] {
            for index in 0..20 {
                let (case, _) = drawn(pair, class, SEED, index);
                let found = answer(&case);
                if found.capped || found.gap <= 0.0 {
                    continue;
                }
                let name = format!("{pair:?} {} {index}: {found:?}", class.name());
                let upper = found.upper.expect(&name);
                wrong.unless(upper - found.gap <= 1e-7 * case.size(), || name.clone());
            }
        }
    }
    wrong.end();
}

#[test]
fn an_overlap_searched_from_one_start_alone_says_so() {
    let mut wrong = Wrong::default();
    for pair in [("ell", "ell"), ("cyl", "cone"), ("frus", "box")] {
        for index in 0..20 {
            let (case, _) = drawn(pair, Class::Deep, SEED, index);
            let cold = answer(&case);
            let warm = ask(&case, Some(cold.normal), Limits::default());
            let name = format!("{pair:?} {index}: {cold:?} {warm:?}");
            wrong.unless(!cold.local && (warm.local || warm.gap > 0.0), || name);
        }
        let (near, _) = drawn(pair, Class::Near, SEED, 0);
        let warm = ask(&near, Some(answer(&near).normal), Limits::default());
        wrong.unless(!warm.local, || format!("{pair:?}: {warm:?}"));
    }
    wrong.end();
}

#[test]
fn the_lower_bound_grows_with_the_cap() {
    let mut wrong = Wrong::default();
    let mut capped = 0;
    for pair in all_pairs() {
        for class in [Class::Near, Class::Touching, Class::Deep] {
            for index in 0..6 {
                let (case, _) = drawn(pair, class, SEED, index);
                let mut last = f64::NEG_INFINITY;
                for iteration_cap in [1, 2, 3, 5, 7, 10, 14, 20, 40] {
                    let limits = Limits {
                        iteration_cap,
                        ..Limits::default()
                    };
                    let found = ask(&case, None, limits);
                    wrong.unless(found.gap >= last - 1e-14, || {
                        format!(
                            "{pair:?} {} {index} cap {iteration_cap}: {} after {last}",
                            class.name(),
                            found.gap
                        )
                    });
                    last = found.gap;
                    capped += u32::from(found.capped);
                }
            }
        }
    }
    wrong.unless(capped > 100, || {
        format!("one or two iterations are not enough for many: {capped}")
    });
    wrong.end();
}

#[test]
fn a_coarse_tolerance_costs_less_and_is_kept() {
    let mut wrong = Wrong::default();
    let (mut coarse_work, mut fine_work) = (0, 0);
    for pair in all_pairs() {
        for index in 0..10 {
            let (case, truth) = drawn(pair, Class::Near, SEED, 2 * index);
            let Some((gap, _)) = truth else { continue };
            let limits = Limits {
                tolerance: 1e-4,
                ..Limits::default()
            };
            let coarse = ask(&case, None, limits);
            let name = format!("{pair:?} {index}: {coarse:?}");
            wrong.unless(coarse.gap <= gap + 1e-12, || name.clone());
            if !coarse.capped {
                wrong.unless(coarse.gap >= gap - 1e-3, || name.clone());
            }
            coarse_work += coarse.iterations;
            fine_work += answer(&case).iterations;
        }
    }
    wrong.unless(coarse_work < fine_work, || {
        format!("{coarse_work} iterations instead of {fine_work}")
    });
    wrong.end();
}

#[test]
fn a_gap_that_is_enough_is_not_refined() {
    let mut wrong = Wrong::default();
    let (mut early, mut exact) = (0, 0);
    for pair in all_pairs() {
        for index in 0..10 {
            let (case, truth) = drawn(pair, Class::Near, SEED, 2 * index);
            let Some((gap, _)) = truth else { continue };
            let limits = Limits {
                enough: 0.5 * gap,
                ..Limits::default()
            };
            let found = ask(&case, None, limits);
            let name = format!("{pair:?} {index}: {found:?}");
            wrong.unless(found.capped || found.gap > limits.enough, || name.clone());
            wrong.unless(found.gap <= gap + 1e-12, || name.clone());
            early += found.iterations;
            exact += answer(&case).iterations;
        }
    }
    wrong.unless(early < exact, || {
        format!("{early} iterations instead of {exact}")
    });
    wrong.end();
}

/// Planes are checked by hand: random points of both bodies lie on their sides of them.
#[test]
fn every_certificate_holds_by_brute_force() {
    let mut wrong = Wrong::default();
    let mut random = Random(53);
    for pair in all_pairs() {
        for class in Class::ALL {
            for index in 0..8 {
                let (case, truth) = drawn(pair, class, SEED, index);
                let (a, b) = (case.a.shape(), case.b.shape());
                let (a, b) = ((&a, &case.pose_a), (&b, &case.pose_b));
                let proof = apart(a, b, None, Limits::default());
                let name = format!("{pair:?} {} {index}: {proof:?}", class.name());
                let known_apart = truth.is_some_and(|(gap, _)| gap > 0.0);
                wrong.unless(proof.is_some() || !known_apart, || name.clone());
                wrong.unless(proof.is_none() || class != Class::Deep, || name.clone());
                let Some(proof) = proof else { continue };
                wrong.unless(proof.gap_at_least > 0.0, || name.clone());
                wrong.unless((proof.normal.length() - 1.0).abs() < 1e-12, || name.clone());
                let mut farthest_a = f64::NEG_INFINITY;
                let mut nearest_b = f64::INFINITY;
                for _ in 0..200 {
                    let p = case
                        .pose_a
                        .transform_point(surface_point(&case.a, &mut random).1);
                    let q = case
                        .pose_b
                        .transform_point(surface_point(&case.b, &mut random).1);
                    farthest_a = farthest_a.max(proof.normal.dot(p));
                    nearest_b = nearest_b.min(proof.normal.dot(q));
                    wrong.unless(p.distance(q) >= proof.gap_at_least - 1e-13, || name.clone());
                }
                wrong.unless(nearest_b - farthest_a >= proof.gap_at_least - 1e-13, || {
                    name.clone()
                });
                let own = case.gap_along(proof.normal);
                wrong.unless(proof.gap_at_least <= own + 1e-13, || {
                    format!("{name}: {own}")
                });
            }
        }
    }
    wrong.end();
}

#[test]
fn the_question_apart_costs_less_than_the_gap() {
    let mut wrong = Wrong::default();
    let (mut asked, mut measured) = (0, 0);
    for pair in all_pairs() {
        for index in 0..10 {
            let (case, _) = drawn(pair, Class::Near, SEED, index);
            let (a, b) = (case.a.shape(), case.b.shape());
            let (a, b) = ((&a, &case.pose_a), (&b, &case.pose_b));
            asked += apart(a, b, None, Limits::default()).map_or(20, |proof| proof.iterations);
            measured += answer(&case).iterations;
        }
    }
    wrong.unless(2 * asked < measured, || {
        format!("{asked} instead of {measured} iterations")
    });
    wrong.end();
}
