//! Manifolds against what geometry says, and again one unit in the last place off.

use glam::DQuat;

use super::*;
use crate::query::{Limits, separation};

type Put<'a> = (&'a Shape, &'a Pose);

fn at(x: f64, y: f64, z: f64) -> Pose {
    Pose::from_position(DVec3::new(x, y, z))
}

fn on_its_side(x: f64, y: f64, z: f64) -> Pose {
    Pose::new(
        DVec3::new(x, y, z),
        DQuat::from_rotation_z(std::f64::consts::FRAC_PI_2),
    )
}

fn found(a: Put, b: Put) -> Manifold {
    manifold(a, b, &separation(a, b, None, Limits::default()))
}

/// The manifold, after checking that moving b by one unit in the last place moves no point, and that all points have
/// this depth.
fn steady(a: Put, b: Put, depth: f64) -> Manifold {
    let here = found(a, b);
    for p in here.points() {
        assert!((p.depth - depth).abs() < 1e-12, "{p:?} instead of {depth}");
    }
    for axis in 0..3 {
        for up in [false, true] {
            let mut pose = *b.1;
            let x = &mut pose.position[axis];
            *x = if up { x.next_up() } else { x.next_down() };
            let moved = found(a, (b.0, &pose));
            assert_eq!(moved.points().len(), here.points().len());
            for (p, q) in here.points().iter().zip(moved.points()) {
                assert!(p.point.distance(q.point) < 1e-9, "{p:?} became {q:?}");
            }
        }
    }
    here
}

fn assert_points(found: &Manifold, expected: &[DVec3]) {
    assert_eq!(found.points().len(), expected.len(), "{found:?}");
    for e in expected {
        let near = |p: &&ContactPoint| p.point.distance(*e) < 1e-9;
        let count = found.points().iter().filter(near).count();
        assert_eq!(count, 1, "{e} in {found:?}");
    }
}

/// Area that the points span, taken in their order around it [m2].
fn area(found: &Manifold) -> f64 {
    let p = found.points();
    let next = p.iter().cycle().skip(1);
    let sum: DVec3 = p
        .iter()
        .zip(next)
        .map(|(p, q)| p.point.cross(q.point))
        .sum();
    0.5 * sum.length()
}

fn floor() -> Shape {
    Shape::half_space(DVec3::Y).unwrap()
}

fn block() -> Shape {
    Shape::cuboid(DVec3::new(2.0, 0.5, 3.0)).unwrap()
}

#[test]
fn a_disc_stands_on_a_floor_and_on_a_box_with_four_points_of_its_rim() {
    let can = Shape::cylinder(0.3, 0.2).unwrap();
    let pin = Shape::truncated_ellipsoid(DVec3::new(0.3, 0.25, 0.3), -0.2).unwrap();
    for (shape, radius) in [(&can, 0.3), (&pin, 0.18)] {
        for (ground, top) in [(&floor(), 0.0), (&block(), 0.5)] {
            for depth in [0.0, 1e-3, -1e-3] {
                let up = at(0.1, top + 0.2 - depth, 0.0);
                let m = steady((ground, &Pose::IDENTITY), (shape, &up), depth);
                assert_eq!(m.points().len(), 4);
                for p in m.points() {
                    let out = p.point - DVec3::new(0.1, top - 0.5 * depth, 0.0);
                    assert!(out.y.abs() < 1e-12 && (out.length() - radius).abs() < 1e-12);
                }
                // A square in the circle.
                assert!((area(&m) - 2.0 * radius * radius).abs() < 1e-12);
            }
        }
    }
}

#[test]
fn a_disc_half_over_an_edge_stands_on_the_half() {
    let can = Shape::cylinder(0.3, 0.2).unwrap();
    let m = steady((&block(), &Pose::IDENTITY), (&can, &at(2.0, 0.7, 0.0)), 0.0);
    assert!(m.points().len() >= 3);
    assert!(m.points().iter().all(|p| p.point.x < 2.0 + 1e-9));
    // The ends of the cut are in it, and the point farthest from it.
    for e in [
        DVec3::new(2.0, 0.5, 0.3),
        DVec3::new(2.0, 0.5, -0.3),
        DVec3::new(1.7, 0.5, 0.0),
    ] {
        assert!(
            m.points().iter().any(|p| p.point.distance(e) < 1e-9),
            "{e} {m:?}"
        );
    }
}

