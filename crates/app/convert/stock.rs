//! Everything that is drawn, with its looks: files from `assets/`, and scenery from the settings.

use std::path::Path;

use anyhow::{Result, anyhow};
use game::{Config, Model};
use renderer::{Lamp, Light, Material, MeshId, RenderError, Renderer, TextureId};

use super::light::{lamps, light};
use crate::scenery::{self, Surface};

/// Balls of the rack in their order; later ones begin again.
pub(super) const BALL_TEXTURES: [&str; 4] =
    ["ball_blue", "ball_green", "ball_orange", "ball_violet"];

/// A mesh and its look.
#[derive(Debug, Clone, Copy)]
pub(super) struct Piece {
    pub mesh: MeshId,
    pub material: Material,
}

/// Everything that is drawn, held by a renderer.
#[derive(Debug)]
pub struct Stock {
    /// Drawn where it was made, in the world frame.
    pub(super) scenery: Vec<Piece>,
    pub(super) pin: Piece,
    pub(super) ball: MeshId,
    pub(super) balls: Vec<Material>,
    pub(super) hand_open: Piece,
    pub(super) hand_closed: Piece,
    /// Round for Red, square for Blue: told apart without colours.
    pub(super) buttons: [Piece; 2],
    pub(super) cuboid: MeshId,
    pub(super) light: Light,
    pub(super) lamps: Vec<Lamp>,
}

impl Stock {
    /// Loads meshes and textures from `assets/` in `root`, and builds the scenery that `config` describes.
    ///
    /// # Errors
    /// A sentence with the file, and the line of a malformed mesh.
    pub fn load(renderer: &mut Renderer, root: &Path, config: &Config) -> Result<Self> {
        let mut assets = Assets { renderer, root };
        let boards = assets.texture("lane_boards")?;
        let approach = assets.texture("approach_boards")?;
        let mut scenery = Vec::new();
        for (surface, mesh) in scenery::meshes(config) {
            scenery.push(Piece {
                mesh: assets.renderer.add_mesh(&mesh.to_data())?,
                material: surface_material(surface, boards, approach),
            });
        }
        let mut balls = Vec::new();
        for name in BALL_TEXTURES {
            balls.push(textured(assets.texture(name)?, 1.0, 0.18));
        }
        let pin = textured(assets.texture("pin")?, 0.92, 0.25);
        let skin = plain([0.62, 0.40, 0.29], 0.6);
        Ok(Stock {
            scenery,
            pin: assets.piece("pin", pin)?,
            ball: assets.mesh("ball")?,
            balls,
            hand_open: assets.piece("hand_open", skin)?,
            hand_closed: assets.piece("hand_closed", skin)?,
            buttons: [
                assets.piece("button_round", plain([0.55, 0.02, 0.02], 0.3))?,
                assets.piece("button_square", plain([0.02, 0.06, 0.55], 0.3))?,
            ],
            cuboid: assets.mesh("box")?,
            light: light(config),
            lamps: lamps(config),
        })
    }
}

/// The folder of assets, on its way into a renderer.
struct Assets<'a> {
    renderer: &'a mut Renderer,
    root: &'a Path,
}

impl Assets<'_> {
    fn mesh(&mut self, name: &str) -> Result<MeshId> {
        let path = self.root.join(format!("assets/meshes/{name}.obj"));
        self.renderer
            .load_obj(&path)
            .map_err(|error| unusable(&error))
    }

    fn piece(&mut self, mesh: &str, material: Material) -> Result<Piece> {
        Ok(Piece {
            mesh: self.mesh(mesh)?,
            material,
        })
    }

    fn texture(&mut self, name: &str) -> Result<TextureId> {
        let path = self.root.join(format!("assets/textures/{name}.png"));
        self.renderer
            .load_texture(&path)
            .map_err(|error| unusable(&error))
    }
}

/// The same remedy for whatever is wrong with an asset: all of them can be made anew.
fn unusable(error: &RenderError) -> anyhow::Error {
    anyhow!("{error}; write the file anew with `cargo run --bin make-assets`")
}

fn plain(color: [f32; 3], roughness: f32) -> Material {
    Material {
        roughness,
        ..Material::new(color)
    }
}

/// A texture, dimmed to `brightness`.
fn textured(texture: TextureId, brightness: f32, roughness: f32) -> Material {
    Material {
        texture: Some(texture),
        ..plain([brightness; 3], roughness)
    }
}

/// Linear colours and roughness of the scenery.
fn surface_material(surface: Surface, boards: TextureId, approach: TextureId) -> Material {
    match surface {
        Surface::Lane => textured(boards, 0.95, 0.22),
        Surface::Approach => textured(approach, 0.95, 0.35),
        Surface::Markings => plain([0.05, 0.03, 0.02], 0.6),
        Surface::Gutters => plain([0.10, 0.10, 0.11], 0.45),
        Surface::Capping => plain([0.16, 0.12, 0.10], 0.6),
        Surface::Pit => plain([0.035, 0.035, 0.04], 0.9),
        Surface::Masking => plain([0.10, 0.13, 0.20], 0.7),
        Surface::Floor => plain([0.13, 0.12, 0.15], 0.85),
        Surface::Walls => plain([0.42, 0.38, 0.33], 0.9),
        Surface::Ceiling => plain([0.50, 0.49, 0.47], 0.95),
        Surface::Lamps => Material::unlit([1.0, 0.96, 0.88]),
        Surface::RackStand => plain([0.12, 0.12, 0.13], 0.5),
    }
}

/// Look of what is drawn as the box that it is; `None` for what has a mesh of its own or is scenery.
pub(super) fn box_material(model: Model) -> Option<Material> {
    match model {
        Model::FoulLine => Some(Material::new([0.02, 0.02, 0.02])),
        Model::Kickback => Some(Material::new([0.10, 0.09, 0.09])),
        Model::Rack => Some(plain([0.22, 0.22, 0.24], 0.4)),
        Model::Desk => Some(plain([0.30, 0.20, 0.12], 0.5)),
        Model::SweepBar => Some(plain([0.20, 0.21, 0.24], 0.4)),
        Model::Pin(_)
        | Model::Ball(_)
        | Model::Hand
        | Model::RedButton
        | Model::BlueButton
        | Model::Lane
        | Model::Approach
        | Model::Gutter
        | Model::Pit
        | Model::Cushion
        | Model::SideFloor
        | Model::Wall
        | Model::Ceiling => None,
    }
}
