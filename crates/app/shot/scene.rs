//! From arguments to the alley that is thrown in.

use std::path::Path;

use anyhow::Result;
use game::{BareAlley, Config, EffectName, ObjectShape, ResponseModel};
use physics::Effect;

use crate::args::{ModelChoice, ShapeChoice, ThrowArguments, unusable};

/// Settings that have an argument of their own, and its name.
const OWN_ARGUMENTS: [(&str, &str); 5] = [
    ("physics.response", "--model"),
    ("physics.step_hz", "--frame-rate"),
    ("objects.elasticity", "--elasticity"),
    ("objects.friction_rate", "--friction-rate"),
    ("objects.shape", "--shape"),
];

/// The alley of a scene with the arguments' changes.
///
/// # Errors
/// When a setting cannot be used.
pub fn alley(arguments: &ThrowArguments, root: &Path) -> Result<BareAlley> {
    let config = config(arguments, root)?;
    BareAlley::new(&config, &arguments.pins.0).map_err(|error| unusable(error).into())
}

/// Steps of the scene in the simulated time, at least one.
pub fn steps(arguments: &ThrowArguments) -> u64 {
    ((arguments.duration * arguments.frame_rate).round() as u64).max(1)
}

fn config(arguments: &ThrowArguments, root: &Path) -> Result<Config> {
    for setting in &arguments.settings {
        let key = setting.split('=').next().unwrap_or_default().trim();
        if let Some((key, argument)) = OWN_ARGUMENTS.iter().find(|(own, _)| *own == key) {
            let problem = format!("--set {key} has an argument of its own here: give {argument}");
            return Err(unusable(problem).into());
        }
        let of_table = |name: &str| key.starts_with("coulomb.") && key.ends_with(name);
        for (name, argument, value) in [
            ("restitution", "--restitution", arguments.restitution),
            ("friction", "--mu", arguments.mu),
        ] {
            if of_table(name) && value.is_some() {
                let problem =
                    format!("{argument} gives every pair its value: leave out it or --set {key}");
                return Err(unusable(problem).into());
            }
        }
    }
    let folder = root.join("config");
    let mut config = Config::load(&folder, &arguments.scene, None, &arguments.settings)?;
    config.physics.response = match arguments.model {
        ModelChoice::UnoSlater => ResponseModel::UnoSlater,
        ModelChoice::Guarded => ResponseModel::Guarded,
        ModelChoice::Coulomb => ResponseModel::Coulomb,
    };
    config.physics.step_hz = arguments.frame_rate;
    if arguments.no_sleep {
        let effects = &mut config.physics.effects;
        effects.retain(|effect| *effect != EffectName(Effect::Sleeping));
    }
    let objects = &mut config.objects;
    objects.elasticity = arguments.elasticity.unwrap_or(objects.elasticity);
    objects.friction_rate = arguments.friction_rate.unwrap_or(objects.friction_rate);
    objects.shape = match arguments.shape {
        Some(ShapeChoice::True) => ObjectShape::True,
        Some(ShapeChoice::Ellipsoid) => ObjectShape::Ellipsoid,
        None => objects.shape,
    };
    config.coulomb = config.coulomb.with(|pair| {
        pair.restitution = arguments.restitution.unwrap_or(pair.restitution);
        pair.friction = arguments.mu.unwrap_or(pair.friction);
    });
    note_unused(arguments);
    Ok(config)
}

/// Says which coefficients the chosen law does not read, since a sweep over laws gives all of them.
fn note_unused(arguments: &ThrowArguments) {
    let is_coulomb = arguments.model == ModelChoice::Coulomb;
    let unused = [
        ("--elasticity", arguments.elasticity, is_coulomb),
        ("--friction-rate", arguments.friction_rate, is_coulomb),
        ("--restitution", arguments.restitution, !is_coulomb),
        ("--mu", arguments.mu, !is_coulomb),
    ];
    let is_table = |setting: &&String| setting.trim_start().starts_with("coulomb.");
    if !is_coulomb && arguments.settings.iter().any(|setting| is_table(&setting)) {
        eprintln!("note: the table [coulomb] belongs to coulomb; this model does not read it");
    }
    for (name, value, is_unused) in unused {
        if is_unused && value.is_some() {
            let laws = if is_coulomb {
                "uno_slater and guarded"
            } else {
                "coulomb"
            };
            eprintln!("note: {name} belongs to {laws}; this model does not read it");
        }
    }
}
