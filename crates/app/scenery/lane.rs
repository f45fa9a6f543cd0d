//! The lane's own scenery: boards, approach, gutters, capping, the pit behind the deck and the housing over it.

use game::Config;
use glam::{Affine3A, Vec2, Vec3};

use super::mesh::Mesh;
use super::{Plan, block, both_sides, deck};

/// Boards of the lane: u counts them, v is metres.
pub(super) fn boards(plan: &Plan) -> Mesh {
    let mut mesh = Mesh::default();
    deck(
        &mut mesh,
        Vec2::new(-plan.half_lane, plan.deck_end),
        Vec2::new(plan.half_lane, 0.0),
        0.0,
        Vec2::new(2.0 * plan.half_lane / plan.board, -plan.deck_end),
    );
    // The tail plank's end, and the edges over the gutters.
    block(
        &mut mesh,
        Vec3::new(-plan.half_lane, plan.underside, plan.deck_end),
        Vec3::new(plan.half_lane, -1e-4, -0.01),
    );
    mesh
}

/// The approach, boards as wide as the lane's.
pub(super) fn approach(plan: &Plan) -> Mesh {
    let mut mesh = Mesh::default();
    let half = plan.approach_half();
    let repeats = Vec2::new(2.0 * half / plan.board, plan.approach_end);
    deck(
        &mut mesh,
        Vec2::new(-half, 0.0),
        Vec2::new(half, plan.approach_end),
        0.0,
        repeats,
    );
    mesh
}

/// Both gutters: a round trough to where the flat part beside the deck begins.
pub(super) fn gutters(plan: &Plan, config: &Config) -> Mesh {
    let mut right = Mesh::default();
    let (width, depth) = (plan.edge - plan.half_lane, config.gutter.depth_m as f32);
    // Every other edge is one of the strips that collide; those between make it look round.
    let finer = if plan.is_low { 1 } else { 2 };
    let slices = finer * config.gutter.facets as i32;
    // The arc of a circle through both edges, `depth` below them in the middle.
    let radius = (0.25 * width * width + depth * depth) / (2.0 * depth);
    let height = |x: f32| radius - depth - (radius * radius - (x - 0.5 * width).powi(2)).sqrt();
    for i in 0..slices {
        let x = |i: i32| width * i as f32 / slices as f32;
        let (a, b) = (x(i), x(i + 1));
        let at = |x: f32, z: f32| Vec3::new(plan.half_lane + x, height(x).min(0.0), z);
        right.quad(
            [
                at(a, 0.0),
                at(b, 0.0),
                at(b, plan.flat_gutter),
                at(a, plan.flat_gutter),
            ],
            [Vec2::ZERO, Vec2::ONE],
        );
    }
    let flat = -config.gutter.depth_at_deck_m as f32;
    deck(
        &mut right,
        Vec2::new(plan.half_lane, plan.deck_end),
        Vec2::new(plan.edge, plan.flat_gutter),
        flat,
        Vec2::ONE,
    );
    both_sides(&right)
}

/// The capping beside the gutters, level with the lane, out to the walls.
pub(super) fn capping(plan: &Plan) -> Mesh {
    let mut right = Mesh::default();
    for (from, to) in plan.between_lanes() {
        let low = Vec3::new(from, plan.underside, plan.masking);
        block(&mut right, low, Vec3::new(to, 0.0, 0.0));
    }
    both_sides(&right)
}

/// The pit's floor and the cushion behind it.
pub(super) fn pit(plan: &Plan, config: &Config) -> Mesh {
    let mut mesh = Mesh::default();
    let low = Vec2::new(-plan.edge, plan.cushion);
    deck(
        &mut mesh,
        low,
        Vec2::new(plan.edge, plan.deck_end),
        plan.pit_floor,
        Vec2::ONE,
    );
    let back = plan.rear;
    let cushion_top = config.pit.cushion_height_m as f32;
    block(
        &mut mesh,
        Vec3::new(-plan.edge, plan.pit_floor, back),
        Vec3::new(plan.edge, cushion_top, plan.cushion),
    );
    mesh
}

/// The dark housing of the machines: it closes the view over cushions and kickbacks, and between the lanes.
pub(super) fn housing(plan: &Plan, config: &Config) -> Mesh {
    let mut mesh = Mesh::default();
    let back = plan.rear;
    let cushion_top = config.pit.cushion_height_m as f32;
    block(
        &mut mesh,
        Vec3::new(-plan.half_room, plan.pit_floor, back - 0.05),
        Vec3::new(
            plan.half_room,
            (plan.masking_bottom + 0.4).max(cushion_top + 0.25),
            back,
        ),
    );
    let kickback = config.kickback.thickness_m as f32 + 0.02;
    let mut beside = Mesh::default();
    for (from, to) in plan.between_lanes() {
        // Beyond the outermost kickback there is a wall, not another kickback.
        let to = if to < plan.half_room {
            to - kickback
        } else {
            to
        };
        block(
            &mut beside,
            Vec3::new(from + kickback, plan.pit_floor, back),
            Vec3::new(to, plan.masking_bottom, plan.masking - 0.02),
        );
    }
    mesh.append(&both_sides(&beside), Affine3A::IDENTITY);
    mesh
}