#[test]
fn lying_bodies_touch_with_two_points() {
    let can = Shape::cylinder(0.3, 0.2).unwrap();
    let capsule = Shape::capsule(0.3, 0.2).unwrap();
    for shape in [&can, &capsule] {
        for (ground, top) in [(&floor(), 0.0), (&block(), 0.5)] {
            let pose = on_its_side(0.0, top + 0.3, 0.0);
            let m = steady((ground, &Pose::IDENTITY), (shape, &pose), 0.0);
            assert_points(&m, &[DVec3::new(-0.2, top, 0.0), DVec3::new(0.2, top, 0.0)]);
        }
    }
    // Over the edge: what lies on the box.
    let pose = on_its_side(2.0, 0.8, 0.0);
    let m = steady((&block(), &Pose::IDENTITY), (&can, &pose), 0.0);
    assert_points(&m, &[DVec3::new(1.8, 0.5, 0.0), DVec3::new(2.0, 0.5, 0.0)]);
}

#[test]
fn a_cone_lies_on_its_mantle_and_stands_on_its_apex() {
    let cone = Shape::cone(0.3, 0.4).unwrap();
    // The mantle is horizontal when the axis leans by the half angle.
    let lean = (0.3_f64 / 0.8).atan() + std::f64::consts::FRAC_PI_2;
    let pose = Pose::new(DVec3::ZERO, DQuat::from_rotation_z(lean));
    let low = pose.transform_vector(cone.support(pose.inverse().transform_vector(-DVec3::Y)));
    let pose = Pose::new(DVec3::Y * -low.y, pose.rotation);
    let m = found((&floor(), &Pose::IDENTITY), (&cone, &pose));
    assert_eq!(m.points().len(), 2);
    let length = m.points()[0].point.distance(m.points()[1].point);
    assert!((length - 0.3_f64.hypot(0.8)).abs() < 1e-9);
    let upside_down = Pose::new(DVec3::Y * 0.4, DQuat::from_rotation_z(std::f64::consts::PI));
    let m = steady((&floor(), &Pose::IDENTITY), (&cone, &upside_down), 0.0);
    assert_points(&m, &[DVec3::ZERO]);
}

#[test]
fn cylinders_touch_side_by_side_end_to_end_and_crosswise() {
    let can = Shape::cylinder(0.3, 0.2).unwrap();
    let still = (&can, &Pose::IDENTITY);
    let m = steady(still, (&can, &at(0.6, 0.1, 0.0)), 0.0);
    assert_points(&m, &[DVec3::new(0.3, -0.1, 0.0), DVec3::new(0.3, 0.2, 0.0)]);
    let m = steady(still, (&can, &at(0.0, 0.4, 0.0)), 0.0);
    assert_eq!(m.points().len(), 4);
    assert!((area(&m) - 0.18).abs() < 1e-9);
    let small = Shape::cylinder(0.1, 0.2).unwrap();
    let m = steady(still, (&small, &at(0.05, 0.4, 0.0)), 0.0);
    assert!((area(&m) - 0.02).abs() < 1e-9, "{m:?}");
    let across = Pose::new(
        DVec3::new(0.6, 0.0, 0.0),
        DQuat::from_rotation_x(std::f64::consts::FRAC_PI_2),
    );
    let m = steady(still, (&can, &across), 0.0);
    assert_points(&m, &[DVec3::new(0.3, 0.0, 0.0)]);
}

