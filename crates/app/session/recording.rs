//! What `bowling play` leaves beside the journal: motion table, score sheets, and snapshots for the pictures.

use std::fmt::Display;
use std::io::{self, Write};
use std::path::{Path, PathBuf};

use anyhow::{Context, Result, anyhow};
use experiment::background::{BackgroundWriter, Sink};
use game::{Button, Game, Input};

use crate::journal::{Header, Journal};
use crate::motion::{self, Row};
use crate::output::{Draft, JOURNAL, MOTION, OutputFolder};
use crate::pictures::film::{Camera, Film};
use crate::pictures::{Painter, Wanted};

fn motion_failed(problem: impl Display) -> anyhow::Error {
    anyhow!("cannot write the motion table: is the disk full? ({problem})")
}

impl Sink<Row> for Draft {
    fn write(&mut self, row: Row) -> io::Result<()> {
        writeln!(self, "{row}")
    }
}

/// The files of a recording under way.
pub struct Recording {
    folder: OutputFolder,
    motion: BackgroundWriter<Row, Draft>,
    camera: Camera,
}

impl Recording {
    /// Opens the folder with the journal in it; nothing is left behind when that fails.
    ///
    /// # Errors
    /// When the folder is not empty or cannot be written.
    pub fn begin(path: &Path, header: Header, game: &Game) -> Result<(Self, Journal)> {
        let folder = OutputFolder::create(path)?;
        let begun = folder.draft(MOTION).and_then(|mut motion| {
            writeln!(motion, "{}", motion::heading()).map_err(motion_failed)?;
            let motion = BackgroundWriter::begin("motion", motion)
                .context("cannot start the motion table's thread")?;
            let journal = Journal::create(&folder.path().join(JOURNAL), header)?;
            Ok((motion, journal))
        });
        match begun {
            Ok((motion, journal)) => {
                let camera = Camera::new(game);
                let recording = Self {
                    folder,
                    motion,
                    camera,
                };
                Ok((recording, journal))
            }
            Err(error) => {
                folder.abandon();
                Err(error)
            }
        }
    }

    /// Takes a row and a snapshot of the frame that `game` has finished with `input`.
    ///
    /// # Errors
    /// When the disk is full or gone.
    pub fn frame(&mut self, game: &Game, input: &Input) -> Result<()> {
        let row = Row::new(game, input);
        self.motion.hand_over(row).map_err(motion_failed)?;
        self.camera.observe(game);
        Ok(())
    }

    /// True once a ball was thrown in a game: there is something to draw.
    pub fn has_throws(&self) -> bool {
        self.camera.has_throws()
    }

    /// Closes the motion table and writes the sheets of the games that were `started`; returns the files and what pictures
    /// are made from.
    ///
    /// # Errors
    /// When a file cannot be written.
    pub fn finish(self, game: &Game, started: &[Button]) -> Result<(Vec<PathBuf>, Album)> {
        let motion = self.motion.close().map_err(motion_failed)?.finish()?;
        let mut files = vec![self.folder.path().join(JOURNAL), motion];
        for button in started {
            let stem = button.file_stem();
            for (ending, content) in [
                ("txt", sheet_text(game, *button)),
                ("tsv", sheet_table(game, *button)),
            ] {
                let name = format!("{stem}-score.{ending}");
                files.push(self.folder.write(&name, content.as_bytes())?);
            }
        }
        let album = Album {
            folder: self.folder,
            camera: self.camera,
        };
        Ok((files, album))
    }
}

/// Snapshots of a finished recording.
pub struct Album {
    folder: OutputFolder,
    camera: Camera,
}

impl Album {
    /// Draws the pictures that are wanted, telling `progress` now and then; returns their files.
    ///
    /// # Errors
    /// When a picture cannot be drawn or written; what is finished stays.
    pub fn paint(
        self,
        painter: &mut Painter,
        wanted: Wanted,
        progress: &mut dyn FnMut(&str),
    ) -> Result<Vec<PathBuf>> {
        let (still, films) = self.camera.develop();
        let mut files = Vec::new();
        for film in latest_of_each(films) {
            match painter.paint(&still, &film, &self.folder, wanted, progress) {
                Ok(pictures) => files.extend(pictures),
                // The recording is whole; only pictures are missing, as was asked for.
                Err(_) if painter.is_stopped() => break,
                Err(error) => return Err(error),
            }
        }
        Ok(files)
    }
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
