//! Impacts in the order of time, each answered where and when it happens.

use glam::DVec3;

use super::base::Base;
use super::pairs::Key;
use super::patch::strike_point;
use super::scratch::Answer;
use super::search::{Event, Next, What};
use super::touch::Touch;
use super::{PARTING, RELEASE, SINK};
use crate::body::Body;
use crate::effects::Effect;
use crate::response::{Coefficients, impulse, smooth_impulse};
use crate::world::{Impact, World};

/// Most impulses in answer to one event.
const ROUNDS: usize = 60;
/// Impulses that a body takes in 1/720 s before restitution is dropped.
///
/// What bounces between two walls that approach each other does so endlessly in a finite time, and gains speed.
const ELASTIC_BLOWS: u32 = 24;
/// Impulses that a body takes in 1/720 s before it is squeezed.
///
/// Then whatever holds it cannot be satisfied, as between the hand and a wall: it stops, and what moves on overlaps it.
/// Every impulse moves a body that is not squeezed yet, so that no step has more than this for each body. A longer step
/// has room for more: bodies that turn round each other touch anew every few hundredths of a millimetre.
const BLOWS: u32 = 64;
/// Slower approach than this is left to the lasting contact [m/s].
const APPROACH: f64 = 1e-6;
/// Rounds after which restitution is dropped, so that a body between two others comes to terms with them.
const ELASTIC_ROUNDS: usize = 40;

impl World {
    /// Finds and answers all contacts that come about during the step.
    pub(crate) fn run_events(&mut self, dt: f64) {
        self.gather_due();
        let mut due = std::mem::take(&mut self.scratch.due);
        for (_, _, pair) in due.drain(..) {
            self.look(pair, 0.0, dt);
        }
        self.scratch.due = due;
        self.announce_renewals();
        let mut answer = std::mem::take(&mut self.scratch.answer);
        while let Some(next) = self.scratch.events.pop() {
            if !self.is_valid(&next) {
                continue;
            }
            if next.time >= dt {
                break;
            }
            match next.what {
                What::Meet { key, .. } => {
                    self.effort.events += 1;
                    self.answer(key, next.time, dt, &mut answer);
                }
                What::Look { pair, .. } => self.look(pair, next.time, dt),
                What::StretchEnds { slot, .. } => {
                    self.carry_on(slot as usize, next.time, dt, &mut answer);
                }
            }
            self.look_again(&answer.bodies, next.time, dt);
            self.announce_renewals();
            answer.clear();
        }
        self.scratch.events.clear();
        self.scratch.answer = answer;
    }

    /// Looks at a pair from `t` [s] on, and notes its next contact.
    fn look(&mut self, pair: u32, t: f64, dt: f64) {
        if let Some((time, next)) = self.first_contact(pair, t, dt) {
            self.announced += 1;
            let entry = self.pairs.get(pair);
            let bodies = (entry.a, entry.b);
            let changes = |slot: u32| self.bodies[slot as usize].changes;
            let changes = (changes(bodies.0), changes(bodies.1));
            let what = match next {
                Next::Contact(key) => What::Meet { key, changes },
                Next::Look => What::Look {
                    pair,
                    bodies,
                    changes,
                },
            };
            self.scratch.events.push(Event {
                time,
                number: self.announced,
                what,
            });
        }
        self.wait(pair);
    }

    /// Looks at all neighbours of bodies whose motion has changed at `t` [s].
    fn look_again(&mut self, changed: &[usize], t: f64, dt: f64) {
        for slot in changed {
            self.bodies[*slot].changes += 1;
            self.quicken(*slot);
            self.stay_in_box(*slot);
        }
        for (i, slot) in changed.iter().enumerate() {
            for k in 0..self.pairs.near(*slot).len() {
                let near = self.pairs.near(*slot)[k];
                if !changed[..i].contains(&(near.other as usize)) {
                    self.look(near.pair, t, dt);
                }
            }
        }
    }

    /// Whether no body concerned has changed its motion since the event was foreseen.
    fn is_valid(&self, event: &Event) -> bool {
        let now = |slot: u32| self.bodies[slot as usize].changes;
        match event.what {
            What::Meet { key, changes } => changes == (now(key.a), now(key.b)),
            What::Look {
                bodies, changes, ..
            } => changes == (now(bodies.0), now(bodies.1)),
            What::StretchEnds { slot, changes } => changes == now(slot),
        }
    }

