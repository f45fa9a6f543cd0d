//! The law of collisions: the paper's to the letter, guarded, and Coulomb's, which is taken for true.

use std::sync::Arc;

use glam::{DMat3, DVec3};
use physics::Response;
use physics::response::{Coefficients, compliance, impulse};

use super::budget::Budget;
use super::racks::{self, Rack};
use super::report::{Line, Measure, Point, Reference, Report, largest, share_below};
use super::timing::{each, in_turns};
use crate::hard_cases::scene::{MODELS, between, composite_pin, direction, rotation, vector};
use experiment::random::SplitMix64;

pub const NAME: &str = "response";

const SEED: u64 = 9;
/// Random impacts.
const IMPACTS: usize = 2000;
/// Elasticity and friction rate of pairs under the paper's laws: 0.7 x 0.7.
const PAPER: (f64, f64) = (0.49, 0.49);
/// Restitution and friction of ball and pin under Coulomb's.
const COULOMB: (f64, f64) = (0.65, 0.12);

const MEASURES: [Measure; 3] = [
    Measure {
        name: "impulse_p50_share",
        words: "half of the impulses differ from Coulomb's by less, as a share",
        noise: 0.2,
    },
    Measure {
        name: "energy_gain_share",
        words: "largest gain of energy in an impact",
        noise: 1.0,
    },
    Measure {
        name: "fallen_distance_pins",
        words: "distance of the distributions of fallen pins [pins]",
        noise: 1.0,
    },
];

/// An impact of two random bodies: normal, relative velocity of the contact points, and their compliance.
struct Meeting {
    normal: DVec3,
    slip: DVec3,
    k: DMat3,
}

/// Measures the dial.
pub fn measure(budget: &Budget) -> Report {
    let mut report = Report {
        dial: NAME,
        title: "law of collisions",
        axis: "law",
        is_ordered: false,
        measures: MEASURES.to_vec(),
        lines: Vec::new(),
        references: Vec::new(),
        findings: Vec::new(),
    };
    impacts(&mut report, budget);
    throws(&mut report, budget);
    report
}

/// The law's name in settings.
pub fn name(response: Response) -> &'static str {
    match response {
        Response::UnoSlater => "uno_slater",
        Response::Guarded => "guarded",
        Response::Coulomb => "coulomb",
    }
}

fn contact(response: Response) -> (f64, f64) {
    if response == Response::Coulomb {
        COULOMB
    } else {
        PAPER
    }
}

fn meeting(index: usize) -> Meeting {
    let mut random = SplitMix64::for_index(SEED, index as u64);
    let random = &mut random;
    let mut side = || {
        let turn = DMat3::from_quat(rotation(random));
        let local = DVec3::new(
            between(random, 1.0, 3.0),
            between(random, 1.0, 3.0),
            between(random, 1.5, 2.5),
        );
        let mass = between(random, 0.5, 2.0);
        let inertia = turn * DMat3::from_diagonal(1.0 / (0.1 * mass * local)) * turn.transpose();
        compliance(1.0 / mass, &inertia, vector(random))
    };
    let k = side() + side();
    let normal = direction(random);
    let mut slip = vector(random) * 5.0;
    if slip.dot(normal) < 0.0 {
        slip = -slip;
    }
    Meeting { normal, slip, k }
}

fn answer(response: Response, meeting: &Meeting) -> DVec3 {
    let (elasticity, friction) = contact(response);
    let pair = Coefficients {
        elasticity,
        friction,
    };
    impulse(response, pair, meeting.normal, meeting.slip, &meeting.k)
}

