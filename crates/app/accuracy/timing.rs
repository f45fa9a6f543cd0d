//! Times of several settings in turns, so that the machine's moods strike all of them alike.

use std::hint::black_box;
use std::ops::Deref;

use crate::shot::clock::thread_seconds;

/// Processor time per piece of work [ns]: median of the rounds, and the quartiles about it.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Time {
    /// Half of the rounds took less.
    pub median: f64,
    /// A quarter took less.
    pub low: f64,
    /// A quarter took more.
    pub high: f64,
}

/// Work to be timed; says how many pieces it did.
pub type Task<'a> = Box<dyn FnMut() -> u64 + 'a>;

impl Time {
    /// Median and quartiles of what the rounds took [ns] each.
    pub fn of(mut rounds: Vec<f64>) -> Time {
        rounds.sort_by(f64::total_cmp);
        let at = |share: f64| {
            let last = rounds.len().saturating_sub(1) as f64;
            rounds.get((last * share).round() as usize).copied()
        };
        Time {
            median: at(0.5).unwrap_or(0.0),
            low: at(0.25).unwrap_or(0.0),
            high: at(0.75).unwrap_or(0.0),
        }
    }
}

impl Time {
    /// The same for a piece of which this is so much.
    pub fn per(self, much: f64) -> Time {
        Time {
            median: self.median / much,
            low: self.low / much,
            high: self.high / much,
        }
    }
}

/// Work on each of `inputs`, a piece each; nothing that `work` returns is optimised away.
pub fn each<'a, I: 'a, R>(
    inputs: impl Deref<Target = [I]> + 'a,
    work: impl Fn(&I) -> R + 'a,
) -> Task<'a> {
    Box::new(move || {
        for input in inputs.iter() {
            black_box(work(black_box(input)));
        }
        inputs.len() as u64
    })
}

/// Does all tasks once a round, and every other round backwards; the first round only warms up.
pub fn in_turns(rounds: usize, tasks: &mut [Task]) -> Vec<Time> {
    let mut taken = vec![Vec::with_capacity(rounds); tasks.len()];
    for round in 0..=rounds {
        for k in 0..tasks.len() {
            let index = if round % 2 == 0 {
                k
            } else {
                tasks.len() - 1 - k
            };
            let begun = thread_seconds();
            let pieces = tasks[index]();
            let seconds = thread_seconds() - begun;
            if round > 0 {
                taken[index].push(1e9 * seconds / pieces.max(1) as f64);
            }
        }
    }
    taken.into_iter().map(Time::of).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn of_takes_median_and_quartiles() {
        let time = Time::of(vec![5.0, 1.0, 4.0, 2.0, 3.0]);
        assert_eq!((time.low, time.median, time.high), (2.0, 3.0, 4.0));
        assert_eq!(Time::of(Vec::new()), Time::default());
    }

    #[test]
    fn in_turns_gives_every_task_its_rounds_and_counts_pieces() {
        let mut order = Vec::new();
        let cell = std::cell::RefCell::new(&mut order);
        let task = |name: usize| -> Task {
            let cell = &cell;
            Box::new(move || {
                cell.borrow_mut().push(name);
                1000
            })
        };
        let times = in_turns(2, &mut [task(0), task(1)]);
        assert_eq!(times.len(), 2);
        assert_eq!(order, [0, 1, 1, 0, 0, 1]);
    }
}
