//! What stands on the approach: the ball rack and the desk with the buttons.

use glam::{DVec2, DVec3};

use super::Part;
use crate::config::Config;
use crate::visible::Model;

/// Thickness of the rack's tray and of the desk's top [m].
const BOARD: f64 = 0.04;

/// The ground that a piece of furniture covers, as (x, z) [m].
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Footprint {
    pub low: DVec2,
    pub high: DVec2,
}

impl Footprint {
    fn about(middle: DVec2, size: DVec2) -> Self {
        Self {
            low: middle - size / 2.0,
            high: middle + size / 2.0,
        }
    }
}

/// The ground that rack and desk cover.
pub(crate) fn footprints(config: &Config) -> [Footprint; 2] {
    [rack_footprint(config), desk_footprint(config)]
}

fn rack_footprint(config: &Config) -> Footprint {
    let rack = &config.rack;
    let widest = config
        .balls
        .iter()
        .map(|ball| ball.diameter_m)
        .fold(0.0, f64::max);
    let width = widest + 2.0 * (rack.clearance_m + rack.rim_thickness_m);
    Footprint::about(
        DVec2::new(rack.x_m, rack.z_m),
        DVec2::new(width, rack_length(config)),
    )
}

fn desk_footprint(config: &Config) -> Footprint {
    let desk = &config.desk;
    Footprint::about(
        DVec2::new(desk.x_m, desk.z_m),
        DVec2::new(desk.width_m, desk.depth_m),
    )
}

/// Centre of each ball on the rack [m].
pub(crate) fn ball_homes(config: &Config) -> Vec<DVec3> {
    let rack = &config.rack;
    let mut z = rack.z_m - rack_length(config) / 2.0 + rack.rim_thickness_m;
    let mut homes = Vec::new();
    for ball in &config.balls {
        let cell = ball.diameter_m + 2.0 * rack.clearance_m;
        homes.push(DVec3::new(
            rack.x_m,
            rack.tray_height_m + ball.radius_m(),
            z + cell / 2.0,
        ));
        z += cell + rack.rim_thickness_m;
    }
    homes
}

/// Middle of a button's foot on the desk [m]; `side` is -1 for the left one and 1 for the right one.
pub(crate) fn button_foot(config: &Config, side: f64) -> DVec3 {
    let desk = &config.desk;
    DVec3::new(
        desk.x_m + side * desk.button_spacing_m / 2.0,
        desk.height_m,
        desk.z_m,
    )
}

/// Length of the rack along the lane [m].
fn rack_length(config: &Config) -> f64 {
    let cells: f64 = config
        .balls
        .iter()
        .map(|ball| ball.diameter_m + 2.0 * config.rack.clearance_m)
        .sum();
    cells + (config.balls.len() as f64 + 1.0) * config.rack.rim_thickness_m
}

/// A tray with a rim around it and between the balls, on two feet.
pub(super) fn rack(config: &Config) -> Vec<Part> {
    let rack = &config.rack;
    let (rim, tray) = (rack.rim_thickness_m, rack.tray_height_m);
    let Footprint {
        low: DVec2 { x: x0, y: far },
        high: DVec2 { x: x1, y: near },
    } = rack_footprint(config);
    let plank = |low: DVec3, high: DVec3| Part::between(Model::Rack, low, high);
    let rim_top = tray + rack.rim_height_m;
    let mut parts = vec![
        plank(
            DVec3::new(x0, tray - BOARD, far),
            DVec3::new(x1, tray, near),
        ),
        plank(
            DVec3::new(x0, tray, far),
            DVec3::new(x0 + rim, rim_top, near),
        ),
        plank(
            DVec3::new(x1 - rim, tray, far),
            DVec3::new(x1, rim_top, near),
        ),
    ];
    let (inner0, inner1) = (x0 + rim, x1 - rim);
    let mut z = far;
    let cells = config
        .balls
        .iter()
        .map(|ball| ball.diameter_m + 2.0 * rack.clearance_m);
    for cell in cells.chain([0.0]) {
        parts.push(plank(
            DVec3::new(inner0, tray, z),
            DVec3::new(inner1, rim_top, z + rim),
        ));
        z += rim + cell;
    }
    for foot in [far, near - BOARD] {
        parts.push(plank(
            DVec3::new(x0, 0.0, foot),
            DVec3::new(x1, tray - BOARD, foot + BOARD),
        ));
    }
    parts
}

/// A top on two side boards.
pub(super) fn desk(config: &Config) -> Vec<Part> {
    let desk = &config.desk;
    let Footprint {
        low: DVec2 { x: x0, y: z0 },
        high: DVec2 { x: x1, y: z1 },
    } = desk_footprint(config);
    let (top, under) = (desk.height_m, desk.height_m - BOARD);
    let board = |low: DVec3, high: DVec3| Part::between(Model::Desk, low, high);
    vec![
        board(DVec3::new(x0, under, z0), DVec3::new(x1, top, z1)),
        board(DVec3::new(x0, 0.0, z0), DVec3::new(x0 + BOARD, under, z1)),
        board(DVec3::new(x1 - BOARD, 0.0, z0), DVec3::new(x1, under, z1)),
    ]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::alley::parts;
    use crate::config::tests::default_config;

    #[test]
    fn balls_lie_in_their_cells() {
        let config = default_config();
        let parts = parts(&config);
        for (home, ball) in ball_homes(&config).iter().zip(&config.balls) {
            for part in parts.iter().filter(|part| part.is_solid) {
                let local = part.pose.inverse().transform_point(*home);
                let nearest = local.clamp(-part.size / 2.0, part.size / 2.0);
                let gap = (local - nearest).length() - ball.radius_m();
                assert!(gap > -1e-12, "{part:?} reaches {gap} into a ball");
            }
        }
    }
}
