//! The virtual hand, in the poses that it is drawn in: nothing else of a body is seen, as in 1997.

use glam::{Affine3A, Quat, Vec3};
use std::f32::consts::FRAC_PI_2;

use super::mesh::{Mesh, capsule, sphere};

/// How the fingers are bent [rad]: each joint of index, middle, ring and little finger against the part before it, then the
/// thumb's.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Fingers {
    /// Index, middle, ring, little finger.
    pub bends: [[f32; 3]; 4],
    /// Thumb.
    pub thumb: [f32; 3],
}

impl Fingers {
    /// As a tracker has them: of index, middle, ring and little finger, then of the thumb [rad].
    pub fn tracked(bends: &[[f64; 3]; 5]) -> Self {
        let [index, middle, ring, little, thumb] =
            bends.map(|finger| finger.map(|bend| bend as f32));
        Self {
            bends: [index, middle, ring, little],
            thumb,
        }
    }

    /// From open, 0, to closed as round a ball, 1.
    pub fn closing(closed: f32) -> Self {
        let curl = 0.55 * closed;
        let joint = 0.10 + 0.75 * curl;
        let finger = [0.12 + 0.4 * curl, joint, joint];
        let thumb = 0.5 * curl;
        Self {
            bends: [finger; 4],
            thumb: [
                0.12 + 0.25 * thumb,
                0.10 + 0.75 * thumb,
                0.10 + 0.75 * thumb,
            ],
        }
    }

    /// The index finger stretched, the others in the palm: what presses a button.
    pub fn pointing() -> Self {
        let bent = [1.15, 1.5, 0.9];
        Self {
            bends: [[0.05, 0.05, 0.05], bent, bent, bent],
            thumb: [0.5, 0.7, 0.5],
        }
    }

    /// On a ball under the palm: middle and ring finger and thumb in its holes, the others along it.
    pub fn gripping() -> Self {
        let along = [0.55, 0.5, 0.45];
        let into = [0.90, 0.50, 0.30];
        Self {
            bends: [along, into, into, along],
            thumb: [0.9, 0.5, 0.3],
        }
    }
}

/// Distance of the palm's middle from the surface that the palm lies on [m].
pub const PALM: f32 = 0.018;

/// Thickness of the palm over its width and length: half extents [m].
const PALM_HALF: Vec3 = Vec3::new(0.043, 0.016, 0.050);

/// Side offset [m], length [m] and thickness [m] of index, middle, ring and little finger.
const FINGERS: [(f32, f32, f32); 4] = [
    (-0.030, 0.072, 0.0095),
    (-0.010, 0.080, 0.0098),
    (0.011, 0.074, 0.0093),
    (0.030, 0.058, 0.0082),
];

/// A right hand about its palm: fingers along -z, palm down, thumb to the left; `round` segments go round a finger.
pub fn hand(fingers: &Fingers, round: u32) -> Mesh {
    let mut hand = palm(round);
    for bone in bones(fingers).as_flattened() {
        hand.append(&bone.mesh(round), bone.hand_from_bone);
    }
    hand
}

/// A hand without its fingers.
pub fn palm(round: u32) -> Mesh {
    let mut hand = Mesh::default();
    let palm = sphere(1.0, round + 6, round);
    hand.append(&palm, Affine3A::from_scale(PALM_HALF));
    let wrist = capsule(0.026, 0.03, round + 4);
    let along_z = Quat::from_rotation_x(FRAC_PI_2);
    hand.append(
        &wrist,
        Affine3A::from_rotation_translation(along_z, Vec3::new(0.0, 0.0, 0.065)),
    );
    hand
}

/// A part of a finger between two of its joints.
#[derive(Clone, Copy, Debug)]
pub struct Bone {
    /// Where it lies; its own y runs along it.
    pub hand_from_bone: Affine3A,
    /// Half its length [m].
    half: f32,
    /// [m]
    radius: f32,
}

impl Bone {
    /// Its shape, about its middle.
    pub fn mesh(&self, round: u32) -> Mesh {
        capsule(self.radius, self.half, round)
    }
}

/// From the palm outward: of index, middle, ring and little finger, then of the thumb.
pub fn bones(fingers: &Fingers) -> [[Bone; 3]; 5] {
    std::array::from_fn(|index| match FINGERS.get(index) {
        Some(&(side, length, radius)) => {
            let root = Vec3::new(side, 0.0, -0.044 + 6.0 * side * side);
            finger(root, 0.0, [length, radius], fingers.bends[index])
        }
        None => {
            let root = Vec3::new(-0.036, -0.004, 0.010);
            finger(root, 0.9, [0.052, 0.0105], fingers.thumb)
        }
    })
}

