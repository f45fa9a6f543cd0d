//! Whether a scene can be drawn with what the renderer holds.

use glam::Mat3;

use super::Renderer;
use crate::RenderError;
use crate::scene::{Instance, Lamp, MAX_LAMPS, MAX_OCCLUDERS, Scene, TextureId};

impl Renderer {
    /// One sentence on the first thing in it that cannot be drawn.
    pub(super) fn check_scene(&self, scene: &Scene) -> Result<(), RenderError> {
        let fail = |reason: String| Err(RenderError::Scene(reason));
        if scene.lamps.len() > MAX_LAMPS {
            let count = scene.lamps.len();
            return fail(format!(
                "it has {count} lamps, at most {MAX_LAMPS} are drawn"
            ));
        }
        let lamp_is_bad = |lamp: &Lamp| {
            !(lamp.position.is_finite() && lamp.range_m.is_finite() && lamp.range_m > 0.0)
        };
        if let Some(at) = scene.lamps.iter().position(lamp_is_bad) {
            return fail(format!("lamp {at} needs a position and a range above zero"));
        }
        let count = scene.occluders.len();
        if count > MAX_OCCLUDERS {
            return fail(format!(
                "it has {count} occluders, at most {MAX_OCCLUDERS} are drawn"
            ));
        }
        for (at, instance) in scene.instances.iter().enumerate() {
            if let Some(reason) = self.what_is_wrong(instance) {
                return fail(format!("instance {at} {reason}"));
            }
        }
        Ok(())
    }

    fn what_is_wrong(&self, instance: &Instance) -> Option<&'static str> {
        let material = &instance.material;
        let texture_is_known = |id: TextureId| (id.0 as usize) < self.textures.len();
        if instance.mesh.0 as usize >= self.meshes.len() {
            return Some("uses a mesh that is not this renderer's");
        }
        if !material.texture.is_none_or(texture_is_known) {
            return Some("uses a texture that is not this renderer's");
        }
        if !instance.world_from_mesh.is_finite() {
            return Some("has a transform that is not a number");
        }
        if Mat3::from_mat4(instance.world_from_mesh).determinant() <= 0.0 {
            return Some("has a transform that flattens or mirrors it");
        }
        None
    }
}
