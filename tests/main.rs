//! Tests of the whole product, one module each.

/// What accuracy costs: dials, references, files.
mod accuracy;
/// Tables in, reports out; power.
mod analyse;
/// Meshes and textures against their generator.
mod assets;
/// What is refused, and with which sentence.
mod bad_input;
/// One recorded throw under several conditions.
mod compare;
/// What a scene calls for, and what it costs.
mod effects;
/// Pictures of hand-set states, both eyes, against references.
mod golden;
/// What is hard for a rigid-body engine, against what analysis says.
mod hard_cases;
/// Questions to the collision detection, in JSON lines.
mod query;
/// A recording of the real program: what is in it, and what a replay finds.
mod recording;
/// The release velocity comes out of the poses as it does out of measured velocities.
mod release;
/// What each scene shows, what that costs, and that the distance does not flicker.
mod scenes;
/// Processes and screens, which the tests of the headset have too.
mod shared;
/// Throws without hands, one and many.
mod shot;
/// What a throw sounds like.
mod sound;
/// Maps of strikes, and what cannot be mapped.
mod strike_map;
/// Studies from plan to tables, killed, damaged, erased.
#[cfg(unix)]
mod study;
/// Folders, and the real program.
mod support;
/// A person bowls in a real window.
mod window;
