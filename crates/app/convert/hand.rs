//! The participant's hand in its shape.

use anyhow::Result;
use game::{Config, Visible, hand_on_ball};
use glam::{Affine3A, Mat4, Vec3};
use physics::Pose;
use renderer::{Instance, Material, MeshId};

use super::stock::{Assets, plain};
use super::{HandLook, HandShape, Stock, world_from};
use crate::scenery::hand::{self, Fingers, PALM, bones, hand};
use crate::scenery::mesh::Mesh;

/// Steps in which a hand is drawn from open to closed: finer than a finger moves between two pictures.
const CLOSING_STEPS: usize = 8;

/// The hand in its poses.
#[derive(Debug)]
pub(super) struct Hands {
    pub right: Poses,
    pub left: Poses,
    /// A hand without fingers, and the phalanges of those that are bent one by one: the same on either side.
    pub palm: MeshId,
    pub phalanges: [[MeshId; 3]; 5],
    pub skin: Material,
}

/// The poses of one of the two hands.
#[derive(Debug)]
pub(super) struct Poses {
    /// From open to closed.
    pub closing: Vec<MeshId>,
    pub pointing: MeshId,
    pub gripping: MeshId,
}

impl Assets<'_> {
    /// A hand whose throws are helped has another colour, where it is seen beside no board that says so.
    pub(super) fn hands(&mut self, config: &Config) -> Result<Hands> {
        let round = if self.shows.low_polygon { 4 } else { 8 };
        let right = self.poses(|fingers| hand(fingers, round))?;
        let left = self.poses(|fingers| hand(fingers, round).mirrored())?;
        let palm = self.built(&hand::palm(round))?;
        let mut phalanges = [[palm; 3]; 5];
        let bones = bones(&Fingers::closing(0.0));
        for (mesh, bone) in phalanges
            .as_flattened_mut()
            .iter_mut()
            .zip(bones.as_flattened())
        {
            *mesh = self.built(&bone.mesh(round))?;
        }
        Ok(Hands {
            right,
            left,
            palm,
            phalanges,
            skin: match config.release.assist_share > 0.0 {
                true => plain([0.20, 0.50, 0.32], 0.6),
                false => plain([0.62, 0.40, 0.29], 0.6),
            },
        })
    }

    /// Every pose, of a hand that is made so for its fingers.
    fn poses(&mut self, made: impl Fn(&Fingers) -> Mesh) -> Result<Poses> {
        let mut closing = Vec::new();
        for step in 0..=CLOSING_STEPS {
            let closed = step as f32 / CLOSING_STEPS as f32;
            closing.push(self.built(&made(&Fingers::closing(closed)))?);
        }
        Ok(Poses {
            closing,
            pointing: self.built(&made(&Fingers::pointing()))?,
            gripping: self.built(&made(&Fingers::gripping()))?,
        })
    }
}

/// A hand at a share of its size, from 0 to 1; where it holds nothing, its place is its own.
pub fn shrunk_hand(hand: &Visible, stock: &Stock, look: HandLook, share: f64) -> Vec<Instance> {
    let mut parts = instances(hand, &[], stock, look);
    let middle = world_from(&hand.pose, Vec3::ONE);
    let shrink = middle * Mat4::from_scale(Vec3::splat(share as f32)) * middle.inverse();
    for part in &mut parts {
        part.world_from_mesh = shrink * part.world_from_mesh;
    }
    parts
}

/// A hand that holds a ball lies on it, whatever place within reach it took it from.
pub(super) fn instances(
    thing: &Visible,
    all: &[Visible],
    stock: &Stock,
    HandLook { shape, is_left }: HandLook,
) -> Vec<Instance> {
    let ball = shape
        .held_ball()
        .and_then(|model| all.iter().find(|other| other.model == model));
    let hands = &stock.hands;
    let poses = if is_left { &hands.left } else { &hands.right };
    let whole = |mesh, pose: Pose| vec![hands.part(mesh, world_from(&pose, Vec3::ONE))];
    match (shape, ball) {
        (_, Some(ball)) => {
            let (centre, radius) = (ball.pose.position, 0.5 * ball.size.x);
            let pose = hand_on_ball(&thing.pose, centre, radius, f64::from(PALM));
            whole(poses.gripping, pose)
        }
        (HandShape::Pointing, None) => whole(poses.pointing, thing.pose),
        (HandShape::Closing(closed), None) => whole(poses.closed(closed), thing.pose),
        (HandShape::Holding(_), None) => whole(poses.closed(1.0), thing.pose),
        (HandShape::Bent(fingers), None) => bent(thing, hands, &fingers, is_left),
    }
}

/// Palm and phalanges one by one, as the fingers are bent.
fn bent(thing: &Visible, hands: &Hands, fingers: &Fingers, is_left: bool) -> Vec<Instance> {
    let world_from_hand = world_from(&thing.pose, Vec3::ONE);
    let mut parts = vec![hands.part(hands.palm, world_from_hand)];
    let meshes = hands.phalanges.as_flattened();
    for (bone, mesh) in bones(fingers).as_flattened().iter().zip(meshes) {
        let hand_from_bone = match is_left {
            true => mirrored(bone.hand_from_bone),
            false => bone.hand_from_bone,
        };
        parts.push(hands.part(*mesh, world_from_hand * Mat4::from(hand_from_bone)));
    }
    parts
}

