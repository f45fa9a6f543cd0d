//! What the answers know about each other: mirrors, motions, sweeps.

use glam::{DQuat, DVec3};
use physics::Pose;
use physics::query::Limits;

use crate::judge::built::drawn;
use crate::judge::cases::{
    self, Case, Class, KINDS, all_pairs, direction, distance_for, parametric_pairs, random_shape,
    rotation,
};
use crate::judge::verdict::angle;
use crate::support::Random;
use crate::{Wrong, answer, ask};

const SEED: u64 = 271;
/// Angle up to which two normals are the same [rad]: 1e-4 degrees.
const SAME: f64 = 1.75e-6;

#[test]
fn the_support_point_maximises() {
    let mut wrong = Wrong::default();
    let mut random = Random(59);
    for kind in KINDS.into_iter().chain(["trunc"]) {
        for _ in 0..300 {
            let known = random_shape(kind, &mut random);
            let shape = known.shape();
            let mut n = direction(&mut random);
            // Also along axes and across them, where ties are.
            let axis = random.0 as usize % 3;
            match random.0 % 5 {
                0 => n[axis] = 0.0,
                1 => n = DVec3::AXES[axis] * n[axis].signum(),
                _ => {}
            }
            let p = shape.support(n * 3.0);
            let height = known.height(n);
            wrong.unless((n.dot(p) - height).abs() < 1e-13, || {
                format!("{known:?} {n}: {p}")
            });
            wrong.unless(known.outside(p) < 1e-12, || format!("{known:?} {n}: {p}"));
            for _ in 0..10 {
                let (_, q) = crate::judge::built::surface_point(&known, &mut random);
                wrong.unless(n.dot(q) <= n.dot(p) + 1e-13, || {
                    format!("{known:?} {n}: {q} over {p}")
                });
            }
        }
    }
    wrong.end();
}

/// The same case with a and b exchanged.
fn swapped(case: &Case) -> Case {
    Case {
        a: case.b.clone(),
        pose_a: case.pose_b,
        b: case.a.clone(),
        pose_b: case.pose_a,
    }
}

/// The same case after a common rigid motion.
fn moved(case: &Case, by: Pose) -> Case {
    Case {
        a: case.a.clone(),
        pose_a: by * case.pose_a,
        b: case.b.clone(),
        pose_b: by * case.pose_b,
    }
}

#[test]
fn swapping_the_shapes_mirrors_the_answer() {
    let mut wrong = Wrong::default();
    for pair in all_pairs() {
        for class in Class::ALL {
            for index in 0..12 {
                let (case, _) = drawn(pair, class, SEED, index);
                let (here, back) = (answer(&case), answer(&swapped(&case)));
                let name = format!("{pair:?} {} {index}: {here:?} {back:?}", class.name());
                wrong.unless((here.gap - back.gap).abs() < 1e-11, || name.clone());
                wrong.unless(angle(here.normal, -back.normal) < SAME, || name.clone());
            }
        }
    }
    wrong.end();
}

/// Poses are rounded where they are moved to; what that changes is in the bounds.
fn moves_along(offset: f64, gap_bound: f64, normal_bound: f64) {
    let mut wrong = Wrong::default();
    let mut random = Random(61);
    for pair in parametric_pairs() {
        for class in Class::ALL {
            for index in 0..8 {
                let (case, _) = drawn(pair, class, SEED, index);
                let by = Pose::new(direction(&mut random) * offset, rotation(&mut random));
                let (here, there) = (answer(&case), answer(&moved(&case, by)));
                let name = format!("{pair:?} {} {index}: {here:?} {there:?}", class.name());
                wrong.unless((here.gap - there.gap).abs() < gap_bound, || name.clone());
                if class != Class::Touching {
                    let turned = by.transform_vector(here.normal);
                    wrong.unless(angle(turned, there.normal) < normal_bound, || name.clone());
                    let (p, q) = (by.transform_point(here.point_a), there.point_a);
                    let slide = (p - q).dot(turned).abs();
                    wrong.unless(slide < 10.0 * gap_bound + normal_bound, || name.clone());
                }
            }
        }
    }
    wrong.end();
}

