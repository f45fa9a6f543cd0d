//! What a second of simulated alley costs, and how many times as much it costs rapier3d.
//!
//! `cargo bench -p physics --features peers --bench step -- report [ROUNDS]` measures shots, racks that stand and that sleep, the
//! slowest steps and many lanes against the targets, and writes docs/step.md. Without `report` criterion times a
//! simulated second of each. `run MODEL RATE` is what runs under valgrind.
#![allow(
    clippy::disallowed_methods,
    reason = "a report may come from any library"
)]

#[path = "../../app/shot/clock.rs"]
mod clock;
#[path = "lanes/growth.rs"]
mod growth;
#[path = "query/machine.rs"]
mod machine;
#[path = "step/measure.rs"]
mod measure;
#[path = "step/profile.rs"]
mod profile;
#[path = "step/rapier.rs"]
mod rapier;
#[path = "step/report.rs"]
mod report;
#[path = "step/rounds.rs"]
mod rounds;
#[path = "step/scenes.rs"]
mod scenes;
#[path = "../tests/support/mod.rs"]
mod support;

use criterion::{BatchSize, Criterion};
use rapier::{PEERS, Peer};
use scenes::{MODELS, RATES, counted_steps, rack, shot};

/// Rounds of a report in which the contenders take turns.
const ROUNDS: usize = 11;
/// The throw that criterion times, near the head pin's side.
const THROW: u32 = 11;

/// Criterion's own measurements: a simulated second from the release on, and of a rack that stands awake.
fn groups() {
    let mut criterion = Criterion::default().configure_from_args();
    for rate in RATES {
        let mut group = criterion.benchmark_group(format!("shot, {rate} steps/s"));
        group.sample_size(20);
        for (name, response) in MODELS {
            let make = || shot(response, rate, THROW);
            group.bench_function(name, |b| {
                b.iter_batched(
                    make,
                    |mut world| {
                        counted_steps(&mut world, rate);
                        world
                    },
                    BatchSize::SmallInput,
                )
            });
        }
        for (name, pins) in PEERS {
            let make = || Peer::shot(pins, rate, THROW);
            group.bench_function(format!("peer, {name}"), |b| {
                b.iter_batched(
                    make,
                    |mut peer| {
                        peer.run(rate);
                        peer
                    },
                    BatchSize::SmallInput,
                )
            });
        }
        group.finish();
        let mut group = criterion.benchmark_group(format!("standing awake, {rate} steps/s"));
        group.sample_size(20);
        for (name, response) in MODELS {
            let mut world = rack(response, rate, false);
            group.bench_function(name, |b| b.iter(|| counted_steps(&mut world, rate)));
        }
        for (name, pins) in PEERS {
            let mut peer = Peer::rack(pins, rate, false);
            group.bench_function(format!("peer, {name}"), |b| b.iter(|| peer.run(rate)));
        }
        group.finish();
    }
    criterion.final_summary();
}

fn main() {
    let words: Vec<String> = std::env::args()
        .skip(1)
        .filter(|word| word != "--bench")
        .collect();
    let words: Vec<&str> = words.iter().map(String::as_str).collect();
    match words[..] {
        ["run", model, rate] => {
            profile::run(
                model,
                rate.parse()
                    .expect("the rate is a number of steps per second"),
            );
        }
        ["report"] => report::write(ROUNDS),
        ["report", rounds] => {
            report::write(
                rounds
                    .parse()
                    .expect("the word after `report` counts rounds"),
            );
        }
        _ => groups(),
    }
}
