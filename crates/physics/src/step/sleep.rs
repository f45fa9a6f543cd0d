//! Rest: bodies that stopped are skipped until something touches them.

use super::pairs::{Contact, Key};
use crate::body::Motion;
use crate::effects::Effect;
use crate::world::World;

/// Time at rest before sleep [s].
const QUIET: f64 = 0.25;
/// Speed of any surface point below which a body is quiet [m/s].
const QUIET_SPEED: f64 = 1e-4;

impl World {
    pub(crate) fn wake(&mut self, slot: usize) {
        let body = &mut self.bodies[slot];
        body.asleep = false;
        body.still_for = 0.0;
        self.rouse(slot);
    }

    /// Ends a lasting contact; what slept on it may fall now.
    pub(crate) fn part(&mut self, key: Key) {
        if self.pairs.part(key).touching {
            self.pairs.set_touching(key, false);
            self.wake(key.a as usize);
            self.wake(key.b as usize);
        }
    }

    /// A driven body that moves wakes what it touches.
    pub(crate) fn wake_driven_neighbours(&mut self) {
        let mut aged = std::mem::take(&mut self.scratch.aged);
        for slot in &self.awake {
            let body = &self.bodies[*slot as usize];
            if body.motion == Motion::Driven && body.is_busy() {
                aged.extend(self.pairs.contacts(*slot as usize));
                self.effort.work.add(Effect::Hand, 1);
            }
        }
        aged.sort_unstable_by_key(|contact| contact.formed);
        for Contact { key, .. } in aged.drain(..) {
            for (mover, other) in [(key.a, key.b), (key.b, key.a)] {
                let body = &self.bodies[mover as usize];
                let moves = body.motion == Motion::Driven && body.is_busy();
                if moves && self.bodies[other as usize].asleep {
                    self.disturb(other as usize);
                }
            }
        }
        self.scratch.aged = aged;
    }

    /// Puts groups of touching bodies to sleep when all of them have been quiet for a while.
    pub(crate) fn fall_asleep(&mut self, dt: f64) {
        let (mut restless, mut looked_at) = (std::mem::take(&mut self.scratch.restless), 0);
        for slot in &self.awake {
            let body = &mut self.bodies[*slot as usize];
            if !body.is_active() {
                continue;
            }
            looked_at += 1;
            let turning = body.angular_velocity().length() * body.compound.bounding_radius();
            let quiet = body.contacts > 0 && body.linear.length() + turning < QUIET_SPEED;
            body.still_for = if quiet { body.still_for + dt } else { 0.0 };
            body.sleepy = body.still_for > QUIET - 1e-9;
            if !body.sleepy {
                restless.push(*slot);
            }
        }
        self.effort.work.add(Effect::Sleeping, looked_at);
        // A body sleeps only with all that it touches.
        while let Some(slot) = restless.pop() {
            for i in 0..self.pairs.contacts(slot as usize).len() {
                let other = self.pairs.contacts(slot as usize)[i]
                    .key
                    .other(slot as usize);
                let body = &mut self.bodies[other];
                if !body.is_dynamic() {
                    continue;
                }
                if body.asleep {
                    self.wake(other);
                } else if !std::mem::replace(&mut body.sleepy, false) {
                    continue;
                }
                restless.push(other as u32);
            }
        }
        self.scratch.restless = restless;
        for slot in &self.awake {
            let body = &mut self.bodies[*slot as usize];
            if body.is_active() && body.sleepy {
                body.asleep = true;
                body.sleepy = false;
                body.halt();
            }
        }
    }
}
