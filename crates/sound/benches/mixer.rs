//! What a block of sound costs. Budget: 10 ms of sound on one core in less than 1 ms, also in a crash of all pins.

use std::hint::black_box;

use criterion::{Criterion, criterion_group, criterion_main};
use sound::{Event, Mixer, Settings, VOICES};

#[path = "../examples/throw/strike.rs"]
#[expect(dead_code, reason = "the bench takes the crash alone")]
mod strike;

/// Samples of 10 ms.
const BLOCK: usize = 480;

fn block(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("10 ms of sound");
    group.bench_function("silence", |bencher| {
        let mut mixer = Mixer::new(&Settings::default());
        let mut out = [[0.0; 2]; BLOCK];
        bencher.iter(|| mixer.render(black_box(&mut out)));
    });
    group.bench_function("a crash, mean of its first half second", |bencher| {
        bencher.iter_batched_ref(
            || {
                let mut mixer = Mixer::new(&Settings::default());
                for event in strike::crash() {
                    let time_s = event.time_s - strike::CRASH_S;
                    mixer.submit(Event { time_s, ..event });
                }
                mixer
            },
            |mixer| {
                let mut out = [[0.0; 2]; BLOCK];
                // Fifty blocks; the figure that is printed is for all of them.
                for _ in 0..50 {
                    mixer.render(black_box(&mut out));
                }
            },
            criterion::BatchSize::LargeInput,
        );
    });
    group.bench_function("every voice at once", |bencher| {
        bencher.iter_batched_ref(
            || {
                let mut mixer = Mixer::new(&Settings::default());
                for event in strike::crash().into_iter().cycle().take(2 * VOICES) {
                    mixer.submit(Event {
                        time_s: 0.0,
                        ..event
                    });
                }
                let mut out = [[0.0; 2]; 64];
                mixer.render(&mut out);
                assert_eq!(mixer.sounding(), VOICES);
                mixer
            },
            |mixer| {
                let mut out = [[0.0; 2]; BLOCK];
                mixer.render(black_box(&mut out));
            },
            criterion::BatchSize::LargeInput,
        );
    });
    group.finish();
}

criterion_group!(benches, block);
criterion_main!(benches);
