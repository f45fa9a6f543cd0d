//! One session, whatever the device: boundary, journal, game, and what is kept of it; files at the end.
//!
//! A loop calls [`Session::frame`] once per displayed frame and [`Session::finish`] when it is over,
//! also when somebody interrupts it: the folder is in order then, up to that frame.

mod asking;
pub mod course;
mod health;
mod recording;
mod setup;

use std::path::{Path, PathBuf};
use std::time::Instant;

use anyhow::{Context, Result, bail};
use experiment::protocol::{Note, Place};
use game::{Button, Conditions, DisplayProfileName, Event, EventKind, Game, Input};
use physics::{Stopwatch, Unwatched};

use crate::boundary::{Boundary, Refused};
use crate::journal::{self, Changes, End, Header, Journal, Said};
use crate::panel::Pointing;
use crate::pictures::{Painter, Wanted};
use course::Course;
pub use health::Health;
pub use recording::sheet_text;
use recording::{Album, Recording};
pub use setup::{Keep, Seat, Setup};

/// A session under way.
pub struct Session {
    game: Game,
    boundary: Boundary,
    journal: Journal,
    path: PathBuf,
    /// Where time is not simulated: when the program began, and how much time had passed before [s].
    clock: Option<(Instant, f64)>,
    recording: Option<Recording>,
    course: Option<Course>,
    started: Vec<Button>,
    games_over: u32,
    trigger: f64,
    health: Health,
    /// The throw of a pair that the alley is laid out for.
    laid_out: Option<(u32, u8)>,
}

/// What a session left.
#[derive(Debug)]
pub struct Summary {
    /// State hash, sixteen hexadecimal digits.
    pub hash: String,
    /// The score sheets of the games that were started, in the order of play.
    pub sheets: Vec<String>,
    /// The files, in the order they were written.
    pub files: Vec<PathBuf>,
    /// What the device boundary refused.
    pub refused: Refused,
    /// Simulated time [s].
    pub simulated_s: f64,
}

impl Session {
    /// Sets up the game, then opens the journal.
    ///
    /// # Errors
    /// When the settings make no game, or the folder cannot be used; nothing is left behind then.
    pub fn start(setup: Setup) -> Result<Self> {
        let game =
            Game::new(setup.conditions.clone(), setup.frames).context("cannot set up the alley")?;
        let is_script = setup.device == "script";
        let header = Header {
            schema: journal::SCHEMA,
            program: env!("CARGO_PKG_VERSION").to_owned(),
            commit: env!("BOWLING_COMMIT").to_owned(),
            device: setup.device.to_owned(),
            seed: setup.seed,
            rate_hz: setup.rate_hz,
            display: display_name(&setup.conditions).to_owned(),
            frames: setup.frames,
            scene: setup.scene,
            conditions: None,
            settings_digest: None,
            continues: None,
        };
        match setup.keep {
            Keep::Recording(path) => {
                let conditions = Some(setup.conditions);
                let header = Header {
                    conditions,
                    ..header
                };
                let (recording, journal) = Recording::begin(&path, header, &game)?;
                let mut session = Session::new(game, journal, path, is_script);
                session.recording = Some(recording);
                Ok(session)
            }
            Keep::Study(seat) => Session::sit_down(*seat, header, game, is_script),
        }
    }

    fn new(game: Game, journal: Journal, path: PathBuf, is_script: bool) -> Self {
        Session {
            clock: (!is_script).then(|| (Instant::now(), game.time())),
            game,
            boundary: Boundary::default(),
            journal,
            path,
            recording: None,
            course: None,
            started: Vec::new(),
            games_over: 0,
            trigger: 0.0,
            health: Health::default(),
            laid_out: None,
        }
    }

    /// Begins, or takes up, a study's session.
    fn sit_down(seat: Seat, header: Header, mut game: Game, is_script: bool) -> Result<Self> {
        let mut course = Course::new(seat.plan)?;
        let header = Header {
            settings_digest: Some(seat.settings_digest),
            continues: seat.before.as_ref().map(|(continues, _)| continues.clone()),
            ..header
        };
        let mut started = Vec::new();
        let mut games_over = 0;
        if let Some((continues, story)) = &seat.before {
            let earlier = seat.journal.with_file_name(&continues.journal);
            let changes = Changes::of(&earlier, &story.header, &story.notes)?;
            for (index, input) in story.inputs.iter().enumerate() {
                changes.before(index, &mut game)?;
                game.step(input);
                count(game.events(), &mut started, &mut games_over);
            }
            let hash = journal::hash_text(game.hash());
            if hash != continues.hash {
                bail!(
                    "{}: playing it again leads to state {hash} and not to {}: it was made by another version of the program",
                    continues.journal,
                    continues.hash
                );
            }
            course.catch_up(story)?;
        }
        let inputs = seat.before.map_or(0, |(_, story)| story.inputs.len());
        let journal = Journal::create(&seat.journal, header)?.behind(inputs as u64);
        let path = seat.journal.parent().unwrap_or(Path::new("")).to_owned();
        let mut session = Session::new(game, journal, path, is_script);
        (session.started, session.games_over) = (started, games_over);
        session.course = Some(course);
        for note in seat.notes {
            session.journal.study(&note)?;
        }
        Ok(session)
    }

    /// One displayed frame: checks the input, records it, and only then lets the game consume it.
    ///
    /// # Errors
    /// When the recording cannot be written any more; the session must end then.
    pub fn frame(&mut self, input: Input) -> Result<()> {
        self.frame_watched(input, &mut Unwatched)
    }

