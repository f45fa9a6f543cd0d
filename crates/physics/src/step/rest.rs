//! Lasting contacts: what lies, stands, leans or rolls keeps from sinking, with the friction of one step.
//!
//! A carried body moves through a stretch of time (a step, or what an impact leaves of it) at one velocity, that of
//! the stretch's middle. Half of gravity's kick and an answer of the contacts lead there from the start, another
//! half and another answer lead on to the end; so a body that passes between flight and contact takes the velocity of
//! that very moment along, and energy is kept to second order.
//!
//! In an answer each contact takes the e = 0 blend of Eq. (9) once, with the friction rate of that half; then the
//! normal impulses alone are iterated until no contact approaches. Iterating the blend itself never settles when
//! a body has two contacts. A flat base on a flat face is one contact in closed form.

use glam::{DMat3, DVec3};

use super::RELEASE;
use super::touch::{Base, Touch, coefficients};
use crate::response::friction_rate_per_step;
use crate::world::World;

/// Most passes over the normals of a step.
const PASSES: usize = 40;
/// Depth that a lasting contact keeps [m]; deeper ones are pushed out slowly.
const SLOP: f64 = 5e-6;
/// Gap that is not worth closing [m]; a standing pin then has no velocity at all.
const EXACT: f64 = 1e-9;

/// A lasting contact while it is being answered.
pub(crate) struct Row {
    touch: Touch,
    k: DMat3,
    /// Approach that is allowed: a gap may close in the stretch, an overlap must open.
    allowed: f64,
    /// Friction rate of half a stretch.
    rate: f64,
    /// Normal impulse so far [N s].
    pressed: f64,
    /// A base's impulse and torque impulse so far, for undoing.
    given: (DVec3, DVec3),
}

impl World {
    /// Answers all lasting contacts, and sets everybody off for the step.
    pub(crate) fn rest(&mut self, dt: f64) {
        let mut rows = self.gather(dt);
        let gravity = self.settings.gravity;
        let mut carried = Vec::new();
        for (slot, body) in self.bodies.iter_mut().enumerate() {
            if body.is_active() && body.contacts > 0 {
                carried.push(slot);
            } else if body.is_active() {
                body.acceleration = gravity;
            }
        }
        self.carry(&mut rows, &carried, dt);
        for body in &mut self.bodies {
            body.look_ahead(dt);
        }
    }

    /// Takes the bodies `slots` through a stretch of `span` seconds that begins at their clocks.
    pub(crate) fn carry(&mut self, rows: &mut [Row], slots: &[usize], span: f64) {
        let half = 0.5 * span;
        let kick = self.settings.gravity * half;
        for slot in slots {
            self.bodies[*slot].linear += kick;
        }
        self.answer_rows(rows, half);
        let mut middle = Vec::with_capacity(slots.len());
        for slot in slots {
            let body = &mut self.bodies[*slot];
            middle.push((body.linear, body.momentum));
            body.linear += kick;
        }
        for row in rows.iter_mut() {
            // What closes a gap or opens an overlap on the way must not be left over at the end.
            row.allowed = 0.0;
            row.pressed = 0.0;
            row.given = (DVec3::ZERO, DVec3::ZERO);
        }
        self.answer_rows(rows, half);
        for (slot, (linear, momentum)) in slots.iter().zip(middle) {
            let body = &mut self.bodies[*slot];
            body.bend = (
                (body.linear - linear) / half,
                (body.momentum - momentum) / half,
            );
            (body.linear, body.momentum) = (linear, momentum);
            body.middle = body.clock + half;
        }
    }

    /// Stops every approach at the rows' contacts, with their friction.
    fn answer_rows(&mut self, rows: &mut [Row], half: f64) {
        for row in rows.iter_mut().filter(|r| r.touch.base.is_none()) {
            self.rub(row);
        }
        let enough = 1e-4 * self.settings.gravity.length() * half + 1e-15;
        for _ in 0..PASSES {
            let mut worst: f64 = 0.0;
            for row in rows.iter_mut() {
                worst = worst.max(match row.touch.base {
                    Some(base) => self.stand(row, &base),
                    None => self.press(row),
                });
            }
            if worst <= enough {
                break;
            }
        }
    }

    /// Lasting contacts of awake bodies, with their geometry; counts them per body.
    fn gather(&mut self, dt: f64) -> Vec<Row> {
        for body in &mut self.bodies {
            body.contacts = 0;
        }
        let mut rows = Vec::new();
        for key in self.pairs.touching.clone() {
            let (a, b) = (key.a as usize, key.b as usize);
            if !self.bodies[a].is_active() && !self.bodies[b].is_active() {
                continue;
            }
            let touch = self.touch(key);
            if touch.gap > RELEASE {
                self.pairs.set_touching(key, false);
                continue;
            }
            self.bodies[a].contacts += 1;
            self.bodies[b].contacts += 1;
            rows.push(self.row(touch, dt));
        }
        rows
    }

