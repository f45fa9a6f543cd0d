//! The paper's rival: are its polyhedra what they should be, and does it see the overlaps that the detection sees?
#![allow(
    clippy::disallowed_methods,
    reason = "what is expected may come from any library"
)]

mod support;

use std::collections::HashSet;
use std::f64::consts::{PI, TAU};

use glam::DVec3;
use physics::query::{Limits, separation};
use physics::rival::{Object, PAPER_POLYGONS, Polyhedron, Rival, data_set, polygon_count};
use physics::{Pose, Shape};
use support::Random;

const SIDES: [u32; 6] = [3, 4, 7, 8, 13, 40];

/// A shape with its own formula for "inside": negative inside, zero on the surface, positive outside.
struct Known {
    name: &'static str,
    shape: Shape,
    level: fn(DVec3) -> f64,
}

fn across(p: DVec3) -> f64 {
    p.x.hypot(p.z)
}

fn known() -> Vec<Known> {
    let semi = DVec3::new(0.5, 0.8, 0.3);
    let kind = |name, shape: Result<Shape, _>, level| Known {
        name,
        shape: shape.expect("sizes are positive"),
        level,
    };
    vec![
        kind("sphere", Shape::sphere(0.7), |p| p.length() - 0.7),
        kind("ellipsoid", Shape::ellipsoid(semi), |p| {
            (p / DVec3::new(0.5, 0.8, 0.3)).length() - 1.0
        }),
        kind("truncated", Shape::truncated_ellipsoid(semi, -0.4), |p| {
            ((p / DVec3::new(0.5, 0.8, 0.3)).length() - 1.0).max(-0.4 - p.y)
        }),
        kind("capsule", Shape::capsule(0.3, 0.6), |p| {
            p.distance(DVec3::Y * p.y.clamp(-0.6, 0.6)) - 0.3
        }),
        kind("cylinder", Shape::cylinder(0.4, 0.5), |p| {
            (across(p) - 0.4).max(p.y.abs() - 0.5)
        }),
        kind("frustum", Shape::frustum(0.4, 0.2, 0.5), |p| {
            (across(p) - 0.3 + 0.2 * p.y).max(p.y.abs() - 0.5)
        }),
        kind("cone", Shape::frustum(0.4, 0.0, 0.5), |p| {
            (across(p) - 0.4 * (0.5 - p.y)).max(p.y.abs() - 0.5)
        }),
        kind("cone on its tip", Shape::frustum(0.0, 0.4, 0.5), |p| {
            (across(p) - 0.4 * (0.5 + p.y)).max(p.y.abs() - 0.5)
        }),
        kind("box", Shape::cuboid(semi), |p| {
            (p.abs() - DVec3::new(0.5, 0.8, 0.3)).max_element()
        }),
    ]
}

fn polyhedron(known: &Known, sides: u32) -> Polyhedron {
    Polyhedron::of(&known.shape, sides).expect("a bounded parametric shape")
}

/// Every shape at every fineness.
fn all(mut check: impl FnMut(&Known, &Polyhedron, &str)) {
    for known in known() {
        for sides in SIDES {
            let name = format!("{} of {sides} sides", known.name);
            check(&known, &polyhedron(&known, sides), &name);
        }
    }
}

#[test]
fn polygons_are_as_many_as_announced() {
    for known in known() {
        for sides in SIDES {
            let solid = polyhedron(&known, sides);
            let counted = solid.polygons().count();
            assert_eq!(Some(counted), polygon_count(&known.shape, sides));
            assert_eq!(counted, solid.polygon_count(), "{} {sides}", known.name);
        }
    }
    let cylinder = Shape::cylinder(1.0, 1.0).unwrap();
    assert_eq!(polygon_count(&cylinder, 12), Some(14), "12 sides, two ends");
    let half_space = Shape::half_space(DVec3::Y).unwrap();
    assert!(Polyhedron::of(&half_space, 8).is_none() && polygon_count(&half_space, 8).is_none());
}

