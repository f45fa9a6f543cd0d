//! The scoreboard over the lane: both games, painted by egui into a texture whenever they change.

use anyhow::Result;
use game::{Button, Game, ScoreSheet};
use renderer::egui::{self, Align2, Color32, FontId, Pos2, Rect, Stroke, StrokeKind, Vec2};
use renderer::{Gpu, Renderer, RgbaImage, TextPainter, TextureId};

/// Size of the picture [pixels]: three to one, as the screen is.
const SIZE: [u32; 2] = [1024, 341];
const GROUND: [u8; 4] = [10, 14, 28, 255];
const INK: Color32 = Color32::from_rgb(236, 240, 248);
const FAINT: Color32 = Color32::from_rgb(96, 112, 146);

/// One game on the board.
#[derive(Clone, Debug, PartialEq)]
struct Row {
    button: Button,
    frames: u32,
    marks: Vec<String>,
    scores: Vec<Option<u32>>,
    is_playing: bool,
}

/// What the board shows.
#[derive(Clone, Debug, PartialEq)]
pub struct Scores {
    rows: [Row; 2],
    /// Help that throws get [percent]; what is not studied must not be had unseen.
    assist: u32,
}

impl Scores {
    /// The sheets of a game as they stand.
    pub fn of(game: &Game) -> Self {
        let rows = Button::BOTH.map(|button| {
            let is_playing = game.playing() == Some(button);
            Row::of(button, game.score_sheet(button), is_playing)
        });
        let share = game.config().release.assist_share;
        Self {
            rows,
            assist: (100.0 * share).ceil() as u32,
        }
    }

    /// Two games that have not begun.
    pub fn empty(frames: u32) -> Self {
        Self {
            rows: Button::BOTH.map(|button| Row::of(button, &ScoreSheet::new(frames), false)),
            assist: 0,
        }
    }
}

impl Row {
    fn of(button: Button, sheet: &ScoreSheet, is_playing: bool) -> Self {
        Self {
            button,
            frames: sheet.frames(),
            marks: sheet.marks(),
            scores: sheet.frame_scores(),
            is_playing,
        }
    }

    /// Red is a disc, Blue a square, as the buttons are: told apart without colours.
    fn sign(&self, painter: &egui::Painter, middle: Pos2, half: f32) {
        match self.button {
            Button::Red => {
                painter.circle_filled(middle, half, Color32::from_rgb(214, 44, 44));
            }
            Button::Blue => {
                let square = Rect::from_center_size(middle, Vec2::splat(1.8 * half));
                painter.rect_filled(square, 0.0, Color32::from_rgb(52, 104, 230));
            }
        }
    }
}

/// The board on its screen.
pub(super) struct Board {
    texture: TextureId,
    painter: TextPainter,
    shown: Scores,
}

impl std::fmt::Debug for Board {
    fn fmt(&self, formatter: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        formatter
            .debug_struct("Board")
            .field("shown", &self.shown)
            .finish_non_exhaustive()
    }
}

impl Board {
    /// A board with nothing on it yet.
    pub fn new(renderer: &mut Renderer, gpu: &Gpu) -> Result<Self> {
        let mut painter = TextPainter::new(gpu);
        let shown = Scores::empty(game::MAX_FRAMES);
        let image = paint(&mut painter, &shown)?;
        Ok(Self {
            texture: renderer.add_texture(&image)?,
            painter,
            shown,
        })
    }

    pub fn texture(&self) -> TextureId {
        self.texture
    }

    /// Shows these scores, if others are shown.
    pub fn show(&mut self, renderer: &mut Renderer, scores: &Scores) -> Result<()> {
        if *scores == self.shown {
            return Ok(());
        }
        let image = paint(&mut self.painter, scores)?;
        renderer.update_texture(self.texture, &image)?;
        self.shown = scores.clone();
        Ok(())
    }
}

fn paint(painter: &mut TextPainter, scores: &Scores) -> Result<RgbaImage> {
    let [width, height] = SIZE;
    let image = painter.paint(width, height, GROUND, |ui| {
        let painter = ui.ctx().debug_painter();
        let half = 0.5 * height as f32;
        for (row, top) in scores.rows.iter().zip([0.0, half]) {
            let area = Rect::from_min_size(
                Pos2::new(12.0, top + 10.0),
                Vec2::new(width as f32 - 24.0, half - 20.0),
            );
            paint_row(&painter, row, area);
        }
        if scores.assist > 0 {
            let text = format!("throws are helped: {} %", scores.assist);
            let at = Pos2::new(0.5 * width as f32, half);
            painter.text(
                at,
                Align2::CENTER_CENTER,
                text,
                FontId::proportional(18.0),
                INK,
            );
        }
    })?;
    Ok(image)
}

/// Sign and name, a cell for each frame with its marks over its score, and the total.
fn paint_row(painter: &egui::Painter, row: &Row, area: Rect) {
    let name_width = 150.0;
    let total_width = 110.0;
    let middle = area.center().y;
    row.sign(painter, Pos2::new(area.left() + 30.0, middle), 22.0);
    let write = |at: Pos2, align: Align2, text: &str, size: f32, color: Color32| {
        painter.text(at, align, text, FontId::proportional(size), color);
    };
    let name = Pos2::new(area.left() + 62.0, middle);
    write(
        name,
        Align2::LEFT_CENTER,
        &row.button.to_string(),
        34.0,
        INK,
    );
    let cells = area.width() - name_width - total_width;
    let wide = cells / row.frames as f32;
    for frame in 0..row.frames {
        let left = area.left() + name_width + wide * frame as f32;
        let cell = Rect::from_min_size(Pos2::new(left, area.top()), Vec2::new(wide, area.height()));
        let is_next = row.is_playing && frame as usize == row.scores.len().max(1) - 1;
        let edge = if is_next { INK } else { FAINT };
        painter.rect_stroke(
            cell.shrink(2.0),
            3.0,
            Stroke::new(2.0, edge),
            StrokeKind::Inside,
        );
        let number = Pos2::new(cell.left() + 8.0, cell.top() + 6.0);
        write(
            number,
            Align2::LEFT_TOP,
            &(frame + 1).to_string(),
            17.0,
            FAINT,
        );
        if let Some(marks) = row.marks.get(frame as usize) {
            let at = Pos2::new(cell.center().x, cell.top() + 0.42 * cell.height());
            write(at, Align2::CENTER_CENTER, marks, 32.0, INK);
        }
        if let Some(Some(score)) = row.scores.get(frame as usize) {
            let at = Pos2::new(cell.center().x, cell.bottom() - 0.2 * cell.height());
            write(at, Align2::CENTER_CENTER, &score.to_string(), 30.0, INK);
        }
    }
    let total = row.scores.iter().flatten().last().copied().unwrap_or(0);
    let at = Pos2::new(area.right() - 6.0, middle);
    write(at, Align2::RIGHT_CENTER, &total.to_string(), 56.0, INK);
}
