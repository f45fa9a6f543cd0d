//! `bowling study simulate`: a whole study without anybody, both games of every participant and all answers.

use std::path::Path;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::{Mutex, PoisonError};
use std::time::Instant;

use anyhow::{Result, bail};
use experiment::plan::About;
use experiment::protocol::Note;
use experiment::random::SplitMix64;
use experiment::study::{Assignment, Lock, Study};
use indicatif::{ProgressBar, ProgressStyle};

use super::run::{bowl, seed, simulated, simulated_consent};
use super::seat::{self, Guest};
use super::{manage, tables};
use crate::args::{SimulateArguments, unusable};
use crate::pictures::Wanted;
use crate::play;

/// The day on which simulated participants agree: the same in every run, so that a seed gives the same study.
const DAY: &str = "1997-01-01";
/// Simulated data need not be erased by any day.
const FOR_EVER: &str = "9999-12-31";

/// Makes a study and plays it through, several participants at a time.
///
/// # Errors
/// When the study cannot be made or a participant does not get through; what is done then stays, and is in order.
pub fn simulate(arguments: &SimulateArguments, root: &Path) -> Result<()> {
    check(arguments)?;
    let stop = play::interruption()?;
    let begun = Instant::now();
    let about = About {
        title: "A simulated study".to_owned(),
        laboratory: "Nobody: the participants are simulated".to_owned(),
        contact: "nobody".to_owned(),
        withdrawal_until: FOR_EVER.to_owned(),
        retention_until: FOR_EVER.to_owned(),
    };
    let config = root.join("config");
    let texts = [config.join("questionnaire.toml"), config.join("consent.md")];
    let mut random = SplitMix64::new(arguments.plan.seed);
    let study = manage::create(
        &arguments.plan,
        about,
        [&texts[0], &texts[1]],
        random.next_u64(),
        root,
    )?;
    let lock = study.lock()?;
    let seats: Vec<Assignment> = (0..arguments.plan.subjects)
        .map(|_| study.admit(&lock, random.next_u64()))
        .collect::<Result<_, _>>()?;
    let progress = bar(seats.len());
    let play = |assignment: &Assignment, registers: &Mutex<&Lock>| {
        play_one(
            &study,
            registers,
            assignment,
            arguments.threshold,
            root,
            &stop,
        )
    };
    let outcome = play_all(&lock, &seats, play, &stop, &progress);
    progress.finish_and_clear();
    outcome?;
    if stop.load(Ordering::Relaxed) {
        bail!(
            "interrupted: the journals are in order up to here; `bowling study resume` and `run` go on, {}",
            study.root().display()
        );
    }
    let played = begun.elapsed().as_secs_f64();
    tables::write(&study, &lock)?;
    println!(
        "{} participants in {played:.0} s, tables in {:.0} s: {}",
        seats.len(),
        begun.elapsed().as_secs_f64() - played,
        study.root().display()
    );
    Ok(())
}

/// What only simulated participants have must fit before anything is made.
fn check(arguments: &SimulateArguments) -> Result<()> {
    match arguments.threshold {
        Some(_) if arguments.plan.scheme != "staircase" => {
            bail!(unusable("--threshold belongs to --scheme staircase"))
        }
        Some(threshold) if !(threshold.is_finite() && threshold > 0.0) => bail!(unusable(format!(
            "--threshold is {threshold}, and has to be a number above 0"
        ))),
        _ => Ok(()),
    }
}

fn bar(count: usize) -> ProgressBar {
    let style = ProgressStyle::with_template("{bar:30} {pos} of {len} participants, {eta} left")
        .expect("the template is a constant that parses");
    ProgressBar::new(count as u64).with_style(style)
}

/// Plays every session, as many at a time as there are cores; the first failure ends it.
fn play_all(
    lock: &Lock,
    seats: &[Assignment],
    play: impl Fn(&Assignment, &Mutex<&Lock>) -> Result<()> + Sync,
    stop: &AtomicBool,
    progress: &ProgressBar,
) -> Result<()> {
    let next = AtomicUsize::new(0);
    let failure = Mutex::new(None);
    let registers = Mutex::new(lock);
    let worker = || {
        while let Some(assignment) = seats.get(next.fetch_add(1, Ordering::Relaxed)) {
            let failed = failure
                .lock()
                .unwrap_or_else(PoisonError::into_inner)
                .is_some();
            if failed || stop.load(Ordering::Relaxed) {
                return;
            }
            match play(assignment, &registers) {
                Ok(()) => progress.inc(1),
                Err(error) => {
                    let mut failure = failure.lock().unwrap_or_else(PoisonError::into_inner);
                    let who = &assignment.participant;
                    failure.get_or_insert(error.context(format!("participant {who}")));
                    return;
                }
            }
        }
    };
    std::thread::scope(|scope| {
        let cores = std::thread::available_parallelism().map_or(1, usize::from);
        for _ in 0..cores.min(seats.len()) {
            scope.spawn(worker);
        }
    });
    let failure = failure.into_inner().unwrap_or_else(PoisonError::into_inner);
    failure.map_or(Ok(()), Err)
}

fn play_one(
    study: &Study,
    registers: &Mutex<&Lock>,
    assignment: &Assignment,
    threshold: Option<f64>,
    root: &Path,
    stop: &AtomicBool,
) -> Result<()> {
    let consent = simulated_consent(study, DAY)?;
    let slot = assignment.slot;
    let guest = Guest {
        participant: &assignment.participant,
        slot,
        device: "script",
        seed: seed(study, slot),
        notes: vec![Note::Consent(consent.clone())],
        before: None,
    };
    let setup = {
        // The plan's registers are written by one at a time.
        let lock = registers.lock().unwrap_or_else(PoisonError::into_inner);
        study.record_consent(*lock, &assignment.participant, &consent)?;
        seat::setup(study, *lock, guest, root)?
    };
    let attendant = simulated(study, slot, seed(study, slot), threshold);
    let session = bowl(setup, attendant, stop)?;
    session.finish(None, Wanted { video: false }, &mut |_| ())?;
    Ok(())
}