#[test]
fn polyhedra_are_closed_and_obey_euler() {
    all(|_, solid, name| {
        let mut directed = HashSet::new();
        for polygon in solid.polygons() {
            for (k, &i) in polygon.iter().enumerate() {
                let j = polygon[(k + 1) % polygon.len()];
                assert!(directed.insert((i, j)), "{name}: edge {i} {j} twice");
            }
        }
        assert!(
            directed.iter().all(|&(i, j)| directed.contains(&(j, i))),
            "{name}: an open edge"
        );
        let edges: HashSet<_> = solid.edges().iter().map(|&[i, j]| (i, j)).collect();
        assert!(edges.iter().all(|edge| directed.contains(edge)), "{name}");
        assert_eq!(2 * edges.len(), directed.len(), "{name}");
        let (v, f) = (solid.vertices().len(), solid.polygon_count());
        assert_eq!(v + f, edges.len() + 2, "{name}: V - E + F = 2");
    });
}

#[test]
fn vertices_lie_on_the_surface_and_behind_every_polygon() {
    all(|known, solid, name| {
        for &v in solid.vertices() {
            let level = (known.level)(v);
            assert!(level.abs() < 1e-15, "{name}: vertex {v} is {level:e} off");
            assert!(
                solid.contains(v * (1.0 - 1e-12)),
                "{name}: not convex at {v}"
            );
        }
        assert!(solid.contains(DVec3::ZERO), "{name}");
    });
}

/// Six times the volume is the sum over triangles of their corners' triple product: only if all face outwards.
fn volume(solid: &Polyhedron) -> f64 {
    let v = |i: u32| solid.vertices()[i as usize];
    let fan = |polygon: &[u32]| -> f64 {
        let triangle = |pair: &[u32]| v(polygon[0]).dot(v(pair[0]).cross(v(pair[1])));
        polygon[1..].windows(2).map(triangle).sum()
    };
    solid.polygons().map(fan).sum::<f64>() / 6.0
}

#[test]
fn volumes_are_those_of_the_closed_forms() {
    let n = 40.0;
    let polygon = 0.5 * n * (TAU / n).sin();
    for known in known() {
        let (exact, tolerance) = match known.name {
            // A prism, and a pyramid, over the regular polygon.
            "cylinder" => (polygon * 0.16, 1e-15),
            "cone" | "cone on its tip" => (polygon * 0.16 / 3.0, 1e-15),
            "frustum" => (polygon * (0.16 + 0.04 + 0.08) / 3.0, 1e-15),
            "box" => (8.0 * 0.5 * 0.8 * 0.3, 1e-15),
            // Inscribed: smaller by 1.1 % of the round part at 40 sides, a share that falls with their square.
            "sphere" => (4.0 / 3.0 * PI * 0.343, 0.016),
            "ellipsoid" => (4.0 / 3.0 * PI * 0.12, 0.006),
            // The cap that y >= -0.4 leaves of a unit sphere stretched by the semi-axes: y from -1/2.
            "truncated" => (0.12 * PI * (1.5 - (1.0 + 0.125) / 3.0), 0.004),
            "capsule" => (PI * 0.09 * 1.2 + 4.0 / 3.0 * PI * 0.027, 0.006),
            other => panic!("no volume for {other}"),
        };
        let got = volume(&polyhedron(&known, 40));
        assert!(
            got <= exact + 1e-15 && got >= exact - tolerance,
            "{}: {got} for {exact}",
            known.name
        );
    }
}

#[test]
fn inside_of_a_prism_is_inside_of_its_polygon() {
    let solid = polyhedron(&known()[4], 7);
    let mut random = Random(0x5eed_0001);
    let mut inside = 0;
    for _ in 0..20_000 {
        let p = random.vector() * DVec3::new(0.5, 0.6, 0.5);
        // A regular polygon with a corner at angle 0: distance along the nearest side's normal.
        let sector = TAU / 7.0;
        let to_middle = p.z.atan2(p.x).rem_euclid(sector) - 0.5 * sector;
        let side = across(p) * to_middle.cos() - 0.4 * (0.5 * sector).cos();
        let level = side.max(p.y.abs() - 0.5);
        if level.abs() > 1e-14 {
            assert_eq!(solid.contains(p), level < 0.0, "seed 0x5eed0001, {p}");
        }
        inside += u32::from(level < 0.0);
    }
    assert!(
        (2_000..18_000).contains(&inside),
        "{inside} of 20,000 inside"
    );
}

