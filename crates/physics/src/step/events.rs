//! Impacts in the order of time, each answered where and when it happens.

use glam::DVec3;

use super::RELEASE;
use super::pairs::Key;
use super::search::Event;
use super::touch::{Base, Touch, coefficients};
use crate::body::Body;
use crate::response::{Coefficients, Response, impulse};
use crate::world::{Impact, World};

/// Most impulses in answer to one event.
const ROUNDS: usize = 60;
/// Impulses that a body takes in a step before restitution is dropped.
///
/// What bounces between two walls that approach each other does so endlessly in a finite time, and gains speed.
const ELASTIC_BLOWS: u32 = 24;
/// Impulses that a body takes in a step before it is squeezed.
///
/// Then whatever holds it cannot be satisfied, as between the hand and a wall: it stops, and what moves on overlaps it.
/// Every impulse moves a body that is not squeezed yet, so that no step has more than this for each body.
const BLOWS: u32 = 64;
/// Slower approach than this is left to the lasting contact [m/s].
const APPROACH: f64 = 1e-6;
/// Rounds after which restitution is dropped, so that a body between two others comes to terms with them.
const ELASTIC_ROUNDS: usize = 40;

impl World {
    /// Finds and answers all contacts that come about during the step.
    pub(crate) fn run_events(&mut self, dt: f64) {
        let count = self.bodies.len();
        let mut events: Vec<Event> = Vec::new();
        let moving: Vec<usize> = (0..count).filter(|i| !self.bodies[*i].is_still()).collect();
        for slot in &moving {
            for other in 0..count {
                let counted = other < *slot && !self.bodies[other].is_still();
                if other != *slot && !counted {
                    events.extend(self.first_contact(*slot, other, 0.0, dt));
                }
            }
        }
        while let Some(next) = earliest(&events).filter(|e| e.time < dt) {
            self.effort.events += 1;
            let changed = self.answer(next, dt);
            let involved = |slot: u32| changed.contains(&(slot as usize));
            events.retain(|e| !involved(e.key.a) && !involved(e.key.b));
            for (i, slot) in changed.iter().enumerate() {
                for other in 0..count {
                    if other != *slot && !changed[..i].contains(&other) {
                        events.extend(self.first_contact(*slot, other, next.time, dt));
                    }
                }
            }
        }
    }

    /// Answers one contact and what follows from it at once; returns the bodies involved.
    fn answer(&mut self, event: Event, dt: f64) -> Vec<usize> {
        let t = event.time;
        let mut bodies = Vec::new();
        let mut struck = Vec::new();
        let mut touches: Vec<Touch> = Vec::new();
        self.involve(event.key, t, dt, &mut bodies, &mut touches);
        for round in 0..ROUNDS {
            let Some(worst) = self.most_approaching(&mut touches, round == 0) else {
                break;
            };
            let touch = touches[worst];
            self.effort.impulses += 1;
            self.strike(&touch, round < ELASTIC_ROUNDS);
            self.squeeze(&touch);
            for slot in [touch.a, touch.b] {
                if !struck.contains(&slot) && self.bodies[slot].is_dynamic() {
                    struck.push(slot);
                    self.spread(slot, t, dt, &mut bodies, &mut touches);
                }
            }
        }
        if struck.is_empty() {
            // Nothing approaches: the contact only begins. Its bodies still change from flight to support.
            struck.extend([event.key.a as usize, event.key.b as usize]);
            for slot in &struck {
                self.bodies[*slot].blows += 1;
            }
            self.squeeze(&touches[0]);
            struck.retain(|slot| self.bodies[*slot].is_active());
            for slot in struck.clone() {
                self.spread(slot, t, dt, &mut bodies, &mut touches);
            }
        }
        self.settle_touches(&touches);
        self.set_off(&struck, &touches, t, dt);
        for slot in &bodies {
            self.bodies[*slot].look_ahead(dt);
        }
        bodies
    }

    /// Brings a contact and its bodies into play.
    fn involve(
        &mut self,
        key: Key,
        t: f64,
        dt: f64,
        bodies: &mut Vec<usize>,
        touches: &mut Vec<Touch>,
    ) {
        if touches.iter().any(|known| known.key == key) {
            return;
        }
        for slot in [key.a as usize, key.b as usize] {
            if !bodies.contains(&slot) && self.bodies[slot].is_dynamic() {
                bodies.push(slot);
            }
            self.bodies[slot].advance(t, dt);
        }
        let touch = self.touch(key);
        touches.push(touch);
    }

    /// A body got an impulse: it wakes, and its other contacts come into play.
    fn spread(
        &mut self,
        slot: usize,
        t: f64,
        dt: f64,
        bodies: &mut Vec<usize>,
        touches: &mut Vec<Touch>,
    ) {
        if !self.bodies[slot].is_dynamic() {
            return;
        }
        if self.bodies[slot].asleep {
            self.wake(slot);
        }
        for key in self.pairs.touching.clone() {
            if key.a as usize == slot || key.b as usize == slot {
                self.involve(key, t, dt, bodies, touches);
            }
        }
    }

