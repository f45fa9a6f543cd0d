//! What a scene calls for: the effects that its steps compute, and how often each of them was.

use std::fmt;

/// A part of mechanics that a scene lists or leaves out.
///
/// What is left out executes nothing in a step. An effect that is listed, in a scene where it has its *neutral value*,
/// changes nothing either; `tests/effects.rs` compares the two.
///
/// | effect | left out | neutral value |
/// |---|---|---|
/// | gravity | bodies fly straight, contacts carry nothing | [`Settings::gravity`](crate::Settings::gravity) of zero |
/// | elasticity | every impact has e = 0 | elasticity, or restitution, of zero |
/// | friction | every contact is smooth: impulses along the normal alone | friction rate, or coefficient, of zero |
/// | rotation | bodies keep their orientation and have no spin | endless inertia, and no spin to begin with |
/// | gyroscopic | free bodies keep their angular velocity, not their angular momentum | three equal moments of inertia |
/// | continuous | contacts are looked for only where bodies are when a tick begins | nothing meets inside the step |
/// | sleeping | every body stays awake | nothing is at rest for 0.25 s |
/// | oil | friction is the same everywhere on a surface | a pattern of factors of 1 |
/// | rolling_resistance | what rolls rolls on | an arm of 0 m |
/// | drag | nothing is slowed by air | a density of 0 kg/m3, or an area of 0 m2 |
/// | hand | driven bodies touch nothing | driven bodies out of reach |
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Effect {
    /// Weight.
    Gravity,
    /// Impacts that give approach speed back.
    Elasticity,
    /// Impulses across the normal, in impacts and in lasting contacts.
    Friction,
    /// Turning.
    Rotation,
    /// The torque-free motion of bodies with unequal moments of inertia: precession, tumbling.
    Gyroscopic,
    /// Contacts found when they come about, inside a step.
    Continuous,
    /// Bodies at rest are skipped until something touches them.
    Sleeping,
    /// Friction that varies with the place on a surface, [`OilPattern`](crate::OilPattern).
    Oil,
    /// A torque against rolling, [`Settings::rolling_resistance_m`](crate::Settings::rolling_resistance_m).
    RollingResistance,
    /// Resistance of the air, [`Settings::air_density_kgpm3`](crate::Settings::air_density_kgpm3).
    Drag,
    /// Contact with driven bodies, such as a hand.
    Hand,
}

impl Effect {
    /// All effects, in the order of their declaration.
    pub const ALL: [Effect; 11] = [
        Effect::Gravity,
        Effect::Elasticity,
        Effect::Friction,
        Effect::Rotation,
        Effect::Gyroscopic,
        Effect::Continuous,
        Effect::Sleeping,
        Effect::Oil,
        Effect::RollingResistance,
        Effect::Drag,
        Effect::Hand,
    ];

    /// Its name in configurations.
    pub const fn name(self) -> &'static str {
        match self {
            Effect::Gravity => "gravity",
            Effect::Elasticity => "elasticity",
            Effect::Friction => "friction",
            Effect::Rotation => "rotation",
            Effect::Gyroscopic => "gyroscopic",
            Effect::Continuous => "continuous",
            Effect::Sleeping => "sleeping",
            Effect::Oil => "oil",
            Effect::RollingResistance => "rolling_resistance",
            Effect::Drag => "drag",
            Effect::Hand => "hand",
        }
    }

    /// The effect of that name, if there is one.
    pub fn from_name(name: &str) -> Option<Effect> {
        Effect::ALL.into_iter().find(|effect| effect.name() == name)
    }
}

impl fmt::Display for Effect {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

/// A set of effects. The default is what an alley without oil, air and rolling resistance calls for.
#[derive(Clone, Copy, PartialEq, Eq)]
pub struct Effects(u16);

impl Effects {
    /// No effect.
    pub const NONE: Effects = Effects(0);

    /// The set with one more effect.
    #[must_use]
    pub const fn with(self, effect: Effect) -> Effects {
        Effects(self.0 | 1 << effect as u16)
    }

