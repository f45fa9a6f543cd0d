//! `bowling compare`: one recorded throw under several conditions, or along a parameter, side by side.

mod condition;
mod course;
mod divergence;
mod figure;
mod pictures;
mod sweep;
mod table;
mod thrown;
mod verdict;

use std::io::Write;
use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::SystemTime;

use anyhow::{Context, Result, bail};
use game::{BareAlley, Conditions, Game, Model, Visible};

use crate::args::{CompareArguments, unusable};
use crate::output::{self, OutputFolder};
use crate::pictures::Painter;
use crate::play::{Progress, interruption};
use condition::{Condition, Table1};
use course::Course;
use pictures::Gallery;
use sweep::Swept;
use table::Comparison;
use thrown::Thrown;

/// How long throws are followed of which nothing says when they were over [s].
const USUAL_S: f64 = 8.0;

/// Compares, prints tables, and writes tables, figures and pictures into the folder.
///
/// Nothing is written before all throws are over, and each file appears only once it is whole.
///
/// # Errors
/// When recording, conditions or folder cannot be used, nothing draws, or somebody interrupts.
pub fn compare(arguments: &CompareArguments, root: &Path) -> Result<()> {
    let stop = interruption()?;
    let thrown = Thrown::read(arguments)?;
    let duration = duration(arguments, &thrown);
    let at = arguments.at.iter().copied().fold(0.0, f64::max);
    if at > duration {
        bail!(unusable(format!(
            "--at {at} lies after the end: give times up to {duration} s, or a longer --duration"
        )));
    }
    let mut progress = Progress::new();
    let done = if arguments.sweep.is_empty() {
        conditions(arguments, root, &thrown, &stop, &mut progress)
    } else {
        into_folder(arguments, |folder| {
            sweeps(arguments, &thrown, &stop, &mut progress, folder)
        })
    };
    progress.end();
    done
}

/// How long throws are followed [s]: as asked for, else until the recorded one was counted.
fn duration(arguments: &CompareArguments, thrown: &Thrown) -> f64 {
    let duration = arguments.duration.or(thrown.counted);
    duration.unwrap_or(USUAL_S).clamp(0.1, 60.0)
}

/// Opens the folder before the work, and takes it back when the work fails.
fn into_folder(
    arguments: &CompareArguments,
    work: impl FnOnce(&OutputFolder) -> Result<()>,
) -> Result<()> {
    let default = || output::timed_folder("compare", SystemTime::now());
    let folder = OutputFolder::create(&arguments.out.clone().unwrap_or_else(default))?;
    let done = work(&folder);
    if done.is_err() {
        folder.abandon();
    }
    done
}

fn conditions(
    arguments: &CompareArguments,
    root: &Path,
    thrown: &Thrown,
    stop: &Arc<AtomicBool>,
    progress: &mut Progress,
) -> Result<()> {
    let table = Table1::load(root)?;
    let (conditions, base) = condition::chosen(arguments, thrown, &table, root)?;
    // Before the throws: a missing driver must not cost them.
    let painter = Painter::new(root, &thrown.config)?.stopped_by(Arc::clone(stop));
    into_folder(arguments, |folder| {
        let courses = courses(arguments, thrown, &conditions, stop, progress)?;
        let comparison = Comparison {
            thrown,
            conditions: &conditions,
            courses: &courses,
            base,
        };
        show(arguments, &table, &comparison, painter, progress, folder)
    })
}

