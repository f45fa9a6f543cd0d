//! The alley's scenery, in the world frame, from the measures in `config/default.toml`: one mesh per material.
//!
//! What the physics has as plain boxes (rack, desk, kickbacks, cushion) is drawn as those boxes; here is what is round,
//! painted, or only looked at.

use crate::mesh::{Mesh, cuboid, drum};
use game::Config;
use glam::{Affine3A, Vec2, Vec3};

/// Markings lie this far above the boards [m]: enough for a depth buffer at 20 m, too little to see from the side.
const DECAL: f32 = 0.0012;

/// Where things are [m], in the renderer's precision.
struct Plan {
    half_lane: f32,
    /// Inner face of the kickbacks, outer edge of the gutters.
    edge: f32,
    approach_end: f32,
    deck_end: f32,
    headpin: f32,
    flat_gutter: f32,
    cushion: f32,
    pit_floor: f32,
    half_room: f32,
    room_end: f32,
    ceiling: f32,
    /// Front of the panel that hides the pinsetter, and its lower edge.
    masking: f32,
    masking_bottom: f32,
}

impl Plan {
    fn new(c: &Config) -> Self {
        let headpin = c.lane.headpin_z_m as f32;
        let deck_end = c.lane.deck_end_z_m as f32;
        let half_lane = 0.5 * c.lane.width_m as f32;
        Self {
            half_lane,
            edge: half_lane + c.gutter.width_m as f32,
            approach_end: c.room.approach_length_m as f32,
            deck_end,
            headpin,
            flat_gutter: headpin + c.gutter.flat_starts_before_headpin_m as f32,
            cushion: deck_end - c.pit.cushion_behind_deck_m as f32,
            pit_floor: -c.pit.floor_below_deck_m as f32,
            half_room: c.room.half_width_m as f32,
            room_end: c.room.depth_m as f32,
            ceiling: c.room.height_m as f32,
            masking: headpin + c.kickback.starts_before_headpin_m as f32 + 0.25,
            masking_bottom: 0.85,
        }
    }
}

/// Every alley mesh by file stem.
pub fn meshes(config: &Config) -> Vec<(&'static str, Mesh)> {
    let plan = Plan::new(config);
    vec![
        ("lane", lane(&plan)),
        ("approach", approach(&plan)),
        ("markings", markings(&plan, config)),
        ("gutters", gutters(&plan, config)),
        ("sides", sides(&plan)),
        ("pit", pit(&plan, config)),
        ("masking", masking(&plan)),
        ("floor", floor(&plan)),
        ("walls", walls(&plan)),
        ("ceiling", ceiling(&plan)),
        ("lamps", lamps(&plan)),
        ("rack", rack(config)),
    ]
}

/// A horizontal face from `low` to `high` (x, z) at height `y`, seen from above; texture in `uv` along x and -z.
fn deck(mesh: &mut Mesh, low: Vec2, high: Vec2, y: f32, uv: Vec2) {
    let at = |x: f32, z: f32| Vec3::new(x, y, z);
    mesh.quad(
        [
            at(low.x, high.y),
            at(high.x, high.y),
            at(high.x, low.y),
            at(low.x, low.y),
        ],
        [Vec2::ZERO, uv],
    );
}

/// A box between two corners.
fn block(mesh: &mut Mesh, low: Vec3, high: Vec3) {
    mesh.append(
        &cuboid(0.5 * (high - low)),
        Affine3A::from_translation(0.5 * (low + high)),
    );
}

/// Boards with all of the width in one texture image, repeated along the lane; in pieces, so that light falls off on it.
fn lane(plan: &Plan) -> Mesh {
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
            Vec2::new(1.0, (near - far) / 3.6),
        );
    }
    // The tail plank's end, and the edges over the gutters.
    block(
        &mut mesh,
        Vec3::new(-plan.half_lane, plan.pit_floor, plan.deck_end),
        Vec3::new(plan.half_lane, -1e-4, -0.01),
    );
    mesh
}

/// The approach, boards as wide as the lane's.
fn approach(plan: &Plan) -> Mesh {
    let mut mesh = Mesh::default();
    let half = plan.edge + 0.35;
    let repeats = Vec2::new(half / plan.half_lane, plan.approach_end / 3.6);
    deck(
        &mut mesh,
        Vec2::new(-half, 0.0),
        Vec2::new(half, plan.approach_end),
        0.0,
        repeats,
    );
    mesh
}

