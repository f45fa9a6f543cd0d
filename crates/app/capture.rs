//! `bowling capture`: any moment or span of a session, drawn again from its journal.

use std::path::{Path, PathBuf};

use anyhow::{Context, Result, bail};
use game::{Config, DisplayProfileName, Game, Visible};
use image::{DynamicImage, RgbaImage};
use renderer::View;
use sound::Listener;

use crate::args::{CaptureArguments, ViewChoice, unusable};
use crate::convert;
use crate::journal::{self, Changes};
use crate::output::Draft;
use crate::pictures::Painter;
use crate::pictures::avi::AviWriter;
use crate::pictures::film::{SHOTS_PER_SECOND, Shot, can_move};
use crate::play;
use crate::replay::{check_inputs, journal_in};
use crate::sound::{Reporter, Sounded, Track};

/// Draws what the arguments ask for, with the data in `root`.
///
/// # Errors
/// When the session cannot be played again up to there, or the picture cannot be drawn or written.
pub fn capture(arguments: &CaptureArguments, root: &Path) -> Result<()> {
    let until = arguments.until.unwrap_or(arguments.at);
    if until < arguments.at {
        bail!(unusable(format!(
            "--until {until} lies before --at {}",
            arguments.at
        )));
    }
    let path = if arguments.session.is_dir() {
        journal_in(&arguments.session)
    } else {
        arguments.session.clone()
    };
    // What there is of a session that is not over can be looked at too.
    let story = journal::read_open(&path)?;
    let conditions = journal::settings::of(&path, &story.header)?;
    check_inputs(&conditions, &story.inputs)?;
    let mut config = conditions.lobby.clone();
    if let Some(display) = arguments.profile {
        config.display.profile = DisplayProfileName::from(display);
    }
    let mut game =
        Game::new(conditions, story.header.frames).context("cannot set up the recorded alley")?;
    let mut shots = Shots::new(arguments.at, until, Reporter::of(&config));
    let changes = Changes::of(&path, &story.header, &story.notes)?;
    for (index, input) in story.inputs.iter().enumerate() {
        changes.before(index, &mut game)?;
        game.step(input);
        shots.look(&game);
        if game.time() > until {
            break;
        }
    }
    if shots.taken.is_empty() {
        bail!(unusable(format!(
            "--at {}: the session ends at {:.1} s",
            arguments.at,
            game.time()
        )));
    }
    let painter = Painter::new(root, &config)?.stopped_by(play::interruption()?);
    let camera = Camera {
        painter,
        config,
        view: arguments.view,
    };
    let out = out_path(arguments);
    let written = if arguments.until.is_some() {
        camera.video(&shots, &out)?
    } else {
        camera.picture(&shots, &out)?
    };
    println!("{}", written.display());
    Ok(())
}

/// Where it goes: as asked, or `capture.png` or `capture.avi` here.
fn out_path(arguments: &CaptureArguments) -> PathBuf {
    let usual = if arguments.until.is_some() {
        "capture.avi"
    } else {
        "capture.png"
    };
    arguments.out.clone().unwrap_or_else(|| usual.into())
}

/// The things that never move, and snapshots of the others.
struct Shots {
    from: f64,
    until: f64,
    still: Vec<Visible>,
    taken: Vec<Shot>,
    /// Takes the sound; `None` in a scene without.
    reporter: Option<Reporter>,
    sounds: Vec<Sounded>,
}

impl Shots {
    fn new(from: f64, until: f64, reporter: Option<Reporter>) -> Self {
        Self {
            from,
            until,
            still: Vec::new(),
            taken: Vec::new(),
            reporter,
            sounds: Vec::new(),
        }
    }

