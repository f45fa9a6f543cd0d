//! How the cost of a step grows with the number of lanes: 11 bodies that move on one, 2,816 on 256.
//!
//! Budget: the time of a step in which balls fall into all racks grows with the lanes to the power 1.05 at most, and a
//! step in which one lane is awake costs the same among 256 as alone. Fewer lanes than throws are timed in several
//! worlds, so that all numbers of lanes play the same mixture. The exponents are printed before criterion's times.
#![allow(missing_docs, reason = "criterion's macros make undocumented items")]

#[path = "../tests/support/mod.rs"]
mod support;

use std::sync::LazyLock;
use std::time::Instant;

use criterion::{BatchSize, Criterion, criterion_group, criterion_main};
use physics::{Settings, World};
use support::{LANE_SPACING, alleys, composite_pin, material, throw};

const LANES: [u32; 5] = [1, 4, 16, 64, 256];
/// Different throws.
const THROWS: u32 = 16;
/// Steps from the release, a metre before the head pin, until shortly before the hit, and those that are timed.
const APPROACH: u32 = 60;
const HEAP: u32 = 180;

fn run(world: &mut World, steps: u32) {
    for _ in 0..steps {
        world.step();
    }
}

/// Worlds that together have every throw equally often, their balls about to hit.
fn shots(lanes: u32) -> Vec<World> {
    let m = material(0.7, 0.7);
    let make = |first: u32| {
        let mut world = alleys(lanes, Settings::default(), &composite_pin(), m);
        for lane in 0..lanes {
            let share = f64::from((lane + first) % THROWS) / f64::from(THROWS);
            let x = LANE_SPACING * f64::from(lane) + 0.02 + 0.05 * share;
            throw(&mut world, m, x, 1.0, 8.0);
        }
        run(&mut world, APPROACH);
        world
    };
    (0..(THROWS / lanes).max(1))
        .map(|i| make(i * lanes))
        .collect()
}

/// A ball that rolls down one lane for long, all racks asleep.
fn one_awake(lanes: u32) -> World {
    let m = material(0.7, 0.7);
    let mut world = alleys(lanes, Settings::default(), &composite_pin(), m);
    run(&mut world, 360);
    throw(&mut world, m, 0.05, 17.0, 6.0);
    run(&mut world, 2);
    world
}

/// Seconds that this thread has run: processor time where the system tells it (Linux), so that what else the machine
/// does is not counted against the longer runs.
fn clock() -> f64 {
    static START: LazyLock<Instant> = LazyLock::new(Instant::now);
    let told = std::fs::read_to_string("/proc/thread-self/schedstat").ok();
    let nanoseconds = told.and_then(|t| t.split(' ').next()?.parse::<f64>().ok());
    nanoseconds.map_or_else(|| START.elapsed().as_secs_f64(), |ns| 1e-9 * ns)
}

/// Time of a step [us], per lane that is awake: the least of five means over at least 0.2 s.
///
/// Shorter stretches mean nothing: the processor time is only counted up a few hundred times a second.
fn best(worlds: &[World], steps: u32, awake: u32) -> f64 {
    let mean = || {
        let (mut seconds, mut runs) = (0.0, 0);
        while seconds < 0.2 {
            let mut copies: Vec<World> = (0..32).flat_map(|_| worlds).take(32).cloned().collect();
            if awake > 16 {
                copies.truncate(1);
            }
            let start = clock();
            copies.iter_mut().for_each(|world| run(world, steps));
            seconds += clock() - start;
            runs += copies.len() as u32;
        }
        1e6 * seconds / f64::from(steps * awake * runs)
    };
    (0..5).map(|_| mean()).fold(f64::INFINITY, f64::min)
}

/// Slope of the straight line nearest to the points (lanes, total time), both as logarithms.
fn exponent(points: &[(u32, f64)]) -> f64 {
    let logs: Vec<(f64, f64)> = points
        .iter()
        .map(|(lanes, each)| (f64::from(*lanes).ln(), (f64::from(*lanes) * each).ln()))
        .collect();
    let count = logs.len() as f64;
    let mean = logs
        .iter()
        .fold((0.0, 0.0), |s, p| (s.0 + p.0 / count, s.1 + p.1 / count));
    let rise: f64 = logs.iter().map(|p| (p.0 - mean.0) * (p.1 - mean.1)).sum();
    let run: f64 = logs.iter().map(|p| (p.0 - mean.0) * (p.0 - mean.0)).sum();
    rise / run
}

fn lanes(c: &mut Criterion) {
    let mut points = Vec::new();
    for lanes in LANES {
        let each = best(&shots(lanes), HEAP, lanes);
        println!("{lanes} lanes: {each:.2} us a step and lane while the pins fall");
        points.push((lanes, each));
    }
    println!("exponent {:.3}", exponent(&points));
    for lanes in LANES {
        let each = best(&[one_awake(lanes)], 1000, 1);
        println!("one ball rolls on one of {lanes} lanes: {each:.2} us a step");
    }
    let mut group = c.benchmark_group("lanes");
    group.sample_size(10);
    for lanes in [1, 256] {
        let world = shots(lanes).swap_remove(0);
        let step = |mut world: World| {
            run(&mut world, HEAP);
            world
        };
        group.bench_function(format!("{lanes}, {HEAP} steps while the pins fall"), |b| {
            b.iter_batched(|| world.clone(), step, BatchSize::LargeInput)
        });
    }
    group.finish();
}

criterion_group!(benches, lanes);
criterion_main!(benches);
