//! How the cost of a step grows with the number of lanes: 11 bodies that move on one, 2,816 on 256.
//!
//! Budget: the time of a step in which balls fall into all racks grows with the lanes to the power 1.05 at most, and a
//! step in which one lane is awake costs the same among 256 as alone. Fewer lanes than throws are timed in several
//! worlds, so that all numbers of lanes play the same mixture. The exponents are printed before criterion's times.
#![allow(
    clippy::disallowed_methods,
    reason = "a report may come from any library"
)]
#![allow(missing_docs, reason = "criterion's macros make undocumented items")]

#[path = "../../app/shot/clock.rs"]
mod clock;
#[path = "lanes/growth.rs"]
mod growth;
#[path = "../tests/support/mod.rs"]
mod support;

use criterion::{BatchSize, Criterion, criterion_group, criterion_main};
use growth::{Growth, HEAP, shots};
use physics::World;

fn lanes(c: &mut Criterion) {
    let growth = Growth::measure();
    for (lanes, each) in &growth.falling {
        println!("{lanes} lanes: {each:.2} us a step and lane while the pins fall");
    }
    println!("exponent {:.3}", growth.exponent());
    for (lanes, each) in &growth.one_awake {
        println!("one ball rolls on one of {lanes} lanes: {each:.2} us a step");
    }
    let mut group = c.benchmark_group("lanes");
    group.sample_size(10);
    for lanes in [1, 256] {
        let world = shots(lanes).swap_remove(0);
        let step = |mut world: World| {
            for _ in 0..HEAP {
                world.step();
            }
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
