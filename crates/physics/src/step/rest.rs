//! Lasting contacts: what lies, stands, leans or rolls keeps from sinking, with the friction of one step.
//!
//! A carried body moves through a stretch of time (a step, or what an impact leaves of it) at one velocity, that of
//! the stretch's middle. Half of gravity's kick and an answer of the contacts lead there from the start, another
//! half and another answer lead on to the end; so a body that passes between flight and contact takes the velocity of
//! that very moment along, and energy is kept to second order. What one contact gives two bodies in a stretch is a
//! pair of opposite impulses as long as both go through the same stretch: so bodies that contacts join are always
//! carried in one call, and all of them anew when an impact cuts the stretch of one.
//!
//! How the contacts are answered is in `solve.rs`.

use glam::DVec3;

use super::RELEASE;
use super::grip::Friction;
use super::mover::Mover;
use super::pairs::{Contact, Key, Load};
use super::row::Row;
use super::scratch::Carry;
use super::solve::{Halves, Work, group, most_passes};
use super::touch::Touch;
use crate::body::{Bend, Motion, Spin};
use crate::effects::Effect;
use crate::response::{Response, friction_rate_per_step};
use crate::world::World;

/// Depth that a lasting contact keeps [m]; deeper ones are pushed out slowly.
const SLOP: f64 = 5e-7;
/// Speed at which an overlap of bodies that do not turn is opened [m/s]: lifting all pins that fast for a step of 1/60 s
/// takes 1e-5 of a ball's energy.
const PUSH: f64 = 1e-3;
/// Points of a contact nearer to each other than this from one step to the next are the same [m].
const SAME: f64 = 0.01;
/// Velocity of a carried body that is a rounding error of the passes [m/s], per gravity's kick.
const NOISE: f64 = 1e-6;
/// Gap that is not worth closing [m]; a standing pin then has no velocity at all.
const EXACT: f64 = 1e-7;

impl World {
    /// Answers the lasting contacts, and sets everybody off.
    pub(crate) fn rest(&mut self, dt: f64) {
        let mut carried = std::mem::take(&mut self.scratch.found);
        let mut lasting = std::mem::take(&mut self.scratch.lasting);
        let (gravity, falls) = (self.plan.gravity, self.plan.has(Effect::Gravity));
        let mut falling = 0;
        for slot in &self.awake {
            let body = &mut self.bodies[*slot as usize];
            if body.rests {
                continue;
            }
            if body.is_active() && body.contacts > 0 {
                carried.push(*slot);
            } else if falls && body.is_active() {
                body.acceleration = gravity;
                falling += 1;
            }
        }
        self.effort.work.add(Effect::Gravity, falling);
        self.carry_islands(&lasting, &carried, dt);
        lasting.clear();
        self.scratch.lasting = lasting;
        for slot in &self.awake {
            self.bodies[*slot as usize].look_ahead();
        }
        carried.clear();
        self.scratch.found = carried;
    }

