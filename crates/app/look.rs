//! `bowling look`: a scene from six places for both eyes, and what its picture costs.

use std::path::Path;
use std::time::Instant;

use anyhow::{Context, Result};
use game::{Conditions, Config, DisplayConfig, Game, Model, Visible};
use glam::{DQuat, DVec3};
use image::{RgbaImage, imageops};
use physics::Pose;
use renderer::{BackendChoice, Fov, Gpu, Renderer, Scene, TextPainter, View};

use crate::args::LookArguments;
use crate::convert::{self, HandLook, HandShape, Stock};

/// Width and height at which times are taken [pixels]: the display of the experiment.
pub const TIMED_SIZE: [u32; 2] = [704, 480];
/// A time is the median of so many pictures.
const TIMED_PICTURES: usize = 5;
/// Vertical field of view of the sheet's pictures [rad].
const FIELD: f32 = 1.0;

/// A place to look from.
pub struct Place {
    /// What is seen from there, in a word or two.
    pub name: &'static str,
    /// Where the head is [m].
    pub from: DVec3,
    /// What it looks at [m].
    pub at: DVec3,
    /// Where a right hand is, and its shape.
    hand: (DVec3, HandShape),
}

/// The six places.
pub fn places(config: &Config) -> [Place; 6] {
    let deck = config.lane.headpin_z_m;
    let (rack, desk) = (&config.rack, &config.desk);
    let idle = (DVec3::new(0.35, 1.0, 3.6), HandShape::Closing(0.1));
    let button = DVec3::new(
        desk.x_m + 0.5 * desk.button_spacing_m,
        desk.height_m + 0.11,
        desk.z_m + 0.1,
    );
    let ball = DVec3::new(rack.x_m - 0.02, rack.tray_height_m + 0.25, rack.z_m + 0.26);
    let place = |name, from: [f64; 3], at: [f64; 3], hand| Place {
        name,
        from: DVec3::from_array(from),
        at: DVec3::from_array(at),
        hand,
    };
    [
        place("start", [0.0, 1.62, 4.4], [0.0, 0.9, -6.0], idle),
        place("foul line", [0.15, 1.55, 0.35], [0.0, 0.1, -9.0], idle),
        place(
            "pins",
            [0.35, 0.85, deck + 2.3],
            [0.0, 0.1, deck - 0.4],
            idle,
        ),
        place(
            "ball return",
            [0.45, 1.5, rack.z_m + 0.9],
            [rack.x_m, 0.75, rack.z_m],
            (ball, HandShape::Holding(Model::Ball(2))),
        ),
        place(
            "desk",
            [desk.x_m + 0.5, 1.55, desk.z_m + 0.75],
            [desk.x_m, 0.8, desk.z_m],
            (button, HandShape::Pointing),
        ),
        place("hall", [-0.4, 1.7, -5.5], [0.6, 0.9, 4.0], idle),
    ]
}

impl Place {
    /// The two eyes of a head here, left first, with square pixels.
    pub fn eyes(&self, display: &DisplayConfig, aspect: f32) -> [View; 2] {
        let fov = Fov::from_aspect(FIELD, aspect);
        let view = View::looking_at(self.from.as_vec3(), self.at.as_vec3(), fov);
        View::stereo(
            view.position,
            view.rotation,
            display.eye_distance_m as f32,
            fov,
        )
    }

    /// The room as it is at first, with the hand of this place.
    pub fn scene(&self, room: &[Visible], stock: &Stock) -> Scene {
        let (position, shape) = self.hand;
        let hand = Visible {
            model: Model::Hand,
            pose: Pose::new(position, DQuat::from_rotation_x(-0.35)),
            size: DVec3::ONE,
            is_highlighted: false,
        };
        let others = room.iter().filter(|thing| thing.model != Model::Hand);
        convert::scene(others.chain([&hand]), stock, HandLook::right(shape))
    }
}

/// A scene, ready to be drawn.
pub struct Stage {
    /// What draws it.
    pub renderer: Renderer,
    /// What it is made of.
    pub stock: Stock,
    /// Its things as they are at first.
    pub room: Vec<Visible>,
    /// The scene's own settings.
    pub config: Config,
}

