//! The video of highlights: the throws that felled most, release through the participant's eyes,
//! then the pins from beside the deck; both eyes side by side.

use std::path::PathBuf;

use anyhow::{Context, Result};
use game::Visible;
use image::{DynamicImage, RgbImage, RgbaImage};

use super::Painter;
use super::avi::AviWriter;
use super::film::{Film, SHOTS_PER_SECOND, Throw};
use super::layout::{eye_size, paper, place};
use crate::output::OutputFolder;

/// Pixels of one eye's picture: chosen so that two videos take under two minutes on two cores
/// without a graphics card.
const EYE_AREA: f32 = 272.0 * 272.0;
/// Height of the line of text [pixels].
const TEXT: u32 = 20;
/// Longest video [s].
const LONGEST: f64 = 20.0;
/// Shown before the release and after it [s].
const RELEASE: (f64, f64) = (0.9, 0.7);
/// Shown before the first hit and after it [s].
const HIT: (f64, f64) = (0.4, 1.9);

/// A stretch of the film.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Clip {
    throw: usize,
    from: f64,
    to: f64,
    own_eyes: bool,
}

impl Clip {
    fn duration(&self) -> f64 {
        self.to - self.from
    }
}

/// Draws and writes the highlights of one game; `None` when nothing was thrown.
///
/// # Errors
/// When a picture cannot be drawn or the file cannot be written.
pub fn write(
    painter: &mut Painter,
    still: &[Visible],
    film: &Film,
    folder: &OutputFolder,
    progress: &mut dyn FnMut(&str),
) -> Result<Option<PathBuf>> {
    let frames = frames(film);
    if frames.is_empty() {
        return Ok(None);
    }
    let spectator = painter.spectator_eyes();
    let size = eye_size(EYE_AREA, spectator[0].fov.aspect());
    let draft = folder.draft(&format!("{}-highlights.avi", film.button.file_stem()))?;
    let lines: Vec<String> = film
        .throws
        .iter()
        .map(|throw| caption(film, throw))
        .collect();
    let captions = painter.captions(&lines)?;
    let mut video =
        AviWriter::new(draft, 2 * size.0, size.1 + TEXT, SHOTS_PER_SECOND).context(FAILED)?;
    for (number, (clip, index)) in frames.iter().enumerate() {
        if number.is_multiple_of(SHOTS_PER_SECOND as usize) {
            progress(&format!(
                "{} highlights: picture {number} of {}",
                film.button,
                frames.len()
            ));
        }
        let shot = &film.shots[*index];
        let eyes = if clip.own_eyes {
            painter.own_eyes(shot)
        } else {
            spectator
        };
        let [left, right] = painter.draw(still, shot, &eyes, size)?;
        let picture = page(&left, &right, &captions[clip.throw]);
        video.push(&picture).context(FAILED)?;
    }
    Ok(Some(video.finish().context(FAILED)?.finish()?))
}

const FAILED: &str = "cannot write the video of highlights: is the disk full?";

/// One picture of the video: the eyes side by side, the caption below.
fn page(left: &RgbaImage, right: &RgbaImage, caption: &RgbaImage) -> RgbImage {
    let mut page = paper(left.width() + right.width(), left.height() + TEXT);
    place(&mut page, left, 0, 0);
    place(&mut page, right, left.width(), 0);
    place(&mut page, caption, 4, left.height());
    DynamicImage::ImageRgba8(page).to_rgb8()
}

fn caption(film: &Film, throw: &Throw) -> String {
    let pins = if throw.fallen == 1 { "pin" } else { "pins" };
    format!(
        "{}, frame {}, ball {}: {} {pins}",
        film.button, throw.frame, throw.ball, throw.fallen
    )
}

