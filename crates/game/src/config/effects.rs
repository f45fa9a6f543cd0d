//! Settings of what a scene calls for, and of the effects that need numbers of their own.

use physics::{Effect, OilPattern};
use serde::de::Error as _;
use serde::{Deserialize, Deserializer, Serialize, Serializer};

/// Distance between the nodes of the oil's grid [m], about.
const NODE: f64 = 0.05;

/// An effect by its name in a scene; what a scene does not list executes nothing.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct EffectName(pub Effect);

/// The names of all effects.
const NAMES: [&str; Effect::ALL.len()] = {
    let mut names = [""; Effect::ALL.len()];
    let mut i = 0;
    while i < names.len() {
        names[i] = Effect::ALL[i].name();
        i += 1;
    }
    names
};

impl Serialize for EffectName {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.serialize_str(self.0.name())
    }
}

impl<'de> Deserialize<'de> for EffectName {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let name = String::deserialize(deserializer)?;
        let effect = Effect::from_name(&name);
        effect.map_or_else(
            || Err(D::Error::unknown_variant(&name, &NAMES)),
            |effect| Ok(EffectName(effect)),
        )
    }
}

/// Oil on the lane, from the foul line on: factors on whatever friction a body has there. Read with the effect `oil`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct OilConfig {
    /// How far down the lane it reaches [m].
    pub length_m: f64,
    /// The last part of that, along which it becomes less until nothing is left [m].
    pub taper_m: f64,
    /// Width in the middle of the lane on which there is most [m]; from there it becomes less towards the edges.
    pub flat_width_m: f64,
    /// Factor on the friction in the middle.
    pub middle_factor: f64,
    /// Factor on the friction at the lane's edges.
    pub edge_factor: f64,
}

impl OilConfig {
    /// The factor at `x` and `down` the lane [m] from the middle of the foul line, on a lane that is `width` wide [m].
    pub fn factor(&self, x: f64, down: f64, width: f64) -> f64 {
        let (flat, half) = (self.flat_width_m / 2.0, width / 2.0);
        let outwards = ((x.abs() - flat) / (half - flat)).clamp(0.0, 1.0);
        let across = self.middle_factor + (self.edge_factor - self.middle_factor) * outwards;
        let left = ((self.length_m - down) / self.taper_m).clamp(0.0, 1.0);
        1.0 + (across - 1.0) * left
    }

    /// The pattern on a box of the lane whose frame has the foul line at `foul_line_z` [m].
    pub(crate) fn pattern(
        &self,
        width: f64,
        foul_line_z: f64,
    ) -> Result<OilPattern, physics::OilError> {
        let nodes = |length: f64| (length / NODE).ceil() as usize + 1;
        let (across, along) = (nodes(width), nodes(self.length_m));
        let place =
            |index: usize, count: usize, length: f64| length * index as f64 / (count - 1) as f64;
        let mut factors = Vec::with_capacity(across * along);
        for row in 0..along {
            let down = place(row, along, self.length_m);
            for column in 0..across {
                let x = place(column, across, width) - width / 2.0;
                factors.push(self.factor(x, down, width));
            }
        }
        let from = [-width / 2.0, foul_line_z];
        let to = [width / 2.0, foul_line_z - self.length_m];
        OilPattern::new(from, to, [across, along], factors)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::config::tests::default_config;

    #[test]
    fn names_are_those_of_physics() {
        for effect in Effect::ALL {
            let text = serde_json::to_value(EffectName(effect)).unwrap();
            assert_eq!(text, effect.name());
            let name: EffectName = serde_json::from_value(text).unwrap();
            assert_eq!(name.0, effect);
        }
    }

    #[test]
    fn oil_lies_where_the_settings_put_it() {
        let (oil, width) = (default_config().oil, default_config().lane.width_m);
        let pattern = oil.pattern(width, 2.0).unwrap();
        let factor = |x: f64, down: f64| pattern.factor([x, 2.0 - down]);
        let near = |a: f64, b: f64| assert!((a - b).abs() < 0.02, "{a} instead of {b}");
        near(factor(0.0, 0.0), oil.middle_factor);
        near(factor(0.2, 5.0), oil.middle_factor);
        near(factor(0.527, 5.0), oil.edge_factor);
        near(factor(-0.527, 5.0), oil.edge_factor);
        let half_way = oil.length_m - oil.taper_m / 2.0;
        near(factor(0.0, half_way), (1.0 + oil.middle_factor) / 2.0);
        near(factor(0.0, oil.length_m - 0.001), 1.0);
        assert_eq!(factor(0.0, oil.length_m + 0.001), 1.0);
        assert_eq!(factor(0.0, -0.001), 1.0);
    }
}
