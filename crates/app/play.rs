//! `bowling play`: sets up a session with the chosen device and runs it to its end.

use std::io::{IsTerminal, Write};
use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Instant, SystemTime};

use anyhow::{Context, Result, bail};
use game::{Button, Conditions, EventKind};

use crate::args::PlayArguments;
use crate::choose::{self, Choice, Machine};
use crate::devices::Device;
use crate::devices::script::{Script, Velocities};
use crate::headset;
use crate::output;
use crate::pictures::{Painter, Wanted};
use crate::practice;
use crate::rehearsal;
use crate::session::{Keep, Session, Setup, Summary};
use crate::window;
use crate::words::Words;

/// Scene when none is asked for.
const DEFAULT_SCENE: &str = "alley";
/// Plays as the arguments say, with the data in `root`.
///
/// # Errors
/// One sentence for everything that keeps the session from its end.
pub fn play(arguments: &PlayArguments, root: &Path) -> Result<()> {
    let (machine, found) = Machine::look(arguments.device, arguments.offscreen);
    let (choice, why) = choose::choose(arguments.device, arguments.offscreen, &machine)?;
    println!("{why}");
    let scene = arguments
        .scene
        .clone()
        .unwrap_or_else(|| DEFAULT_SCENE.to_owned());
    // Mouse and script have no body to measure; who wants the gesture there says so.
    let mut settings = match choice {
        Choice::Headset => Vec::new(),
        _ => vec!["calibration.gesture=false".to_owned()],
    };
    settings.extend_from_slice(&arguments.settings);
    if let Some(display) = arguments.display {
        settings.push(format!("display.profile=\"{}\"", display.name()));
    }
    if let Some(words) = &arguments.words {
        settings.push(format!(
            "guidance.words={}",
            toml::Value::from(words.as_str())
        ));
    }
    let mut conditions = Conditions::load(&root.join("config"), &scene, &settings)?;
    if arguments.practice {
        settings.extend(practice::settings(arguments, &conditions)?);
        conditions = Conditions::load(&root.join("config"), &scene, &settings)?;
    }
    // Before anything is opened: words that are not whole must not stop a session later.
    Words::load(root, &conditions.lobby)?;
    let folder = arguments
        .out
        .clone()
        .unwrap_or_else(|| output::default_folder(arguments.seed, SystemTime::now()));
    let setup = Setup {
        rate_hz: conditions.lobby.tracking.rate_hz,
        conditions,
        scene,
        frames: arguments.frames,
        seed: arguments.seed,
        device: choice.device(),
        keep: Keep::Recording(folder),
    };
    let wanted = Wanted {
        video: !arguments.no_video,
    };
    match choice {
        Choice::ScriptOffscreen => offscreen(setup, root, wanted),
        Choice::Headset => {
            let found = found.context("a headset is chosen only where one was found")?;
            let headset = (found, headset::asking_for(arguments.headset.refresh_rate));
            headset::run(setup, root, wanted, headset, None)
        }
        Choice::DeskWindow | Choice::ScriptWindow => window::run(setup, root, wanted, choice, None),
    }
}

/// What is said after Ctrl-C.
const INTERRUPTED: &str = "Interrupted: the recording is in order up to here; pictures that were not finished are left out.";

/// Turned on by Ctrl-C (or a request to terminate): the loop ends in order after its frame.
///
/// # Errors
/// When the system takes no handler.
pub fn interruption() -> Result<Arc<AtomicBool>> {
    let flag = Arc::new(AtomicBool::new(false));
    let raised = Arc::clone(&flag);
    ctrlc::set_handler(move || raised.store(true, Ordering::Relaxed))
        .context("cannot listen for Ctrl-C")?;
    Ok(flag)
}

/// Ends a session that went well: writes its files, draws its pictures where there is a painter, and reports.
///
/// # Errors
/// When a file cannot be written or a picture cannot be drawn.
pub fn close(
    session: Session,
    mut painter: Option<Painter>,
    wanted: Wanted,
    mut progress: Progress,
) -> Result<Summary> {
    let summary = session.finish(painter.as_mut(), wanted, &mut |text| progress.say(text))?;
    progress.end();
    if painter.is_some_and(|painter| painter.is_stopped()) {
        println!("{INTERRUPTED}");
    }
    report(&summary);
    Ok(summary)
}

