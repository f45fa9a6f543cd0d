//! `bowling study run` and `resume`: a participant's session, with whatever device there is.

use std::path::Path;
use std::sync::atomic::{AtomicBool, Ordering};

use anyhow::{Context, Result, bail};
use experiment::consent::{Consent, Ticks};
use experiment::participant::{Model, Simulated};
use experiment::protocol::Note;
use experiment::random::SplitMix64;
use experiment::staircase::{Observer, StaircasePlan};
use experiment::study::{Lock, ParticipantId, Study};
use winit::event_loop::EventLoop;

use super::attendant::{Attendance, Attendant};
use super::console::Console;
use super::folder;
use super::gate;
use super::seat::{self, Guest};
use super::{entropy, tables, today, utc_now};
use crate::args::{DeviceChoice, ResumeArguments, RunArguments};
use crate::choose::{self, Choice, Machine};
use crate::devices::Device;
use crate::devices::script::{Script, Velocities};
use crate::pictures::Wanted;
use crate::session::{Session, Setup};
use crate::{headset, play, rehearsal, window};

/// Runs a session from its beginning.
///
/// # Errors
/// When nobody agreed, the participant has begun already, or anything a session needs is missing.
pub fn run(arguments: &RunArguments, root: &Path) -> Result<()> {
    let study = Study::open(&arguments.folder)?;
    let lock = study.lock()?;
    let choice = device(arguments.device)?;
    let known = match arguments.participant.as_str() {
        "new" => None,
        id => Some(not_begun(&study, id)?),
    };
    let (consent, attendance) = if is_script(choice) {
        (simulated_consent(&study, &today())?, None)
    } else {
        let console = Console::listen()?;
        let (consent, events) = gate::pass(&study, &console)?;
        (consent, Some(attended(console, events)))
    };
    let now = utc_now();
    let participant = match known {
        Some(participant) => participant,
        None => study.admit(&lock, entropy())?.participant,
    };
    study.record_consent(&lock, &participant, &consent)?;
    println!("Participant {participant}.");
    let notes = vec![Note::Consent(consent), clock(now, 0.0)];
    let guest = guest(&study, &participant, choice, notes)?;
    let device = (choice, arguments.headset.refresh_rate);
    sit(&study, &lock, guest, device, attendance, root)
}

/// The experimenter at the terminal, and the window system where a window was opened already.
fn attended(console: Console, events: Option<EventLoop<()>>) -> Attendance {
    Attendance {
        attendant: Attendant::Console(Box::new(console)),
        events,
    }
}

/// Takes up a session that was broken off.
///
/// # Errors
/// When there is none, or its journals cannot be played again.
pub fn resume(arguments: &ResumeArguments, root: &Path) -> Result<()> {
    let study = Study::open(&arguments.folder)?;
    let lock = study.lock()?;
    let choice = device(arguments.device)?;
    let participant = match &arguments.participant {
        Some(id) => ParticipantId::parse(id)?,
        None => folder::broken_off(&study)?,
    };
    let progress = folder::progress(&study, &participant)?
        .with_context(|| format!("{participant} has not begun: `bowling study run` begins"))?;
    if !progress.is_open() {
        bail!(
            "the session of {participant} is {}: there is nothing to resume",
            folder::place_text(progress.protocol.place())
        );
    }
    if let Some(torn) = progress.story.torn {
        println!("{}: {torn}.", progress.path.display());
    }
    let (continues, story) = progress.cut()?;
    println!(
        "Participant {participant}: goes on behind frame {} of the recording.",
        continues.inputs
    );
    let notes = vec![clock(utc_now(), 0.0)];
    let mut guest = guest(&study, &participant, choice, notes)?;
    guest.before = Some((continues, story));
    let attendance = if is_script(choice) {
        None
    } else {
        Some(attended(Console::listen()?, None))
    };
    let device = (choice, arguments.headset.refresh_rate);
    sit(&study, &lock, guest, device, attendance, root)
}

const ALL_TICKS: Ticks = Ticks {
    take_part: true,
    share_data: true,
    share_motion: true,
    contact: false,
};

fn clock(utc: String, at_s: f64) -> Note {
    Note::Clock { utc, at_s }
}

fn is_script(choice: Choice) -> bool {
    matches!(choice, Choice::ScriptWindow | Choice::ScriptOffscreen)
}

fn device(wanted: Option<DeviceChoice>) -> Result<Choice> {
    // What was found is let go: the consent is asked for first, and nobody listens to a runtime meanwhile.
    let (machine, _) = Machine::look(wanted, false);
    let (choice, why) = choose::choose(wanted, false, &machine)?;
    println!("{why}");
    Ok(choice)
}

