//! The panel's picture.

use anyhow::{Context, Result};
use experiment::questionnaire::{Answer, Item, Kind};
use renderer::{RenderError, RgbaImage, TextPainter, egui};

use super::layout::{Area, Choice, Content, Layout, SIZE_PX};
use crate::words::{PanelWords, StopWords, fill};

const GROUND: [u8; 4] = [24, 26, 32, 255];
const LETTERS: egui::Color32 = egui::Color32::from_rgb(240, 236, 228);
const BOX: egui::Color32 = egui::Color32::from_rgb(58, 64, 78);
/// What was chosen before.
const CHOSEN: egui::Color32 = egui::Color32::from_rgb(40, 120, 90);
const STOP: egui::Color32 = egui::Color32::from_rgb(120, 44, 40);
/// Letters of the question, the answers and the small print [pixels].
pub(super) const QUESTION_PX: f32 = 36.0;
pub(super) const ANSWER_PX: f32 = 28.0;
pub(super) const SMALL_PX: f32 = 22.0;
/// Letters of the stop sign's first and of its other lines [pixels].
const STOP_PX: f32 = 110.0;
pub(super) const STOP_HOW_PX: f32 = 44.0;
const MARGIN: f32 = 40.0;
/// Size of the stop sign's picture [pixels].
pub(super) const STOP_SIZE_PX: glam::UVec2 = glam::UVec2::new(480, 320);

/// Paints what the panel shows.
///
/// # Errors
/// When the device does not paint it.
pub fn paint(
    painter: &mut TextPainter,
    content: &Content,
    layout: &Layout,
    fixed: &PanelWords,
) -> Result<RgbaImage, RenderError> {
    painter.paint(SIZE_PX.x, SIZE_PX.y, GROUND, |ui| {
        let brush = ui.ctx().debug_painter();
        match content {
            Content::Words(words) => text(&brush, words, QUESTION_PX, egui::pos2(MARGIN, 200.0)),
            Content::Pair(number, count) => {
                let corner = egui::pos2(MARGIN, 24.0);
                let position = fill(&fixed.position, &[("number", number), ("count", count)]);
                text(&brush, &position, SMALL_PX, corner);
                let words = fixed.compare.as_str();
                text(&brush, words, QUESTION_PX, egui::pos2(MARGIN, 64.0));
                layout
                    .areas
                    .iter()
                    .for_each(|area| draw(&brush, area, None));
            }
            Content::Item {
                item,
                position: (number, count),
                given,
            } => {
                let corner = egui::pos2(MARGIN, 24.0);
                let position = fill(&fixed.position, &[("number", number), ("count", count)]);
                text(&brush, &position, SMALL_PX, corner);
                text(&brush, &item.text, QUESTION_PX, egui::pos2(MARGIN, 64.0));
                ends(&brush, item, layout, fixed);
                for area in &layout.areas {
                    draw(&brush, area, given.as_ref());
                }
            }
        }
    })
}

/// The picture of the stop sign.
///
/// # Errors
/// When the device does not paint it.
pub fn stop_sign(painter: &mut TextPainter, words: &StopWords) -> Result<RgbaImage> {
    let size = STOP_SIZE_PX;
    let image = painter.paint(size.x, size.y, STOP.to_array(), |ui| {
        let brush = ui.ctx().debug_painter();
        let width = size.x as f32 - 20.0;
        let centred = |words: &str, size_px: f32, y: f32| {
            let mut job = egui::text::LayoutJob::simple(
                words.to_owned(),
                egui::FontId::proportional(size_px),
                LETTERS,
                width,
            );
            job.halign = egui::Align::Center;
            let galley = brush.layout_job(job);
            let at = egui::pos2(0.5 * size.x as f32, y - 0.5 * galley.size().y);
            brush.galley(at, galley, LETTERS);
        };
        centred(
            &words.stop,
            STOP_PX.min(1.8 * width / words.stop.chars().count() as f32),
            90.0,
        );
        centred(&words.how, STOP_HOW_PX, 230.0);
    });
    image.context("cannot paint the stop sign")
}

/// Text from a corner, wrapped at the other margin.
fn text(brush: &egui::Painter, words: &str, size: f32, at: egui::Pos2) {
    let width = SIZE_PX.x as f32 - MARGIN - at.x;
    let font = egui::FontId::proportional(size);
    let galley = brush.layout(words.to_owned(), font, LETTERS, width);
    brush.galley(at, galley, LETTERS);
}

/// The words at a scale's ends, and what to do where there are no boxes.
fn ends(brush: &egui::Painter, item: &Item, layout: &Layout, fixed: &PanelWords) {
    let below = layout
        .areas
        .iter()
        .filter(|area| matches!(area.choice, Choice::Answer(_)))
        .map(|area| area.to.y as f32 + 12.0)
        .fold(270.0, f32::max);
    match &item.kind {
        Kind::Scale { low, high } => {
            let half = SIZE_PX.x as f32 / 2.0;
            let font = egui::FontId::proportional(SMALL_PX);
            let width = half - MARGIN - 20.0;
            let low = brush.layout(low.clone(), font.clone(), LETTERS, width);
            brush.galley(egui::pos2(MARGIN, below), low, LETTERS);
            let high = brush.layout(high.clone(), font, LETTERS, width);
            let right = SIZE_PX.x as f32 - MARGIN - high.size().x;
            brush.galley(egui::pos2(right, below), high, LETTERS);
        }
        Kind::Text => {
            text(
                brush,
                &fixed.own_words,
                ANSWER_PX,
                egui::pos2(MARGIN, below),
            );
        }
        Kind::YesNo | Kind::Choice { .. } => {}
    }
}

fn draw(brush: &egui::Painter, area: &Area, given: Option<&Answer>) {
    let corner = |at: glam::DVec2| egui::pos2(at.x as f32, at.y as f32);
    let rect = egui::Rect::from_min_max(corner(area.from), corner(area.to));
    let is_given = matches!(&area.choice, Choice::Answer(answer) if Some(answer) == given);
    let fill = match area.choice {
        _ if is_given => CHOSEN,
        Choice::Stop => STOP,
        _ => BOX,
    };
    brush.rect_filled(rect, 8.0, fill);
    let font = egui::FontId::proportional(ANSWER_PX);
    let galley = brush.layout(area.words.clone(), font, LETTERS, rect.width() - 16.0);
    brush.galley(rect.center() - 0.5 * galley.size(), galley, LETTERS);
}
