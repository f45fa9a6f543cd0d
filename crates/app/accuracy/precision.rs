//! Precision: the innermost formulas in `f32` and in `f64`. The crate itself is `f64` throughout.

use glam::{DMat3, DVec3, Mat3, Vec3};
use physics::query::{Limits, separation};
use physics::{Pose, Shape};

use super::budget::Budget;
use super::kernels::{double, single};
use super::report::{Line, Measure, Point, Reference, Report, largest, p95};
use super::timing::{Task, Time, each, in_turns};
use crate::hard_cases::scene::{G, between, direction, rotation, vector};
use experiment::random::SplitMix64;

pub const NAME: &str = "precision";

const SEED: u64 = 32;
const POSES: usize = 1000;
/// Where the head pin is in the world [m]: what coordinates lose there, differences of them lose too.
const HEAD_PIN: DVec3 = DVec3::new(0.0, 0.15, -18.288);
/// Steps of a flight of 2 s, and the step [s].
const STEPS: u32 = 1440;
const DT: f64 = 1.0 / 720.0;

const MEASURES: [Measure; 2] = [
    Measure {
        name: "length_p95_m",
        words: "gap or place is off by [m]",
        noise: 0.2,
    },
    Measure {
        name: "impulse_p95_share",
        words: "the impulse is off by a share of it",
        noise: 0.2,
    },
];

/// Two ellipsoids put so that their gap is known.
struct Pair {
    squares: [DMat3; 2],
    centres: [DVec3; 2],
    gap: f64,
    /// The same for the query.
    placed: [(Shape, Pose); 2],
}

/// A kernel in both precisions: errors and tasks, `f32` first.
type Both<'a> = ([Vec<f64>; 2], [Task<'a>; 2]);

/// Measures the dial.
pub fn measure(budget: &Budget) -> Report {
    let mut lines = Vec::new();
    let pairs: Vec<Pair> = (0..POSES).map(pair).collect();
    for (name, at) in [
        ("at the origin", DVec3::ZERO),
        ("at the head pin", HEAD_PIN),
    ] {
        let both = ellipsoids(&pairs, at);
        lines.push(line(
            format!("two ellipsoids {name}"),
            "lengths",
            0,
            both,
            budget,
        ));
    }
    let balls: Vec<Ball> = (0..POSES).map(ball).collect();
    lines.push(line(
        "ball and frustum".to_owned(),
        "lengths",
        0,
        frusta(&balls),
        budget,
    ));
    let flights: Vec<[DVec3; 2]> = (0..POSES / 10).map(flight).collect();
    lines.push(line(
        "2 s of flight in steps".to_owned(),
        "lengths",
        0,
        fly(&flights),
        budget,
    ));
    let hits: Vec<Hit> = (0..POSES).map(hit).collect();
    lines.push(line(
        "impulse, Eq. (9)".to_owned(),
        "impulses",
        1,
        impulses(&hits),
        budget,
    ));
    let ratio = |line: &Line| line.points[1].time.median / line.points[0].time.median;
    let ratios: Vec<String> = lines
        .iter()
        .map(|line| format!("{} {:.2}", line.name, ratio(line)))
        .collect();
    let built = pairs.iter().map(|p| (query_gap(p) - p.gap).abs());
    Report {
        dial: NAME,
        title: "precision of the innermost formulas",
        axis: "numbers",
        is_ordered: true,
        measures: MEASURES.to_vec(),
        references: vec![Reference {
            truth: "gaps that the ellipsoids were built with".to_owned(),
            other: "the physics crate's query".to_owned(),
            difference: largest(built),
            allowed: 1e-12,
            unit: "m",
        }],
        findings: vec![format!("f64 takes times f32: {}", ratios.join(", "))],
        lines,
    }
}

fn line(name: String, panel: &str, measure: usize, both: Both, budget: &Budget) -> Line {
    let mut line = Line::new(name, panel, MEASURES.len(), "query");
    line.floors = vec![1e-15, 1e-16];
    line.time_reason = Some("both precisions take as long on this processor");
    let (errors, tasks) = both;
    let times: Vec<Time> = in_turns(budget.rounds, &mut Vec::from(tasks));
    for (index, (found, time)) in errors.into_iter().zip(times).enumerate() {
        let mut errors = vec![f64::INFINITY; MEASURES.len()];
        errors[measure] = p95(found);
        line.points.push(Point {
            setting: ["f32", "f64"][index].to_owned(),
            value: [32.0, 64.0][index],
            is_default: index == 1,
            errors,
            time,
            step_hz: None,
        });
    }
    line
}

