//! *666* and *elastic 666*: 216 frictionless spheres fall on the ground, and on each other.

use glam::DVec3;

use super::{Form, GRAVITY, Scenario, Simulated, Thing, lines};
use crate::accuracy::budget::Budget;
use crate::accuracy::report::{Line, Measure, Reason, Reference, Report};
use crate::hard_cases::scene::between;
use experiment::random::SplitMix64;

/// The one that loses all.
pub const NAME: &str = "666";
/// The one that loses nothing.
pub const ELASTIC: &str = "elastic-666";

const SIDE: u32 = 6;
const RADIUS: f64 = 0.1;
const MASS: f64 = 10.0;
const SPACING: f64 = 0.21;
const HEIGHT: f64 = 1.101;
const PERTURBATION: f64 = 1e-3;
/// The scenario's seed.
const SEED: u64 = 42;
/// Simulated time, for a quick look and for figures to publish [s]; the first sphere lands after 0.45 s.
const DURATIONS: [f64; 2] = [0.7, 2.0];
/// Time between looks at all pairs [s].
const LOOK: f64 = 1.0 / 60.0;

const DEEP: [Measure; 1] = [Measure {
    name: "penetration_m",
    words: "deepest overlap of two spheres, or of one and the ground [m]",
    noise: 1.0,
}];
const DRIFT: [Measure; 1] = [Measure {
    name: "energy_drift_share",
    words: "largest change of energy, as a share",
    noise: 1.0,
}];

const SLOP: &str = "impacts are answered when they come about; what overlaps is what contacts that last may sink before they are lifted";
const SLOW: &str = "impacts keep energy whatever the step; what is left are those slower than gravity makes in 1/360 s, which by design give \
nothing back";

/// Measures the scenario without restitution: how deep spheres overlap.
pub fn measure(budget: &Budget) -> Report {
    let scenario = scenario(0.0, budget);
    let error = |scene: &mut dyn Simulated, hz: f64| vec![penetration(scene, &scenario, hz)];
    let mut all = lines("restitution 0", &scenario, &DEEP, budget, error);
    for line in &mut all {
        line.floors[0] = 1e-5;
        line.reasons[0] = Some(Reason::up_to(1e-4, SLOP));
    }
    report(
        NAME,
        "SimBenchmark 666: 216 spheres, restitution and friction 0",
        DEEP.to_vec(),
        all,
        &scenario,
    )
}

/// Measures the scenario with restitution 1: what becomes of energy.
pub fn measure_elastic(budget: &Budget) -> Report {
    let scenario = scenario(1.0, budget);
    let error = |scene: &mut dyn Simulated, hz: f64| {
        let before = scene.energy();
        let mut most = 0.0_f64;
        for _ in 0..(scenario.duration * hz).round() as u64 {
            scene.step();
            most = most.max((scene.energy() / before - 1.0).abs());
        }
        vec![most]
    };
    let mut all = lines("restitution 1", &scenario, &DRIFT, budget, error);
    for line in &mut all {
        line.floors[0] = 1e-11;
        line.reasons[0] = Some(Reason::up_to(1e-5, SLOW));
    }
    report(
        ELASTIC,
        "SimBenchmark elastic 666: 216 spheres, restitution 1",
        DRIFT.to_vec(),
        all,
        &scenario,
    )
}

fn report(
    dial: &'static str,
    title: &'static str,
    measures: Vec<Measure>,
    lines: Vec<Line>,
    scenario: &Scenario,
) -> Report {
    let heights = scenario.things.iter().map(|thing| thing.at.y);
    let sum: f64 = heights.map(|y| MASS * GRAVITY * y).sum();
    let built = super::Ours::new(scenario, 720.0).energy();
    Report {
        dial,
        title,
        axis: "step",
        is_ordered: true,
        measures,
        lines,
        references: vec![
            Reference {
                truth: "rigid spheres do not overlap: at the beginning".to_owned(),
                other: "all pairs, one by one".to_owned(),
                difference: deepest(&|index| scenario.things[index].at, scenario.things.len()),
                allowed: 0.0,
                unit: "m",
            },
            Reference {
                truth: "the energy that the scene begins with".to_owned(),
                other: "the sum of weight times height".to_owned(),
                difference: (built / sum - 1.0).abs(),
                allowed: 1e-12,
                unit: "of it",
            },
        ],
        findings: Vec::new(),
    }
}

fn scenario(restitution: f64, budget: &Budget) -> Scenario {
    let mut random = SplitMix64::new(SEED);
    let mut things = Vec::new();
    for index in 0..SIDE.pow(3) {
        let [i, j, k] = [index % SIDE, index / SIDE % SIDE, index / SIDE / SIDE].map(f64::from);
        let mut off = || between(&mut random, -PERTURBATION, PERTURBATION);
        let jitter = DVec3::new(off(), off(), off());
        things.push(Thing {
            form: Form::Ball(RADIUS),
            mass: MASS,
            at: DVec3::new(i * SPACING, HEIGHT + k * SPACING, j * SPACING) + jitter,
        });
    }
    Scenario {
        things,
        friction: [0.0; 2],
        restitution,
        force: DVec3::ZERO,
        duration: DURATIONS[usize::from(budget.share == 1.0)],
    }
}

/// The deepest overlap that was seen [m].
fn penetration(scene: &mut dyn Simulated, scenario: &Scenario, hz: f64) -> f64 {
    let mut most = 0.0_f64;
    let between = (hz * LOOK).round().max(1.0) as u64;
    for step in 1..=(scenario.duration * hz).round() as u64 {
        scene.step();
        if step % between == 0 {
            most = most.max(deepest(
                &|index| scene.state(index).0,
                scenario.things.len(),
            ));
        }
    }
    most
}

/// The deepest overlap of spheres at these centres, with each other and with the ground [m]; 0 of none.
fn deepest(centre: &dyn Fn(usize) -> DVec3, count: usize) -> f64 {
    let centres: Vec<DVec3> = (0..count).map(centre).collect();
    let mut most = 0.0_f64;
    for (index, a) in centres.iter().enumerate() {
        most = most.max(RADIUS - a.y);
        for b in &centres[index + 1..] {
            if (*a - *b).length_squared() < 4.0 * RADIUS * RADIUS {
                most = most.max(2.0 * RADIUS - (*a - *b).length());
            }
        }
    }
    most
}
