//! The scoreboard over the lane: both games and how the last ball was let go, painted by egui into a texture whenever they change.

use anyhow::{Context, Result};
use game::{Button, Game, ScoreSheet, ThrowSeen};
use renderer::egui::{self, Align2, Color32, FontId, Pos2, Rect, Stroke, StrokeKind, Vec2};
use renderer::{Gpu, RenderError, Renderer, RgbaImage, TextPainter, TextureId};

use crate::lettering::{Letters, Scribe};
use crate::words::{Words, fill};

/// Size of the picture [pixels]; its shape is the screen's.
pub(crate) const SIZE: [u32; 2] = [1160, 512];
const GROUND: [u8; 4] = [10, 14, 28, 255];
const INK: Color32 = Color32::from_rgb(236, 240, 248);
const FAINT: Color32 = Color32::from_rgb(140, 154, 186);
/// Letters of figures, and of what is read word by word [pixels].
pub(crate) const FIGURE_PX: f32 = 44.0;
pub(crate) const WORD_PX: f32 = 57.0;
/// Height of one game's row [pixels].
const ROW: f32 = 166.0;

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
    pub assist: u32,
    /// How the last ball was let go, where a participant is told.
    pub throw: Option<ThrowSeen>,
}

impl Scores {
    /// The sheets of a game as they stand, and its last throw where the settings let a participant know.
    pub fn of(game: &Game) -> Self {
        let rows = Button::BOTH.map(|button| {
            let is_playing = game.playing() == Some(button);
            Row::of(button, game.score_sheet(button), is_playing)
        });
        let share = game.config().release.assist_share;
        let tells = game.config().guidance.feedback;
        Self {
            rows,
            assist: (100.0 * share).ceil() as u32,
            throw: game.last_throw().filter(|_| tells),
        }
    }

