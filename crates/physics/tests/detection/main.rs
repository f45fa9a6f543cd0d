//! Detection against closed forms and against a search that shares no code with it.

#[path = "../support/mod.rs"]
mod support;

use glam::{DQuat, DVec3};
use physics::query::{Limits, Separation, separation};
use physics::{Pose, Shape};
use support::Random;

/// A shape as the oracle knows it: support height in the shape's own frame, by formulas of its own.
#[derive(Clone, Copy, Debug)]
enum Known {
    Sphere(f64),
    Ellipsoid(DVec3),
    /// Semi-axes and cut.
    Truncated(DVec3, f64),
    Capsule(f64, f64),
    Frustum(f64, f64, f64),
    Cuboid(DVec3),
}

impl Known {
    fn shape(self) -> Shape {
        match self {
            Known::Sphere(r) => Shape::sphere(r),
            Known::Ellipsoid(a) => Shape::ellipsoid(a),
            Known::Truncated(a, cut) => Shape::truncated_ellipsoid(a, cut),
            Known::Capsule(r, h) => Shape::capsule(r, h),
            Known::Frustum(a, b, h) => Shape::frustum(a, b, h),
            Known::Cuboid(h) => Shape::cuboid(h),
        }
        .expect("sizes are positive")
    }

    fn height(self, n: DVec3) -> f64 {
        let across = n.x.hypot(n.z);
        match self {
            Known::Sphere(r) => r,
            Known::Ellipsoid(a) => (a * n).length(),
            Known::Truncated(a, cut) => {
                // Largest n.p over heights y >= cut: concave in y, so a ternary search finds it.
                let (mut low, mut high) = (cut, a.y);
                let value = |y: f64| {
                    let w = (1.0 - (y / a.y).powi(2)).max(0.0).sqrt();
                    n.y * y + w * (a.x * n.x).hypot(a.z * n.z)
                };
                for _ in 0..200 {
                    let (x, y) = (low + (high - low) / 3.0, high - (high - low) / 3.0);
                    if value(x) < value(y) {
                        low = x
                    } else {
                        high = y
                    }
                }
                value(0.5 * (low + high)).max(value(cut))
            }
            Known::Capsule(r, h) => r + h * n.y.abs(),
            Known::Frustum(a, b, h) => (a * across - h * n.y).max(b * across + h * n.y),
            Known::Cuboid(h) => (h * n.abs()).element_sum(),
        }
    }
}

/// The gap between the tangent planes with normal `n`, from the oracle's own heights.
fn gap_along(a: (Known, Pose), b: (Known, Pose), n: DVec3) -> f64 {
    n.dot(b.1.position - a.1.position)
        - a.0.height(a.1.rotation.conjugate() * n)
        - b.0.height(b.1.rotation.conjugate() * -n)
}

/// Largest gap over all normals, by sampling and a shrinking pattern search from the best samples.
///
/// On a ridge it stops a little low; together with `gap_along` at the answer's own normal it still decides both ways.
fn oracle(a: (Known, Pose), b: (Known, Pose)) -> f64 {
    let gap = |n: DVec3| gap_along(a, b, n);
    let mut samples: Vec<(f64, DVec3)> = (0..1200)
        .map(|i| {
            let y = 1.0 - (2.0 * f64::from(i) + 1.0) / 1200.0;
            let r = (1.0 - y * y).sqrt();
            let (s, c) = (2.399_963_229_728_653 * f64::from(i)).sin_cos();
            let n = DVec3::new(r * c, y, r * s);
            (gap(n), n)
        })
        .collect();
    samples.sort_by(|x, y| y.0.total_cmp(&x.0));
    let mut starts: Vec<DVec3> = Vec::new();
    for (_, n) in samples {
        if starts.iter().all(|s| s.dot(n) < 0.97) {
            starts.push(n);
        }
        if starts.len() == 6 {
            break;
        }
    }
    starts
        .into_iter()
        .map(|n| climb(&gap, n))
        .fold(f64::NEG_INFINITY, f64::max)
}

fn climb(gap: &impl Fn(DVec3) -> f64, start: DVec3) -> f64 {
    let (mut n, mut best, mut h, mut turn) = (start, gap(start), 0.05, 0.0f64);
    while h > 1e-10 {
        let (u, w) = n.any_orthonormal_pair();
        turn += 0.7;
        let mut moved = false;
        for k in 0..8 {
            let (s, c) = (turn + f64::from(k) * std::f64::consts::FRAC_PI_4).sin_cos();
            let m = (n + (u * c + w * s) * h).normalize_or(n);
            let value = gap(m);
            if value > best {
                (n, best, moved) = (m, value, true);
                break;
            }
        }
        h *= if moved { 1.3 } else { 0.6 };
    }
    best
}

