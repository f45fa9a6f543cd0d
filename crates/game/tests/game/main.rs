//! The game as a participant meets it: real physics, everything through inputs.
#![expect(clippy::unwrap_used, reason = "a test that cannot go on fails")]
#![allow(
    clippy::disallowed_methods,
    reason = "what is expected may come from any library"
)]

/// Help for throws.
mod assist;
/// What could be heard of a throw.
mod contacts;
/// Whole throws.
mod let_go;
/// What helps a newcomer.
mod newcomer;
/// A pause, and the way back to the start.
mod pause;
mod play;
/// Tracking space is laid anew.
mod recentre;
/// The same inputs give the same bits.
mod reproduce;
/// Buttons, walking, touching, dropping.
mod room;
/// Hands that jab, squeeze and jump.
mod rough;
/// A participant for tests.
mod support;