    /// Answers one contact and what follows from it at once; notes the bodies involved.
    fn answer(&mut self, key: Key, t: f64, dt: f64, answer: &mut Answer) {
        let Answer {
            bodies,
            struck,
            touches,
        } = answer;
        self.involve(key, t, bodies, touches);
        for round in 0..ROUNDS {
            let Some(worst) = self.most_approaching(touches, round == 0) else {
                break;
            };
            let touch = touches[worst];
            self.effort.impulses += 1;
            self.strike(&touch, round < ELASTIC_ROUNDS);
            self.squeeze(&touch);
            for slot in [touch.a, touch.b] {
                if !struck.contains(&slot) && self.bodies[slot].is_dynamic() {
                    struck.push(slot);
                    self.spread(slot, t, bodies, touches);
                }
            }
        }
        if struck.is_empty() {
            // Nothing approaches: the contact only begins. Its bodies still change from flight to support.
            struck.extend([key.a as usize, key.b as usize]);
            for slot in &*struck {
                self.bodies[*slot].blows += 1;
            }
            self.squeeze(&touches[0]);
            struck.retain(|slot| self.bodies[*slot].is_active());
            for slot in &*struck {
                self.spread(*slot, t, bodies, touches);
            }
        }
        self.settle_touches(touches);
        for slot in &*struck {
            self.bodies[*slot].still_for = 0.0;
        }
        self.join(struck, bodies, touches, t);
        self.set_off(struck, touches, t, dt);
        for slot in &*bodies {
            self.bodies[*slot].look_ahead();
        }
    }

    /// Brings a contact and its bodies into play.
    fn involve(&mut self, key: Key, t: f64, bodies: &mut Vec<usize>, touches: &mut Vec<Touch>) {
        if touches.iter().any(|known| known.key == key) {
            return;
        }
        for slot in [key.a as usize, key.b as usize] {
            if !bodies.contains(&slot) && self.bodies[slot].is_dynamic() {
                bodies.push(slot);
            }
            self.rouse(slot);
            self.bodies[slot].advance(t);
        }
        let touch = self.touch(key);
        touches.push(touch);
    }

    /// A body got an impulse: it wakes, and its other contacts come into play.
    fn spread(&mut self, slot: usize, t: f64, bodies: &mut Vec<usize>, touches: &mut Vec<Touch>) {
        if !self.bodies[slot].is_dynamic() {
            return;
        }
        if self.bodies[slot].asleep {
            self.wake(slot);
        }
        for i in 0..self.pairs.contacts(slot).len() {
            let key = self.pairs.contacts(slot)[i].key;
            self.involve(key, t, bodies, touches);
        }
    }