#[test]
fn boxes_share_faces_edges_and_corners() {
    let cube = Shape::cuboid(DVec3::ONE).unwrap();
    let still = (&cube, &Pose::IDENTITY);
    let m = steady(still, (&cube, &at(0.5, 2.0, 0.25)), 0.0);
    let corner = |x, z| DVec3::new(x, 1.0, z);
    assert_points(
        &m,
        &[
            corner(-0.5, -0.75),
            corner(1.0, -0.75),
            corner(1.0, 1.0),
            corner(-0.5, 1.0),
        ],
    );
    let same = steady(still, (&cube, &at(0.0, 2.0, 0.0)), 0.0);
    assert!((area(&same) - 4.0).abs() < 1e-9);
    // Turned by 45 degrees the shared face is an octagon of area 8 (sqrt 2 - 1), of which a square is kept.
    let turned = Pose::new(
        DVec3::Y * 2.0,
        DQuat::from_rotation_y(0.25 * std::f64::consts::PI),
    );
    let m = steady(still, (&cube, &turned), 0.0);
    assert_eq!(m.points().len(), 4);
    assert!(area(&m) > 2.0);
    let on_edge = Pose::new(
        DVec3::new(0.0, 1.0 + 2.0_f64.sqrt(), 0.5),
        DQuat::from_rotation_z(0.25 * std::f64::consts::PI),
    );
    let m = steady(still, (&cube, &on_edge), 0.0);
    assert_points(&m, &[DVec3::new(0.0, 1.0, -0.5), DVec3::new(0.0, 1.0, 1.0)]);
    let on_corner = Pose::new(
        DVec3::Y * (1.0 + 3.0_f64.sqrt()),
        DQuat::from_rotation_arc(DVec3::ONE.normalize(), DVec3::Y),
    );
    let m = steady(still, (&cube, &on_corner), 0.0);
    assert_points(&m, &[DVec3::Y]);
}

#[test]
fn a_cloud_touches_as_the_shape_whose_vertices_it_has() {
    let cube = Shape::cuboid(DVec3::ONE).unwrap();
    let signs = [-1.0, 1.0];
    let corners: Vec<DVec3> = signs
        .iter()
        .flat_map(|x| signs.map(|y| (*x, y)))
        .flat_map(|(x, y)| signs.map(|z| DVec3::new(x, y, z)))
        .chain([DVec3::new(0.0, -1.0, 0.0), DVec3::new(1.0, -1.0, 0.0)])
        .collect();
    let cloud = Shape::cloud(&corners).unwrap();
    for pose in [at(0.5, 2.0, 0.25), at(0.0, 2.0, 0.0)] {
        let known = separation(
            (&cube, &Pose::IDENTITY),
            (&cube, &pose),
            None,
            Limits::default(),
        );
        let one = manifold((&cube, &Pose::IDENTITY), (&cube, &pose), &known);
        let two = manifold((&cube, &Pose::IDENTITY), (&cloud, &pose), &known);
        let expected: Vec<DVec3> = one.points().iter().map(|p| p.point).collect();
        assert_points(&two, &expected);
    }
}

#[test]
fn smooth_bodies_touch_in_the_point_of_equation_one() {
    let ball = Shape::sphere(0.3).unwrap();
    let egg = Shape::ellipsoid(DVec3::new(0.2, 0.3, 0.4)).unwrap();
    for shape in [&ball, &egg] {
        let m = steady(
            (&block(), &Pose::IDENTITY),
            (shape, &at(0.2, 0.799, 0.3)),
            1e-3,
        );
        assert_points(&m, &[DVec3::new(0.2, 0.4995, 0.3)]);
    }
}

/// A leaning face is still one contact of several points, each with its own depth.
#[test]
fn depth_follows_the_lean_of_a_face() {
    let cube = Shape::cuboid(DVec3::ONE).unwrap();
    let lean = 5e-5;
    let pose = Pose::new(DVec3::Y, DQuat::from_rotation_z(lean));
    let m = found((&floor(), &Pose::IDENTITY), (&cube, &pose));
    assert_eq!(m.points().len(), 4);
    for p in m.points() {
        assert!((p.depth + lean * p.point.x.signum()).abs() < 1e-8, "{p:?}");
    }
}
