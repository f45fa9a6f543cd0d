//! Text over the window: the score sheet, what just happened, and the keys.

use anyhow::{Context, Result};
use game::{Button, EventKind, Game};
use image::RgbaImage;
use renderer::{Anchor, TextBlock, TextPainter, WindowTarget};

use super::cost::Report;
use super::keys;

/// What the text says; painted anew only when it changes.
#[derive(Clone, Debug, PartialEq, Default)]
struct Words {
    news: String,
    sheet: String,
    help: bool,
    cost: Option<String>,
}

/// The text over the window.
pub struct Overlay {
    painter: TextPainter,
    words: Words,
    shown: Option<Words>,
    playing: Option<Button>,
    has_cost: bool,
}

impl Overlay {
    /// Text by `painter`; at first it says how to begin.
    pub fn new(painter: TextPainter) -> Self {
        let news = "Press 1 (Red) or 2 (Blue) to begin".to_owned();
        Self {
            painter,
            words: Words {
                news,
                ..Words::default()
            },
            shown: None,
            playing: None,
            has_cost: false,
        }
    }

    /// Shows or hides the keys.
    pub fn toggle_help(&mut self) {
        self.words.help = !self.words.help;
    }

    /// Shows or hides what frames and physics cost.
    pub fn toggle_cost(&mut self) {
        self.has_cost = !self.has_cost;
    }

    /// Takes notice of what the last frame brought.
    pub fn notice(&mut self, game: &Game) {
        for event in game.events() {
            if let EventKind::GameStarted { button } = event.kind {
                self.playing = Some(button);
            }
            if let Some(news) = news(&event.kind) {
                self.words.news = news;
            }
        }
    }

    /// Brings the window's text up to date.
    ///
    /// # Errors
    /// When the text cannot be painted.
    pub fn show(
        &mut self,
        game: &Game,
        cost: Option<&Report>,
        target: &mut WindowTarget,
    ) -> Result<()> {
        self.words.cost = cost.filter(|_| self.has_cost).map(Report::text);
        let sheet = |button| format!("{button}\n{}", game.score_sheet(button));
        self.words.sheet = self.playing.map(sheet).unwrap_or_default();
        if self.shown.as_ref() == Some(&self.words) {
            return Ok(());
        }
        let mut images = vec![(
            Anchor::TopLeft,
            self.paint(&self.words.news.clone(), 20.0, false)?,
        )];
        images.push((
            Anchor::BottomLeft,
            self.paint("F1 shows the keys", 14.0, false)?,
        ));
        if !self.words.sheet.is_empty() {
            images.push((
                Anchor::TopRight,
                self.paint(&self.words.sheet.clone(), 13.0, true)?,
            ));
        }
        if let Some(cost) = self.words.cost.clone() {
            images.push((Anchor::BottomRight, self.paint(&cost, 12.0, true)?));
        }
        if self.words.help {
            images.push((Anchor::Center, self.paint(keys::HELP, 17.0, true)?));
        }
        let overlays: Vec<_> = images
            .iter()
            .map(|(anchor, image)| (*anchor, image))
            .collect();
        target
            .set_overlays(&overlays)
            .context("cannot show text in the window")?;
        self.shown = Some(self.words.clone());
        Ok(())
    }

    fn paint(&mut self, text: &str, size_px: f32, monospace: bool) -> Result<RgbaImage> {
        let block = TextBlock {
            size_px,
            monospace,
            ..TextBlock::new(text)
        };
        self.painter.block(&block).context("cannot paint text")
    }
}

/// What a player wants to be told, in one line.
fn news(event: &EventKind) -> Option<String> {
    match event {
        EventKind::GameStarted { button } => Some(format!("{button}: take a ball and bowl")),
        EventKind::ConfirmAsked { button } => Some(format!(
            "A game is being played: press {button} again to start over"
        )),
        EventKind::Released(release) => Some(format!("Released at {:.1} m/s", release.speed)),
        EventKind::Foul => Some("Foul: over the line at the release".to_owned()),
        EventKind::Settled {
            fallen, standing, ..
        } => Some(format!(
            "{} down, {} standing",
            fallen.len(),
            standing.len()
        )),
        EventKind::GameOver { button, total } => Some(format!(
            "{button} is over: {total} pins. Press 1 or 2 for another game"
        )),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn news_counts_what_fell() {
        let settled = EventKind::Settled {
            fallen: vec![1, 2, 3],
            standing: vec![4, 5, 6, 7, 8, 9, 10],
            reason: game::EndReason::Still,
        };
        assert_eq!(news(&settled).as_deref(), Some("3 down, 7 standing"));
    }
}