    /// The contact that approaches fastest; in the first round the event's own.
    fn most_approaching(&self, touches: &mut [Touch], first: bool) -> Option<usize> {
        let mut worst: Option<(usize, f64)> = None;
        for (i, touch) in touches.iter_mut().enumerate() {
            if let Some(base) = touch.base {
                touch.set_point(pressure_point(touch, &base, &self.bodies), &self.bodies);
            }
            let speed = touch.normal.dot(touch.slip(&self.bodies));
            let movable = [touch.a, touch.b]
                .iter()
                .any(|s| self.bodies[*s].is_dynamic());
            if movable && speed > APPROACH && worst.is_none_or(|w| speed > w.1) {
                worst = Some((i, speed));
            }
            if first {
                break;
            }
        }
        worst.map(|w| w.0)
    }

    /// The impact law at one contact.
    fn strike(&mut self, touch: &Touch, elastic: bool) {
        let slip = touch.slip(&self.bodies);
        let approach = touch.normal.dot(slip);
        let mut pair = coefficients(&self.bodies[touch.a], &self.bodies[touch.b]);
        let worn = |slot: usize| self.bodies[slot].blows >= ELASTIC_BLOWS;
        if approach < self.resting_speed() || !elastic || worn(touch.a) || worn(touch.b) {
            // A slow touch is the beginning of a lasting contact, and that has a friction of its own.
            pair = Coefficients {
                elasticity: 0.0,
                friction_rate: 0.0,
            };
        }
        let response: Response = self.settings.response;
        let k = touch.compliance(&self.bodies);
        let impulse = impulse(response, pair, touch.normal, slip, &k);
        touch.push(&mut self.bodies, impulse);
        for slot in [touch.a, touch.b] {
            self.bodies[slot].blows += 1;
        }
        self.impacts.push(Impact {
            a: self.id(touch.a),
            b: self.id(touch.b),
            point: touch.point,
            normal: touch.normal,
            approach_speed: approach,
            impulse,
        });
    }

    /// Stops the bodies of a contact that have taken too many blows, for the rest of the step.
    fn squeeze(&mut self, touch: &Touch) {
        for slot in [touch.a, touch.b] {
            let body = &mut self.bodies[slot];
            if body.is_dynamic() && body.blows >= BLOWS {
                body.squeezed = true;
                // A broken state is not to look sound again: its body is frozen when the step ends.
                if body.is_finite() {
                    body.halt();
                }
            }
        }
    }

    /// Decides which contacts last: close and hardly separating.
    fn settle_touches(&mut self, touches: &[Touch]) {
        let leaving = 0.25 * self.resting_speed();
        for touch in touches {
            let mut touch = *touch;
            if let Some(base) = touch.base {
                touch.set_point(pressure_point(&touch, &base, &self.bodies), &self.bodies);
            }
            let separating = -touch.normal.dot(touch.slip(&self.bodies));
            let lasts = separating < leaving && touch.gap < RELEASE;
            if lasts {
                self.pairs.set_touching(touch.key, true);
            } else {
                self.part(touch.key);
            }
        }
    }

    /// Chooses flight or support of the struck bodies for the rest of the step.
    fn set_off(&mut self, struck: &[usize], touches: &[Touch], t: f64, dt: f64) {
        let gravity = self.settings.gravity;
        let mut carried = Vec::new();
        for slot in struck {
            let on = |k: &Key| k.a as usize == *slot || k.b as usize == *slot;
            let is_carried = self.pairs.touching.iter().any(on);
            let body = &mut self.bodies[*slot];
            if !body.is_active() {
                continue;
            }
            body.still_steps = 0;
            body.straighten();
            body.acceleration = if is_carried { DVec3::ZERO } else { gravity };
            if is_carried {
                carried.push(*slot);
            }
        }
        let span = dt - t;
        if carried.is_empty() || span < 1e-9 {
            return;
        }
        let movable = |touch: &Touch| {
            [touch.a, touch.b]
                .iter()
                .any(|slot| self.bodies[*slot].is_dynamic())
        };
        let lasts = |touch: &&Touch| self.pairs.part(touch.key).touching && movable(touch);
        let lasting: Vec<Touch> = touches.iter().filter(lasts).copied().collect();
        self.carry(&lasting, &carried, span);
    }
}

fn earliest(events: &[Event]) -> Option<Event> {
    let mut first: Option<Event> = None;
    for event in events {
        if first.is_none_or(|f| event.time < f.time) {
            first = Some(*event);
        }
    }
    first
}

/// Where a flat base takes an impact: the centre of pressure that stops or reflects the whole patch.
///
/// Within the patch the base stays flat; at its edge the body tips, which is Housner's rocking.
fn pressure_point(touch: &Touch, base: &Base, bodies: &[Body]) -> DVec3 {
    let body = &bodies[if base.of_a { touch.a } else { touch.b }];
    let other = &bodies[if base.of_a { touch.b } else { touch.a }];
    if !body.is_dynamic() {
        return base.clamp(base.centre);
    }
    let turning = body.angular_velocity();
    let across = turning - base.up * base.up.dot(turning);
    let rate = across.length();
    if rate < 1e-14 {
        return base.clamp(base.centre);
    }
    let closing = -base
        .up
        .dot(body.linear_now() - other.velocity_at(base.centre));
    let inertia = body.mass.inertia.x;
    let lever = if closing > 0.0 {
        (inertia * rate / (body.mass.mass * closing)).min(base.radius)
    } else {
        base.radius
    };
    base.clamp(base.centre - base.up.cross(across) * (lever / rate))
}