#[test]
fn inside_of_a_polyhedron_lies_between_the_shape_and_its_core() {
    all(|known, solid, name| {
        let mut random = Random(0x5eed_0002);
        for _ in 0..500 {
            let p = random.vector();
            if solid.contains(p) {
                assert!((known.level)(p) <= 1e-15, "{name}: {p}, seed 0x5eed0002");
            }
        }
    });
    // Forty sides leave a core of cos(pi / 40) of the cross-section, and as much from pole to pole.
    let core = (PI / 40.0).cos().powi(2);
    for known in known() {
        let solid = polyhedron(&known, 40);
        let mut random = Random(0x5eed_0003);
        for _ in 0..5_000 {
            let p = random.vector();
            if (known.level)(p) < 0.0 {
                assert!(
                    solid.contains(p * core),
                    "{}: {p}, seed 0x5eed0003",
                    known.name
                );
            }
        }
    }
}

#[test]
fn segments_are_found_where_no_end_is_inside() {
    let solid = polyhedron(&known()[8], 3);
    let through = |p: DVec3, q: DVec3| solid.meets_segment(p, q) && solid.meets_segment(q, p);
    assert!(through(
        DVec3::new(-2.0, 0.1, 0.0),
        DVec3::new(2.0, 0.2, 0.1)
    ));
    assert!(through(
        DVec3::new(0.1, 0.1, 0.1),
        DVec3::new(2.0, 0.2, 0.1)
    ));
    let past = |p, q| !solid.meets_segment(p, q) && !solid.meets_segment(q, p);
    assert!(past(DVec3::new(-2.0, 0.9, 0.0), DVec3::new(2.0, 0.9, 0.1)));
    assert!(past(DVec3::new(0.6, -0.9, 0.0), DVec3::new(1.9, 0.9, 0.1)));
    // Past the edge at x = 0.5, y = 0.8, in the box's shadow along every axis.
    assert!(past(DVec3::new(0.4, 1.0, 0.0), DVec3::new(0.7, 0.7, 0.0)));
    assert!(through(
        DVec3::new(0.4, 0.9, 0.0),
        DVec3::new(0.6, 0.6, 0.0)
    ));
}

#[test]
fn crossed_bars_overlap_though_no_corner_is_inside() {
    let lying = Polyhedron::of(&Shape::cuboid(DVec3::new(1.0, 0.1, 0.1)).unwrap(), 3).unwrap();
    let standing = Polyhedron::of(&Shape::cuboid(DVec3::new(0.1, 1.0, 0.1)).unwrap(), 3).unwrap();
    let mut rival = Rival::default();
    let mut overlap = |z: f64| {
        let there = Pose::from_position(DVec3::new(0.0, 0.0, z));
        rival.overlap((&lying, &Pose::IDENTITY), (&standing, &there))
    };
    assert!(overlap(0.0) && overlap(0.15));
    assert!(!overlap(0.25));
}

/// How far the shape reaches beyond its polyhedron in any direction, at most: the largest of many directions, and
/// what the next direction can add.
fn coarseness(shape: &Shape, solid: &Polyhedron) -> f64 {
    let mut random = Random(0x5eed_0004);
    let beyond = |n: DVec3| {
        let reach = solid.vertices().iter().map(|v| n.dot(*v));
        n.dot(shape.support(n)) - reach.fold(f64::NEG_INFINITY, f64::max)
    };
    let largest = (0..2_000).map(|_| beyond(random.direction()));
    largest.fold(0.0, f64::max) * 1.1
}

