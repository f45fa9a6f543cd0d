//! An alley for tests and benches: the pin and ball of the reference data, a lane, walls.
#![allow(
    dead_code,
    reason = "every test binary uses its own part of the fixtures"
)]
#![allow(
    clippy::disallowed_methods,
    reason = "what is expected may come from any library"
)]

use std::sync::Arc;

use glam::{DQuat, DVec3};
use physics::{
    BodyDef, BodyId, Compound, Effect, MassProperties, Material, Motion, PairContact, Pose,
    Response, Settings, Shape, Surface, World,
};

/// Height of the pin's centre of mass above its base [m].
pub const PIN_CG: f64 = 0.147461;
/// Radius of the pin's flat base [m].
pub const BASE_RADIUS: f64 = 0.0257935;
/// Ball radius [m].
pub const BALL_RADIUS: f64 = 0.108585;

/// Height above the base to body frame.
fn up(y: f64) -> Pose {
    Pose::from_position(DVec3::new(0.0, y - PIN_CG, 0.0))
}

/// Pin of primitives: flat base, belly, neck and head.
pub fn composite_pin() -> Arc<Compound> {
    let base = Shape::frustum(BASE_RADIUS, 0.0359, 0.0095).expect("fixture sizes are positive");
    let belly =
        Shape::ellipsoid(DVec3::new(0.0605, 0.112, 0.0605)).expect("fixture sizes are positive");
    let neck = Shape::frustum(0.0265, 0.0230, 0.028).expect("fixture sizes are positive");
    let head = Shape::sphere(0.0323).expect("fixture sizes are positive");
    let parts = vec![
        (up(0.0095), base),
        (up(0.1143), belly),
        (up(0.247), neck),
        (up(0.3487), head),
    ];
    Arc::new(Compound::new(parts).expect("fixture sizes are positive"))
}

/// Pin of one ellipsoid that stands on its cut.
pub fn ellipsoid_pin() -> Arc<Compound> {
    let ratio = (1.0 - (BASE_RADIUS / 0.0605f64).powi(2)).sqrt();
    let tall = 0.381 / (1.0 + ratio);
    let shape = Shape::truncated_ellipsoid(DVec3::new(0.0605, tall, 0.0605), -tall * ratio)
        .expect("fixture sizes are positive");
    Arc::new(Compound::new(vec![(up(tall * ratio), shape)]).expect("fixture sizes are positive"))
}

/// Settings with all effects, each with a value that acts.
pub fn every_effect(response: Response) -> Settings {
    Settings {
        effects: Effect::ALL.into_iter().collect(),
        response,
        rolling_resistance_m: 2e-4,
        air_density_kgpm3: 1.2,
        contact: PairContact {
            restitution: 0.5,
            friction: 0.2,
        },
        ..Settings::default()
    }
}

pub fn material(elasticity: f64, friction_rate: f64) -> Material {
    Material {
        elasticity,
        friction_rate,
        surface: Surface::default(),
    }
}

pub const PIN_MASS: MassProperties = MassProperties {
    mass: 1.587573,
    inertia: DVec3::new(1.369813e-2, 2.015449e-3, 1.369813e-2),
};

pub const BALL_MASS: MassProperties = MassProperties {
    mass: 6.803886,
    inertia: DVec3::splat(0.027435),
};

fn def(
    compound: Arc<Compound>,
    motion: Motion,
    mass: MassProperties,
    material: Material,
    at: DVec3,
) -> BodyDef {
    BodyDef {
        compound,
        motion,
        mass,
        material,
        pose: Pose::from_position(at),
        linear_velocity: DVec3::ZERO,
        angular_velocity: DVec3::ZERO,
        drag_area_m2: 0.0,
    }
}

/// A body of one shape, with its moments of inertia per mass [m2].
pub fn solid(shape: Shape, mass: f64, inertia: DVec3, material: Material, pose: Pose) -> BodyDef {
    let compound = Arc::new(Compound::single(shape));
    let mass = MassProperties {
        mass,
        inertia: inertia * mass,
    };
    BodyDef {
        pose,
        ..def(compound, Motion::Dynamic, mass, material, DVec3::ZERO)
    }
}

/// A pin whose base centre stands at `spot`.
pub fn pin(compound: &Arc<Compound>, material: Material, spot: DVec3) -> BodyDef {
    def(
        compound.clone(),
        Motion::Dynamic,
        PIN_MASS,
        material,
        spot + DVec3::Y * PIN_CG,
    )
}

pub fn ball(material: Material, at: DVec3) -> BodyDef {
    let sphere = Arc::new(Compound::single(
        Shape::sphere(BALL_RADIUS).expect("fixture sizes are positive"),
    ));
    def(sphere, Motion::Dynamic, BALL_MASS, material, at)
}

/// A fixed box between two corners.
pub fn block(material: Material, low: DVec3, high: DVec3) -> BodyDef {
    let shape = Shape::cuboid((high - low) * 0.5).expect("fixture sizes are positive");
    def(
        Arc::new(Compound::single(shape)),
        Motion::Fixed,
        PIN_MASS,
        material,
        (low + high) * 0.5,
    )
}

