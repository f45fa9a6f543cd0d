use game::{Conditions, Game, Model};
use physics::query::{Limits, separation};
use physics::{Pose, Shape};

use super::*;
use crate::convert::tests::config as shipped;
use glam::DVec3;

/// The shipped settings without what takes no part in the game.
fn config() -> Config {
    let mut config = shipped();
    config.shows.neighbouring_lanes = false;
    config.shows.furnishings = false;
    config
}

/// Seen and solid surfaces lie no farther apart than this [m]: floors beside the approach are seen 2.4 mm low, round
/// gutters bulge 2 mm below the strips that collide.
const AGREEMENT: f64 = 0.003;

/// The building's boxes, as the physics has them.
fn solids(config: &Config) -> Vec<(Shape, Pose)> {
    let conditions = Conditions {
        lobby: config.clone(),
        red: config.clone(),
        blue: config.clone(),
    };
    let game = Game::new(conditions, 1).expect("settings that make a room");
    let is_building = |model| {
        matches!(
            model,
            Model::Lane
                | Model::Approach
                | Model::Gutter
                | Model::Pit
                | Model::Cushion
                | Model::SideFloor
                | Model::Wall
                | Model::Ceiling
        )
    };
    game.visible()
        .into_iter()
        .filter(|visible| is_building(visible.model))
        .map(|box_| {
            let shape = Shape::cuboid(0.5 * box_.size).expect("a box with a volume");
            (shape, box_.pose)
        })
        .collect()
}

/// How far a grain flies until it touches something solid [m]: at each point no farther than the nearest surface is.
fn solid_distance(solids: &[(Shape, Pose)], from: DVec3, direction: DVec3) -> f64 {
    let radius = 1e-5;
    let grain = Shape::sphere(radius).expect("a radius");
    let mut way = 0.0;
    for _ in 0..2000 {
        let at = Pose::from_position(from + way * direction);
        let gap = solids
            .iter()
            .map(|(shape, pose)| {
                separation((&grain, &at), (shape, pose), None, Limits::default()).gap
            })
            .fold(f64::INFINITY, f64::min);
        if gap < 1e-6 {
            return way + radius;
        }
        way += gap;
    }
    panic!("nothing solid from {from} along {direction}");
}

/// How far one sees until the first triangle that faces the eye [m] (Moeller and Trumbore 1997).
fn seen_distance(scenery: &[(Surface, Mesh)], from: DVec3, direction: DVec3) -> f64 {
    let (from, direction) = (from.as_vec3(), direction.as_vec3());
    let mut nearest = f32::INFINITY;
    for (_, mesh) in scenery {
        for corners in &mesh.triangles {
            let [a, b, c] = corners.map(|index| mesh.vertices[index as usize].position);
            let (ab, ac) = (b - a, c - a);
            let across = direction.cross(ac);
            let facing = ab.dot(across);
            if facing <= 1e-9 {
                continue;
            }
            let off = from - a;
            let u = off.dot(across) / facing;
            let turned = off.cross(ab);
            let v = direction.dot(turned) / facing;
            let way = ac.dot(turned) / facing;
            if u >= 0.0 && v >= 0.0 && u + v <= 1.0 && way > 0.0 {
                nearest = nearest.min(way);
            }
        }
    }
    f64::from(nearest)
}

/// Looks down on every floor, into the gutters and the pit, at the walls and at the ceiling: origin and direction.
fn glances(config: &Config) -> Vec<(DVec3, DVec3)> {
    let half = config.lane.width_m / 2.0;
    let edge = half + config.gutter.width_m;
    let side = config.room.half_width_m;
    let (headpin, deck_end) = (config.lane.headpin_z_m, config.lane.deck_end_z_m);
    let flat = headpin + config.gutter.flat_starts_before_headpin_m;
    let in_pit = deck_end - 0.5 * config.pit.cushion_behind_deck_m;
    let mut glances = Vec::new();
    for mirror in [-1.0, 1.0] {
        for (x, z) in [
            (0.9 * half, -1.03),
            (0.5 * half, 0.5 * headpin),
            (0.9 * half, deck_end + 0.05),
            (half + 0.2 * config.gutter.width_m, 0.5 * headpin),
            (half + 0.52 * config.gutter.width_m, 0.5 * headpin),
            (half + 0.8 * config.gutter.width_m, 0.5 * headpin),
            (half + 0.5 * config.gutter.width_m, 0.5 * (flat + deck_end)),
            (0.5 * (edge + side), 0.5 * headpin),
            (0.3 * half, 0.55),
            (0.3 * half, config.room.depth_m - 0.1),
            (0.98 * side, 0.5 * config.room.depth_m),
            (0.7 * edge, in_pit),
        ] {
            glances.push((DVec3::new(mirror * x, 0.4, z), DVec3::NEG_Y));
        }
        glances.push((DVec3::new(0.0, 1.5, 1.0), DVec3::X * mirror));
        glances.push((DVec3::new(0.0, 0.3, 0.6 * headpin), DVec3::X * mirror));
    }
    glances.push((DVec3::new(0.05, 1.5, 1.0), DVec3::Y));
    glances.push((DVec3::new(0.05, 1.5, 1.0), DVec3::Z));
    glances.push((DVec3::new(0.1, 0.1, deck_end - 0.05), DVec3::NEG_Z));
    glances
}

