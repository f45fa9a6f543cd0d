//! One fixed step: lasting contacts, then impacts in the order of time, then sleep.

pub(crate) mod pairs;

mod approach;
mod events;
mod rest;
mod search;
mod sleep;
mod solve;
mod touch;

use glam::DVec3;

use crate::body::{Body, Motion};
use crate::world::World;

/// Distance at which two bodies count as in contact [m].
pub(crate) const CONTACT: f64 = 1e-7;
/// A lasting contact may sink this far in a step before it is struck again [m].
pub(crate) const SINK: f64 = 1e-5;
/// Gap beyond which a lasting contact is given up [m].
pub(crate) const RELEASE: f64 = 1e-5;

impl World {
    /// Advances by one fixed step of `1 / step_hz` seconds.
    pub fn step(&mut self) {
        let dt = self.dt();
        self.impacts.clear();
        self.steps += 1;
        if self.is_quiet() {
            return;
        }
        self.aim_driven(dt);
        for body in &mut self.bodies {
            body.clock = 0.0;
            body.acceleration = DVec3::ZERO;
        }
        self.wake_driven_neighbours();
        self.rest(dt);
        self.run_events(dt);
        for body in &mut self.bodies {
            body.advance(dt, dt);
            body.straighten();
            body.fresh = false;
            (body.blows, body.squeezed) = (0, false);
        }
        self.freeze_broken();
        if self.settings.sleeping {
            self.fall_asleep(dt);
        }
    }

    /// Whether nothing moves and nobody is told to: a step then only counts.
    fn is_quiet(&self) -> bool {
        let idle = |body: &Body| match body.motion {
            Motion::Fixed => true,
            Motion::Driven => body.linear == DVec3::ZERO && body.turning == DVec3::ZERO,
            Motion::Dynamic => !body.is_active(),
        };
        let idle = |body: &Body| !body.fresh && idle(body);
        self.targets.iter().all(Option::is_none) && self.bodies.iter().all(idle)
    }

    /// Approach speed below which a contact is inelastic [m/s]: what gravity adds in 1/360 s.
    ///
    /// A constant of the scene and not of the step, so that a bouncing ball rests after the same bounce whatever the
    /// step. Weightless scenes keep restitution down to 0.1 mm/s.
    pub(crate) fn resting_speed(&self) -> f64 {
        (self.settings.gravity.length() / 360.0).max(1e-4)
    }

    fn freeze_broken(&mut self) {
        for body in &mut self.bodies {
            if !body.is_finite() {
                let last = body.last_finite;
                body.position = last.position;
                body.rotation = last.rotation;
                body.halt();
                body.frozen = true;
            } else {
                body.last_finite = body.pose();
            }
        }
    }
}
