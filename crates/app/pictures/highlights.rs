//! The video of highlights: the throws that felled most, release through the participant's eyes,
//! then the pins from beside the deck; both eyes side by side.

use std::path::PathBuf;

use anyhow::{Context, Result};
use image::{DynamicImage, RgbImage, RgbaImage};

use super::album::{Album, Eyes};
use super::avi::AviWriter;
use super::film::{Film, SHOTS_PER_SECOND, Shot, Throw};
use super::layout::{paper, place};
use crate::sound::Track;

/// Pixels of one eye's picture: chosen so that two videos take under two minutes on two cores
/// without a graphics card.
const EYE_AREA: f32 = 272.0 * 272.0;
/// Height of the line of text [pixels].
const TEXT: u32 = 20;
/// Longest video [s].
const LONGEST: f64 = 20.0;
/// Looked at before and after the release [s]: the swing's way down and the ball's way to the arrows.
const RELEASE: (f64, f64) = (0.1, 0.9);
/// Looked at before and after the first hit [s].
const HIT: (f64, f64) = (0.5, 1.9);
/// A clip begins this long before the ball comes into sight [s].
const LEAD: f64 = 0.07;

/// Whether a snapshot shows a ball to the eyes.
type Shows<'a> = dyn Fn(&Shot, Eyes) -> bool + 'a;

/// A stretch of the film.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Clip {
    throw: usize,
    from: f64,
    to: f64,
    eyes: Eyes,
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
pub fn write(album: &mut Album<'_>) -> Result<Option<PathBuf>> {
    let film = album.film;
    let frames = frames(film, &|shot, eyes| album.shows_a_ball(shot, eyes));
    if frames.is_empty() {
        return Ok(None);
    }
    let size = album.size(EYE_AREA);
    let draft = album
        .folder
        .draft(&format!("{}-highlights.avi", film.button.file_stem()))?;
    let lines: Vec<String> = film
        .throws
        .iter()
        .map(|throw| caption(film, throw))
        .collect();
    let captions = album.painter.captions(&lines)?;
    let track = sound_track(album, &frames);
    let mut video = AviWriter::new(
        draft,
        (2 * size.0, size.1 + TEXT),
        SHOTS_PER_SECOND,
        track.as_ref().map(|track| track.sample_rate),
    )
    .context(FAILED)?;
    for (number, (clip, index)) in frames.iter().enumerate() {
        if number.is_multiple_of(SHOTS_PER_SECOND as usize) {
            (album.progress)(&format!(
                "{} highlights: picture {number} of {}",
                film.button,
                frames.len()
            ));
        }
        let [left, right] = album.draw(&film.shots[*index], clip.eyes, size)?;
        let picture = page(&left, &right, &captions[clip.throw]);
        video.push(&picture).context(FAILED)?;
        if let Some(track) = &track {
            video.push_sound(track.of_picture(number)).context(FAILED)?;
        }
    }
    Ok(Some(video.finish().context(FAILED)?.finish()?))
}

const FAILED: &str = "cannot write the video of highlights: is the disk full?";

/// What is heard during all pictures, clip by clip; `None` in a scene without sound.
fn sound_track(album: &Album<'_>, frames: &[(Clip, usize)]) -> Option<Track> {
    let mut track = Track::new(album.painter.sound()?, SHOTS_PER_SECOND);
    for clip in frames.chunk_by(|a, b| a.0 == b.0) {
        let heads: Vec<_> = clip
            .iter()
            .map(|(clip, index)| album.listener(&album.film.shots[*index], clip.eyes))
            .collect();
        track.add(&album.film.sounds, clip[0].0.from, &heads);
    }
    Some(track)
}

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
fn frames(film: &Film, shows: &Shows<'_>) -> Vec<(Clip, usize)> {
    let mut frames = Vec::new();
    for clip in clips(film, shows) {
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
fn clips(film: &Film, shows: &Shows<'_>) -> Vec<Clip> {
    let mut by_pins: Vec<usize> = (0..film.throws.len()).collect();
    // Stable: of two throws with equally many pins the earlier one goes first.
    by_pins.sort_by_key(|index| std::cmp::Reverse(film.throws[*index].fallen));
    let mut chosen: Vec<(usize, Vec<Clip>)> = Vec::new();
    let mut left = LONGEST;
    for index in by_pins {
        let clips = clips_of(film, index, shows);
        let duration: f64 = clips.iter().map(Clip::duration).sum();
        if !clips.is_empty() && duration <= left {
            left -= duration;
            chosen.push((index, clips));
        }
    }
    chosen.sort_by_key(|(index, _)| *index);
    chosen.into_iter().flat_map(|(_, clips)| clips).collect()
}

/// The clips of one throw. Each begins when there is a ball to see: the swing is behind and below what the eyes see.
fn clips_of(film: &Film, index: usize, shows: &Shows<'_>) -> Vec<Clip> {
    let throw = &film.throws[index];
    let (Some(first), Some(last)) = (film.shots.first(), film.shots.last()) else {
        return Vec::new();
    };
    let clip = |at: Option<usize>, (before, after): (f64, f64), eyes| {
        let time = film.shots.get(at?)?.time;
        let (from, to) = (time - before, (time + after).min(last.time));
        let seen = film.shots[film.nearest(from)..]
            .iter()
            .take_while(|shot| shot.time < to)
            .find(|shot| shows(shot, eyes));
        let from = seen.map_or(from, |shot| shot.time - LEAD);
        Some(Clip {
            throw: index,
            from: from.max(first.time),
            to,
            eyes,
        })
    };
    // A gutter ball has no hit; its end is shown instead.
    let end = throw.first_hit.or(throw.settled);
    [
        clip(throw.release, RELEASE, Eyes::Own),
        clip(end, HIT, Eyes::Spectator),
    ]
    .into_iter()
    .flatten()
    .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::convert::{HandLook, HandShape};
    use game::Button;

    /// A throw every ten seconds.
    fn film(fallen: &[usize]) -> Film {
        let shot = |number: usize| Shot {
            time: number as f64 / 30.0,
            head: None,
            moving: Vec::new(),
            hand: HandLook::right(HandShape::Closing(0.0)),
            scores: std::sync::Arc::new(crate::convert::Scores::empty(game::MAX_FRAMES)),
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
            sounds: Vec::new(),
            total: 0,
        }
    }

    #[test]
    fn frames_never_last_longer_than_twenty_seconds() {
        let frames = frames(&film(&[5; 12]), &|_, _| true);
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
        let throws: Vec<usize> = clips(&film(&fallen), &|_, _| true)
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
        for pair in frames(&film, &|_, _| true).windows(2) {
            let same_clip = pair[0].0 == pair[1].0;
            assert!(!same_clip || pair[0].1 < pair[1].1, "{pair:?}");
        }
    }

    #[test]
    fn clips_begin_just_before_a_ball_is_seen() {
        // Released at 2 s and seen from 2.3 s on; it hits at 4.33 s and is seen there all the time.
        let clips = clips(&film(&[5]), &|shot, eyes| {
            eyes == Eyes::Spectator || shot.time > 2.29
        });
        let begins: Vec<f64> = clips.iter().map(|clip| clip.from).collect();
        assert!((begins[0] - (2.3 - LEAD)).abs() < 1e-9, "{begins:?}");
        assert!(
            (begins[1] - (130.0 / 30.0 - HIT.0 - LEAD)).abs() < 0.02,
            "{begins:?}"
        );
    }
}
