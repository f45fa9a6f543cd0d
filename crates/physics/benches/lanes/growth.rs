//! Scenes of many lanes, their times, and the power with which these grow.

use physics::{Settings, World};

use crate::clock::thread_seconds;
use crate::support::{LANE_SPACING, alleys, composite_pin, material, throw};

/// Numbers of lanes.
pub const LANES: [u32; 5] = [1, 4, 16, 64, 256];
/// Different throws.
const THROWS: u32 = 16;
/// Steps from the release, a metre before the head pin, until shortly before the hit.
const APPROACH: u32 = 60;
/// Steps that are timed while the pins fall.
pub const HEAP: u32 = 180;
/// Steps that are timed of a ball that rolls.
const ROLL: u32 = 1000;
/// Rounds in which all numbers of lanes take turns; of each the least mean counts.
const ROUNDS: usize = 5;
/// Least time of a mean [s].
const TURN: f64 = 0.2;

/// Times of a step [us] by number of lanes.
pub struct Growth {
    /// While all racks fall, for each lane.
    pub falling: Vec<(u32, f64)>,
    /// While a ball rolls down one lane and all else sleeps.
    pub one_awake: Vec<(u32, f64)>,
}

impl Growth {
    /// Measures.
    pub fn measure() -> Growth {
        let falling = LANES.map(shots);
        let rolling = LANES.map(|lanes| vec![one_awake(lanes)]);
        let mut growth = Growth {
            falling: LANES.map(|lanes| (lanes, f64::INFINITY)).to_vec(),
            one_awake: LANES.map(|lanes| (lanes, f64::INFINITY)).to_vec(),
        };
        for _ in 0..ROUNDS {
            for (i, lanes) in LANES.into_iter().enumerate() {
                let least = &mut growth.falling[i].1;
                *least = least.min(mean(&falling[i], HEAP, lanes));
                let least = &mut growth.one_awake[i].1;
                *least = least.min(mean(&rolling[i], ROLL, 1));
            }
        }
        growth
    }

    /// Slope of the straight line nearest to (lanes, total time) while racks fall, both as logarithms.
    pub fn exponent(&self) -> f64 {
        let logs = self.falling.iter().map(|(lanes, each)| {
            let lanes = f64::from(*lanes);
            (lanes.ln(), (lanes * each).ln())
        });
        let logs: Vec<(f64, f64)> = logs.collect();
        let count = logs.len() as f64;
        let sum = logs.iter().fold((0.0, 0.0), |s, p| (s.0 + p.0, s.1 + p.1));
        let mean = (sum.0 / count, sum.1 / count);
        let rise: f64 = logs.iter().map(|p| (p.0 - mean.0) * (p.1 - mean.1)).sum();
        let run: f64 = logs.iter().map(|p| (p.0 - mean.0) * (p.0 - mean.0)).sum();
        rise / run
    }
}

fn run(world: &mut World, steps: u32) {
    for _ in 0..steps {
        world.step();
    }
}

/// Worlds that together have every throw equally often, their balls about to hit.
pub fn shots(lanes: u32) -> Vec<World> {
    let m = material(0.7, 0.7);
    let make = |first: u32| {
        let mut world = alleys(lanes, Settings::default(), &composite_pin(), m);
        for lane in 0..lanes {
            let share = f64::from((lane + first) % THROWS) / f64::from(THROWS);
            let x = LANE_SPACING * f64::from(lane) + 0.02 + 0.05 * share;
            throw(&mut world, m, x, 1.0, 8.0);
        }
        run(&mut world, APPROACH);
        world
    };
    (0..(THROWS / lanes).max(1))
        .map(|i| make(i * lanes))
        .collect()
}

/// A ball that rolls down one lane for long, all racks asleep.
fn one_awake(lanes: u32) -> World {
    let m = material(0.7, 0.7);
    let mut world = alleys(lanes, Settings::default(), &composite_pin(), m);
    run(&mut world, 360);
    throw(&mut world, m, 0.05, 17.0, 6.0);
    run(&mut world, 2);
    world
}

/// Mean time of a step [us], per lane that is awake.
fn mean(worlds: &[World], steps: u32, awake: u32) -> f64 {
    let (mut seconds, mut runs) = (0.0, 0);
    while seconds < TURN {
        let mut copies: Vec<World> = (0..32).flat_map(|_| worlds).take(32).cloned().collect();
        if awake > 16 {
            copies.truncate(1);
        }
        let start = thread_seconds();
        copies.iter_mut().for_each(|world| run(world, steps));
        seconds += thread_seconds() - start;
        runs += copies.len() as u32;
    }
    1e6 * seconds / f64::from(steps * awake * runs)
}
