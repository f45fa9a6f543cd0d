//! Rigid bodies for an alley: convex shapes, the collision method of Uno and Slater (1997), fixed steps.
#![cfg_attr(test, allow(clippy::disallowed_methods))]

mod body;
mod compound;
mod hash;
mod pose;
pub mod query;
pub mod response;
mod shape;
mod step;
mod support;
mod world;

pub use body::{Body, BodyDef, MassProperties, Material, Motion};
pub use compound::{Compound, Part};
pub use pose::Pose;
pub use response::Response;
pub use shape::{Shape, ShapeError};
pub use world::{BodyId, Impact, Settings, SettingsError, World};
