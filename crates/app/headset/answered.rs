//! Questions to a runtime that may never answer.

use std::sync::mpsc::{RecvTimeoutError, channel};
use std::time::{Duration, Instant};

/// How often the one who waits looks whether to go on waiting.
const INTERVAL: Duration = Duration::from_millis(50);

/// What `ask` brings, if it does so within `patience` and before it `is_given_up`; it is left behind otherwise, in a thread of its own.
pub fn answered<T: Send + 'static>(
    patience: Duration,
    is_given_up: impl Fn() -> bool,
    ask: impl FnOnce() -> T + Send + 'static,
) -> Option<T> {
    let (tell, told) = channel();
    std::thread::spawn(move || {
        // Nobody waits any more.
        let _ = tell.send(ask());
    });
    let began = Instant::now();
    while began.elapsed() < patience && !is_given_up() {
        match told.recv_timeout(INTERVAL) {
            Ok(answer) => return Some(answer),
            Err(RecvTimeoutError::Timeout) => {}
            Err(RecvTimeoutError::Disconnected) => return None,
        }
    }
    None
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::sync::mpsc::Receiver;

    const LONG: Duration = Duration::from_secs(60);

    #[test]
    fn who_answers_is_heard_and_who_does_not_is_left() {
        assert_eq!(answered(LONG, || false, || 7), Some(7));
        let (hold, held) = channel::<()>();
        let hang = |held: Receiver<()>| move || held.recv().is_ok();
        assert_eq!(answered(Duration::ZERO, || false, hang(held)), None);
        drop(hold);
        let (hold, held) = channel::<()>();
        assert_eq!(answered(LONG, || true, hang(held)), None, "given up");
        drop(hold);
    }
}
