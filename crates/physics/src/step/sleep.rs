//! Rest: bodies that stopped are skipped until something touches them.

use super::pairs::Key;
use crate::body::Motion;
use crate::world::World;

/// Time at rest before sleep [s].
const QUIET: f64 = 0.25;
/// Speed of any surface point below which a body is quiet [m/s].
const QUIET_SPEED: f64 = 1e-4;

impl World {
    pub(crate) fn wake(&mut self, slot: usize) {
        let body = &mut self.bodies[slot];
        body.asleep = false;
        body.still_steps = 0;
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
        for i in 0..self.pairs.touching.len() {
            let key = self.pairs.touching[i];
            for (mover, other) in [(key.a, key.b), (key.b, key.a)] {
                let body = &self.bodies[mover as usize];
                let moves = body.motion == Motion::Driven
                    && (body.linear != glam::DVec3::ZERO || body.turning != glam::DVec3::ZERO);
                if moves && self.bodies[other as usize].asleep {
                    self.disturb(other as usize);
                }
            }
        }
    }

    /// Puts groups of touching bodies to sleep when all of them have been quiet for a while.
    pub(crate) fn fall_asleep(&mut self, dt: f64) {
        let needed = (QUIET / dt).ceil() as u32;
        let mut ready = vec![false; self.bodies.len()];
        for (slot, body) in self.bodies.iter_mut().enumerate() {
            if !body.is_active() {
                ready[slot] = true;
                continue;
            }
            let turning = body.angular_velocity().length() * body.compound.bounding_radius();
            let quiet = body.contacts > 0 && body.linear.length() + turning < QUIET_SPEED;
            body.still_steps = if quiet { body.still_steps + 1 } else { 0 };
            ready[slot] = body.still_steps >= needed;
        }
        // A body sleeps only with all that it touches.
        loop {
            let mut changed = false;
            for key in &self.pairs.touching {
                let (a, b) = (key.a as usize, key.b as usize);
                let both_move = self.bodies[a].is_dynamic() && self.bodies[b].is_dynamic();
                if both_move && ready[a] != ready[b] {
                    (ready[a], ready[b]) = (false, false);
                    changed = true;
                }
            }
            if !changed {
                break;
            }
        }
        for (slot, body) in self.bodies.iter_mut().enumerate() {
            if body.is_active() && ready[slot] {
                body.asleep = true;
                body.halt();
                body.reach = 0.0;
            } else if body.asleep && !ready[slot] {
                body.asleep = false;
                body.still_steps = 0;
            }
        }
    }
}
