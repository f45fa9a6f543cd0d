//! What makes a hall an alley and takes no part in the game: seats, screens, a rack of house balls.

use game::Config;
use glam::{Affine3A, Quat, Vec2, Vec3};

use super::mesh::{Mesh, drum};
use super::{Plan, Surface, block, both_sides};

/// The screen over the foul line: width and height [m], its middle's height and place along the lane [m].
pub(crate) const SCREEN: [f32; 2] = [1.7, 0.75];
const SCREEN_HEIGHT: f32 = 2.52;
const SCREEN_Z: f32 = -0.9;
/// How far it leans towards who looks up at it [rad].
const SCREEN_LEAN: f32 = 0.17;

/// How far before the screen lies what covers it [m].
const COVER: f32 = 0.004;

/// The tubes on the side walls: how thick, how far from the wall, and their lower edge [m].
const NEON_THICK: f32 = 0.035;
const NEON_FROM_WALL: f32 = 0.02;
const NEON_HEIGHT: f32 = 2.05;

/// Depth of the rack of house balls [m], and its tiers [m].
const SHELF_DEPTH: f32 = 0.26;
const TIERS: [f32; 3] = [0.35, 0.7, 1.05];
/// Distance between two balls on it [m], and how many lie on a tier.
const BALL_SPACING: f32 = 0.27;
const BALLS_ON_TIER: i32 = 5;

/// A ball that lies on the rack beside the room and is only looked at.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HouseBall {
    /// Its middle, world frame [m].
    pub position: Vec3,
    /// Its radius [m].
    pub radius: f32,
    /// A number that tells one from another, for colour and turn.
    pub number: usize,
}

/// The furnishings of the room.
pub(super) fn meshes(plan: &Plan) -> Vec<(Surface, Mesh)> {
    let [seats, legs] = benches(plan);
    let mut metal = legs;
    metal.append(&shelf(plan), Affine3A::IDENTITY);
    metal.append(&screen_rods(plan), Affine3A::IDENTITY);
    let mut cases = Mesh::default();
    let mut idle = Mesh::default();
    for middle in plan.neighbours.iter().chain([&0.0]) {
        let place = screen_place(*middle, plan);
        cases.append(&case(), place);
        if *middle != 0.0 {
            idle.append(&screen(), place);
        }
    }
    let mut own = Mesh::default();
    own.append(&screen(), screen_place(0.0, plan));
    vec![
        (Surface::Seats, seats),
        (Surface::Metal, metal),
        (Surface::Cases, cases),
        (Surface::Neon, neon(plan)),
        (Surface::IdleScreens, idle),
        (Surface::Scoreboard, own),
    ]
}

/// A tube of light along each side wall, which leads the eye to the pins.
fn neon(plan: &Plan) -> Mesh {
    let mut tube = Mesh::default();
    let outer = plan.half_room - NEON_FROM_WALL;
    block(
        &mut tube,
        Vec3::new(outer - NEON_THICK, NEON_HEIGHT, plan.masking),
        Vec3::new(outer, NEON_HEIGHT + NEON_THICK, plan.room_end),
    );
    both_sides(&tube)
}

fn screen_place(middle: f32, plan: &Plan) -> Affine3A {
    let height = SCREEN_HEIGHT.min(plan.ceiling - 0.5 * SCREEN[1] - 0.1);
    Affine3A::from_rotation_translation(
        Quat::from_rotation_x(SCREEN_LEAN),
        Vec3::new(middle, height, SCREEN_Z),
    )
}

/// What covers the screen over the own lane, its texture filling it once.
pub fn screen_mesh(config: &Config) -> Mesh {
    let cover = Affine3A::from_translation(Vec3::Z * COVER);
    let mut mesh = Mesh::default();
    mesh.append(&screen(), screen_place(0.0, &Plan::new(config)) * cover);
    mesh
}

/// Middle of the screen over the own lane.
#[cfg(test)]
pub(crate) fn screen_middle(config: &Config) -> Vec3 {
    screen_place(0.0, &Plan::new(config)).translation.into()
}

/// Facing +z, about its middle.
fn screen() -> Mesh {
    let mut mesh = Mesh::default();
    let [x, y] = SCREEN.map(|side| 0.5 * side);
    let z = 0.003;
    mesh.quad(
        [
            Vec3::new(-x, -y, z),
            Vec3::new(x, -y, z),
            Vec3::new(x, y, z),
            Vec3::new(-x, y, z),
        ],
        [Vec2::ZERO, Vec2::ONE],
    );
    mesh
}

