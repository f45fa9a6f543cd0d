//! Coefficients of a contact: those of the pair, and what oil makes of them where it lies.

use super::plan::Source;
use super::touch::Touch;
use crate::body::Material;
use crate::effects::Effect;
use crate::response::Response;
use crate::surface::PairContact;
use crate::world::World;

impl World {
    /// Elasticity of a contact, or its restitution under Coulomb's law.
    pub(crate) fn elasticity_of(&self, touch: &Touch) -> f64 {
        let own = |material: &Material| material.elasticity;
        self.of_pair(self.plan.elasticity, touch, own, |pair| pair.restitution)
    }

    /// Friction rate of a contact at its place, or its coefficient under Coulomb's law.
    pub(crate) fn friction_of(&mut self, touch: &Touch) -> f64 {
        let own = |material: &Material| material.friction_rate;
        let friction = self.of_pair(self.plan.friction, touch, own, |pair| pair.friction);
        if self.plan.has(Effect::Oil) {
            friction * self.oil_factor(touch, friction)
        } else {
            friction
        }
    }

    /// A coefficient of a pair: the product of the two objects' own (§2.2), or Coulomb's from his table.
    fn of_pair(
        &self,
        source: Source,
        touch: &Touch,
        own: fn(&Material) -> f64,
        listed: fn(&PairContact) -> f64,
    ) -> f64 {
        let (a, b) = (
            &self.bodies[touch.a].material,
            &self.bodies[touch.b].material,
        );
        match source {
            Source::Nothing => 0.0,
            Source::Products => own(a) * own(b),
            Source::Table => listed(&self.contacts.get(a.surface, b.surface)),
        }
    }

    /// Factor that oil has on the friction of a contact; a rate stays at 1 or below.
    fn oil_factor(&mut self, touch: &Touch, friction: f64) -> f64 {
        let mut factor = 1.0;
        for slot in [touch.a, touch.b] {
            let body = &self.bodies[slot];
            if let Some(oil) = &body.oil {
                factor *= oil.factor_at(&body.pose(), touch.point);
                self.effort.work.add(Effect::Oil, 1);
            }
        }
        if self.settings.response == Response::Coulomb || friction * factor <= 1.0 {
            factor
        } else {
            1.0 / friction
        }
    }
}
