//! The room around the lane: floor, walls, ceiling, lamps, and the stand of the ball rack.

use game::Config;
use glam::{Affine3A, Vec2, Vec3};

use super::mesh::{Mesh, drum};
use super::{DECAL, Plan, block, deck};

/// The panel that hides the pinsetter above the pins.
pub(super) fn masking(plan: &Plan) -> Mesh {
    let mut mesh = Mesh::default();
    block(
        &mut mesh,
        Vec3::new(-plan.half_room, plan.masking_bottom, plan.masking - 0.05),
        Vec3::new(plan.half_room, plan.ceiling, plan.masking),
    );
    mesh
}

/// The floor beside and behind the approach.
pub(super) fn floor(plan: &Plan) -> Mesh {
    let mut mesh = Mesh::default();
    let half = plan.approach_half();
    let y = -2.0 * DECAL;
    let tile = |low: Vec2, high: Vec2| (high - low) / TUFT;
    let mut add = |low: Vec2, high: Vec2| deck(&mut mesh, low, high, y, tile(low, high));
    add(
        Vec2::new(-plan.half_room, 0.0),
        Vec2::new(-half, plan.approach_end),
    );
    add(
        Vec2::new(half, 0.0),
        Vec2::new(plan.half_room, plan.approach_end),
    );
    add(
        Vec2::new(-plan.half_room, plan.approach_end),
        Vec2::new(plan.half_room, plan.room_end),
    );
    mesh
}

/// A band of the two side walls and of the one behind the participant, from `low` to `high`, seen from inside; u runs along the
/// walls in `unit` [m], v upwards in the same.
fn band(plan: &Plan, inset: f32, [low, high]: [f32; 2], unit: f32) -> Mesh {
    let mut mesh = Mesh::default();
    let (near, far, x) = (plan.room_end - inset, plan.masking, plan.half_room - inset);
    let at = Vec3::new;
    let tall = (high - low) / unit;
    let along = Vec2::new((near - far) / unit, tall);
    let across = Vec2::new(2.0 * x / unit, tall);
    mesh.quad(
        [
            at(-x, low, near),
            at(-x, low, far),
            at(-x, high, far),
            at(-x, high, near),
        ],
        [Vec2::ZERO, along],
    );
    mesh.quad(
        [
            at(x, low, far),
            at(x, low, near),
            at(x, high, near),
            at(x, high, far),
        ],
        [Vec2::ZERO, along],
    );
    mesh.quad(
        [
            at(x, low, near),
            at(-x, low, near),
            at(-x, high, near),
            at(x, high, near),
        ],
        [Vec2::ZERO, across],
    );
    mesh
}

/// Height of the walls' panelling [m].
const WAINSCOT: f32 = 1.05;

/// Below the floors, so that no gap shows.
const WALL_FOOT: f32 = -0.2;

/// The two side walls and the one behind the participant, seen from inside.
pub(super) fn walls(plan: &Plan) -> Mesh {
    band(plan, 0.0, [WALL_FOOT, plan.ceiling], 1.0)
}

/// The walls' panelling, a rail on top of it: a little in front of them.
pub(super) fn wainscot(plan: &Plan) -> Mesh {
    if !plan.has_furnishings {
        return Mesh::default();
    }
    let top = WAINSCOT.min(plan.ceiling);
    let mut mesh = band(plan, 0.002, [WALL_FOOT, top], 0.11);
    let (x, z) = (plan.half_room, plan.room_end);
    let deep = 0.03;
    for side in [-1.0_f32, 1.0] {
        let (low, high) = (side * x, side * (x - deep));
        block(
            &mut mesh,
            Vec3::new(low.min(high), top, plan.masking),
            Vec3::new(low.max(high), top + 0.04, z),
        );
    }
    block(
        &mut mesh,
        Vec3::new(-x, top, z - deep),
        Vec3::new(x, top + 0.04, z),
    );
    mesh
}

/// The ceiling, seen from below, in tiles.
pub(super) fn ceiling(plan: &Plan) -> Mesh {
    let mut mesh = Mesh::default();
    let (x, y) = (plan.half_room, plan.ceiling);
    let at = |x: f32, z: f32| Vec3::new(x, y, z);
    let (near, far) = (plan.room_end, plan.masking);
    mesh.quad(
        [at(-x, far), at(x, far), at(x, near), at(-x, near)],
        [Vec2::ZERO, Vec2::new(2.0 * x, near - far) / TILE],
    );
    mesh
}

/// Edge of a ceiling tile, and of a repeat of the carpet [m].
const TILE: f32 = 0.6;
const TUFT: f32 = 0.3;

/// Rows of luminous panels on the ceiling, between the lanes.
pub(super) fn lamps(plan: &Plan) -> Mesh {
    let mut mesh = Mesh::default();
    let mut rows: Vec<f32> = plan
        .neighbours
        .iter()
        .map(|x| x - x.signum() * 0.5 * plan.pitch)
        .collect();
    if rows.is_empty() {
        rows = vec![-0.6 * plan.half_room, 0.6 * plan.half_room];
    }
    let mut z = plan.room_end - 1.5;
    while z > plan.masking + 1.5 {
        for x in &rows {
            block(
                &mut mesh,
                Vec3::new(x - 0.15, plan.ceiling - 0.06, z - 0.6),
                Vec3::new(x + 0.15, plan.ceiling - 0.01, z + 0.6),
            );
        }
        z -= 3.0;
    }
    mesh
}

/// The ball return's stand under its tray. The tray's rims are drawn where the physics has them.
pub(super) fn rack_stand(config: &Config) -> Mesh {
    let mut mesh = Mesh::default();
    let c = &config.rack;
    let cell = |diameter: f64| diameter + 2.0 * c.clearance_m;
    let widest = config
        .balls
        .iter()
        .map(|b| b.diameter_m)
        .fold(0.0, f64::max);
    let length: f64 = config
        .balls
        .iter()
        .map(|b| cell(b.diameter_m) + c.rim_thickness_m)
        .sum();
    let half = Vec3::new(
        (0.5 * cell(widest) + c.rim_thickness_m) as f32,
        0.0,
        (0.5 * (length + c.rim_thickness_m)) as f32,
    );
    let (x, z, top) = (c.x_m as f32, c.z_m as f32, c.tray_height_m as f32);
    let stand = 0.62;
    block(
        &mut mesh,
        Vec3::new(x - stand * half.x, 0.0, z - stand * half.z),
        Vec3::new(x + stand * half.x, top - 0.04, z + stand * half.z),
    );
    let foot = drum(1.0, 0.03, if config.shows.low_polygon { 8 } else { 32 });
    let scale = Vec3::new(1.1 * half.x, 1.0, 0.9 * half.z);
    mesh.append(
        &foot,
        Affine3A::from_translation(Vec3::new(x, 0.0, z)) * Affine3A::from_scale(scale),
    );
    mesh
}