/// Every picture of the video: its clip and its snapshot.
fn frames(film: &Film) -> Vec<(Clip, usize)> {
    let mut frames = Vec::new();
    for clip in clips(film) {
        // Snapshots of moments lie between the regular ones: pick the nearest to each video frame.
        let count = (clip.duration() * f64::from(SHOTS_PER_SECOND)).floor() as usize;
        for number in 0..count {
            let time = clip.from + number as f64 / f64::from(SHOTS_PER_SECOND);
            frames.push((clip, film.nearest(time)));
        }
    }
    frames.truncate((LONGEST * f64::from(SHOTS_PER_SECOND)) as usize);
    frames
}

/// The clips of the best throws that fit into the video, in the order of play.
fn clips(film: &Film) -> Vec<Clip> {
    let mut by_pins: Vec<usize> = (0..film.throws.len()).collect();
    // Stable: of two throws with equally many pins the earlier one goes first.
    by_pins.sort_by_key(|index| std::cmp::Reverse(film.throws[*index].fallen));
    let mut chosen: Vec<(usize, Vec<Clip>)> = Vec::new();
    let mut left = LONGEST;
    for index in by_pins {
        let clips = clips_of(film, index);
        let duration: f64 = clips.iter().map(Clip::duration).sum();
        if !clips.is_empty() && duration <= left {
            left -= duration;
            chosen.push((index, clips));
        }
    }
    chosen.sort_by_key(|(index, _)| *index);
    chosen.into_iter().flat_map(|(_, clips)| clips).collect()
}

fn clips_of(film: &Film, index: usize) -> Vec<Clip> {
    let throw = &film.throws[index];
    let (Some(first), Some(last)) = (film.shots.first(), film.shots.last()) else {
        return Vec::new();
    };
    let clip = |at: Option<usize>, (before, after): (f64, f64), own_eyes| {
        let time = film.shots.get(at?)?.time;
        Some(Clip {
            throw: index,
            from: (time - before).max(first.time),
            to: (time + after).min(last.time),
            own_eyes,
        })
    };
    // A gutter ball has no hit; its end is shown instead.
    let end = throw.first_hit.or(throw.settled);
    [clip(throw.release, RELEASE, true), clip(end, HIT, false)]
        .into_iter()
        .flatten()
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::pictures::film::Shot;
    use game::Button;

    /// A throw every ten seconds.
    fn film(fallen: &[usize]) -> Film {
        let shot = |number: usize| Shot {
            time: number as f64 / 30.0,
            head: None,
            moving: Vec::new(),
            hand_is_closed: false,
        };
        let throw = |(number, fallen): (usize, &usize)| Throw {
            frame: number as u32 + 1,
            ball: 1,
            grab: None,
            release: Some(number * 300 + 60),
            first_hit: Some(number * 300 + 130),
            settled: Some(number * 300 + 250),
            fallen: *fallen,
            foul: false,
        };
        Film {
            button: Button::Red,
            shots: (0..300 * fallen.len()).map(shot).collect(),
            throws: fallen.iter().enumerate().map(throw).collect(),
            total: 0,
        }
    }

    #[test]
    fn frames_never_last_longer_than_twenty_seconds() {
        let frames = frames(&film(&[5; 12]));
        assert!(
            frames.len() <= 600 && frames.len() > 500,
            "{}",
            frames.len()
        );
    }

    #[test]
    fn clips_take_the_best_throws_in_the_order_of_play() {
        let mut fallen = [1; 10];
        fallen[7] = 10;
        fallen[2] = 9;
        let throws: Vec<usize> = clips(&film(&fallen))
            .iter()
            .map(|clip| clip.throw)
            .collect();
        assert!(throws.contains(&7) && throws.contains(&2), "{throws:?}");
        assert!(throws.is_sorted(), "{throws:?}");
        assert!(!throws.contains(&9), "{throws:?}");
    }

    #[test]
    fn frames_move_on_in_time_within_a_clip() {
        let film = film(&[5, 6]);
        for pair in frames(&film).windows(2) {
            let same_clip = pair[0].0 == pair[1].0;
            assert!(!same_clip || pair[0].1 < pair[1].1, "{pair:?}");
        }
    }
}
