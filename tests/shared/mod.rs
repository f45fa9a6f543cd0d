//! What the tests of the product and those of the headset have in common.

/// A process that ends with the test.
pub mod process;
/// A screen in memory.
pub mod screen;

use std::time::{Duration, Instant};

/// Asks again and again until there is an answer; none when `limit` has passed.
pub fn ask_until<T>(limit: Duration, mut ask: impl FnMut() -> Option<T>) -> Option<T> {
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
