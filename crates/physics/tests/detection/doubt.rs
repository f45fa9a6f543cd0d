//! Overlaps that are none: starts that have grown old, and the wrong one of several maxima; and what proves one.

use std::f64::consts::FRAC_PI_3;

use glam::{DQuat, DVec3};
use physics::Pose;
use physics::query::{Limits, Separation};

use crate::judge::built::drawn;
use crate::judge::cases::{Case, Class};
use crate::judge::known::Known;
use crate::judge::verdict::angle;
use crate::{Wrong, answer, ask};

/// A lane's box, 1.05 m wide and 19 m long.
const LANE: DVec3 = DVec3::new(0.52705, 0.15, 9.578);
/// What stands beside the lane is this wide [m].
const RADIUS: f64 = 0.06;
const BESIDE: [Known; 4] = [
    Known::Frustum(RADIUS, RADIUS, 0.19),
    Known::Frustum(RADIUS, 0.02, 0.19),
    Known::Capsule(RADIUS, 0.13),
    Known::Ellipsoid(DVec3::new(RADIUS, 0.19, RADIUS)),
];

/// What was struck on one face of a lane and has passed over it to the other is apart, by 12 mm.
#[test]
fn an_old_start_does_not_make_an_overlap() {
    let mut wrong = Wrong::default();
    let gap = 0.012;
    for b in BESIDE {
        // The lower rim is the widest point; its height must be that of the lane.
        let position = DVec3::new(LANE.x + gap + RADIUS, 0.05, 3.0);
        let case = Case {
            a: Known::Cuboid(LANE),
            pose_a: Pose::IDENTITY,
            b,
            pose_b: Pose::from_position(position),
        };
        for axis in DVec3::AXES {
            for start in [
                axis,
                -axis,
                DQuat::from_scaled_axis(DVec3::splat(0.02)) * -axis,
            ] {
                let found = ask(&case, Some(start), Limits::default());
                let right = (found.gap - gap).abs() < 1e-9 && angle(found.normal, DVec3::X) < 1e-6;
                wrong.unless(right && !found.local, || {
                    format!("{:?} from {start}: {found:?}", case.b)
                });
            }
        }
    }
    wrong.end();
}

/// Two cones 1.9 micrometres apart, rim on rim, of which the axis of one's base shows an overlap of 2 mm, and all other
/// normals that lead to maxima lie 16 mm deeper at first.
#[test]
fn a_wrong_way_out_is_not_an_overlap() {
    let (case, truth) = drawn(("cone", "cone"), Class::Touching, 32_000_000, 3508);
    let (gap, normal) = truth.expect("touching poses are built from a known contact");
    let Separation {
        gap: found,
        normal: n,
        ..
    } = answer(&case);
    assert!((found - gap).abs() < 1e-9, "{found} for {gap}");
    assert!(angle(n, normal) < 1e-4, "{n} for {normal}");
}

/// The base of a pin that leans by some microradians over a lane's box: its lowest rim point says how far, at once.
#[test]
fn a_face_answers_for_what_lies_over_it() {
    let mut wrong = Wrong::default();
    let (radius, half) = (0.0258, 0.19);
    for lean in [1e-8, 1e-5, 1e-3] {
        for gap in [-1e-6, 1e-6, 0.01] {
            let low = half * f64::cos(lean) + radius * f64::sin(lean);
            let position = DVec3::new(0.3, LANE.y + low + gap, -4.0);
            let case = Case {
                a: Known::Frustum(radius, 0.06, half),
                pose_a: Pose::new(position, DQuat::from_rotation_x(lean)),
                b: Known::Cuboid(LANE),
                pose_b: Pose::IDENTITY,
            };
            let start = DQuat::from_rotation_z(0.02) * -DVec3::Y;
            let found = ask(&case, Some(start), Limits::default());
            let right = (found.gap - gap).abs() < 1e-12 && found.normal == -DVec3::Y;
            wrong.unless(right && found.iterations == 1, || {
                format!("{lean} {gap}: {found:?}")
            });
        }
    }
    wrong.end();
}

/// A slender tip in a face: half way between the closest points is outside of the cone, which leans, and its apex alone
/// proves the depth.
#[test]
fn a_leaning_tip_proves_its_depth() {
    let mut wrong = Wrong::default();
    for depth in [1e-3, 0.02, 0.1] {
        let half = 0.5;
        let turn = DQuat::from_rotation_x(FRAC_PI_3 * 2.0);
        let apex = turn * (DVec3::Y * half);
        let case = Case {
            a: Known::Cuboid(DVec3::splat(2.0)),
            pose_a: Pose::IDENTITY,
            b: Known::Frustum(0.1, 0.0, half),
            pose_b: Pose::new(DVec3::new(0.2, 2.0 - depth, 0.3) - apex, turn),
        };
        let found = answer(&case);
        wrong.unless((found.gap + depth).abs() < 1e-12, || format!("{found:?}"));
        let proven = found
            .upper
            .is_some_and(|upper| (upper + depth).abs() < 1e-12);
        wrong.unless(proven, || format!("{depth}: {found:?}"));
    }
    wrong.end();
}