/// Prints the tables, draws the pictures, and writes all of it.
fn show(
    arguments: &CompareArguments,
    table: &Table1,
    comparison: &Comparison<'_>,
    mut painter: Painter,
    progress: &mut Progress,
    folder: &OutputFolder,
) -> Result<()> {
    let Comparison {
        thrown, courses, ..
    } = comparison;
    let mut text = comparison.text();
    let mut files = vec![("compare.csv".to_owned(), comparison.csv().into_bytes())];
    if arguments.conditions.trim() == "all" {
        let edges = verdict::edges(thrown, courses);
        text += &format!("\n{}", verdict::verdict(table, &edges));
        let pairs = table::edges_csv(table, &edges).into_bytes();
        files.push(("pairs.csv".to_owned(), pairs));
    }
    progress.end();
    print(&text)?;
    let mut say = |text: &str| progress.say(text);
    let mut gallery = Gallery {
        painter: &mut painter,
        still: &still(thrown)?,
        comparison,
        progress: &mut say,
    };
    let instants = if arguments.at.is_empty() {
        gallery.instants()
    } else {
        arguments.at.clone()
    };
    let sheet = gallery.sheet(&instants, arguments.tile)?;
    files.push(("contact-sheet.png".to_owned(), sheet));
    let video = match arguments.no_video {
        true => None,
        false => Some(gallery.video(folder, "compare.avi")?),
    };
    progress.end();
    // Only now, when nothing can fail any more but the disk: a folder holds all files or none.
    let mut written = write(folder, &files)?;
    if let Some(video) = video {
        written += &format!("{}\n", video.finish()?.display());
    }
    print(&written)
}

fn courses(
    arguments: &CompareArguments,
    thrown: &Thrown,
    conditions: &[Condition],
    stop: &AtomicBool,
    progress: &mut Progress,
) -> Result<Vec<Course>> {
    let count = conditions.len();
    let mut courses = Vec::new();
    for (index, condition) in conditions.iter().enumerate() {
        let Condition { name, config } = condition;
        check(stop)?;
        progress.say(&format!("condition {name}: {} of {count}", index + 1));
        let pin = BareAlley::pin_shape(config)?;
        let course = Course::of(thrown, config, pin, duration(arguments, thrown))
            .with_context(|| format!("condition {name}"))?;
        courses.push(course);
    }
    Ok(courses)
}

fn sweeps(
    arguments: &CompareArguments,
    thrown: &Thrown,
    stop: &AtomicBool,
    progress: &mut Progress,
    folder: &OutputFolder,
) -> Result<()> {
    let mut files: Vec<(String, Vec<u8>)> = Vec::new();
    for sweep in &arguments.sweep {
        let mut say = |text: &str| {
            progress.say(text);
            check(stop)
        };
        let duration = duration(arguments, thrown);
        let swept = Swept::of(sweep, thrown, duration, &mut say)?;
        progress.end();
        print(&swept.text())?;
        let name = swept.name;
        if files.iter().any(|(file, _)| *file == format!("{name}.csv")) {
            bail!(unusable(format!(
                "--sweep {name} is given twice: give each parameter once"
            )));
        }
        files.push((format!("{name}.csv"), swept.csv().into_bytes()));
        files.push((
            format!("{name}.svg"),
            figure::svg(&swept, duration)?.into_bytes(),
        ));
        files.push((format!("{name}.png"), figure::png(&swept, duration)?));
    }
    print(&write(folder, &files)?)
}

/// Ends the work when somebody asked for that.
fn check(stop: &AtomicBool) -> Result<()> {
    if stop.load(Ordering::Relaxed) {
        bail!("the comparison was interrupted; nothing was written");
    }
    Ok(())
}

/// Writes files; returns their paths, a line each.
fn write(folder: &OutputFolder, files: &[(String, Vec<u8>)]) -> Result<String> {
    let mut written = "\n".to_owned();
    for (name, content) in files {
        written += &format!("{}\n", folder.write(name, content)?.display());
    }
    Ok(written)
}

fn print(text: &str) -> Result<()> {
    let written = std::io::stdout().write_all(text.as_bytes());
    written.context("the result cannot be written")
}

/// What is in the room and stays where it is; neither the pins nor the ball that is thrown.
fn still(thrown: &Thrown) -> Result<Vec<Visible>> {
    let config = &thrown.config;
    let conditions = Conditions {
        lobby: config.clone(),
        red: config.clone(),
        blue: config.clone(),
    };
    let game = Game::new(conditions, 1).context("cannot set up the recorded alley")?;
    let moves = |model: Model| {
        matches!(model, Model::Pin(_) | Model::Hand) || model == Model::Ball(thrown.ball)
    };
    let visible = game.visible().into_iter();
    Ok(visible.filter(|seen| !moves(seen.model)).collect())
}
