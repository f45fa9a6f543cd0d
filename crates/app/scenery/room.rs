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
    let tile = |low: Vec2, high: Vec2| (high - low) / 1.2;
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

/// The two side walls and the one behind the participant, seen from inside.
pub(super) fn walls(plan: &Plan) -> Mesh {
    let mut mesh = Mesh::default();
    let (low, high, near, far) = (-0.2, plan.ceiling, plan.room_end, plan.masking);
    let x = plan.half_room;
    let at = Vec3::new;
    let pieces = 6;
    for i in 0..pieces {
        let z = |i: i32| near + (far - near) * i as f32 / pieces as f32;
        let (a, b) = (z(i), z(i + 1));
        mesh.quad(
            [
                at(-x, low, a),
                at(-x, low, b),
                at(-x, high, b),
                at(-x, high, a),
            ],
            [Vec2::ZERO, Vec2::ONE],
        );
        mesh.quad(
            [at(x, low, b), at(x, low, a), at(x, high, a), at(x, high, b)],
            [Vec2::ZERO, Vec2::ONE],
        );
    }
    mesh.quad(
        [
            at(x, low, near),
            at(-x, low, near),
            at(-x, high, near),
            at(x, high, near),
        ],
        [Vec2::ZERO, Vec2::ONE],
    );
    mesh
}

/// The ceiling, seen from below.
pub(super) fn ceiling(plan: &Plan) -> Mesh {
    let mut mesh = Mesh::default();
    let (x, y) = (plan.half_room, plan.ceiling);
    let at = |x: f32, z: f32| Vec3::new(x, y, z);
    let (near, far) = (plan.room_end, plan.masking);
    mesh.quad(
        [at(-x, far), at(x, far), at(x, near), at(-x, near)],
        [Vec2::ZERO, Vec2::ONE],
    );
    mesh
}

/// Rows of luminous panels on the ceiling.
pub(super) fn lamps(plan: &Plan) -> Mesh {
    let mut mesh = Mesh::default();
    let mut z = plan.room_end - 1.5;
    while z > plan.masking + 1.5 {
        for x in [-0.6 * plan.half_room, 0.6 * plan.half_room] {
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
    let foot = drum(1.0, 0.03, 32);
    let scale = Vec3::new(1.1 * half.x, 1.0, 0.9 * half.z);
    mesh.append(
        &foot,
        Affine3A::from_translation(Vec3::new(x, 0.0, z)) * Affine3A::from_scale(scale),
    );
    mesh
}