fn pair(index: usize) -> Pair {
    let mut random = SplitMix64::for_index(SEED, index as u64);
    let random = &mut random;
    let mut body = || {
        let turn = rotation(random);
        let mut size = || between(random, 0.025, 0.1);
        let semi = DVec3::new(size(), size(), size());
        let shape = Shape::ellipsoid(semi).expect("semi-axes are positive");
        let axes = DMat3::from_quat(turn);
        let square = axes * DMat3::from_diagonal(semi * semi) * axes.transpose();
        (square, shape, turn)
    };
    let bodies = [body(), body()];
    let squares = [bodies[0].0, bodies[1].0];
    let n = direction(random);
    let gap = libm::pow(10.0, between(random, -5.0, -2.0));
    let reach = |square: DMat3| square * n / n.dot(square * n).sqrt();
    let first = vector(random);
    let second = first + reach(squares[0]) + n * gap + reach(squares[1]);
    let [(_, shape_a, turn_a), (_, shape_b, turn_b)] = bodies;
    Pair {
        squares,
        centres: [first, second],
        gap,
        placed: [
            (shape_a, Pose::new(first, turn_a)),
            (shape_b, Pose::new(second, turn_b)),
        ],
    }
}

/// What the crate's own detection says about a pair.
fn query_gap(pair: &Pair) -> f64 {
    let [(a, pose_a), (b, pose_b)] = &pair.placed;
    separation((a, pose_a), (b, pose_b), None, Limits::default()).gap
}

fn ellipsoids(pairs: &[Pair], at: DVec3) -> Both<'_> {
    let halves: Vec<_> = pairs
        .iter()
        .map(|p| {
            (
                p.squares.map(|m| m.as_mat3()),
                p.centres.map(|c| (c + at).as_vec3()),
            )
        })
        .collect();
    let wholes: Vec<_> = pairs
        .iter()
        .map(|p| (p.squares, p.centres.map(|c| c + at)))
        .collect();
    let in_single = |(squares, c): &([Mat3; 2], [Vec3; 2])| {
        f64::from(single::ellipsoids(*squares, c[1] - c[0]).0)
    };
    let in_double =
        |(squares, c): &([DMat3; 2], [DVec3; 2])| double::ellipsoids(*squares, c[1] - c[0]).0;
    let off = |(gap, pair): (f64, &Pair)| (gap - pair.gap).abs();
    let singles = halves.iter().map(in_single).zip(pairs).map(off).collect();
    let doubles = wholes.iter().map(in_double).zip(pairs).map(off).collect();
    (
        [singles, doubles],
        [each(halves, in_single), each(wholes, in_double)],
    )
}

/// A point at a known distance from a frustum's mantle.
struct Ball {
    point: DVec3,
    radii: [f64; 2],
    half: f64,
    distance: f64,
}

fn ball(index: usize) -> Ball {
    let mut random = SplitMix64::for_index(SEED + 1, index as u64);
    let mut size = || between(&mut random, 0.025, 0.1);
    let (low, high, half) = (size(), size(), size());
    let distance = between(&mut random, 1e-5, 1e-2);
    let share = between(&mut random, 0.2, 0.8);
    let slant = (high - low).hypot(2.0 * half);
    let (across, along) = (2.0 * half / slant, (low - high) / slant);
    let radius = low + (high - low) * share + across * distance;
    let height = half * (2.0 * share - 1.0) + along * distance;
    let turn = between(&mut random, 0.0, 6.0);
    Ball {
        point: DVec3::new(radius * libm::cos(turn), height, radius * libm::sin(turn)),
        radii: [low, high],
        half,
        distance,
    }
}