fn kinds(random: &mut Random) -> [Known; 7] {
    let mut size = || 0.6 + 0.4 * random.next();
    [
        Known::Sphere(size()),
        Known::Ellipsoid(DVec3::new(size(), size(), size())),
        Known::Capsule(0.5 * size(), size()),
        Known::Frustum(size(), size(), size()),
        Known::Frustum(size(), 0.0, size()),
        Known::Cuboid(DVec3::new(size(), size(), size())),
        {
            let a = DVec3::new(size(), size(), size());
            Known::Truncated(a, -a.y * 0.9 * size())
        },
    ]
}

fn answer(a: (Known, Pose), b: (Known, Pose)) -> Separation {
    let limits = Limits {
        iteration_cap: 40,
        ..Limits::default()
    };
    separation((&a.0.shape(), &a.1), (&b.0.shape(), &b.1), None, limits)
}

/// Two random shapes whose gap is about `gap`.
fn pair(random: &mut Random, i: usize, j: usize, gap: f64) -> ((Known, Pose), (Known, Pose)) {
    let a = (
        kinds(random)[i],
        Pose::new(random.vector(), random.rotation()),
    );
    let b = kinds(random)[j];
    let (direction, rotation) = (random.direction(), random.rotation());
    let (mut low, mut high) = (0.0, 6.0);
    for _ in 0..40 {
        let middle = 0.5 * (low + high);
        let at = Pose::new(a.1.position + direction * middle, rotation);
        if answer(a, (b, at)).gap < gap {
            low = middle
        } else {
            high = middle
        }
    }
    (a, (b, Pose::new(a.1.position + direction * high, rotation)))
}

#[test]
fn gap_agrees_with_the_oracle_when_apart_and_touching() {
    let mut random = Random(88172645463325252);
    let mut worst: f64 = 0.0;
    for i in 0..7 {
        for j in 0..7 {
            for gap in [0.3, 0.02, 1e-3, 1e-5, -1e-6, -1e-3] {
                for _ in 0..2 {
                    let (a, b) = pair(&mut random, i, j, gap);
                    let (found, truth) = (answer(a, b), oracle(a, b));
                    let own = gap_along(a, b, found.normal);
                    worst = worst.max(truth - found.gap).max((own - found.gap).abs());
                    assert!(
                        truth < found.gap + 1e-7 && (own - found.gap).abs() < 1e-9,
                        "{a:?} {b:?}: {} instead of {truth}, {} iterations, capped {}",
                        found.gap,
                        found.iterations,
                        found.capped
                    );
                }
            }
        }
    }
    println!("worst error {worst:.1e} m");
}

#[test]
fn overlap_is_never_overestimated_and_rarely_missed() {
    let mut random = Random(5);
    let (mut cases, mut missed) = (0, 0);
    for i in 0..7 {
        for j in 0..7 {
            for _ in 0..6 {
                let kinds = kinds(&mut random);
                let a = (kinds[i], Pose::new(DVec3::ZERO, random.rotation()));
                let b = (
                    kinds[j],
                    Pose::new(random.vector() * 0.5, random.rotation()),
                );
                let (found, truth) = (answer(a, b), oracle(a, b));
                let own = gap_along(a, b, found.normal);
                assert!(
                    (own - found.gap).abs() < 1e-9,
                    "{a:?} {b:?}: {} is not {own}",
                    found.gap
                );
                assert!((found.normal.length() - 1.0).abs() < 1e-12);
                cases += 1;
                missed += i32::from(found.gap < truth - 1e-6);
            }
        }
    }
    println!("deep: {missed} of {cases} not the shallowest");
    assert!(
        missed * 50 < cases,
        "{missed} of {cases} deep overlaps not the shallowest"
    );
}

#[test]
fn swapping_the_shapes_flips_the_answer_and_moving_both_moves_it() {
    let mut random = Random(3);
    for i in 0..7 {
        for j in 0..7 {
            let (a, b) = pair(&mut random, i, j, 0.01);
            let here = answer(a, b);
            let back = answer(b, a);
            assert!((here.gap - back.gap).abs() < 1e-12, "{a:?} {b:?}");
            assert!((here.normal + back.normal).length() < 1e-5, "{a:?} {b:?}");
            let away = Pose::new(random.vector() * 100.0, random.rotation());
            let moved = answer((a.0, away * a.1), (b.0, away * b.1));
            assert!((here.gap - moved.gap).abs() < 1e-11, "{a:?} {b:?}");
            assert!((away.transform_vector(here.normal) - moved.normal).length() < 1e-5);
            // The closest points are as far apart as the gap says, and along the normal.
            let d = here.point_b - here.point_a;
            assert!(
                (d - here.normal * here.gap).length() < 1e-6,
                "{a:?} {b:?}: {d}"
            );
        }
    }
}

