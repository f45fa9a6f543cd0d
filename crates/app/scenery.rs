//! The scenery: what never moves, built from the settings in the world frame, one mesh per material.
//!
//! The settings move the physics, so they make the pictures too. What the physics has as plain boxes (rack, desk, kickbacks,
//! foul line) is drawn as those boxes; here is what is round, painted, or only looked at.

pub(crate) mod furnishings;
pub mod hand;
mod lane;
mod markings;
pub mod mesh;
mod neighbours;
pub mod oil;
mod room;

use game::Config;
use glam::{Affine3A, Vec2, Vec3};

use mesh::{Mesh, cuboid};

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
    /// Rear of the cushion.
    rear: f32,
    pit_floor: f32,
    /// Lower edge of what is seen at the lane's sides: no higher than gutters and pit.
    underside: f32,
    half_room: f32,
    room_end: f32,
    ceiling: f32,
    /// Front of the panel that hides the pinsetter, and its lower edge.
    masking: f32,
    masking_bottom: f32,
    /// Width of a board.
    board: f32,
    /// From one lane's middle to the next, and the middles of the neighbours.
    pitch: f32,
    neighbours: Vec<f32>,
    /// Corners are left out where they only make things look rounder.
    is_low: bool,
    has_furnishings: bool,
}

impl Plan {
    fn new(c: &Config) -> Self {
        let headpin = c.lane.headpin_z_m as f32;
        let deck_end = c.lane.deck_end_z_m as f32;
        let half_lane = 0.5 * c.lane.width_m as f32;
        let cushion = deck_end - c.pit.cushion_behind_deck_m as f32;
        let pit_floor = -c.pit.floor_below_deck_m as f32;
        let ceiling = c.room.height_m as f32;
        Self {
            half_lane,
            edge: half_lane + c.gutter.width_m as f32,
            approach_end: c.room.approach_length_m as f32,
            deck_end,
            headpin,
            flat_gutter: headpin + c.gutter.flat_starts_before_headpin_m as f32,
            cushion,
            rear: cushion - c.pit.cushion_thickness_m as f32,
            pit_floor,
            underside: pit_floor.min(-c.gutter.depth_at_deck_m as f32),
            half_room: c.room.half_width_m as f32,
            room_end: c.room.depth_m as f32,
            ceiling,
            masking: headpin + c.kickback.starts_before_headpin_m as f32 + 0.25,
            masking_bottom: (c.kickback.height_m as f32 + 0.35).min(ceiling - 0.1),
            board: c.lane.width_m as f32 / c.lane.boards as f32,
            pitch: c.room.lane_pitch_m as f32,
            neighbours: neighbours::middles(c),
            is_low: c.shows.low_polygon,
            has_furnishings: c.shows.furnishings,
        }
    }

    /// Half of the approach's width [m]: it runs behind all lanes.
    fn approach_half(&self) -> f32 {
        if self.neighbours.is_empty() {
            (self.edge + 0.35).min(self.half_room)
        } else {
            self.half_room
        }
    }

    /// Where the outermost lane ends at the right: the outer edge of its gutter.
    fn lanes_end(&self) -> f32 {
        self.neighbours.iter().fold(0.0, |far, x| x.max(far)) + self.edge
    }

    /// The strips between lanes and out to the walls, at the right of the middle, as (from, to).
    fn between_lanes(&self) -> Vec<(f32, f32)> {
        let mut strips: Vec<_> = self
            .neighbours
            .iter()
            .filter(|x| **x > 0.0)
            .map(|x| (x - self.pitch + self.edge, x - self.edge))
            .collect();
        strips.push((self.lanes_end(), self.half_room));
        strips
    }
}

/// What a mesh of the scenery shows, and so how it looks.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Surface {
    /// The lane's boards with the pin deck.
    Lane,
    /// The approach's boards.
    Approach,
    /// Oil on the boards, where it is shown: from 1 to the most that there is.
    Oil(u8),
    /// Arrows, dots and pin spots.
    Markings,
    /// Both gutters.
    Gutters,
    /// The capping beside the gutters.
    Capping,
    /// Pit, cushion, and the housing of the machine.
    Pit,
    /// The panel above the pins.
    Masking,
    /// The floor beside and behind the approach.
    Floor,
    /// The three walls that are seen, above their panelling.
    Walls,
    /// The panelling.
    Wainscot,
    /// The ceiling.
    Ceiling,
    /// The luminous panels on it.
    Lamps,
    /// The stand of the ball rack.
    RackStand,
    /// The kickbacks of the neighbouring lanes.
    Kickbacks,
    /// The foul lines of the neighbouring lanes.
    FoulLines,
    /// Upholstery of the seats.
    Seats,
    /// Metal legs, tubes and brackets.
    Metal,
    /// The cases of the screens.
    Cases,
    /// The screens of the neighbouring lanes, on which nobody plays.
    IdleScreens,
    /// Tubes of light along the side walls.
    Neon,
    /// The screen over the own lane, with both score sheets; its texture fills it once.
    Scoreboard,
}

/// The scenery that `config` describes, in the world frame; a surface that has no area under it is left out.
pub fn meshes(config: &Config) -> Vec<(Surface, Mesh)> {
    let plan = Plan::new(config);
    let mut meshes = vec![
        (Surface::Lane, lane::boards(&plan)),
        (Surface::Approach, lane::approach(&plan)),
        (Surface::Markings, markings::markings(&plan, config)),
        (Surface::Gutters, lane::gutters(&plan, config)),
        (Surface::Capping, lane::capping(&plan)),
        (Surface::Pit, lane::pit(&plan, config)),
        (Surface::Pit, lane::housing(&plan, config)),
        (Surface::Masking, room::masking(&plan)),
        (Surface::Floor, room::floor(&plan)),
        (Surface::Walls, room::walls(&plan)),
        (Surface::Ceiling, room::ceiling(&plan)),
        (Surface::Lamps, room::lamps(&plan)),
        (Surface::Wainscot, room::wainscot(&plan)),
        (Surface::RackStand, room::rack_stand(config)),
    ];
    if plan.has_furnishings {
        meshes.extend(furnishings::meshes(&plan));
    }
    if config.practice.shows_lane {
        meshes.extend(oil::meshes(config));
    }
    meshes.retain(|(_, mesh)| !mesh.triangles.is_empty());
    meshes
}

pub use furnishings::{HouseBall, house_balls, screen_mesh};
pub use markings::pin_spots;
pub use neighbours::{meshes as neighbour_meshes, middles as neighbour_middles};

/// A horizontal face from `low` to `high` (x, z) at height `y`, seen from above; texture in `uv` along x and -z. Nothing where
/// there is no area.
fn deck(mesh: &mut Mesh, low: Vec2, high: Vec2, y: f32, uv: Vec2) {
    if (high - low).min_element() <= 0.0 {
        return;
    }
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

/// A box between two corners; nothing where it would have no volume.
fn block(mesh: &mut Mesh, low: Vec3, high: Vec3) {
    if (high - low).min_element() <= 0.0 {
        return;
    }
    mesh.append(
        &cuboid(0.5 * (high - low)),
        Affine3A::from_translation(0.5 * (low + high)),
    );
}

/// `right` and its mirror image across the lane's middle.
fn both_sides(right: &Mesh) -> Mesh {
    let mut mesh = Mesh::default();
    mesh.append(right, Affine3A::IDENTITY);
    mesh.append(right, Affine3A::from_scale(Vec3::new(-1.0, 1.0, 1.0)));
    mesh
}

#[cfg(test)]
mod tests;