    /// A contact made ready for a stretch of `span` seconds.
    pub(crate) fn row(&self, touch: Touch, span: f64) -> Row {
        let rate = coefficients(&self.bodies[touch.a], &self.bodies[touch.b]).friction_rate;
        let reference = self.settings.friction_reference_s;
        Row {
            k: touch.compliance(&self.bodies),
            allowed: self.allowed_approach(&touch, span),
            rate: friction_rate_per_step(rate, 0.5 * span, reference),
            pressed: 0.0,
            given: (DVec3::ZERO, DVec3::ZERO),
            touch,
        }
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

    /// The e = 0 blend of Eq. (9) at a point: `F00 + mu (F01 - F00)`.
    fn rub(&mut self, row: &mut Row) {
        let n = row.touch.normal;
        let slip = row.touch.slip(&self.bodies);
        let approach = n.dot(slip) - row.allowed;
        if approach <= 0.0 {
            return;
        }
        let f00 = n * (-approach / n.dot(row.k * n));
        let mut impulse = f00;
        if row.rate > 0.0 {
            let f01 = row.k.inverse() * (n * row.allowed - slip);
            impulse = f00 + (f01 - f00) * row.rate;
            if impulse.dot(n) > 0.0 {
                return;
            }
        }
        row.pressed = -impulse.dot(n);
        row.touch.push(&mut self.bodies, impulse);
    }

    /// One pass at a point: the normal impulse that stops the approach, or less of it if it pulls.
    fn press(&mut self, row: &mut Row) -> f64 {
        let n = row.touch.normal;
        let excess = n.dot(row.touch.slip(&self.bodies)) - row.allowed;
        let stiffness = n.dot(row.k * n);
        let pressed = (row.pressed + excess / stiffness).max(0.0);
        let change = pressed - row.pressed;
        row.pressed = pressed;
        if change != 0.0 {
            row.touch.push(&mut self.bodies, n * -change);
        }
        (change * stiffness).abs()
    }

    /// One pass at a flat base: takes back what it gave and answers anew.
    ///
    /// The impulse `J` along the normal stops the base. It acts at the centre of pressure, where its torque takes
    /// what is left of the angular momentum across the normal. Inside the patch both stop *exactly*, which is why a
    /// standing pin does not drift; outside the body tips about the nearest point of the patch.
    fn stand(&mut self, row: &mut Row, base: &Base) -> f64 {
        let (own, other) = if base.of_a {
            (row.touch.a, row.touch.b)
        } else {
            (row.touch.b, row.touch.a)
        };
        if !self.bodies[own].is_dynamic() || self.bodies[other].is_dynamic() {
            return self.press(row);
        }
        let ground = self.bodies[other].velocity_at(base.centre);
        let body = &mut self.bodies[own];
        let (m, up) = (body.mass.mass, base.up);
        body.linear -= row.given.0 / m;
        body.momentum -= row.given.1;
        let velocity = body.linear - ground;
        let load = -m * (up.dot(velocity) + row.allowed);
        let before = row.given;
        row.given = (DVec3::ZERO, DVec3::ZERO);
        if load <= 0.0 {
            return before.0.length() / m;
        }
        let spin = up * up.dot(body.momentum);
        let along = velocity - up * up.dot(velocity);
        let arm = base.centre - body.position;
        let friction = along * (-m * row.rate);
        let tilt = body.momentum - spin + arm.cross(friction + up * load);
        let pressure = base.centre + up.cross(tilt) * (-1.0 / load);
        if base.holds(pressure) {
            // Set, not added up: a rounding error left over would move the body for ever.
            let after = ground - up * row.allowed + along * (1.0 - row.rate);
            let turning = spin * (1.0 - row.rate);
            row.given = ((after - body.linear) * m, turning - body.momentum);
            (body.linear, body.momentum) = (after, turning);
        } else {
            let before = (body.linear, body.momentum);
            row.touch.set_point(base.clamp(pressure), &self.bodies);
            row.k = row.touch.compliance(&self.bodies);
            row.pressed = 0.0;
            self.rub(row);
            self.press(row);
            let body = &self.bodies[own];
            row.given = ((body.linear - before.0) * m, body.momentum - before.1);
        }
        (row.given.0 - before.0).length() / m
    }
}