#[test]
fn coincident_centres_give_a_valid_direction_and_the_same_every_time() {
    let mut random = Random(11);
    for (i, a) in kinds(&mut random).into_iter().enumerate() {
        for (j, b) in kinds(&mut random).into_iter().enumerate() {
            for offset in [0.0, 1e-30, 1e-9] {
                let at = Pose::from_position(DVec3::new(offset, 0.0, 0.0));
                let found = answer((a, Pose::IDENTITY), (b, at));
                assert!((found.normal.length() - 1.0).abs() < 1e-12, "{a:?} {b:?}");
                assert!(found.gap < 0.0 && found.gap.is_finite());
                assert_eq!(found, answer((a, Pose::IDENTITY), (b, at)), "{i} {j}");
            }
        }
    }
    let one = Known::Ellipsoid(DVec3::new(0.5, 0.3, 0.7));
    let depth = answer((one, Pose::IDENTITY), (one, Pose::IDENTITY)).gap;
    assert!(
        (depth + 0.6).abs() < 1e-9,
        "the shallowest way out is twice the smallest semi-axis: {depth}"
    );
}

#[test]
fn a_larger_budget_never_gives_a_worse_bound_and_says_when_it_ended_the_search() {
    let mut random = Random(17);
    let mut capped = 0;
    for _ in 0..200 {
        let (a, b) = pair(&mut random, 1, 1, 0.05);
        let mut last = f64::NEG_INFINITY;
        for iteration_cap in [1, 2, 3, 5, 10, 20] {
            let limits = Limits {
                iteration_cap,
                ..Limits::default()
            };
            let found = separation((&a.0.shape(), &a.1), (&b.0.shape(), &b.1), None, limits);
            assert!(
                found.gap >= last - 1e-15,
                "cap {iteration_cap}: {} after {last}",
                found.gap
            );
            assert!(found.iterations <= iteration_cap);
            capped += i32::from(found.capped);
            last = found.gap;
        }
    }
    assert!(
        capped > 100,
        "one or two iterations are not enough for most pairs: {capped}"
    );
}

#[test]
fn apart_is_enough_stops_at_the_first_separating_normal() {
    let (a, b) = (
        Known::Ellipsoid(DVec3::new(0.5, 0.3, 0.7)),
        Known::Frustum(0.3, 0.1, 0.5),
    );
    let at = Pose::new(DVec3::new(2.0, 0.7, -0.4), DQuat::from_rotation_x(0.4));
    let limits = Limits {
        enough: 0.0,
        ..Limits::default()
    };
    let found = separation(
        (&a.shape(), &Pose::IDENTITY),
        (&b.shape(), &at),
        None,
        limits,
    );
    assert!(found.gap > 0.0 && found.iterations == 0);
}

#[test]
fn flat_faces_and_edges_meet_their_closed_forms() {
    let boxes = Known::Cuboid(DVec3::new(1.0, 0.5, 2.0));
    let cylinder = Known::Frustum(0.5, 0.5, 1.0);
    let cone = Known::Frustum(0.5, 0.0, 1.0);
    let upside_down = DQuat::from_rotation_x(std::f64::consts::PI);
    let lying = DQuat::from_rotation_x(std::f64::consts::FRAC_PI_2);
    let at = |x, y, z, q| Pose::new(DVec3::new(x, y, z), q);
    let id = DQuat::IDENTITY;
    for gap in [0.02, 1e-6, 0.0, -1e-6, -0.02] {
        let cases = [
            (
                "cylinder on a box",
                boxes,
                cylinder,
                at(0.2, 1.5 + gap, 0.3, id),
                DVec3::Y,
            ),
            (
                "half over the edge",
                boxes,
                cylinder,
                at(1.2, 1.5 + gap, 0.3, id),
                DVec3::Y,
            ),
            (
                "coaxial cylinders",
                cylinder,
                cylinder,
                at(0.0, 2.0 + gap, 0.0, id),
                DVec3::Y,
            ),
            (
                "side by side",
                cylinder,
                cylinder,
                at(1.0 + gap, 0.3, 0.0, id),
                DVec3::X,
            ),
            (
                "crossed",
                cylinder,
                cylinder,
                at(1.0 + gap, 0.0, 0.0, lying),
                DVec3::X,
            ),
            (
                "lying on a box",
                boxes,
                cylinder,
                at(0.0, 1.0 + gap, 0.0, lying),
                DVec3::Y,
            ),
            (
                "apex on a box",
                boxes,
                cone,
                at(0.1, 1.5 + gap, 0.2, upside_down),
                DVec3::Y,
            ),
            (
                "box on box",
                boxes,
                boxes,
                at(0.3, 1.0 + gap, 0.4, id),
                DVec3::Y,
            ),
        ];
        for (name, a, b, pose, normal) in cases {
            let found = answer((a, Pose::IDENTITY), (b, pose));
            assert!(
                (found.gap - gap).abs() < 1e-12,
                "{name}: {} instead of {gap}",
                found.gap
            );
            assert!(
                (found.normal - normal).length() < 1e-6,
                "{name}: {}",
                found.normal
            );
        }
    }
}
