//! The program in a headset: against Monado, a real OpenXR runtime, whose head, hands and buttons the tests move.
//!
//! `scripts/xr-runtime.sh` unpacks the runtime; `scripts/in-own-network.sh` keeps its open port to this machine.

/// The program as the runtime's client, and the journal that it writes.
mod client;
/// What the eyes show, and what the validation layers say.
mod eyes;
/// Focus, tracking and the runtime come and go.
mod loss;
/// What the machine must offer: the unpacked runtime, a network without neighbours.
mod machine;
/// Walking, grabbing, swinging, releasing, scoring.
mod play;
/// A process that ends with the test.
mod process;
/// Head, hands and buttons through the runtime's remote port.
mod remote;
/// A participant whom the test moves.
mod room;
/// The runtime's service, with a folder, a port and, if need be, a screen of its own.
mod service;
/// How long the first picture takes.
mod start;

use std::time::{Duration, Instant};

/// Asks again and again until there is an answer; none when `limit` has passed.
fn ask_until<T>(limit: Duration, mut ask: impl FnMut() -> Option<T>) -> Option<T> {
    let begun = Instant::now();
    loop {
        if let Some(answer) = ask() {
            return Some(answer);
        }
        if begun.elapsed() >= limit {
            return None;
        }
        // Shorter than a frame, so that nothing that happens once a frame is seen late.
        std::thread::sleep(Duration::from_millis(2));
    }
}