    /// Two games that have not begun.
    pub fn empty(frames: u32) -> Self {
        Self {
            rows: Button::BOTH.map(|button| Row::of(button, &ScoreSheet::new(frames), false)),
            assist: 0,
            throw: None,
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
    letters: Letters<()>,
    /// What was painted last, or is being painted.
    shown: Scores,
    words: Words,
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
    pub fn new(renderer: &mut Renderer, gpu: &Gpu, words: Words) -> Result<Self> {
        let mut letters = Letters::here(gpu);
        let shown = Scores::empty(game::MAX_FRAMES);
        ask(&mut letters, &shown, &words)?;
        let ((), picture) = letters.done()?.context("nobody painted the scoreboard")?;
        Ok(Self {
            texture: renderer.add_picture(&picture)?,
            letters,
            shown,
            words,
        })
    }

    /// From now on is painted by somebody else.
    pub fn paint_apart(&mut self, scribe: &Scribe) {
        self.letters = Letters::apart(scribe);
    }

    pub fn texture(&self) -> TextureId {
        self.texture
    }

    /// Shows these scores, if others are shown, as soon as they are painted.
    pub fn show(&mut self, renderer: &mut Renderer, scores: &Scores) -> Result<()> {
        if *scores != self.shown {
            ask(&mut self.letters, scores, &self.words)?;
            self.shown = scores.clone();
        }
        while let Some(((), picture)) = self.letters.done()? {
            renderer.update_picture(self.texture, &picture)?;
        }
        Ok(())
    }
}

fn ask(letters: &mut Letters<()>, scores: &Scores, words: &Words) -> Result<()> {
    let (scores, words) = (scores.clone(), words.clone());
    letters.ask((), move |painter| paint(painter, &scores, &words))
}

fn paint(
    painter: &mut TextPainter,
    scores: &Scores,
    words: &Words,
) -> Result<RgbaImage, RenderError> {
    let [width, height] = SIZE;
    painter.paint(width, height, GROUND, |ui| {
        let painter = ui.ctx().debug_painter();
        for (row, top) in scores.rows.iter().zip([0.0, ROW]) {
            let area = Rect::from_min_size(
                Pos2::new(12.0, top + 8.0),
                Vec2::new(width as f32 - 24.0, ROW - 12.0),
            );
            paint_row(&painter, row, words.button(row.button), area);
        }
        let below = 2.0 * ROW + 0.25 * (height as f32 - 2.0 * ROW);
        for (line, text) in told(scores.throw, words).into_iter().enumerate() {
            let middle = below + 0.5 * (height as f32 - 2.0 * ROW) * line as f32;
            let at = Pos2::new(30.0, middle);
            write(&painter, at, Align2::LEFT_CENTER, &text, WORD_PX, INK);
        }
        if scores.assist > 0 {
            let text = fill(&words.board.assist, &[("percent", &scores.assist)]);
            let at = Pos2::new(width as f32 - 18.0, below);
            write(&painter, at, Align2::RIGHT_CENTER, &text, WORD_PX, INK);
        }
    })
}

/// How the last ball was let go, in two lines.
fn told(throw: Option<ThrowSeen>, words: &Words) -> Vec<String> {
    let Some(throw) = throw else {
        return Vec::new();
    };
    let board = &words.board;
    let degrees = throw.angle.to_degrees();
    let side = if degrees < 0.0 {
        &board.left
    } else {
        &board.right
    };
    let line = if throw.is_foul {
        &board.over
    } else {
        &board.behind
    };
    let speed = fill(&board.speed, &[("speed", &format!("{:.1}", throw.speed))]);
    let angle = fill(side, &[("angle", &format!("{:.1}", degrees.abs()))]);
    let turns = format!("{:.0}", 60.0 * throw.turns);
    let turns = fill(&board.turns, &[("turns", &turns)]);
    vec![format!("{speed}, {angle}"), format!("{turns}, {line}")]
}

fn write(painter: &egui::Painter, at: Pos2, align: Align2, text: &str, size: f32, color: Color32) {
    painter.text(at, align, text, FontId::proportional(size), color);
}

/// Sign and name, a cell for each frame with its number, marks and score, and the total.
fn paint_row(painter: &egui::Painter, row: &Row, name: &str, area: Rect) {
    let name_width = 190.0;
    let total_width = 110.0;
    let middle = area.center().y;
    row.sign(painter, Pos2::new(area.left() + 26.0, middle), 22.0);
    let at = Pos2::new(area.left() + 56.0, middle);
    write(painter, at, Align2::LEFT_CENTER, name, WORD_PX, INK);
    let wide = (area.width() - name_width - total_width) / row.frames as f32;
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
        let third = |number: f32| Pos2::new(cell.center().x, cell.top() + number * cell.height());
        let figure = |at: Pos2, text: &str, color| {
            write(painter, at, Align2::CENTER_CENTER, text, FIGURE_PX, color);
        };
        figure(third(0.19), &(frame + 1).to_string(), FAINT);
        if let Some(marks) = row.marks.get(frame as usize) {
            figure(third(0.5), marks, INK);
        }
        if let Some(Some(score)) = row.scores.get(frame as usize) {
            figure(third(0.81), &score.to_string(), INK);
        }
    }
    let total = row.scores.iter().flatten().last().copied().unwrap_or(0);
    let at = Pos2::new(area.right() - 6.0, middle);
    write(
        painter,
        at,
        Align2::RIGHT_CENTER,
        &total.to_string(),
        WORD_PX,
        INK,
    );
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Width of a text on the board [pixels].
    fn width(text: &str) -> f32 {
        let context = egui::Context::default();
        let mut width = 0.0;
        let mut output = context.run_ui(egui::RawInput::default(), |ui| {
            let font = FontId::proportional(WORD_PX);
            let painter = ui.ctx().debug_painter();
            let galley = painter.layout_no_wrap(text.to_owned(), font, INK);
            width = galley.size().x;
        });
        output.textures_delta.clear();
        width
    }

    /// What an arm can do at most, in every language that there is, and with help.
    #[test]
    fn what_is_told_of_a_throw_fits_on_the_board() {
        let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR"));
        for name in ["words.toml", "words-de.toml"] {
            let mut config = super::super::tests::config();
            config.guidance.words = name.to_owned();
            let words = Words::load(folder, &config).expect("shipped words");
            for (angle, is_foul) in [(0.3, true), (-0.3, false), (-0.3, true)] {
                let throw = ThrowSeen {
                    speed: 12.4,
                    angle,
                    turns: 9.9,
                    is_foul,
                };
                let [first, second] = &told(Some(throw), &words)[..] else {
                    panic!("two lines");
                };
                let help = fill(&words.board.assist, &[("percent", &100)]);
                let board = SIZE[0] as f32 - 30.0 - 18.0;
                assert!(width(first) + 30.0 + width(&help) < board, "{first} {help}");
                assert!(width(second) < board, "{second}");
            }
        }
    }

    #[test]
    fn a_throw_is_told_in_two_lines() {
        let throw = ThrowSeen {
            speed: 6.84,
            angle: -0.02,
            turns: 3.1,
            is_foul: true,
        };
        let lines = told(Some(throw), &Words::shipped());
        assert_eq!(
            lines,
            [
                "6.8 m/s, 1.1° to the left",
                "186 turns a minute, over the line: foul"
            ]
        );
        assert!(told(None, &Words::shipped()).is_empty());
    }
}
