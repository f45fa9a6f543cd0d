//! What the frame's thread spends on the journal: median, 99th and 99.9th percentile and longest of many frames.
//!
//! Criterion gives means; a hitch is a percentile, so that this bench keeps every single time. Frames come at 120 Hz, as the
//! fastest headsets have them, with head, hand and the hand at the trigger's last change moving and measured, an event, and
//! the headset's line on the frame. Between two frames the same thread spends the median time of the first second on nothing at all: what that
//! takes at the same percentiles is the machine's.

use std::time::{Duration, Instant};

use bowling_app::journal::{Header, Journal, SCHEMA, Said};
use game::{Event, EventKind, Input, Model, Tracked, TriggerChange, Velocity};
use glam::{DQuat, DVec3};
use physics::Pose;
use serde_json::json;

/// Frames per second [Hz].
const RATE: f64 = 120.0;
/// Frames before any is counted: a second.
const WARM_UP: u32 = 120;
/// Seconds that are measured.
const SECONDS: f64 = 60.0;

fn main() {
    // `cargo test --benches` only wants to know that it runs.
    let is_test = !std::env::args().any(|argument| argument == "--bench");
    let frames = if is_test { 10 } else { (RATE * SECONDS) as u32 };
    let folder = tempfile::tempdir().expect("a temporary folder");
    let mut journal =
        Journal::create(&folder.path().join("journal.jsonl"), header()).expect("writable");
    let begun = Instant::now();
    let wait = |ticks: f64| {
        let due = begun + Duration::from_secs_f64(ticks / RATE);
        std::thread::sleep(due.saturating_duration_since(Instant::now()));
    };
    let mut warm_up = Times::default();
    let first = WARM_UP.min(frames);
    for frame in 0..first {
        wait(f64::from(frame));
        let seen = Seen::new(frame);
        warm_up.take(|| seen.log(&mut journal));
    }
    let usual = warm_up.at(0.5);
    let (mut logging, mut nothing) = (Times::default(), Times::default());
    for frame in first..first + frames {
        wait(f64::from(frame));
        let seen = Seen::new(frame);
        logging.take(|| seen.log(&mut journal));
        wait(f64::from(frame) + 0.5);
        nothing.take(|| spend(usual));
    }
    println!("logging: {logging}");
    println!("nothing: {nothing}");
}

/// A frame in a headset.
struct Seen {
    frame: u32,
    input: Input,
    event: Event,
}

impl Seen {
    fn new(frame: u32) -> Self {
        let kind = EventKind::Impact {
            a: Model::Ball(0),
            b: Model::Pin(1),
            point: DVec3::new(0.1, 0.2, -18.0),
            approach_speed: 7.0 / 3.0,
            impulse: 1.0 / 3.0,
        };
        let step = u64::from(frame);
        Self {
            frame,
            input: input(f64::from(frame) / RATE),
            event: Event { step, kind },
        }
    }

    /// Has written what is written of it.
    fn log(self, journal: &mut Journal) {
        let frame = self.frame;
        let line = Said::later(move || {
            json!({ "frame": {
                "xr_time_ns": i64::from(frame) * 8_333_333,
                "period_ms": 8.333,
                "prediction_ms": 25.417,
                "simulated_ms": 1.234,
                "taken_ms": 4.567,
                "missed": 0,
                "shown": true,
            }})
        });
        journal
            .input(&self.input)
            .and_then(|()| journal.event(&self.event))
            .and_then(|()| journal.device(line))
            .expect("writable");
    }
}

/// Lets time pass without the system's help.
fn spend(time: Duration) {
    let begun = Instant::now();
    while begun.elapsed() < time {
        std::hint::spin_loop();
    }
}

/// How long something took, again and again.
#[derive(Default)]
struct Times(Vec<Duration>);

impl Times {
    fn take(&mut self, work: impl FnOnce()) {
        let begun = Instant::now();
        work();
        self.0.push(begun.elapsed());
    }

    fn at(&self, share: f64) -> Duration {
        let mut sorted = self.0.clone();
        sorted.sort();
        sorted[((sorted.len() - 1) as f64 * share) as usize]
    }
}

impl std::fmt::Display for Times {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(
            f,
            "{} frames: median {:.1?}, 99 % {:.1?}, 99.9 % {:.1?}, longest {:.1?}",
            self.0.len(),
            self.at(0.5),
            self.at(0.99),
            self.at(0.999),
            self.at(1.0)
        )
    }
}

fn header() -> Header {
    Header {
        schema: SCHEMA,
        program: "bench".to_owned(),
        commit: "unknown".to_owned(),
        device: "headset".to_owned(),
        seed: 1,
        rate_hz: RATE,
        display: "modern".to_owned(),
        frames: 10,
        scene: "alley".to_owned(),
        conditions: None,
        settings_digest: None,
        continues: None,
    }
}

fn input(time: f64) -> Input {
    let tracked = Tracked {
        pose: Pose {
            position: DVec3::new(time.sin(), 1.6, time.cos()),
            rotation: DQuat::from_rotation_y(time),
        },
        velocity: Some(Velocity {
            linear: DVec3::new(time.cos(), 0.1, -time.sin()),
            angular: DVec3::Y,
        }),
    };
    Input {
        head: Some(tracked),
        hand: Some(tracked),
        trigger: 0.5,
        steps: 6,
        trigger_change: Some(TriggerChange {
            age_s: 0.01,
            hand: tracked,
        }),
        ..Input::default()
    }
}
