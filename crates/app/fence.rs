//! A soft fence where the tracked space ends: posts and rails that grow and brighten as head or hands come near, and are not there
//! at all while nobody does.

use game::Game;
use glam::{DVec2, DVec3, Mat4, Quat, Vec3};
use physics::Pose;
use renderer::{Instance, Material};

use crate::convert::Stock;

/// Height of the fence, and of its rails [m].
const HEIGHT_M: f64 = 2.0;
const RAILS_M: [f64; 3] = [0.25, 1.0, 1.75];
/// Distance between posts, and how far along the edge the fence is seen [m].
const POSTS_M: f64 = 0.25;
const SEEN_ALONG_M: f64 = 1.0;
/// Half the thickness of a post at the edge itself [m].
const THICK_M: f64 = 0.006;

/// The tracked space: a rectangle on the floor.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Space {
    /// `tracking_from_space`: its middle, sides along x and z.
    pub pose: Pose,
    /// Width along x and depth along z [m].
    pub size_m: [f64; 2],
}

impl Space {
    /// The space of the settings, about the middle of tracking space; `None` where they have none.
    pub fn of_settings(size_m: [f64; 2]) -> Option<Self> {
        let has_end = size_m.iter().all(|side| *side > 0.0);
        has_end.then_some(Self {
            pose: Pose::IDENTITY,
            size_m,
        })
    }
}

/// A box of the fence: its middle and half extents in the space [m], and how bright it is, from 0 to 1.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Bar {
    middle: DVec3,
    half: DVec3,
    share: f64,
}

/// What is to be drawn of the fence: `others` are hands that the game does not have, world frame.
pub fn instances(
    game: &Game,
    space: Option<&Space>,
    others: &[DVec3],
    stock: &Stock,
) -> Vec<Instance> {
    let comfort = &game.config().comfort;
    let Some(space) = space.filter(|_| comfort.fence) else {
        return Vec::new();
    };
    let world_from_space = game.world_from_tracking() * space.pose;
    let space_from_world = world_from_space.inverse();
    let parts = [game.head_pose_world(), game.hand_pose_world()];
    let parts = parts.into_iter().flatten().map(|pose| pose.position);
    parts
        .chain(others.iter().copied())
        .flat_map(|part| {
            let part = space_from_world.transform_point(part);
            bars(space.size_m, part, comfort.fence_from_m)
        })
        .map(|bar| drawn(&bar, world_from_space, stock))
        .collect()
}

/// The bars that a head or hand at a place of the space calls up.
fn bars(size_m: [f64; 2], part: DVec3, from_m: f64) -> Vec<Bar> {
    let half = 0.5 * DVec2::from_array(size_m);
    let mut bars = Vec::new();
    // The edges at +x, -x, +z, -z: outward, and along.
    for (out, along, far, long) in [
        (DVec3::X, DVec3::Z, half.x, half.y),
        (DVec3::NEG_X, DVec3::Z, half.x, half.y),
        (DVec3::Z, DVec3::X, half.y, half.x),
        (DVec3::NEG_Z, DVec3::X, half.y, half.x),
    ] {
        let gap = far - part.dot(out);
        let near = 1.0 - (gap / from_m).clamp(0.0, 1.0);
        if near <= 0.0 {
            continue;
        }
        let here = part.dot(along);
        let first = ((here - SEEN_ALONG_M).max(-long) / POSTS_M).ceil() as i64;
        let last = ((here + SEEN_ALONG_M).min(long) / POSTS_M).floor() as i64;
        for post in first..=last {
            let at = post as f64 * POSTS_M;
            let share = near * (1.0 - (at - here).abs() / SEEN_ALONG_M).max(0.0);
            if share > 0.0 {
                post_and_rails(&mut bars, out * far + along * at, along, share);
            }
        }
    }
    bars
}

/// A post, and the rails for half the way to its neighbours.
fn post_and_rails(bars: &mut Vec<Bar>, foot: DVec3, along: DVec3, share: f64) {
    let thick = DVec3::splat(THICK_M * share);
    bars.push(Bar {
        middle: foot + DVec3::Y * (0.5 * HEIGHT_M),
        half: DVec3::new(thick.x, 0.5 * HEIGHT_M, thick.z),
        share,
    });
    for height in RAILS_M {
        bars.push(Bar {
            middle: foot + DVec3::Y * height,
            half: thick + along * (0.5 * POSTS_M),
            share,
        });
    }
}

fn drawn(bar: &Bar, world_from_space: Pose, stock: &Stock) -> Instance {
    let color = [0.15, 0.75, 0.95].map(|part| part * bar.share as f32);
    let rotation: Quat = world_from_space.rotation.as_quat().normalize();
    let middle: Vec3 = world_from_space.transform_point(bar.middle).as_vec3();
    Instance {
        mesh: stock.cuboid(),
        material: Material {
            casts_shadows: false,
            takes_shadows: false,
            ..Material::unlit(color)
        },
        world_from_mesh: Mat4::from_scale_rotation_translation(
            bar.half.as_vec3(),
            rotation,
            middle,
        ),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const SIZE: [f64; 2] = [3.0, 2.0];

    fn brightest(part: DVec3) -> f64 {
        let bars = bars(SIZE, part, 0.4);
        bars.iter().map(|bar| bar.share).fold(0.0, f64::max)
    }

    #[test]
    fn the_fence_is_there_within_its_distance_alone_and_grows_towards_the_edge() {
        assert!(bars(SIZE, DVec3::new(0.0, 1.6, 0.0), 0.4).is_empty());
        assert!(bars(SIZE, DVec3::new(1.09, 1.6, 0.0), 0.4).is_empty());
        let shares = [1.2, 1.3, 1.4, 1.5, 1.7].map(|x| brightest(DVec3::new(x, 1.6, 0.0)));
        let expected = [0.25, 0.5, 0.75, 1.0, 1.0];
        for (share, expected) in shares.into_iter().zip(expected) {
            assert!((share - expected).abs() < 1e-9, "{share} {expected}");
        }
        assert!(
            brightest(DVec3::new(0.0, 1.0, -0.9)) > 0.7,
            "the other edges too"
        );
    }

    #[test]
    fn posts_stand_on_the_edge_near_the_hand_that_comes_to_it() {
        let hand = DVec3::new(1.4, 1.1, 0.3);
        for bar in bars(SIZE, hand, 0.4) {
            assert!((bar.middle.x - 1.5).abs() < 1e-9, "{bar:?}");
            assert!((bar.middle.z - hand.z).abs() <= SEEN_ALONG_M, "{bar:?}");
            assert!(bar.middle.z.abs() <= 1.0, "not beyond the corner: {bar:?}");
        }
        // In a corner both edges are seen.
        let corner = bars(SIZE, DVec3::new(1.4, 1.1, 0.9), 0.4);
        assert!(corner.iter().any(|bar| (bar.middle.z - 1.0).abs() < 1e-9));
        assert!(corner.iter().any(|bar| (bar.middle.x - 1.5).abs() < 1e-9));
    }

    #[test]
    fn a_space_without_an_end_has_no_fence() {
        assert_eq!(Space::of_settings([0.0, 0.0]), None);
        assert_eq!(Space::of_settings([2.0, 0.0]), None);
        assert!(Space::of_settings([2.0, 3.0]).is_some());
    }
}
