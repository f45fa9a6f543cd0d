//! The world: bodies, what touches what, and the calls that change them from outside.

use std::sync::Arc;

use glam::DVec3;

use crate::body::{Body, BodyDef, Motion};
use crate::effects::{Effect, Effects, Effort};
use crate::oil::OilPattern;
use crate::pose::Pose;
use crate::response::Response;
use crate::settings::{Settings, SettingsError};
use crate::step::near::Broad;
use crate::step::pairs::Pairs;
use crate::step::plan::{Plan, PlannedStage};
use crate::step::scratch::Scratch;
use crate::surface::{PairContact, PairTable, Surface};

/// A body's name in its world; stale after the body is removed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct BodyId {
    pub(crate) slot: u32,
    generation: u32,
}

/// One impact of the last step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Impact {
    /// First body.
    pub a: BodyId,
    /// Second body.
    pub b: BodyId,
    /// Where they met [m], Eq. (1).
    pub point: DVec3,
    /// Unit normal from a to b, Eq. (2).
    pub normal: DVec3,
    /// Speed at which the contact points approached along the normal [m/s].
    pub approach_speed: f64,
    /// Impulse on a [N s]; b received the opposite.
    pub impulse: DVec3,
}

/// Bodies and their contacts. Cloning it is a snapshot: the clone runs on to the same bits.
#[derive(Clone, Debug)]
pub struct World {
    pub(crate) settings: Settings,
    /// Effects that something in the world calls for.
    called: Effects,
    pub(crate) plan: Plan,
    pub(crate) contacts: PairTable,
    pub(crate) bodies: Vec<Body>,
    /// Per slot: how often it was reused, and whether a body lives in it.
    generations: Vec<(u32, bool)>,
    /// Slots in which no body lives.
    vacant: usize,
    pub(crate) targets: Vec<Option<Pose>>,
    pub(crate) broad: Broad,
    pub(crate) pairs: Pairs,
    /// Bodies that the steps look at, in the order of their numbers when a step begins.
    pub(crate) awake: Vec<u32>,
    /// Contacts foreseen so far.
    pub(crate) announced: u64,
    pub(crate) scratch: Scratch,
    pub(crate) impacts: Vec<Impact>,
    pub(crate) effort: Effort,
    pub(crate) steps: u64,
}

impl World {
    /// An empty world.
    ///
    /// # Errors
    /// On a setting that cannot be used.
    pub fn new(settings: Settings) -> Result<World, SettingsError> {
        settings.check()?;
        let called = settings.calls_for();
        Ok(World {
            settings,
            called,
            plan: Plan::new(&settings, called),
            contacts: PairTable::new(settings.contact),
            bodies: Vec::new(),
            generations: Vec::new(),
            vacant: 0,
            targets: Vec::new(),
            broad: Broad::default(),
            pairs: Pairs::default(),
            awake: Vec::new(),
            announced: 0,
            scratch: Scratch::default(),
            impacts: Vec::new(),
            effort: Effort::default(),
            steps: 0,
        })
    }

    /// The constants it runs with.
    pub fn settings(&self) -> &Settings {
        &self.settings
    }

    /// Sets how two surfaces meet under `Response::Coulomb`, either way round.
    ///
    /// # Errors
    /// On a restitution outside 0 to 1 and on a friction coefficient that is negative or not finite.
    pub fn set_pair(
        &mut self,
        a: Surface,
        b: Surface,
        pair: PairContact,
    ) -> Result<(), SettingsError> {
        if !pair.is_valid() {
            return Err(SettingsError::Pair(pair));
        }
        self.contacts.set(a, b, pair);
        if self.settings.response == Response::Coulomb {
            self.call_for(pair.calls_for());
        }
        Ok(())
    }

    /// Oils a body's surface, in place of the pattern that it had; friction listens to it with `Effect::Oil` alone.
    ///
    /// # Panics
    /// If the body was removed.
    pub fn set_oil(&mut self, id: BodyId, pattern: OilPattern) {
        let slot = self.slot(id);
        self.disturb(slot);
        if !pattern.is_neutral() {
            self.call_for(Effects::NONE.with(Effect::Oil));
        }
        self.bodies[slot].oil = Some(Arc::new(pattern));
    }

