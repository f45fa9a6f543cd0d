//! The shape ladder of the pin: one ellipsoid, the composite of 1997, denser composites, a convex cloud, the profile.

use std::sync::Arc;

use game::{BareAlley, Config, ObjectShape};
use glam::{DQuat, DVec3};
use physics::query::{Limits, separation};
use physics::{Compound, Pose, Response, Shape};

use super::budget::Budget;
use super::cap::angle;
use super::hits::{self, How};
use super::profile::Profile;
use super::racks::{self, Rack};
use super::report::{Line, Measure, Point, Reason, Reference, Report, largest, p95};
use super::timing::{Time, each, in_turns};
use crate::hard_cases::scene::{BALL_RADIUS, between};
use experiment::random::SplitMix64;

pub const NAME: &str = "ladder";

const SEED: u64 = 1997;
/// Slices of the dense composites.
const SLICES: [usize; 4] = [16, 32, 64, 128];
/// Points around and every how manieth ring of the convex clouds.
const CLOUDS: [(u32, usize); 3] = [(8, 16), (16, 8), (32, 4)];
/// Slices of the outline between two rows of the specification, in what is taken for true.
const FINER: usize = 16;
/// A dense rack costs as many throws less.
const FEWER: u64 = 4;
/// Slices of the densest pins that racks are made of, for a quick look and for figures to publish.
const RACKED: [usize; 2] = [32, 64];

const MEASURES: [Measure; 4] = [
    Measure {
        name: "gap_p95_m",
        words: "the gap of ball and pin is off by [m]",
        noise: 0.3,
    },
    Measure {
        name: "normal_p95_rad",
        words: "the normal of ball and pin is off by [rad]",
        noise: 0.3,
    },
    Measure {
        name: "velocity_p95_mps",
        words: "the pin's velocity just after the first hit is off by [m/s]",
        noise: 0.3,
    },
    Measure {
        name: "fallen_distance_pins",
        words: "distance of the distributions of fallen pins [pins]",
        noise: 1.0,
    },
];

const SCATTER: &str = "the scatter of samples of this size, not the shape";
const NECK: &str =
    "a hull has no neck: there it is up to 2 cm too thick, however many corners it has";
const CORNERS: &str = "slices have edges at which the normal jumps by the bend of the outline, and neck and ball touch at two of them";

/// A shape of the pin.
struct Rung {
    name: String,
    is_default: bool,
    pin: Arc<Compound>,
}

/// A ball beside a pin.
struct Place {
    centre: DVec3,
    gap: f64,
    normal: DVec3,
}

/// Measures the dial.
pub fn measure(budget: &Budget) -> Report {
    let table = Profile::specification();
    let profile = table.smooth(FINER);
    let places: Vec<Place> = (0..budget.poses).map(|i| place(&profile, i)).collect();
    let mut report = Report {
        dial: NAME,
        title: "shape of the pin",
        axis: "shape",
        is_ordered: true,
        measures: MEASURES.to_vec(),
        lines: Vec::new(),
        references: references(&table, &places),
        findings: Vec::new(),
    };
    let ladder = rungs(&table, &budget.config);
    let clouds: Vec<Rung> = CLOUDS
        .iter()
        .map(|(around, stride)| Rung {
            name: format!("{} rings of {around}", 180_usize.div_ceil(*stride)),
            is_default: false,
            pin: Arc::new(table.cloud(*around, *stride)),
        })
        .collect();
    queries(&mut report, "ladder", &ladder, &profile, &places, budget);
    queries(
        &mut report,
        "convex cloud",
        &clouds,
        &profile,
        &places,
        budget,
    );
    let neck = [0.03, 0.5, 5.0, 0.0].map(|most| Some(Reason::up_to(most, NECK)));
    report.lines[1].reasons = neck.to_vec();
    throws(&mut report, &ladder, budget);
    report
}

