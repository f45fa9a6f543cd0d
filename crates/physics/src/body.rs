//! One rigid body: its state, and how velocities, momenta and impulses act on it.

mod def;
mod motion;

use std::sync::Arc;

use glam::{DMat3, DQuat, DVec3};

use crate::compound::Compound;
use crate::effects::Effect;
use crate::oil::OilPattern;
use crate::pose::Pose;
use crate::settings::Settings;

pub use def::{BodyDef, MassProperties, Material, Motion};
pub(crate) use motion::{Spin, Sweep, turn};

/// Rates at which velocity and momentum of a carried body change in one half of its stretch.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Bend {
    /// Of the velocity [m/s2].
    pub linear: DVec3,
    /// Of the momentum [N m], at the step's begin; it grows by `drift` [N m/s].
    pub torque: DVec3,
    pub drift: DVec3,
}

impl Bend {
    /// Of a body that nothing carries.
    pub const NONE: Bend = Bend {
        linear: DVec3::ZERO,
        torque: DVec3::ZERO,
        drift: DVec3::ZERO,
    };
}

/// A body in a world. Read it here, change it through the world.
#[derive(Clone, Debug)]
pub struct Body {
    pub(crate) compound: Arc<Compound>,
    pub(crate) motion: Motion,
    pub(crate) mass: MassProperties,
    pub(crate) material: Material,
    pub(crate) collides: bool,
    /// Whether it collides and meets others; see `World::decide_meeting`.
    pub(crate) meets: bool,
    pub(crate) spin: Spin,
    /// `1/2 rho C_d A / m` [1/m].
    pub(crate) drag: f64,
    pub(crate) oil: Option<Arc<OilPattern>>,
    pub(crate) asleep: bool,
    pub(crate) frozen: bool,
    /// Whether a body can have its coefficients, and whether one that is not fixed can have its mass and its drag.
    has_material: bool,
    pub(crate) can_move: bool,
    pub(crate) position: DVec3,
    pub(crate) rotation: DQuat,
    pub(crate) linear: DVec3,
    /// Angular momentum of a dynamic body [N m s]; kept instead of the angular velocity because flight conserves it.
    pub(crate) momentum: DVec3,
    /// Angular velocity of a driven body [rad/s].
    pub(crate) turning: DVec3,
    /// Acceleration for the rest of the step [m/s2]: gravity in flight, zero while something carries the body.
    pub(crate) acceleration: DVec3,
    /// What something that carries the body does before and after the middle of its stretch of time; see `linear_now`.
    pub(crate) bend: [Bend; 2],
    /// Middle of the stretch of time to which velocity and momentum of a carried body belong [s].
    pub(crate) middle: f64,
    /// Time inside the current step up to which the state has been brought [s].
    pub(crate) clock: f64,
    /// Time inside the step up to which its motion is known: the end of its stretch [s].
    pub(crate) until: f64,
    /// Pose at that time if nothing more happens.
    pub(crate) end: Pose,
    /// Upper bound of the way of any surface point since the body was made [m].
    pub(crate) path: f64,
    /// The same up to `until`.
    pub(crate) reach: f64,
    /// Bound of the way in a step that the waits of its pairs count on [m]; see `step/near.rs`.
    pub(crate) pace: f64,
    /// Length of `path` up to which its box in the broad phase holds it [m].
    pub(crate) box_until: f64,
    /// Whether the next step looks at it; see `World::rouse`.
    pub(crate) listed: bool,
    /// Pose after the last step that left the state finite.
    pub(crate) last_finite: Pose,
    /// Time at rest so far [s].
    pub(crate) still_for: f64,
    /// Whether it could sleep, if all that it touches could.
    pub(crate) sleepy: bool,
    /// Number of touching contacts.
    pub(crate) contacts: u32,
    /// Whether it was put where it is since the last step, and may overlap something without moving.
    pub(crate) fresh: bool,
    /// Whether it stands perfectly still in this step, on its base alone.
    pub(crate) rests: bool,
    /// How often its motion has changed inside a step.
    pub(crate) changes: u32,
    /// Impulses taken in this step.
    pub(crate) blows: u32,
    /// Whether it took too many, and stays where it is for the rest of the step.
    pub(crate) squeezed: bool,
}

