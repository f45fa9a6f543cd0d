//! One fixed step: lasting contacts, then impacts in the order of time, then sleep.

mod mover;
pub(crate) mod near;
pub(crate) mod pairs;
pub(crate) mod plan;
pub(crate) mod scratch;

mod approach;
mod base;
mod called;
mod coefficient;
mod drag;
mod events;
mod grip;
mod islands;
mod patch;
mod queue;
mod rest;
mod roll;
mod row;
mod search;
mod sleep;
mod solve;
mod stretch;
mod touch;
mod tree;

pub(crate) use approach::part_gap;
pub(crate) use touch::place;

use glam::DVec3;

use self::plan::Stage;
use crate::body::Spin;
use crate::effects::Effect;
use crate::world::World;

/// Distance at which two bodies count as in contact [m].
pub(crate) const CONTACT: f64 = 1e-7;
/// A lasting contact may sink this far in a step before it is struck again [m].
pub(crate) const SINK: f64 = 1e-5;
/// The same for a flat base that rocks: what its edge sinks in before it takes over is lifted again, and adds up [m].
const SINK_OF_BASE: f64 = 2.5e-7;
/// Bodies that overlap and part slower than this are in contact [m/s].
pub(crate) const PARTING: f64 = 5e-3;
/// Gap beyond which a lasting contact is given up [m].
pub(crate) const RELEASE: f64 = 1e-5;

/// A caller's clock: the crate has none, and a step without one asks for none.
pub trait Stopwatch {
    /// The stages of a step begin.
    fn begin(&mut self);
    /// A stage has ended; the next one begins.
    fn lap(&mut self, stage: Stage);
}

/// Measures nothing.
pub struct Unwatched;

impl Stopwatch for Unwatched {
    #[inline]
    fn begin(&mut self) {}
    #[inline]
    fn lap(&mut self, _: Stage) {}
}

/// How far a lasting contact may sink in a step before it is struck again [m].
pub(crate) fn sink(rocks: bool) -> f64 {
    if rocks { SINK_OF_BASE } else { SINK }
}

impl World {
    /// Advances by one fixed step of `1 / step_hz` seconds.
    pub fn step(&mut self) {
        self.step_watched(&mut Unwatched);
    }

    /// The same step, which tells `watch` when each stage begins and ends; what it does with that changes nothing here.
    pub fn step_watched(&mut self, watch: &mut impl Stopwatch) {
        let dt = self.dt();
        self.impacts.clear();
        self.steps += 1;
        self.awake.sort_unstable();
        if self.is_quiet() {
            return;
        }
        watch.begin();
        for i in 0..self.plan.stages.len() {
            let stage = self.plan.stages[i];
            self.run(stage, dt);
            watch.lap(stage);
        }
        self.dismiss();
    }

    /// One stage of a step of `dt` seconds.
    fn run(&mut self, stage: Stage, dt: f64) {
        match stage {
            Stage::Drive => self.aim_driven(dt),
            Stage::Slow | Stage::SlowAgain => self.slow_in_air(dt),
            Stage::WakeHeld => self.wake_driven_neighbours(),
            Stage::Gather => self.gather_lasting(dt),
            Stage::Carry => self.rest(dt),
            Stage::Strike => self.run_events(dt),
            Stage::Arrive => self.arrive(dt),
            Stage::Sleep => self.fall_asleep(dt),
        }
    }

    /// Notes the lasting contacts of a step of `dt` seconds.
    fn gather_lasting(&mut self, dt: f64) {
        self.awake.sort_unstable();
        for slot in &self.awake {
            let body = &mut self.bodies[*slot as usize];
            (body.acceleration, body.until) = (DVec3::ZERO, dt);
        }
        let mut lasting = std::mem::take(&mut self.scratch.lasting);
        self.gather(&mut lasting);
        self.scratch.lasting = lasting;
    }

    fn arrive(&mut self, dt: f64) {
        for i in 0..self.awake.len() {
            self.end_step(self.awake[i] as usize, dt);
        }
    }

    /// Whether nothing moves and nobody is told to: a step then only counts.
    fn is_quiet(&self) -> bool {
        self.awake.iter().all(|slot| {
            let slot = *slot as usize;
            let body = &self.bodies[slot];
            !body.fresh && !body.is_busy() && self.targets[slot].is_none()
        })
    }

    /// Lets the step look at a body from now on, until it is idle again.
    pub(crate) fn rouse(&mut self, slot: usize) {
        let body = &mut self.bodies[slot];
        if !body.listed {
            body.listed = true;
            self.awake.push(slot as u32);
        }
    }

    /// Takes those off the list that have become idle.
    pub(super) fn dismiss(&mut self) {
        let bodies = &mut self.bodies;
        self.awake.retain(|slot| {
            let body = &mut bodies[*slot as usize];
            body.listed = body.is_busy() || body.fresh;
            if !body.listed {
                body.rest_in_place();
            }
            body.listed
        });
    }

    /// Approach speed below which a contact is inelastic [m/s]: what gravity adds in 1/360 s.
    ///
    /// A constant of the scene and not of the step, so that a bouncing ball rests after the same bounce whatever the
    /// step. Weightless scenes keep restitution down to 0.1 mm/s.
    pub(crate) fn resting_speed(&self) -> f64 {
        (self.plan.gravity.length() / 360.0).max(1e-4)
    }

    /// Brings a body to the end of the step; one whose state is no state any more stops where it last was.
    pub(super) fn end_step(&mut self, slot: usize, dt: f64) {
        let body = &mut self.bodies[slot];
        body.advance(dt);
        if body.momentum != DVec3::ZERO {
            self.effort.work.add(Effect::Rotation, 1);
            if body.spin == Spin::Free {
                self.effort.work.add(Effect::Gyroscopic, 1);
            }
        }
        body.straighten();
        body.fresh = false;
        body.clock = 0.0;
        (body.blows, body.squeezed) = (0, false);
        if body.is_finite() {
            body.last_finite = body.pose();
            return;
        }
        body.position = body.last_finite.position;
        body.rotation = body.last_finite.rotation;
        body.freeze();
        self.renew(slot);
    }
}
