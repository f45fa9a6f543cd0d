//! The length of a step, 1/60 to 1/5760 s: first hits, a ball's path, energy, and distributions of fallen pins.

use std::sync::Arc;

use physics::{Response, World};

use super::budget::Budget;
use super::hits::{self, After, How, Throw};
use super::profile::Profile;
use super::racks::{self, Rack};
use super::report::{Line, Measure, Point, Reason, Reference, Report, p95};
use super::slide;
use super::timing::{Task, Time, each, in_turns};
use crate::hard_cases::scene::{Setup, add_alley, add_rack, close_alley, composite_pin, throw};

pub const NAME: &str = "step";

/// Steps per second, coarsest first [1/s].
pub const RATES: [f64; 8] = [60.0, 90.0, 180.0, 360.0, 720.0, 1440.0, 2880.0, 5760.0];
/// The rate that the program runs with [1/s].
pub const DEFAULT: f64 = 720.0;
/// Slices of the pin that is hit.
const SLICES: usize = 48;
/// Difference of first hits and their calculation that rounding and the contact distance of 1e-7 m make [m/s], [rad/s].
pub const HIT_FLOORS: [f64; 2] = [1e-4, 2e-3];

const MEASURES: [Measure; 4] = [
    Measure {
        name: "velocity_p95_mps",
        words: "the pin's velocity just after the first hit is off by [m/s]",
        noise: 0.2,
    },
    Measure {
        name: "path_m",
        words: "the ball's place after 2 s is off by [m]",
        noise: 0.2,
    },
    Measure {
        name: "energy_drift_share",
        words: "largest change of energy, as a share, of a shot without losses",
        noise: 1.0,
    },
    Measure {
        name: "fallen_distance_pins",
        words: "distance of the distributions of fallen pins [pins]",
        noise: 1.0,
    },
];

const EXACT_HIT: &str = "contacts are found at their own time inside a step, so a first hit is the same whatever the step";
const SLOW: &str = "an impact slower than gravity makes in 1/360 s gives nothing back, by design; whether a shot has one is chance";
const STRETCHES: &str = "a step of 1/60 s is carried in two stretches of 1/120 s, which are finer than the one of 1/90 s";

/// Measures the dial.
pub fn measure(budget: &Budget) -> Report {
    let mut report = Report {
        dial: NAME,
        title: "length of a step",
        axis: "step",
        is_ordered: true,
        measures: MEASURES.to_vec(),
        lines: Vec::new(),
        references: Vec::new(),
        findings: Vec::new(),
    };
    first_hits(&mut report, budget);
    for response in [Response::Coulomb, Response::Guarded] {
        path(&mut report, response, budget);
    }
    energy(&mut report, budget);
    fallen(&mut report, budget);
    report
}

/// A point of the dial at which one measure was taken.
pub fn point(hz: f64, measures: usize, measure: usize, error: f64, time: Time) -> Point {
    let mut errors = vec![f64::INFINITY; measures];
    errors[measure] = error;
    Point {
        setting: format!("1/{hz} s"),
        value: hz,
        is_default: hz == DEFAULT,
        errors,
        time,
        step_hz: Some(hz),
    }
}

/// Times of many hits, by settings [ns per simulated second].
pub fn time_hits(
    hows: &[How],
    pin: &Arc<physics::Compound>,
    throws: &[Throw],
    rounds: usize,
) -> Vec<Time> {
    let worlds: Vec<_> = hows
        .iter()
        .map(|how| (*how, hits::world(*how, pin)))
        .collect();
    let tasks = worlds.iter().map(|(how, (world, id))| {
        each(throws, move |throw| {
            hits::simulated(world, *id, *how, throw)
        })
    });
    let times = in_turns(rounds, &mut tasks.collect::<Vec<_>>());
    times
        .into_iter()
        .map(|time| time.per(hits::HIT_S))
        .collect()
}

fn first_hits(report: &mut Report, budget: &Budget) {
    let profile = Profile::specification().slices(SLICES);
    let pin = Arc::new(profile.compound());
    let throws: Vec<Throw> = (0..budget.hits).map(hits::throw).collect();
    let truths: Vec<Option<After>> = throws.iter().map(|t| hits::expected(&profile, t)).collect();
    let hows = RATES.map(|step_hz| How {
        response: Response::Guarded,
        step_hz,
        is_continuous: true,
    });
    let mut line = Line::new(
        "guarded, no friction",
        "first hit",
        MEASURES.len(),
        "simulated second",
    );
    line.floors[0] = HIT_FLOORS[0];
    line.reasons[0] = Some(Reason::up_to(1e-3, EXACT_HIT));
    let times = time_hits(
        &hows,
        &pin,
        &throws[..throws.len().min(20)],
        budget.scene_rounds,
    );
    for (how, time) in hows.iter().zip(times) {
        let (world, id) = hits::world(*how, &pin);
        let apart = throws.iter().zip(&truths).map(|(throw, truth)| {
            hits::difference(hits::simulated(&world, id, *how, throw).0, *truth)[0]
        });
        let error = p95(apart.collect());
        line.points
            .push(point(how.step_hz, MEASURES.len(), 0, error, time));
    }
    report.references.push(Reference {
        truth: "first hits by sphere tracing of the profile and one line of algebra".to_owned(),
        other: "the finest step".to_owned(),
        difference: line.points.last().map_or(f64::INFINITY, |p| p.errors[0]),
        allowed: HIT_FLOORS[0],
        unit: "m/s",
    });
    report.lines.push(line);
}