impl Body {
    pub(crate) fn new(def: BodyDef, settings: &Settings) -> Body {
        let drag = if settings.effects.contains(Effect::Drag) {
            0.5 * settings.air_density_kgpm3 * def.drag_area_m2 / def.mass.mass
        } else {
            0.0
        };
        let (has_material, can_move) = (def.material.is_valid(), def.can_move());
        let material = if has_material {
            def.material
        } else {
            // What touches it is to go on: smooth and inelastic.
            Material {
                elasticity: 0.0,
                friction_rate: 0.0,
                ..def.material
            }
        };
        let mut body = Body {
            compound: def.compound,
            motion: def.motion,
            mass: def.mass,
            material,
            collides: true,
            meets: true,
            spin: if can_move {
                Spin::new(&def.mass, settings.effects)
            } else {
                Spin::Never
            },
            drag,
            oil: None,
            asleep: false,
            frozen: false,
            has_material,
            can_move,
            position: def.pose.position,
            rotation: def.pose.rotation.normalize(),
            linear: DVec3::ZERO,
            momentum: DVec3::ZERO,
            turning: DVec3::ZERO,
            acceleration: DVec3::ZERO,
            bend: [Bend::NONE; 2],
            middle: 0.0,
            clock: 0.0,
            until: 0.0,
            end: def.pose,
            path: 0.0,
            reach: 0.0,
            pace: 0.0,
            box_until: f64::NEG_INFINITY,
            listed: false,
            last_finite: def.pose,
            still_for: 0.0,
            sleepy: false,
            contacts: 0,
            rests: false,
            fresh: true,
            changes: 0,
            blows: 0,
            squeezed: false,
        };
        body.set_velocity(def.linear_velocity, def.angular_velocity);
        body.judge();
        body
    }

    /// `world_from_body`.
    pub fn pose(&self) -> Pose {
        Pose::new(self.position, self.rotation)
    }

    /// Velocity of the centre of mass [m/s], world frame.
    pub fn linear_velocity(&self) -> DVec3 {
        self.linear
    }

    /// Angular velocity [rad/s], world frame.
    pub fn angular_velocity(&self) -> DVec3 {
        match self.motion {
            Motion::Dynamic if self.spin != Spin::Never => {
                let local = self.rotation.conjugate() * self.momentum_now();
                self.rotation * (local / self.mass.inertia)
            }
            Motion::Driven => self.turning,
            Motion::Dynamic | Motion::Fixed => DVec3::ZERO,
        }
    }

    /// Velocity [m/s] of the body's material at a point [m], world frame.
    pub fn velocity_at(&self, point: DVec3) -> DVec3 {
        self.linear_now() + self.angular_velocity().cross(point - self.position)
    }

    /// Kinetic energy [J]; zero unless the body is dynamic.
    pub fn kinetic_energy(&self) -> f64 {
        if self.motion != Motion::Dynamic || self.frozen {
            return 0.0;
        }
        let spin = self.momentum.dot(self.angular_velocity());
        0.5 * (self.mass.mass * self.linear.length_squared() + spin)
    }

    /// Angular momentum about the centre of mass [N m s], world frame; zero unless the body is dynamic.
    pub fn angular_momentum(&self) -> DVec3 {
        self.momentum
    }

    /// Who moves it.
    pub fn motion(&self) -> Motion {
        self.motion
    }

    /// Elasticity and friction rate.
    pub fn material(&self) -> Material {
        self.material
    }

    /// Mass and principal moments.
    pub fn mass(&self) -> MassProperties {
        self.mass
    }

    /// Its surface.
    pub fn compound(&self) -> &Arc<Compound> {
        &self.compound
    }

    /// Whether it takes part in collisions.
    pub fn collides(&self) -> bool {
        self.collides
    }

    /// Whether it rests and is skipped until something touches it.
    pub fn is_asleep(&self) -> bool {
        self.asleep
    }

    /// Whether its state is none (not finite, or made of what no body can be made of, [`crate::World::add`]).
    ///
    /// It then stays where it last was, without velocity, until it is given a pose that is one.
    pub fn is_frozen(&self) -> bool {
        self.frozen
    }

    /// Velocity at the body's clock [m/s].
    ///
    /// A carried body moves at a constant velocity, that of the middle of the stretch; at any other time what its
    /// contacts and gravity do between the middle and that time is to be added. Each half has its own rate: the
    /// velocity then lies between two that the contacts have answered, and what they take in the second half is not
    /// given back in the first. At the end of a step there is nothing to add.
    pub(crate) fn linear_now(&self) -> DVec3 {
        self.linear + self.bend_at(self.clock).linear * (self.clock - self.middle)
    }

    pub(crate) fn momentum_now(&self) -> DVec3 {
        let bend = self.bend_at(self.clock);
        self.momentum + (bend.torque + bend.drift * self.clock) * (self.clock - self.middle)
    }

    /// Rates of velocity and momentum at time `t` [s] of the step.
    pub(crate) fn bend_at(&self, t: f64) -> Bend {
        self.bend[usize::from(t > self.middle)]
    }

    /// Makes velocity and momentum those of the body's clock.
    pub(crate) fn straighten(&mut self) {
        (self.linear, self.momentum) = (self.linear_now(), self.momentum_now());
        self.bend = [Bend::NONE; 2];
    }

