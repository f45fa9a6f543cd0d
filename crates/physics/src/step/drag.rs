//! Resistance of the air: `-1/2 rho C_d A |v| v` on the centre of mass.
//!
//! Half of a step's drag comes before all else and half after it, so that what gravity and contacts do in between is
//! right to second order (Strang's splitting). Without them the two halves are the exact solution for the whole step,
//! `v / (1 + k |v| dt)`. Turning is not slowed.

use crate::effects::Effect;
use crate::world::World;

impl World {
    /// Slows all that moves for half a step of `dt` seconds.
    pub(super) fn slow_in_air(&mut self, dt: f64) {
        let mut slowed = 0;
        for slot in &self.awake {
            let body = &mut self.bodies[*slot as usize];
            if body.drag == 0.0 || !body.is_active() {
                continue;
            }
            let speed = body.linear.length();
            body.linear /= 1.0 + body.drag * speed * (0.5 * dt);
            slowed += 1;
        }
        self.effort.work.add(Effect::Drag, slowed);
    }
}