fn path(report: &mut Report, response: Response, budget: &Budget) {
    let name = match response {
        Response::Coulomb => "coulomb",
        _ => "guarded",
    };
    let truth = slide::place(response);
    let integrated = slide::integrated(response);
    let mut line = Line::new(name, "sliding ball", MEASURES.len(), "simulated second");
    // The distance at which bodies count as touching.
    line.floors[1] = 1e-7;
    line.reasons[1] = Some(Reason::up_to(1e-4, STRETCHES));
    let tasks = RATES.map(|hz| -> Task {
        Box::new(move || {
            std::hint::black_box(slide::simulated(response, hz));
            slide::DURATION as u64
        })
    });
    let mut tasks = Vec::from(tasks);
    let times = in_turns(budget.rounds, &mut tasks);
    for (hz, time) in RATES.into_iter().zip(times) {
        let error = (slide::simulated(response, hz) - truth).abs();
        line.points.push(point(hz, MEASURES.len(), 1, error, time));
    }
    report.lines.push(line);
    report.references.push(Reference {
        truth: format!("{name}: the sliding ball's place in closed form"),
        other: "the equation of motion in two million steps".to_owned(),
        difference: (integrated - truth).abs(),
        allowed: 1e-5,
        unit: "m",
    });
}

/// A shot at a rack in a closed room in which nothing is lost.
fn shot(hz: f64) -> World {
    let setup = Setup::new(Response::Guarded).rate(hz).contact(1.0, 0.0);
    let mut world = setup.world();
    add_alley(&mut world, &setup);
    close_alley(&mut world, &setup);
    add_rack(&mut world, &setup, &composite_pin());
    throw(&mut world, &setup, 0.05, 1.0, 8.0);
    world
}

fn energy(report: &mut Report, budget: &Budget) {
    let duration = 2.0 * budget.share;
    // Largest change of energy, and largest gain, as shares.
    let drift = |hz: f64| {
        let mut world = shot(hz);
        let before = world.energy();
        let (mut most, mut gain) = (0.0_f64, 0.0_f64);
        for _ in 0..(duration * hz) as u64 {
            world.step();
            let change = world.energy() / before - 1.0;
            (most, gain) = (most.max(change.abs()), gain.max(change));
        }
        (most, gain)
    };
    let mut line = Line::new(
        "guarded, elastic, no friction",
        "elastic shot",
        MEASURES.len(),
        "simulated second",
    );
    // What 1e5 impacts' rounding adds up to.
    line.floors[2] = 1e-12;
    line.reasons[2] = Some(Reason::up_to(1e-5, SLOW));
    let mut gains = 0.0_f64;
    let tasks = RATES.map(|hz| -> Task {
        Box::new(move || {
            let mut world = shot(hz);
            for _ in 0..(duration * hz) as u64 {
                world.step();
            }
            1
        })
    });
    let mut tasks = Vec::from(tasks);
    let times = in_turns(budget.scene_rounds, &mut tasks);
    for (hz, time) in RATES.into_iter().zip(times) {
        let (most, gain) = drift(hz);
        gains = gains.max(gain);
        let time = time.per(duration);
        line.points.push(point(hz, MEASURES.len(), 2, most, time));
    }
    report.findings.push(format!(
        "an elastic shot of {duration} s gains at most {gains:.1e} of its energy at any step"
    ));
    report.lines.push(line);
}

fn fallen(report: &mut Report, budget: &Budget) {
    let racks = RATES.map(|step_hz| Rack {
        response: Response::Guarded,
        step_hz,
        contact: (0.49, 0.49),
        pin: composite_pin(),
        seed: 1,
    });
    let finest = &racks[RATES.len() - 1];
    let name = "at the finest step";
    let compared = racks::compare(racks.to_vec(), finest, name, budget.throws, 5);
    let (all, reference, noise) = (&compared.samples, &compared.reference, compared.noise);
    let mut line = Line::new(
        "guarded",
        "jittered throws",
        MEASURES.len(),
        "simulated second",
    );
    line.floors[3] = noise;
    line.reasons[3] = Some(Reason::up_to(
        2.0 * noise,
        "the scatter of samples of this size, not the step",
    ));
    for (hz, fallen) in RATES.into_iter().zip(all) {
        let error = fallen.distance(reference);
        line.points
            .push(point(hz, MEASURES.len(), 3, error, fallen.time));
    }
    report.references.push(compared.check);
    report.findings.push(format!(
        "fallen pins at 1/60 s are {:.3} pins from those at 1/{} s, where two samples of {} throws differ by up to {noise:.3}; means {:.2} and {:.2}",
        line.points[0].errors[3],
        finest.step_hz,
        budget.throws,
        all[0].mean(),
        reference.mean()
    ));
    report.lines.push(line);
}
