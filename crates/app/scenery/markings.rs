//! What is painted on the boards.

use game::Config;
use glam::{Vec2, Vec3};

use super::mesh::Mesh;
use super::{DECAL, Plan};

/// Boards across the lane by which the rule book places its markings.
const RULE_BOARDS: f32 = 39.0;

/// Arrows and dots at the boards that the settings give, and the pin spots. On a lane of another width they keep their share
/// of it; what would lie beyond the head pin or the approach is left out.
pub(super) fn markings(plan: &Plan, config: &Config) -> Mesh {
    let mut mesh = lane_markings(plan, config);
    let paint = &config.markings;
    for z in &paint.approach_dots_z_m {
        let z = *z as f32;
        if z > plan.approach_end {
            continue;
        }
        for number in &paint.approach_dot_boards {
            dot(&mut mesh, Vec3::new(board_x(config, *number), DECAL, z));
        }
    }
    mesh
}

/// Middle of a board, counted from the right edge [m].
fn board_x(config: &Config, number: u32) -> f32 {
    let board = config.lane.width_m as f32 / RULE_BOARDS;
    (0.5 * (RULE_BOARDS + 1.0) - number as f32) * board
}

/// What is painted on a lane.
pub(super) fn lane_markings(plan: &Plan, config: &Config) -> Mesh {
    let mut mesh = Mesh::default();
    let paint = &config.markings;
    for (number, z) in paint.arrow_boards.iter().zip(&paint.arrow_z_m) {
        let z = *z as f32;
        if z >= plan.headpin {
            arrow(&mut mesh, Vec3::new(board_x(config, *number), DECAL, z));
        }
    }
    let row = paint.lane_dots_z_m as f32;
    for number in &paint.lane_dot_boards {
        if row >= plan.headpin {
            dot(&mut mesh, Vec3::new(board_x(config, *number), DECAL, row));
        }
    }
    // The pin spots, 2 1/4 in wide.
    for spot in pin_spots(config) {
        disc(&mut mesh, spot + Vec3::Y * DECAL, 0.028575);
    }
    mesh
}

/// Where the pins of a lane stand, about the lane's own middle [m].
pub fn pin_spots(config: &Config) -> Vec<Vec3> {
    let lane = &config.lane;
    let mut spots = Vec::new();
    for row in 0..4 {
        for i in 0..=row {
            let x = f64::from(2 * i - row) * 0.5 * lane.pin_spacing_m;
            let z = lane.headpin_z_m - f64::from(row) * lane.row_pitch_m;
            spots.push(Vec3::new(x as f32, 0.0, z as f32));
        }
    }
    spots
}

/// A dart 15 cm long that points down the lane.
fn arrow(mesh: &mut Mesh, tip: Vec3) {
    let corner = |x: f32, z: f32| tip + Vec3::new(x, 0.0, z);
    mesh.quad(
        [
            corner(0.0, 0.0),
            corner(-0.032, 0.15),
            corner(0.0, 0.11),
            corner(0.032, 0.15),
        ],
        [Vec2::ZERO, Vec2::ONE],
    );
}

fn dot(mesh: &mut Mesh, centre: Vec3) {
    disc(mesh, centre, 0.0095);
}

fn disc(mesh: &mut Mesh, centre: Vec3, radius: f32) {
    let sides = 12;
    let rim = |i: i32| {
        let direction = Vec2::from_angle(std::f32::consts::TAU * i as f32 / sides as f32);
        centre + Vec3::new(direction.x, 0.0, -direction.y) * radius
    };
    for i in 0..sides / 2 {
        mesh.quad(
            [centre, rim(2 * i), rim(2 * i + 1), rim(2 * i + 2)],
            [Vec2::ZERO, Vec2::ONE],
        );
    }
}
