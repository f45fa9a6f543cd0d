//! The detection, section 5: pairs of shapes against gaps that are known or against the best of many normals.

use glam::{DQuat, DVec3};
use physics::Pose;
use physics::query::{Limits, Separation, separation};

use super::Case;
use super::findings::{Findings, Outcome, worse};
use super::oracle::{Kind, Known, Pair};
use super::scene::{between, direction, rotation, vector};
use experiment::random::SplitMix64;

pub const CASES: &[Case] = &[
    Case {
        name: "all-pairs",
        section: "5.1",
        expected: "signed gap max s(n): known by construction, else the best of many normals",
        criterion: "21 pairs x 4 classes x 500 (overlaps 100): 1e-9, 0 wrong (parry 0-14)",
        run: all_pairs,
    },
    Case {
        name: "needles-and-plates",
        section: "5.2",
        expected: "ellipsoids 1:10 to 1:1000 apart or touching: known by construction",
        criterion: "500 each: 1e-5 of the longest axis, at most 20 normals, no NaN",
        run: needles,
    },
    Case {
        name: "coincident-centres",
        section: "5.3",
        expected: "a body in its own copy is as deep as it is narrow (analysis)",
        criterion: "centres 0 and 1e-30 m apart: 1e-5, a unit normal, the same again",
        run: coincident,
    },
    Case {
        name: "swap-and-move",
        section: "5.5",
        expected: "swapped, and moved 10 km: the same but for the sign (analysis)",
        criterion: "gap 1e-5, normal 1e-4 deg",
        run: swap_and_move,
    },
    Case {
        name: "sweep-through-touch",
        section: "5.6",
        expected: "the gap changes by no more than the motion (analysis)",
        criterion: "1e4 poses a pair: no change above the motion by 1e-9",
        run: sweep,
    },
    Case {
        name: "certificates",
        section: "5.7",
        expected: "s(n) <= gap <= distance of the points (analysis)",
        criterion: "own heights agree to 1e-12, the interval holds and is 1e-5 wide",
        run: certificates,
    },
    Case {
        name: "iteration-budget",
        section: "5.8",
        expected: "5, 10, 20 normals: the lower bound grows with the budget",
        criterion: "err(20) <= err(10) <= err(5) for every pair that is apart",
        run: budget,
    },
];

const CLASSES: [Class; 4] = [Class::Far, Class::Near, Class::Touching, Class::Deep];

/// What two shapes are to each other.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Class {
    Far,
    Near,
    Touching,
    Deep,
}

fn ask(pair: &Pair, limits: Limits) -> Separation {
    let (a, b) = (pair.a.shape(), pair.b.shape());
    separation((&a, &pair.pose_a), (&b, &pair.pose_b), None, limits)
}

/// The program's answer from a cold start.
pub fn answer(pair: &Pair) -> Separation {
    ask(pair, Limits::default())
}

/// Two random shapes of two kinds; the gap where it is known.
///
/// b is put where its point nearest along -n lies on the normal n through a's: where the gap is positive, two convex
/// bodies are then exactly so far apart.
fn drawn(kinds: (Kind, Kind), class: Class, random: &mut SplitMix64) -> (Pair, Option<f64>) {
    let (a, b) = (
        Known::random(kinds.0, random),
        Known::random(kinds.1, random),
    );
    place(a, b, class, random)
}

fn place(a: Known, b: Known, class: Class, random: &mut SplitMix64) -> (Pair, Option<f64>) {
    let tiny = 10f64.powf(between(random, -7.0, -4.0));
    let gap = match class {
        Class::Far => 1.0,
        Class::Near => 0.02,
        Class::Touching if random.uniform() < 0.5 => -tiny,
        Class::Touching => tiny,
        Class::Deep => -between(random, 0.1, 0.6),
    };
    let mut pair = Pair {
        a,
        pose_a: Pose::new(vector(random) * 3.0, rotation(random)),
        b,
        pose_b: Pose::new(DVec3::ZERO, rotation(random)),
    };
    let n = direction(random);
    let from = pair
        .pose_a
        .transform_point(pair.a.farthest(pair.pose_a.rotation.conjugate() * n));
    let to = pair.pose_b.rotation * pair.b.farthest(pair.pose_b.rotation.conjugate() * -n);
    pair.pose_b.position = from + n * gap - to;
    (pair, (gap > 0.0).then_some(gap))
}

