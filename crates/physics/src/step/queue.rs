//! Pairs in the order in which they have to be looked at again.
//!
//! A wheel with a list for each of the coming steps: to put a pair in, to move it and to take it out costs the same
//! however many others wait, and a step touches only those whose time has come. Waits longer than the wheel is round
//! are served early and put in again.

/// Steps that the wheel covers.
const ROUND: u64 = 128;
/// No pair, and no place on the wheel.
const NONE: u32 = u32::MAX;

/// Place of one pair in the list of its step.
#[derive(Clone, Copy, Debug)]
struct Link {
    before: u32,
    after: u32,
    place: u32,
}

const LOOSE: Link = Link {
    before: NONE,
    after: NONE,
    place: NONE,
};

/// Who waits, and for which step.
#[derive(Clone, Debug)]
pub(crate) struct Queue {
    first: [u32; ROUND as usize],
    links: Vec<Link>,
    /// Steps served so far.
    served: u64,
}

impl Default for Queue {
    fn default() -> Queue {
        Queue {
            first: [NONE; ROUND as usize],
            links: Vec::new(),
            served: 0,
        }
    }
}

impl Queue {
    /// Lets a pair wait for `wait` more steps, zero being the next that is served; an earlier wait is forgotten.
    pub fn put(&mut self, pair: u32, wait: u64) {
        let place = ((self.served + wait.min(ROUND - 1)) % ROUND) as u32;
        let index = pair as usize;
        if self.links.len() <= index {
            self.links.resize(index + 1, LOOSE);
        }
        if self.links[index].place == place {
            return;
        }
        self.take_out(pair);
        let after = std::mem::replace(&mut self.first[place as usize], pair);
        self.links[index] = Link {
            before: NONE,
            after,
            place,
        };
        if after != NONE {
            self.links[after as usize].before = pair;
        }
    }

    /// Lets a pair wait no longer.
    pub fn take_out(&mut self, pair: u32) {
        let Some(link) = self.links.get_mut(pair as usize) else {
            return;
        };
        let Link {
            before,
            after,
            place,
        } = std::mem::replace(link, LOOSE);
        if place == NONE {
            return;
        }
        match before {
            NONE => self.first[place as usize] = after,
            _ => self.links[before as usize].after = after,
        }
        if after != NONE {
            self.links[after as usize].before = before;
        }
    }

    /// Serves a step: takes out those whose time has come and appends them, in no order that matters.
    pub fn serve(&mut self, due: &mut Vec<u32>) {
        let place = (self.served % ROUND) as usize;
        let mut pair = std::mem::replace(&mut self.first[place], NONE);
        while pair != NONE {
            due.push(pair);
            pair = std::mem::replace(&mut self.links[pair as usize], LOOSE).after;
        }
        self.served += 1;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn serve(queue: &mut Queue) -> Vec<u32> {
        let mut due = Vec::new();
        queue.serve(&mut due);
        due.sort_unstable();
        due
    }

    #[test]
    fn pairs_come_out_in_the_step_they_wait_for() {
        let mut queue = Queue::default();
        queue.put(3, 0);
        queue.put(1, 2);
        queue.put(2, 2);
        queue.put(7, 2);
        queue.put(2, 1);
        queue.take_out(7);
        queue.take_out(9);
        assert_eq!(serve(&mut queue), [3]);
        assert_eq!(serve(&mut queue), [2]);
        queue.put(3, 0);
        assert_eq!(serve(&mut queue), [1, 3]);
        assert!((0..300).all(|_| serve(&mut queue).is_empty()));
    }

    #[test]
    fn a_long_wait_is_served_early_never_late() {
        let mut queue = Queue::default();
        queue.put(0, 1_000_000);
        let steps = (0..).take_while(|_| serve(&mut queue).is_empty()).count();
        assert_eq!(steps as u64, ROUND - 1);
    }

    #[test]
    fn waits_agree_with_a_list_that_is_searched() {
        let mut queue = Queue::default();
        let mut waits = [None; 40];
        let mut word = 1u64;
        for step in 0..5000u64 {
            for _ in 0..4 {
                word = word.wrapping_mul(6364136223846793005).wrapping_add(1);
                let (pair, wait) = (((word >> 33) % 40) as usize, (word >> 45) % 90);
                if wait == 0 {
                    queue.take_out(pair as u32);
                    waits[pair] = None;
                } else {
                    queue.put(pair as u32, wait);
                    waits[pair] = Some(step + wait);
                }
            }
            let expected: Vec<u32> = (0..40)
                .filter(|i| waits[*i as usize] == Some(step))
                .collect();
            for pair in &expected {
                waits[*pair as usize] = None;
            }
            assert_eq!(serve(&mut queue), expected);
        }
    }
}
