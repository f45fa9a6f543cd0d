//! The conditions side by side at the same instants: a sheet, and a video.

use std::io::Cursor;

use anyhow::{Context, Result};
use game::Visible;
use glam::{DVec3, Vec3};
use image::{DynamicImage, ImageFormat, RgbaImage};
use renderer::{Fov, View};

use super::course::Course;
use super::table::{Comparison, shape};
use crate::convert;
use crate::output::{Draft, OutputFolder};
use crate::pictures::Painter;
use crate::pictures::avi::AviWriter;
use crate::pictures::film::{SHOTS_PER_SECOND, Shot};
use crate::pictures::layout::{paper, place};

/// Between pictures [pixels].
const GAP: u32 = 4;
/// Height of a line of text [pixels].
const TEXT: u32 = 20;
/// Width of the names of the instants, left of their row [pixels].
const MARGIN: u32 = 96;
/// Width of a picture of the video [pixels], four beside each other.
const VIDEO_TILE: u32 = 240;
const VIDEO_ACROSS: usize = 4;
/// A longer video shows little but pins that lie [s].
const LONGEST_S: f64 = 8.0;
/// Vertical field of view [rad]: a ball on the lane fills some pixels of a small picture, and the pins fit in.
const EYE_FOV: f32 = 0.62;
const DECK_FOV: f32 = 0.85;
/// The view changes from the participant's eye to the pins so long before the first ball meets one [s].
const BEFORE_HIT: f64 = 0.3;

/// Draws the conditions of a comparison.
pub struct Gallery<'a> {
    /// Draws.
    pub painter: &'a mut Painter,
    /// What never moves.
    pub still: &'a [Visible],
    /// What is shown.
    pub comparison: &'a Comparison<'a>,
    /// Told how far the work is.
    pub progress: &'a mut dyn FnMut(&str),
}

