//! The building: every part of the room that never moves, as boxes, and the places that follow from the measures.

mod furniture;

use glam::{DQuat, DVec3};
use physics::Pose;

use crate::config::{Config, LaneConfig};
use crate::visible::Model;

pub(crate) use furniture::{Footprint, ball_homes, button_foot, footprints};

/// How far walls and floors reach beyond what is seen [m]: thick enough that nothing passes at any speed.
const MASSIVE: f64 = 0.5;

/// Thickness of what is painted on the floor [m].
const PAINT: f64 = 0.002;

/// A box of the building.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Part {
    pub model: Model,
    /// World pose of its middle.
    pub pose: Pose,
    /// Full extents [m].
    pub size: DVec3,
    /// False for what is only painted.
    pub is_solid: bool,
}

impl Part {
    /// An upright box between two opposite corners.
    fn between(model: Model, low: DVec3, high: DVec3) -> Self {
        let pose = Pose::from_position((low + high) / 2.0);
        Self {
            model,
            pose,
            size: high - low,
            is_solid: true,
        }
    }
}

/// All boxes of a scene.
pub(crate) fn parts(config: &Config) -> Vec<Part> {
    let mut parts = floors(config);
    parts.extend(gutters(config));
    parts.extend(pit(config));
    parts.extend(walls(config));
    parts.extend(furniture::rack(config));
    parts.extend(furniture::desk(config));
    parts
}

/// Inner face of the right kickback, and outer edge of the right gutter [m].
pub(crate) fn kickback_x(config: &Config) -> f64 {
    config.lane.width_m / 2.0 + config.gutter.width_m
}

/// Face of the cushion [m].
pub(crate) fn cushion_z(config: &Config) -> f64 {
    config.lane.deck_end_z_m - config.pit.cushion_behind_deck_m
}

/// Front edge of the pin deck [m]: where the kickbacks begin.
pub(crate) fn deck_front_z(config: &Config) -> f64 {
    config.lane.headpin_z_m + config.kickback.starts_before_headpin_m
}

/// Spot of each pin on the deck, pin 1 first [m].
pub(crate) fn pin_spots(lane: &LaneConfig) -> Vec<DVec3> {
    let mut spots = Vec::new();
    for row in 0..4 {
        for place in 0..=row {
            let x = (f64::from(place) - f64::from(row) / 2.0) * lane.pin_spacing_m;
            spots.push(DVec3::new(
                x,
                0.0,
                lane.headpin_z_m - f64::from(row) * lane.row_pitch_m,
            ));
        }
    }
    spots
}

/// Lane, approach and the floors beside: all tops at y = 0.
///
/// The lane's box reaches back to the wall, between the two boxes of the approach, so that a ball crosses no seam when it
/// crosses the foul line.
fn floors(config: &Config) -> Vec<Part> {
    let half = config.lane.width_m / 2.0;
    let (side, edge) = (config.room.half_width_m, kickback_x(config));
    let (back, front) = (config.room.depth_m, config.lane.deck_end_z_m);
    let end = cushion_z(config) - config.pit.cushion_thickness_m - MASSIVE;
    let slab = |model, (x0, x1): (f64, f64), (z0, z1): (f64, f64)| {
        let depth = config.lane.thickness_m;
        Part::between(model, DVec3::new(x0, -depth, z0), DVec3::new(x1, 0.0, z1))
    };
    let half_line = config.room.foul_line_width_m / 2.0;
    let foul_line = Part {
        is_solid: false,
        ..Part::between(
            Model::FoulLine,
            DVec3::new(-half, 0.0, -half_line),
            DVec3::new(half, PAINT, half_line),
        )
    };
    vec![
        slab(Model::Lane, (-half, half), (front, back)),
        slab(Model::Approach, (-side, -half), (0.0, back)),
        slab(Model::Approach, (half, side), (0.0, back)),
        slab(Model::SideFloor, (-side, -edge), (end, 0.0)),
        slab(Model::SideFloor, (edge, side), (end, 0.0)),
        foul_line,
    ]
}

/// On each side strips along an arc as wide and deep as the gutter, then one flat strip beside the deck.
fn gutters(config: &Config) -> Vec<Part> {
    let gutter = &config.gutter;
    let half = config.lane.width_m / 2.0;
    let flat_z = config.lane.headpin_z_m + gutter.flat_starts_before_headpin_m;
    let bed = config.lane.thickness_m;
    let mut parts = Vec::new();
    for side in [-1.0, 1.0] {
        for strip in 0..gutter.facets {
            let (a, b) = (arc_point(config, strip), arc_point(config, strip + 1));
            let (a, b) = (
                DVec3::new(side * a.x, a.y, 0.0),
                DVec3::new(side * b.x, b.y, 0.0),
            );
            // From left to right, whichever side: the strip's own y then points up.
            let (left, right) = if a.x < b.x { (a, b) } else { (b, a) };
            let along = right - left;
            let rotation = DQuat::from_rotation_arc(DVec3::X, along / along.length());
            let middle =
                (left + right) / 2.0 + rotation * DVec3::new(0.0, -bed / 2.0, flat_z / 2.0);
            parts.push(Part {
                model: Model::Gutter,
                pose: Pose::new(middle, rotation),
                size: DVec3::new(along.length(), bed, -flat_z),
                is_solid: true,
            });
        }
        let (x0, x1) = (side * half, side * (half + gutter.width_m));
        let top = -gutter.depth_at_deck_m;
        parts.push(Part::between(
            Model::Gutter,
            DVec3::new(x0.min(x1), top - bed, config.lane.deck_end_z_m),
            DVec3::new(x0.max(x1), top, flat_z),
        ));
    }
    parts
}

