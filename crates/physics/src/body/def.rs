//! What a body is made of and starts with.

use std::sync::Arc;

use glam::DVec3;

use crate::compound::Compound;
use crate::pose::Pose;
use crate::surface::Surface;

/// Mass and principal moments; properties of the object, not of the shape that stands in for it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MassProperties {
    /// Mass [kg].
    pub mass: f64,
    /// Moments of inertia about the body's x, y and z axes through the centre of mass [kg m2].
    pub inertia: DVec3,
}

impl MassProperties {
    /// Whether a body can have these: all positive and finite.
    pub fn is_valid(&self) -> bool {
        let positive = |x: f64| x > 0.0 && x.is_finite();
        positive(self.mass) && self.inertia.to_array().into_iter().all(positive)
    }
}

/// The paper's coefficients of one object, of which a pair uses the products (§2.2), and what Coulomb's law goes by.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Material {
    /// Elasticity, 0 to 1.
    pub elasticity: f64,
    /// Friction rate as the paper defines it, 0 to 1; not a Coulomb coefficient.
    pub friction_rate: f64,
    /// Its row in the table of the world's pairs, [`crate::World::set_pair`]; read by `Response::Coulomb` alone.
    pub surface: Surface,
}

impl Material {
    /// Whether both coefficients lie between 0 and 1.
    pub fn is_valid(&self) -> bool {
        let unit = 0.0..=1.0;
        unit.contains(&self.elasticity) && unit.contains(&self.friction_rate)
    }
}

/// Who moves a body.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Motion {
    /// Nobody: part of the building.
    Fixed,
    /// The caller, through [`crate::World::drive_to`]; it pushes others and nothing pushes it.
    Driven,
    /// The laws of physics.
    Dynamic,
}

/// What a body starts with.
#[derive(Clone, Debug)]
pub struct BodyDef {
    /// Surface, in the body frame (origin at the centre of mass).
    pub compound: Arc<Compound>,
    /// Who moves it.
    pub motion: Motion,
    /// Mass and inertia; used while the body is `Dynamic`.
    pub mass: MassProperties,
    /// Elasticity and friction rate.
    pub material: Material,
    /// `world_from_body`.
    pub pose: Pose,
    /// Velocity of the centre of mass [m/s], world frame.
    pub linear_velocity: DVec3,
    /// Angular velocity [rad/s], world frame.
    pub angular_velocity: DVec3,
    /// Drag coefficient times cross-section, C_d A [m2]; 0 for a body that air does not slow.
    pub drag_area_m2: f64,
}

impl BodyDef {
    /// Whether a body can move so; something that never moves may have any mass.
    pub(crate) fn can_move(&self) -> bool {
        let drags = self.drag_area_m2 >= 0.0 && self.drag_area_m2.is_finite();
        self.mass.is_valid() && drags
    }
}
