//! What resists rolling: torques against the relative turning across the normal of a lasting contact.
//!
//! Each is at most the normal impulse times an arm, as if the contact pressed that far ahead of where it touches, and
//! stops the turning rather than reverse it. So it only ever takes energy.

use glam::DVec3;

use super::mover::Mover;
use super::row::Row;

impl Row {
    /// Whether anything resists rolling here, `arm` [m] being the rolling resistance of the scene.
    pub fn resists(&self, arm: Option<f64>) -> bool {
        arm.is_some() || self.touch.chord != DVec3::ZERO
    }

    /// Rolling resistance at one contact, with `arm` [m].
    ///
    /// Returns by how much that changed the velocity of a surface there at most [m/s], or nothing where nothing rolls:
    /// a flat base that lies does not.
    pub fn brake(&self, arm: f64, all: &mut [Mover]) -> Option<f64> {
        if self.touch.base.is_some() {
            return None;
        }
        let n = self.touch.normal;
        let turning = self.turning(all);
        let across = turning - n * n.dot(turning);
        let rate = across.length();
        (rate > 0.0)
            .then(|| self.brake_about(across / rate, rate, arm, all))
            .flatten()
    }

    /// What a tilted base loses while it circles on its edge: part of how things turn here, and with `Effect::Rotation` alone.
    ///
    /// It stands on a chord of its rim, and circling tips it over the chord's foremost end. Rocking tips it about the chord,
    /// which costs nothing before the base is flat. A point would let a pin circle for ever.
    pub fn circle(&self, all: &mut [Mover]) -> Option<f64> {
        let arm = self.touch.chord.length();
        if arm == 0.0 {
            return None;
        }
        let axis = self.touch.chord / arm;
        let rate = axis.dot(self.turning(all));
        self.brake_about(axis * rate.signum(), rate.abs(), arm, all)
    }

    /// Angular velocity of a relative to b [rad/s].
    fn turning(&self, all: &[Mover]) -> DVec3 {
        all[self.movers.0].angular - all[self.movers.1].angular
    }

    /// Slows a relative turning of `rate` [rad/s] about `axis` by the normal impulse at `arm` [m], or stops it.
    fn brake_about(&self, axis: DVec3, rate: f64, arm: f64, all: &mut [Mover]) -> Option<f64> {
        let most = arm * self.pressed();
        let turns = [self.movers.0, self.movers.1].map(|i| all[i].turn_by(axis));
        let ease = axis.dot(turns[0] + turns[1]);
        if most <= 0.0 || rate == 0.0 || ease <= 0.0 {
            return None;
        }
        let torque = most.min(0.5 * rate / ease);
        let changes = (turns[0] * -torque, turns[1] * torque);
        all[self.movers.0].angular += changes.0;
        all[self.movers.1].angular += changes.1;
        let surface = |change: DVec3, arm: DVec3| change.length() * arm.length();
        Some(surface(changes.0, self.touch.arm_a) + surface(changes.1, self.touch.arm_b))
    }
}
