//! Small numbers of what `cargo bench -p physics --bench query -- accuracy` judges in great ones.

use physics::query::Separation;

use crate::judge::built::{drawn, rims_and_corners};
use crate::judge::cases::{self, Class, all_pairs, between, parametric_pairs};
use crate::judge::oracle::{Field, Oracle};
use crate::judge::verdict::{Verdict, angle, judge};
use crate::support::Random;
use crate::{Wrong, answer};

const SEED: u64 = 1_997;

/// Judges `poses` answers of each of the `pairs` and classes, and complains where `wrong` says why.
fn complain(
    pairs: Vec<(&'static str, &'static str)>,
    classes: &[Class],
    poses: usize,
    wrong: impl Fn(&Separation, &Verdict, f64) -> Option<&'static str>,
) {
    let oracle = Oracle::new(800, 4);
    let mut complaints = Wrong::default();
    for &pair in &pairs {
        for class in classes {
            for index in 0..poses {
                let (case, truth) = drawn(pair, *class, SEED, index);
                let found = answer(&case);
                let verdict = judge(&case, &found, truth, &oracle);
                let why = wrong(&found, &verdict, case.size());
                complaints.unless(why.is_none(), || {
                    // `cargo bench -p physics --bench query -- case PAIR CLASS INDEX SEED` shows it in full.
                    format!(
                        "{}-{} {} {index} {SEED}: {why:?}: {found:?} {verdict:?}",
                        pair.0,
                        pair.1,
                        class.name()
                    )
                });
            }
        }
    }
    complaints.end();
}

/// Whether an error is too large, or not even a number.
fn above(error: f64, bound: f64) -> bool {
    error.is_nan() || error > bound
}

#[test]
fn far_near_and_touching_answers_are_right() {
    complain(
        all_pairs(),
        &[Class::Far, Class::Near, Class::Touching],
        24,
        |_, verdict, size| {
            if above(verdict.gap_error, 1e-6 * size) {
                Some("gap")
            } else if above(verdict.normal_error, 1e-4) {
                Some("normal")
            } else {
                None
            }
        },
    );
}

#[test]
fn deep_answers_are_the_shallowest_way_out() {
    complain(
        parametric_pairs(),
        &[Class::Deep],
        24,
        |_, verdict, size| above(verdict.gap_error, 1e-4 * size).then_some("gap"),
    );
}

/// A rim that has come into a corner or an apex by a micrometre can be left at either end of an arc of normals, and s
/// hardly tells the two apart.
#[test]
fn touching_rims_edges_and_apexes_are_left_the_shortest_way() {
    let oracle = Oracle::new(800, 4);
    let mut wrong = Wrong::default();
    for pair in [
        ("cyl", "cyl"),
        ("cyl", "cone"),
        ("cyl", "box"),
        ("cone", "cone"),
        ("cone", "box"),
    ] {
        for index in 0..160 {
            let mut random = cases::random(SEED + index, pair, Class::Touching);
            let (a, b) = (
                cases::random_shape(pair.0, &mut random),
                cases::random_shape(pair.1, &mut random),
            );
            let magnitude = 10f64.powf(between(&mut random, -7.0, -4.0));
            let gap = magnitude.copysign(random.next());
            let case = rims_and_corners(a, b, gap, &mut random);
            let found = answer(&case);
            let best = if gap > 0.0 {
                gap
            } else {
                oracle.best(&case).gap
            };
            let short = (best - found.gap) / case.size();
            wrong.unless(short < 1e-9 || found.capped, || {
                format!("{pair:?} {index} {SEED}: {gap:.3e}, short by {short:.1e}: {found:?}")
            });
            let over = found.gap - case.gap_along(found.normal);
            wrong.unless(over < 1e-14, || {
                format!("{pair:?} {index} {SEED}: claims {over:.1e} more than it proves")
            });
        }
    }
    wrong.end();
}

