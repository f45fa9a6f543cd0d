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
    Flight::begin(&alley, &release(arguments, 0, false)).map_err(unusable)?;
    let printed = if arguments.repeat > 1 {
        many(arguments, &alley)
    } else {
        let shot = match &arguments.record {
            Some(file) => recorded(arguments, &alley, file)?,
            None => throw(arguments, &alley, 0)?,
        };
        print(arguments, &mut io::stdout().lock(), &shot)
    };
    match printed {
        // Whoever reads has read enough, as `head` does.
        Err(error) if is_closed(&error) => Ok(()),
        printed => printed,
    }
}

fn is_closed(error: &anyhow::Error) -> bool {
    let error = error.downcast_ref::<io::Error>();
    error.is_some_and(|error| error.kind() == io::ErrorKind::BrokenPipe)
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
        return Ok(());
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
    let throw = |index| throw(arguments, alley, index);
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
    let throw = |index| throw(arguments, &alley, index);
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
    let release = release(arguments, 0, true);
    let mut flight = Flight::begin(alley, &release)?;
    let mut record = record::Record::begin(file, &flight, &release)?;
    for _ in 0..steps(&arguments.throw) {
        flight.run(1);
        record.state(&flight)?;
    }
    let shot = shot_of(0, release, &flight, alley);
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
