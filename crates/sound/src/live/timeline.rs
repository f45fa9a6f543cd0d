//! The game's clock against the card's.

/// Share of a difference between the clocks that one frame makes good: jitter of frames is smoothed away, drift is not.
const FOLLOWED: f64 = 0.02;
/// A difference that is no drift [s]: the game stood still or leapt.
const LEAP_S: f64 = 0.1;

/// Maps times of the game to times of the mixer.
#[derive(Debug, Clone)]
pub struct Timeline {
    lookahead_s: f64,
    /// Mixer's time less game's time, lookahead included [s]; none before the first frame.
    offset: Option<f64>,
}

impl Timeline {
    /// A timeline that plays everything `lookahead_s` [s] after it happened.
    pub fn new(lookahead_s: f64) -> Self {
        Timeline {
            lookahead_s,
            offset: None,
        }
    }

    /// Notes that the game has come to `game_s` while the mixer is at `mixer_s` [s].
    pub fn meet(&mut self, game_s: f64, mixer_s: f64) {
        let measured = mixer_s - game_s + self.lookahead_s;
        self.offset = Some(match self.offset {
            Some(offset) if (measured - offset).abs() < LEAP_S => {
                offset + FOLLOWED * (measured - offset)
            }
            _ => measured,
        });
    }

    /// When an event of the game at `game_s` is heard, in the mixer's time [s]; at once before the first frame.
    pub fn mixer_time(&self, game_s: f64) -> f64 {
        self.offset.map_or(0.0, |offset| game_s + offset)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn meet_smooths_jitter_follows_drift_and_leaps_with_the_game() {
        let mut timeline = Timeline::new(0.02);
        // 72 frames a second for a minute that come up to 5 ms late, on a card that is 1 in 10000 fast.
        for frame in 0..4320u32 {
            let game = f64::from(frame) / 72.0;
            let late = 0.005 * f64::from(frame * 7919 % 100) / 100.0;
            timeline.meet(game, 3.0 + 1.0001 * game + late);
        }
        let error = timeline.mixer_time(60.0) - (3.0 + 1.0001 * 60.0 + 0.02 + 0.0025);
        assert!(error.abs() < 0.001, "{error}");
        timeline.meet(90.0, 64.0);
        assert!((timeline.mixer_time(90.0) - 64.02).abs() < 1e-9);
    }
}
