//! The lights of the alley, where its measures put them.

use game::Config;
use glam::Vec3;
use renderer::{Lamp, Light, LightSource};

/// The light over approach and lane; a box of shadows from the room's back to the pit.
///
/// It leans across the lane and not along it: along 25 m even a small lean would bring the ceiling between the light and
/// one end of the box, and half of the approach into the ceiling's shadow.
pub(super) fn light(config: &Config) -> Light {
    let (rack, desk) = (&config.rack, &config.desk);
    let edge = config.lane.width_m / 2.0 + config.gutter.width_m + 0.1;
    let half_desk = desk.width_m / 2.0 + 0.15;
    let pit = &config.pit;
    let rear = config.lane.deck_end_z_m - pit.cushion_behind_deck_m - pit.cushion_thickness_m;
    let low = [desk.x_m - half_desk, rack.x_m - 0.8, -edge].into_iter();
    let high = [desk.x_m + half_desk, rack.x_m + 0.8, edge].into_iter();
    let low_x = low.fold(f64::INFINITY, f64::min);
    let high_x = high.fold(f64::NEG_INFINITY, f64::max);
    // Whole metres behind the pit: the shadows' grain stays where it is while the pit is moved a little.
    let (low_z, high_z) = ((rear - 0.5).floor(), config.room.depth_m - 1.0);
    Light {
        source: LightSource::Directional {
            direction: Vec3::new(-0.25, -1.0, 0.0),
            shadow_min: Vec3::new(low_x as f32, -0.2, low_z as f32),
            shadow_max: Vec3::new(high_x as f32, 1.9, high_z as f32),
        },
        color: [0.55, 0.52, 0.47],
        softness_m: 0.02,
    }
}

/// Warm light over the lane and a brighter one over the pins, as alleys have.
pub(super) fn lamps(config: &Config) -> Vec<Lamp> {
    let headpin = config.lane.headpin_z_m;
    let height = (config.room.height_m - 0.6) as f32;
    let lamp = |z: f64, strength: f32| Lamp {
        position: Vec3::new(0.0, height, z as f32),
        color: [strength, 0.95 * strength, 0.85 * strength],
        range_m: 6.0,
    };
    // Well in front of the masking panel, which it would bleach from nearby.
    let over_pins = Lamp {
        position: Vec3::new(0.0, 1.6, (headpin + 1.788) as f32),
        color: [2.0, 1.96, 1.85],
        range_m: 5.0,
    };
    // A fifth and half of the way to the pins.
    vec![
        lamp(2.5, 0.8),
        lamp(headpin * (4.0 / 18.288), 0.6),
        lamp(headpin * (10.0 / 18.288), 0.5),
        over_pins,
    ]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::convert::tests::config;

    #[test]
    fn lights_follow_the_alley() {
        let default = config();
        let mut short = config();
        short.lane.headpin_z_m += 8.0;
        short.lane.deck_end_z_m += 8.0;
        short.desk.x_m -= 0.5;
        let box_of = |config: &Config| match light(config).source {
            LightSource::Directional {
                shadow_min,
                shadow_max,
                ..
            } => [shadow_min, shadow_max],
            other => panic!("{other:?}"),
        };
        let expected = [Vec3::new(-1.6, -0.2, -21.0), Vec3::new(1.9, 1.9, 5.0)];
        assert_eq!(box_of(&default), expected);
        assert_eq!(box_of(&short)[0], Vec3::new(-2.1, -0.2, -13.0));
        let over_pins = |config: &Config| lamps(config)[3].position.z;
        assert_eq!((over_pins(&default), over_pins(&short)), (-16.5, -8.5));
    }
}
