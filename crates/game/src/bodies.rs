//! Bodies of a scene as physics takes them, the same in a session and in a throw without one.

use std::sync::Arc;

use glam::DVec3;
use physics::{
    BodyDef, BodyId, Compound, Effect, MassProperties, Material, Motion, Pose, Response, Settings,
    SettingsError, Shape, ShapeError, Surface, World,
};

use crate::GameError;
use crate::alley::Part;
use crate::components::Shown;
use crate::config::{BallConfig, Config, EffectName, ResponseModel, coulomb};
use crate::pin_shape::pin_mass;
use crate::visible::Model;

/// The empty world that a configuration describes.
///
/// # Errors
/// When physics refuses a setting.
pub(crate) fn world(config: &Config) -> Result<World, SettingsError> {
    let physics = &config.physics;
    let mut world = World::new(Settings {
        step_hz: physics.step_hz,
        gravity: DVec3::NEG_Y * physics.gravity_mps2,
        response: match physics.response {
            ResponseModel::UnoSlater => Response::UnoSlater,
            ResponseModel::Guarded => Response::Guarded,
            ResponseModel::Coulomb => Response::Coulomb,
        },
        iteration_cap: physics.iteration_cap,
        friction_reference_s: physics.friction_reference_s,
        effects: physics.effects.iter().map(|name| name.0).collect(),
        rolling_resistance_m: physics.rolling_resistance_m,
        air_density_kgpm3: physics.air_density_kgpm3,
        contact: config.coulomb.other.contact(),
        ..Settings::default()
    })?;
    for (_, a, b, pair) in config.coulomb.pairs() {
        world.set_pair(a, b, pair.contact())?;
    }
    Ok(world)
}

/// A body at rest, of the condition's one material.
pub(crate) fn body(
    config: &Config,
    surface: Surface,
    compound: Arc<Compound>,
    motion: Motion,
    mass: MassProperties,
    pose: Pose,
) -> BodyDef {
    let objects = &config.objects;
    BodyDef {
        compound,
        motion,
        mass,
        material: Material {
            elasticity: objects.elasticity,
            friction_rate: objects.friction_rate,
            surface,
        },
        pose,
        linear_velocity: DVec3::ZERO,
        angular_velocity: DVec3::ZERO,
        drag_area_m2: 0.0,
    }
}

/// Adds a solid box of the building, the lane with its oil.
///
/// # Errors
/// When a measure is impossible, which a checked configuration has none of.
pub(crate) fn add_part(
    world: &mut World,
    config: &Config,
    part: &Part,
) -> Result<BodyId, GameError> {
    let compound = Arc::new(Compound::single(Shape::cuboid(part.size / 2.0)?));
    let surface = match part.model {
        Model::Lane => coulomb::LANE,
        Model::Gutter => coulomb::GUTTER,
        Model::Kickback => coulomb::KICKBACK,
        Model::Cushion => coulomb::CUSHION,
        Model::Pit => coulomb::PIT,
        _ => coulomb::REST,
    };
    let (motion, mass) = (Motion::Fixed, immovable());
    let id = world.add(body(config, surface, compound, motion, mass, part.pose));
    if part.model == Model::Lane && config.physics.effects.contains(&EffectName(Effect::Oil)) {
        // The lane's box is upright, and its middle lies behind or before the foul line.
        let foul_line = -part.pose.position.z;
        world.set_oil(id, config.oil.pattern(config.lane.width_m, foul_line)?);
    }
    Ok(id)
}

/// A pin that stands on a spot of the deck.
pub(crate) fn pin(config: &Config, compound: Arc<Compound>, spot: DVec3) -> BodyDef {
    let pose = Pose::from_position(spot + DVec3::Y * config.pin.cg_height_m);
    let mass = pin_mass(&config.pin);
    BodyDef {
        drag_area_m2: config.pin.drag_area_m2,
        ..body(config, coulomb::PIN, compound, Motion::Dynamic, mass, pose)
    }
}

/// A ball with its centre at `centre`.
///
/// # Errors
/// When a length is impossible, which a checked configuration has none of.
pub(crate) fn ball(
    config: &Config,
    ball: &BallConfig,
    centre: DVec3,
) -> Result<BodyDef, ShapeError> {
    let compound = Arc::new(Compound::single(Shape::sphere(ball.radius_m())?));
    let mass = MassProperties {
        mass: ball.mass_kg,
        inertia: DVec3::splat(ball.mass_kg * ball.rg_m * ball.rg_m),
    };
    let pose = Pose::from_position(centre);
    let motion = Motion::Dynamic;
    Ok(BodyDef {
        drag_area_m2: ball.drag_area_m2,
        ..body(config, coulomb::BALL, compound, motion, mass, pose)
    })
}

/// What is seen of a pin, whatever shape it collides with.
pub(crate) fn shown_pin(config: &Config, number: u8) -> Shown {
    let pin = &config.pin;
    let width = 2.0 * pin.parts.belly_radius_m;
    Shown {
        model: Model::Pin(number),
        size: DVec3::new(width, pin.height_m, width),
        body_from_model: Pose::from_position(DVec3::NEG_Y * pin.cg_height_m),
        is_hidden: false,
    }
}

/// What is seen of a ball.
pub(crate) fn shown_ball(ball: &BallConfig, index: u8) -> Shown {
    Shown {
        model: Model::Ball(index),
        size: DVec3::splat(ball.diameter_m),
        body_from_model: Pose::IDENTITY,
        is_hidden: false,
    }
}

/// Mass of what is fixed or driven: physics asks for one and does not use it.
pub(crate) fn immovable() -> MassProperties {
    MassProperties {
        mass: 1.0,
        inertia: DVec3::ONE,
    }
}
