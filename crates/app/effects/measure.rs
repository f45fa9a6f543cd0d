//! Times of steps with one set of effects and with another, from the same states.

use anyhow::Result;
use game::{BareAlley, Config, PINS};
use glam::DVec3;
use physics::{BodyId, Effect, Effort, Pose, World};

use crate::shot::clock::thread_seconds;
use crate::shot::throw::Release;
use experiment::random::SplitMix64;

/// Time of a throw [s], and how often a state is taken in it.
const DURATION: f64 = 4.0;
const STATES: u64 = 10;
/// Steps from each state: the first find out who is near whom and are not timed.
const WARMING: u64 = 2;
const TIMED: u64 = 8;
/// Each time is the least of so many, taken in turns so that the machine's moods strike both alike.
const PASSES: u32 = 3;
/// Where the hand moves, and how far and fast [m], [1/s]: beside the approach, as that of somebody who waits.
const HAND: DVec3 = DVec3::new(0.6, 1.0, 2.0);
const HAND_SWAY: (f64, f64) = (0.1, 3.0);

/// Pose and velocities of the ball and of the pins in their order.
type State = Vec<(Pose, DVec3, DVec3)>;

/// States of throws in a scene, to measure from.
pub struct Bench {
    throws: u64,
    alley: Lane,
    states: Vec<State>,
}

/// An alley in which a ball is thrown while a hand moves.
#[derive(Clone)]
struct Lane {
    alley: BareAlley,
    moving: Vec<BodyId>,
    hand: BodyId,
}

/// What a set of effects costs.
#[derive(Clone, Debug)]
pub struct Cost {
    /// Time of a step from the states of the bench [us].
    pub step: f64,
    /// Time of whole throws per simulated time [ms/s].
    pub throw: f64,
    plan: Vec<Effect>,
    effort: Effort,
    steps: u64,
}

impl Cost {
    /// Whether an effect is in the plan.
    pub fn acts_in_plan(&self, effect: Effect) -> bool {
        self.plan.contains(&effect)
    }

    /// How often it acted in a step of the whole throws.
    pub fn acts(&self, effect: Effect) -> f64 {
        self.effort.work.of(effect) as f64 / self.steps as f64
    }
}

impl Bench {
    /// Throws `throws` times in the scene as it is and keeps states on the way.
    ///
    /// # Errors
    /// When the scene cannot be built.
    pub fn new(config: &Config, throws: u64) -> Result<Self> {
        let mut states = Vec::new();
        for index in 0..throws {
            let mut lane = Lane::new(config, index)?;
            let between = steps_in(config, DURATION) / STATES;
            for _ in 0..STATES {
                lane.run(between);
                states.push(lane.state());
            }
        }
        let alley = Lane::new(config, 0)?;
        Ok(Self {
            throws,
            alley,
            states,
        })
    }

    /// The world of the scene, before anything happened in it.
    pub fn world(&self) -> &World {
        &self.alley.alley.world
    }

    /// What two scenes cost that differ in their effects alone.
    ///
    /// # Errors
    /// When one of them cannot be built.
    pub fn compare(&self, with: &Config, without: &Config) -> Result<(Cost, Cost)> {
        let mut costs = [self.cost(with)?, self.cost(without)?];
        for _ in 1..PASSES {
            for (cost, config) in costs.iter_mut().zip([with, without]) {
                let again = self.cost(config)?;
                cost.step = cost.step.min(again.step);
                cost.throw = cost.throw.min(again.throw);
            }
        }
        let [with, without] = costs;
        Ok((with, without))
    }

    fn cost(&self, config: &Config) -> Result<Cost> {
        let fresh = Lane::new(config, 0)?;
        let mut seconds = 0.0;
        for state in &self.states {
            let mut lane = fresh.clone();
            lane.put(state);
            lane.run(WARMING);
            seconds += lane.run(TIMED);
        }
        let step = 1e6 * seconds / (self.states.len() as u64 * TIMED) as f64;
        let (mut seconds, mut effort) = (0.0, Effort::default());
        let steps = steps_in(config, DURATION);
        for index in 0..self.throws {
            let mut lane = Lane::new(config, index)?;
            seconds += lane.run(steps);
            effort = lane.alley.world.effort();
        }
        let world = &fresh.alley.world;
        Ok(Cost {
            step,
            throw: 1e3 * seconds / (DURATION * self.throws as f64),
            plan: world
                .plan()
                .flat_map(|stage| stage.effects.iter())
                .collect(),
            effort,
            steps,
        })
    }
}

impl Lane {
    /// Throw `index`, about to begin.
    fn new(config: &Config, index: u64) -> Result<Self> {
        let numbers: Vec<u8> = (1..=PINS).collect();
        let mut alley = BareAlley::new(config, &numbers)?;
        let hand = alley.add_hand(HAND)?;
        let mut random = SplitMix64::for_index(1, index);
        let release = Release {
            offset: 0.06 + 0.03 * random.normal(),
            start: 2.0,
            speed: 8.0,
            angle: 0.0,
            revs: 0.0,
            axis_rotation: 0.0,
        };
        let ball = release.put_into(&mut alley)?;
        let pins = alley.pins().iter().map(|(_, id)| *id);
        Ok(Self {
            moving: std::iter::once(ball).chain(pins).collect(),
            alley,
            hand,
        })
    }

    /// Advances by so many steps; returns the time that they took [s].
    fn run(&mut self, steps: u64) -> f64 {
        let started = thread_seconds();
        let world = &mut self.alley.world;
        let (far, fast) = HAND_SWAY;
        for _ in 0..steps {
            let sway = DVec3::X * (far * libm::sin(fast * world.time()));
            world.drive_to(self.hand, Pose::from_position(HAND + sway));
            world.step();
        }
        thread_seconds() - started
    }

    fn state(&self) -> State {
        let bodies = self.moving.iter().map(|id| self.alley.world.body(*id));
        bodies
            .map(|body| (body.pose(), body.linear_velocity(), body.angular_velocity()))
            .collect()
    }

    fn put(&mut self, state: &State) {
        for (id, (pose, linear, angular)) in self.moving.iter().zip(state) {
            self.alley.world.set_pose(*id, *pose);
            self.alley.world.set_velocity(*id, *linear, *angular);
        }
    }
}

fn steps_in(config: &Config, seconds: f64) -> u64 {
    (seconds * config.physics.step_hz).round() as u64
}
