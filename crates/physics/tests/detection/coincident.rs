//! Bodies with one centre: no line of centres, and ties everywhere.

use glam::{DQuat, DVec3};
use physics::Pose;
use physics::query::Limits;

use crate::judge::cases::{Case, KINDS, direction, random_shape, rotation};
use crate::judge::hull::Hull;
use crate::judge::known::Known;
use crate::judge::oracle::{Field, Oracle};
use crate::judge::verdict::judge;
use crate::support::Random;
use crate::{Wrong, answer, ask};

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

/// The largest gap of two clouds that overlap: along a face's normal or square to two edges, for every facet of the
/// polytope of their differences is one of these.
fn largest_gap(case: &Case) -> f64 {
    let (Known::Cloud(a), Known::Cloud(b)) = (&case.a, &case.b) else {
        panic!("clouds have corners");
    };
    let field = Field::new(case);
    let edges = |hull: &Hull, turn: DQuat| -> Vec<DVec3> {
        let all = hull.faces.iter().flat_map(|face| {
            let [i, j, k] = face.corners;
            [(i, j), (j, k), (k, i)]
        });
        let once = all.filter(|(i, j)| i < j);
        once.map(|(i, j)| turn * (hull.points[j] - hull.points[i]))
            .collect()
    };
    let (turn_a, turn_b) = (case.pose_a.rotation, case.pose_b.rotation);
    let (edges_a, edges_b) = (edges(a, turn_a), edges(b, turn_b));
    let faces = (a.faces.iter().map(|face| turn_a * face.normal))
        .chain(b.faces.iter().map(|face| turn_b * face.normal));
    let square = edges_a
        .iter()
        .flat_map(|u| edges_b.iter().map(|v| u.cross(*v)))
        .filter_map(DVec3::try_normalize);
    faces
        .chain(square)
        .flat_map(|n| [n, -n])
        .map(|n| field.gap(n))
        .fold(f64::NEG_INFINITY, f64::max)
}

/// A cloud in its own copy, at the same place and nearly so: opposite facets of the polytope of differences are as
/// far. The growth of that polytope may need more than 20 normals, and then says so.
#[test]
fn a_cloud_in_its_own_copy_is_as_deep_as_it_is_wide() {
    let mut wrong = Wrong::default();
    let mut random = Random(73);
    for (kind, shapes) in [("cloud8", 40), ("cloud64", 3)] {
        for _ in 0..shapes {
            let shape = random_shape(kind, &mut random);
            let turn = rotation(&mut random);
            for off in [0.0, 1e-30, 1e-12, 1e-9, 1e-6, 1e-3] {
                for tilt in [0.0, 1e-12, 1e-8, 1e-4] {
                    let mut case = identical(shape.clone(), direction(&mut random) * off, turn);
                    let tilted = DQuat::from_axis_angle(direction(&mut random), tilt);
                    case.pose_b.rotation = (tilted * turn).normalize();
                    let right = largest_gap(&case);
                    for iteration_cap in [20, 100] {
                        let limits = Limits {
                            iteration_cap,
                            ..Limits::default()
                        };
                        let found = ask(&case, None, limits);
                        let name = || format!("{kind} {off} {tilt}: not {right}, {found:?}");
                        let capped = found.capped && kind == "cloud64" && iteration_cap == 20;
                        wrong.unless((found.gap - right).abs() < 1e-9 || capped, name);
                        wrong.unless(found.gap <= right + 1e-12, name);
                        wrong.unless(found.upper.is_none_or(|up| up >= right - 1e-12), name);
                        wrong.unless(found == ask(&case, None, limits), name);
                    }
                }
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
