//! What is painted on the boards.

use game::Config;
use glam::{Vec2, Vec3};

use super::mesh::Mesh;
use super::{DECAL, Plan};

/// Boards across the lane by which the rule book places its markings.
const RULE_BOARDS: f32 = 39.0;

/// Arrows and dots at the boards that the rule book gives: seven arrows 12 to 16 ft down the lane, dots on the lane at
/// 7 ft, rows of dots on the approach. On a lane of another width they keep their share of it; what would lie beyond the
/// head pin or the approach is left out.
pub(super) fn markings(plan: &Plan, config: &Config) -> Mesh {
    let mut mesh = Mesh::default();
    let board = config.lane.width_m as f32 / RULE_BOARDS;
    let x_of = |number: f32| (0.5 * (RULE_BOARDS + 1.0) - number) * board;
    for step in -3..=3_i32 {
        let (x, z) = (
            x_of(20.0 + 5.0 * step as f32),
            -4.7244 + 0.3048 * step.abs() as f32,
        );
        if z < plan.headpin {
            continue;
        }
        arrow(&mut mesh, Vec3::new(x, DECAL, z));
    }
    let lane_dots = [3.0, 5.0, 8.0, 11.0, 14.0, 26.0, 29.0, 32.0, 35.0, 37.0];
    for number in lane_dots {
        dot(&mut mesh, Vec3::new(x_of(number), DECAL, -2.1336));
    }
    for z in [0.0762, 3.6576, plan.approach_end - 0.05] {
        if z > plan.approach_end {
            continue;
        }
        for i in 1..=7 {
            dot(&mut mesh, Vec3::new(x_of(5.0 * i as f32), DECAL, z));
        }
    }
    // The pin spots, 2 1/4 in wide.
    let (pitch, half_spacing) = (
        config.lane.row_pitch_m as f32,
        0.5 * config.lane.pin_spacing_m as f32,
    );
    for row in 0..4 {
        for i in 0..=row {
            let x = (2 * i - row) as f32 * half_spacing;
            disc(
                &mut mesh,
                Vec3::new(x, DECAL, plan.headpin - row as f32 * pitch),
                0.028575,
            );
        }
    }
    mesh
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