impl Stage {
    /// Opens a scene on a device.
    ///
    /// # Errors
    /// When its settings or an asset cannot be used.
    pub fn open(gpu: &Gpu, root: &Path, scene: &str, settings: &[String]) -> Result<Self> {
        let conditions = Conditions::load(&root.join("config"), scene, settings)?;
        let config = conditions.lobby.clone();
        let mut renderer =
            Renderer::new(gpu, convert::settings(&config.shows)).context("cannot draw")?;
        let stock = Stock::load(&mut renderer, root, &config)?;
        let room = Game::new(conditions, game::MAX_FRAMES)?.visible();
        Ok(Self {
            renderer,
            stock,
            room,
            config,
        })
    }

    /// Time of a picture of both eyes from the start [s], after one that made the passes.
    ///
    /// # Errors
    /// When it cannot be drawn.
    pub fn seconds(&mut self) -> Result<f64> {
        let [width, height] = TIMED_SIZE;
        let place = &places(&self.config)[0];
        let eyes = place.eyes(&self.config.display, width as f32 / height as f32);
        let scene = place.scene(&self.room, &self.stock);
        let mut times = Vec::new();
        for _ in 0..=TIMED_PICTURES {
            let started = Instant::now();
            self.renderer.render(&scene, &eyes, width, height)?;
            times.push(started.elapsed().as_secs_f64());
        }
        times.remove(0);
        times.sort_by(f64::total_cmp);
        Ok(times[times.len() / 2])
    }

    /// Triangles of the picture from the start.
    pub fn triangles(&self) -> u64 {
        let place = &places(&self.config)[0];
        let scene = place.scene(&self.room, &self.stock);
        self.renderer.triangles(&scene)
    }
}

/// Draws the sheet and prints what a picture costs.
///
/// # Errors
/// When there is no driver, the scene cannot be used, or the sheet cannot be written.
pub fn look(arguments: &LookArguments, root: &Path) -> Result<()> {
    let gpu = Gpu::new(BackendChoice::Auto).context("cannot draw")?;
    let mut stage = Stage::open(&gpu, root, &arguments.scene, &arguments.settings)?;
    let sheet = sheet(&mut stage, &gpu, arguments.width)?;
    sheet
        .save(&arguments.out)
        .with_context(|| format!("{} cannot be written", arguments.out.display()))?;
    let [width, height] = TIMED_SIZE;
    let milliseconds = 1e3 * stage.seconds()?;
    println!("Scene {}: {} triangles", arguments.scene, stage.triangles());
    println!("Passes: {}", stage.renderer.passes().join(", "));
    println!("Both eyes, {width}x{height}: {milliseconds:.0} ms with {gpu}");
    println!("{}", arguments.out.display());
    Ok(())
}

/// A row for each two places, both eyes side by side with a caption.
fn sheet(stage: &mut Stage, gpu: &Gpu, width: u32) -> Result<RgbaImage> {
    let height = width * 3 / 4;
    let mut text = TextPainter::new(gpu);
    let mut pictures = Vec::new();
    for place in places(&stage.config) {
        let eyes = place.eyes(&stage.config.display, width as f32 / height as f32);
        let scene = place.scene(&stage.room, &stage.stock);
        let images = stage.renderer.render(&scene, &eyes, width, height)?;
        let caption = text.caption(&format!("{}: left and right eye", place.name), 2 * width)?;
        pictures.push((caption, images));
    }
    let row = height + pictures[0].0.height();
    let mut sheet = RgbaImage::new(4 * width, 3 * row);
    for (index, (caption, images)) in (0..).zip(&pictures) {
        let (left, top) = (
            i64::from(2 * width * (index % 2)),
            i64::from(row * (index / 2)),
        );
        for (eye, image) in (0..).zip(images) {
            imageops::replace(&mut sheet, image, left + i64::from(width * eye), top);
        }
        imageops::replace(&mut sheet, caption, left, top + i64::from(height));
    }
    Ok(sheet)
}
