//! Bodies with one centre: no line of centres, and ties everywhere.

use glam::{DQuat, DVec3};
use physics::Pose;

use crate::judge::cases::{Case, KINDS, random_shape, rotation};
use crate::judge::known::Known;
use crate::judge::oracle::Oracle;
use crate::judge::verdict::judge;
use crate::support::Random;
use crate::{Wrong, answer};

/// Depth of a shape in its own copy at the same place: its smallest width.
fn smallest_width(shape: &Known) -> f64 {
    match *shape {
        Known::Sphere(r) | Known::Capsule(r, _) => 2.0 * r,
        Known::Ellipsoid(a) => 2.0 * a.min_element(),
        Known::Cuboid(h) => 2.0 * h.min_element(),
        Known::Frustum(bottom, top, h) if bottom == top => 2.0 * bottom.min(h),
        _ => {
            let case = identical(shape.clone(), DVec3::ZERO, DQuat::IDENTITY);
            -Oracle::new(20_000, 12).best(&case).gap
        }
    }
}

fn identical(shape: Known, offset: DVec3, rotation: DQuat) -> Case {
    Case {
        a: shape.clone(),
        pose_a: Pose::new(DVec3::ZERO, rotation),
        b: shape,
        pose_b: Pose::new(offset, rotation),
    }
}

#[test]
fn a_body_in_its_own_copy_is_as_deep_as_it_is_wide() {
    let mut wrong = Wrong::default();
    let mut random = Random(71);
    for kind in KINDS[..7].iter().copied() {
        for _ in 0..3 {
            let shape = random_shape(kind, &mut random);
            let width = smallest_width(&shape);
            let turn = rotation(&mut random);
            for (offset, turn) in [
                (0.0, DQuat::IDENTITY),
                (1e-30, DQuat::IDENTITY),
                (1e-9, DQuat::IDENTITY),
                (0.0, turn),
                (1e-30, turn),
            ] {
                let case = identical(shape.clone(), DVec3::new(offset, 0.0, 0.0), turn);
                let found = answer(&case);
                let name = format!("{shape:?} {offset} {turn}: {found:?}");
                wrong.unless((found.gap + width).abs() < 1e-6 + offset, || {
                    format!("{name}, not {width}")
                });
                wrong.unless((found.normal.length() - 1.0).abs() < 1e-12, || name.clone());
                wrong.unless(found == answer(&case), || name.clone());
            }
        }
    }
    wrong.end();
}

#[test]
fn coincident_centres_give_a_valid_direction_and_the_same_every_time() {
    let mut wrong = Wrong::default();
    let mut random = Random(11);
    let oracle = Oracle::new(1500, 6);
    for a in KINDS {
        for b in KINDS {
            let pose = Pose::new(DVec3::ZERO, rotation(&mut random));
            let case = Case {
                a: random_shape(a, &mut random),
                pose_a: pose,
                b: random_shape(b, &mut random),
                pose_b: Pose::new(DVec3::ZERO, rotation(&mut random)),
            };
            let found = answer(&case);
            let verdict = judge(&case, &found, None, &oracle);
            let name = format!("{case:?}: {found:?}");
            wrong.unless(found.gap.is_finite() && found.gap < 0.0, || name.clone());
            wrong.unless(
                verdict.gap_error <= 1e-4 * case.size() || found.capped,
                || format!("{name}, not {:?}", verdict.truth),
            );
            wrong.unless(found == answer(&case), || name.clone());
        }
    }
    wrong.end();
}