impl Gallery<'_> {
    fn base(&self) -> &Course {
        &self.comparison.courses[self.comparison.base]
    }

    /// When the first ball of all meets a pin [s].
    fn first_hit(&self) -> Option<f64> {
        let hits = self
            .comparison
            .courses
            .iter()
            .filter_map(|course| course.first_hit);
        hits.map(|hit| hit.time).min_by(f64::total_cmp)
    }

    /// Whether a time is seen from beside the pins.
    fn is_at_pins(&self, time: f64) -> bool {
        self.first_hit().is_some_and(|hit| time > hit - BEFORE_HIT)
    }

    /// The ball on its way, the first ball at the pins, the base's there, both a little later, and the end; spread over
    /// the time where no pin is met.
    pub fn instants(&self) -> Vec<f64> {
        let end = self.base().duration();
        let Some(first) = self.first_hit() else {
            return [0.1, 0.3, 0.6, 1.0].map(|share| share * end).to_vec();
        };
        let base = self.base().first_hit.map_or(first, |hit| hit.time);
        let mut instants = vec![0.25 * first, first + 0.05, base + 0.05, base + 0.4, end];
        instants.retain(|time| *time <= end);
        instants.dedup_by(|a, b| *a - *b < 0.05);
        instants
    }

    /// Where a time is seen from: the participant's eye that follows the base's ball, or beside the deck.
    fn view(&self, time: f64, aspect: f32) -> View {
        let painter = &self.painter;
        if self.is_at_pins(time) {
            let [left, _] = convert::spectator_eyes(painter.headpin_z(), painter.display());
            let fov = Fov::from_aspect(DECK_FOV, aspect);
            return View { fov, ..left };
        }
        let eye = self.comparison.thrown.head(time).position;
        let ball = self.base().ball_at(time);
        // A ball below the eyes is looked at a little ahead of itself, where the others may be.
        let target = ball + DVec3::NEG_Z * 0.1 * (ball - eye).length();
        let (eye, target): (Vec3, Vec3) = (eye.as_vec3(), target.as_vec3());
        View::looking_at(eye, target, Fov::from_aspect(EYE_FOV, aspect))
    }

    fn tile(&mut self, index: usize, time: f64, size: (u32, u32)) -> Result<RgbaImage> {
        let view = self.view(time, size.0 as f32 / size.1 as f32);
        let shot = Shot {
            time,
            head: None,
            moving: self.comparison.courses[index].picture(time).to_vec(),
            hand: convert::HandLook::right(convert::HandShape::Closing(0.0)),
            scores: std::sync::Arc::new(convert::Scores::empty(game::MAX_FRAMES)),
        };
        self.painter.one_eye(self.still, &shot, view, size)
    }

    /// The sheet as PNG: a column for each condition, a row for each instant.
    ///
    /// # Errors
    /// When a picture cannot be drawn.
    pub fn sheet(&mut self, instants: &[f64], width: u32) -> Result<Vec<u8>> {
        let size = (width, width * 3 / 4);
        let conditions = self.comparison.conditions.len();
        let (across, down) = (size.0 + GAP, size.1 + GAP);
        let top = 3 * TEXT + GAP;
        let mut sheet = paper(
            MARGIN + conditions as u32 * across,
            top + instants.len() as u32 * down,
        );
        let mut lines = vec![self.title()];
        for index in 0..conditions {
            lines.extend(self.heading(index));
        }
        for time in instants {
            let place = if self.is_at_pins(*time) {
                "beside the pins"
            } else {
                "own eye"
            };
            lines.extend([format!("{time:.2} s"), place.to_owned()]);
        }
        let captions = self.painter.captions(&lines)?;
        let (title, rest) = captions.split_first().expect("the title is the first");
        place(&mut sheet, title, GAP, 2);
        let (headings, sides) = rest.split_at(2 * conditions);
        for (index, heading) in headings.chunks_exact(2).enumerate() {
            let left = MARGIN + index as u32 * across;
            place(&mut sheet, &fitting(&heading[0], size.0), left, TEXT + 2);
            place(&mut sheet, &fitting(&heading[1], size.0), left, 2 * TEXT);
        }
        for (row, (time, side)) in instants.iter().zip(sides.chunks_exact(2)).enumerate() {
            (self.progress)(&format!(
                "contact sheet: row {} of {}",
                row + 1,
                instants.len()
            ));
            let y = top + row as u32 * down;
            place(&mut sheet, &side[0], GAP, y);
            place(&mut sheet, &side[1], GAP, y + TEXT);
            for index in 0..conditions {
                let picture = self.tile(index, *time, size)?;
                place(&mut sheet, &picture, MARGIN + index as u32 * across, y);
            }
        }
        let mut png = Cursor::new(Vec::new());
        sheet
            .write_to(&mut png, ImageFormat::Png)
            .context("cannot encode the contact sheet")?;
        Ok(png.into_inner())
    }

    /// The video from the release to the end, four conditions beside each other.
    ///
    /// # Errors
    /// When a picture cannot be drawn or the file not be written.
    pub fn video(&mut self, folder: &OutputFolder, name: &str) -> Result<Draft> {
        let size = (VIDEO_TILE, VIDEO_TILE * 3 / 4);
        let count = self.comparison.conditions.len();
        let across = count.min(VIDEO_ACROSS) as u32;
        let down = (count as u32).div_ceil(across);
        let (width, height) = (across * size.0, down * (size.1 + TEXT) + TEXT);
        let frames = (self.base().duration().min(LONGEST_S) * f64::from(SHOTS_PER_SECOND)) as u32;
        let times = (0..=frames).map(|frame| f64::from(frame) / f64::from(SHOTS_PER_SECOND));
        let mut lines: Vec<String> = (0..count).map(|i| self.heading(i)[0].clone()).collect();
        lines.extend(times.clone().map(|time| self.place(time)));
        let captions = self.painter.captions(&lines)?;
        let (headings, instants) = captions.split_at(count);
        let draft = folder.draft(name)?;
        let mut video =
            AviWriter::new(draft, (width, height), SHOTS_PER_SECOND, None).context(UNWRITTEN)?;
        for ((frame, time), instant) in (0..=frames).zip(times).zip(instants) {
            if frame.is_multiple_of(SHOTS_PER_SECOND) {
                (self.progress)(&format!("video: picture {frame} of {frames}"));
            }
            let mut page = paper(width, height);
            place(&mut page, instant, GAP, height - TEXT + 2);
            for (index, heading) in headings.iter().enumerate() {
                let (column, row) = (index as u32 % across, index as u32 / across);
                let (x, y) = (column * size.0, row * (size.1 + TEXT));
                place(&mut page, &fitting(heading, size.0), x + GAP, y + 2);
                let picture = self.tile(index, time, size)?;
                place(&mut page, &picture, x, y + TEXT);
            }
            let page = DynamicImage::ImageRgba8(page).to_rgb8();
            video.push(&page).context(UNWRITTEN)?;
        }
        video.finish().context(UNWRITTEN)
    }

    /// An instant and where it is seen from, in words.
    fn place(&self, time: f64) -> String {
        let from = match self.is_at_pins(time) {
            true => "beside the pins",
            false => "own eye",
        };
        format!("{time:.2} s  {from}")
    }

    fn title(&self) -> String {
        let Comparison {
            thrown,
            conditions,
            base,
            ..
        } = self.comparison;
        format!(
            "{}. The same release under {} conditions; base {}.",
            thrown.name,
            conditions.len(),
            conditions[*base].name
        )
    }

    /// Two lines above a column: the condition, and what came of it.
    fn heading(&self, index: usize) -> [String; 2] {
        let condition = &self.comparison.conditions[index];
        let course = &self.comparison.courses[index];
        let objects = &condition.config.objects;
        let setting = format!(
            "{}  e {}  f {}  {}",
            condition.name,
            objects.elasticity,
            objects.friction_rate,
            shape(&condition.config)
        );
        let pins = course.fallen.len();
        let seen = self.comparison.divergence(index).seen;
        let parts = match seen {
            _ if index == self.comparison.base => "base".to_owned(),
            Some(time) => format!("5 deg at {time:.2} s"),
            None => "never 5 deg".to_owned(),
        };
        [
            setting,
            format!("{pins} {}, {parts}", if pins == 1 { "pin" } else { "pins" }),
        ]
    }
}

const UNWRITTEN: &str = "cannot write the video: is the disk full?";

/// A caption, cut where its column ends.
fn fitting(caption: &RgbaImage, width: u32) -> RgbaImage {
    let width = caption.width().min(width);
    image::imageops::crop_imm(caption, 0, 0, width, caption.height()).to_image()
}
