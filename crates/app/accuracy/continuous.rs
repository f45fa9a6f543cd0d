//! Contacts found inside a step against contacts found where bodies are when a step begins.

use std::sync::Arc;

use glam::DVec3;
use physics::{Effect, Effects, Response, Settings, World};

use super::budget::Budget;
use super::hits::{self, How};
use super::profile::Profile;
use super::report::{Line, Measure, Point, Reason, Reference, Report, p95};
use super::step::{HIT_FLOORS, RATES, point, time_hits};
use super::timing::{Task, in_turns};
use crate::hard_cases::scene::{Setup, between};
use experiment::random::SplitMix64;

pub const NAME: &str = "continuous";

const SLICES: usize = 48;
/// Seed, number and simulated time [s] of the balls at the wall.
const SEED: u64 = 100;
const BALLS: usize = 120;
const WALL_S: f64 = 0.2;
/// Thickness of the wall, as a kickback's [m].
const THICK: f64 = 0.04;

const MEASURES: [Measure; 2] = [
    Measure {
        name: "velocity_p95_mps",
        words: "the pin's velocity just after the first hit is off by [m/s]",
        noise: 0.3,
    },
    Measure {
        name: "missed_share",
        words: "share of balls of 5 to 100 m/s through a wall of 4 cm",
        noise: 0.3,
    },
];

const EXACT: &str = "contacts are found at their own time inside a step, whatever its length";

/// Measures the dial.
pub fn measure(budget: &Budget) -> Report {
    let profile = Profile::specification().slices(SLICES);
    let pin = Arc::new(profile.compound());
    let throws: Vec<_> = (0..budget.hits).map(hits::throw).collect();
    let truths: Vec<_> = throws.iter().map(|t| hits::expected(&profile, t)).collect();
    let hit = truths.iter().flatten().count();
    let mut lines = Vec::new();
    for is_continuous in [true, false] {
        let name = if is_continuous { "on" } else { "off" };
        let hows = RATES.map(|step_hz| How {
            response: Response::Guarded,
            step_hz,
            is_continuous,
        });
        let mut line = Line::new(name, "first hit", MEASURES.len(), "simulated second");
        line.floors[0] = HIT_FLOORS[0];
        line.reasons[0] = is_continuous.then_some(Reason::up_to(1e-3, EXACT));
        let few = &throws[..throws.len().min(20)];
        let times = time_hits(&hows, &pin, few, budget.scene_rounds);
        for (how, time) in hows.iter().zip(times) {
            let (world, id) = hits::world(*how, &pin);
            let apart = throws.iter().zip(&truths).map(|(throw, truth)| {
                hits::difference(hits::simulated(&world, id, *how, throw).0, *truth)[0]
            });
            let error = p95(apart.collect());
            let mut point = point(how.step_hz, MEASURES.len(), 0, error, time);
            point.is_default &= is_continuous;
            line.points.push(point);
        }
        lines.push(line);
    }
    for is_continuous in [true, false] {
        lines.push(wall(is_continuous, budget));
    }
    Report {
        dial: NAME,
        title: "contacts found inside a step, or where bodies are when it begins",
        axis: "step",
        is_ordered: true,
        measures: MEASURES.to_vec(),
        references: vec![Reference {
            truth: format!(
                "first hits by sphere tracing, {hit} of {} hit",
                throws.len()
            ),
            other: "the finest step with contacts found inside".to_owned(),
            difference: lines[0]
                .points
                .last()
                .map_or(f64::INFINITY, |p| p.errors[0]),
            allowed: HIT_FLOORS[0],
            unit: "m/s",
        }],
        lines,
        findings: Vec::new(),
    }
}

/// Balls thrown at a wall; the world has one at a time.
fn wall(is_continuous: bool, budget: &Budget) -> Line {
    let name = if is_continuous { "on" } else { "off" };
    let mut line = Line::new(name, "thin wall", MEASURES.len(), "simulated second");
    let mut tasks: Vec<Task> = Vec::new();
    for hz in RATES {
        tasks.push(Box::new(move || {
            missed(hz, is_continuous);
            BALLS as u64
        }));
    }
    let times = in_turns(budget.scene_rounds, &mut tasks);
    for (hz, time) in RATES.into_iter().zip(times) {
        let error = missed(hz, is_continuous) as f64 / BALLS as f64;
        let mut point: Point = point(hz, MEASURES.len(), 1, error, time.per(WALL_S));
        point.is_default &= is_continuous;
        line.points.push(point);
    }
    line
}

/// How many balls get through.
fn missed(hz: f64, is_continuous: bool) -> usize {
    let setup = Setup::new(Response::Guarded)
        .weightless()
        .rate(hz)
        .contact(0.5, 0.0);
    let effects = Effects::default().without(Effect::Sleeping);
    let settings = Settings {
        effects: effects.set(Effect::Continuous, is_continuous),
        ..*setup.world().settings()
    };
    let mut empty =
        World::new(settings).expect("a scene that runs with one effect runs without it");
    let half = DVec3::new(2.0, 2.0, 0.5 * THICK);
    empty.add(setup.block(-half, half));
    let passes = |index: &usize| {
        let mut random = SplitMix64::for_index(SEED, *index as u64);
        let speed = between(&mut random, 5.0, 100.0);
        let from = DVec3::new(0.0, 0.0, between(&mut random, 0.5, 0.9));
        let mut world = empty.clone();
        let mut def = setup.bowling_ball(from);
        def.linear_velocity = DVec3::NEG_Z * speed;
        let ball = world.add(def);
        for _ in 0..(WALL_S * hz).ceil() as u64 {
            world.step();
        }
        world.body(ball).pose().position.z < 0.0
    };
    (0..BALLS).filter(passes).count()
}