/// A driven ball.
pub fn hand(material: Material, at: DVec3) -> BodyDef {
    let sphere = Arc::new(Compound::single(
        Shape::sphere(0.05).expect("fixture sizes are positive"),
    ));
    def(sphere, Motion::Driven, PIN_MASS, material, at)
}

pub fn spots() -> Vec<DVec3> {
    let mut spots = Vec::new();
    for row in 0..4 {
        for k in 0..=row {
            let x = (f64::from(k) - f64::from(row) * 0.5) * 0.3048;
            spots.push(DVec3::new(x, 0.0, -18.288 - f64::from(row) * 0.263965));
        }
    }
    spots
}

/// Lane, gutters, kickbacks, pit and cushion of fixed boxes.
pub fn add_building(world: &mut World, m: Material) -> Vec<BodyId> {
    add_building_at(world, m, DVec3::ZERO)
}

/// Opposite corners of the boxes that a building is made of [m].
pub fn building_boxes() -> [(DVec3, DVec3); 12] {
    let v = DVec3::new;
    [
        (v(-0.52705, -0.3, -19.156), v(0.52705, 0.0, 0.0)),
        (v(-0.762, -0.3, -19.156), v(-0.52705, -0.0889, 0.0)),
        (v(0.52705, -0.3, -19.156), v(0.762, -0.0889, 0.0)),
        (v(-0.962, -0.3, -20.4), v(-0.762, 0.6, 0.0)),
        (v(0.762, -0.3, -20.4), v(0.962, 0.6, 0.0)),
        (v(-0.962, -0.5, -20.4), v(0.962, -0.3, -19.156)),
        (v(-0.962, -0.3, -20.6), v(0.962, 0.9, -20.06)),
        (v(-2.0, -0.3, 0.0), v(2.0, 0.0, 4.6)),
        (v(-1.2, -0.3, 0.0), v(-1.0, 0.7, 1.0)),
        (v(1.0, -0.3, 0.0), v(1.2, 0.7, 1.0)),
        (v(-2.2, -0.3, 0.0), v(-2.0, 2.5, 4.6)),
        (v(2.0, -0.3, 0.0), v(2.2, 2.5, 4.6)),
    ]
}

fn add_building_at(world: &mut World, m: Material, at: DVec3) -> Vec<BodyId> {
    building_boxes()
        .iter()
        .map(|(low, high)| world.add(block(m, *low + at, *high + at)))
        .collect()
}

/// A whole alley with a rack of pins; returns the pins.
pub fn alley(settings: Settings, pins: &Arc<Compound>, m: Material) -> (World, Vec<BodyId>) {
    let mut world = World::new(settings).expect("fixture sizes are positive");
    add_building(&mut world, m);
    let ids = spots()
        .iter()
        .map(|s| world.add(pin(pins, m, *s)))
        .collect();
    (world, ids)
}

/// Distance from the middle of one of many lanes to that of the next [m].
pub const LANE_SPACING: f64 = 5.0;

/// So many alleys side by side, each with a rack of pins.
pub fn alleys(lanes: u32, settings: Settings, pins: &Arc<Compound>, m: Material) -> World {
    let mut world = World::new(settings).expect("fixture sizes are positive");
    for lane in 0..lanes {
        let at = DVec3::X * (LANE_SPACING * f64::from(lane));
        add_building_at(&mut world, m, at);
        for spot in spots() {
            world.add(pin(pins, m, spot + at));
        }
    }
    world
}

/// Adds a rolling ball that starts `back` metres before the head pin, `x` beside the middle.
pub fn throw(world: &mut World, m: Material, x: f64, back: f64, speed: f64) -> BodyId {
    let mut def = ball(m, DVec3::new(x, BALL_RADIUS, -18.288 + back));
    def.linear_velocity = DVec3::new(0.0, 0.0, -speed);
    def.angular_velocity = DVec3::new(-speed / BALL_RADIUS, 0.0, 0.0);
    world.add(def)
}

/// Angle between a body's axis and the vertical [degrees].
pub fn tilt(world: &World, id: BodyId) -> f64 {
    let axis = world.body(id).pose().rotation * DVec3::Y;
    (axis.x * axis.x + axis.z * axis.z)
        .sqrt()
        .atan2(axis.y)
        .to_degrees()
}

pub fn tilted(angle: f64) -> DQuat {
    DQuat::from_rotation_x(angle)
}

/// Seeded numbers in [-1, 1), the same everywhere.
pub struct Random(pub u64);

impl Random {
    pub fn next(&mut self) -> f64 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        (self.0 >> 11) as f64 / (1u64 << 52) as f64 - 1.0
    }

    pub fn vector(&mut self) -> DVec3 {
        DVec3::new(self.next(), self.next(), self.next())
    }

    pub fn direction(&mut self) -> DVec3 {
        loop {
            if let Some(n) = self.vector().try_normalize() {
                return n;
            }
        }
    }

    pub fn rotation(&mut self) -> DQuat {
        DQuat::from_scaled_axis(self.vector() * 3.0)
    }
}
