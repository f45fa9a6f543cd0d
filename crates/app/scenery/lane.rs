//! The lane's own scenery: boards, approach, gutters, capping, and the pit behind the deck.

use game::Config;
use glam::{Affine3A, Vec2, Vec3};

use super::mesh::Mesh;
use super::{Plan, block, both_sides, deck};

/// Length of boards that one texture image shows [m].
const IMAGE_LENGTH: f32 = 3.6;

/// Boards of the lane; in pieces, so that light falls off on it.
pub(super) fn boards(plan: &Plan) -> Mesh {
    let mut mesh = Mesh::default();
    let pieces = 8;
    for i in 0..pieces {
        let z = |i: i32| plan.deck_end * i as f32 / pieces as f32;
        let (near, far) = (z(i), z(i + 1));
        deck(
            &mut mesh,
            Vec2::new(-plan.half_lane, far),
            Vec2::new(plan.half_lane, near),
            0.0,
            Vec2::new(plan.images_across, (near - far) / IMAGE_LENGTH),
        );
    }
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
    let repeats = Vec2::new(
        plan.images_across * half / plan.half_lane,
        plan.approach_end / IMAGE_LENGTH,
    );
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
    let slices = 2 * config.gutter.facets as i32;
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
    let low = Vec3::new(plan.edge, plan.underside, plan.masking);
    block(&mut right, low, Vec3::new(plan.half_room, 0.0, 0.0));
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
    // The dark housing of the machine closes the view over cushion and kickbacks.
    block(
        &mut mesh,
        Vec3::new(-plan.half_room, plan.pit_floor, back - 0.05),
        Vec3::new(
            plan.half_room,
            (plan.masking_bottom + 0.4).max(cushion_top + 0.25),
            back,
        ),
    );
    let outside = plan.edge + config.kickback.thickness_m as f32 + 0.02;
    let mut beside = Mesh::default();
    block(
        &mut beside,
        Vec3::new(outside, plan.pit_floor, back),
        Vec3::new(plan.half_room, plan.masking_bottom, plan.masking - 0.02),
    );
    mesh.append(&both_sides(&beside), Affine3A::IDENTITY);
    mesh
}