    /// The stages that a step runs, in their order, with the effects that act in each.
    ///
    /// An effect is missing if the settings do not list it, and if nothing in the world has called for it so far. What was
    /// called for once stays in the plan when the body is removed that did, or the pair set back to zero: a plan only
    /// grows, so that it is the same whoever came and went.
    pub fn plan(&self) -> impl Iterator<Item = PlannedStage> + '_ {
        self.plan.stages()
    }

    /// Adds a body.
    ///
    /// What no body can have freezes it where it is instead of failing later: a state that is not finite; coefficients outside 0
    /// to 1, which then count as zero; and, unless it is fixed, a mass or a moment that is not positive, a negative drag.
    pub fn add(&mut self, def: BodyDef) -> BodyId {
        let mut body = Body::new(def, &self.settings);
        let vacant = if self.vacant > 0 {
            self.generations.iter().position(|(_, live)| !live)
        } else {
            None
        };
        let slot = match vacant {
            Some(slot) => {
                self.vacant -= 1;
                self.generations[slot].1 = true;
                body.listed = self.bodies[slot].listed;
                self.bodies[slot] = body;
                self.targets[slot] = None;
                slot
            }
            None => {
                self.generations.push((0, true));
                self.bodies.push(body);
                self.targets.push(None);
                self.pairs.grow(self.bodies.len());
                self.bodies.len() - 1
            }
        };
        self.call_for_all_of(slot);
        self.decide_meeting(slot);
        self.renew(slot);
        BodyId {
            slot: slot as u32,
            generation: self.generations[slot].0,
        }
    }

    /// Takes a body out; what it carried wakes.
    ///
    /// # Panics
    /// If the body was removed before.
    pub fn remove(&mut self, id: BodyId) {
        let slot = self.slot(id);
        self.disturb(slot);
        self.generations[slot] = (id.generation + 1, false);
        self.vacant += 1;
        let body = &mut self.bodies[slot];
        (body.collides, body.meets) = (false, false);
        body.motion = Motion::Fixed;
        body.halt();
        self.renew(slot);
    }

    /// Whether the body is still in the world.
    pub fn contains(&self, id: BodyId) -> bool {
        self.generations.get(id.slot as usize) == Some(&(id.generation, true))
    }

    /// The body's state.
    ///
    /// # Panics
    /// If the body was removed.
    pub fn body(&self, id: BodyId) -> &Body {
        &self.bodies[self.slot(id)]
    }

    /// All bodies, in the order of their slots.
    pub fn ids(&self) -> impl Iterator<Item = BodyId> + '_ {
        let live = self.generations.iter().enumerate().filter(|(_, g)| g.1);
        live.map(|(slot, g)| BodyId {
            slot: slot as u32,
            generation: g.0,
        })
    }

    /// Puts a body elsewhere at once, keeping its velocity; wakes it and what it touched.
    ///
    /// Thaws a frozen body. A pose that is none freezes it where it is.
    pub fn set_pose(&mut self, id: BodyId, pose: Pose) {
        let slot = self.slot(id);
        self.disturb(slot);
        let body = &mut self.bodies[slot];
        let angular = body.angular_velocity();
        body.position = pose.position;
        body.rotation = pose.rotation.normalize();
        let linear = body.linear;
        body.set_velocity(linear, angular);
        body.frozen = false;
        body.judge();
        body.last_finite = body.pose();
        self.renew(slot);
    }

    /// Sets velocities [m/s] and [rad/s], world frame; wakes the body. Velocities that are none freeze it.
    ///
    /// A fixed body takes none, and a driven one keeps its own no longer than to the next step: that sets it anew from the
    /// target that [`World::drive_to`] gave, or to zero.
    pub fn set_velocity(&mut self, id: BodyId, linear: DVec3, angular: DVec3) {
        let slot = self.slot(id);
        self.disturb(slot);
        self.bodies[slot].set_velocity(linear, angular);
        self.bodies[slot].judge();
    }

    /// Changes who moves the body; its velocity stays. One that cannot be moved so freezes, see [`World::add`].
    pub fn set_motion(&mut self, id: BodyId, motion: Motion) {
        let slot = self.slot(id);
        self.disturb(slot);
        let body = &mut self.bodies[slot];
        let (linear, angular) = (body.linear, body.angular_velocity());
        body.motion = motion;
        body.set_velocity(linear, angular);
        body.judge();
        self.call_for_all_of(slot);
        self.decide_meeting(slot);
        let body = &mut self.bodies[slot];
        // What it never met while both stood fast.
        body.box_until = f64::NEG_INFINITY;
        self.targets[slot] = None;
    }

    /// Whether the body takes part in collisions; one that does not passes through everything.
    pub fn set_collides(&mut self, id: BodyId, collides: bool) {
        let slot = self.slot(id);
        self.disturb(slot);
        self.bodies[slot].collides = collides;
        self.decide_meeting(slot);
        self.renew(slot);
    }

    /// Tells a driven body where to be at the end of the next step; its velocity follows from the difference.
    ///
    /// A step without a new target leaves it standing. A pose that is not finite or has no orientation is ignored, and so
    /// is the call for a body that is not driven. A target so far away that the way there has no speed freezes the body.
    pub fn drive_to(&mut self, id: BodyId, pose: Pose) {
        let slot = self.slot(id);
        let turns = pose.rotation.length_squared() > 0.0;
        if pose.is_finite() && turns && self.bodies[slot].motion == Motion::Driven {
            self.targets[slot] = Some(pose);
            self.rouse(slot);
        }
    }

    /// Impacts of the last step, in the order in which they happened.
    pub fn impacts(&self) -> &[Impact] {
        &self.impacts
    }

    /// How much work all steps were so far.
    pub fn effort(&self) -> Effort {
        self.effort
    }

    /// Whether two bodies were in contact at the end of the last step: resting on each other or just struck.
    pub fn touching(&self, a: BodyId, b: BodyId) -> bool {
        let (a, b) = (self.slot(a), self.slot(b));
        self.pairs.any_touching(a, b)
            || self.impacts.iter().any(|i| {
                let (x, y) = (i.a.slot as usize, i.b.slot as usize);
                (x, y) == (a, b) || (x, y) == (b, a)
            })
    }

    /// Steps taken since the world was made.
    pub fn steps(&self) -> u64 {
        self.steps
    }

    /// Simulated time [s]: steps over step rate.
    pub fn time(&self) -> f64 {
        self.steps as f64 / self.settings.step_hz
    }

    /// Length of a step [s].
    pub fn dt(&self) -> f64 {
        1.0 / self.settings.step_hz
    }

    /// Kinetic and potential energy of all dynamic bodies [J], the height measured along gravity from the origin.
    ///
    /// Without `Effect::Gravity` there is no potential energy.
    pub fn energy(&self) -> f64 {
        // What has no mass that is one is frozen, and none of the energy.
        let has_energy = |b: &&Body| b.motion == Motion::Dynamic && b.can_move;
        let dynamic = self.bodies.iter().filter(has_energy);
        dynamic
            .map(|b| b.kinetic_energy() - b.mass.mass * self.plan.gravity.dot(b.position))
            .sum()
    }

    /// Takes effects into the plan, where the settings list them.
    pub(crate) fn call_for(&mut self, effects: Effects) {
        let called = self.called.or(effects);
        if called != self.called {
            self.called = called;
            self.plan = Plan::new(&self.settings, called);
        }
    }

    pub(crate) fn id(&self, slot: usize) -> BodyId {
        BodyId {
            slot: slot as u32,
            generation: self.generations[slot].0,
        }
    }

    pub(crate) fn slot(&self, id: BodyId) -> usize {
        assert!(self.contains(id), "body {id:?} was removed from this world");
        id.slot as usize
    }

    /// Forgets what was known about a body that is no longer what or where it was.
    pub(crate) fn renew(&mut self, slot: usize) {
        let body = &mut self.bodies[slot];
        body.fresh = true;
        // Nothing refers to its way any more: from zero on, the same calls give the same bits again.
        body.path = 0.0;
        body.box_until = f64::NEG_INFINITY;
        self.pairs.forget(slot);
        self.rouse(slot);
    }

    /// Wakes a body and all that lean on it.
    pub(crate) fn disturb(&mut self, slot: usize) {
        self.wake(slot);
        for i in 0..self.pairs.contacts(slot).len() {
            let other = self.pairs.contacts(slot)[i].key.other(slot);
            self.wake(other);
        }
    }

    /// Velocity of driven bodies for this step.
    pub(crate) fn aim_driven(&mut self, dt: f64) {
        for slot in &self.awake {
            let body = &mut self.bodies[*slot as usize];
            if body.motion != Motion::Driven {
                continue;
            }
            let (linear, angular) = match self.targets[*slot as usize].take() {
                Some(pose) => {
                    let mut change = pose.rotation * body.rotation.conjugate();
                    if change.w < 0.0 {
                        change = -change;
                    }
                    (
                        (pose.position - body.position) / dt,
                        change.normalize().to_scaled_axis() / dt,
                    )
                }
                None => (DVec3::ZERO, DVec3::ZERO),
            };
            body.set_velocity(linear, angular);
            body.judge();
        }
    }
}
