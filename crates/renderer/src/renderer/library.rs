//! The meshes and textures that a renderer holds.

use std::path::Path;

use image::RgbaImage;

use super::Renderer;
use crate::passes::GpuMesh;
use crate::scene::{Instance, MeshId, Scene, TextureId};
use crate::texture::{self, Picture, Texture};
use crate::{MeshData, RenderError};

impl Renderer {
    /// Takes a mesh.
    ///
    /// # Errors
    /// If it has no triangles, an index out of range, or a number that is none.
    pub fn add_mesh(&mut self, mesh: &MeshData) -> Result<MeshId, RenderError> {
        mesh.check()?;
        self.meshes.push(GpuMesh::new(&self.gpu.device, mesh));
        Ok(MeshId(self.meshes.len() as u32 - 1))
    }

    /// Draws `stand_in` for `mesh` in shadows and in the glossy floor, where both are blurred: fewer corners for the same sight.
    ///
    /// # Errors
    /// If one of them is not this renderer's.
    pub fn set_stand_in(&mut self, mesh: MeshId, stand_in: MeshId) -> Result<(), RenderError> {
        if [mesh, stand_in]
            .iter()
            .any(|id| id.0 as usize >= self.meshes.len())
        {
            return Err(RenderError::Mesh("it is not this renderer's".to_owned()));
        }
        self.meshes[mesh.0 as usize].stand_in = Some(stand_in);
        Ok(())
    }

    /// Triangles that one eye's picture of a scene has, in the lit pass; things that are not this renderer's count for none.
    pub fn triangles(&self, scene: &Scene) -> u64 {
        let of = |instance: &Instance| {
            self.meshes
                .get(instance.mesh.0 as usize)
                .map_or(0, |mesh| u64::from(mesh.triangles()))
        };
        scene.instances.iter().map(of).sum()
    }

    /// Takes a mesh from an OBJ file, as [`MeshData::load_obj`] reads it.
    ///
    /// # Errors
    /// One sentence with the file and, where one is to blame, the line.
    pub fn load_obj(&mut self, path: &Path) -> Result<MeshId, RenderError> {
        self.add_mesh(&MeshData::load_obj(path)?)
    }

    /// Takes a texture, sRGB, its first row uppermost.
    ///
    /// # Errors
    /// If a side is zero or larger than the device holds.
    pub fn add_texture(&mut self, image: &RgbaImage) -> Result<TextureId, RenderError> {
        self.add_picture(&image.clone().into())
    }

    /// Takes a texture whose smaller copies are made already.
    ///
    /// # Errors
    /// If a side is zero or larger than the device holds.
    pub fn add_picture(&mut self, picture: &Picture) -> Result<TextureId, RenderError> {
        let texture = self.upload(picture)?;
        Ok(self.take_texture(texture))
    }

    pub(crate) fn take_texture(&mut self, texture: Texture) -> TextureId {
        self.textures.push(texture);
        TextureId(self.textures.len() as u32 - 1)
    }

    /// Takes a texture from a PNG or JPEG file.
    ///
    /// # Errors
    /// One sentence with the file.
    pub fn load_texture(&mut self, path: &Path) -> Result<TextureId, RenderError> {
        self.add_texture(&texture::load_image(path)?)
    }

    /// Shows another image on a texture, for example a score board's; the size may differ.
    ///
    /// # Errors
    /// If the texture is not this renderer's, or the image cannot be taken.
    pub fn update_texture(&mut self, id: TextureId, image: &RgbaImage) -> Result<(), RenderError> {
        self.update_picture(id, &image.clone().into())
    }

    /// The same with a picture whose smaller copies are made already.
    ///
    /// # Errors
    /// If the texture is not this renderer's, or the picture cannot be taken.
    pub fn update_picture(&mut self, id: TextureId, picture: &Picture) -> Result<(), RenderError> {
        let index = id.0 as usize;
        match self.textures.get(index) {
            None => return Err(RenderError::Texture("it is not this renderer's".to_owned())),
            Some(texture) if texture.replace(&self.gpu, picture) => {}
            Some(_) => self.textures[index] = self.upload(picture)?,
        }
        Ok(())
    }

    fn upload(&self, picture: &Picture) -> Result<Texture, RenderError> {
        Texture::new(&self.gpu, &self.texture_layout, &self.sampler, picture)
    }
}