/// All pairs of kinds, each once.
fn pairs() -> Vec<(Kind, Kind)> {
    let mut pairs = Vec::new();
    for (i, a) in Kind::ALL.into_iter().enumerate() {
        pairs.extend(Kind::ALL[i..].iter().map(|b| (a, *b)));
    }
    pairs
}

fn all_pairs() -> Outcome {
    let mut findings = Findings::new();
    let mut random = SplitMix64::new(51);
    let (mut worst, mut wrong, mut count): (f64, usize, usize) = (0.0, 0, 0);
    let mut signs = 0;
    for kinds in pairs() {
        for class in CLASSES {
            for i in 0..500 {
                let (pair, known) = drawn(kinds, class, &mut random);
                // What must be searched for takes longer: a hundred of each.
                if known.is_none() && i >= 100 {
                    continue;
                }
                let found = answer(&pair);
                let right = known.unwrap_or_else(|| pair.best_gap(found.normal));
                let off = (found.gap - right).abs() / pair.size();
                worst = worse(worst, off);
                wrong += usize::from(off > 1e-9 || found.normal.is_nan());
                signs += usize::from(right.abs() > 1e-6 && right * found.gap <= 0.0);
                count += 1;
            }
        }
    }
    findings.at_most("largest error", worst, 1e-9, "of size");
    findings.none_of("wrong", wrong, count);
    findings.none_of("with the wrong sign", signs, count);
    findings.outcome()
}

fn needles() -> Outcome {
    let mut findings = Findings::new();
    let mut random = SplitMix64::new(52);
    let (mut worst, mut most): (f64, u32) = (0.0, 0);
    let (mut wrong, mut broken, mut count) = (0, 0, 0);
    for ratio in [10.0, 100.0, 1000.0] {
        let thin = 1.0 / ratio;
        let kinds = [
            DVec3::new(thin, 1.0, thin),
            DVec3::new(1.0, thin, 1.0),
            DVec3::new(thin, 1.0, thin.sqrt()),
        ];
        for a in kinds {
            for b in kinds {
                for class in [Class::Far, Class::Near, Class::Touching] {
                    for _ in 0..500 {
                        let (a, b) = (Known::Ellipsoid(a), Known::Ellipsoid(b));
                        let (pair, known) = place(a, b, class, &mut random);
                        let Some(right) = known else { continue };
                        let found = answer(&pair);
                        count += 1;
                        let off = (found.gap - right).abs();
                        worst = worse(worst, off);
                        wrong += usize::from(off > 1e-5);
                        most = most.max(found.iterations);
                        broken += usize::from(!found.gap.is_finite());
                    }
                }
            }
        }
    }
    findings.at_most("largest error", worst, 1e-5, "of the axis");
    findings.none_of("wrong", wrong, count);
    findings.at_most("normals", f64::from(most), 20.0, "");
    findings.none_of("not finite", broken, count);
    findings.outcome()
}

fn coincident() -> Outcome {
    let mut findings = Findings::new();
    let mut random = SplitMix64::new(53);
    let (mut worst, mut odd, mut count): (f64, usize, usize) = (0.0, 0, 0);
    for kind in Kind::ALL {
        for _ in 0..100 {
            let shape = Known::random(kind, &mut random);
            let width = shape.smallest_width();
            let turn = rotation(&mut random);
            for off in [0.0, 1e-30] {
                let pair = Pair {
                    a: shape,
                    pose_a: Pose::new(DVec3::ZERO, turn),
                    b: shape,
                    pose_b: Pose::new(DVec3::X * off, turn),
                };
                let found = answer(&pair);
                count += 1;
                worst = worse(worst, (found.gap + width).abs());
                let unit = (found.normal.length() - 1.0).abs() < 1e-9;
                odd += usize::from(!unit || found != answer(&pair));
            }
        }
    }
    findings.at_most("depth off by", worst, 1e-5, "m");
    findings.none_of("without a unit normal, or another time another", odd, count);
    findings.outcome()
}