/// Coulomb's impulse by a search: the largest share of the sticking impulse that the cone allows, by bisection.
fn searched(meeting: &Meeting) -> DVec3 {
    let Meeting { normal, slip, k } = meeting;
    let approach = slip.dot(*normal);
    if approach <= 0.0 {
        return DVec3::ZERO;
    }
    let along = -approach / normal.dot(*k * *normal);
    let pressing = *normal * (along * (1.0 + COULOMB.0));
    let rub = -(k.inverse() * *slip) - *normal * along;
    let fits = |share: f64| {
        let sum = pressing + rub * share;
        let pressed = -sum.dot(*normal);
        (sum + *normal * pressed).length() <= COULOMB.1 * pressed
    };
    let (mut low, mut high) = (0.0, 1.0);
    if fits(high) {
        low = high;
    }
    while high - low > 1e-15 {
        let middle = 0.5 * (low + high);
        if middle == low || middle == high {
            break;
        }
        if fits(middle) {
            low = middle;
        } else {
            high = middle;
        }
    }
    pressing + rub * low
}

fn impacts(report: &mut Report, budget: &Budget) {
    let meetings: Vec<Meeting> = (0..IMPACTS).map(meeting).collect();
    let truths: Vec<DVec3> = meetings
        .iter()
        .map(|m| answer(Response::Coulomb, m))
        .collect();
    let tasks = MODELS.map(|response| each(&meetings[..], move |m| answer(response, m)));
    let times = in_turns(budget.rounds, &mut Vec::from(tasks));
    let mut line = Line::new("random impacts", "impacts", MEASURES.len(), "impact");
    for (index, (response, time)) in MODELS.into_iter().zip(times).enumerate() {
        let pairs = || meetings.iter().zip(&truths);
        let apart =
            pairs().map(|(m, truth)| (answer(response, m) - truth).length() / truth.length());
        let gain = |m: &Meeting| {
            let f = answer(response, m);
            let before = 0.5 * m.slip.dot(m.k.inverse() * m.slip);
            (f.dot(m.slip) + 0.5 * f.dot(m.k * f)) / before
        };
        let most = meetings.iter().map(gain).fold(0.0, f64::max);
        line.points.push(Point {
            setting: name(response).to_owned(),
            value: index as f64,
            is_default: response == Response::UnoSlater,
            errors: vec![share_below(apart.collect(), 0.5), most, f64::INFINITY],
            time,
            step_hz: None,
        });
    }
    report.lines.push(line);
    let checked = meetings.iter().zip(&truths);
    let apart = checked.map(|(m, truth)| (searched(m) - *truth).length() / truth.length());
    report.references.push(Reference {
        truth: "Coulomb's impulse in closed form".to_owned(),
        other: "its share by bisection against the cone".to_owned(),
        difference: largest(apart),
        allowed: 1e-10,
        unit: "of the impulse",
    });
}

fn throws(report: &mut Report, budget: &Budget) {
    let pin = composite_pin();
    let rack = |response| Rack {
        response,
        step_hz: 720.0,
        contact: contact(response),
        pin: Arc::clone(&pin),
        seed: 1,
    };
    let coulomb = rack(Response::Coulomb);
    let racks = MODELS.map(rack).to_vec();
    let compared = racks::compare(racks, &coulomb, "under coulomb", budget.throws, 7);
    let (all, reference, noise) = (&compared.samples, &compared.reference, compared.noise);
    let mut line = Line::new(
        "jittered throws",
        "throws",
        MEASURES.len(),
        "simulated second",
    );
    line.floors[2] = noise;
    for (index, (response, fallen)) in MODELS.into_iter().zip(all).enumerate() {
        let mut errors = vec![f64::INFINITY; MEASURES.len()];
        errors[2] = fallen.distance(reference);
        line.points.push(Point {
            setting: name(response).to_owned(),
            value: index as f64,
            is_default: response == Response::UnoSlater,
            errors,
            time: fallen.time,
            step_hz: Some(720.0),
        });
    }
    report.references.push(compared.check);
    let means: Vec<String> = MODELS
        .iter()
        .zip(all)
        .map(|(response, fallen)| format!("{} {:.2}", name(*response), fallen.mean()))
        .collect();
    report.findings.push(format!(
        "mean fallen pins: {}; two samples of {} throws differ by up to {noise:.3}",
        means.join(", "),
        budget.throws
    ));
    report.lines.push(line);
}