#[test]
fn rival_sees_what_the_detection_sees() {
    let seed = 0x5eed_0005;
    let mut random = Random(seed);
    let mut rival = Rival::default();
    let fine: Vec<(Known, Polyhedron, f64)> = known()
        .into_iter()
        .map(|known| {
            let solid = polyhedron(&known, 16);
            let coarse = coarseness(&known.shape, &solid);
            (known, solid, coarse)
        })
        .collect();
    let (mut apart, mut overlapping) = (0, 0);
    for (k, (a, solid_a, coarse_a)) in fine.iter().enumerate() {
        for (b, solid_b, coarse_b) in &fine[k..] {
            for _ in 0..100 {
                let pose_a = Pose::new(random.vector(), random.rotation());
                let pose_b = Pose::new(random.vector(), random.rotation());
                let exact = separation(
                    (&a.shape, &pose_a),
                    (&b.shape, &pose_b),
                    None,
                    Limits::default(),
                );
                let found = rival.overlap((solid_a, &pose_a), (solid_b, &pose_b));
                let name = format!("{} {} gap {}, seed {seed:#x}", a.name, b.name, exact.gap);
                // Inscribed polyhedra are apart when the shapes are, and overlap when the shapes overlap by more
                // than both polyhedra lack.
                if exact.gap > 1e-12 {
                    assert!(!found, "{name}");
                    apart += 1;
                } else if exact.gap < -coarse_a - coarse_b {
                    assert!(found, "{name}");
                    overlapping += 1;
                }
                let swapped = rival.overlap((solid_b, &pose_b), (solid_a, &pose_a));
                assert_eq!(found, swapped, "{name}");
            }
        }
    }
    assert!(
        apart > 1_000 && overlapping > 1_000,
        "{apart}, {overlapping}"
    );
}

fn polygons(objects: &[Object]) -> usize {
    let pieces = objects.iter().flat_map(|object| &object.pieces);
    pieces.map(|piece| piece.polyhedron.polygon_count()).sum()
}

#[test]
fn data_sets_have_the_papers_numbers() {
    assert_eq!(PAPER_POLYGONS, [419, 970]);
    for wanted in [118, 119, 419, 970, 971, 1_000, 4_999, 10_000, 100_000] {
        let objects = data_set(wanted).expect("enough polygons");
        assert_eq!(objects.len(), 7);
        let pieces: usize = objects.iter().map(|object| object.pieces.len()).sum();
        assert_eq!(pieces, 22);
        assert_eq!(polygons(&objects), wanted);
    }
    assert!(data_set(117).is_none() && data_set(0).is_none());
}

#[test]
fn data_sets_are_evenly_fine() {
    let objects = data_set(100_000).expect("enough polygons");
    for piece in objects.iter().flat_map(|object| &object.pieces) {
        let solid = &piece.polyhedron;
        let short = coarseness(&piece.shape, solid) / piece.shape.bounding_radius();
        assert!(short < 2e-3, "{:?}: {short}", piece.shape);
    }
}

#[test]
fn objects_overlap_where_a_part_does() {
    let objects = data_set(970).expect("enough polygons");
    let mut rival = Rival::default();
    let seed = 0x5eed_0006;
    let mut random = Random(seed);
    let mut overlaps = 0;
    for _ in 0..300 {
        let (a, b) = (&objects[0], &objects[4]);
        let pose_a = Pose::new(random.vector() * 0.2, random.rotation());
        let pose_b = Pose::new(random.vector() * 0.2, random.rotation());
        let mut deepest = f64::INFINITY;
        for p in &a.pieces {
            for q in &b.pieces {
                let (at_p, at_q) = (pose_a * p.pose, pose_b * q.pose);
                let answer = separation(
                    (&p.shape, &at_p),
                    (&q.shape, &at_q),
                    None,
                    Limits::default(),
                );
                deepest = deepest.min(answer.gap);
            }
        }
        let found = a.place(&pose_a).overlaps(&b.place(&pose_b), |p, q| {
            let (solid_p, solid_q) = (&p.piece.polyhedron, &q.piece.polyhedron);
            rival.overlap((solid_p, &p.pose), (solid_q, &q.pose))
        });
        if deepest > 1e-12 {
            assert!(!found, "gap {deepest}, seed {seed:#x}");
        } else if deepest < -0.01 {
            assert!(found, "gap {deepest}, seed {seed:#x}");
        }
        overlaps += u32::from(found);
    }
    assert!((50..250).contains(&overlaps), "{overlaps} of 300");
}