fn swap_and_move() -> Outcome {
    let mut findings = Findings::new();
    let mut random = SplitMix64::new(55);
    let (mut swapped_off, mut moved_off, mut turned): (f64, f64, f64) = (0.0, 0.0, 0.0);
    for kinds in pairs() {
        for class in CLASSES {
            for _ in 0..50 {
                let (pair, known) = drawn(kinds, class, &mut random);
                let here = answer(&pair);
                let back = answer(&pair.swapped());
                let by = Pose::new(direction(&mut random) * 1e4, rotation(&mut random));
                let there = answer(&pair.moved(by));
                swapped_off = worse(swapped_off, (here.gap - back.gap).abs());
                moved_off = worse(moved_off, (here.gap - there.gap).abs());
                // The normal of a touch rests on what is left of the gap; of an overlap there may be two as good.
                if known.is_some_and(|gap| gap > 1e-3) {
                    let there = by.rotation.conjugate() * there.normal;
                    for other in [-back.normal, there] {
                        turned = worse(turned, here.normal.cross(other).length().to_degrees());
                    }
                }
            }
        }
    }
    findings.at_most("gap swapped off by", swapped_off, 1e-5, "m");
    findings.at_most("moved", moved_off, 1e-5, "m");
    findings.at_most("normal", turned, 1e-4, "deg");
    findings.outcome()
}

fn sweep() -> Outcome {
    let mut findings = Findings::new();
    let mut random = SplitMix64::new(56);
    let mut over: f64 = f64::NEG_INFINITY;
    const POSES: u32 = 10_000;
    for kinds in pairs() {
        let (mut pair, _) = drawn(kinds, Class::Touching, &mut random);
        let (touch, from) = (pair.pose_b.position, pair.pose_b.rotation);
        let (along, axis) = (direction(&mut random), direction(&mut random));
        let (step, turn) = (0.2 / f64::from(POSES), 0.1 / f64::from(POSES));
        let most = step + turn * pair.b.radius();
        let mut last: Option<f64> = None;
        for i in 0..POSES {
            let t = f64::from(i) - 0.5 * f64::from(POSES);
            let turned = DQuat::from_axis_angle(axis, t * turn) * from;
            pair.pose_b = Pose::new(touch + along * (t * step), turned);
            let gap = answer(&pair).gap;
            if let Some(last) = last {
                over = worse(over, (gap - last).abs() - most);
            }
            last = Some(gap);
        }
    }
    findings.at_most("change less motion", over, 1e-9, "m");
    findings.outcome()
}

fn certificates() -> Outcome {
    let mut findings = Findings::new();
    let mut random = SplitMix64::new(57);
    let (mut own_off, mut width): (f64, f64) = (0.0, 0.0);
    let (mut outside, mut open, mut count) = (0, 0, 0);
    for kinds in pairs() {
        for class in CLASSES {
            for _ in 0..100 {
                let (pair, known) = drawn(kinds, class, &mut random);
                let found = answer(&pair);
                own_off = worse(own_off, (pair.gap_along(found.normal) - found.gap).abs());
                let Some(right) = known else { continue };
                count += 1;
                let Some(upper) = found.upper else {
                    open += 1;
                    continue;
                };
                outside += usize::from(found.gap > right + 1e-12 || upper < right - 1e-12);
                width = worse(width, upper - found.gap);
            }
        }
    }
    findings.at_most("own heights off by", own_off, 1e-12, "m");
    findings.none_of("intervals miss the gap", outside, count);
    findings.none_of("without an upper end", open, count);
    findings.at_most("widest", width, 1e-5, "m");
    findings.outcome()
}

fn budget() -> Outcome {
    let mut findings = Findings::new();
    let mut random = SplitMix64::new(58);
    let (mut worse_with_more, mut over, mut count) = (0, 0, 0);
    let mut worst = [0.0f64; 3];
    for kinds in pairs() {
        for class in [Class::Far, Class::Near, Class::Touching] {
            for _ in 0..200 {
                let (pair, known) = drawn(kinds, class, &mut random);
                let Some(right) = known else { continue };
                let errors = [5, 10, 20].map(|iteration_cap| {
                    let found = ask(
                        &pair,
                        Limits {
                            iteration_cap,
                            ..Limits::default()
                        },
                    );
                    over += usize::from(found.iterations > iteration_cap);
                    right - found.gap
                });
                count += 1;
                let rises = errors[1] > errors[0] + 1e-13 || errors[2] > errors[1] + 1e-13;
                worse_with_more += usize::from(rises);
                for (worst, error) in worst.iter_mut().zip(errors) {
                    *worst = worse(*worst, error);
                }
            }
        }
    }
    findings.none_of("worse with more", worse_with_more, count);
    findings.none_of("over the budget", over, 3 * count);
    findings.note(format!(
        "largest errors {:.0e}, {:.0e}, {:.0e} m",
        worst[0], worst[1], worst[2]
    ));
    findings.outcome()
}
