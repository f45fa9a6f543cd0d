//! *Bouncing*: frictionless balls fall from 5 m.

use glam::DVec3;

use super::{Form, GRAVITY, Scenario, Simulated, Thing, lines};
use crate::accuracy::budget::Budget;
use crate::accuracy::report::{Line, Measure, Reason, Reference, Report, largest};

pub const NAME: &str = "bouncing";

const RADIUS: f64 = 0.1;
const HEIGHT: f64 = 5.0;
const MASS: f64 = 10.0;
/// Balls along each side.
const SIDE: u32 = 7;
const RESTITUTIONS: [f64; 4] = [0.0, 0.5, 0.8, 1.0];
/// Step of the integration [s].
const FINE: f64 = 2e-6;

const MEASURES: [Measure; 2] = [
    Measure {
        name: "height_rms_m",
        words: "heights are off by [m], root of mean square",
        noise: 1.0,
    },
    Measure {
        name: "energy_rms_share",
        words: "energy is off by a share of the first, root of mean square",
        noise: 1.0,
    },
];

const EXACT: &str = "flight is a parabola in closed form and a bounce is found at its own time, whatever the step; what is left is where \
within the contact distance of 1e-7 m each is found, and that bounces end below what gravity makes in 1/360 s";

/// Measures the scenario.
pub fn measure(budget: &Budget) -> Report {
    let mut all: Vec<Line> = Vec::new();
    let duration = 10.0 * budget.share;
    for e in RESTITUTIONS {
        let scenario = scenario(e, duration);
        let error = |scene: &mut dyn Simulated, hz: f64| error(scene, &scenario, hz);
        let panel = format!("restitution {e}");
        all.extend(lines(&panel, &scenario, &MEASURES, budget, error));
    }
    for line in &mut all {
        line.floors = vec![1e-9, 1e-10];
        line.reasons = [1e-5, 1e-6]
            .map(|most| Some(Reason::up_to(most, EXACT)))
            .to_vec();
    }
    let apart = RESTITUTIONS.map(|e| (height(e, duration) - integrated(e, duration)).abs());
    Report {
        dial: NAME,
        title: "SimBenchmark: 49 frictionless balls dropped from 5 m",
        axis: "step",
        is_ordered: true,
        measures: MEASURES.to_vec(),
        lines: all,
        references: vec![Reference {
            truth: "the height after the whole time, by the series of bounces".to_owned(),
            other: "by integration in steps of 2 us".to_owned(),
            difference: largest(apart),
            allowed: 1e-2,
            unit: "m",
        }],
        findings: Vec::new(),
    }
}

fn scenario(restitution: f64, duration: f64) -> Scenario {
    let places = (0..SIDE).flat_map(|i| (0..SIDE).map(move |j| (f64::from(i), f64::from(j))));
    let things = places.map(|(i, j)| Thing {
        form: Form::Ball(RADIUS),
        mass: MASS,
        at: DVec3::new(2.0 * i, HEIGHT, 2.0 * j),
    });
    Scenario {
        things: things.collect(),
        friction: [0.0; 2],
        restitution,
        force: DVec3::ZERO,
        duration,
    }
}

/// Height of a ball's centre and its speed at a time [m], [m/s]: parabolas between bounces that lose a share.
fn state(e: f64, time: f64) -> (f64, f64) {
    let fall = HEIGHT - RADIUS;
    let first = (2.0 * fall / GRAVITY).sqrt();
    if time < first {
        return (HEIGHT - 0.5 * GRAVITY * time * time, GRAVITY * time);
    }
    let mut speed = GRAVITY * first * e;
    let mut left = time - first;
    loop {
        let hop = 2.0 * speed / GRAVITY;
        if hop < 1e-12 {
            return (RADIUS, 0.0);
        }
        if left <= hop {
            let height = RADIUS + speed * left - 0.5 * GRAVITY * left * left;
            return (height, speed - GRAVITY * left);
        }
        left -= hop;
        speed *= e;
    }
}

fn height(e: f64, time: f64) -> f64 {
    state(e, time).0
}

/// The same height in small steps.
fn integrated(e: f64, time: f64) -> f64 {
    let (mut y, mut v) = (HEIGHT - RADIUS, 0.0);
    for _ in 0..(time / FINE).round() as u64 {
        y += v * FINE - 0.5 * GRAVITY * FINE * FINE;
        v -= GRAVITY * FINE;
        if y < 0.0 && v < 0.0 {
            // Back to the touch, and on with what is left of the step.
            let late = (y / v).min(FINE);
            v = -e * (v + GRAVITY * late);
            y = v * late - 0.5 * GRAVITY * late * late;
            v -= GRAVITY * late;
            if y < 0.0 {
                (y, v) = (0.0, 0.0);
            }
        }
    }
    y + RADIUS
}

/// Errors of height [m] and of energy over all steps; all balls do the same, so one is looked at.
fn error(scene: &mut dyn Simulated, scenario: &Scenario, hz: f64) -> Vec<f64> {
    let (mut heights, mut energies, mut count) = (0.0, 0.0, 0);
    let balls = f64::from(SIDE * SIDE);
    let whole = balls * MASS * GRAVITY * HEIGHT;
    for step in 1..=(scenario.duration * hz).round() as u32 {
        scene.step();
        let (height, speed) = state(scenario.restitution, f64::from(step) / hz);
        let energy = balls * MASS * (GRAVITY * height + 0.5 * speed * speed);
        heights += (scene.state(0).0.y - height).powi(2);
        energies += ((scene.energy() - energy) / whole).powi(2);
        count += 1;
    }
    [heights, energies]
        .map(|sum| (sum / f64::from(count)).sqrt())
        .to_vec()
}
