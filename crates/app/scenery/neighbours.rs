//! The lanes on both sides: seen, not played on. One is built, about its own middle, and drawn at each place.

use game::Config;
use glam::Vec3;

use super::mesh::Mesh;
use super::{Plan, Surface, block, both_sides, lane, markings};

/// Least distance from the outermost gutter to the wall [m].
const TO_WALL: f32 = 0.1;

/// The middles of the lanes beside the own one, as many as fit into the room; none if the scene shows none [m].
pub fn middles(config: &Config) -> Vec<f32> {
    let pitch = config.room.lane_pitch_m as f32;
    let edge = (0.5 * config.lane.width_m + config.gutter.width_m) as f32;
    let room = config.room.half_width_m as f32 - edge - TO_WALL;
    if !config.shows.neighbouring_lanes || room < pitch {
        return Vec::new();
    }
    let count = (room / pitch) as i32;
    (-count..=count)
        .filter(|number| *number != 0)
        .map(|number| pitch * number as f32)
        .collect()
}

/// One neighbouring lane about its own middle.
pub fn meshes(config: &Config) -> Vec<(Surface, Mesh)> {
    let plan = Plan::new(config);
    vec![
        (Surface::Lane, lane::boards(&plan)),
        (Surface::Markings, markings::lane_markings(&plan, config)),
        (Surface::Gutters, lane::gutters(&plan, config)),
        (Surface::Pit, lane::pit(&plan, config)),
        (Surface::Kickbacks, kickbacks(&plan, config)),
        (Surface::FoulLines, foul_line(&plan, config)),
    ]
}

fn kickbacks(plan: &Plan, config: &Config) -> Mesh {
    let kickback = &config.kickback;
    let front = plan.headpin + kickback.starts_before_headpin_m as f32;
    let outer = plan.edge + kickback.thickness_m as f32;
    let mut right = Mesh::default();
    block(
        &mut right,
        Vec3::new(plan.edge, plan.underside, plan.rear),
        Vec3::new(outer, kickback.height_m as f32, front),
    );
    both_sides(&right)
}

fn foul_line(plan: &Plan, config: &Config) -> Mesh {
    let half = 0.5 * config.room.foul_line_width_m as f32;
    let mut mesh = Mesh::default();
    block(
        &mut mesh,
        Vec3::new(-plan.half_lane, -0.001, -half),
        Vec3::new(plan.half_lane, 0.002, half),
    );
    mesh
}