/// Corner `index` of the right gutter's strips, from the lane outwards [m].
fn arc_point(config: &Config, index: u32) -> DVec3 {
    let (width, depth) = (config.gutter.width_m, config.gutter.depth_m);
    let radius = (width * width / 4.0 + depth * depth) / (2.0 * depth);
    let share = f64::from(index) / f64::from(config.gutter.facets);
    let from_middle = (share - 0.5) * width;
    // The chord's ends lie on the arc; its middle strip is flat when their number is odd.
    let below = (radius * radius - from_middle * from_middle).sqrt() - (radius - depth);
    DVec3::new(config.lane.width_m / 2.0 + share * width, -below, 0.0)
}

/// Pit floor, cushion, and the kickbacks on both sides of deck and pit.
fn pit(config: &Config) -> Vec<Part> {
    let (inner, face) = (kickback_x(config), cushion_z(config));
    let pit = &config.pit;
    let outer = inner + config.kickback.thickness_m;
    let (front, rear) = (deck_front_z(config), face - pit.cushion_thickness_m);
    let low = -(pit.floor_below_deck_m + MASSIVE);
    let kickback = |x0: f64, x1: f64| {
        let (low, high) = (
            DVec3::new(x0, low, rear),
            DVec3::new(x1, config.kickback.height_m, front),
        );
        Part::between(Model::Kickback, low, high)
    };
    vec![
        kickback(inner, outer),
        kickback(-outer, -inner),
        Part::between(
            Model::Pit,
            DVec3::new(-inner, low, rear),
            DVec3::new(inner, -pit.floor_below_deck_m, config.lane.deck_end_z_m),
        ),
        Part::between(
            Model::Cushion,
            DVec3::new(-inner, -pit.floor_below_deck_m, rear),
            DVec3::new(inner, pit.cushion_height_m, face),
        ),
    ]
}

/// Four walls and a ceiling.
fn walls(config: &Config) -> Vec<Part> {
    let room = &config.room;
    let front = cushion_z(config) - config.pit.cushion_thickness_m;
    let (side, back, top) = (room.half_width_m, room.depth_m, room.height_m);
    let (low, thick) = (-1.0, MASSIVE);
    let wall = |low: DVec3, high: DVec3| Part::between(Model::Wall, low, high);
    vec![
        wall(
            DVec3::new(side, low, front),
            DVec3::new(side + thick, top, back),
        ),
        wall(
            DVec3::new(-side - thick, low, front),
            DVec3::new(-side, top, back),
        ),
        wall(
            DVec3::new(-side, low, back),
            DVec3::new(side, top, back + thick),
        ),
        wall(
            DVec3::new(-side, low, front - thick),
            DVec3::new(side, top, front),
        ),
        Part::between(
            Model::Ceiling,
            DVec3::new(-side, top, front),
            DVec3::new(side, top + thick, back),
        ),
    ]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::config::tests::default_config;

    #[test]
    fn pin_spots_match_the_reference() {
        let rows = include_str!("../tests/data/pin_spots.csv").lines().skip(1);
        let spots = pin_spots(&default_config().lane);
        assert_eq!(rows.clone().count(), spots.len());
        for (row, spot) in rows.zip(spots) {
            let numbers: Vec<f64> = row
                .split(',')
                .map(|number| number.parse().unwrap())
                .collect();
            let expected = DVec3::new(numbers[1], numbers[2], numbers[3]);
            assert!((spot - expected).length() < 2e-6, "{row}: {spot}");
        }
    }

    /// Height of the highest solid top surface below a point, by its boxes.
    fn ground(parts: &[Part], x: f64, z: f64) -> f64 {
        let inside = |part: &Part, y: f64| {
            let local = part.pose.inverse().transform_point(DVec3::new(x, y, z));
            (local.abs().cmple(part.size / 2.0)).all()
        };
        let mut y = 0.05;
        while y > -0.3 && !parts.iter().any(|part| part.is_solid && inside(part, y)) {
            y -= 1e-4;
        }
        y
    }

    #[test]
    fn floors_lie_where_the_specification_puts_them() {
        let config = default_config();
        let parts = parts(&config);
        let gutter_x = (config.lane.width_m + config.gutter.width_m) / 2.0;
        for (x, z, y) in [
            (0.0, -9.0, 0.0),
            (0.5, -18.9, 0.0),
            (0.0, 3.0, 0.0),
            (1.5, 0.5, 0.0),
            (-1.5, -9.0, 0.0),
            // The middle strip is a chord: a little above the arc's lowest point.
            (gutter_x, -9.0, -0.0457),
            (-gutter_x, -9.0, -0.0457),
            (gutter_x, -18.0, -0.0889),
            (0.0, -19.6, -0.1),
        ] {
            let found = ground(&parts, x, z);
            assert!((found - y).abs() < 4e-4, "({x}, {z}): {found} m");
        }
    }

    #[test]
    fn gutter_strips_join_without_a_gap() {
        let config = default_config();
        let parts = parts(&config);
        let edge = kickback_x(&config);
        let mut x = config.lane.width_m / 2.0 - 0.01;
        let mut last = ground(&parts, x, -9.0);
        while x < edge + 0.01 {
            for side in [-1.0, 1.0] {
                let here = ground(&parts, side * x, -9.0);
                assert!(here > -0.048, "a hole at {x}");
                assert!((here - last).abs() < 0.005, "a step at {x}");
                last = if side > 0.0 { here } else { last };
            }
            x += 0.001;
        }
    }
}
