//! The lane's oil, as it is seen where practice shows it: patches of the boards, one mesh for each of a few amounts.

use game::Config;
use glam::{Vec2, Vec3};

use super::mesh::Mesh;
use super::{DECAL, Plan, Surface};

/// Amounts that are told apart; the largest is the pattern's most.
pub const LEVELS: u8 = 4;
/// Patches across the lane and along the oil.
const ACROSS: u32 = 13;
const ALONG: u32 = 30;

/// The patches with at least the smallest amount.
pub fn meshes(config: &Config) -> Vec<(Surface, Mesh)> {
    let plan = Plan::new(config);
    let oil = &config.oil;
    let most = 1.0 - oil.middle_factor.min(oil.edge_factor);
    if most <= 0.0 {
        return Vec::new();
    }
    let mut levels = vec![Mesh::default(); usize::from(LEVELS)];
    let width = 2.0 * plan.half_lane;
    let length = oil.length_m as f32;
    let edge = |index: u32, count: u32, size: f32| size * index as f32 / count as f32;
    for row in 0..ALONG {
        let [near, far] = [row, row + 1].map(|row| -edge(row, ALONG, length));
        for column in 0..ACROSS {
            let [left, right] =
                [column, column + 1].map(|column| edge(column, ACROSS, width) - plan.half_lane);
            let (x, down) = (0.5 * (left + right), -0.5 * (near + far));
            let factor = oil.factor(f64::from(x), f64::from(down), f64::from(width));
            let share = (1.0 - factor) / most;
            let level = (share * f64::from(LEVELS))
                .round()
                .clamp(0.0, f64::from(LEVELS));
            if level >= 1.0 {
                let mesh = &mut levels[level as usize - 1];
                patch(mesh, &plan, [left, right], [near, far]);
            }
        }
    }
    (1..=LEVELS)
        .map(Surface::Oil)
        .zip(levels)
        .filter(|(_, mesh)| !mesh.triangles.is_empty())
        .collect()
}

/// A piece of the lane a little above it, its boards where the lane has them.
fn patch(mesh: &mut Mesh, plan: &Plan, [left, right]: [f32; 2], [near, far]: [f32; 2]) {
    let at = |x: f32, z: f32| Vec3::new(x, 0.5 * DECAL, z);
    let board = |x: f32| (x + plan.half_lane) / plan.board;
    mesh.quad(
        [
            at(left, near),
            at(right, near),
            at(right, far),
            at(left, far),
        ],
        [Vec2::new(board(left), -near), Vec2::new(board(right), -far)],
    );
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::convert::tests::config;

    #[test]
    fn most_oil_lies_in_the_middle_and_none_behind_its_end() {
        let config = config();
        let meshes = meshes(&config);
        let reach = |level: u8| {
            let found = meshes
                .iter()
                .find(|(surface, _)| *surface == Surface::Oil(level));
            let (_, mesh) = found.unwrap_or_else(|| panic!("level {level}"));
            let places = || mesh.vertices.iter().map(|vertex| vertex.position);
            let widest = places().map(|at| at.x.abs()).fold(0.0, f32::max);
            let farthest = places().map(|at| at.z).fold(0.0, f32::min);
            (widest, farthest)
        };
        let (widest, farthest) = reach(LEVELS);
        assert!(widest < reach(1).0, "{widest}");
        assert!((0.25..0.45).contains(&widest), "{widest}");
        assert!(
            farthest > -(config.oil.length_m as f32) && farthest < -8.0,
            "{farthest}"
        );
        assert!(reach(1).1 >= -(config.oil.length_m as f32) - 1e-3);
    }

    #[test]
    fn a_dry_lane_has_no_patches() {
        let mut config = config();
        (config.oil.middle_factor, config.oil.edge_factor) = (1.0, 1.0);
        assert!(meshes(&config).is_empty());
    }
}