/// A participant who has a slot and no journal.
fn not_begun(study: &Study, id: &str) -> Result<ParticipantId> {
    let participant = ParticipantId::parse(id)?;
    study.slot_of(&participant)?;
    if folder::progress(study, &participant)?.is_some() {
        bail!(
            "{participant} has begun already, and nothing is overwritten: `bowling study resume` goes on where a session was broken off"
        );
    }
    Ok(participant)
}

fn guest<'a>(
    study: &Study,
    participant: &'a ParticipantId,
    choice: Choice,
    notes: Vec<Note>,
) -> Result<Guest<'a>> {
    let slot = study.slot_of(participant)?;
    Ok(Guest {
        participant,
        slot,
        device: choice.device(),
        seed: seed(study, slot),
        notes,
        before: None,
    })
}

/// Seed of the simulated participant in `slot`.
pub fn seed(study: &Study, slot: u32) -> u64 {
    SplitMix64::for_index(study.plan().seed, u64::from(slot)).next_u64()
}

/// The session, from the first frame to the tables; without anybody attending a simulated participant answers. A headset is asked for
/// a refresh rate [Hz], where one is given.
fn sit(
    study: &Study,
    lock: &Lock,
    guest: Guest,
    (choice, refresh_rate): (Choice, Option<f32>),
    attendance: Option<Attendance>,
    root: &Path,
) -> Result<()> {
    let (slot, seed) = (guest.slot, guest.seed);
    let setup = seat::setup(study, lock, guest, root)?;
    let attendance = attendance.unwrap_or_else(|| Attendance {
        attendant: simulated(study, slot, seed, None),
        events: None,
    });
    if let Attendant::Console(console) = &attendance.attendant {
        console.introduce();
    }
    let wanted = Wanted { video: false };
    match choice {
        Choice::ScriptOffscreen => {
            let stop = play::interruption()?;
            let session = bowl(setup, attendance.attendant, &stop)?;
            session.finish(None, wanted, &mut |_| ())?;
        }
        Choice::Headset => {
            let headset = (choose::find()?, headset::asking_for(refresh_rate));
            headset::run(setup, root, wanted, headset, Some(attendance))?;
        }
        Choice::DeskWindow | Choice::ScriptWindow => {
            window::run(setup, root, wanted, choice, Some(attendance))?;
        }
    }
    tables::write(study, lock)?;
    println!("Tables in {}.", study.data_folder().display());
    Ok(())
}

/// A simulated participant for `slot`, who calls a difference of `threshold`, in the parameter's unit, different 70.7 % of the time.
pub fn simulated(study: &Study, slot: u32, seed: u64, threshold: Option<f64>) -> Attendant {
    let person = Simulated::new(
        &Model::TABLE_6,
        study.questionnaire(),
        &study.plan().design(),
        study.row(slot),
        seed,
    );
    let range = study
        .plan()
        .staircase
        .as_ref()
        .map_or(1.0, StaircasePlan::range);
    let observer = Observer {
        target: threshold.map_or(USUAL_TARGET, |threshold| threshold / range),
        false_alarms: USUAL_FALSE_ALARMS,
    };
    Attendant::simulated(person, observer, seed)
}

/// What a simulated participant tells apart where nobody says, as a part of the range.
const USUAL_TARGET: f64 = 0.25;
/// How often one calls two equal throws different.
const USUAL_FALSE_ALARMS: f64 = 0.08;

/// A scripted participant plays a session through as fast as the machine can; it is not yet finished.
///
/// # Errors
/// When the journal cannot be written, or the script does not get through; the journal is in order then.
pub fn bowl(setup: Setup, mut attendant: Attendant, stop: &AtomicBool) -> Result<Session> {
    let (games, training) = setup.keep.script();
    let config = &setup.conditions.lobby;
    let mut script =
        Script::new(config, setup.seed, Velocities::Measured, &games).practising(training);
    let longest = rehearsal::patience(setup.frames, 2 + training as usize);
    let mut session = Session::start(setup)?;
    while !session.is_over() && !stop.load(Ordering::Relaxed) {
        attendant.attend(&mut session)?;
        if session.is_over() {
            break;
        }
        let input = if session.is_asking() {
            script.wait(session.game())
        } else {
            script.next(session.game())
        };
        session.frame(input)?;
        if session.game().time() > longest {
            bail!(
                "the scripted participant got stuck after {longest:.0} simulated seconds: with these settings it cannot finish a game"
            );
        }
    }
    Ok(session)
}

/// What a simulated participant agrees to.
///
/// # Errors
/// When the study's form cannot be agreed to.
pub fn simulated_consent(study: &Study, date: &str) -> Result<Consent> {
    Ok(study.consent_form().agree(ALL_TICKS, date)?)
}