    /// The set without an effect.
    #[must_use]
    pub const fn without(self, effect: Effect) -> Effects {
        Effects(self.0 & !(1 << effect as u16))
    }

    /// The set with an effect if it `is_listed`, otherwise without it.
    #[must_use]
    pub const fn set(self, effect: Effect, is_listed: bool) -> Effects {
        if is_listed {
            self.with(effect)
        } else {
            self.without(effect)
        }
    }

    /// Whether an effect is in it.
    pub const fn contains(self, effect: Effect) -> bool {
        self.0 & 1 << effect as u16 != 0
    }

    /// The effects in it, in the order of [`Effect::ALL`].
    pub fn iter(self) -> impl Iterator<Item = Effect> {
        Effect::ALL
            .into_iter()
            .filter(move |effect| self.contains(*effect))
    }

    /// The effects that are in either set.
    pub(crate) const fn or(self, other: Effects) -> Effects {
        Effects(self.0 | other.0)
    }

    /// The effects that are in both sets.
    pub(crate) const fn and(self, other: Effects) -> Effects {
        Effects(self.0 & other.0)
    }
}

impl Default for Effects {
    fn default() -> Effects {
        let extra = [Effect::Oil, Effect::RollingResistance, Effect::Drag];
        Effect::ALL
            .into_iter()
            .filter(|effect| !extra.contains(effect))
            .collect()
    }
}

impl FromIterator<Effect> for Effects {
    fn from_iter<I: IntoIterator<Item = Effect>>(effects: I) -> Effects {
        effects.into_iter().fold(Effects::NONE, Effects::with)
    }
}

impl fmt::Debug for Effects {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_set().entries(self.iter()).finish()
    }
}

/// How often the work of each effect was done on a body or a contact.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Counts([u64; Effect::ALL.len()]);

impl Counts {
    /// How often the effect's work was done.
    pub fn of(&self, effect: Effect) -> u64 {
        self.0[effect as usize]
    }

    pub(crate) fn add(&mut self, effect: Effect, times: usize) {
        self.0[effect as usize] += times as u64;
    }
}

/// How much work a world's steps were so far: counts, not times, so that they are the same on every machine.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Effort {
    /// Stretches of time that islands of lasting contacts were carried through.
    pub stretches: u64,
    /// Contacts that came about and were answered.
    pub events: u64,
    /// Impulses given in their answers.
    pub impulses: u64,
    /// Times at which a pair of parts was looked at.
    pub looks: u64,
    /// Iterations of the detection in those looks.
    pub iterations: u64,
    /// Pairs of parts whose clearance was not used up, so that nothing was looked at.
    pub spared: u64,
    /// Pairs of bodies that were near each other, step by step.
    pub near: u64,
    /// How many of those were due; the others waited.
    pub due: u64,
    /// Answers of single lasting contacts.
    pub passes: u64,
    /// Impulses without elasticity and friction since the bodies met slowly: a contact that lasts begins so.
    pub slow: u64,
    /// Impulses without elasticity and friction since their bodies had taken many in this step.
    pub worn: u64,
    /// Bodies that were stopped for the rest of a step since nothing could satisfy all that they touched.
    pub squeezed: u64,
    /// Searches in time that ended before the step did, and were taken up again where they had ended.
    pub capped: u64,
    /// How often the work of each effect was done on a body or a contact.
    pub work: Counts,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_lead_back_to_their_effects() {
        for effect in Effect::ALL {
            assert_eq!(Effect::from_name(effect.name()), Some(effect));
        }
        assert_eq!(Effect::from_name("magnetism"), None);
    }

    #[test]
    fn a_set_holds_what_was_put_into_it() {
        let set: Effects = [Effect::Drag, Effect::Gravity].into_iter().collect();
        assert!(set.iter().eq([Effect::Gravity, Effect::Drag]));
        assert_eq!(
            set.without(Effect::Drag),
            Effects::NONE.with(Effect::Gravity)
        );
        assert_eq!(format!("{:?}", Effects::NONE.with(Effect::Hand)), "{Hand}");
        assert!(!Effects::default().contains(Effect::Oil));
        assert_eq!(Effects::default().iter().count(), 8);
    }
}