/// The ladder, cheapest first; pins of the scene are taken as the game makes them.
fn rungs(profile: &Profile, config: &Config) -> Vec<Rung> {
    let scene = |shape: ObjectShape, name: &str| {
        let mut config = config.clone();
        config.objects.shape = shape;
        let alley = BareAlley::new(&config, &[1]).expect("the checked scene can be built");
        let (_, id) = alley.pins()[0];
        Rung {
            name: name.to_owned(),
            is_default: shape == ObjectShape::True,
            pin: alley.world.body(id).compound().clone(),
        }
    };
    let mut rungs = vec![
        scene(ObjectShape::Ellipsoid, "one ellipsoid"),
        scene(ObjectShape::True, "5 primitives"),
    ];
    let dense = SLICES.iter().map(|count| profile.slices(*count));
    rungs.extend(dense.chain([profile.clone()]).map(|profile| Rung {
        name: format!("{} slices", profile.count()),
        is_default: false,
        pin: Arc::new(profile.compound()),
    }));
    rungs
}

/// The ladder's shapes of the pin with their names, cheapest first, up to the densest that racks are made of.
pub fn pins(config: &Config) -> Vec<(String, Arc<Compound>)> {
    let densest = format!("{} slices", RACKED[1]);
    let rungs = rungs(&Profile::specification(), config);
    let last = rungs.iter().position(|rung| rung.name == densest);
    let count = last.map_or(rungs.len(), |last| last + 1);
    rungs
        .into_iter()
        .take(count)
        .map(|rung| (rung.name, rung.pin))
        .collect()
}

/// Ball `index` beside the pin, somewhere between touching and a centimetre off; its truth is the profile's.
fn place(profile: &Profile, index: usize) -> Place {
    let mut random = SplitMix64::for_index(SEED, index as u64);
    let height = between(&mut random, -0.13, 0.22);
    let turn = DQuat::from_rotation_y(between(&mut random, 0.0, std::f64::consts::TAU));
    let off = between(&mut random, 0.0, 0.01);
    let mut across = 0.0;
    // The nearest the ball comes at this height, from outside inwards.
    let mut far = 0.3;
    for _ in 0..60 {
        across = far;
        let distance = profile.nearest(DVec3::new(far, height, 0.0)).distance;
        far -= distance - BALL_RADIUS - off;
    }
    let centre = turn * DVec3::new(across, height, 0.0);
    let nearest = profile.nearest(centre);
    Place {
        centre,
        gap: nearest.distance - BALL_RADIUS,
        normal: (centre - nearest.point) / nearest.distance,
    }
}

/// Gap and normal from pin to ball, of the part that is nearest.
fn ask(pin: &Compound, ball: &Shape, centre: DVec3) -> (f64, DVec3) {
    let pose = Pose::from_position(centre);
    let answers = pin.parts().iter().map(|part| {
        let of_part = (&part.shape, &part.pose);
        let answer = separation(of_part, (ball, &pose), None, Limits::default());
        (answer.gap, answer.normal)
    });
    answers
        .min_by(|x, y| x.0.total_cmp(&y.0))
        .expect("a pin has parts")
}

fn queries(
    report: &mut Report,
    name: &str,
    rungs: &[Rung],
    profile: &Profile,
    places: &[Place],
    budget: &Budget,
) {
    let ball = Shape::sphere(BALL_RADIUS).expect("the ball's radius is positive");
    let tasks = rungs.iter().map(|rung| {
        let ball = &ball;
        each(places, move |place| ask(&rung.pin, ball, place.centre))
    });
    let times = in_turns(budget.rounds, &mut tasks.collect::<Vec<_>>());
    let throws: Vec<_> = (0..budget.hits).map(hits::throw).collect();
    let truths: Vec<_> = throws.iter().map(|t| hits::expected(profile, t)).collect();
    let how = How {
        response: Response::Guarded,
        step_hz: 720.0,
        is_continuous: true,
    };
    let mut line = Line::new(name, "ball and pin", MEASURES.len(), "query");
    // The table has six digits behind the point: over a slice of 2 mm that is half a milliradian.
    line.floors = vec![5e-7, 5e-4, 5e-3, f64::INFINITY];
    line.reasons = vec![None, Some(Reason::up_to(0.1, CORNERS)), None, None];
    for (index, (rung, time)) in rungs.iter().zip(times).enumerate() {
        let answers: Vec<_> = places
            .iter()
            .map(|p| ask(&rung.pin, &ball, p.centre))
            .collect();
        let pairs = || answers.iter().zip(places);
        let gaps = pairs().map(|(answer, place)| (answer.0 - place.gap).abs());
        let normals = pairs().map(|(answer, place)| angle(answer.1, place.normal));
        let (world, id) = hits::world(how, &rung.pin);
        let apart = throws.iter().zip(&truths).map(|(throw, truth)| {
            hits::difference(hits::simulated(&world, id, how, throw).0, *truth)[0]
        });
        let mut errors = vec![
            p95(gaps.collect()),
            p95(normals.collect()),
            p95(apart.collect()),
        ];
        errors.push(f64::INFINITY);
        line.points.push(point(rung, index, errors, time));
    }
    report.lines.push(line);
}

