//! What a second of simulated alley costs. Divide the times by ten: each case runs a tenth of a second.
//!
//! Budgets per simulated second on one core: shot 5 ms, standing awake 1 ms, asleep 0.05 ms. A whole game at 50 times
//! real time may take 20 ms per second, everything included.
#![allow(missing_docs, reason = "criterion's macros make undocumented items")]

#[path = "../tests/support/mod.rs"]
mod support;

use criterion::{BatchSize, Criterion, criterion_group, criterion_main};
use physics::{Effect, Effects, Settings, World};
use support::{alley, composite_pin, ellipsoid_pin, material, throw};

const TENTH: u32 = 9;
/// Steps per second, those of a display.
const RATE: f64 = 90.0;

fn settings(sleeping: bool) -> Settings {
    Settings {
        step_hz: RATE,
        effects: Effects::default().set(Effect::Sleeping, sleeping),
        ..Settings::default()
    }
}

fn run(world: &mut World, steps: u32) {
    for _ in 0..steps {
        world.step();
    }
}

fn bench(c: &mut Criterion, name: &str, world: &World) {
    let step = |mut world: World| {
        run(&mut world, TENTH);
        world
    };
    c.bench_function(name, |b| {
        b.iter_batched(|| world.clone(), step, BatchSize::SmallInput)
    });
}

fn steps(c: &mut Criterion) {
    let m = material(0.7, 0.7);
    for (pins, name) in [
        (composite_pin(), "composite"),
        (ellipsoid_pin(), "ellipsoid"),
    ] {
        let (mut world, _) = alley(settings(true), &pins, m);
        throw(&mut world, m, 0.05, 1.0, 8.0);
        // The ball is on its way, the rack untouched; then the worst tenth of a second, and the heap it leaves.
        run(&mut world, 8);
        bench(c, &format!("{name}/shot, first tenth"), &world);
        run(&mut world, 38);
        bench(c, &format!("{name}/shot, half a second later"), &world);

        let (mut world, _) = alley(settings(false), &pins, m);
        run(&mut world, 90);
        bench(c, &format!("{name}/standing awake"), &world);

        let (mut world, _) = alley(settings(true), &pins, m);
        run(&mut world, 90);
        bench(c, &format!("{name}/asleep"), &world);
    }
}

criterion_group!(benches, steps);
criterion_main!(benches);
