//! Faces, lines, rims and apexes that meet exactly, and one unit in the last place off.

use std::f64::consts::{FRAC_PI_2, FRAC_PI_4, PI};
use std::ops::RangeInclusive;

use glam::{DQuat, DVec3};
use physics::Pose;
use physics::query::manifold;

use crate::judge::cases::Case;
use crate::judge::known::Known;
use crate::judge::verdict::angle;
use crate::{Wrong, answer};

const X: DVec3 = DVec3::X;
const Y: DVec3 = DVec3::Y;

const BOX: Known = Known::Cuboid(DVec3::new(1.0, 0.5, 2.0));
const CUBE: Known = Known::Cuboid(DVec3::splat(0.5));
const CYLINDER: Known = Known::Frustum(0.5, 0.5, 1.0);
const FRUSTUM: Known = Known::Frustum(0.5, 0.25, 1.0);
const CONE: Known = Known::Frustum(0.5, 0.0, 1.0);
const CAPSULE: Known = Known::Capsule(0.5, 1.0);
const ELLIPSOID: Known = Known::Ellipsoid(DVec3::new(0.5, 1.0, 0.7));
const BALL: Known = Known::Sphere(0.5);
const FLOOR: Known = Known::HalfSpace(DVec3::Y);

/// A contact whose gap and normal are known.
struct Exact {
    name: String,
    case: Case,
    gap: f64,
    /// None where more than one is as good.
    normal: Option<DVec3>,
    /// How many points span the contact.
    span: RangeInclusive<usize>,
}

/// Where b stands: position [m] and a turn about x [rad].
fn at(x: f64, y: f64, z: f64, turn: f64) -> Pose {
    Pose::new(DVec3::new(x, y, z), DQuat::from_rotation_x(turn))
}

/// A contact with a in the origin; its gap is filled in by `exact_contacts`.
fn meet(name: &str, a: Known, b: Known, pose_b: Pose, normal: DVec3) -> Exact {
    Exact {
        name: name.to_owned(),
        case: Case {
            a,
            pose_a: Pose::IDENTITY,
            b,
            pose_b,
        },
        gap: 0.0,
        normal: Some(normal),
        span: 1..=1,
    }
}

/// Faces on faces.
fn faces(g: f64) -> Vec<Exact> {
    vec![
        meet(
            "cylinder on box",
            BOX,
            CYLINDER,
            at(0.2, 1.5 + g, 0.3, 0.0),
            Y,
        ),
        meet(
            "cylinder over an edge",
            BOX,
            CYLINDER,
            at(1.2, 1.5 + g, 0.3, 0.0),
            Y,
        ),
        meet(
            "cylinder over a corner",
            BOX,
            CYLINDER,
            at(1.2, 1.5 + g, 2.2, 0.0),
            Y,
        ),
        meet(
            "cylinder on floor",
            FLOOR,
            CYLINDER,
            at(0.1, 1.0 + g, 0.0, 0.0),
            Y,
        ),
        meet(
            "frustum on box",
            BOX,
            FRUSTUM,
            at(0.2, 1.5 + g, 0.3, 0.0),
            Y,
        ),
        meet(
            "frustum upside down",
            BOX,
            FRUSTUM,
            at(0.2, 1.5 + g, 0.3, PI),
            Y,
        ),
        meet(
            "coaxial cylinders",
            CYLINDER,
            CYLINDER,
            at(0.0, 2.0 + g, 0.0, 0.0),
            Y,
        ),
        meet(
            "parallel cylinders",
            CYLINDER,
            CYLINDER,
            at(0.3, 2.0 + g, 0.2, 0.0),
            Y,
        ),
        meet(
            "cone's base on box",
            BOX,
            CONE,
            at(0.1, 1.5 + g, 0.2, 0.0),
            Y,
        ),
        meet(
            "cones base to base",
            CONE,
            CONE,
            at(0.0, -2.0 - g, 0.0, PI),
            -Y,
        ),
        meet("box on box", BOX, BOX, at(0.3, 1.0 + g, 0.4, 0.0), Y),
        meet(
            "box squarely on box",
            BOX,
            BOX,
            at(0.0, 1.0 + g, 0.0, 0.0),
            Y,
        ),
    ]
}

