//! Lasting contacts: what lies, stands, leans or rolls keeps from sinking, with the friction of one step.
//!
//! A carried body moves through a stretch of time (a step, or what an impact leaves of it) at one velocity, that of
//! the stretch's middle. Half of gravity's kick and an answer of the contacts lead there from the start, another
//! half and another answer lead on to the end; so a body that passes between flight and contact takes the velocity of
//! that very moment along, and energy is kept to second order.
//!
//! How the contacts are answered is in `solve.rs`.

use glam::DVec3;

use super::RELEASE;
use super::solve::{Mover, Row, answer_group, group};
use super::touch::{Touch, coefficients};
use crate::response::friction_rate_per_step;
use crate::world::World;

/// Depth that a lasting contact keeps [m]; deeper ones are pushed out slowly.
const SLOP: f64 = 5e-6;
/// Gap that is not worth closing [m]; a standing pin then has no velocity at all.
const EXACT: f64 = 1e-9;

impl World {
    /// Answers all lasting contacts, and sets everybody off for the step.
    pub(crate) fn rest(&mut self, dt: f64) {
        let touches = self.gather();
        let gravity = self.settings.gravity;
        let mut carried = Vec::new();
        for (slot, body) in self.bodies.iter_mut().enumerate() {
            if body.rests {
                continue;
            }
            if body.is_active() && body.contacts > 0 {
                carried.push(slot);
            } else if body.is_active() {
                body.acceleration = gravity;
            }
        }
        self.carry(&touches, &carried, dt);
        for body in &mut self.bodies {
            body.look_ahead(dt);
        }
    }

    /// Takes the bodies `carried` through a stretch of `span` seconds that begins at their clocks.
    ///
    /// Other bodies of the `touches` keep the stretch they are in and only take impulses.
    pub(crate) fn carry(&mut self, touches: &[Touch], carried: &[usize], span: f64) {
        let half = 0.5 * span;
        let kick = self.settings.gravity * half;
        let enough = 1e-4 * kick.length() + 1e-15;
        let mut slots = carried.to_vec();
        for slot in touches.iter().flat_map(|t| [t.a, t.b]) {
            if !slots.contains(&slot) {
                slots.push(slot);
            }
        }
        let mut movers: Vec<Mover> = slots.iter().map(|s| Mover::new(&self.bodies[*s])).collect();
        let mut rows = self.rows(touches, &slots, &movers, span);
        let ends = group(&mut rows, &movers);
        let before = movers.clone();
        let mut passes = 0;
        let mut answer = |movers: &mut [Mover], rows: &mut [Row]| {
            for mover in &mut movers[..carried.len()] {
                mover.linear += kick;
            }
            let mut start = 0;
            for end in &ends {
                passes += answer_group(&mut rows[start..*end], movers, &self.bodies, enough);
                start = *end;
            }
        };
        answer(&mut movers, &mut rows);
        let middle = movers.clone();
        rows.iter_mut().for_each(Row::renew);
        answer(&mut movers, &mut rows);
        self.effort.passes += u64::from(passes);
        for (i, slot) in slots.iter().enumerate() {
            let body = &mut self.bodies[*slot];
            if !body.is_dynamic() {
                continue;
            }
            let inertia = body.inertia();
            if i < carried.len() {
                body.linear = middle[i].linear;
                body.momentum = inertia * middle[i].angular;
                let turned = inertia * (movers[i].angular - middle[i].angular);
                body.bend = ((movers[i].linear - middle[i].linear) / half, turned / half);
                body.middle = body.clock + half;
            } else {
                body.linear += movers[i].linear - before[i].linear;
                body.momentum += inertia * (movers[i].angular - before[i].angular);
            }
        }
    }

    /// Lasting contacts of awake bodies, with their geometry; counts them per body.
    fn gather(&mut self) -> Vec<Touch> {
        for body in &mut self.bodies {
            body.contacts = 0;
            body.rests = false;
        }
        let mut touches = Vec::with_capacity(self.pairs.touching.len());
        for key in self.pairs.touching.clone() {
            let (a, b) = (key.a as usize, key.b as usize);
            if !self.bodies[a].is_active() && !self.bodies[b].is_active() {
                continue;
            }
            let touch = self.touch(key);
            if touch.gap > RELEASE {
                self.part(key);
                continue;
            }
            self.bodies[a].contacts += 1;
            self.bodies[b].contacts += 1;
            touches.push(touch);
        }
        touches.retain(|touch| !self.stands_still(touch));
        touches
    }

    /// Whether the answer is known beforehand: a body at perfect rest on its base alone stays so.
    ///
    /// It is what the rows would find, to the bit, and what most pins do most of the time.
    fn stands_still(&mut self, touch: &Touch) -> bool {
        let Some(base) = touch.base else { return false };
        let (own, other) = if base.of_a {
            (touch.a, touch.b)
        } else {
            (touch.b, touch.a)
        };
        let (body, ground) = (&self.bodies[own], &self.bodies[other]);
        let still = body.contacts == 1
            && (body.linear, body.momentum) == (DVec3::ZERO, DVec3::ZERO)
            && !ground.is_dynamic()
            && (ground.linear, ground.turning) == (DVec3::ZERO, DVec3::ZERO);
        let gravity = self.settings.gravity;
        let Some(down) = gravity.try_normalize() else {
            return false;
        };
        let upright = base.up.dot(down) < -1.0 + 1e-14;
        if !still || !upright || touch.gap.abs() > EXACT || !base.holds(base.below(body.position)) {
            return false;
        }
        self.bodies[own].rests = true;
        true
    }

    /// Contacts made ready for a stretch of `span` seconds.
    fn rows(&self, touches: &[Touch], slots: &[usize], movers: &[Mover], span: f64) -> Vec<Row> {
        let number = |slot: usize| {
            let found = slots.iter().position(|s| *s == slot);
            found.expect("the bodies of every touch are among the movers")
        };
        let reference = self.settings.friction_reference_s;
        let mut known: Option<(f64, f64)> = None;
        let make = |touch: &Touch| {
            let pair = coefficients(&self.bodies[touch.a], &self.bodies[touch.b]);
            // Most contacts of a scene share their friction rate: the power is taken once for all in a row.
            let rate = match known {
                Some((rate, per_step)) if rate == pair.friction_rate => per_step,
                _ => friction_rate_per_step(pair.friction_rate, 0.5 * span, reference),
            };
            known = Some((pair.friction_rate, rate));
            let numbers = (number(touch.a), number(touch.b));
            Row::new(
                *touch,
                numbers,
                movers,
                self.allowed_approach(touch, span),
                rate,
            )
        };
        touches.iter().map(make).collect()
    }

    /// Largest approach speed that a contact may keep [m/s]; negative when it is to be pushed apart.
    fn allowed_approach(&self, touch: &Touch, dt: f64) -> f64 {
        if touch.gap >= 0.0 {
            return if touch.gap < EXACT {
                0.0
            } else {
                touch.gap / dt
            };
        }
        // What a driven body holds down is pushed out faster: nobody minds, and its hand is inside.
        let driven = !self.bodies[touch.a].is_dynamic() || !self.bodies[touch.b].is_dynamic();
        let hasty = driven && touch.gap < -1e-3;
        let fastest = if hasty {
            0.3
        } else {
            0.25 * self.resting_speed()
        };
        -((-touch.gap - SLOP).max(0.0) / dt).min(fastest)
    }
}