/// Arrows and dots at the boards that the rule book gives: seven arrows 12 to 16 ft down the lane, dots on the lane at
/// 7 ft, rows of dots on the approach.
fn markings(plan: &Plan, config: &Config) -> Mesh {
    let mut mesh = Mesh::default();
    let board = config.lane.width_m as f32 / config.lane.boards as f32;
    let x_of = |number: f32| (20.0 - number) * board;
    for step in -3..=3_i32 {
        let (x, z) = (
            x_of(20.0 + 5.0 * step as f32),
            -4.7244 + 0.3048 * step.abs() as f32,
        );
        arrow(&mut mesh, Vec3::new(x, DECAL, z));
    }
    let lane_dots = [3.0, 5.0, 8.0, 11.0, 14.0, 26.0, 29.0, 32.0, 35.0, 37.0];
    for number in lane_dots {
        dot(&mut mesh, Vec3::new(x_of(number), DECAL, -2.1336));
    }
    for z in [0.0762, 3.6576, plan.approach_end - 0.05] {
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

/// Both gutters: a round trough to where the flat part beside the deck begins.
fn gutters(plan: &Plan, config: &Config) -> Mesh {
    let mut right = Mesh::default();
    let (width, depth) = (plan.edge - plan.half_lane, config.gutter.depth_m as f32);
    let slices = 10;
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

/// `right` and its mirror image across the lane's middle.
fn both_sides(right: &Mesh) -> Mesh {
    let mut mesh = Mesh::default();
    mesh.append(right, Affine3A::IDENTITY);
    mesh.append(right, Affine3A::from_scale(Vec3::new(-1.0, 1.0, 1.0)));
    mesh
}

/// The capping beside the gutters, level with the lane, out to the walls.
fn sides(plan: &Plan) -> Mesh {
    let mut right = Mesh::default();
    let low = Vec3::new(plan.edge, plan.pit_floor, plan.masking);
    block(&mut right, low, Vec3::new(plan.half_room, 0.0, 0.0));
    both_sides(&right)
}

/// The pit's floor and the cushion behind it.
fn pit(plan: &Plan, config: &Config) -> Mesh {
    let mut mesh = Mesh::default();
    let low = Vec2::new(-plan.edge, plan.cushion);
    deck(
        &mut mesh,
        low,
        Vec2::new(plan.edge, plan.deck_end),
        plan.pit_floor,
        Vec2::ONE,
    );
    let back = plan.cushion - config.pit.cushion_thickness_m as f32;
    block(
        &mut mesh,
        Vec3::new(-plan.edge, plan.pit_floor, back),
        Vec3::new(plan.edge, config.pit.cushion_height_m as f32, plan.cushion),
    );
    // The dark housing of the machine closes the view over cushion and kickbacks.
    block(
        &mut mesh,
        Vec3::new(-plan.half_room, plan.pit_floor, back - 0.05),
        Vec3::new(plan.half_room, plan.masking_bottom + 0.4, back),
    );
    for side in [-1.0, 1.0] {
        let (a, b) = (side * (plan.edge + 0.06), side * plan.half_room);
        block(
            &mut mesh,
            Vec3::new(a.min(b), plan.pit_floor, back),
            Vec3::new(a.max(b), plan.masking_bottom, plan.masking - 0.02),
        );
    }
    mesh
}

/// The panel that hides the pinsetter above the pins.
fn masking(plan: &Plan) -> Mesh {
    let mut mesh = Mesh::default();
    block(
        &mut mesh,
        Vec3::new(-plan.half_room, plan.masking_bottom, plan.masking - 0.05),
        Vec3::new(plan.half_room, plan.ceiling, plan.masking),
    );
    mesh
}

/// The floor beside and behind the approach.
fn floor(plan: &Plan) -> Mesh {
    let mut mesh = Mesh::default();
    let half = plan.edge + 0.35;
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
fn walls(plan: &Plan) -> Mesh {
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

fn ceiling(plan: &Plan) -> Mesh {
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
fn lamps(plan: &Plan) -> Mesh {
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
fn rack(config: &Config) -> Mesh {
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
