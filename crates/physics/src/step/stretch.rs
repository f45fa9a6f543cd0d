//! Stretches of time: how long bodies that contacts join are carried before their contacts are looked at anew.
//!
//! Flight is exact however long it lasts. A carried body moves at one velocity, and how soon that becomes wrong differs:
//! a pile of still pins does with one stretch a step, a pin that rocks needs many. So each island has its own.

use super::RELEASE;
use super::scratch::Answer;
use super::search::{Event, What};
use super::touch::Touch;
use crate::world::World;

/// Stretches per second of a base that rocks, and of contacts that change little.
const FINEST: f64 = 720.0;
const COARSEST: f64 = 90.0;
/// How far a body with a lasting contact may turn in a stretch [rad].
const TURN: f64 = 0.04;

impl World {
    /// Length of the next stretch of an island [s]: `left` in equal parts, as many as its contacts ask for.
    pub(crate) fn stretch(&self, touches: &[Touch], left: f64) -> f64 {
        let rates = touches.iter().map(|touch| self.stretch_rate(touch));
        let rate = rates.fold(0.0, f64::max);
        let parts = (left * rate - 1e-6).ceil();
        if parts > 1.0 { left / parts } else { left }
    }

    /// Stretches per second that a lasting contact needs.
    ///
    /// A base that tilts changes its mind about where it stands, and a body that turns takes its contacts round with it.
    fn stretch_rate(&self, touch: &Touch) -> f64 {
        if touch.on_base && touch.base.is_none() {
            return FINEST;
        }
        let turning = [touch.a, touch.b].map(|slot| {
            let body = &self.bodies[slot];
            if body.is_active() {
                body.turning_across()
            } else {
                0.0
            }
        });
        (turning[0].max(turning[1]) / TURN).clamp(COARSEST, FINEST)
    }

    /// Puts the ends of the stretches that have begun among the events.
    pub(crate) fn announce_renewals(&mut self) {
        while let Some((time, slot)) = self.scratch.renewals.pop() {
            self.announced += 1;
            let changes = self.bodies[slot as usize].changes;
            self.scratch.events.push(Event {
                time,
                number: self.announced,
                what: What::StretchEnds { slot, changes },
            });
        }
    }

    /// Carries the island of `slot` on from `t` [s], with the contacts that it has then.
    pub(crate) fn carry_on(&mut self, slot: usize, t: f64, dt: f64, answer: &mut Answer) {
        let Answer {
            bodies,
            struck,
            touches,
        } = answer;
        bodies.push(slot);
        struck.push(slot);
        self.bodies[slot].advance(t);
        self.join(struck, bodies, touches, t);
        for touch in touches.iter().filter(|touch| touch.gap > RELEASE) {
            self.part(touch.key);
        }
        self.set_off(struck, touches, t, dt);
        for slot in &*bodies {
            self.bodies[*slot].look_ahead();
        }
    }
}
