//! Everything that is drawn, with its looks: files from `assets/`, and scenery from the settings.

mod looks;

use std::path::Path;

use anyhow::{Result, anyhow};
use game::{Config, Model, ShowsConfig};
use glam::{Affine3A, Mat4, Quat, Vec3};
use renderer::{
    Enclosure, Instance, Lamp, Light, Material, MeshId, RenderError, Renderer, RendererSettings,
    TextureId,
};

use super::board::{Board, Scores};
use super::hand::Hands;
use super::light::{lamps, light};
use super::screen::Screen;
use crate::again::Moment;
use crate::lettering::Scribe;
use crate::scenery::{self, Surface, mesh};
use crate::words::Words;
use looks::Looks;
pub(super) use looks::plain;

/// Balls of the rack in their order; later ones begin again.
pub(super) const BALL_TEXTURES: [&str; 4] =
    ["ball_blue", "ball_green", "ball_orange", "ball_violet"];

/// A mesh and its look.
#[derive(Debug, Clone, Copy)]
pub(super) struct Piece {
    pub mesh: MeshId,
    pub material: Material,
}

impl Piece {
    fn at(&self, world_from_mesh: Mat4) -> Instance {
        Instance {
            mesh: self.mesh,
            material: self.material,
            world_from_mesh,
        }
    }
}

/// Everything that is drawn, held by a renderer.
#[derive(Debug)]
pub struct Stock {
    /// What never moves, where it is.
    pub(super) scenery: Vec<Instance>,
    pub(super) rack_stand: RackStand,
    /// A pin, and the bands of one that has no texture.
    pub(super) pin: Vec<Piece>,
    pub(super) ball: MeshId,
    pub(super) balls: Vec<Material>,
    /// The holes of a ball that has no texture.
    pub(super) ball_holes: Option<Piece>,
    pub(super) hands: Hands,
    /// Round for Red, square for Blue: told apart without colours.
    pub(super) buttons: [Piece; 2],
    pub(super) cuboid: MeshId,
    pub(super) light: Option<Light>,
    pub(super) lamps: Vec<Lamp>,
    pub(super) enclosure: Option<Enclosure>,
    pub(super) shows: ShowsConfig,
    board: Option<Board>,
    screen: Option<Screen>,
}

/// The stand under the rack, which follows a rack that was raised or lowered to somebody's reach.
#[derive(Clone, Copy, Debug)]
pub(super) struct RackStand {
    /// Its place in the scenery.
    pub place: Option<usize>,
    /// Upper edge of the rack's rims, and height of the stand, as the settings have them [m].
    pub rims: f32,
    pub height: f32,
}

impl RackStand {
    fn of(config: &Config) -> Self {
        let rack = &config.rack;
        let is_stand = |(surface, _): &(Surface, mesh::Mesh)| *surface == Surface::RackStand;
        Self {
            place: scenery::meshes(config).iter().position(is_stand),
            rims: (rack.tray_height_m + rack.rim_height_m) as f32,
            height: (rack.tray_height_m - 0.04) as f32,
        }
    }
}

/// What a renderer has to be able to do for a scene.
pub fn settings(shows: &ShowsConfig) -> RendererSettings {
    RendererSettings {
        samples: if shows.smooth_edges { 4 } else { 1 },
        shadow_size: if shows.shadows { 2048 } else { 0 },
        reflection: shows.reflection,
        occlusion: shows.ambient_occlusion,
        filtered: shows.smooth_edges,
        flat: !shows.materials,
    }
}

impl Stock {
    /// Loads meshes and textures from `assets/` in `root`, and builds the scenery that `config` describes.
    ///
    /// # Errors
    /// A sentence with the file, and the line of a malformed mesh.
    pub fn load(renderer: &mut Renderer, root: &Path, config: &Config) -> Result<Self> {
        let shows = &config.shows;
        let gpu = renderer.gpu().clone();
        let board = shows
            .furnishings
            .then(|| Board::new(renderer, &gpu, Words::load(root, config)?))
            .transpose()?;
        let mut assets = Assets {
            renderer,
            root,
            shows,
        };
        let looks = Looks::load(&mut assets, board.as_ref().map(Board::texture))?;
        let pin = assets.pin(&looks)?;
        let ball = assets.ball()?;
        let balls = assets.balls()?;
        let mut scenery = assets.scenery(config, &looks)?;
        let neighbours = assets.neighbours(config, &looks, &pin, &mut scenery)?;
        let house = assets.house_balls(config, &balls)?;
        scenery.extend(neighbours.into_iter().chain(house));
        Ok(Stock {
            scenery,
            rack_stand: RackStand::of(config),
            pin,
            ball,
            balls,
            ball_holes: assets.ball_holes()?,
            hands: assets.hands(config)?,
            buttons: [
                assets.piece("button_round", plain([0.55, 0.02, 0.02], 0.3))?,
                assets.piece("button_square", plain([0.02, 0.06, 0.55], 0.3))?,
            ],
            cuboid: assets.mesh("box")?,
            // Faces of one colour need a light too, to be told apart.
            light: Some(light(config)),
            lamps: if shows.materials {
                lamps(config)
            } else {
                Vec::new()
            },
            enclosure: shows.ambient_occlusion.then(|| enclosure(config)),
            shows: shows.clone(),
            board,
            screen: None,
        })
    }

