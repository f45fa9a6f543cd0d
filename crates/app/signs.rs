//! Short texts that hang in the room and face who reads them.

use std::collections::BTreeMap;

use anyhow::Result;
use glam::{DQuat, DVec3, Mat4, Quat, Vec3};
use physics::Pose;
use renderer::{Gpu, Instance, Material, MeshData, MeshId, Renderer, TextBlock, TextureId};

use crate::lettering::{Letters, Scribe};

/// Letters of a sign's picture [pixels]: twice what a headset of 25 pixels per degree shows of the largest.
const LETTER_PX: f32 = 48.0;

/// How a sign looks.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Ground {
    /// Something to read.
    Plain,
    /// Something that can be chosen.
    Button,
    /// What is about to be chosen.
    Chosen,
}

impl Ground {
    fn color(self) -> [u8; 4] {
        match self {
            Self::Plain => [24, 26, 32, 255],
            Self::Button => [58, 64, 78, 255],
            Self::Chosen => [40, 120, 90, 255],
        }
    }
}

/// A text in the room.
#[derive(Clone, Debug, PartialEq)]
pub struct Sign {
    /// What it says.
    pub text: String,
    /// Size of its letters [m].
    pub letter_m: f64,
    /// `world_from_sign`: its middle, facing +z.
    pub pose: Pose,
    /// How it looks.
    pub ground: Ground,
}

/// The pose of something at `position` whose +z faces `eye`.
pub fn facing(position: DVec3, eye: DVec3) -> Pose {
    let way = eye - position;
    let level = libm::hypot(way.x, way.z);
    let yaw = libm::atan2(way.x, way.z);
    let pitch = -libm::atan2(way.y, level);
    Pose {
        position,
        rotation: DQuat::from_rotation_y(yaw) * DQuat::from_rotation_x(pitch),
    }
}

/// What a sign's picture depends on.
type Face = (String, Ground);

/// Signs' pictures, held by a renderer; each text is painted once.
pub struct SignStock {
    letters: Letters<Face>,
    quad: MeshId,
    /// Pictures and their sizes in letters; `None` while one is being painted.
    pictures: BTreeMap<Face, Option<(TextureId, Vec3)>>,
}

impl SignStock {
    /// No sign yet.
    ///
    /// # Errors
    /// When the renderer takes no mesh.
    pub fn new(gpu: &Gpu, renderer: &mut Renderer) -> Result<Self> {
        Ok(Self {
            letters: Letters::here(gpu),
            quad: renderer.add_mesh(&MeshData::quad(1.0, 1.0))?,
            pictures: BTreeMap::new(),
        })
    }

    /// Has signs painted by somebody else: they appear when they are done.
    pub fn paint_apart(&mut self, scribe: &Scribe) {
        self.letters = Letters::apart(scribe);
    }

    /// What is to be drawn of `signs`.
    ///
    /// # Errors
    /// When a sign cannot be painted.
    pub fn instances(&mut self, signs: &[Sign], renderer: &mut Renderer) -> Result<Vec<Instance>> {
        for sign in signs {
            self.ask(sign)?;
        }
        while let Some((face, picture)) = self.letters.done()? {
            let [width, height] = picture.size().map(|side| side as f32);
            let size = Vec3::new(width, height, LETTER_PX) / LETTER_PX;
            let texture = renderer.add_picture(&picture)?;
            self.pictures.insert(face, Some((texture, size)));
        }
        Ok(signs
            .iter()
            .filter_map(|sign| self.instance(sign))
            .collect())
    }

    /// Has a sign's picture painted, once.
    fn ask(&mut self, sign: &Sign) -> Result<()> {
        let face = (sign.text.clone(), sign.ground);
        if self.pictures.contains_key(&face) {
            return Ok(());
        }
        self.pictures.insert(face.clone(), None);
        let block = TextBlock {
            size_px: LETTER_PX,
            padding_px: 18,
            background: sign.ground.color(),
            ..TextBlock::new(&sign.text)
        };
        self.letters.ask(face, move |painter| painter.block(&block))
    }

    fn instance(&self, sign: &Sign) -> Option<Instance> {
        let face = (sign.text.clone(), sign.ground);
        let (texture, per_letter) = (*self.pictures.get(&face)?)?;
        let pose = &sign.pose;
        let rotation: Quat = pose.rotation.as_quat().normalize();
        Some(Instance {
            mesh: self.quad,
            material: Material {
                texture: Some(texture),
                casts_shadows: false,
                takes_shadows: false,
                ..Material::unlit([1.0; 3])
            },
            world_from_mesh: Mat4::from_scale_rotation_translation(
                per_letter * sign.letter_m as f32,
                rotation,
                pose.position.as_vec3(),
            ),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_sign_faces_its_reader_upright() {
        let eye = DVec3::new(1.0, 1.7, 3.0);
        for position in [
            DVec3::ZERO,
            DVec3::new(2.0, 2.5, -1.0),
            DVec3::new(1.5, 1.7, 4.0),
        ] {
            let pose = facing(position, eye);
            let way = (eye - position).normalize_or_zero();
            assert!(
                (pose.rotation * DVec3::Z).distance(way) < 1e-12,
                "{position}"
            );
            assert!((pose.rotation * DVec3::X).y.abs() < 1e-12, "{position}");
        }
    }
}
