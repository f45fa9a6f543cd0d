//! What must not depend on the step, and what a step costs: sections 6.3 and 6.4.

use std::sync::Arc;
use std::time::Instant;

use glam::DVec3;
use physics::{BodyId, Compound, Response, World};

use super::Case;
use super::findings::{Findings, Outcome, worse};
use super::scene::{
    BALL_RADIUS, Setup, add_alley, add_rack, between, composite_pin, run, throw, tilt,
};
use experiment::random::SplitMix64;

pub const CASES: &[Case] = &[
    Case {
        name: "fallen-pins-converge",
        section: "6.3",
        expected: "the pins down after 1 s do not depend on the step, on average",
        criterion: "1000 shots, 90 against 1440 Hz: means within 0.2, every pin within 3 sigma",
        run: fallen_pins,
    },
    Case {
        name: "even-steps",
        section: "6.4",
        expected: "a frame of a shot takes about as long as any other (peers)",
        criterion: "99th percentile at most 3 medians at 90 Hz",
        run: even_steps,
    },
    Case {
        name: "asleep-costs-nothing",
        section: "6.4",
        expected: "an alley that sleeps costs nearly nothing (Jolt 14 us)",
        criterion: "at most 1 us per simulated second at 90 Hz",
        run: asleep,
    },
];

const SHOTS: u32 = 1000;

fn alley(setup: &Setup, pin: &Arc<Compound>) -> (World, Vec<BodyId>) {
    let mut world = setup.world();
    add_alley(&mut world, setup);
    let pins = add_rack(&mut world, setup, pin);
    (world, pins)
}

/// How often each pin fell in many shots whose scatter a seed decides.
fn fallen(step_hz: f64) -> [u32; 10] {
    let mut setup = Setup::new(Response::Guarded)
        .rate(step_hz)
        .contact(0.49, 0.49);
    setup.sleeping = true;
    let (rack, pins) = alley(&setup, &composite_pin());
    let mut random = SplitMix64::new(63);
    let mut counts = [0; 10];
    for _ in 0..SHOTS {
        let mut world = rack.clone();
        let aside = 0.06 + between(&mut random, -0.06, 0.06);
        let speed = 8.0 + between(&mut random, -0.5, 0.5);
        let ball = throw(&mut world, &setup, aside, 0.3, speed);
        let across = between(&mut random, -0.4, 0.2);
        let body = world.body(ball);
        let (v, w) = (body.linear_velocity(), body.angular_velocity());
        world.set_velocity(
            ball,
            v + DVec3::X * across,
            w - DVec3::Z * (across / BALL_RADIUS),
        );
        run(&mut world, 1.0);
        for (count, id) in counts.iter_mut().zip(&pins) {
            let body = world.body(*id);
            // Leaning, or off the deck.
            *count += u32::from(tilt(body) > 30.0 || body.pose().position.y < 0.1);
        }
    }
    counts
}

fn fallen_pins() -> Outcome {
    let mut findings = Findings::new();
    let (coarse, fine) = (fallen(90.0), fallen(1440.0));
    let mean = |counts: &[u32; 10]| f64::from(counts.iter().sum::<u32>()) / f64::from(SHOTS);
    let (coarse_mean, fine_mean) = (mean(&coarse), mean(&fine));
    let mut most: f64 = 0.0;
    for (a, b) in coarse.iter().zip(&fine) {
        let (a, b) = (f64::from(*a), f64::from(*b));
        let share = (a + b) / f64::from(2 * SHOTS);
        // Of the difference of two counts, each of so many shots.
        let sigma = (2.0 * f64::from(SHOTS) * share * (1.0 - share)).sqrt();
        most = worse(most, (a - b).abs() / sigma.max(1.0));
    }
    findings.note(format!("means {coarse_mean:.3} and {fine_mean:.3} pins"));
    findings.at_most("apart by", (coarse_mean - fine_mean).abs(), 0.2, "pins");
    findings.at_most("a pin by", most, 3.0, "sigma");
    findings.outcome()
}

fn even_steps() -> Outcome {
    let mut findings = Findings::new();
    let setup = Setup::new(Response::Guarded).rate(90.0).contact(0.49, 0.49);
    let (mut world, _) = alley(&setup, &composite_pin());
    throw(&mut world, &setup, 0.05, 1.0, 8.0);
    // The shortest of several runs of the very same step: what else the machine did does not count.
    let mut times = vec![f64::INFINITY; 360];
    for _ in 0..9 {
        let mut world = world.clone();
        for time in &mut times {
            let begun = Instant::now();
            world.step();
            *time = time.min(begun.elapsed().as_secs_f64());
        }
    }
    times.sort_by(f64::total_cmp);
    let (median, late) = (times[times.len() / 2], times[times.len() * 99 / 100]);
    findings.at_most("99th percentile", late / median, 3.0, "medians");
    findings.note(format!("median {:.1} us", 1e6 * median));
    findings.outcome()
}

fn asleep() -> Outcome {
    let mut findings = Findings::new();
    let mut setup = Setup::new(Response::Guarded).rate(90.0).contact(0.49, 0.49);
    setup.sleeping = true;
    let (mut world, pins) = alley(&setup, &composite_pin());
    run(&mut world, 5.0);
    let awake = pins
        .iter()
        .filter(|id| !world.body(**id).is_asleep())
        .count();
    findings.none_of("pins awake after 5 s", awake, pins.len());
    let mut best = f64::INFINITY;
    for _ in 0..50 {
        let begun = Instant::now();
        run(&mut world, 100.0);
        best = best.min(begun.elapsed().as_secs_f64());
    }
    findings.at_most("a second takes", 1e6 * best / 100.0, 1.0, "us");
    findings.outcome()
}