    /// Adds the screen on which a throw can be watched again, where the scene shows one; for pictures of the moment.
    ///
    /// # Errors
    /// As [`Stock::load`].
    pub fn add_screen(
        &mut self,
        renderer: &mut Renderer,
        root: &Path,
        config: &Config,
    ) -> Result<()> {
        let shows = &config.shows;
        // Without furnishings there is no screen.
        if shows.replay && shows.furnishings {
            self.screen = Some(Screen::new(renderer, root, config)?);
        }
        Ok(())
    }

    /// Shows a moment of the last throw on that screen, or nothing.
    ///
    /// # Errors
    /// When it cannot be drawn.
    pub fn show_again(&mut self, moment: Option<Moment>) -> Result<()> {
        match &mut self.screen {
            Some(screen) => screen.show(moment),
            None => Ok(()),
        }
    }

    /// The screen, while it shows something.
    pub(super) fn screen_instance(&self) -> Option<Instance> {
        self.screen.as_ref().and_then(Screen::instance)
    }

    /// Has the board painted by somebody else, for a frame that must not wait.
    pub fn paint_apart(&mut self, scribe: &Scribe) {
        if let Some(board) = &mut self.board {
            board.paint_apart(scribe);
        }
    }

    /// A box from -1 to 1 each way.
    pub(crate) fn cuboid(&self) -> MeshId {
        self.cuboid
    }

    /// Shows the scores on the board over the lane, where the scene has one.
    ///
    /// # Errors
    /// When the board cannot be painted.
    pub fn show_scores(&mut self, renderer: &mut Renderer, scores: &Scores) -> Result<()> {
        match &mut self.board {
            Some(board) => board.show(renderer, scores),
            None => Ok(()),
        }
    }
}

/// The inside of the hall.
fn enclosure(config: &Config) -> Enclosure {
    let side = config.room.half_width_m as f32;
    let rear = config.lane.headpin_z_m + config.kickback.starts_before_headpin_m + 0.25;
    Enclosure {
        min: Vec3::new(-side, 0.0, rear as f32),
        max: Vec3::new(
            side,
            config.room.height_m as f32,
            config.room.depth_m as f32,
        ),
        reach_m: 0.35,
    }
}