/// The scripted participant plays both games without a screen, as fast as the machine can.
fn offscreen(setup: Setup, root: &Path, wanted: Wanted) -> Result<()> {
    // Before anything is written: a missing driver or asset must not cost a game.
    let stop = interruption()?;
    let painter = Painter::new(root, &setup.conditions.lobby)?.stopped_by(Arc::clone(&stop));
    let mut script = scripted(&setup);
    let frames = setup.frames;
    let started = Instant::now();
    let mut session = Session::start(setup)?;
    let mut progress = Progress::new();
    let run = simulate(&mut session, &mut script, frames, &stop, &mut progress);
    let simulated_in = started.elapsed().as_secs_f64();
    if let Err(error) = run {
        progress.end();
        // The journal is what tells what went wrong: close it in order before reporting.
        session.finish(None, wanted, &mut |_| ())?;
        return Err(error);
    }
    let simulated_s = close(session, Some(painter), wanted, progress)?.simulated_s;
    println!(
        "{simulated_s:.0} simulated seconds in {simulated_in:.1} s, pictures in {:.1} s.",
        started.elapsed().as_secs_f64() - simulated_in
    );
    Ok(())
}

/// The scripted participant of a session: both games, or a throw for each frame of practice.
pub fn scripted(setup: &Setup) -> Script {
    let config = &setup.conditions.lobby;
    let (games, throws) = if config.practice.only {
        (Vec::new(), setup.frames)
    } else {
        setup.keep.script()
    };
    Script::new(config, setup.seed, Velocities::Measured, &games).practising(throws)
}

fn simulate(
    session: &mut Session,
    script: &mut Script,
    frames: u32,
    stop: &AtomicBool,
    progress: &mut Progress,
) -> Result<()> {
    let longest = rehearsal::patience(frames, Button::BOTH.len());
    while !script.is_done() && !stop.load(Ordering::Relaxed) {
        let input = script.next(session.game());
        session.frame(input)?;
        for event in session.game().events() {
            if let Some(text) = progress_text(&event.kind, frames) {
                progress.say(&text);
            }
        }
        if session.game().time() > longest {
            bail!(
                "the scripted participant got stuck after {longest:.0} simulated seconds: with these settings it cannot finish a game (journal in {})",
                session.folder().display()
            );
        }
    }
    Ok(())
}

fn progress_text(event: &EventKind, frames: u32) -> Option<String> {
    match event {
        EventKind::GameStarted { button } => Some(format!("{button}: frame 1 of {frames}")),
        EventKind::FrameScored {
            button,
            frame,
            total,
            ..
        } if *frame < frames => Some(format!(
            "{button}: frame {} of {frames}, {total} so far",
            frame + 1
        )),
        EventKind::GameOver { button, total } => Some(format!("{button}: over, {total} pins")),
        _ => None,
    }
}

/// Prints what a session left: score sheets, files, hash, refusals.
fn report(summary: &Summary) {
    for sheet in &summary.sheets {
        println!("\n{sheet}");
    }
    println!("Files:");
    for file in &summary.files {
        println!("  {}", file.display());
    }
    if !summary.refused.is_none() {
        println!(
            "Readings of the device that were no numbers and were refused: {}.",
            summary.refused
        );
    }
    println!("State hash {}", summary.hash);
    if let Some(folder) = summary.files.first().and_then(|file| file.parent()) {
        let program = std::env::current_exe().unwrap_or_else(|_| "bowling".into());
        let folder = folder.canonicalize().unwrap_or_else(|_| folder.to_owned());
        println!(
            "Check it with: {} replay {}",
            shell_word(&program),
            shell_word(&folder)
        );
    }
}

fn shell_word(path: &Path) -> String {
    let text = path.display().to_string();
    if text.contains(char::is_whitespace) {
        format!("'{text}'")
    } else {
        text
    }
}

/// One line that is written over on a terminal, and plain lines elsewhere.
#[derive(Debug)]
pub struct Progress {
    is_terminal: bool,
    written: usize,
}

impl Progress {
    /// Progress on the standard error stream, so that the standard output holds the results alone.
    pub fn new() -> Self {
        Progress {
            is_terminal: std::io::stderr().is_terminal(),
            written: 0,
        }
    }

    /// Shows `text`.
    pub fn say(&mut self, text: &str) {
        let mut stream = std::io::stderr().lock();
        // A closed stream is no reason to end a session.
        let _ = if self.is_terminal {
            let result = write!(stream, "\r{text:<width$}", width = self.written);
            self.written = text.len();
            stream.flush().and(result)
        } else {
            writeln!(stream, "{text}")
        };
    }

    /// Leaves the line.
    pub fn end(&mut self) {
        if self.is_terminal && self.written > 0 {
            eprintln!();
            self.written = 0;
        }
    }
}

impl Default for Progress {
    fn default() -> Self {
        Self::new()
    }
}