    /// Takes a snapshot of the first frame that is due.
    fn look(&mut self, game: &Game) {
        if let Some(reporter) = &mut self.reporter {
            self.sounds.extend(reporter.report(game));
        }
        let period = 1.0 / f64::from(SHOTS_PER_SECOND);
        let due = self.from + period * self.taken.len() as f64;
        let is_one = self.taken.is_empty() || due <= self.until;
        if game.time() < due || !is_one {
            return;
        }
        let (moving, still) = game
            .visible()
            .into_iter()
            .partition(|visible| can_move(visible.model));
        self.still = still;
        self.taken.push(Shot {
            time: game.time(),
            head: game.head_pose_world(),
            moving,
            hand: convert::HandLook::of(game),
            scores: std::sync::Arc::new(convert::Scores::of(game)),
        });
    }
}

struct Camera {
    painter: Painter,
    config: Config,
    view: ViewChoice,
}

impl Camera {
    fn picture(mut self, shots: &Shots, out: &Path) -> Result<PathBuf> {
        let picture = self.draw(&shots.still, &shots.taken[0])?;
        let mut draft = Draft::at(out)?;
        picture
            .write_to(&mut draft, image::ImageFormat::Png)
            .context("cannot write the picture")?;
        draft.finish()
    }

    fn video(mut self, shots: &Shots, out: &Path) -> Result<PathBuf> {
        const FAILED: &str = "cannot write the video";
        let track = self.sound_track(shots);
        let mut writer = None;
        let mut progress = play::Progress::new();
        for (number, shot) in shots.taken.iter().enumerate() {
            progress.say(&format!("picture {number} of {}", shots.taken.len()));
            let picture = DynamicImage::from(self.draw(&shots.still, shot)?).to_rgb8();
            let (width, height) = picture.dimensions();
            let video = match &mut writer {
                Some(video) => video,
                None => {
                    let rate = track.as_ref().map(|track| track.sample_rate);
                    let draft = Draft::at(out)?;
                    let video = AviWriter::new(draft, (width, height), SHOTS_PER_SECOND, rate);
                    writer.insert(video.context(FAILED)?)
                }
            };
            video.push(&picture).context(FAILED)?;
            if let Some(track) = &track {
                video.push_sound(track.of_picture(number)).context(FAILED)?;
            }
        }
        progress.end();
        let video = writer.context("there is nothing in this span")?;
        video.finish().context(FAILED)?.finish()
    }

    /// What is heard during all pictures; `None` in a scene without sound.
    fn sound_track(&self, shots: &Shots) -> Option<Track> {
        let mut track = Track::new(self.painter.sound()?, SHOTS_PER_SECOND);
        let heads: Vec<_> = shots.taken.iter().map(|shot| self.listener(shot)).collect();
        track.add(&shots.sounds, shots.taken.first()?.time, &heads);
        Some(track)
    }

    /// Where the ears are while a snapshot is seen: with the eyes.
    fn listener(&self, shot: &Shot) -> Listener {
        match (self.view, shot.head) {
            (ViewChoice::Bird, _) | (_, None) => {
                let view = convert::bird(1.0);
                Listener {
                    position: view.position.as_dvec3(),
                    orientation: view.rotation.as_dquat(),
                }
            }
            (ViewChoice::Eye, Some(head)) => Listener {
                position: head.position,
                orientation: head.rotation,
            },
        }
    }

    /// Both eyes side by side, or the one of a bird.
    fn draw(&mut self, still: &[Visible], shot: &Shot) -> Result<RgbaImage> {
        let display = self.config.display.current();
        let size = (display.width_px, display.height_px);
        match (self.view, shot.head) {
            (ViewChoice::Bird, _) | (_, None) => {
                let view: View = convert::bird(size.0 as f32 / size.1 as f32);
                self.painter.one_eye(still, shot, view, size)
            }
            (ViewChoice::Eye, Some(head)) => {
                let eyes = convert::eyes(&head, &self.config.display);
                let [left, right] = self.painter.draw(still, shot, &eyes, size)?;
                let mut both = RgbaImage::new(left.width() + right.width(), left.height());
                image::imageops::replace(&mut both, &left, 0, 0);
                image::imageops::replace(&mut both, &right, i64::from(left.width()), 0);
                Ok(both)
            }
        }
    }
}