/// The folder of assets, on its way into a renderer.
pub(super) struct Assets<'a> {
    renderer: &'a mut Renderer,
    root: &'a Path,
    pub(super) shows: &'a ShowsConfig,
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

    pub(super) fn built(&mut self, mesh: &mesh::Mesh) -> Result<MeshId> {
        Ok(self.renderer.add_mesh(&mesh.to_data())?)
    }

    /// A pin; where faces have one colour its bands are meshes of their own.
    fn pin(&mut self, looks: &Looks) -> Result<Vec<Piece>> {
        let low = self.mesh("pin_low")?;
        let mut pieces = Vec::new();
        if self.shows.low_polygon {
            pieces.push(Piece {
                mesh: low,
                material: looks.pin,
            });
        } else {
            let pin = self.piece("pin", looks.pin)?;
            self.renderer.set_stand_in(pin.mesh, low)?;
            pieces.push(pin);
        }
        if !self.shows.materials {
            pieces.push(self.piece("pin_bands", plain([0.52, 0.01, 0.02], 0.4))?);
        }
        Ok(pieces)
    }

    /// A ball of radius 1.
    fn ball(&mut self) -> Result<MeshId> {
        let low = self.built(&mesh::sphere(1.0, 12, 8))?;
        if self.shows.low_polygon {
            return Ok(low);
        }
        let ball = self.mesh("ball")?;
        self.renderer.set_stand_in(ball, low)?;
        Ok(ball)
    }

    fn balls(&mut self) -> Result<Vec<Material>> {
        if !self.shows.materials {
            return Ok(looks::PLAIN_BALLS.map(|color| plain(color, 0.3)).to_vec());
        }
        let mut balls = Vec::new();
        for name in BALL_TEXTURES {
            balls.push(looks::ball(self.texture(name)?));
        }
        Ok(balls)
    }

    fn ball_holes(&mut self) -> Result<Option<Piece>> {
        if self.shows.materials {
            return Ok(None);
        }
        let dark = plain([0.01, 0.01, 0.01], 0.8);
        Ok(Some(self.piece("ball_holes", dark)?))
    }

    fn scenery(&mut self, config: &Config, looks: &Looks) -> Result<Vec<Instance>> {
        let mut scenery = Vec::new();
        for (surface, mesh) in scenery::meshes(config) {
            let piece = Piece {
                mesh: self.built(&mesh)?,
                material: looks.of(surface),
            };
            scenery.push(piece.at(Mat4::IDENTITY));
        }
        Ok(scenery)
    }

    /// The lanes beside, each a copy of one, with pins of few corners: none is nearer than two metres to one's own.
    fn neighbours(
        &mut self,
        config: &Config,
        looks: &Looks,
        pin: &[Piece],
        scenery: &mut Vec<Instance>,
    ) -> Result<Vec<Instance>> {
        let middles = scenery::neighbour_middles(config);
        if middles.is_empty() {
            return Ok(Vec::new());
        }
        for (surface, mesh) in scenery::neighbour_meshes(config) {
            let piece = Piece {
                mesh: self.built(&mesh)?,
                material: looks.of(surface),
            };
            let copies = middles.iter().map(|x| piece.at(moved(Vec3::X * *x)));
            scenery.extend(copies);
        }
        let low = Piece {
            mesh: self.mesh("pin_low")?,
            // Outside of the box in which shadows are cast.
            material: Material {
                casts_shadows: false,
                ..pin[0].material
            },
        };
        let spots = scenery::pin_spots(config);
        let pins = middles
            .iter()
            .flat_map(|x| spots.iter().map(|spot| *spot + Vec3::X * *x))
            .map(|spot| low.at(moved(spot)));
        Ok(pins.collect())
    }

    fn house_balls(&mut self, config: &Config, balls: &[Material]) -> Result<Vec<Instance>> {
        let house = scenery::house_balls(config);
        if house.is_empty() {
            return Ok(Vec::new());
        }
        let mesh = self.built(&mesh::sphere(1.0, 20, 12))?;
        let instance = |ball: &scenery::HouseBall| {
            let number = ball.number;
            let turn = Quat::from_rotation_y(1.7 * number as f32) * Quat::from_rotation_x(0.9);
            let place = Affine3A::from_scale_rotation_translation(
                Vec3::splat(ball.radius),
                turn,
                ball.position,
            );
            let material = balls[number % balls.len()];
            Piece { mesh, material }.at(Mat4::from(place))
        };
        Ok(house.iter().map(instance).collect())
    }
}

fn moved(by: Vec3) -> Mat4 {
    Mat4::from_translation(by)
}

/// The same remedy for whatever is wrong with an asset: all of them can be made anew.
fn unusable(error: &RenderError) -> anyhow::Error {
    anyhow!("{error}; write the file anew with `cargo run --bin make-assets`")
}

/// Look of what is drawn as the box that it is; `None` for what has a mesh of its own or is scenery.
pub(super) fn box_material(model: Model) -> Option<Material> {
    let mirrored = |material| Material {
        is_mirrored: true,
        ..material
    };
    // The machine hangs under the pins' own light: its shadow would lie on every rack.
    let machine = |color, roughness| Material {
        casts_shadows: false,
        ..mirrored(plain(color, roughness))
    };
    match model {
        Model::FoulLine => Some(Material::new([0.02, 0.02, 0.02])),
        Model::Kickback => Some(mirrored(looks::KICKBACK.material())),
        Model::Rack => Some(mirrored(looks::METAL.material())),
        Model::Desk => Some(plain([0.23, 0.13, 0.07], 0.4)),
        Model::SweepBar => Some(machine([0.035, 0.04, 0.055], 0.75)),
        Model::SettingTable => Some(machine([0.04, 0.04, 0.05], 0.6)),
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