/// Distances to what is solid at these glances, after they were compared with what is seen.
fn agreed(config: &Config, name: &str, glances: &[(DVec3, DVec3)]) -> Vec<f64> {
    let (solids, scenery) = (solids(config), meshes(config));
    glances
        .iter()
        .copied()
        .map(|(from, direction)| {
            let solid = solid_distance(&solids, from, direction);
            let seen = seen_distance(&scenery, from, direction);
            assert!(
                (seen - solid).abs() < AGREEMENT,
                "{name}, from {from} along {direction}: seen at {seen} m, solid at {solid} m"
            );
            solid
        })
        .collect()
}

/// A setting's name, and what changes it.
type Change = (&'static str, fn(&mut Config));

#[test]
fn what_is_seen_is_where_it_is_solid_whatever_the_settings() {
    let changes: [Change; 12] = [
        ("lane.width_m", |c| c.lane.width_m = 1.4),
        ("lane.headpin_z_m", |c| {
            c.lane.headpin_z_m = -17.5;
            c.lane.deck_end_z_m = -18.4;
        }),
        ("lane.deck_end_z_m", |c| c.lane.deck_end_z_m = -19.5),
        ("gutter.width_m", |c| c.gutter.width_m = 0.3),
        ("gutter.depth_m", |c| c.gutter.depth_m = 0.06),
        ("gutter.depth_at_deck_m", |c| c.gutter.depth_at_deck_m = 0.2),
        ("pit.floor_below_deck_m", |c| c.pit.floor_below_deck_m = 0.3),
        ("pit.cushion_behind_deck_m", |c| {
            c.pit.cushion_behind_deck_m = 1.5
        }),
        ("room.half_width_m", |c| c.room.half_width_m = 5.5),
        ("room.depth_m", |c| c.room.depth_m = 9.0),
        ("room.height_m", |c| c.room.height_m = 4.0),
        ("kickback.thickness_m", |c| c.kickback.thickness_m = 0.1),
    ];
    let usual = agreed(&config(), "default", &glances(&config()));
    for (name, change) in changes {
        let mut changed = config();
        change(&mut changed);
        agreed(&changed, name, &glances(&changed));
        // And from where one looked before, if that still lies in the room: there the change has to show.
        let rear = changed.lane.deck_end_z_m - changed.pit.cushion_behind_deck_m;
        let (places, before): (Vec<_>, Vec<_>) = glances(&config())
            .into_iter()
            .zip(&usual)
            .filter(|((from, _), _)| from.z > rear)
            .unzip();
        let after = agreed(&changed, name, &places);
        let moved = after
            .iter()
            .zip(before)
            .any(|(a, b): (&f64, &f64)| (a - b).abs() > 0.01);
        // A kickback is drawn as the box that it is; its thickness only must not open a gap.
        let is_drawn_by_physics = name.starts_with("kickback");
        assert!(moved != is_drawn_by_physics, "{name}: moved {moved}");
    }
}

#[test]
fn gutters_follow_the_strips_that_collide() {
    for facets in [3, 5, 16] {
        let mut config = config();
        config.gutter.facets = facets;
        let plan = Plan::new(&config);
        let mesh = lane::gutters(&plan, &config);
        // The inner corner of the outermost strip, on the arc through both edges and the lowest point.
        let (w, d) = (config.gutter.width_m, config.gutter.depth_m);
        let radius = (w * w / 4.0 + d * d) / (2.0 * d);
        let x = w * (0.5 - 1.0 / f64::from(facets));
        let y = radius - d - libm::sqrt(radius * radius - x * x);
        let corner = DVec3::new(config.lane.width_m / 2.0 + w / 2.0 + x, y, 0.0).as_vec3();
        let near = |v: &mesh::Vertex| v.position.distance(corner) < 1e-5;
        assert!(
            mesh.vertices.iter().any(near),
            "{facets} strips: none at {corner}"
        );
    }
}

#[test]
fn boards_and_approach_act_on_the_picture() {
    let extent = |config: &Config, surface| {
        let meshes = meshes(config);
        let (_, mesh) = meshes.iter().find(|(s, _)| *s == surface).expect("drawn");
        let corners = mesh.vertices.iter().filter(|v| v.position.y == 0.0);
        let u = corners.clone().map(|v| v.uv.x).fold(0.0, f32::max);
        (u, corners.map(|v| v.position.z).fold(0.0, f32::max))
    };
    let mut changed = config();
    changed.lane.boards = 13;
    changed.room.approach_length_m = 3.0;
    assert!((extent(&config(), Surface::Lane).0 - 39.0).abs() < 1e-4);
    assert!((extent(&changed, Surface::Lane).0 - 13.0).abs() < 1e-4);
    let (u, z) = extent(&changed, Surface::Approach);
    let wide = extent(&config(), Surface::Approach).0;
    assert!((u - wide / 3.0).abs() < 1e-4, "{u}");
    assert_eq!(z, 3.0);
    // The floor begins where the approach ends, and is not drawn where there is none.
    changed.room.approach_length_m = changed.room.depth_m;
    changed.room.half_width_m = 1.0;
    assert!(meshes(&changed).iter().all(|(s, _)| *s != Surface::Floor));
}

#[test]
fn extreme_settings_give_meshes_that_can_be_drawn() {
    let mut config = config();
    config.lane.headpin_z_m = -3.0;
    config.lane.deck_end_z_m = -4.0;
    config.kickback.height_m = 2.0;
    config.kickback.thickness_m = 0.3;
    config.kickback.starts_before_headpin_m = 2.0;
    config.room.height_m = 2.0;
    config.room.half_width_m = 1.0;
    config.room.approach_length_m = 1.0;
    for (surface, mesh) in meshes(&config) {
        for corners in &mesh.triangles {
            let [a, b, c] = corners.map(|index| mesh.vertices[index as usize].position);
            let area = (b - a).cross(c - a).length();
            assert!(area.is_finite() && area > 0.0, "{surface:?}: {a} {b} {c}");
        }
    }
    let (_, markings) = &meshes(&config)[2];
    let beyond = |v: &mesh::Vertex| v.position.z < config.lane.deck_end_z_m as f32;
    assert!(!markings.vertices.iter().any(beyond), "painted on air");
}

#[test]
fn markings_lie_at_the_places_of_the_rule_book() {
    // USBC: board n from the right edge, arrows 12 ft 6 in to 15 ft 6 in past the foul line, as lane data has them [m].
    let published = [
        (0.40542, -3.8100),
        (0.27028, -4.1148),
        (0.13514, -4.4196),
        (0.0, -4.7244),
        (-0.13514, -4.4196),
        (-0.27028, -4.1148),
        (-0.40542, -3.8100),
        // Dots on boards 3 and 14, 7 feet past; on board 10, 3 inches and 12 feet before.
        (0.459479, -2.1336),
        (0.162169, -2.1336),
        (0.27028, 0.0762),
        (0.27028, 3.6576),
        // The 7 pin's spot.
        (-0.457200, -19.079894),
    ];
    let config = shipped();
    let plan = Plan::new(&config);
    let paint = markings::markings(&plan, &config);
    for (x, z) in published {
        let at = Vec3::new(x, DECAL, z);
        let nearest = paint.vertices.iter().map(|v| v.position.distance(at));
        let nearest = nearest.fold(f32::INFINITY, f32::min);
        assert!(nearest < 1e-4, "({x}, {z}) is {nearest} m from any paint");
    }
    let seven = config.markings.arrow_boards.len();
    assert_eq!((seven, config.lane.boards), (7, 39));
}

#[test]
fn neighbours_lie_beside_the_lane_and_overlap_nothing() {
    let config = shipped();
    let plan = Plan::new(&config);
    assert_eq!(plan.neighbours, [-3.6, -1.8, 1.8, 3.6]);
    let mut last = plan.edge;
    for (from, to) in plan.between_lanes() {
        assert!(from >= last && to > from, "{from} {to} after {last}");
        last = to + 2.0 * plan.edge;
    }
    let mut narrow = shipped();
    narrow.room.half_width_m = 2.5;
    assert!(neighbour_middles(&narrow).is_empty());
    let one = neighbour_meshes(&config);
    let widest = one.iter().flat_map(|(_, mesh)| &mesh.vertices);
    let widest = widest.map(|v| v.position.x.abs()).fold(0.0, f32::max);
    assert!(2.0 * widest < plan.pitch, "{widest}");
}

#[test]
fn house_balls_lie_on_their_rails_inside_the_room() {
    let config = shipped();
    let balls = house_balls(&config);
    assert_eq!(balls.len(), 15);
    for ball in &balls {
        assert!(ball.position.x + ball.radius < config.room.half_width_m as f32);
        let near = balls.iter().filter(|other| {
            let apart = other.position.distance(ball.position);
            apart > 0.0 && apart < 2.0 * ball.radius
        });
        assert_eq!(near.count(), 0);
    }
}
