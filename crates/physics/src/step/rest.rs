//! Lasting contacts: what lies, stands, leans or rolls keeps from sinking, with the friction of one step.
//!
//! A body that something carries gets gravity's kick at the start of the step and then moves at constant velocity.
//! Each contact takes the e = 0 blend of Eq. (9) once, with the friction rate of this step's length; then the
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

struct Row {
    touch: Touch,
    k: DMat3,
    /// Approach that is allowed: a gap may close in the step, an overlap must open.
    allowed: f64,
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
        for body in &mut self.bodies {
            if !body.is_active() {
                continue;
            }
            if body.contacts > 0 {
                body.linear += gravity * dt;
            } else {
                body.acceleration = gravity;
            }
        }
        for row in rows.iter_mut().filter(|r| r.touch.base.is_none()) {
            self.rub(row);
        }
        let enough = 1e-4 * gravity.length() * dt + 1e-15;
        for _ in 0..PASSES {
            let mut worst: f64 = 0.0;
            for row in &mut rows {
                worst = worst.max(match row.touch.base {
                    Some(base) => self.stand(row, &base),
                    None => self.press(row),
                });
            }
            if worst <= enough {
                break;
            }
        }
        for body in &mut self.bodies {
            body.look_ahead(dt);
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
            let rate = coefficients(&self.bodies[a], &self.bodies[b]).friction_rate;
            let rate = friction_rate_per_step(rate, dt, self.settings.friction_reference_s);
            let allowed = self.allowed_approach(&touch, dt);
            let k = touch.compliance(&self.bodies);
            rows.push(Row {
                touch,
                k,
                allowed,
                rate,
                pressed: 0.0,
                given: (DVec3::ZERO, DVec3::ZERO),
            });
        }
        rows
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
