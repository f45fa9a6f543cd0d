//! What the frame's thread spends on the journal: median, 99th and 99.9th percentile and longest of many frames.
//!
//! Criterion gives means; a hitch is a percentile, so that this bench keeps every single time. Frames come at 120 Hz, as the
//! fastest headsets have them, with head, hand and the hand at the trigger's last change moving and measured.

use std::time::{Duration, Instant};

use bowling_app::journal::{Header, Journal, SCHEMA};
use game::{Event, EventKind, Input, Model, Tracked, TriggerChange, Velocity};
use glam::{DQuat, DVec3};
use physics::Pose;

/// Frames per second [Hz].
const RATE: f64 = 120.0;
/// Seconds that are measured.
const SECONDS: f64 = 20.0;

fn main() {
    // `cargo test --benches` only wants to know that it runs.
    let is_test = !std::env::args().any(|argument| argument == "--bench");
    let frames = if is_test { 10 } else { (RATE * SECONDS) as u32 };
    let folder = tempfile::tempdir().expect("a temporary folder");
    let mut journal =
        Journal::create(&folder.path().join("journal.jsonl"), header()).expect("writable");
    let mut times: Vec<Duration> = Vec::new();
    let begun = Instant::now();
    for frame in 0..frames {
        let input = input(f64::from(frame) / RATE);
        let event = Event {
            step: u64::from(frame),
            kind: EventKind::Impact {
                a: Model::Ball(0),
                b: Model::Pin(1),
                point: DVec3::new(0.1, 0.2, -18.0),
                approach_speed: 7.0 / 3.0,
                impulse: 1.0 / 3.0,
            },
        };
        let before = Instant::now();
        journal.input(&input).expect("writable");
        journal.event(&event).expect("writable");
        times.push(before.elapsed());
        let due = begun + Duration::from_secs_f64(f64::from(frame + 1) / RATE);
        std::thread::sleep(due.saturating_duration_since(Instant::now()));
    }
    times.sort();
    let at = |share: f64| times[((times.len() - 1) as f64 * share) as usize];
    println!(
        "{} frames: median {:?}, 99 % {:?}, 99.9 % {:?}, longest {:?}",
        times.len(),
        at(0.5),
        at(0.99),
        at(0.999),
        at(1.0)
    );
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