    /// Takes the bodies `carried` through a stretch that begins at `t` and ends at `dt` [s], or earlier if that is too long.
    ///
    /// Other bodies of the `touches`, those that still sleep, only take impulses.
    pub(crate) fn carry(&mut self, touches: &[Touch], carried: &[usize], t: f64, dt: f64) {
        let span = self.stretch(touches, dt - t);
        let until = if span < dt - t { t + span } else { dt };
        self.effort.stretches += 1;
        if let [first, ..] = carried
            && until < dt
        {
            self.scratch.renewals.push((until, *first as u32));
        }
        let half = 0.5 * span;
        let kick = self.plan.gravity * half;
        let halves = Halves {
            kick: self.plan.has(Effect::Gravity).then_some(kick),
            is_cone: self.settings.response == Response::Coulomb,
            is_rough: self.plan.has(Effect::Friction),
            rolling: self.plan.rolling,
            slow: kick.length(),
            enough: 1e-4 * kick.length() + 1e-15,
            passes: most_passes(&self.settings),
            sweep_cap: self.settings.sweep_cap,
        };
        let mut room = std::mem::take(&mut self.scratch.carry);
        room.number(self.bodies.len(), carried, touches);
        let movers = room.slots.iter().map(|s| Mover::new(&self.bodies[*s]));
        room.movers.extend(movers);
        self.rows(touches, &mut room, span);
        group(&mut room);
        room.before.extend(&room.movers);
        let first = room.answer(&self.bodies, carried.len(), &halves);
        self.still(&mut room, carried.len(), NOISE * kick.length());
        room.middle.extend(&room.movers);
        room.note_drift(false, half);
        room.rows.iter_mut().for_each(Row::renew);
        let second = room.answer(&self.bodies, carried.len(), &halves);
        room.note_drift(true, half);
        self.note_work(&room, carried.len(), [first, second]);
        self.keep_loads(&room.rows, half);
        for (i, slot) in room.slots.iter().enumerate() {
            let body = &mut self.bodies[*slot];
            if !body.is_dynamic() {
                continue;
            }
            let inertia = body.inertia();
            let (before, now) = (&room.before[i], &room.movers[i]);
            let change = |from: &Mover, to: &Mover| {
                let turned = inertia * (to.angular - from.angular);
                (to.linear - from.linear, turned)
            };
            if i < carried.len() {
                let middle = &room.middle[i];
                body.linear = middle.linear;
                body.momentum = inertia * middle.angular;
                let halves = [change(before, middle), change(middle, now)];
                // Without the gyroscopic term no momentum is kept, and torques go round with the body.
                let keeps = f64::from(body.spin != Spin::Steady);
                body.bend = [0, 1].map(|k| {
                    let ((linear, turned), drift) = (halves[k], room.drifts[i][k] * keeps);
                    Bend {
                        linear: linear / half,
                        torque: turned / half - drift * body.clock,
                        drift,
                    }
                });
                (body.middle, body.until) = (body.clock + half, until);
            } else {
                let (linear, turned) = change(before, now);
                body.linear += linear;
                body.momentum += turned;
            }
        }
        room.clear();
        self.scratch.carry = room;
    }

    /// Stops those of the first `carried` movers whose surfaces are slower than `noise` [m/s], which is what passes leave.
    ///
    /// A body that stays where it is need not be looked at again.
    fn still(&self, room: &mut Carry, carried: usize, noise: f64) {
        for (mover, slot) in room.movers.iter_mut().zip(&room.slots).take(carried) {
            let radius = self.bodies[*slot].compound.bounding_radius();
            if mover.linear.length() + radius * mover.angular.length() < noise {
                (mover.linear, mover.angular) = (DVec3::ZERO, DVec3::ZERO);
            }
        }
    }

    /// Counts what a stretch took.
    fn note_work(&mut self, room: &Carry, carried: usize, halves: [Work; 2]) {
        let rough = room
            .rows
            .iter()
            .filter(|row| row.friction != Friction::None);
        let work = &mut self.effort.work;
        if self.plan.has(Effect::Friction) {
            work.add(Effect::Friction, 2 * rough.count());
        }
        if self.plan.has(Effect::Gravity) {
            work.add(Effect::Gravity, 2 * carried);
        }
        for half in halves {
            self.effort.passes += u64::from(half.passes);
            work.add(Effect::RollingResistance, half.braked);
            work.add(Effect::Rotation, half.circled);
        }
    }

    /// Lasting contacts of awake bodies that have to be answered, by age; counts them per body.
    pub(super) fn gather(&mut self, lasting: &mut Vec<Contact>) {
        for slot in &self.awake {
            let slot = *slot as usize;
            let body = &mut self.bodies[slot];
            (body.contacts, body.rests) = (0, false);
            if !body.is_active() {
                continue;
            }
            // Of two that are awake the first brings the contact.
            let brings = |c: &&Contact| {
                let other = c.key.other(slot);
                other > slot || !self.bodies[other].is_active()
            };
            lasting.extend(self.pairs.contacts(slot).iter().filter(brings));
        }
        lasting.sort_unstable_by_key(|contact| contact.formed);
        lasting.retain(|Contact { key, .. }| {
            let lasts = self.touch(*key).gap <= RELEASE;
            if !lasts {
                self.part(*key);
                return false;
            }
            for slot in [key.a as usize, key.b as usize] {
                if self.bodies[slot].motion == Motion::Dynamic {
                    self.bodies[slot].contacts += 1;
                    self.rouse(slot);
                }
            }
            true
        });
        self.awake.sort_unstable();
        lasting.retain(|contact| !self.stands_still(contact.key));
    }

