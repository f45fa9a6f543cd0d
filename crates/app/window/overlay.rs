//! Text over the window: the score sheet, what just happened, and the keys.

use anyhow::{Context, Result};
use game::{Button, EventKind, Game};
use image::RgbaImage;
use renderer::{Anchor, TextBlock, TextPainter, WindowTarget};

use super::cost::Report;
use crate::words::{Words as AllWords, fill};

/// What is shown; painted anew only when it changes.
#[derive(Clone, Debug, PartialEq, Default)]
struct Shown {
    news: String,
    sheet: String,
    help: bool,
    is_paused: bool,
    cost: Option<String>,
}

/// The text over the window.
pub struct Overlay {
    painter: TextPainter,
    words: AllWords,
    now: Shown,
    shown: Option<Shown>,
    playing: Option<Button>,
    has_cost: bool,
}

impl Overlay {
    /// Text by `painter` in these words; at first it says how to begin.
    pub fn new(painter: TextPainter, words: AllWords, is_practice: bool) -> Self {
        let begin = if is_practice {
            &words.practice.begin
        } else {
            &words.window.begin
        };
        Self {
            painter,
            now: Shown {
                news: words.with_buttons(begin),
                ..Shown::default()
            },
            words,
            shown: None,
            playing: None,
            has_cost: false,
        }
    }

    /// Shows or hides the keys.
    pub fn toggle_help(&mut self) {
        self.now.help = !self.now.help;
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
            let tells = game.config().guidance.feedback;
            if let Some(news) = news(&event.kind, tells, &self.words) {
                self.now.news = news;
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
        self.now.is_paused = game.is_paused();
        self.now.cost = cost.filter(|_| self.has_cost).map(Report::text);
        let name = |button| self.words.button(button);
        let sheet = |button| format!("{}\n{}", name(button), game.score_sheet(button));
        self.now.sheet = self.playing.map(sheet).unwrap_or_default();
        if self.shown.as_ref() == Some(&self.now) {
            return Ok(());
        }
        let news = if self.now.is_paused {
            self.words.window.paused.clone()
        } else {
            self.now.news.clone()
        };
        let mut images = vec![(Anchor::TopLeft, self.paint(&news, 20.0, false)?)];
        images.push((
            Anchor::BottomLeft,
            self.paint(&self.words.window.keys.clone(), 14.0, false)?,
        ));
        if !self.now.sheet.is_empty() {
            images.push((
                Anchor::TopRight,
                self.paint(&self.now.sheet.clone(), 13.0, true)?,
            ));
        }
        if let Some(cost) = self.now.cost.clone() {
            images.push((Anchor::BottomRight, self.paint(&cost, 12.0, true)?));
        }
        if self.now.help {
            let help = self.words.with_buttons(&self.words.window.help);
            images.push((Anchor::Center, self.paint(help.trim(), 17.0, true)?));
        }
        let overlays: Vec<_> = images
            .iter()
            .map(|(anchor, image)| (*anchor, image))
            .collect();
        target
            .set_overlays(&overlays)
            .context("cannot show text in the window")?;
        self.shown = Some(self.now.clone());
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

/// What a player wants to be told, in one line; of a release only where `tells`.
fn news(event: &EventKind, tells: bool, words: &AllWords) -> Option<String> {
    let window = &words.window;
    let of = |text: &str, button: &Button| fill(text, &[("button", &words.button(*button))]);
    match event {
        EventKind::GameStarted { button } => Some(of(&window.started, button)),
        EventKind::ConfirmAsked { button } => Some(of(&window.confirm, button)),
        EventKind::Released(release) if tells => {
            let speed = format!("{:.1}", release.speed);
            Some(fill(&window.released, &[("speed", &speed)]))
        }
        EventKind::Foul if tells => Some(window.foul.clone()),
        EventKind::Settled {
            fallen, standing, ..
        } => Some(fill(
            &window.settled,
            &[("fallen", &fallen.len()), ("standing", &standing.len())],
        )),
        EventKind::GameOver { button, total } => {
            Some(fill(&of(&window.over, button), &[("total", total)]))
        }
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
        let words = AllWords::shipped();
        let told = news(&settled, false, &words);
        assert_eq!(told.as_deref(), Some("3 down, 7 standing"));
        let over = EventKind::GameOver {
            button: Button::Blue,
            total: 144,
        };
        let told = news(&over, false, &words).expect("a line");
        assert!(told.starts_with("Blue is over: 144 pins."), "{told}");
    }

    #[test]
    fn news_of_a_release_are_told_where_that_is_asked_for() {
        let words = AllWords::shipped();
        assert_eq!(news(&EventKind::Foul, false, &words), None);
        assert_eq!(
            news(&EventKind::Foul, true, &words),
            Some(words.window.foul)
        );
    }
}