#[test]
fn a_common_motion_moves_the_answer() {
    moves_along(10.0, 1e-11, SAME);
}

#[test]
fn ten_kilometres_away_the_answer_is_the_same() {
    moves_along(1e4, 2e-11, SAME);
}

/// A sweep of 10,000 poses through touch, moving and turning: the gap changes by no more than the motion.
#[test]
fn the_gap_is_lipschitz_through_touch() {
    let mut wrong = Wrong::default();
    const POSES: u32 = 10_000;
    for pair in all_pairs() {
        if pair.0 == "plane" {
            continue;
        }
        let mut random = cases::random(SEED, pair, Class::Touching);
        let mut case = cases::case(pair, Class::Touching, &mut random);
        let along = direction(&mut random);
        let touch = distance_for(&case, along, 0.0);
        let axis = direction(&mut random);
        let from = case.pose_b.rotation;
        let step = 0.2 / f64::from(POSES);
        let turn = 0.1 / f64::from(POSES);
        // No point of b moves farther than this from one pose to the next.
        let most = step + turn * case.b.radius();
        let mut last: Option<f64> = None;
        for i in 0..POSES {
            let t = f64::from(i) - 0.5 * f64::from(POSES);
            case.pose_b = Pose::new(
                case.pose_a.position + along * (touch - t * step),
                DQuat::from_axis_angle(axis, t * turn) * from,
            );
            let gap = answer(&case).gap;
            if let Some(last) = last {
                wrong.unless((gap - last).abs() <= most + 1e-12, || {
                    format!(
                        "{pair:?} pose {i}: from {last} to {gap}, {:.2} times the motion",
                        (gap - last).abs() / most
                    )
                });
            }
            last = Some(gap);
        }
    }
    wrong.end();
}

/// A warm start is a hint: near and touching it leads to the same answer.
#[test]
fn a_warm_start_leads_to_the_same_answer() {
    let mut wrong = Wrong::default();
    let mut random = Random(67);
    for pair in all_pairs() {
        for class in [Class::Far, Class::Near, Class::Touching] {
            for index in 0..12 {
                let (case, _) = drawn(pair, class, SEED, index);
                let cold = answer(&case);
                for off in [0.0, 1e-6, 0.02] {
                    let start = cold.normal + direction(&mut random) * off;
                    let warm = ask(&case, start.try_normalize(), Limits::default());
                    let name = format!("{pair:?} {} {index} off {off}", class.name());
                    wrong.unless((warm.gap - cold.gap).abs() < 1e-10, || {
                        format!("{name}: {cold:?} {warm:?}")
                    });
                }
            }
        }
    }
    wrong.end();
}

#[test]
fn the_closest_points_are_on_the_bodies_and_as_far_apart_as_the_gap_says() {
    let mut wrong = Wrong::default();
    for pair in all_pairs() {
        for class in Class::ALL {
            for index in 0..12 {
                let (case, _) = drawn(pair, class, SEED, index);
                let found = answer(&case);
                let name = format!("{pair:?} {} {index}: {found:?}", class.name());
                let outside = |p: DVec3, of: &crate::judge::known::Known, pose: &Pose| {
                    of.outside(pose.rotation.conjugate() * (p - pose.position))
                };
                wrong.unless(outside(found.point_a, &case.a, &case.pose_a) < 1e-9, || {
                    name.clone()
                });
                wrong.unless(outside(found.point_b, &case.b, &case.pose_b) < 1e-9, || {
                    name.clone()
                });
                if !found.capped {
                    let d = found.point_b - found.point_a;
                    let off = (d - found.normal * found.gap).length();
                    wrong.unless(off < 1e-6 * case.size(), || {
                        format!("{name}: off by {off:.1e}")
                    });
                }
            }
        }
    }
    wrong.end();
}

#[test]
fn the_same_question_has_the_same_answer() {
    let mut wrong = Wrong::default();
    for pair in all_pairs() {
        for class in Class::ALL {
            let (case, _) = drawn(pair, class, SEED, 0);
            let first = answer(&case);
            let _ = answer(&swapped(&case));
            wrong.unless(first == answer(&case), || {
                format!("{pair:?} {}", class.name())
            });
        }
    }
    wrong.end();
}
