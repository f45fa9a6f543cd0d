//! Hulls of solids whose faces are known, and of points that have none.

use glam::DQuat;

use super::*;
use crate::random::Random;

/// The points of a grid on and in a turned cube.
fn grid(steps: i32, turn: DQuat) -> Vec<DVec3> {
    let at = |i: i32| 2.0 * f64::from(i) / f64::from(steps) - 1.0;
    let mut points = Vec::new();
    for x in 0..=steps {
        for y in 0..=steps {
            for z in 0..=steps {
                points.push(turn * DVec3::new(at(x), at(y), at(z)));
            }
        }
    }
    points
}

#[test]
fn a_cube_has_six_faces_however_many_points_lie_on_them() {
    let hull = Hull::new(&grid(8, DQuat::IDENTITY));
    assert_eq!(hull.planes.len(), 6, "{:?}", hull.planes);
    assert!(hull.planes.iter().all(|p| p.offset == 1.0));
    assert!((hull.inner_radius(DVec3::new(0.25, 0.0, 0.0)).unwrap() - 0.75).abs() < 1e-15);
    assert_eq!(hull.inner_radius(DVec3::X * 1.1), None);
    for steps in 1..6 {
        let turn = DQuat::from_rotation_y(0.3) * DQuat::from_rotation_x(1.1);
        let hull = Hull::new(&grid(steps, turn));
        let q = turn * DVec3::new(0.2, -0.5, 0.1);
        assert!((hull.inner_radius(q).unwrap() - 0.5).abs() < 1e-12);
        assert!(hull.corners.len() < 8 + 6 * 25, "{}", hull.corners.len());
    }
}

#[test]
fn the_support_height_is_that_of_all_points() {
    let seed = 11;
    println!("seed {seed}");
    let mut random = Random(seed);
    for round in 0..60 {
        let count = 4 + 7 * round;
        let points: Vec<DVec3> = match round % 3 {
            0 => (0..count).map(|_| random.vector()).collect(),
            1 => (0..count).map(|_| random.vector().normalize()).collect(),
            // A plate with doubles, a thousand times as wide as thick.
            _ => {
                let mut plate: Vec<DVec3> = (0..count)
                    .map(|_| random.vector() * DVec3::new(1.0, 1e-3, 1.0))
                    .collect();
                plate.extend_from_within(..);
                plate
            }
        };
        let hull = Hull::new(&points);
        for _ in 0..100 {
            let n = random.vector().normalize();
            let height = |of: &[DVec3]| {
                of.iter()
                    .map(|p| n.dot(*p))
                    .fold(f64::NEG_INFINITY, f64::max)
            };
            let found = n.dot(hull.corners[hull.farthest(n)]);
            assert!((found - height(&points)).abs() < 1e-14);
        }
        for plane in &hull.planes {
            let over = |p: &DVec3| plane.normal.dot(*p) - plane.offset;
            assert!(points.iter().all(|p| over(p) < 1e-12));
        }
        // Every point of a sphere is a corner.
        if round % 3 == 1 {
            assert_eq!(hull.corners.len(), count);
        }
    }
}

#[test]
fn points_inside_are_dropped() {
    let seed = 3;
    println!("seed {seed}");
    let mut random = Random(seed);
    let mut points: Vec<DVec3> = (0..500).map(|_| random.vector() * 0.9).collect();
    points.extend(grid(1, DQuat::IDENTITY));
    assert_eq!(Hull::new(&points).corners.len(), 8);
}

#[test]
fn points_without_volume_have_no_faces() {
    let line: Vec<DVec3> = (0..9)
        .map(|i| DVec3::new(1.0, 2.0, -0.7) * f64::from(i))
        .collect();
    let flat: Vec<DVec3> = line.iter().map(|p| *p + DVec3::X * p.y.sin()).collect();
    for points in [vec![DVec3::X; 5], line, flat] {
        let hull = Hull::new(&points);
        assert!(hull.planes.is_empty());
        assert_eq!(hull.inner_radius(points[0]), None);
    }
    assert_eq!(Hull::new(&[DVec3::X; 5]).corners, [DVec3::X]);
}
