//! One session, whatever the device: boundary, journal, game, motion table, film; files at the end.
//!
//! A loop calls [`Session::frame`] once per displayed frame and [`Session::finish`] when it is over,
//! also when somebody interrupts it: the folder is in order then, up to that frame.

use std::io::Write;
use std::path::{Path, PathBuf};

use anyhow::{Context, Result};
use game::{Button, Conditions, DisplayProfileName, EventKind, Game, Input};
use physics::{Stopwatch, Unwatched};

use crate::boundary::{Boundary, Refused};
use crate::journal::{self, End, Header, Journal};
use crate::motion;
use crate::output::{Draft, JOURNAL, MOTION, OutputFolder};
use crate::pictures::film::{Camera, Film};
use crate::pictures::{Painter, Wanted};

/// How a session is set up.
#[derive(Debug, Clone)]
pub struct Setup {
    /// Resolved settings.
    pub conditions: Conditions,
    /// Scene that they came from.
    pub scene: String,
    /// Bowling frames per game.
    pub frames: u32,
    /// Seed of the scripted participant.
    pub seed: u64,
    /// Who bowls: `headset`, `desk` or `script`.
    pub device: &'static str,
    /// Frames per second of the device [Hz].
    pub rate_hz: f64,
    /// The folder for the recording.
    pub folder: PathBuf,
}

/// A session under way.
pub struct Session {
    game: Game,
    boundary: Boundary,
    journal: Journal,
    motion: Draft,
    camera: Camera,
    folder: OutputFolder,
    started: Vec<Button>,
    games_over: u32,
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
    /// Sets up the game, then opens the folder with the journal in it.
    ///
    /// # Errors
    /// When the settings make no game, or the folder cannot be used; nothing is left behind then.
    pub fn start(setup: Setup) -> Result<Self> {
        let game =
            Game::new(setup.conditions.clone(), setup.frames).context("cannot set up the alley")?;
        let camera = Camera::new(&game);
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
            conditions: Some(setup.conditions),
            settings_digest: None,
            continues: None,
        };
        let folder = OutputFolder::create(&setup.folder)?;
        let (journal, motion) = match begin(&folder, header) {
            Ok(files) => files,
            Err(error) => {
                folder.abandon();
                return Err(error);
            }
        };
        Ok(Session {
            game,
            boundary: Boundary::default(),
            journal,
            motion,
            camera,
            folder,
            started: Vec::new(),
            games_over: 0,
        })
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
        let input = self.boundary.admit(input);
        self.journal.input(&input)?;
        self.game.step_watched(&input, watch);
        for event in self.game.events() {
            self.journal.event(event)?;
            match event.kind {
                EventKind::GameStarted { button } => self.started.push(button),
                EventKind::GameOver { .. } => self.games_over += 1,
                _ => {}
            }
        }
        writeln!(self.motion, "{}", motion::row(&self.game, &input)).context(MOTION_FAILED)?;
        self.camera.observe(&self.game);
        Ok(())
    }

    /// Records what the device said of itself; the game never sees it.
    ///
    /// # Errors
    /// As [`Session::frame`].
    pub fn device(&mut self, value: serde_json::Value) -> Result<()> {
        self.journal.device(value)
    }

    /// The game, as the last frame left it.
    pub fn game(&self) -> &Game {
        &self.game
    }

    /// True once a ball was thrown in a game: there is something to draw.
    pub fn has_throws(&self) -> bool {
        self.camera.has_throws()
    }

    /// What the device boundary refused so far.
    pub fn refused(&self) -> Refused {
        self.boundary.refused()
    }

    /// The folder that the recording is in.
    pub fn folder(&self) -> &Path {
        self.folder.path()
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
        self.journal.end(End {
            hash: summary.hash.clone(),
            inputs: 0,
            complete: self.games_over >= 2,
            red: total(&self.game, &started, Button::Red),
            blue: total(&self.game, &started, Button::Blue),
            refused: summary.refused,
        })?;
        let mut files = vec![self.folder.path().join(JOURNAL), self.motion.finish()?];
        for (button, text) in started.iter().zip(&summary.sheets) {
            let stem = button.file_stem();
            files.push(
                self.folder
                    .write(&format!("{stem}-score.txt"), text.as_bytes())?,
            );
            let table = sheet_table(&self.game, *button);
            files.push(
                self.folder
                    .write(&format!("{stem}-score.tsv"), table.as_bytes())?,
            );
        }
        if let Some(painter) = painter {
            let (still, films) = self.camera.develop();
            for film in latest_of_each(films) {
                match painter.paint(&still, &film, &self.folder, wanted, progress) {
                    Ok(pictures) => files.extend(pictures),
                    // The recording is whole; only pictures are missing, as was asked for.
                    Err(_) if painter.is_stopped() => break,
                    Err(error) => return Err(error),
                }
            }
        }
        Ok(Summary { files, ..summary })
    }
}

/// The two files that grow with the session, with their first lines; neither stays where one fails.
fn begin(folder: &OutputFolder, header: Header) -> Result<(Journal, Draft)> {
    let mut motion = folder.draft(MOTION)?;
    writeln!(motion, "{}", motion::heading()).context(MOTION_FAILED)?;
    let journal = Journal::create(&folder.path().join(JOURNAL), header)?;
    Ok((journal, motion))
}

const MOTION_FAILED: &str = "cannot write the motion table: is the disk full?";

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

/// A game that was started again replaces the one before it, as on its score sheet.
fn latest_of_each(films: Vec<Film>) -> Vec<Film> {
    let mut latest: Vec<Film> = Vec::new();
    for film in films {
        latest.retain(|earlier| earlier.button != film.button);
        latest.push(film);
    }
    latest
}

fn total(game: &Game, started: &[Button], button: Button) -> Option<u32> {
    started
        .contains(&button)
        .then(|| game.score_sheet(button).total())
}

/// The score sheet of one game for people.
pub fn sheet_text(game: &Game, button: Button) -> String {
    format!("{button}\n{}\n", game.score_sheet(button))
}

/// The score sheet of one game as a table: a row per frame.
fn sheet_table(game: &Game, button: Button) -> String {
    let sheet = game.score_sheet(button);
    let mut table = "frame\tmarks\tcumulative\n".to_owned();
    for (index, (marks, score)) in sheet.marks().iter().zip(sheet.frame_scores()).enumerate() {
        let score = score.map_or("n/a".to_owned(), |score| score.to_string());
        table += &format!("{}\t{marks}\t{score}\n", index + 1);
    }
    table
}
