//! A hand that the tracker loses fades: it shrinks away where it was last seen.
//!
//! By its size and not by its colour, because nothing here is drawn through anything else. It is gone when a grip outlasts
//! its tracking no longer, so that a ball in it falls from no hand.

use game::{Model, Visible};

/// The hand as it was last seen.
#[derive(Debug)]
pub struct Fading {
    /// Time that it takes [s].
    seconds: f64,
    /// The hand, and the time of display of its picture [ns].
    last: Option<(Visible, i64)>,
}

impl Fading {
    /// Of hands that take `seconds` to go.
    pub fn new(seconds: f64) -> Self {
        Self {
            seconds,
            last: None,
        }
    }

    /// The hand to draw beside what is visible in the picture seen at `display_ns`, and the share of its size that is left;
    /// `None` while it is seen itself, and when it has gone.
    pub fn of(&mut self, visible: &[Visible], display_ns: i64) -> Option<(Visible, f64)> {
        let hand = visible.iter().find(|seen| seen.model == Model::Hand);
        if let Some(hand) = hand {
            self.last = Some((*hand, display_ns));
            return None;
        }
        let (hand, seen_ns) = self.last?;
        let gone = (display_ns - seen_ns) as f64 * 1e-9 / self.seconds;
        if gone >= 1.0 {
            self.last = None;
            return None;
        }
        Some((hand, 1.0 - gone.max(0.0)))
    }

    /// Whoever does not play has no hand, and none that fades.
    pub fn forget(&mut self) {
        self.last = None;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DVec3;
    use physics::Pose;

    fn seen(model: Model) -> Visible {
        Visible {
            model,
            pose: Pose::from_position(DVec3::X),
            size: DVec3::ONE,
            is_highlighted: false,
        }
    }

    #[test]
    fn a_hand_that_is_lost_shrinks_where_it_was_and_is_gone_in_time() {
        let mut fading = Fading::new(0.3);
        let with_hand = [seen(Model::Lane), seen(Model::Hand)];
        assert_eq!(fading.of(&with_hand[..1], 0), None, "there was none");
        assert_eq!(fading.of(&with_hand, 1_000_000_000), None);
        let mut share = |milliseconds: i64| {
            let faded = fading.of(&with_hand[..1], milliseconds * 1_000_000);
            faded.map(|(hand, share)| {
                assert_eq!(hand, with_hand[1]);
                share
            })
        };
        let close = |share: Option<f64>, expected: f64| {
            share.is_some_and(|share| (share - expected).abs() < 1e-9)
        };
        assert!(close(share(1_030), 0.9));
        assert!(close(share(1_240), 0.2));
        assert_eq!(share(1_300), None);
        assert_eq!(share(1_010), None, "it does not come back by itself");
    }

    #[test]
    fn who_does_not_play_has_no_hand_that_fades() {
        let mut fading = Fading::new(0.3);
        fading.of(&[seen(Model::Hand)], 0);
        fading.forget();
        assert_eq!(fading.of(&[], 1), None);
    }
}