    /// The same, while `watch` is told the stages of the physics.
    ///
    /// # Errors
    /// As [`Session::frame`].
    pub fn frame_watched(&mut self, input: Input, watch: &mut impl Stopwatch) -> Result<()> {
        let mut input = self.boundary.admit(input);
        if let Some(course) = &self.course {
            input.locked = course.protocol().locked();
        } else if self.game.config().practice.only {
            input.locked = [true; 2];
        }
        self.lay_out()?;
        self.trigger = input.trigger;
        let step_hz = self.game.config().physics.step_hz;
        self.health.follow(&input, f64::from(input.steps) / step_hz);
        self.journal.input(&input)?;
        self.game.step_watched(&input, watch);
        count(self.game.events(), &mut self.started, &mut self.games_over);
        for event in self.game.events() {
            self.journal.event(event)?;
        }
        self.hear()?;
        if let Some(recording) = &mut self.recording {
            recording.frame(&self.game, &input)?;
        }
        Ok(())
    }

    /// Tells the course what happened, and notes where the session has got to by it: behind all events, so that any line behind them
    /// shows that none is missing.
    fn hear(&mut self) -> Result<()> {
        let Some(course) = &mut self.course else {
            return Ok(());
        };
        let at_s = now(self.clock, &self.game);
        for event in self.game.events() {
            if let Some(place) = course.hear(&event.kind) {
                self.journal.study(&Note::Reached { place, at_s })?;
            }
        }
        Ok(())
    }

    /// Where the participant points from, while the head is tracked.
    pub fn pointing(&self) -> Option<Pointing> {
        Some(Pointing {
            head: self.game.head_pose_world()?,
            hand: self.game.hand_pose_world(),
        })
    }

    /// The trigger of the hand that plays, from 0 (open) to 1 (closed).
    pub fn trigger(&self) -> f64 {
        self.trigger
    }

    /// Time since the session began: simulated where a script plays, else measured [s].
    fn now(&self) -> f64 {
        now(self.clock, &self.game)
    }

    /// Records what the device said of itself; the game never sees it.
    ///
    /// # Errors
    /// As [`Session::frame`].
    pub fn device(&mut self, said: impl Into<Said>) -> Result<()> {
        let said = said.into();
        if let Said::Now(value) = &said {
            self.health.hear(value);
        }
        self.journal.device(said)
    }

    /// A picture was shown, `missed` pictures after it was due.
    pub fn picture(&mut self, missed: u64) {
        self.health.picture(Instant::now(), missed);
    }

    /// How tracking and pictures fare.
    pub fn health(&self) -> &Health {
        &self.health
    }

    /// The game, as the last frame left it.
    pub fn game(&self) -> &Game {
        &self.game
    }

    /// True once a ball was thrown in a game: there is something to draw.
    pub fn has_throws(&self) -> bool {
        self.recording.as_ref().is_some_and(Recording::has_throws)
    }

    /// What the device boundary refused so far.
    pub fn refused(&self) -> Refused {
        self.boundary.refused()
    }

    /// The folder that the journal is in.
    pub fn folder(&self) -> &Path {
        &self.path
    }

    /// Ends the session: closes journal and motion table, writes the score sheets, and draws the
    /// pictures that are wanted, telling `progress` now and then.
    ///
    /// # Errors
    /// When a file cannot be written or a picture cannot be drawn; what is finished stays.
    pub fn finish(
        self,
        painter: Option<&mut Painter>,
        wanted: Wanted,
        progress: &mut dyn FnMut(&str),
    ) -> Result<Summary> {
        let started = played_once(&self.started);
        let summary = Summary {
            hash: journal::hash_text(self.game.hash()),
            sheets: started
                .iter()
                .map(|button| sheet_text(&self.game, *button))
                .collect(),
            files: Vec::new(),
            refused: self.boundary.refused(),
            simulated_s: self.game.time(),
        };
        let is_complete = match &self.course {
            Some(course) => course.protocol().place() == Place::Complete,
            None => self.games_over >= 2,
        };
        self.journal.end(End {
            hash: summary.hash.clone(),
            inputs: 0,
            complete: is_complete,
            red: total(&self.game, &started, Button::Red),
            blue: total(&self.game, &started, Button::Blue),
            refused: summary.refused,
        })?;
        let Some(recording) = self.recording else {
            return Ok(summary);
        };
        let (mut files, album): (_, Album) = recording.finish(&self.game, &started)?;
        if let Some(painter) = painter {
            files.extend(album.paint(painter, wanted, progress)?);
        }
        Ok(Summary { files, ..summary })
    }
}

fn now(clock: Option<(Instant, f64)>, game: &Game) -> f64 {
    clock.map_or_else(
        || game.time(),
        |(began, before)| before + began.elapsed().as_secs_f64(),
    )
}

/// Counts games that began and ended.
fn count(events: &[Event], started: &mut Vec<Button>, games_over: &mut u32) {
    for event in events {
        match event.kind {
            EventKind::GameStarted { button } => started.push(button),
            EventKind::GameOver { .. } => *games_over += 1,
            _ => {}
        }
    }
}

/// The display profile in use, as its key in the configuration.
fn display_name(conditions: &Conditions) -> &'static str {
    match conditions.lobby.display.profile {
        DisplayProfileName::Modern => "modern",
        DisplayProfileName::Of1996 => "1996",
    }
}

/// Each button once, in the order in which its last game began.
fn played_once(started: &[Button]) -> Vec<Button> {
    let mut once: Vec<Button> = Vec::new();
    for button in started {
        once.retain(|earlier| earlier != button);
        once.push(*button);
    }
    once
}

fn total(game: &Game, started: &[Button], button: Button) -> Option<u32> {
    started
        .contains(&button)
        .then(|| game.score_sheet(button).total())
}