fn point(rung: &Rung, index: usize, errors: Vec<f64>, time: Time) -> Point {
    Point {
        setting: rung.name.clone(),
        value: index as f64,
        is_default: rung.is_default,
        errors,
        time,
        step_hz: None,
    }
}

/// Distributions of fallen pins; the reference is the profile itself.
fn throws(report: &mut Report, ladder: &[Rung], budget: &Budget) {
    let rack = |rung: &Rung| Rack {
        response: Response::Guarded,
        step_hz: 180.0,
        contact: (0.49, 0.49),
        pin: rung.pin.clone(),
        seed: 1,
    };
    let densest = RACKED[usize::from(budget.share == 1.0)];
    let racked = ladder
        .iter()
        .position(|rung| rung.pin.parts().len() == densest);
    let ladder = &ladder[..=racked.expect("the ladder has this rung")];
    let last = &ladder[ladder.len() - 1];
    let racks: Vec<Rack> = ladder.iter().map(rack).collect();
    let count = (budget.throws / FEWER).max(budget.throws.min(50));
    let name = format!("at {}", last.name);
    let compared = racks::compare(racks, &rack(last), &name, count, 6);
    let (all, reference, noise) = (&compared.samples, &compared.reference, compared.noise);
    let mut line = Line::new(
        "ladder",
        "jittered throws",
        MEASURES.len(),
        "simulated second",
    );
    line.floors[3] = noise;
    line.reasons[3] = Some(Reason::up_to(2.0 * noise, SCATTER));
    for (index, (rung, fallen)) in ladder.iter().zip(all).enumerate() {
        let mut errors = vec![f64::INFINITY; MEASURES.len()];
        errors[3] = fallen.distance(reference);
        let mut point = point(rung, index, errors, fallen.time);
        point.step_hz = Some(180.0);
        line.points.push(point);
    }
    report.references.push(compared.check);
    let means: Vec<String> = ladder
        .iter()
        .zip(all)
        .map(|(rung, fallen)| format!("{} {:.2}", rung.name, fallen.mean()))
        .collect();
    report
        .findings
        .push(format!("mean fallen pins: {}", means.join(", ")));
    report.lines.push(line);
}

/// The outline in its half-plane against its slices in the query, and the smooth one against one twice as fine.
fn references(table: &Profile, places: &[Place]) -> Vec<Reference> {
    let ball = Shape::sphere(BALL_RADIUS).expect("the ball's radius is positive");
    let pin = table.compound();
    let finer = table.smooth(2 * FINER);
    let query = places.iter().map(|place| {
        let distance = table.nearest(place.centre).distance - BALL_RADIUS;
        (ask(&pin, &ball, place.centre).0 - distance).abs()
    });
    let query = largest(query);
    let twice: Vec<_> = places.iter().map(|p| finer.nearest(p.centre)).collect();
    let pairs = || places.iter().zip(&twice);
    let gaps = pairs().map(|(place, near)| (near.distance - BALL_RADIUS - place.gap).abs());
    let normals = pairs().map(|(place, near)| {
        let normal = (place.centre - near.point) / near.distance;
        angle(normal, place.normal)
    });
    let (gaps, normals) = (largest(gaps), largest(normals));
    let finer = |difference, allowed, unit| Reference {
        truth: format!("the smooth outline in {FINER} slices for each of the table's"),
        other: "in twice as many".to_owned(),
        difference,
        allowed,
        unit,
    };
    vec![
        Reference {
            truth: "gaps of the table's outline in its half-plane".to_owned(),
            other: "the query with a part for each of its 179 slices".to_owned(),
            difference: query,
            allowed: 1e-12,
            unit: "m",
        },
        finer(gaps, 5e-7, "m"),
        finer(normals, 5e-3, "rad"),
    ]
}