fn frusta(balls: &[Ball]) -> Both<'_> {
    let halves: Vec<_> = balls
        .iter()
        .map(|b| (b.point.as_vec3(), b.radii.map(|r| r as f32), b.half as f32))
        .collect();
    let in_single = |(p, r, h): &(Vec3, [f32; 2], f32)| f64::from(single::frustum(*p, *r, *h));
    let in_double = |b: &Ball| double::frustum(b.point, b.radii, b.half);
    let off = |(found, ball): (f64, &Ball)| (found - ball.distance).abs();
    let singles = halves.iter().map(in_single).zip(balls).map(off).collect();
    let doubles = balls.iter().map(in_double).zip(balls).map(off).collect();
    (
        [singles, doubles],
        [each(halves, in_single), each(balls, in_double)],
    )
}

fn flight(index: usize) -> [DVec3; 2] {
    let mut random = SplitMix64::for_index(SEED + 2, index as u64);
    [HEAD_PIN + vector(&mut random), vector(&mut random) * 8.0]
}

fn fly(flights: &[[DVec3; 2]]) -> Both<'_> {
    let time = f64::from(STEPS) * DT;
    let end = |[from, velocity]: &[DVec3; 2]| {
        *from + *velocity * time + DVec3::NEG_Y * (0.5 * G * time * time)
    };
    let halves: Vec<_> = flights.iter().map(|f| f.map(|v| v.as_vec3())).collect();
    let in_single =
        |[from, velocity]: &[Vec3; 2]| single::flight(*from, *velocity, G as f32, DT as f32, STEPS);
    let in_double = |[from, velocity]: &[DVec3; 2]| double::flight(*from, *velocity, G, DT, STEPS);
    let off = |(found, flight): (DVec3, &[DVec3; 2])| (found - end(flight)).length();
    let singles = halves.iter().map(|half| in_single(half).as_dvec3());
    let singles = singles.zip(flights).map(off).collect();
    let doubles = flights.iter().map(in_double).zip(flights).map(off);
    let doubles = doubles.collect();
    (
        [singles, doubles],
        [each(halves, in_single), each(flights, in_double)],
    )
}

/// An impact whose answer is known because the bodies are balls: the compliance is a diagonal in the contact's frame.
struct Hit {
    normal: DVec3,
    slip: DVec3,
    k: DMat3,
    truth: DVec3,
}

const PAIR: (f64, f64) = (0.49, 0.49);

fn hit(index: usize) -> Hit {
    let mut random = SplitMix64::for_index(SEED + 3, index as u64);
    let normal = direction(&mut random);
    let (along, across) = (
        between(&mut random, 0.5, 2.0),
        between(&mut random, 1.0, 5.0),
    );
    let outer = DMat3::from_cols(normal * normal.x, normal * normal.y, normal * normal.z);
    let k = DMat3::from_diagonal(DVec3::splat(across)) + outer * (along - across);
    let mut slip = vector(&mut random) * 8.0;
    if slip.dot(normal) < 0.0 {
        slip = -slip;
    }
    let (e, mu) = PAIR;
    let approach = slip.dot(normal);
    let pressing = normal * (-approach / along);
    let rub = -(slip - normal * approach) / across;
    Hit {
        normal,
        slip,
        k,
        truth: pressing * ((1.0 + e) * (1.0 - mu) + mu) + rub * mu,
    }
}

fn impulses(hits: &[Hit]) -> Both<'_> {
    let (e, mu) = PAIR;
    let halves: Vec<_> = hits
        .iter()
        .map(|h| (h.normal.as_vec3(), h.slip.as_vec3(), h.k.as_mat3()))
        .collect();
    let in_single =
        move |(n, dv, k): &(Vec3, Vec3, Mat3)| single::impulse(*n, *dv, *k, e as f32, mu as f32);
    let in_double = move |h: &Hit| double::impulse(h.normal, h.slip, h.k, e, mu);
    let off = |(found, hit): (DVec3, &Hit)| (found - hit.truth).length() / hit.truth.length();
    let singles = halves.iter().map(|half| in_single(half).as_dvec3());
    let singles = singles.zip(hits).map(off).collect();
    let doubles = hits.iter().map(in_double).zip(hits).map(off).collect();
    (
        [singles, doubles],
        [each(halves, in_single), each(hits, in_double)],
    )
}
