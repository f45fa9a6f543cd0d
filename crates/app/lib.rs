//! The `bowling` program: who bowls, what is recorded, what is drawn.
//!
//! Entry points: [`run`] reads the command line; [`play`], [`replay`], [`query`], [`hard_cases`],
//! [`shot`], [`strike_map`], [`effects`](mod@effects), [`look`](mod@look), [`accuracy`](mod@accuracy) and [`compare`] are the commands; a [`session::Session`] takes one input per displayed frame from any device.

pub mod accuracy;
pub mod again;
pub mod analyse;
pub mod args;
pub mod boundary;
pub mod capture;
pub mod choose;
pub mod compare;
pub mod convert;
pub mod devices;
pub mod effects;
pub mod fence;
pub mod hard_cases;
pub mod headset;
pub mod hints;
pub mod journal;
pub mod labels;
pub mod lettering;
pub mod look;
pub mod motion;
pub mod output;
pub mod panel;
pub mod pictures;
pub mod play;
pub mod power;
pub mod practice;
pub mod query;
pub mod rehearsal;
pub mod replay;
pub mod root;
pub mod scenery;
pub mod session;
pub mod shot;
pub mod signs;
pub mod sound;
pub mod strike_map;
pub mod study;
pub mod trigger;
pub mod voice;
pub mod window;
pub mod words;
pub mod wrist;

use std::ffi::OsString;
use std::process::ExitCode;

use anyhow::Result;
use clap::{CommandFactory, Parser};

use args::{Arguments, Command};
pub use shot::clock::thread_seconds;

/// Exit code for arguments that cannot be used.
const BAD_ARGUMENTS: u8 = 2;

/// Runs the program with its command line, the program's own name first.
///
/// Returns 0, 1 for a failure, or 2 for arguments that cannot be used.
pub fn run(arguments: impl Iterator<Item = OsString>) -> ExitCode {
    let arguments = match Arguments::try_parse_from(arguments).and_then(Arguments::consistent) {
        Ok(arguments) => arguments,
        Err(error) => {
            let code = if error.use_stderr() { BAD_ARGUMENTS } else { 0 };
            // A closed stream leaves nothing to tell.
            let _ = error.print();
            return ExitCode::from(code);
        }
    };
    match obey(&arguments) {
        Ok(()) => ExitCode::SUCCESS,
        // Arguments that only turned out to be unusable when they were put to use.
        Err(error) if error.is::<clap::Error>() => {
            eprint!("{error}");
            ExitCode::from(BAD_ARGUMENTS)
        }
        // Whoever reads has read enough, as `head` does.
        Err(error) if is_closed(&error) => ExitCode::SUCCESS,
        Err(error) => {
            // The whole chain in one line: what was tried, then why it failed.
            eprintln!("error: {error:#}");
            ExitCode::FAILURE
        }
    }
}

/// Whether the reader of the output has gone. Nothing else of the program writes into a pipe.
fn is_closed(error: &anyhow::Error) -> bool {
    let error = error.downcast_ref::<std::io::Error>();
    error.is_some_and(|error| error.kind() == std::io::ErrorKind::BrokenPipe)
}

fn obey(arguments: &Arguments) -> Result<()> {
    match &arguments.command {
        None => {
            Arguments::command().print_help()?;
            Ok(())
        }
        Some(Command::Play(play)) => play::play(play, &root::find(arguments.root.as_deref())?),
        Some(Command::Replay(arguments)) => replay::replay(&arguments.folder),
        Some(Command::Query(arguments)) => query::query(arguments),
        Some(Command::HardCases(arguments)) => hard_cases::hard_cases(arguments),
        Some(Command::Shot(shot)) => shot::shot(shot, &root::find(arguments.root.as_deref())?),
        Some(Command::Effects(effects)) => {
            effects::effects(effects, &root::find(arguments.root.as_deref())?)
        }
        Some(Command::Look(look)) => look::look(look, &root::find(arguments.root.as_deref())?),
        Some(Command::Accuracy(accuracy)) => {
            accuracy::accuracy(accuracy, &root::find(arguments.root.as_deref())?)
        }
        Some(Command::Analyse(arguments)) => analyse::analyse(arguments),
        Some(Command::Power(arguments)) => power::power(arguments),
        Some(Command::Compare(compare)) => {
            compare::compare(compare, &root::find(arguments.root.as_deref())?)
        }
        Some(Command::Capture(capture)) => {
            capture::capture(capture, &root::find(arguments.root.as_deref())?)
        }
        Some(Command::Study(study)) => study::study(study, &root::find(arguments.root.as_deref())?),
        Some(Command::StrikeMap(map)) => {
            strike_map::strike_map(map, &root::find(arguments.root.as_deref())?)
        }
    }
}
