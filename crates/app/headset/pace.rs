//! Whether the machine holds the display's rate; a lower one is asked for while it does not.

use std::collections::VecDeque;

use renderer::headset::Note;

/// Frames that are judged together: some five seconds.
const WINDOW: usize = 450;
/// Of so many frames one may come too late. A single hitch, however long, is one frame.
const LATE_ONE_IN: usize = 20;

/// Frames after a choice that are not judged: some first pictures are always late.
const BEGINNING: usize = 90;

/// The frames since the rate was chosen, until the first throw: a rate that changes later would be a difference between two throws
/// that nobody planned.
#[derive(Debug, Default)]
pub struct Pace {
    /// Frames so far that were not judged.
    begun: usize,
    /// Whether each frame of the window came too late.
    late: VecDeque<bool>,
    /// What the display has [Hz], as far as the runtime tells.
    rate_hz: Option<f32>,
    is_settled: bool,
}

impl Pace {
    /// The rate stays as it is.
    pub fn settled() -> Self {
        Self {
            is_settled: true,
            ..Self::default()
        }
    }

    /// A throw or a game: nothing changes any more.
    pub fn settle(&mut self) {
        self.is_settled = true;
    }

    /// Hears which rate the display has: the count begins anew.
    pub fn hear(&mut self, note: &Note) {
        if let Note::RefreshRate(rate) = note {
            *self = Self {
                rate_hz: Some(*rate),
                is_settled: self.is_settled,
                ..Self::default()
            };
        }
    }

    /// Takes down a picture that a participant saw, `period_s` after the one before as the runtime has it, and `missed` old ones
    /// between. Whether they come late so often that a lower rate must be tried; the count begins anew then.
    pub fn is_lost(&mut self, missed: u64, period_s: f64) -> bool {
        if self.is_settled {
            return false;
        }
        if self.begun < BEGINNING {
            self.begun += 1;
            return false;
        }
        // A runtime that has given up by itself tells of a longer period and of none missed.
        let is_halved = (self.rate_hz).is_some_and(|rate| period_s * f64::from(rate) > 1.5);
        self.late.push_back(missed > 0 || is_halved);
        if self.late.len() < WINDOW {
            return false;
        }
        let late = self.late.iter().filter(|is_late| **is_late).count();
        let is_lost = late * LATE_ONE_IN > WINDOW;
        if is_lost {
            self.late.clear();
        } else {
            self.late.pop_front();
        }
        is_lost
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const PERIOD_S: f64 = 1.0 / 90.0;

    /// At which of `frames` frames behind the beginning the pace was lost, when every `nth` misses a picture.
    fn lost(pace: &mut Pace, frames: usize, nth: usize) -> Vec<usize> {
        assert!(!(0..BEGINNING).any(|_| pace.is_lost(9, PERIOD_S)));
        (1..=frames)
            .filter(|index| pace.is_lost(u64::from(index % nth == 0), PERIOD_S))
            .collect()
    }

    #[test]
    fn a_rate_that_is_held_stays() {
        assert!(lost(&mut Pace::default(), 10 * WINDOW, 21).is_empty());
    }

    #[test]
    fn a_rate_that_is_not_held_is_lowered_once_in_a_window() {
        let at = lost(&mut Pace::default(), 2 * WINDOW + 10, 18);
        assert_eq!(at, [WINDOW, 2 * WINDOW]);
    }

    #[test]
    fn a_hitch_is_no_reason() {
        let mut pace = Pace::default();
        let hitch = |index| if index == 500 { 90 } else { 0 };
        assert!(!(0..2000).any(|index| pace.is_lost(hitch(index), PERIOD_S)));
    }

    #[test]
    fn a_runtime_that_halved_its_rate_does_not_hold_it() {
        let mut pace = Pace::default();
        pace.hear(&Note::RefreshRate(90.0));
        let lost =
            |pace: &mut Pace, period| (0..BEGINNING + WINDOW).any(|_| pace.is_lost(0, period));
        assert!(!lost(&mut pace, PERIOD_S));
        assert!(lost(&mut pace, 2.0 * PERIOD_S));
        pace.hear(&Note::RefreshRate(45.0));
        assert!(!lost(&mut pace, 2.0 * PERIOD_S));
    }

    #[test]
    fn nothing_changes_once_a_ball_was_thrown() {
        let mut pace = Pace::default();
        pace.settle();
        pace.hear(&Note::RefreshRate(90.0));
        assert!(lost(&mut pace, 2 * WINDOW, 1).is_empty());
        assert!(lost(&mut Pace::settled(), 2 * WINDOW, 1).is_empty());
    }
}
