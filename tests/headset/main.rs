//! The program in a headset: against Monado, a real OpenXR runtime, whose head, hands and buttons the tests move.
//!
//! `scripts/xr-runtime.sh` unpacks the runtime; `scripts/in-own-network.sh` keeps its open port to this machine.

/// The order in which the runtime is called.
mod calls;
/// The program as the runtime's client, and the journal that it writes.
mod client;
/// `monado-ctl`.
mod control;
/// Play that goes on and on.
mod endurance;
/// The experimenter's window beside the headset.
mod experimenter;
/// What the eyes show.
mod eyes;
/// Bare hands.
mod hands;
/// Buttons and triggers, of the controllers that the runtime has.
mod inputs;
/// Tests that run as a client of the runtime themselves.
mod inside;
/// Focus, tracking and the runtime come and go.
mod loss;
/// What the machine must offer: the unpacked runtime, a network without neighbours.
mod machine;
/// Walking, grabbing, swinging, releasing, scoring.
mod play;
/// Head, hands and buttons through the runtime's remote port.
mod remote;
/// A participant whom the test moves.
mod room;
/// The runtime's service, with a folder, a port and, if need be, a screen of its own.
mod service;
/// Processes and screens, which the tests of the product have too.
#[path = "../shared/mod.rs"]
mod shared;
/// What is done to processes.
mod signals;
/// How long the first picture takes.
mod start;
/// A study's questions in the room, and what its tables say of the device.
mod study;
/// The validation layers watch every program of these tests, and are watched.
mod validation;
/// The panel at the wrist, and the fence where the tracked space ends.
mod wrist;
