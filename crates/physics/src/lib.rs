//! Rigid bodies for an alley: detection and response of Uno and Slater (1997), made exact, in fixed steps.
//!
//! **Frames and units.** SI units and radians, right-handed, +Y up. Positions and velocities are in the world frame,
//! shapes and parts in the body frame, whose origin is the centre of mass. Transforms are `target_from_source`.
//!
//! **A step**, `World::step`, in five lines:
//! 1. Lasting contacts are answered together: half of gravity's kick, the contacts, and again (`step/rest.rs`).
//! 2. Bodies in flight follow their parabola and turn as torque-free bodies do, in closed form (`body/motion.rs`).
//! 3. The next time at which two parts touch is found by advancing along separating normals (`step/approach.rs`).
//! 4. There and then the impact law answers, at that contact and at those it disturbs (`step/events.rs`); back to 3.
//! 5. At the end of the step bodies at rest fall asleep (`step/sleep.rs`).
//!
//! **Detection** (§2.1 of the paper) is in [`query`], usable without a world; **response** (§2.2) in [`response`].
//! What the paper compared its detection with is in [`rival`].
//!
//! **Always.** Same calls, same bits: no clock, no randomness, no threads, no hash order, no sine but glam's `libm`. A
//! clone of a [`World`] is a snapshot. Nothing panics on numbers: bad sizes are refused when a shape is made, and a
//! body whose state stops being finite is frozen where it last was.
//!
//! ```
//! use std::sync::Arc;
//! use glam::DVec3;
//! use physics::{BodyDef, Compound, MassProperties, Material, Motion, Pose, Settings, Shape, Surface, World};
//!
//! let mut world = World::new(Settings::default())?;
//! let material = Material { elasticity: 0.7, friction_rate: 0.7, surface: Surface(0) };
//! let mass = MassProperties { mass: 6.8, inertia: DVec3::splat(0.0274) };
//! let floor = BodyDef {
//!     compound: Arc::new(Compound::single(Shape::half_space(DVec3::Y)?)),
//!     motion: Motion::Fixed,
//!     mass,
//!     material,
//!     pose: Pose::IDENTITY,
//!     linear_velocity: DVec3::ZERO,
//!     angular_velocity: DVec3::ZERO,
//!     drag_area_m2: 0.0,
//! };
//! let ball = BodyDef {
//!     compound: Arc::new(Compound::single(Shape::sphere(0.1)?)),
//!     motion: Motion::Dynamic,
//!     pose: Pose::from_position(DVec3::new(0.0, 1.0, 0.0)),
//!     ..floor.clone()
//! };
//! let floor = world.add(floor);
//! let ball = world.add(ball);
//! while !world.touching(ball, floor) {
//!     world.step();
//! }
//! assert!((world.time() - (2.0 * 0.9 / 9.81f64).sqrt()).abs() < 1.0 / 720.0);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
#![cfg_attr(test, allow(clippy::disallowed_methods))]

// So that unit tests can use the fixtures of the crate's tests, which see it from outside.
#[cfg(test)]
extern crate self as physics;

pub mod advance;
mod body;
mod compound;
mod effects;
mod hash;
mod hull;
mod oil;
mod pose;
pub mod query;
#[cfg(test)]
mod random;
pub mod response;
pub mod rival;
mod settings;
mod shape;
mod step;
mod support;
mod surface;
mod world;

pub use body::{Body, BodyDef, MassProperties, Material, Motion};
pub use compound::{Compound, Part};
pub use effects::{Counts, Effect, Effects, Effort};
pub use oil::{OilError, OilPattern};
pub use pose::Pose;
pub use response::Response;
pub use settings::{Settings, SettingsError};
pub use shape::{Shape, ShapeError};
pub use step::plan::{PlannedStage, Stage};
pub use step::{Stopwatch, Unwatched};
pub use surface::{PairContact, Surface};
pub use world::{BodyId, Impact, World};
