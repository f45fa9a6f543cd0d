//! One fixed step, tick by tick: lasting contacts, then impacts in the order of time, then sleep.

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
mod touch;
mod tree;

pub(crate) use approach::part_gap;
pub(crate) use touch::place;

use glam::DVec3;

use self::pairs::{Contact, Key};
use self::plan::{Plan, Stage};
use crate::body::Spin;
use crate::effects::Effect;
use crate::world::World;

/// Distance at which two bodies count as in contact [m].
pub(crate) const CONTACT: f64 = 1e-7;
/// A lasting contact may sink this far in a step before it is struck again [m].
pub(crate) const SINK: f64 = 1e-5;
/// Ticks per second of a base that rocks, and of contacts that change little.
const FINEST: f64 = 720.0;
const COARSEST: f64 = 180.0;
/// How far a body with a lasting contact may turn in a tick [rad].
const TURN: f64 = 0.04;
/// Gap beyond which a lasting contact is given up [m].
pub(crate) const RELEASE: f64 = 1e-5;

impl World {
    /// Advances by one fixed step of `1 / step_hz` seconds, in as many ticks as what happens in it needs.
    pub fn step(&mut self) {
        self.impacts.clear();
        self.steps += 1;
        self.awake.sort_unstable();
        if self.is_quiet() {
            return;
        }
        let whole = self.dt();
        self.run_stages(|plan| &plan.before, whole);
        let mut left = whole;
        while left > 0.0 {
            self.effort.ticks += 1;
            // The last tick is all that is left, so that this ends at zero.
            left -= self.run_stages(|plan| &plan.tick, left);
        }
        self.run_stages(|plan| &plan.after, whole);
        self.dismiss();
    }

    /// Runs some stages of the plan over at most `dt` seconds; returns the length that they chose.
    fn run_stages(&mut self, of: fn(&Plan) -> &[Stage], mut dt: f64) -> f64 {
        for i in 0..of(&self.plan).len() {
            match of(&self.plan)[i] {
                Stage::Drive => self.aim_driven(dt),
                Stage::Slow | Stage::SlowAgain => self.slow_in_air(dt),
                Stage::WakeHeld => self.wake_driven_neighbours(),
                Stage::Gather => dt = self.gather_tick(dt),
                Stage::Carry => self.rest(dt),
                Stage::Strike => self.run_events(dt),
                Stage::Arrive => self.arrive(dt),
                Stage::Sleep => self.fall_asleep(dt),
            }
        }
        dt
    }

    /// Notes the lasting contacts of a tick of at most `left` seconds; returns its length.
    fn gather_tick(&mut self, left: f64) -> f64 {
        self.awake.sort_unstable();
        for slot in &self.awake {
            self.bodies[*slot as usize].acceleration = DVec3::ZERO;
        }
        let mut lasting = std::mem::take(&mut self.scratch.lasting);
        self.gather(&mut lasting);
        let dt = self.tick_length(&lasting, left);
        self.scratch.lasting = lasting;
        dt
    }

    fn arrive(&mut self, dt: f64) {
        for i in 0..self.awake.len() {
            self.end_tick(self.awake[i] as usize, dt);
        }
    }

    /// Length of the next tick [s]: `left` in equal parts, as many as the most demanding contact asks for.
    fn tick_length(&self, lasting: &[Contact], left: f64) -> f64 {
        let rates = lasting.iter().map(|contact| self.tick_rate(contact.key));
        let rate = rates.fold(0.0, f64::max);
        let ticks = (left * rate - 1e-6).ceil();
        if ticks > 1.0 { left / ticks } else { left }
    }

    /// Ticks per second that a lasting contact needs.
    ///
    /// Flight is exact however long it lasts, and so is rest. A base that tilts changes its mind about where it
    /// stands, and a body that turns takes its contacts round with it.
    fn tick_rate(&self, key: Key) -> f64 {
        let tilts = self
            .pairs
            .known(key)
            .is_some_and(|touch| touch.on_base && touch.base.is_none());
        if tilts {
            return FINEST;
        }
        let turning = [key.a, key.b].map(|slot| {
            let body = &self.bodies[slot as usize];
            if body.is_active() {
                body.turning_across()
            } else {
                0.0
            }
        });
        (turning[0].max(turning[1]) / TURN).clamp(COARSEST, FINEST)
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

    /// Brings a body to the end of the tick; one whose state is no state any more stops where it last was.
    pub(super) fn end_tick(&mut self, slot: usize, dt: f64) {
        let body = &mut self.bodies[slot];
        body.advance(dt, dt);
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
        body.halt();
        body.frozen = true;
        self.renew(slot);
    }
}
