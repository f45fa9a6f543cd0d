//! Pictures of a game: a stereo contact sheet and a video of highlights, for both eyes.

pub mod album;
pub mod avi;
pub mod contact_sheet;
pub mod film;
pub mod highlights;
pub(crate) mod layout;

use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use anyhow::{Context, Result, bail};
use game::{Config, DisplayConfig, DisplayProfile, Visible};
use image::RgbaImage;
use renderer::{BackendChoice, Gpu, Renderer, TextBlock, TextPainter, View, relay};

use self::album::Album;
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
    /// How the scene sounds; `None` in one without sound.
    sound: Option<sound::Settings>,
    /// Middle of the pin deck in front, world frame.
    headpin_z: f64,
    /// Set from outside to stop drawing.
    stop: Arc<AtomicBool>,
}

/// The pixels that are drawn, and those of the display that they are relayed to, for a picture of `size`.
fn pixels(display: &DisplayProfile, size: (u32, u32)) -> ((u32, u32), (u32, u32)) {
    let own = (display.width_px, display.height_px);
    let relayed = (display.relayed_width_px, display.relayed_height_px);
    if own != relayed {
        return (own, relayed);
    }
    let seen = (size.0.min(own.0), size.1.min(own.1));
    (seen, seen)
}

impl Painter {
    /// Finds a graphics driver and loads what is drawn from `root`.
    ///
    /// # Errors
    /// When there is no driver or an asset is missing or malformed.
    pub fn new(root: &Path, config: &Config) -> Result<Self> {
        let gpu = Gpu::new(BackendChoice::Auto).context("cannot draw")?;
        let mut renderer =
            Renderer::new(&gpu, convert::settings(&config.shows)).context("cannot draw")?;
        let stock = Stock::load(&mut renderer, root, config)?;
        let text = TextPainter::new(&gpu);
        Ok(Painter {
            renderer,
            text,
            stock,
            display: config.display.clone(),
            sound: crate::sound::settings(config),
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
        let mut album = Album {
            painter: self,
            still,
            film,
            folder,
            progress,
        };
        let mut files = vec![contact_sheet::write(&mut album)?];
        if wanted.video {
            files.extend(highlights::write(&mut album)?);
        }
        Ok(files)
    }

    /// Both eyes of one snapshot, left first, each of `size` pixels, as the display shows them.
    ///
    /// A display that relays its image to fewer pixels is imitated step by step: drawn whole, relayed, then brought to
    /// `size`. Else the picture is drawn at `size`, or at the display's own where that is smaller: more pixels than the
    /// picture has would be thrown away again.
    ///
    /// # Errors
    /// When they cannot be drawn, or drawing was stopped.
    pub fn draw(
        &mut self,
        still: &[Visible],
        shot: &Shot,
        eyes: &[View; 2],
        size: (u32, u32),
    ) -> Result<[RgbaImage; 2]> {
        let (drawn, relayed) = pixels(self.display.current(), size);
        let images = self.images(still, shot, eyes, drawn)?;
        let shown = |image: &RgbaImage| relay(&relay(image, relayed.0, relayed.1), size.0, size.1);
        let images: Vec<RgbaImage> = images.iter().map(shown).collect();
        images
            .try_into()
            .map_err(|_| anyhow::anyhow!("the renderer drew another number of eyes than two"))
    }

    /// One eye's picture of `size` pixels, of no particular display.
    ///
    /// # Errors
    /// When it cannot be drawn, or drawing was stopped.
    pub fn one_eye(
        &mut self,
        still: &[Visible],
        shot: &Shot,
        view: View,
        size: (u32, u32),
    ) -> Result<RgbaImage> {
        let mut images = self.images(still, shot, &[view], size)?;
        images
            .pop()
            .context("the renderer drew no picture of a view")
    }

    /// The display that pictures are for.
    pub fn display(&self) -> &DisplayConfig {
        &self.display
    }

    /// How the scene sounds; `None` in one without sound.
    pub fn sound(&self) -> Option<sound::Settings> {
        self.sound
    }

    /// Middle of the pin deck in front, world frame [m].
    pub fn headpin_z(&self) -> f64 {
        self.headpin_z
    }

    fn images(
        &mut self,
        still: &[Visible],
        shot: &Shot,
        views: &[View],
        size: (u32, u32),
    ) -> Result<Vec<RgbaImage>> {
        if self.is_stopped() {
            bail!("the drawing was interrupted");
        }
        self.stock.show_scores(&mut self.renderer, &shot.scores)?;
        let visible = still.iter().chain(&shot.moving);
        let scene = convert::scene(visible, &self.stock, shot.hand);
        Ok(self.renderer.render(&scene, views, size.0, size.1)?)
    }

    /// Lines of text, each an image of its own.
    ///
    /// Painted together and cut apart, because painting takes long and the length of a text does not matter.
    pub(crate) fn captions(&mut self, lines: &[String]) -> Result<Vec<RgbaImage>> {
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
}

#[cfg(test)]
mod tests {
    use super::*;

    fn display(own: (u32, u32), relayed: (u32, u32)) -> DisplayProfile {
        DisplayProfile {
            outer_deg: 40.0,
            inner_deg: 40.0,
            up_deg: 20.0,
            down_deg: 20.0,
            width_px: own.0,
            height_px: own.1,
            relayed_width_px: relayed.0,
            relayed_height_px: relayed.1,
        }
    }

    #[test]
    fn pixels_of_a_relaying_display_are_its_own_whatever_the_picture() {
        let of_1996 = display((704, 480), (360, 240));
        assert_eq!(pixels(&of_1996, (300, 142)), ((704, 480), (360, 240)));
    }

    #[test]
    fn pixels_of_a_fine_display_are_the_pictures_and_of_a_coarse_one_its_own() {
        assert_eq!(
            pixels(&display((1440, 1440), (1440, 1440)), (160, 150)),
            ((160, 150), (160, 150))
        );
        assert_eq!(
            pixels(&display((64, 64), (64, 64)), (160, 150)),
            ((64, 64), (64, 64))
        );
    }
}
