//! Pictures of a game: a stereo contact sheet and a video of highlights, for both eyes.

pub mod avi;
pub mod contact_sheet;
pub mod film;
pub mod highlights;
mod layout;

use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use anyhow::{Context, Result, bail};
use game::{Config, DisplayConfig, Visible};
use image::RgbaImage;
use renderer::{BackendChoice, Gpu, Renderer, RendererSettings, TextBlock, TextPainter, View};

use self::film::{Film, Shot};
use crate::convert::{self, Stock};
use crate::output::OutputFolder;

/// Lines of text painted into one image: well below the height that every driver holds.
const LINES_AT_ONCE: usize = 100;

/// Which pictures are made.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Wanted {
    /// The videos of highlights, beside the contact sheets.
    pub video: bool,
}

/// Draws snapshots for both eyes, without a window.
pub struct Painter {
    renderer: Renderer,
    text: TextPainter,
    stock: Stock,
    display: DisplayConfig,
    /// Middle of the pin deck in front, world frame.
    headpin_z: f64,
    /// Set from outside to stop drawing.
    stop: Arc<AtomicBool>,
}

impl Painter {
    /// Finds a graphics driver and loads what is drawn from `root`.
    ///
    /// # Errors
    /// When there is no driver or an asset is missing or malformed.
    pub fn new(root: &Path, config: &Config) -> Result<Self> {
        let gpu = Gpu::new(BackendChoice::Auto).context("cannot draw")?;
        let mut renderer =
            Renderer::new(&gpu, RendererSettings::default()).context("cannot draw")?;
        let stock = Stock::load(&mut renderer, root)?;
        let text = TextPainter::new(&gpu);
        Ok(Painter {
            renderer,
            text,
            stock,
            display: config.display.clone(),
            headpin_z: config.lane.headpin_z_m,
            stop: Arc::default(),
        })
    }

    /// The same painter, which stops between two pictures once `stop` is set.
    pub fn stopped_by(self, stop: Arc<AtomicBool>) -> Self {
        Painter { stop, ..self }
    }

    /// True when drawing was stopped from outside.
    pub fn is_stopped(&self) -> bool {
        self.stop.load(Ordering::Relaxed)
    }

    /// The contact sheet and, when wanted, the highlights of one game; returns their paths.
    ///
    /// # Errors
    /// When a picture cannot be drawn or written.
    pub fn paint(
        &mut self,
        still: &[Visible],
        film: &Film,
        folder: &OutputFolder,
        wanted: Wanted,
        progress: &mut dyn FnMut(&str),
    ) -> Result<Vec<PathBuf>> {
        let mut files = vec![contact_sheet::write(self, still, film, folder, progress)?];
        if wanted.video {
            files.extend(highlights::write(self, still, film, folder, progress)?);
        }
        Ok(files)
    }

    /// Both eyes of one snapshot, left first, each of `size` pixels.
    fn draw(
        &mut self,
        still: &[Visible],
        shot: &Shot,
        eyes: &[View; 2],
        size: (u32, u32),
    ) -> Result<[RgbaImage; 2]> {
        if self.is_stopped() {
            bail!("the drawing was interrupted");
        }
        let visible = still.iter().chain(&shot.moving);
        let scene = convert::scene(visible, &self.stock, shot.hand_is_closed);
        let images = self.renderer.render(&scene, eyes, size.0, size.1)?;
        images
            .try_into()
            .map_err(|_| anyhow::anyhow!("the renderer drew another number of eyes than two"))
    }

    /// Lines of text, each an image of its own.
    ///
    /// Painted together and cut apart, because painting takes long and the length of a text does not matter.
    fn captions(&mut self, lines: &[String]) -> Result<Vec<RgbaImage>> {
        let mut images = Vec::with_capacity(lines.len());
        for lines in lines.chunks(LINES_AT_ONCE) {
            let block = TextBlock {
                size_px: 13.0,
                background: [0; 4],
                padding_px: 0,
                ..TextBlock::new(lines.join("\n"))
            };
            let painted = self.text.block(&block)?;
            let count = lines.len() as u32;
            for line in 0..count {
                let top = painted.height() * line / count;
                let height = painted.height() / count;
                images.push(
                    image::imageops::crop_imm(&painted, 0, top, painted.width(), height).to_image(),
                );
            }
        }
        Ok(images)
    }

    /// The participant's eyes; a spectator's while the head is not tracked.
    fn own_eyes(&self, shot: &Shot) -> [View; 2] {
        match shot.head {
            Some(head) => convert::eyes(&head, &self.display),
            None => self.spectator_eyes(),
        }
    }

    /// A pair of eyes before the pin deck, as far apart as the participant's.
    fn spectator_eyes(&self) -> [View; 2] {
        convert::spectator_eyes(self.headpin_z, &self.display)
    }
}