/// A left hand's bone from a right hand's. A bone is the same on both its sides, so that no triangle is turned inside out.
fn mirrored(hand_from_bone: Affine3A) -> Affine3A {
    let mirror = Affine3A::from_scale(Vec3::new(-1.0, 1.0, 1.0));
    mirror * hand_from_bone * mirror
}

impl Hands {
    fn part(&self, mesh: MeshId, world_from_mesh: Mat4) -> Instance {
        Instance {
            mesh,
            material: self.skin,
            world_from_mesh,
        }
    }
}

impl Poses {
    /// From open, 0, to closed, 1.
    fn closed(&self, closed: f64) -> MeshId {
        let last = self.closing.len() - 1;
        self.closing[(closed.clamp(0.0, 1.0) * last as f64).round() as usize]
    }
}

#[cfg(test)]
mod tests {
    use super::super::tests::{stock, visible};
    use super::*;
    use crate::convert;
    use game::Model;
    use glam::DVec3;

    #[test]
    fn a_hand_that_holds_a_ball_lies_on_it() {
        let stock = stock();
        let hand = visible(Model::Hand, DVec3::ONE);
        let mut ball = visible(Model::Ball(1), DVec3::splat(0.217));
        ball.pose.position -= DVec3::new(0.0, 0.2, 0.0);
        let shape = HandShape::Holding(Model::Ball(1));
        for (look, mesh) in [
            (HandLook::right(shape), stock.hands.right.gripping),
            (HandLook::left(shape), stock.hands.left.gripping),
        ] {
            let scene = convert::scene(&[hand, ball], &stock, look);
            let drawn = &scene.instances[stock.scenery.len()];
            assert_eq!(drawn.mesh, mesh);
            let palm = drawn.world_from_mesh.transform_point3(Vec3::ZERO);
            let away = palm.distance(ball.pose.position.as_vec3());
            assert!((away - 0.1085 - PALM).abs() < 1e-5, "{away}");
        }
    }

    #[test]
    fn a_left_hand_is_drawn_as_one_in_every_shape() {
        let stock = stock();
        let hand = visible(Model::Hand, DVec3::ONE);
        let drawn = |look| {
            let parts = instances(&hand, &[], &stock, look);
            assert_eq!(parts.len(), 1);
            // Never by a mirroring instance, which would turn the mesh inside out.
            assert!(parts[0].world_from_mesh.determinant() > 0.0);
            parts[0].mesh
        };
        let mut seen = Vec::new();
        for shape in [
            HandShape::Closing(0.0),
            HandShape::Closing(1.0),
            HandShape::Pointing,
        ] {
            seen.extend([drawn(HandLook::right(shape)), drawn(HandLook::left(shape))]);
        }
        let Hands { right, left, .. } = &stock.hands;
        let of = |poses: &Poses| [poses.closed(0.0), poses.closed(1.0), poses.pointing];
        let expected: Vec<MeshId> = of(right)
            .into_iter()
            .zip(of(left))
            .flat_map(|(r, l)| [r, l])
            .collect();
        assert_eq!(seen, expected);
        seen.sort_unstable();
        seen.dedup();
        assert_eq!(seen.len(), 6, "all of them differ");
    }

    #[test]
    fn fingers_that_are_tracked_are_bent_as_they_are_on_either_hand() {
        let stock = stock();
        let hand = visible(Model::Hand, DVec3::ONE);
        let ends = |bend: f64, is_left| {
            let mut bends = [[0.0; 3]; 5];
            bends[0] = [bend; 3];
            let fingers = Fingers::tracked(&bends);
            let shape = HandShape::Bent(fingers);
            let parts = instances(&hand, &[], &stock, HandLook { shape, is_left });
            assert_eq!(parts.len(), 16, "a palm and three phalanges a finger");
            let middle = |part: &Instance| {
                part.world_from_mesh.transform_point3(Vec3::ZERO) - hand.pose.position.as_vec3()
            };
            // Last of the index finger, last of the thumb.
            [middle(&parts[3]), middle(&parts[15])]
        };
        let [straight, thumb] = ends(0.0, false);
        let [curled, same] = ends(1.0, false);
        assert!(curled.y < straight.y - 0.02 && curled.z > straight.z + 0.02);
        assert_eq!(thumb, same);
        assert!(thumb.x < -0.04, "a right hand's thumb is at its left");
        let mirror = Vec3::new(-1.0, 1.0, 1.0);
        for (left, right) in ends(0.7, true).iter().zip(ends(0.7, false)) {
            assert!(left.abs_diff_eq(right * mirror, 1e-6), "{left} {right}");
        }
    }

    #[test]
    fn a_hand_shrinks_about_its_middle() {
        let stock = stock();
        let hand = visible(Model::Hand, DVec3::ONE);
        let fingers = Fingers::closing(0.2);
        let shape = HandLook::right(HandShape::Bent(fingers));
        let whole = instances(&hand, &[], &stock, shape);
        let middle = hand.pose.position.as_vec3();
        for (small, whole) in shrunk_hand(&hand, &stock, shape, 0.25).iter().zip(&whole) {
            let from = |part: &Instance| part.world_from_mesh.transform_point3(Vec3::X) - middle;
            assert!(from(small).abs_diff_eq(0.25 * from(whole), 1e-5));
        }
    }
}
