//! *Rolling*: a box with balls on it is pulled over the ground.

use glam::DVec3;

use super::{Form, GRAVITY, Scenario, Simulated, Thing, lines};
use crate::accuracy::budget::Budget;
use crate::accuracy::report::{Line, Measure, Reason, Reference, Report};

pub const NAME: &str = "rolling";

const BOX_MASS: f64 = 10.0;
const BALL_MASS: f64 = 1.0;
/// Balls along each side.
const SIDE: u32 = 5;
const PULL: f64 = 150.0;
const ON_BOX: f64 = 0.8;
const ON_GROUND: f64 = 0.4;
/// Directions of the pull and their names.
const WAYS: [(DVec3, &str); 2] = [
    (DVec3::X, "along x"),
    (DVec3::new(0.5, 0.0, 0.866_025_403_784_438_6), "oblique"),
];

const MEASURES: [Measure; 1] = [Measure {
    name: "velocity_rms_mps",
    words: "velocities of box and balls are off by [m/s]",
    noise: 0.2,
}];

const STEADY: &str = "velocities grow evenly, which a step of any length gets right; what is left is how far the solver's sweeps go";

/// Measures the scenario.
pub fn measure(budget: &Budget) -> Report {
    let mut all: Vec<Line> = Vec::new();
    for (way, name) in WAYS {
        let scenario = scenario(way, 4.0 * budget.share);
        let error = |scene: &mut dyn Simulated, hz: f64| vec![error(scene, &scenario, way, hz)];
        all.extend(lines(name, &scenario, &MEASURES, budget, error));
    }
    for line in &mut all {
        line.floors[0] = 1e-9;
        line.reasons[0] = Some(Reason::up_to(1e-5, STEADY));
    }
    Report {
        dial: NAME,
        title: "SimBenchmark: a pulled box with 25 balls rolling on it",
        axis: "step",
        is_ordered: true,
        measures: MEASURES.to_vec(),
        lines: all,
        references: vec![Reference {
            truth: "the box's acceleration by momentum".to_owned(),
            other: "by the work of pull and friction".to_owned(),
            difference: (acceleration() - by_work()).abs(),
            allowed: 1e-12,
            unit: "m/s2",
        }],
        findings: Vec::new(),
    }
}

fn balls() -> f64 {
    f64::from(SIDE * SIDE)
}

/// What is left of the pull [N].
fn net() -> f64 {
    PULL - ON_GROUND * (BOX_MASS + balls() * BALL_MASS) * GRAVITY
}

/// The box's acceleration [m/s2]: a ball that rolls on it takes 2/7 of it.
fn acceleration() -> f64 {
    net() / (BOX_MASS + balls() * BALL_MASS * 2.0 / 7.0)
}

/// The same from the energy after a metre: of the box, and of balls that move and turn.
fn by_work() -> f64 {
    let (moving, turning) = (2.0 / 7.0, 5.0 / 7.0);
    let of_ball = BALL_MASS * (moving * moving + 0.4 * turning * turning);
    let square = 2.0 * net() / (BOX_MASS + balls() * of_ball);
    square / 2.0
}

fn scenario(way: DVec3, duration: f64) -> Scenario {
    let mut things = vec![Thing {
        form: Form::Cuboid(DVec3::new(10.0, 0.5, 10.0)),
        mass: BOX_MASS,
        at: DVec3::Y * 0.5,
    }];
    let places = (0..SIDE).flat_map(|i| (0..SIDE).map(move |j| (f64::from(i), f64::from(j))));
    things.extend(places.map(|(i, j)| Thing {
        form: Form::Ball(0.5),
        mass: BALL_MASS,
        at: DVec3::new(2.0 * i - 4.0, 1.5, 2.0 * j - 4.0),
    }));
    Scenario {
        things,
        friction: [ON_BOX, ON_GROUND],
        restitution: 0.0,
        force: way * PULL,
        duration,
    }
}

/// Root of the mean square of the error of box and balls over all steps [m/s].
fn error(scene: &mut dyn Simulated, scenario: &Scenario, way: DVec3, hz: f64) -> f64 {
    let (mut sum, mut count) = (0.0, 0);
    for step in 1..=(scenario.duration * hz).round() as u32 {
        scene.step();
        let speed = acceleration() * f64::from(step) / hz;
        for index in 0..scenario.things.len() {
            let share = if index == 0 { 1.0 } else { 2.0 / 7.0 };
            let (_, velocity) = scene.state(index);
            sum += (velocity - way * (speed * share)).length_squared();
            count += 1;
        }
    }
    (sum / f64::from(count)).sqrt()
}