    /// Whether impulses move it.
    pub(crate) fn is_dynamic(&self) -> bool {
        self.motion == Motion::Dynamic && !self.frozen && !self.squeezed
    }

    /// Whether it is dynamic and awake.
    pub(crate) fn is_active(&self) -> bool {
        self.is_dynamic() && !self.asleep
    }

    /// Whether it moves by itself, or is moved: what a step has to look at.
    pub(crate) fn is_busy(&self) -> bool {
        match self.motion {
            Motion::Fixed => false,
            Motion::Driven => self.linear != DVec3::ZERO || self.turning != DVec3::ZERO,
            Motion::Dynamic => self.is_active(),
        }
    }

    /// Nothing moves it until further notice.
    pub(crate) fn rest_in_place(&mut self) {
        (self.reach, self.pace) = (0.0, 0.0);
        (self.contacts, self.rests) = (0, false);
        self.end = self.pose();
    }

    /// Whether nothing about it changes in this step.
    pub(crate) fn is_still(&self) -> bool {
        self.reach == 0.0 && !self.fresh
    }

    /// Gives it velocities of its centre of mass [m/s] and of turning [rad/s], world frame; a fixed body keeps none.
    pub(crate) fn set_velocity(&mut self, linear: DVec3, angular: DVec3) {
        self.halt();
        match self.motion {
            Motion::Dynamic => {
                self.linear = linear;
                if self.spin != Spin::Never {
                    let local = self.rotation.conjugate() * angular;
                    self.momentum = self.rotation * (local * self.mass.inertia);
                }
            }
            Motion::Driven => (self.linear, self.turning) = (linear, angular),
            Motion::Fixed => {}
        }
    }

    /// Brings the body to rest where it is.
    pub(crate) fn halt(&mut self) {
        self.linear = DVec3::ZERO;
        self.momentum = DVec3::ZERO;
        self.turning = DVec3::ZERO;
        self.acceleration = DVec3::ZERO;
        self.bend = [Bend::NONE; 2];
    }

    pub(crate) fn inv_mass(&self) -> f64 {
        if self.is_dynamic() {
            1.0 / self.mass.mass
        } else {
            0.0
        }
    }

    /// Inverse inertia, world frame; zero for what nothing moves or turns.
    pub(crate) fn inv_inertia(&self) -> DMat3 {
        if !self.is_dynamic() || self.spin == Spin::Never {
            return DMat3::ZERO;
        }
        let i = self.mass.inertia;
        if i.x == i.y && i.y == i.z {
            return DMat3::from_diagonal(DVec3::splat(1.0 / i.x));
        }
        let r = DMat3::from_quat(self.rotation);
        r * DMat3::from_diagonal(i.recip()) * r.transpose()
    }

    /// Inertia, world frame [kg m2]; zero for what does not turn, so that its angular momentum stays zero.
    pub(crate) fn inertia(&self) -> DMat3 {
        if self.spin == Spin::Never {
            return DMat3::ZERO;
        }
        let i = self.mass.inertia;
        if i.x == i.y && i.y == i.z {
            return DMat3::from_diagonal(i);
        }
        let r = DMat3::from_quat(self.rotation);
        r * DMat3::from_diagonal(i) * r.transpose()
    }

    /// Adds an impulse [N s] at the arm [m] from the centre of mass, Eq. (3)-(6).
    pub(crate) fn push(&mut self, arm: DVec3, impulse: DVec3) {
        if self.is_dynamic() {
            self.linear += impulse / self.mass.mass;
            if self.spin != Spin::Never {
                self.momentum += arm.cross(impulse);
            }
        }
    }
}

impl Body {
    /// Freezes it if its state is none; what is frozen stays so.
    ///
    /// Whoever changes a body from outside ends with this: a number that is none would go over to all that touches it.
    pub(crate) fn judge(&mut self) {
        if self.frozen || !self.is_sound() {
            self.freeze();
        }
    }

    /// Stops the body where it last was, until it is given a pose.
    pub(crate) fn freeze(&mut self) {
        self.frozen = true;
        if !self.pose().is_finite() {
            (self.position, self.rotation) = (self.last_finite.position, self.last_finite.rotation);
        }
        self.halt();
    }

    /// Whether a step can work with it: finite, squares included, and made of what a body can be made of.
    pub(crate) fn is_sound(&self) -> bool {
        let vectors = [self.position, self.linear, self.momentum, self.turning];
        self.rotation.is_finite()
            && vectors.iter().all(|v| v.length_squared().is_finite())
            && self.has_material
            && (self.motion == Motion::Fixed || self.can_move)
    }

    pub(crate) fn is_finite(&self) -> bool {
        self.position.is_finite()
            && self.rotation.is_finite()
            && self.linear.is_finite()
            && self.momentum.is_finite()
            && self.turning.is_finite()
    }
}