fn case() -> Mesh {
    let mut mesh = Mesh::default();
    let [x, y] = SCREEN.map(|side| 0.5 * side + 0.025);
    block(&mut mesh, Vec3::new(-x, -y, -0.07), Vec3::new(x, y, 0.0));
    mesh
}

/// Two rods from the ceiling for each screen.
fn screen_rods(plan: &Plan) -> Mesh {
    let mut mesh = Mesh::default();
    let foot = screen_place(0.0, plan).translation.y;
    for middle in plan.neighbours.iter().chain([&0.0]) {
        for x in [middle - 0.5, middle + 0.5] {
            let z = SCREEN_Z - 0.06;
            block(
                &mut mesh,
                Vec3::new(x - 0.015, foot, z - 0.015),
                Vec3::new(x + 0.015, plan.ceiling, z + 0.015),
            );
        }
    }
    mesh
}

/// Benches along the wall behind the approach: seat and back, and their legs.
fn benches(plan: &Plan) -> [Mesh; 2] {
    let (mut seat, mut legs) = (Mesh::default(), Mesh::default());
    let rear = plan.room_end - 0.06;
    let outer = (plan.half_room - 0.3).min(3.6);
    let inner = 0.7;
    let wide = 1.35;
    let mut left = inner;
    while left + wide <= outer {
        let right = left + wide;
        let at = Vec3::new;
        // A cushion and a back, each with a seam in the middle.
        let half = 0.5 * (left + right);
        for (a, b) in [(left, half - 0.004), (half + 0.004, right)] {
            block(
                &mut seat,
                at(a, 0.36, rear - 0.44),
                at(b, 0.46, rear - 0.06),
            );
            block(&mut seat, at(a, 0.5, rear - 0.12), at(b, 0.92, rear));
        }
        for x in [left + 0.12, right - 0.12] {
            let foot = drum(0.03, 0.36, if plan.is_low { 6 } else { 12 });
            for z in [rear - 0.36, rear - 0.1] {
                legs.append(&foot, Affine3A::from_translation(at(x, 0.0, z)));
            }
        }
        left = right + 0.15;
    }
    [both_sides(&seat), both_sides(&legs)]
}

/// Middle of the rack of house balls: by the right wall, behind the approach's dots.
fn shelf_place(plan: &Plan) -> Vec3 {
    let z = 0.55 * plan.approach_end;
    Vec3::new(plan.half_room - 0.5 * SHELF_DEPTH - 0.06, 0.0, z)
}

fn shelf(plan: &Plan) -> Mesh {
    let mut mesh = Mesh::default();
    let middle = shelf_place(plan);
    let half = Vec3::new(
        0.5 * SHELF_DEPTH,
        0.0,
        0.5 * BALL_SPACING * BALLS_ON_TIER as f32,
    );
    for height in TIERS {
        // Two rails carry the balls.
        for x in [-0.07, 0.07] {
            let rail = middle + Vec3::new(x, height, 0.0);
            let thick = Vec3::new(0.012, 0.012, half.z);
            block(&mut mesh, rail - thick, rail + thick);
        }
    }
    for end in [-1.0, 1.0] {
        let foot = middle + Vec3::new(0.0, 0.0, end * (half.z + 0.02));
        let thick = Vec3::new(half.x, 0.0, 0.02);
        let top = TIERS[TIERS.len() - 1] + 0.16;
        block(&mut mesh, foot - thick, foot + thick + Vec3::Y * top);
    }
    mesh
}

/// The balls on the rack beside the room; none where the scene has no furnishings.
pub fn house_balls(config: &Config) -> Vec<HouseBall> {
    let plan = Plan::new(config);
    if !plan.has_furnishings {
        return Vec::new();
    }
    let middle = shelf_place(&plan);
    let radius: f32 = 0.1085;
    // On two rails 0.14 m apart: the middle lies below the rails' distance plus the radius.
    let above = (radius * radius - 0.07 * 0.07).sqrt() + 0.012;
    let mut balls = Vec::new();
    for (tier, height) in TIERS.into_iter().enumerate() {
        for place in 0..BALLS_ON_TIER {
            let along = (place as f32 - 0.5 * (BALLS_ON_TIER - 1) as f32) * BALL_SPACING;
            balls.push(HouseBall {
                position: middle + Vec3::new(0.0, height + above, along),
                radius,
                number: 3 * tier + place as usize,
            });
        }
    }
    balls
}
