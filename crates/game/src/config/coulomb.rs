//! Settings of the law that the paper's is judged against: physical coefficients of pairs of surfaces.

use physics::{PairContact, Surface};
use serde::{Deserialize, Serialize};

/// Surface of the balls.
pub(crate) const BALL: Surface = Surface(0);
/// Surface of the pins.
pub(crate) const PIN: Surface = Surface(1);
/// Surface of the lane and the pin deck.
pub(crate) const LANE: Surface = Surface(2);
/// Surface of the gutters.
pub(crate) const GUTTER: Surface = Surface(3);
/// Surface of the kickbacks.
pub(crate) const KICKBACK: Surface = Surface(4);
/// Surface of the cushion.
pub(crate) const CUSHION: Surface = Surface(5);
/// Surface of the pit's floor.
pub(crate) const PIT: Surface = Surface(6);
/// Surface of everything else: floors, walls, rack, desk, hand.
pub(crate) const REST: Surface = Surface(7);

/// How pairs of surfaces meet under `response = "coulomb"`; the other two laws never read it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct CoulombConfig {
    /// Two balls.
    pub ball_ball: PairConfig,
    /// Ball and pin.
    pub ball_pin: PairConfig,
    /// Ball and lane.
    pub ball_lane: PairConfig,
    /// Ball and gutter.
    pub ball_gutter: PairConfig,
    /// Ball and kickback.
    pub ball_kickback: PairConfig,
    /// Ball and cushion.
    pub ball_cushion: PairConfig,
    /// Ball and the pit's floor.
    pub ball_pit: PairConfig,
    /// Two pins.
    pub pin_pin: PairConfig,
    /// Pin and pin deck.
    pub pin_lane: PairConfig,
    /// Pin and gutter.
    pub pin_gutter: PairConfig,
    /// Pin and kickback.
    pub pin_kickback: PairConfig,
    /// Pin and cushion.
    pub pin_cushion: PairConfig,
    /// Pin and the pit's floor.
    pub pin_pit: PairConfig,
    /// Every pair that has no key of its own.
    pub other: PairConfig,
}

/// The physical coefficients of a pair of surfaces.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PairConfig {
    /// Newton's coefficient of restitution, 0 to 1.
    pub restitution: f64,
    /// Coulomb's coefficient of friction, 0 or more.
    pub friction: f64,
}

impl PairConfig {
    /// As physics takes it.
    pub(crate) fn contact(self) -> PairContact {
        PairContact {
            restitution: self.restitution,
            friction: self.friction,
        }
    }
}

impl CoulombConfig {
    /// The table with every pair changed in the same way.
    #[must_use]
    pub fn with(mut self, change: impl Fn(&mut PairConfig)) -> Self {
        for pair in [
            &mut self.ball_ball,
            &mut self.ball_pin,
            &mut self.ball_lane,
            &mut self.ball_gutter,
            &mut self.ball_kickback,
            &mut self.ball_cushion,
            &mut self.ball_pit,
            &mut self.pin_pin,
            &mut self.pin_lane,
            &mut self.pin_gutter,
            &mut self.pin_kickback,
            &mut self.pin_cushion,
            &mut self.pin_pit,
            &mut self.other,
        ] {
            change(pair);
        }
        self
    }

    /// The pairs with keys of their own: key, surfaces, coefficients.
    pub(crate) fn pairs(&self) -> [(&'static str, Surface, Surface, PairConfig); 13] {
        [
            ("ball_ball", BALL, BALL, self.ball_ball),
            ("ball_pin", BALL, PIN, self.ball_pin),
            ("ball_lane", BALL, LANE, self.ball_lane),
            ("ball_gutter", BALL, GUTTER, self.ball_gutter),
            ("ball_kickback", BALL, KICKBACK, self.ball_kickback),
            ("ball_cushion", BALL, CUSHION, self.ball_cushion),
            ("ball_pit", BALL, PIT, self.ball_pit),
            ("pin_pin", PIN, PIN, self.pin_pin),
            ("pin_lane", PIN, LANE, self.pin_lane),
            ("pin_gutter", PIN, GUTTER, self.pin_gutter),
            ("pin_kickback", PIN, KICKBACK, self.pin_kickback),
            ("pin_cushion", PIN, CUSHION, self.pin_cushion),
            ("pin_pit", PIN, PIT, self.pin_pit),
        ]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::config::tests::default_config;

    /// The keys of the table, as a file has them, with their values.
    fn keys(coulomb: &CoulombConfig) -> Vec<(String, PairConfig)> {
        let value = serde_json::to_value(coulomb).unwrap();
        let table = value.as_object().unwrap().clone();
        let read = |pair| serde_json::from_value(pair).unwrap();
        table
            .into_iter()
            .map(|(key, pair)| (key, read(pair)))
            .collect()
    }

    #[test]
    fn every_key_reaches_a_pair_of_surfaces() {
        let coulomb = default_config().coulomb;
        let mut named: Vec<_> = coulomb
            .pairs()
            .map(|(key, _, _, pair)| (key.to_owned(), pair))
            .into();
        named.push(("other".to_owned(), coulomb.other));
        named.sort_by(|a, b| a.0.cmp(&b.0));
        assert_eq!(named, keys(&coulomb));
        let surfaces = coulomb.pairs().map(|(key, a, b, _)| (key, a.0, b.0));
        for (key, a, b) in surfaces {
            let twin = |other: &&(&str, u8, u8)| (other.1, other.2) == (a, b);
            assert_eq!(surfaces.iter().filter(twin).count(), 1, "{key}");
        }
    }

    #[test]
    fn a_change_reaches_every_key() {
        let changed = default_config().coulomb.with(|pair| {
            *pair = PairConfig {
                restitution: 0.125,
                friction: 7.0,
            }
        });
        for (key, pair) in keys(&changed) {
            assert_eq!((pair.restitution, pair.friction), (0.125, 7.0), "{key}");
        }
    }
}