/// Lines on faces and on lines.
fn lines(g: f64) -> Vec<Exact> {
    let lying = FRAC_PI_2;
    let across = |y: f64| Pose::new(DVec3::Y * y, DQuat::from_rotation_z(FRAC_PI_2));
    // The cone lies on its side: the slant is level where the axis dips towards the apex by the half angle.
    let half_angle = 0.25f64.atan();
    let slant = 0.5 * half_angle.cos() - half_angle.sin();
    let on_slant = at(0.0, 0.5 + slant + g, 0.0, FRAC_PI_2 + half_angle);
    vec![
        meet(
            "side by side",
            CYLINDER,
            CYLINDER,
            at(1.0 + g, 0.3, 0.0, 0.0),
            X,
        ),
        meet(
            "side by side, level",
            CYLINDER,
            CYLINDER,
            at(1.0 + g, 0.0, 0.0, 0.0),
            X,
        ),
        meet(
            "cylinder lying on box",
            BOX,
            CYLINDER,
            at(0.0, 1.0 + g, 0.0, lying),
            Y,
        ),
        meet("cylinder lying across", BOX, CYLINDER, across(1.0 + g), Y),
        meet(
            "capsule lying on box",
            BOX,
            CAPSULE,
            at(0.0, 1.0 + g, 0.0, lying),
            Y,
        ),
        meet(
            "capsules side by side",
            CAPSULE,
            CAPSULE,
            at(1.0 + g, 0.5, 0.0, 0.0),
            X,
        ),
        meet("cone lying on box", BOX, CONE, on_slant, Y),
    ]
}

/// Rims, corners, apexes and round bodies on faces and on each other.
fn points(g: f64) -> Vec<Exact> {
    let leaning = FRAC_PI_4;
    let rim = (0.5 + 1.0) * FRAC_PI_4.sin();
    let upright_diagonal = DQuat::from_rotation_arc(DVec3::ONE / 3f64.sqrt(), DVec3::NEG_Y);
    let half_diagonal = 0.75f64.sqrt();
    let on_corner = Pose::new(
        DVec3::new(0.1, 0.5 + half_diagonal + g, 0.2),
        upright_diagonal,
    );
    vec![
        meet(
            "rim on box",
            BOX,
            CYLINDER,
            at(0.1, 0.5 + rim + g, 0.0, leaning),
            Y,
        ),
        meet(
            "rim on floor",
            FLOOR,
            CYLINDER,
            at(0.1, rim + g, 0.0, leaning),
            Y,
        ),
        meet("apex on box", BOX, CONE, at(0.1, 1.5 + g, 0.2, PI), Y),
        meet("apex on floor", FLOOR, CONE, at(0.1, 1.0 + g, 0.2, PI), Y),
        meet("corner on box", BOX, CUBE, on_corner, Y),
        meet(
            "capsule standing on box",
            BOX,
            CAPSULE,
            at(0.1, 2.0 + g, 0.2, 0.0),
            Y,
        ),
        meet(
            "crossed cylinders",
            CYLINDER,
            CYLINDER,
            at(1.0 + g, 0.0, 0.0, FRAC_PI_2),
            X,
        ),
        meet(
            "capsules end to end",
            CAPSULE,
            CAPSULE,
            at(0.0, 3.0 + g, 0.0, 0.0),
            Y,
        ),
        meet(
            "ellipsoid on box",
            BOX,
            ELLIPSOID,
            at(0.1, 1.5 + g, 0.2, 0.0),
            Y,
        ),
        meet(
            "ellipsoids end to end",
            ELLIPSOID,
            ELLIPSOID,
            at(0.0, 2.0 + g, 0.0, 0.0),
            Y,
        ),
        meet("ball on box", BOX, BALL, at(0.1, 1.0 + g, 0.2, 0.0), Y),
        meet("ball on apex", CONE, BALL, at(0.0, 1.5 + g, 0.0, 0.0), Y),
        meet(
            "ball on cylinder's face",
            CYLINDER,
            BALL,
            at(0.1, 1.5 + g, 0.2, 0.0),
            Y,
        ),
    ]
}

/// Faces, lines, rims and apexes that meet `gap` apart.
fn exact_contacts(gap: f64) -> Vec<Exact> {
    let span = |exacts: Vec<Exact>, span: RangeInclusive<usize>| {
        exacts.into_iter().map(move |exact| Exact {
            name: format!("{}, gap {gap:e}", exact.name),
            gap,
            span: span.clone(),
            ..exact
        })
    };
    span(faces(gap), 3..=4)
        .chain(span(lines(gap), 2..=2))
        .chain(span(points(gap), 1..=1))
        .chain([apex_on_apex(gap)])
        .collect()
}

/// Two cones apex to apex. Overlapping they have no single way out: sideways along any slant is shortest.
fn apex_on_apex(gap: f64) -> Exact {
    let slant = 0.5 / 0.5f64.hypot(2.0);
    Exact {
        name: format!("apex on apex, gap {gap:e}"),
        gap: if gap < 0.0 { gap * slant } else { gap },
        normal: (gap > 0.0).then_some(Y),
        // The way out along a slant makes the two slants a line of contact.
        span: 1..=if gap < 0.0 { 2 } else { 1 },
        ..meet("", CONE, CONE, at(0.0, 2.0 + gap, 0.0, PI), Y)
    }
}