/// Three phalanges from `root`, turned by `yaw` outward and bent downward joint by joint.
fn finger(root: Vec3, yaw: f32, [length, radius]: [f32; 2], bends: [f32; 3]) -> [Bone; 3] {
    const SHARES: [f32; 3] = [0.45, 0.32, 0.23];
    let along_z = Quat::from_rotation_x(FRAC_PI_2);
    let mut joint = root;
    let mut bend = 0.0;
    std::array::from_fn(|index| {
        bend += bends[index];
        let turn = Quat::from_rotation_y(yaw) * Quat::from_rotation_x(-bend);
        let half = 0.5 * SHARES[index] * length;
        let middle = joint + turn * (Vec3::NEG_Z * half);
        joint += turn * (Vec3::NEG_Z * 2.0 * half);
        Bone {
            hand_from_bone: Affine3A::from_rotation_translation(turn * along_z, middle),
            half,
            radius,
        }
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Ends of index, middle, ring and little finger and of the thumb.
    fn tips(fingers: &Fingers) -> Vec<Vec3> {
        let mut tips = Vec::new();
        let all = FINGERS.iter().zip(fingers.bends);
        let thumb = (
            Vec3::new(-0.036, -0.004, 0.010),
            0.9_f32,
            0.052,
            fingers.thumb,
        );
        let roots = all.map(|((side, length, _), bends)| {
            let root = Vec3::new(*side, 0.0, -0.044 + 6.0 * side * side);
            (root, 0.0, *length, bends)
        });
        for (root, yaw, length, bends) in roots.chain([thumb]) {
            let (mut tip, mut bend) = (root, 0.0);
            for (share, more) in [0.45, 0.32, 0.23].into_iter().zip(bends) {
                bend += more;
                let turn = Quat::from_rotation_y(yaw) * Quat::from_rotation_x(-bend);
                tip += turn * (Vec3::NEG_Z * share * length);
            }
            tips.push(tip);
        }
        tips
    }

    #[test]
    fn a_gripping_hand_has_three_fingers_in_the_ball_and_two_on_it() {
        let radius = 0.1085;
        let centre = Vec3::new(0.0, -PALM - radius, 0.0);
        let tips = tips(&Fingers::gripping());
        let depth = |tip: &Vec3| radius - tip.distance(centre);
        let inside = [1, 2, 4].map(|finger| depth(&tips[finger]));
        assert!(inside.iter().all(|deep| *deep > 0.005), "{inside:?}");
        let outside = [0, 3].map(|finger| depth(&tips[finger]));
        assert!(outside.iter().all(|deep| *deep < 0.004), "{outside:?}");
        // Where they enter is where the game turns the holes to.
        let entry = |finger: usize| {
            let out = tips[finger] - centre;
            out / out.length()
        };
        let fingers = 0.5 * (entry(1) + entry(2));
        let holes = game::FINGERS_IN_HAND.as_vec3();
        assert!(fingers.distance(holes) < 0.2, "{fingers} {holes}");
        let thumb = game::THUMB_IN_HAND.as_vec3();
        assert!(entry(4).distance(thumb) < 0.2, "{} {thumb}", entry(4));
    }

    /// Counter-clockwise from outside as the normals have it, so that neither culling nor light is deceived.
    #[test]
    fn a_left_hand_is_a_right_one_in_a_mirror_with_its_outside_outside() {
        let right = hand(&Fingers::gripping(), 8);
        let left = right.mirrored();
        let mirror = Vec3::new(-1.0, 1.0, 1.0);
        assert_eq!(left.triangles.len(), right.triangles.len());
        for (l, r) in left.vertices.iter().zip(&right.vertices) {
            assert_eq!(l.position, mirror * r.position);
            assert!(l.normal.abs_diff_eq(mirror * r.normal, 1e-6));
        }
        for mesh in [&right, &left] {
            for triangle in &mesh.triangles {
                let [a, b, c] = triangle.map(|corner| mesh.vertices[corner as usize]);
                let wound = (b.position - a.position).cross(c.position - a.position);
                let outward = a.normal + b.normal + c.normal;
                // At a pole a triangle has no area.
                assert!(
                    wound.length() < 1e-9 || wound.dot(outward) > 0.0,
                    "{wound} {outward}"
                );
            }
        }
        let thumb_side = |mesh: &Mesh| mesh.vertices.iter().map(|v| v.position.x).sum::<f32>();
        assert!(thumb_side(&right) < 0.0 && thumb_side(&left) > 0.0);
    }

    #[test]
    fn a_closing_hand_comes_nearer_to_its_palm_without_a_leap() {
        let reach = |closed: f32| tips(&Fingers::closing(closed))[1].z;
        let mut last = reach(0.0);
        for step in 1..=10 {
            let now = reach(0.1 * step as f32);
            assert!(now > last && now - last < 0.006, "{step}: {last} {now}");
            last = now;
        }
        assert!(tips(&Fingers::pointing())[0].z < -0.11);
    }
}
