//! Contacts known exactly: faces, lines, rims and apexes, section 5.4.

use std::f64::consts::{FRAC_PI_2, PI};

use glam::{DQuat, DVec3};
use physics::Pose;
use physics::query::manifold;

use super::Case;
use super::detection::answer;
use super::findings::{Findings, Outcome, worse};
use super::oracle::{Known, Pair};

pub const CASES: &[Case] = &[Case {
    name: "exact-contacts",
    section: "5.4",
    expected: "faces, lines, rims, apexes that touch: gap, normal, points (analysis)",
    criterion: "gap 1e-10, normal 0.01 deg, also one ulp off; 3-4, 2 and 1 points",
    run: exact_contacts,
}];

/// A contact whose gap and normal +y are known: b above a, and how many points span it.
struct Exact {
    a: Known,
    b: Known,
    /// Height of b's centre when they touch [m], and its turn.
    height: f64,
    turn: DQuat,
    aside: DVec3,
    points: std::ops::RangeInclusive<usize>,
}

/// Faces, lines, rims and apexes that touch.
fn exacts() -> Vec<Exact> {
    let table = Known::Cuboid(DVec3::new(1.0, 0.5, 2.0));
    let cylinder = Known::Cylinder(0.5, 1.0);
    let cone = Known::Cone(0.5, 1.0);
    let cube = Known::Cuboid(DVec3::splat(0.5));
    let (upright, lying) = (DQuat::IDENTITY, DQuat::from_rotation_x(FRAC_PI_2));
    let upside_down = DQuat::from_rotation_x(PI);
    let leaning = DQuat::from_rotation_x(0.25 * PI);
    let rim = 1.5 * (0.25 * PI).sin();
    let on_corner = DQuat::from_rotation_arc(DVec3::ONE / 3f64.sqrt(), DVec3::NEG_Y);
    let exact = |a, b, height, turn, points| Exact {
        a,
        b,
        height,
        turn,
        aside: DVec3::new(0.2, 0.0, 0.3),
        points,
    };
    let on_axis = |exact: Exact| Exact {
        aside: DVec3::ZERO,
        ..exact
    };
    vec![
        exact(table, cylinder, 1.5, upright, 3..=4),
        exact(table, cube, 1.0, upright, 3..=4),
        exact(table, cone, 1.5, upright, 3..=4),
        exact(cylinder, cylinder, 2.0, upright, 3..=4),
        on_axis(exact(cylinder, cylinder, 2.0, upright, 3..=4)),
        exact(table, cylinder, 1.0, lying, 2..=2),
        exact(table, Known::Capsule(0.5, 1.0), 1.0, lying, 2..=2),
        exact(table, cylinder, 0.5 + rim, leaning, 1..=1),
        exact(table, cone, 1.5, upside_down, 1..=1),
        exact(table, cube, 0.5 + 0.75f64.sqrt(), on_corner, 1..=1),
        exact(table, Known::Sphere(0.5), 1.0, upright, 1..=1),
        exact(table, Known::Capsule(0.5, 1.0), 2.0, upright, 1..=1),
        on_axis(exact(cone, Known::Sphere(0.5), 1.5, upright, 1..=1)),
        on_axis(exact(cone, cone, 2.0, upside_down, 1..=1)),
    ]
}

/// The pose, and as it is with each of its numbers one unit in the last place off.
fn nudged(pose: Pose) -> Vec<Pose> {
    let up = |x: f64| if x == 0.0 { f64::EPSILON } else { x.next_up() };
    let mut poses = vec![pose];
    for i in 0..3 {
        let mut other = pose;
        other.position[i] = up(other.position[i]);
        poses.push(other);
    }
    for i in 0..4 {
        let mut parts = pose.rotation.to_array();
        parts[i] = up(parts[i]);
        poses.push(Pose::new(pose.position, DQuat::from_array(parts)));
    }
    poses
}

fn exact_contacts() -> Outcome {
    let mut findings = Findings::new();
    let (mut gap_off, mut normal_off): (f64, f64) = (0.0, 0.0);
    let (mut odd, mut count) = (0, 0);
    // In the origin, and where everything is rounded.
    let places = [
        Pose::IDENTITY,
        Pose::new(
            DVec3::new(0.3, -1.7, 2.9),
            DQuat::from_scaled_axis(DVec3::new(0.4, -1.1, 0.7)),
        ),
    ];
    for exact in exacts() {
        for gap in [1e-4, 1e-6, 0.0] {
            for place in places {
                let at = exact.aside + DVec3::Y * (exact.height + gap);
                for pose_b in nudged(place * Pose::new(at, exact.turn)) {
                    let pair = Pair {
                        a: exact.a,
                        pose_a: place,
                        b: exact.b,
                        pose_b,
                    };
                    let found = answer(&pair);
                    gap_off = worse(gap_off, (found.gap - gap).abs());
                    let up = place.rotation * DVec3::Y;
                    let angle = found.normal.cross(up).length().atan2(found.normal.dot(up));
                    // Apexes that meet exactly have no single normal.
                    if gap > 0.0 || exact.points != (1..=1) {
                        normal_off = worse(normal_off, angle.to_degrees());
                    }
                    let (a, b) = (pair.a.shape(), pair.b.shape());
                    let spanned = manifold((&a, &pair.pose_a), (&b, &pair.pose_b), &found);
                    count += 1;
                    let points = spanned.points().len();
                    odd += usize::from(gap > 0.0 && !exact.points.contains(&points));
                }
            }
        }
    }
    findings.at_most("gap off by", gap_off, 1e-10, "m");
    findings.at_most("normal", normal_off, 0.01, "deg");
    findings.none_of("with other points", odd, count);
    findings.outcome()
}
