//! What in a scene calls for an effect; what nothing calls for is not in its plan.

use crate::body::{Body, Motion};
use crate::effects::{Effect, Effects};
use crate::response::Response;
use crate::settings::Settings;
use crate::surface::PairContact;
use crate::world::World;

/// The effects of those pairs that are true.
fn all_of(pairs: &[(Effect, bool)]) -> Effects {
    let called = pairs.iter().filter(|(_, called)| *called);
    called.map(|(effect, _)| *effect).collect()
}

impl Settings {
    /// Effects that a scene with these settings calls for before it has any body.
    pub(crate) fn calls_for(&self) -> Effects {
        let mut pair = Effects::NONE;
        if self.response == Response::Coulomb {
            pair = self.contact.calls_for();
        }
        let own = all_of(&[
            (Effect::Gravity, self.gravity != glam::DVec3::ZERO),
            (Effect::Rotation, true),
            (Effect::Continuous, true),
            (Effect::Sleeping, true),
            (Effect::RollingResistance, self.rolling_resistance_m > 0.0),
        ]);
        own.or(pair)
    }
}

impl PairContact {
    /// Effects that such a pair calls for.
    pub(crate) fn calls_for(&self) -> Effects {
        all_of(&[
            (Effect::Elasticity, self.restitution > 0.0),
            (Effect::Friction, self.friction > 0.0),
        ])
    }
}

impl Body {
    /// Effects that the body calls for under a law of impacts.
    fn calls_for(&self, response: Response) -> Effects {
        let (inertia, material) = (self.mass.inertia, self.material);
        let by_rate = response != Response::Coulomb;
        let is_even = inertia.x == inertia.y && inertia.y == inertia.z;
        all_of(&[
            (Effect::Elasticity, by_rate && material.elasticity > 0.0),
            (Effect::Friction, by_rate && material.friction_rate > 0.0),
            (
                Effect::Gyroscopic,
                self.motion == Motion::Dynamic && !is_even,
            ),
            (Effect::Drag, self.drag > 0.0),
            (Effect::Hand, self.motion == Motion::Driven),
        ])
    }
}

impl World {
    /// Lets the plan have all that a body calls for.
    pub(crate) fn call_for_all_of(&mut self, slot: usize) {
        let called = self.bodies[slot].calls_for(self.settings.response);
        self.call_for(called);
    }

    /// Decides whether a body meets others: driven bodies do not without `Effect::Hand`.
    pub(crate) fn decide_meeting(&mut self, slot: usize) {
        let touches = self.settings.effects.contains(Effect::Hand);
        let body = &mut self.bodies[slot];
        let meets = body.collides && (touches || body.motion != Motion::Driven);
        if std::mem::replace(&mut body.meets, meets) != meets {
            self.renew(slot);
        }
    }
}
