//! The contact sheet: every delivery's grab, release, first hit and settled pins, for both eyes.
//!
//! A line per delivery pair: a frame's first ball at the left, its second at the right; a third one
//! of the last frame gets a line of its own. Within a tile the left eye's picture is at the left.

use std::io::Cursor;
use std::path::PathBuf;

use anyhow::{Context, Result};
use image::ImageFormat;

use super::album::{Album, Eyes};
use super::film::{Film, Shot, Throw};
use super::layout::{paper, place};

/// Pixels of one eye's picture: eight tiles beside each other fill a wide screen.
const EYE_AREA: f32 = 160.0 * 160.0;
/// Between tiles [pixels].
const GAP: u32 = 6;
/// Height of a line of text [pixels].
const TEXT: u32 = 20;
/// Texts of one delivery: its heading and its moments.
const CAPTIONS: usize = 5;
/// Deliveries beside each other.
const ACROSS: u32 = 2;

/// One tile's content.
struct Moment {
    name: &'static str,
    shot: Option<usize>,
    /// Shown this much later than it happened [s].
    later: f64,
    eyes: Eyes,
}

impl Moment {
    fn shot<'a>(&self, film: &'a Film) -> Option<&'a Shot> {
        let happened = film.shots.get(self.shot?)?;
        Some(&film.shots[film.nearest(happened.time + self.later)])
    }

    fn caption(&self, film: &Film) -> String {
        match self.shot(film) {
            Some(shot) => format!("{}  {:.2} s", self.name, shot.time),
            None => format!("no {}", self.name),
        }
    }
}

/// The moments that matter. Pins are three degrees wide from the foul line, too small for a tile,
/// so that what happens to them is shown from beside the deck.
fn moments(throw: &Throw) -> [Moment; 4] {
    let moment = |name, shot, later, eyes| Moment {
        name,
        shot,
        later,
        eyes,
    };
    // At the release itself the ball is below what the eyes see.
    [
        moment("grab", throw.grab, 0.0, Eyes::Own),
        moment("just released", throw.release, 0.2, Eyes::Own),
        moment("first hit", throw.first_hit, 0.0, Eyes::Spectator),
        moment("settled", throw.settled, 0.0, Eyes::Spectator),
    ]
}

/// Draws and writes the sheet of one game; returns its path.
///
/// # Errors
/// When a tile cannot be drawn or the file cannot be written.
pub fn write(album: &mut Album<'_>) -> Result<PathBuf> {
    let film = album.film;
    let size = album.size(EYE_AREA);
    let lines = lines(&film.throws);
    let (tile_width, tile_height) = (2 * size.0 + GAP, size.1 + TEXT + GAP);
    let block_width = 4 * tile_width + 2 * GAP;
    let line_height = tile_height + TEXT;
    let count = lines.iter().map(|(line, _)| line + 1).max().unwrap_or(0);
    let mut sheet = paper(GAP + ACROSS * block_width, 2 * TEXT + count * line_height);
    let title = format!(
        "{}: {} pins. Left eye, right eye. Grab and release through the participant's eyes, the rest from beside the pins.",
        film.button, film.total
    );
    let captions = album.painter.captions(&captions(film, title))?;
    let (title, captions) = captions.split_first().expect("the title is the first");
    place(&mut sheet, title, GAP, GAP);
    let throws = film
        .throws
        .iter()
        .zip(&lines)
        .zip(captions.chunks_exact(CAPTIONS));
    for (number, ((throw, (line, block)), captions)) in throws.enumerate() {
        (album.progress)(&format!(
            "{} contact sheet: delivery {} of {}",
            film.button,
            number + 1,
            film.throws.len()
        ));
        let (left, top) = (GAP + block * block_width, 2 * TEXT + line * line_height);
        place(&mut sheet, &captions[0], left, top);
        for (column, (moment, caption)) in moments(throw).iter().zip(&captions[1..]).enumerate() {
            let x = left + column as u32 * tile_width;
            if let Some(shot) = moment.shot(film) {
                let [left_eye, right_eye] = album.draw(shot, moment.eyes, size)?;
                place(&mut sheet, &left_eye, x, top + TEXT);
                place(&mut sheet, &right_eye, x + size.0, top + TEXT);
            }
            place(&mut sheet, caption, x, top + TEXT + size.1);
        }
    }
    let mut png = Cursor::new(Vec::new());
    sheet
        .write_to(&mut png, ImageFormat::Png)
        .context("cannot encode the contact sheet")?;
    album.folder.write(
        &format!("{}-contact-sheet.png", film.button.file_stem()),
        png.get_ref(),
    )
}

/// The title, then for each delivery its heading and the captions of its moments.
fn captions(film: &Film, title: String) -> Vec<String> {
    let mut lines = vec![title];
    for throw in &film.throws {
        lines.push(heading(throw));
        lines.extend(moments(throw).iter().map(|moment| moment.caption(film)));
    }
    lines
}

fn heading(throw: &Throw) -> String {
    let pins = match (throw.foul, throw.fallen) {
        (true, fallen) => format!("foul ({fallen} fell)"),
        (false, 1) => "1 pin".to_owned(),
        (false, fallen) => format!("{fallen} pins"),
    };
    format!("Frame {}, ball {}: {pins}", throw.frame, throw.ball)
}

/// Line and block (0 left, 1 right) of every throw.
fn lines(throws: &[Throw]) -> Vec<(u32, u32)> {
    let mut line = 0;
    let mut places: Vec<(u32, u32)> = Vec::new();
    for throw in throws {
        let block = (throw.ball.max(1) - 1) % ACROSS;
        if block == 0 && !places.is_empty() {
            line += 1;
        }
        places.push((line, block));
    }
    places
}

#[cfg(test)]
mod tests {
    use super::*;

    fn throw(frame: u32, ball: u32) -> Throw {
        Throw {
            frame,
            ball,
            grab: None,
            release: None,
            first_hit: None,
            settled: None,
            fallen: 3,
            foul: false,
        }
    }

    #[test]
    fn lines_start_with_every_first_and_third_ball() {
        let throws = [
            throw(1, 1),
            throw(2, 1),
            throw(2, 2),
            throw(3, 1),
            throw(3, 2),
            throw(3, 3),
        ];
        assert_eq!(
            lines(&throws),
            [(0, 0), (1, 0), (1, 1), (2, 0), (2, 1), (3, 0)]
        );
    }

    #[test]
    fn heading_says_what_fell() {
        assert_eq!(heading(&throw(2, 1)), "Frame 2, ball 1: 3 pins");
        assert_eq!(
            heading(&Throw {
                foul: true,
                ..throw(2, 1)
            }),
            "Frame 2, ball 1: foul (3 fell)"
        );
    }
}
