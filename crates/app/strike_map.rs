//! `bowling strike-map`: how often all pins fall, by entry offset and entry angle.

mod picture;
mod table;

use std::fs;
use std::io::{IsTerminal, Write};
use std::path::{Path, PathBuf};

use anyhow::{Context, Result};
use game::BareAlley;

use crate::args::{Span, StrikeMapArguments, unusable};
use crate::output::Draft;
use crate::shot::distribution::Distribution;
use crate::shot::scene::{alley, steps};
use crate::shot::series;
use crate::shot::throw::{Flight, Outcome, Release};
use experiment::random::SplitMix64;

/// The map: distributions by offset and angle.
#[derive(Clone, Debug, PartialEq)]
pub struct StrikeMap {
    /// Law, rates and seed, in a sentence.
    pub title: String,
    /// Name of the law.
    pub model: &'static str,
    /// Entry offsets [m], to the right of the head pin.
    pub offsets: Span,
    /// Entry angles [degrees], to the left.
    pub angles: Span,
    /// Angle by angle, and within one offset by offset.
    pub cells: Vec<Distribution>,
}

impl StrikeMap {
    /// Offset [m], angle [degrees] and distribution of every cell.
    pub fn entries(&self) -> impl Iterator<Item = (f64, f64, &Distribution)> {
        let columns = self.offsets.count as usize;
        self.cells.iter().enumerate().map(move |(index, cell)| {
            let (row, column) = ((index / columns) as u32, (index % columns) as u32);
            (self.offsets.at(column), self.angles.at(row), cell)
        })
    }
}

/// Throws the map and writes its table and its picture.
///
/// Nothing is written before the last throw, so that an interrupted run leaves nothing.
///
/// # Errors
/// When the arguments or the scene's settings cannot be used, or the folder not be written.
pub fn strike_map(arguments: &StrikeMapArguments, root: &Path) -> Result<()> {
    let alley = alley(&arguments.throw, root)?;
    check_releases(arguments, &alley)?;
    let model = arguments.throw.model.name();
    let default = || PathBuf::from(format!("out/strike-map-{model}"));
    let folder = arguments.out.clone().unwrap_or_else(default);
    let map = throw_all(arguments, &alley)?;
    let unwritten = || format!("cannot write {}", folder.display());
    fs::create_dir_all(&folder).with_context(unwritten)?;
    for (name, content) in [
        ("strike-map.csv", table::csv(&map)),
        ("strike-map.svg", picture::svg(&map)),
    ] {
        let mut draft = Draft::at(&folder.join(name))?;
        draft
            .write_all(content.as_bytes())
            .with_context(unwritten)?;
        println!("{}", draft.finish()?.display());
    }
    println!("{}", table::best(&map));
    Ok(())
}

/// The corners of the map are the releases farthest out: if they begin on free lane, all do.
fn check_releases(arguments: &StrikeMapArguments, alley: &BareAlley) -> Result<()> {
    let half = alley.config().lane.width_m / 2.0;
    let ends = |span: &Span| [span.from - span.step / 2.0, span.last() + span.step / 2.0];
    for offset in ends(&arguments.offsets) {
        for angle in ends(&arguments.angles) {
            let release = entering(arguments, offset, angle, arguments.throw.speed);
            if release.offset.abs() >= half {
                let problem = format!(
                    "a ball that passes the head pin at {offset} m and {angle} degrees begins beside the lane: give a smaller --start"
                );
                return Err(unusable(problem).into());
            }
            Flight::begin(alley, &release).map_err(unusable)?;
        }
    }
    Ok(())
}

/// The release of a ball whose straight way passes the head pin's spot at an offset [m] and an angle [degrees].
fn entering(arguments: &StrikeMapArguments, offset: f64, angle: f64, speed: f64) -> Release {
    let throw = &arguments.throw;
    Release {
        offset: offset + throw.start * libm::tan(angle.to_radians()),
        start: throw.start,
        speed,
        angle: -angle,
        revs: throw.revs,
        axis_rotation: throw.axis_rotation,
    }
}

/// Throw `index` of the map.
fn throw(arguments: &StrikeMapArguments, alley: &BareAlley, index: u64) -> Result<Outcome> {
    let (columns, cell) = (u64::from(arguments.offsets.count), index / arguments.shots);
    let mut random = SplitMix64::for_index(arguments.throw.seed, index);
    let mut within =
        |span: &Span, place: u64| span.at(place as u32) + span.step * (random.uniform() - 0.5);
    let offset = within(&arguments.offsets, cell % columns);
    let angle = within(&arguments.angles, cell / columns);
    let speed = arguments.throw.speed + arguments.jitter_speed * random.normal();
    let release = entering(arguments, offset, angle, speed);
    let mut flight = Flight::begin(alley, &release).map_err(unusable)?;
    flight.run(steps(&arguments.throw));
    Ok(flight.end())
}

fn throw_all(arguments: &StrikeMapArguments, alley: &BareAlley) -> Result<StrikeMap> {
    let (offsets, angles) = (arguments.offsets, arguments.angles);
    let cells = u64::from(offsets.count) * u64::from(angles.count);
    let mut map = StrikeMap {
        title: title(arguments, alley),
        model: arguments.throw.model.name(),
        offsets,
        angles,
        cells: Vec::new(),
    };
    let threads = series::threads(arguments.throw.threads);
    let work = |index| throw(arguments, alley, index);
    let mut cell = Distribution::new(alley.pins().len());
    series::run(cells * arguments.shots, threads, work, |outcome| {
        let outcome = outcome?;
        cell.add(outcome.fallen.len(), outcome.ms_per_second);
        if cell.throws() == arguments.shots {
            let next = Distribution::new(alley.pins().len());
            map.cells.push(std::mem::replace(&mut cell, next));
            progress(map.cells.len(), offsets.count as usize, cells);
        }
        anyhow::Ok(())
    })?;
    Ok(map)
}

/// Says how far it is: in place on a terminal, else a line for every row.
fn progress(done: usize, columns: usize, cells: u64) {
    if std::io::stderr().is_terminal() {
        let end = if done as u64 == cells { "\n" } else { "" };
        eprint!("\r{done} of {cells} cells{end}");
    } else if done.is_multiple_of(columns) {
        eprintln!("{done} of {cells} cells");
    }
}

fn title(arguments: &StrikeMapArguments, alley: &BareAlley) -> String {
    let throw = &arguments.throw;
    let objects = &alley.config().objects;
    let law = match throw.model {
        crate::args::ModelChoice::Coulomb => String::new(),
        _ => format!(
            ", elasticity {} and friction rate {} per object",
            objects.elasticity, objects.friction_rate
        ),
    };
    format!(
        "{}{law}; {} +- {} m/s, 1/{} s, {} throws a cell, seed {}",
        throw.model.name(),
        throw.speed,
        arguments.jitter_speed,
        throw.frame_rate,
        arguments.shots,
        throw.seed
    )
}