const GAPS: [f64; 7] = [0.02, 1e-4, 1e-6, 0.0, -1e-6, -1e-4, -0.02];

/// The case as it is, and after a rigid motion that rounds everything.
fn also_moved(exact: &Exact) -> [(Case, Option<DVec3>); 2] {
    let by = Pose::new(
        DVec3::new(0.3, -1.7, 2.9),
        DQuat::from_scaled_axis(DVec3::new(0.4, -1.1, 0.7)),
    );
    let moved = Case {
        a: exact.case.a.clone(),
        pose_a: by * exact.case.pose_a,
        b: exact.case.b.clone(),
        pose_b: by * exact.case.pose_b,
    };
    let normal = exact.normal.map(|n| by.transform_vector(n));
    [(exact.case.clone(), exact.normal), (moved, normal)]
}

#[test]
fn faces_lines_rims_and_apexes_meet_their_closed_forms() {
    let mut wrong = Wrong::default();
    for gap in GAPS {
        for exact in exact_contacts(gap) {
            for (case, normal) in also_moved(&exact) {
                let found = answer(&case);
                let right = (found.gap - exact.gap).abs() <= 1e-10 && !found.capped;
                wrong.unless(right, || format!("{}: {found:?}", exact.name));
                let off = normal.map_or(0.0, |n| angle(found.normal, n));
                wrong.unless(off <= 1e-5, || {
                    format!("{}: normal off by {off:.1e}: {found:?}", exact.name)
                });
            }
        }
    }
    wrong.end();
}

/// The next number away from zero.
fn one_ulp(x: f64) -> f64 {
    if x == 0.0 {
        f64::MIN_POSITIVE
    } else {
        f64::from_bits(x.to_bits() + 1)
    }
}

/// Every number of b's pose one unit in the last place off, each in turn.
fn nudged(pose: &Pose) -> Vec<Pose> {
    let mut poses = Vec::new();
    for i in 0..3 {
        let mut other = *pose;
        other.position[i] = one_ulp(other.position[i]);
        poses.push(other);
    }
    for i in 0..4 {
        let mut parts = pose.rotation.to_array();
        parts[i] = one_ulp(parts[i]);
        poses.push(Pose::new(pose.position, DQuat::from_array(parts)));
    }
    // A zero of a quaternion is more likely to become an ulp of one.
    for i in 0..3 {
        let mut parts = pose.rotation.to_array();
        parts[i] += f64::EPSILON;
        poses.push(Pose::new(pose.position, DQuat::from_array(parts)));
    }
    poses
}

#[test]
fn one_ulp_does_not_turn_a_unique_normal() {
    let limit = 0.01f64.to_radians();
    let mut wrong = Wrong::default();
    for gap in GAPS {
        for exact in exact_contacts(gap) {
            for (case, normal) in also_moved(&exact) {
                let Some(normal) = normal else { continue };
                for pose_b in nudged(&case.pose_b) {
                    let nudged = Case {
                        pose_b,
                        ..case.clone()
                    };
                    let found = answer(&nudged);
                    let off = angle(found.normal, normal);
                    let right = off <= limit && (found.gap - exact.gap).abs() <= 1e-10;
                    wrong.unless(right, || {
                        format!("{} {pose_b:?}: {off:.1e} {found:?}", exact.name)
                    });
                }
            }
        }
    }
    wrong.end();
}

#[test]
fn faces_lines_and_points_are_spanned_by_four_two_and_one() {
    let mut wrong = Wrong::default();
    for gap in GAPS {
        for exact in exact_contacts(gap) {
            for (case, _) in also_moved(&exact) {
                let (a, b) = (case.a.shape(), case.b.shape());
                let found = manifold((&a, &case.pose_a), (&b, &case.pose_b), &answer(&case));
                let points = found.points();
                wrong.unless(exact.span.contains(&points.len()), || {
                    format!("{}: {} points", exact.name, points.len())
                });
                for point in points {
                    let inside = |shape: &Known, pose: &Pose| {
                        shape.outside(pose.rotation.conjugate() * (point.point - pose.position))
                    };
                    let off = inside(&case.a, &case.pose_a).max(inside(&case.b, &case.pose_b));
                    // Half way between the surfaces, at a rim beside one of them where they overlap; and the
                    // judge's way into a cone is up to 1.5 times the shortest.
                    let half = 0.75 * exact.gap.abs() + 1e-9;
                    let deep = (point.depth + exact.gap).abs() < 1e-9;
                    wrong.unless(deep && off < half, || {
                        format!("{}: {point:?}, off by {off:.1e}", exact.name)
                    });
                }
            }
        }
    }
    wrong.end();
}
