//! Sweeps of the solver over lasting contacts, under Coulomb's law, with what is hardest for it: towers, heavy on light.

use glam::DVec3;
use physics::{BodyId, Response, Settings, World};

use super::budget::Budget;
use super::report::{Line, Measure, Point, Reason, Reference, Report, largest};
use super::timing::{Task, in_turns};
use crate::hard_cases::scene::{Setup, between, run};
use experiment::random::SplitMix64;

pub const NAME: &str = "solver";

const CAPS: [u32; 10] = [1, 2, 4, 8, 16, 32, 64, 128, 512, 3000];
const DEFAULT: u32 = 3000;
/// Edge of the boxes [m].
const EDGE: f64 = 0.2;
const SEED: u64 = 40;
const HZ: f64 = 180.0;
/// Simulated time [s]: later, towers that sag begin to rock, and how far is chance.
const DURATION: f64 = 0.1;
/// Towers of each kind, and how far their boxes are put aside at random [m]: an unfinished answer lets a tower sag, and where
/// is chance.
const TOWERS_EACH: u64 = 4;
const ASIDE: f64 = 0.01;

const MEASURES: [Measure; 1] = [Measure {
    name: "moved_rms_m",
    words: "the top of the tower is off by [m], root of mean square",
    noise: 1.0,
}];

/// Masses of the boxes of a tower from below [kg].
struct Tower {
    name: &'static str,
    masses: &'static [f64],
}

const TOWERS: [Tower; 3] = [
    Tower {
        name: "5 equal boxes",
        masses: &[1.0; 5],
    },
    Tower {
        name: "10 equal boxes",
        masses: &[1.0; 10],
    },
    Tower {
        name: "100 kg on 1 kg",
        masses: &[1.0, 100.0],
    },
];

const LOADS: &str = "sweeps begin with the loads of the last stretch and hold energy until they have come to terms; ended early they may throw \
the upper box up";

/// Measures the dial.
pub fn measure(budget: &Budget) -> Report {
    let lines: Vec<Line> = TOWERS.iter().map(|tower| line(tower, budget)).collect();
    let fine = TOWERS.iter().map(|tower| {
        let at = |hz| moved(tower, DEFAULT, hz);
        (at(HZ) - at(4.0 * HZ)).abs()
    });
    Report {
        dial: NAME,
        title: "largest number of sweeps over lasting contacts under Coulomb's law",
        axis: "sweeps",
        is_ordered: true,
        measures: MEASURES.to_vec(),
        references: vec![Reference {
            truth: "a tower that stands does not move".to_owned(),
            other: "all sweeps at a step of 1/720 instead of 1/180 s".to_owned(),
            difference: largest(fine),
            allowed: 1e-4,
            unit: "m",
        }],
        lines,
        findings: Vec::new(),
    }
}

fn line(tower: &Tower, budget: &Budget) -> Line {
    let mut line = Line::new(tower.name, "towers", 1, "simulated second");
    // The overlap that each contact keeps.
    line.floors[0] = 1e-5 * tower.masses.len() as f64;
    line.reasons[0] = Some(Reason::up_to(0.05, LOADS));
    let tasks = CAPS.map(|cap| -> Task {
        Box::new(move || {
            moved(tower, cap, HZ);
            TOWERS_EACH
        })
    });
    let times = in_turns(budget.scene_rounds, &mut Vec::from(tasks));
    for (cap, time) in CAPS.into_iter().zip(times) {
        line.points.push(Point {
            setting: cap.to_string(),
            value: f64::from(cap),
            is_default: cap == DEFAULT,
            errors: vec![moved(tower, cap, HZ)],
            time: time.per(DURATION),
            step_hz: Some(HZ),
        });
    }
    line
}

/// How far the tops of towers are from where they were put [m].
fn moved(tower: &Tower, cap: u32, hz: f64) -> f64 {
    let squares = (0..TOWERS_EACH).map(|index| {
        let (mut world, top) = build(tower, cap, hz, index);
        let before = world.body(top).pose().position;
        run(&mut world, DURATION);
        (world.body(top).pose().position - before).length_squared()
    });
    (squares.sum::<f64>() / TOWERS_EACH as f64).sqrt()
}

fn build(tower: &Tower, cap: u32, hz: f64, index: u64) -> (World, BodyId) {
    let mut random = SplitMix64::for_index(SEED, index);
    let setup = Setup::new(Response::Coulomb).rate(hz).contact(0.0, 0.5);
    let template = setup.world();
    let mut world = World::new(Settings {
        sweep_cap: cap,
        ..*template.settings()
    })
    .expect("a cap of at least one sweep");
    world.add(setup.floor());
    let mut top = None;
    for (index, mass) in (0u32..).zip(tower.masses) {
        let mut aside = || between(&mut random, -ASIDE, ASIDE);
        let centre = DVec3::new(aside(), EDGE * (f64::from(index) + 0.5), aside());
        top = Some(world.add(setup.cuboid(DVec3::splat(0.5 * EDGE), *mass, centre)));
    }
    (world, top.expect("a tower has boxes"))
}