    /// The contact that approaches fastest; in the first round the event's own.
    fn most_approaching(&self, touches: &mut [Touch], first: bool) -> Option<usize> {
        let mut worst: Option<(usize, f64)> = None;
        for (i, touch) in touches.iter_mut().enumerate() {
            aim(touch, &self.bodies);
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
        let most = self.patience(ELASTIC_BLOWS);
        // What does not move is struck by many bodies in a step, and none of them is worn by that.
        let worn = |slot: usize| {
            let body = &self.bodies[slot];
            body.is_dynamic() && body.blows >= most
        };
        // A slow touch is the beginning of a lasting contact, and that has a friction of its own.
        let is_slow = approach < self.resting_speed();
        let is_worn = !elastic || worn(touch.a) || worn(touch.b);
        let is_soft = is_slow || is_worn;
        self.effort.slow += u64::from(is_slow);
        self.effort.worn += u64::from(is_worn && !is_slow);
        let impulse = self.impact_impulse(touch, slip, is_soft);
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

    /// Impulse of an impact on a [N s]: what the plan has of the law; a `soft` one is neither elastic nor rough.
    fn impact_impulse(&mut self, touch: &Touch, slip: DVec3, is_soft: bool) -> DVec3 {
        let (n, k) = (touch.normal, touch.compliance(&self.bodies));
        let elasticity = if is_soft {
            0.0
        } else {
            self.elasticity_of(touch)
        };
        if elasticity > 0.0 {
            self.effort.work.add(Effect::Elasticity, 1);
        }
        if is_soft || !self.plan.has(Effect::Friction) {
            return smooth_impulse(elasticity, n, slip, &k);
        }
        let friction = self.friction_of(touch);
        self.effort.work.add(Effect::Friction, 1);
        let pair = Coefficients {
            elasticity,
            friction,
        };
        impulse(self.settings.response, pair, n, slip, &k)
    }

    /// So many blows of 1/720 s as blows of a step.
    fn patience(&self, blows: u32) -> u32 {
        blows * (720.0 * self.dt() - 1e-6).ceil().max(1.0) as u32
    }

    /// Stops the bodies of a contact that have taken too many blows, for the rest of the step.
    fn squeeze(&mut self, touch: &Touch) {
        let most = self.patience(BLOWS);
        for slot in [touch.a, touch.b] {
            let body = &mut self.bodies[slot];
            if body.is_dynamic() && body.blows >= most {
                body.squeezed = true;
                self.effort.squeezed += 1;
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
            aim(&mut touch, &self.bodies);
            let separating = -touch.normal.dot(touch.slip(&self.bodies));
            // What overlaps and hardly parts would touch again at once, and for ever.
            let leaving = if touch.gap < -SINK {
                leaving.max(PARTING)
            } else {
                leaving
            };
            let lasts = separating < leaving && touch.gap < RELEASE;
            if lasts {
                self.pairs.set_touching(touch.key, true);
            } else {
                self.part(touch.key);
            }
        }
    }

    /// Adds to the bodies `struck` all that they were carried with, and so on.
    ///
    /// Were one body of a pile set off anew while its neighbour stays in the stretch it is in, the neighbour would
    /// be held up twice: by what that stretch has in store for it, and by the new one.
    pub(super) fn join(
        &mut self,
        struck: &mut Vec<usize>,
        bodies: &mut Vec<usize>,
        touches: &mut Vec<Touch>,
        t: f64,
    ) {
        let mut next = 0;
        while let Some(slot) = struck.get(next).copied() {
            self.spread(slot, t, bodies, touches);
            // A contact that the impact ended held the two together until now.
            for touch in touches.iter().filter(|on| on.a == slot || on.b == slot) {
                let other = touch.a + touch.b - slot;
                if self.bodies[other].is_dynamic() && !struck.contains(&other) {
                    struck.push(other);
                }
            }
            next += 1;
        }
    }

    /// Chooses flight or support of bodies for the rest of the step.
    pub(super) fn set_off(&mut self, joined: &[usize], touches: &[Touch], t: f64, dt: f64) {
        let (gravity, falls) = (self.plan.gravity, self.plan.has(Effect::Gravity));
        let mut carried = std::mem::take(&mut self.scratch.carried);
        for slot in joined {
            let is_carried = !self.pairs.contacts(*slot).is_empty();
            let body = &mut self.bodies[*slot];
            if !body.is_active() {
                continue;
            }
            body.straighten();
            body.acceleration = if is_carried { DVec3::ZERO } else { gravity };
            body.until = dt;
            if falls && !is_carried {
                self.effort.work.add(Effect::Gravity, 1);
            }
            if is_carried {
                carried.push(*slot);
            }
        }
        if !carried.is_empty() && dt - t >= 1e-9 {
            let mut lasting = std::mem::take(&mut self.scratch.touches);
            let movable = |touch: &Touch| {
                let slots = [touch.a, touch.b];
                slots.iter().any(|slot| self.bodies[*slot].is_dynamic())
            };
            let lasts = |touch: &&Touch| self.pairs.part(touch.key).touching && movable(touch);
            lasting.extend(touches.iter().filter(lasts));
            self.carry(&lasting, &carried, t, dt);
            lasting.clear();
            self.scratch.touches = lasting;
        }
        carried.clear();
        self.scratch.carried = carried;
    }
}

/// Puts the point of a contact that is more than a point where the motion of its bodies makes it act.
fn aim(touch: &mut Touch, bodies: &[Body]) {
    if let Some(base) = touch.base {
        touch.set_point(pressure_point(touch, &base, bodies), bodies);
    } else if let Some(patch) = touch.patch
        && touch.chord == DVec3::ZERO
    {
        // Not of a base that tilts: between the corners of its patch its rim is lower.
        touch.set_point(strike_point(touch, &patch, bodies), bodies);
    }
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