    /// Whether the answer is known beforehand: a body at perfect rest on its base alone stays so.
    ///
    /// It is what the rows would find, to the bit, and what most pins do most of the time.
    fn stands_still(&mut self, key: Key) -> bool {
        let touch = self.touch(key);
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
        let Some(down) = self.plan.gravity.try_normalize() else {
            return false;
        };
        let upright = base.up.dot(down) < -1.0 + 1e-14;
        if !still || !upright || touch.gap.abs() > EXACT || !base.holds(base.below(body.position)) {
            return false;
        }
        self.bodies[own].rests = true;
        true
    }

    /// Makes the contacts ready for a stretch of `span` seconds: a row for each of their points.
    fn rows(&mut self, touches: &[Touch], room: &mut Carry, span: f64) {
        let mut known: Option<(f64, Friction)> = None;
        for touch in touches {
            let coefficient = self.friction_of(touch);
            let points = touch.patch.map_or(1, |patch| patch.spots().len());
            // Most contacts of a scene share their friction rate: the power is taken once for all in a row.
            let friction = match known {
                Some((same, friction)) if same == coefficient && points == 1 => friction,
                // Every point takes its share of the slip.
                _ => self.friction(coefficient, 0.5 * span / points as f64),
            };
            known = (points == 1).then_some((coefficient, friction));
            let numbers = (
                room.numbers[touch.a] as usize,
                room.numbers[touch.b] as usize,
            );
            let loads = self.pairs.loads(touch.key).map(|loads| *loads);
            for i in 0..points {
                let mut touch = *touch;
                if let Some(patch) = touch.patch {
                    touch.gap = patch.spots()[i].gap;
                    touch.set_point(patch.spots()[i].point, &self.bodies);
                }
                let allowed = self.allowed_approach(&touch, span);
                if points > 1 || !self.plan.has(Effect::Rotation) {
                    touch.chord = DVec3::ZERO;
                } else if touch.chord != DVec3::ZERO {
                    // What is elastic gives back what the chord's foremost end takes.
                    touch.chord *= 1.0 - self.elasticity_of(&touch);
                }
                let mut row = Row::new(touch, numbers, &room.movers, allowed, friction);
                let near = |load: &&Load| load.point.distance_squared(touch.point) < SAME * SAME;
                if let Some(load) = loads.iter().flatten().find(near) {
                    row.expect(*load, 0.5 * span);
                }
                room.rows.push(row);
            }
        }
    }

    /// Remembers what the points of all contacts carried over `span` [s].
    fn keep_loads(&mut self, rows: &[Row], span: f64) {
        for group in rows.chunk_by(|x, y| x.touch.key == y.touch.key) {
            let Some(loads) = self.pairs.loads(group[0].touch.key) else {
                continue;
            };
            *loads = Default::default();
            for (load, row) in loads.iter_mut().zip(group) {
                *load = row.load(span);
            }
        }
    }

    /// What a pair's coefficient means for contacts that last, over a time of `span` seconds.
    fn friction(&self, coefficient: f64, span: f64) -> Friction {
        let reference = self.settings.friction_reference_s;
        match self.settings.response {
            _ if coefficient == 0.0 => Friction::None,
            Response::Coulomb => Friction::Cone(coefficient),
            _ => Friction::Rate(friction_rate_per_step(coefficient, span, reference)),
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
        // What a driven body holds down is pushed out faster: nobody minds, and its hand is inside. It takes work.
        let hasty = touch.gap < -1e-3
            && self.plan.has(Effect::Hand)
            && (self.is_held(touch.a) || self.is_held(touch.b));
        let fastest = if hasty {
            0.3
        } else {
            // A body that turns on sinks into what it turns on, and is lifted back as fast.
            let sweep = |slot: usize| self.bodies[slot].sweep().acceleration;
            let sinking = 0.5 * dt * (sweep(touch.a) + sweep(touch.b));
            (PUSH + sinking).min(0.125 * self.resting_speed())
        };
        -((-touch.gap - SLOP).max(0.0) / dt).min(fastest)
    }

    /// Whether a body is driven, or touched by one that is.
    pub(super) fn is_held(&self, slot: usize) -> bool {
        let driven = |slot: usize| self.bodies[slot].motion == Motion::Driven;
        let contacts = self.pairs.contacts(slot);
        driven(slot)
            || self.bodies[slot].is_dynamic() && contacts.iter().any(|c| driven(c.key.other(slot)))
    }
}