/// Overlaps whose shallowest way out no kink and no line of centres leads to, found among 260,000 by the benchmark.
#[test]
fn deep_ellipsoids_are_left_by_the_side_that_hides() {
    let oracle = Oracle::new(1200, 5);
    let mut wrong = Wrong::default();
    for (pair, index) in [
        (("cyl", "ell"), 1304),
        (("cone", "ell"), 1717),
        (("ell", "ell"), 1674),
        (("ell", "box"), 3202),
        (("trunc", "caps"), 1869),
        (("trunc", "cone"), 3150),
        (("trunc", "cone"), 3701),
        (("trunc", "frus"), 3032),
        (("trunc", "box"), 2914),
        (("trunc", "trunc"), 310),
    ] {
        let (case, truth) = drawn(pair, Class::Deep, 20_261_122, index);
        let found = answer(&case);
        let verdict = judge(&case, &found, truth, &oracle);
        wrong.unless(verdict.gap_error < 1e-9 * case.size(), || {
            format!("{pair:?} {index}: {found:?} {verdict:?}")
        });
    }
    wrong.end();
}

/// Two polytopes of many corners may need more new normals than the cap allows; then they say so.
#[test]
fn deep_answers_of_clouds_are_the_shallowest_way_out_or_say_that_they_ended_early() {
    complain(all_pairs(), &[Class::Deep], 24, |found, verdict, size| {
        let wrong = above(verdict.gap_error, 1e-4 * size) && !found.capped;
        wrong.then_some("gap")
    });
}

/// The judge is worth as much as its own search: built cases tell.
#[test]
fn the_oracle_finds_what_was_built() {
    let oracle = Oracle::new(800, 4);
    for pair in all_pairs() {
        for index in 0..6 {
            let (case, truth) = drawn(pair, Class::Near, SEED, index);
            let best = oracle.best(&case);
            let Some((gap, normal)) = truth else { continue };
            assert!(
                (best.gap - gap).abs() < 1e-9,
                "{pair:?} {index}: {} instead of {gap}",
                best.gap
            );
            assert!(angle(best.normal, normal) < 1e-5, "{pair:?} {index}");
        }
    }
}

/// Support heights, surface points and distances of the judge are formulas of their own; they must fit together.
#[test]
fn the_judges_formulas_agree_with_each_other() {
    let mut random = Random(7);
    let kinds = cases::KINDS.into_iter().chain(["trunc", "plane"]);
    for kind in kinds {
        for _ in 0..200 {
            let shape = cases::random_shape(kind, &mut random);
            let (n, p) = crate::judge::built::surface_point(&shape, &mut random);
            assert!((n.length() - 1.0).abs() < 1e-12, "{shape:?}");
            assert!((n.dot(p) - shape.height(n)).abs() < 1e-12, "{shape:?} {n}");
            assert!(shape.outside(p) < 1e-12, "{shape:?} {p}");
            let outside = shape.outside(p + n * 0.01);
            // Over an edge the way into a shape may be several times as long.
            assert!((0.001..0.2).contains(&outside), "{shape:?}: {outside}");
        }
    }
}

/// No normal of a dense search is better than the one that a certificate already proves best.
#[test]
fn the_two_bounds_of_the_judge_meet() {
    for pair in all_pairs() {
        if pair.0 == "plane" {
            continue;
        }
        for index in 0..6 {
            let (case, _) = drawn(pair, Class::Near, SEED, 2 * index + 1);
            let found = answer(&case);
            let field = Field::new(&case);
            let climbed = field.refine(found.normal, 0.01);
            let distance = found.point_a.distance(found.point_b);
            assert!(
                climbed.gap <= distance + 1e-9,
                "{pair:?} {index}: {} over {distance}",
                climbed.gap
            );
        }
    }
}

/// The search that judges overlaps is worth as much as a far denser one.
#[test]
fn a_denser_search_finds_nothing_deeper() {
    let (quick, dense) = (Oracle::new(800, 4), Oracle::new(8000, 12));
    let mut wrong = Wrong::default();
    for pair in all_pairs() {
        for index in 0..4 {
            let (case, _) = drawn(pair, Class::Deep, SEED, index);
            let (found, best) = (quick.best(&case), dense.best(&case));
            wrong.unless(found.gap > best.gap - 1e-6 * case.size(), || {
                format!("{pair:?} {index}: {found:?} instead of {best:?}")
            });
        }
    }
    wrong.end();
}
