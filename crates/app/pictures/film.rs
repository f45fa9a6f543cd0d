//! What pictures are made from: light snapshots of the alley, taken while a game is played.

use std::sync::Arc;

use game::{Button, EventKind, Game, Model, Visible};
use physics::Pose;

use crate::convert::{HandLook, Scores};
use crate::sound::{Reporter, Sounded};

/// Snapshots per second: a third of the scripted rate. Every one of them may become a picture of the
/// video, which has to be drawn without a graphics card too.
pub const SHOTS_PER_SECOND: u32 = 30;

/// Everything that moves, at one instant.
#[derive(Debug, Clone)]
pub struct Shot {
    /// Time since the session began [s].
    pub time: f64,
    /// `world_from_head`, while the head is tracked.
    pub head: Option<Pose>,
    /// The things that can move.
    pub moving: Vec<Visible>,
    /// How the hand looks.
    pub hand: HandLook,
    /// Both score sheets; many snapshots share one.
    pub scores: Arc<Scores>,
}

/// One delivery, as indices into [`Film::shots`].
#[derive(Debug, Clone)]
pub struct Throw {
    /// Frame, from 1.
    pub frame: u32,
    /// Ball of the frame, from 1.
    pub ball: u32,
    /// The hand closed on the ball.
    pub grab: Option<usize>,
    /// The hand opened.
    pub release: Option<usize>,
    /// The ball struck the first pin; `None` for a gutter ball.
    pub first_hit: Option<usize>,
    /// The pins were counted.
    pub settled: Option<usize>,
    /// Pins that fell.
    pub fallen: usize,
    /// True when it was a foul.
    pub foul: bool,
}

/// One game.
#[derive(Debug, Clone)]
pub struct Film {
    /// Under which button.
    pub button: Button,
    /// In the order of time.
    pub shots: Vec<Shot>,
    /// In the order of play.
    pub throws: Vec<Throw>,
    /// What sounded, in the order of time; nothing in a scene without sound.
    pub sounds: Vec<Sounded>,
    /// Pins on the score sheet so far.
    pub total: u32,
}

impl Film {
    /// The snapshot nearest to `time` [s]; the film must have one.
    pub fn nearest(&self, time: f64) -> usize {
        let after = self
            .shots
            .partition_point(|shot| shot.time < time)
            .min(self.shots.len() - 1);
        let before = after.saturating_sub(1);
        let distance = |index: usize| (self.shots[index].time - time).abs();
        if distance(before) < distance(after) {
            before
        } else {
            after
        }
    }
}

/// Films games as they are played.
#[derive(Debug)]
pub struct Camera {
    /// The things that never move; taken once.
    still: Vec<Visible>,
    films: Vec<Film>,
    /// Takes the sound; `None` in a scene without.
    reporter: Option<Reporter>,
    is_filming: bool,
    last_shot: Option<f64>,
    grab: Option<usize>,
    release: Option<usize>,
    scores: Arc<Scores>,
}

impl Camera {
    /// Looks at the room before anything moves.
    pub fn new(game: &Game) -> Self {
        let still = game
            .visible()
            .into_iter()
            .filter(|visible| !can_move(visible.model))
            .collect();
        Camera {
            still,
            films: Vec::new(),
            reporter: Reporter::of(game.config()),
            is_filming: false,
            last_shot: None,
            grab: None,
            release: None,
            scores: Arc::new(Scores::of(game)),
        }
    }

    /// Takes notice of the frame that the game has just finished.
    pub fn observe(&mut self, game: &Game) {
        let is_moment = game.events().iter().any(|event| is_moment(&event.kind));
        for event in game.events() {
            if let EventKind::GameStarted { button } = event.kind {
                self.films.push(Film {
                    button,
                    shots: Vec::new(),
                    throws: Vec::new(),
                    sounds: Vec::new(),
                    total: 0,
                });
                self.is_filming = true;
                self.last_shot = None;
            }
        }
        let is_due = self
            .last_shot
            .is_none_or(|last| game.time() - last > 1.0 / f64::from(SHOTS_PER_SECOND) - 1e-6);
        if self.is_filming && (is_due || is_moment) {
            self.shoot(game);
        }
        for event in game.events() {
            self.note(&event.kind);
        }
        if let (Some(reporter), Some(film), true) =
            (&mut self.reporter, self.films.last_mut(), self.is_filming)
        {
            film.sounds.extend(reporter.report(game));
        }
    }

    /// True once a ball was thrown in a game.
    pub fn has_throws(&self) -> bool {
        self.films.iter().any(|film| !film.throws.is_empty())
    }

    /// The things that never move, and all games in the order of play.
    pub fn develop(self) -> (Vec<Visible>, Vec<Film>) {
        (self.still, self.films)
    }

    fn shoot(&mut self, game: &Game) {
        let scores = Scores::of(game);
        if scores != *self.scores {
            self.scores = Arc::new(scores);
        }
        let Some(film) = self.films.last_mut() else {
            return;
        };
        film.shots.push(Shot {
            time: game.time(),
            head: game.head_pose_world(),
            moving: game
                .visible()
                .into_iter()
                .filter(|visible| can_move(visible.model))
                .collect(),
            hand: HandLook::of(game),
            scores: Arc::clone(&self.scores),
        });
        self.last_shot = Some(game.time());
    }

    fn note(&mut self, event: &EventKind) {
        let Some(film) = self.films.last_mut() else {
            return;
        };
        let now = film.shots.len().checked_sub(1);
        match event {
            EventKind::Grabbed {
                model: Model::Ball(_),
            } => self.grab = now,
            EventKind::Released(release) if matches!(release.model, Model::Ball(_)) => {
                self.release = now
            }
            EventKind::ThrowStarted { frame, ball, .. } => film.throws.push(Throw {
                frame: *frame,
                ball: *ball,
                grab: self.grab.take(),
                release: self.release.take(),
                first_hit: None,
                settled: None,
                fallen: 0,
                foul: false,
            }),
            EventKind::FirstHit { .. } => {
                if let Some(throw) = film.throws.last_mut() {
                    throw.first_hit = throw.first_hit.or(now);
                }
            }
            EventKind::Settled { fallen, .. } => {
                if let Some(throw) = film.throws.last_mut() {
                    throw.settled = now;
                    throw.fallen = fallen.len();
                }
            }
            EventKind::Rolled { roll, .. } => {
                if let Some(throw) = film.throws.last_mut() {
                    throw.foul = roll.foul;
                }
            }
            EventKind::FrameScored { total, .. } => film.total = *total,
            EventKind::GameOver { total, .. } => {
                film.total = *total;
                self.is_filming = false;
            }
            _ => {}
        }
    }
}

/// Whether a thing needs a place in every snapshot.
pub fn can_move(model: Model) -> bool {
    matches!(
        model,
        Model::Pin(_)
            | Model::Ball(_)
            | Model::Hand
            | Model::RedButton
            | Model::BlueButton
            | Model::SweepBar
            | Model::SettingTable
    )
}

/// Whether a moment matters enough for a snapshot of its own.
fn is_moment(event: &EventKind) -> bool {
    matches!(
        event,
        EventKind::Grabbed { .. }
            | EventKind::Released(_)
            | EventKind::FirstHit { .. }
            | EventKind::Settled { .. }
            | EventKind::GameStarted { .. }
    )
}
