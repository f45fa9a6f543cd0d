//! How much faster than real time is the simulation alone?
//!
//! A whole scripted game of three frames, hand and pinsetter included, without journal and pictures. The budget is 50
//! simulated seconds per second on one core, for either condition.

use std::path::Path;

use bowling_app::devices::script::Velocities;
use bowling_app::rehearsal::rehearse;
use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use game::{Button, Conditions};

const FRAMES: u32 = 3;
const SEED: u64 = 1;

fn simulation(criterion: &mut Criterion) {
    let config = Path::new(env!("CARGO_MANIFEST_DIR")).join("config");
    let conditions = Conditions::load(&config, "alley", &[]).expect("the project's configuration");
    let mut group = criterion.benchmark_group("simulated milliseconds");
    group.sample_size(10);
    for button in Button::BOTH {
        let play = || {
            rehearse(
                &conditions,
                FRAMES,
                SEED,
                Velocities::Measured,
                &[button],
                |_| (),
            )
            .expect("a game")
        };
        let started = std::time::Instant::now();
        let simulated = play().time();
        let factor = simulated / started.elapsed().as_secs_f64();
        println!(
            "{button}: {simulated:.1} simulated seconds, {factor:.0} times as fast as real time"
        );
        // Elements are simulated milliseconds: 50 Kelem/s is the budget.
        group.throughput(Throughput::Elements((1000.0 * simulated) as u64));
        group.bench_function(button.file_stem(), |bencher| bencher.iter(play));
    }
    group.finish();
}

criterion_group!(benches, simulation);
criterion_main!(benches);
