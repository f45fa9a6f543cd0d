//! `bowling shot`: throws without hands or pictures, one or thousands, for sweeps and comparisons with other engines.

mod answer;
pub(crate) mod clock;
pub mod distribution;
pub(crate) mod record;
pub mod scene;
pub mod series;
pub mod throw;

use std::io::{self, BufWriter, Write};
use std::path::Path;

use anyhow::{Context, Result};
use game::BareAlley;

use crate::args::{ShotArguments, unusable};
use answer::Shot;
use distribution::Distribution;
use experiment::random::SplitMix64;
use scene::{alley, steps};
use throw::{Flight, Release};

/// What failed when the standard output refuses.
const UNWRITTEN: &str = "the result cannot be written";

/// Throws, and prints what came of it.
///
/// # Errors
/// When the arguments or the scene's settings cannot be used, or the output not be written.
pub fn shot(arguments: &ShotArguments, root: &Path) -> Result<()> {
    let alley = alley(&arguments.throw, root)?;
    // Found out before anything is thrown.
    check_lane(arguments, &alley)?;
    Flight::begin(&alley, &release(arguments, arguments.first, false)).map_err(unusable)?;
    if arguments.repeat > 1 {
        return many(arguments, &alley);
    }
    let shot = match &arguments.record {
        Some(file) => recorded(arguments, &alley, file)?,
        None => throw(arguments, &alley, arguments.first)?,
    };
    print(arguments, &mut io::stdout().lock(), &shot)
}

/// A ball begins on the lane, which reaches back to the wall behind the approach.
fn check_lane(arguments: &ShotArguments, alley: &BareAlley) -> Result<()> {
    let (lane, room) = (&alley.config().lane, &alley.config().room);
    let half = lane.width_m / 2.0;
    let (near, far) = (
        lane.deck_end_z_m - lane.headpin_z_m,
        room.depth_m - lane.headpin_z_m,
    );
    let problem = if arguments.offset.abs() >= half {
        let offset = arguments.offset;
        format!("--offset {offset} lies beside the lane: give less than {half} to either side")
    } else if !(near..far).contains(&arguments.throw.start) {
        let start = arguments.throw.start;
        format!("--start {start} lies beyond the lane's ends: give from {near:.3} to {far:.3}")
    } else {
        // All of them before the first is thrown, which may be hours before the last.
        let offset = |index| release(arguments, index, true).offset;
        let mut throws = arguments.first..arguments.first + arguments.repeat;
        let Some(index) = throws.find(|index| offset(*index).abs() >= half) else {
            return Ok(());
        };
        let (jitter, offset) = (arguments.jitter_offset, offset(index));
        format!(
            "--jitter-offset {jitter} begins throw {index} at {offset:.3} m, beside the lane: give less"
        )
    };
    Err(unusable(problem).into())
}

fn print(arguments: &ShotArguments, output: &mut impl Write, shot: &Shot) -> Result<()> {
    let text = if arguments.json {
        shot.json() + "\n"
    } else {
        shot.to_string()
    };
    output.write_all(text.as_bytes()).context(UNWRITTEN)
}

/// Throws them all on all cores and prints every one, or how they are distributed.
fn many(arguments: &ShotArguments, alley: &BareAlley) -> Result<()> {
    let mut output = BufWriter::new(io::stdout().lock());
    let mut distribution = Distribution::new(alley.pins().len());
    let threads = series::threads(arguments.throw.threads);
    let throw = |index| throw(arguments, alley, arguments.first + index);
    series::run(arguments.repeat, threads, throw, |shot| {
        let shot = shot?;
        if arguments.json {
            return print(arguments, &mut output, &shot);
        }
        distribution.add(shot.outcome.fallen.len(), shot.outcome.ms_per_second);
        Ok(())
    })?;
    if !arguments.json {
        write!(output, "{distribution}").context(UNWRITTEN)?;
    }
    output.flush().context(UNWRITTEN)
}

/// Numbers of pins that fell, throw by throw.
///
/// # Errors
/// When the arguments or the scene's settings cannot be used.
pub fn fallen_counts(arguments: &ShotArguments, root: &Path) -> Result<Vec<usize>> {
    let alley = alley(&arguments.throw, root)?;
    let threads = series::threads(arguments.throw.threads);
    let mut counts = Vec::new();
    let throw = |index| throw(arguments, &alley, arguments.first + index);
    series::run(arguments.repeat, threads, throw, |shot| {
        counts.push(shot?.outcome.fallen.len());
        anyhow::Ok(())
    })?;
    Ok(counts)
}

/// The release of throw `index`, with its own share of jitter.
fn release(arguments: &ShotArguments, index: u64, jitter: bool) -> Release {
    let mut random = SplitMix64::for_index(arguments.throw.seed, index);
    let mut scatter = |deviation: f64| {
        if jitter && deviation > 0.0 {
            deviation * random.normal()
        } else {
            0.0
        }
    };
    let throw = &arguments.throw;
    Release {
        offset: arguments.offset + scatter(arguments.jitter_offset),
        start: throw.start,
        angle: arguments.angle + scatter(arguments.jitter_angle),
        speed: throw.speed + scatter(arguments.jitter_speed),
        revs: throw.revs,
        axis_rotation: throw.axis_rotation,
    }
}

/// Throw `index` from the release to the end.
fn throw(arguments: &ShotArguments, alley: &BareAlley, index: u64) -> Result<Shot> {
    let release = release(arguments, index, true);
    let mut flight = Flight::begin(alley, &release)
        .map_err(|error| unusable(format!("throw {index}: {error}")))?;
    flight.run(steps(&arguments.throw));
    Ok(shot_of(index, release, &flight, alley))
}

/// The same, with every state kept in a file.
fn recorded(arguments: &ShotArguments, alley: &BareAlley, file: &Path) -> Result<Shot> {
    let release = release(arguments, arguments.first, true);
    let mut flight = Flight::begin(alley, &release)?;
    let mut record = record::Record::begin(file, &flight, &release)?;
    for _ in 0..steps(&arguments.throw) {
        flight.run(1);
        record.state(&flight)?;
    }
    let shot = shot_of(arguments.first, release, &flight, alley);
    record.end(&shot)?;
    Ok(shot)
}

fn shot_of(index: u64, release: Release, flight: &Flight, alley: &BareAlley) -> Shot {
    Shot {
        index,
        release,
        pins: alley.pins().len(),
        outcome: flight.end(),
    }
}
