//! A consent form as it is read in a window: its file has lines of its own, here its paragraphs are as wide as the window.

use renderer::egui::text::{LayoutJob, TextFormat};
use renderer::egui::{Color32, FontId, Label, Ui};

use super::board::FAINT;

/// Size of the letters, and of a heading's [points].
const SIZE: f32 = 15.0;
const HEADING: f32 = 20.0;
/// Of what is not between asterisks: the font has no bolder letters, so that those are brighter.
const LETTERS: Color32 = Color32::from_gray(196);
/// Wider than this a line is hard to follow back [points].
const WIDEST: f32 = 860.0;

/// What a paragraph is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Kind {
    Heading,
    /// Said about the form, not to the participant.
    Aside,
    Plain,
    Item,
}

/// What is read in one piece.
#[derive(Clone, Debug, PartialEq, Eq)]
struct Paragraph<'a> {
    kind: Kind,
    /// What stands before an item: its number, or a dash.
    marker: &'a str,
    text: String,
}

/// Shows a form's text, as wide as there is room.
pub(super) fn show(ui: &mut Ui, text: &str) {
    ui.set_max_width(ui.available_width().min(WIDEST));
    for paragraph in paragraphs(text) {
        let words = Label::new(layout(&paragraph)).wrap();
        if paragraph.kind == Kind::Item {
            ui.horizontal_top(|ui| {
                ui.label(paragraph.marker);
                ui.vertical(|ui| ui.add(words));
            });
        } else {
            ui.add(words);
        }
        ui.add_space(if paragraph.kind == Kind::Item {
            2.0
        } else {
            8.0
        });
    }
}

/// The paragraphs of a text in Markdown, as far as forms are written in it: headings, asides, items, and what is neither.
fn paragraphs(text: &str) -> Vec<Paragraph<'_>> {
    let mut paragraphs: Vec<Paragraph<'_>> = Vec::new();
    let mut is_open = false;
    for line in text.lines().map(str::trim) {
        let (kind, marker, words) = read(line);
        match paragraphs.last_mut() {
            _ if line.is_empty() => {}
            // A line that begins nothing goes on with what is open; so does the next line of an aside.
            Some(last)
                if is_open
                    && (kind == Kind::Plain || kind == Kind::Aside && last.kind == Kind::Aside) =>
            {
                last.text.push(' ');
                last.text.push_str(words);
            }
            _ => paragraphs.push(Paragraph {
                kind,
                marker,
                text: words.to_owned(),
            }),
        }
        is_open = !line.is_empty() && kind != Kind::Heading;
    }
    paragraphs
}

/// What a line begins, its marker, and the words after it.
fn read(line: &str) -> (Kind, &str, &str) {
    if line.starts_with('#') {
        return (Kind::Heading, "", line.trim_start_matches('#').trim());
    }
    if let Some(words) = line.strip_prefix('>') {
        return (Kind::Aside, "", words.trim());
    }
    let marker = line.split(' ').next().unwrap_or_default();
    let number = marker.strip_suffix('.').unwrap_or_default();
    let is_number = !number.is_empty() && number.bytes().all(|byte| byte.is_ascii_digit());
    if is_number || marker == "-" {
        return (Kind::Item, marker, line[marker.len()..].trim());
    }
    (Kind::Plain, "", line)
}

/// The words of a paragraph, those between two asterisks brighter.
fn layout(paragraph: &Paragraph<'_>) -> LayoutJob {
    let (size, color) = match paragraph.kind {
        Kind::Heading => (HEADING, Color32::WHITE),
        Kind::Aside => (SIZE, FAINT),
        Kind::Plain | Kind::Item => (SIZE, LETTERS),
    };
    let mut job = LayoutJob::default();
    for (piece, words) in paragraph.text.split("**").enumerate() {
        let color = if piece % 2 == 1 {
            Color32::WHITE
        } else {
            color
        };
        let format = TextFormat::simple(FontId::proportional(size), color);
        job.append(words, 0.0, format);
    }
    job
}

#[cfg(test)]
mod tests {
    use renderer::egui;

    use super::*;

    const FORM: &str = include_str!("../../../config/consent.md");

    /// Every text that is painted in a window of this width: its left edge and its lines' widths [points].
    fn painted(width: f32) -> Vec<(f32, Vec<f32>)> {
        let context = egui::Context::default();
        // High enough for all of it.
        let size = egui::vec2(width, 4000.0);
        let input = egui::RawInput {
            screen_rect: Some(egui::Rect::from_min_size(egui::Pos2::ZERO, size)),
            ..egui::RawInput::default()
        };
        let mut output = context.run_ui(input, |ui| show(ui, FORM));
        output.textures_delta.clear();
        let texts = output.shapes.iter().filter_map(|clipped| {
            let egui::Shape::Text(text) = &clipped.shape else {
                return None;
            };
            let rows = text.galley.rows.iter();
            Some((text.pos.x, rows.map(|row| row.rect().width()).collect()))
        });
        texts.collect()
    }

    #[test]
    fn lines_are_as_wide_as_the_window_and_end_where_a_paragraph_does() {
        for width in [640.0, 1280.0] {
            let texts = painted(width);
            let mut lines = 0;
            for (left, rows) in &texts {
                let room = width.min(WIDEST) - left;
                let (last, full) = rows.split_last().expect("a line");
                // Lines are laid out to whole points.
                let most = room + 1.0;
                assert!(*last <= most, "{last} of {room}");
                for row in full {
                    lines += 1;
                    // The next word is no longer than this.
                    assert!(*row <= most && *row > room - 130.0, "{row} of {room}");
                }
            }
            assert!(lines > 10, "{lines} at {width}");
        }
    }

    #[test]
    fn a_form_is_headings_asides_items_and_paragraphs() {
        let text = "# Form\n\n> For\n> you.\n\n**What.** One\ntwo.\n> By the way\n1. First\n   goes on\n2. Second\n\n- [ ] A tick";
        let read = paragraphs(text);
        let read: Vec<(Kind, &str, &str)> = read
            .iter()
            .map(|one| (one.kind, one.marker, one.text.as_str()))
            .collect();
        assert_eq!(
            read,
            [
                (Kind::Heading, "", "Form"),
                (Kind::Aside, "", "For you."),
                (Kind::Plain, "", "**What.** One two."),
                (Kind::Aside, "", "By the way"),
                (Kind::Item, "1.", "First goes on"),
                (Kind::Item, "2.", "Second"),
                (Kind::Item, "-", "[ ] A tick"),
            ]
        );
        let words: usize = paragraphs(FORM)
            .iter()
            .map(|one| one.text.split_whitespace().count())
            .sum();
        let marked = FORM.lines().map(|line| read_marks(line.trim()));
        let marks: usize = marked.sum();
        assert_eq!(
            words + marks,
            FORM.split_whitespace().count(),
            "no word is lost"
        );
    }

    /// Words of a line that are marks.
    fn read_marks(line: &str) -> usize {
        line.split_whitespace().count() - read(line).2.split_whitespace().count()
    }
}
