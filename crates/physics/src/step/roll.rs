//! Rolling resistance: a torque against the relative turning across the normal of a lasting contact.
//!
//! It is at most the normal impulse times an arm, as if the contact pressed that far ahead of where it touches, and it
//! stops the turning rather than reverse it. So it only ever takes energy.

use glam::DVec3;

use super::row::{Mover, Row};

impl Row {
    /// Brakes the rolling at one contact, with `arm` [m].
    ///
    /// Returns by how much that changed the velocity of a surface there at most [m/s], or nothing where nothing rolls:
    /// a flat base that lies does not.
    pub fn brake(&self, arm: f64, all: &mut [Mover]) -> Option<f64> {
        let most = arm * self.pressed();
        if most <= 0.0 || self.touch.base.is_some() {
            return None;
        }
        let n = self.touch.normal;
        let (a, b) = (&all[self.movers.0], &all[self.movers.1]);
        let turning = a.angular - b.angular;
        let across = turning - n * n.dot(turning);
        let rate = across.length();
        if rate == 0.0 {
            return None;
        }
        let axis = across / rate;
        let turns = (a.turn_by(axis), b.turn_by(axis));
        let ease = axis.dot(turns.0 + turns.1);
        if ease <= 0.0 {
            return None;
        }
        let torque = most.min(rate / ease);
        let changes = (turns.0 * -torque, turns.1 * torque);
        all[self.movers.0].angular += changes.0;
        all[self.movers.1].angular += changes.1;
        let surface = |change: DVec3, arm: DVec3| change.length() * arm.length();
        Some(surface(changes.0, self.touch.arm_a) + surface(changes.1, self.touch.arm_b))
    }
}
