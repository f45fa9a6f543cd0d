//! The plan of a step: which stages run, and what is chosen inside them, decided when the scene is made.
//!
//! An effect is in the plan if the scene lists it and something in the scene calls for it: a weightless scene has
//! no kick of gravity, a scene of smooth objects no friction, whatever it lists. What calls for an effect may be added
//! later; the plan is then made anew, and no step ever decides.

use glam::DVec3;

use crate::effects::{Effect, Effects};
use crate::response::Response;
use crate::settings::Settings;

/// A stage of a step.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Stage {
    /// Driven bodies get the velocities that lead to their targets.
    Drive,
    /// Half of the step's air drag.
    Slow,
    /// What a moving driven body touches wakes.
    WakeHeld,
    /// The lasting contacts.
    Gather,
    /// Lasting contacts are answered, and all bodies are set off.
    Carry,
    /// Contacts that come about, in the order of time, are answered.
    Strike,
    /// Bodies are brought to the end of the step.
    Arrive,
    /// Groups of bodies at rest fall asleep.
    Sleep,
    /// The other half of the step's air drag.
    SlowAgain,
}

impl Stage {
    /// Its name.
    pub fn name(self) -> &'static str {
        match self {
            Stage::Drive => "drive",
            Stage::Slow => "slow",
            Stage::WakeHeld => "wake_held",
            Stage::Gather => "gather",
            Stage::Carry => "carry",
            Stage::Strike => "strike",
            Stage::Arrive => "arrive",
            Stage::Sleep => "sleep",
            Stage::SlowAgain => "slow_again",
        }
    }

    /// What it does, in a few words.
    pub fn purpose(self) -> &'static str {
        match self {
            Stage::Drive => "driven bodies head for their targets",
            Stage::Slow => "first half of the air's drag",
            Stage::WakeHeld => "what a moving hand touches wakes",
            Stage::Gather => "lists the lasting contacts",
            Stage::Carry => "answers lasting contacts, sets bodies off",
            Stage::Strike => "finds and answers contacts that come about",
            Stage::Arrive => "brings bodies to the end of the step",
            Stage::Sleep => "groups at rest fall asleep",
            Stage::SlowAgain => "second half of the air's drag",
        }
    }

    /// Effects that act in it, or whose values are read in it.
    ///
    /// Impacts set struck bodies off anew, with all that carries them: what acts in `Carry` acts in `Strike` too.
    fn effects(self) -> &'static [Effect] {
        match self {
            Stage::Drive => &[],
            // Where down is, for what stands; whether a hand holds what rocks.
            Stage::Gather => &[Effect::Gravity, Effect::Hand],
            Stage::Slow | Stage::SlowAgain => &[Effect::Drag],
            Stage::WakeHeld => &[Effect::Hand],
            // Elasticity: what an edge gives back that tips over; hand: what it holds down is pushed out faster.
            Stage::Carry => &[
                Effect::Gravity,
                Effect::Elasticity,
                Effect::Friction,
                Effect::Rotation,
                Effect::Gyroscopic,
                Effect::Oil,
                Effect::RollingResistance,
                Effect::Hand,
            ],
            Stage::Strike => &[
                Effect::Gravity,
                Effect::Elasticity,
                Effect::Friction,
                Effect::Rotation,
                Effect::Gyroscopic,
                Effect::Continuous,
                Effect::Oil,
                Effect::RollingResistance,
                Effect::Hand,
            ],
            Stage::Arrive => &[Effect::Rotation, Effect::Gyroscopic],
            Stage::Sleep => &[Effect::Sleeping],
        }
    }
}

/// A stage as a scene runs it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PlannedStage {
    /// Which stage.
    pub stage: Stage,
    /// Effects of the scene that act in it.
    pub effects: Effects,
}

/// Where a pair's coefficient comes from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Source {
    /// It is zero.
    Nothing,
    /// The product of the two objects' own (§2.2).
    Products,
    /// The world's table of pairs.
    Table,
}

/// What the steps of a scene do.
#[derive(Clone, Debug)]
pub(crate) struct Plan {
    /// Effects that the scene lists and that something in it calls for.
    pub effects: Effects,
    /// Acceleration of gravity [m/s2]; zero without that effect.
    pub gravity: DVec3,
    pub elasticity: Source,
    pub friction: Source,
    /// Arm of the rolling resistance [m], if there is any.
    pub rolling: Option<f64>,
    /// In the order in which a step runs them.
    pub stages: Vec<Stage>,
}

impl Plan {
    /// The plan of a scene in which something calls for the effects `called`.
    pub fn new(settings: &Settings, called: Effects) -> Plan {
        let effects = effective(settings.effects.and(called));
        let has = |effect: Effect| effects.contains(effect);
        let source = |effect: Effect| match settings.response {
            _ if !has(effect) => Source::Nothing,
            Response::Coulomb => Source::Table,
            _ => Source::Products,
        };
        let stages = |all: &[(Stage, bool)]| {
            let runs = all.iter().filter(|(_, runs)| *runs);
            runs.map(|(stage, _)| *stage).collect()
        };
        Plan {
            effects,
            gravity: if has(Effect::Gravity) {
                settings.gravity
            } else {
                DVec3::ZERO
            },
            elasticity: source(Effect::Elasticity),
            friction: source(Effect::Friction),
            rolling: has(Effect::RollingResistance).then_some(settings.rolling_resistance_m),
            stages: stages(&[
                // Driven bodies move whether they touch something or not.
                (Stage::Drive, called.contains(Effect::Hand)),
                (Stage::Slow, has(Effect::Drag)),
                (Stage::WakeHeld, has(Effect::Hand)),
                (Stage::Gather, true),
                (Stage::Carry, true),
                (Stage::Strike, true),
                (Stage::Arrive, true),
                (Stage::Sleep, has(Effect::Sleeping)),
                (Stage::SlowAgain, has(Effect::Drag)),
            ]),
        }
    }

    pub fn has(&self, effect: Effect) -> bool {
        self.effects.contains(effect)
    }

    /// Its stages, in the order in which a step runs them.
    pub fn stages(&self) -> impl Iterator<Item = PlannedStage> + '_ {
        self.stages.iter().map(|stage| PlannedStage {
            stage: *stage,
            effects: stage
                .effects()
                .iter()
                .copied()
                .collect::<Effects>()
                .and(self.effects),
        })
    }
}

/// Leaves out effects that do nothing without another one.
fn effective(effects: Effects) -> Effects {
    let needs = [
        (Effect::Oil, Effect::Friction),
        (Effect::Gyroscopic, Effect::Rotation),
        (Effect::RollingResistance, Effect::Rotation),
    ];
    needs.into_iter().fold(effects, |effects, (effect, other)| {
        effects.set(effect, effects.contains(effect) && effects.contains(other))
    })
}

#[cfg(test)]
mod tests;
