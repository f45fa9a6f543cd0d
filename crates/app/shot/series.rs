//! Many pieces of work on all cores, their results in order.

use std::collections::BTreeMap;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::mpsc::sync_channel;
use std::thread::{available_parallelism, scope};

/// Results that a thread may be ahead of the one that is waited for.
const AHEAD: usize = 256;

/// As many threads as were asked for, else one a core.
pub fn threads(asked: Option<u32>) -> usize {
    asked.map_or_else(
        || available_parallelism().map_or(1, usize::from),
        |asked| asked as usize,
    )
}

/// Does pieces 0 to `count` on `threads` threads; `take` gets their results in the order of their numbers.
///
/// # Errors
/// The first of `take`; what has not begun then is left.
pub fn run<T: Send, E>(
    count: u64,
    threads: usize,
    work: impl Fn(u64) -> T + Sync,
    mut take: impl FnMut(T) -> Result<(), E>,
) -> Result<(), E> {
    let next = AtomicU64::new(0);
    scope(|scope| {
        let (sender, receiver) = sync_channel(AHEAD);
        for _ in 0..threads {
            let (sender, next, work) = (sender.clone(), &next, &work);
            scope.spawn(move || {
                loop {
                    let index = next.fetch_add(1, Ordering::Relaxed);
                    // Nobody takes results any more after an error.
                    if index >= count || sender.send((index, work(index))).is_err() {
                        return;
                    }
                }
            });
        }
        drop(sender);
        let (mut waiting, mut due) = (BTreeMap::new(), 0);
        for (index, result) in receiver {
            waiting.insert(index, result);
            while let Some(result) = waiting.remove(&due) {
                take(result)?;
                due += 1;
            }
        }
        Ok(())
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn results_come_in_order_whatever_the_threads() {
        // Later pieces are quicker.
        let work = |index: u64| {
            let turns = (0..(400 - index) * 50).fold(index, |x, y| x.wrapping_mul(31) ^ y);
            (index, turns)
        };
        for threads in [1, 2, 7] {
            let mut seen = Vec::new();
            let taken: Result<(), ()> = run(400, threads, work, |(index, _)| {
                seen.push(index);
                Ok(())
            });
            assert_eq!((taken, seen), (Ok(()), (0..400).collect()));
        }
    }

    #[test]
    fn an_error_ends_it() {
        let begun = AtomicU64::new(0);
        let work = |index| {
            begun.fetch_add(1, Ordering::Relaxed);
            index
        };
        let take = |index| if index < 5 { Ok(()) } else { Err(index) };
        assert_eq!(run(1_000_000, 3, work, take), Err(5));
        assert!(begun.into_inner() < 1_000);
    }
}
