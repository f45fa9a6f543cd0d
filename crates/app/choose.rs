//! Chooses who bowls and where it is shown, and says why in one sentence.

use std::time::Duration;

use anyhow::{Result, bail};
use renderer::headset::{Found, HeadsetError};

use crate::args::DeviceChoice;
use crate::headset::answered;

/// How long a runtime may take to say whether it has a headset: some start their programs first.
const LONGEST_SILENCE: Duration = Duration::from_secs(20);

/// What the program will run with.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Choice {
    /// A person in a headset.
    Headset,
    /// A person at a desk, in a window.
    DeskWindow,
    /// The scripted participant, watched in a window.
    ScriptWindow,
    /// The scripted participant, pictures to files.
    ScriptOffscreen,
}

impl Choice {
    /// Who bowls, as a journal has it.
    pub fn device(self) -> &'static str {
        match self {
            Self::Headset => "headset",
            Self::DeskWindow => "desk",
            Self::ScriptWindow | Self::ScriptOffscreen => "script",
        }
    }
}

/// What the machine offers, found out by the caller so that the choice can be tested.
#[derive(Debug, Clone)]
pub struct Machine {
    /// The headset's name; `Err` holds the sentence that says why none can be used.
    pub headset: Result<String, String>,
    /// `Err` holds the sentence that says why no window can be opened.
    pub window: Result<(), String>,
}

impl Machine {
    /// Looks for a display server and, where a headset may be chosen, for one: asking for it may start its runtime.
    pub fn look(device: Option<DeviceChoice>, offscreen: bool) -> (Self, Option<Found>) {
        let may_be_headset = !offscreen && matches!(device, None | Some(DeviceChoice::Headset));
        let asked = may_be_headset.then(find);
        let (headset, found) = match asked {
            Some(Ok(found)) => {
                let headset = found.headset();
                let name = format!("{} on {}", headset.system, headset.runtime);
                (Ok(name), Some(found))
            }
            Some(Err(error)) => (Err(error.to_string()), None),
            None => (Err("none was asked for".to_owned()), None),
        };
        let machine = Machine {
            headset,
            window: display(),
        };
        (machine, found)
    }
}

/// Finds the headset, in a runtime that answers.
///
/// # Errors
/// Why there is none.
pub fn find() -> Result<Found, HeadsetError> {
    answered(LONGEST_SILENCE, || false, Found::look).unwrap_or(Err(HeadsetError::Silent))
}

/// Whether a window can be hoped for on this machine.
///
/// # Errors
/// Why not.
pub fn display() -> Result<(), String> {
    window_possible(|name| std::env::var_os(name).is_some())
}

/// Whether a window can be hoped for; opening it may still fail, with its own sentence.
fn window_possible(is_set: impl Fn(&str) -> bool) -> Result<(), String> {
    let needs_display_server = cfg!(all(unix, not(target_os = "macos")));
    if !needs_display_server || is_set("DISPLAY") || is_set("WAYLAND_DISPLAY") {
        Ok(())
    } else {
        Err("neither DISPLAY nor WAYLAND_DISPLAY is set".to_owned())
    }
}

/// Picks by the arguments and by what the machine offers; the sentence is for the person.
///
/// # Errors
/// When a device is asked for that is not there.
pub fn choose(
    device: Option<DeviceChoice>,
    offscreen: bool,
    machine: &Machine,
) -> Result<(Choice, String)> {
    use DeviceChoice::{Desk, Headset, Script};
    match (device, offscreen) {
        // What needs a display was refused with the arguments.
        (_, true) => Ok((
            Choice::ScriptOffscreen,
            "Scripted participant without a screen, as asked for.".to_owned(),
        )),
        (Some(Headset), false) => match &machine.headset {
            Ok(name) => Ok((Choice::Headset, format!("Headset {name}, as asked for."))),
            Err(why) => bail!(
                "No headset: {}. Use --device desk or --device script, or leave --device out",
                without_full_stop(why)
            ),
        },
        (Some(Desk), false) => match &machine.window {
            Ok(()) => Ok((
                Choice::DeskWindow,
                "Desk in a window, as asked for.".to_owned(),
            )),
            Err(why) => bail!("No window: {why}. Start from a desktop, or use --offscreen"),
        },
        (Some(Script), false) if machine.window.is_ok() => Ok((
            Choice::ScriptWindow,
            "Scripted participant in a window, as asked for; --offscreen does without the window."
                .to_owned(),
        )),
        (Some(Script), false) => Ok((
            Choice::ScriptOffscreen,
            format!(
                "Scripted participant as asked for, without a window: {}.",
                window_reason(machine)
            ),
        )),
        (None, false) => Ok(first_there(machine)),
    }
}

fn first_there(machine: &Machine) -> (Choice, String) {
    let no_headset = match &machine.headset {
        Ok(name) => {
            let why = format!("Headset {name}, because it is there; --device desk does without.");
            return (Choice::Headset, why);
        }
        Err(why) => without_full_stop(why),
    };
    match &machine.window {
        Ok(()) => (
            Choice::DeskWindow,
            format!("Desk in a window, because there is a display and no headset ({no_headset})."),
        ),
        Err(why) => (
            Choice::ScriptOffscreen,
            format!(
                "Scripted participant without a screen, because there is no headset ({no_headset}) \
                 and no window ({why})."
            ),
        ),
    }
}

fn window_reason(machine: &Machine) -> &str {
    machine
        .window
        .as_ref()
        .err()
        .map_or("none was asked for", String::as_str)
}

fn without_full_stop(sentence: &str) -> &str {
    sentence.trim_end().trim_end_matches('.')
}

#[cfg(test)]
mod tests {
    use super::*;

    fn machine(window: bool) -> Machine {
        Machine {
            headset: Err("no OpenXR loader is installed.".to_owned()),
            window: if window {
                Ok(())
            } else {
                Err("DISPLAY is not set".to_owned())
            },
        }
    }

    #[test]
    fn choose_takes_the_window_when_there_is_one() {
        let (choice, why) = choose(None, false, &machine(true)).expect("a choice");
        assert_eq!(choice, Choice::DeskWindow);
        assert!(why.contains("no OpenXR loader is installed)"), "{why}");
    }

    #[test]
    fn choose_falls_back_to_the_script_and_names_both_reasons() {
        let (choice, why) = choose(None, false, &machine(false)).expect("a choice");
        assert_eq!(choice, Choice::ScriptOffscreen);
        assert!(
            why.contains("no OpenXR loader") && why.contains("DISPLAY is not set"),
            "{why}"
        );
    }

    #[test]
    fn choose_takes_the_headset_where_there_is_one() {
        let machine = Machine {
            headset: Ok("Index on Monado".to_owned()),
            ..machine(true)
        };
        let (choice, why) = choose(None, false, &machine).expect("a choice");
        assert_eq!(choice, Choice::Headset);
        assert!(why.contains("Index on Monado"), "{why}");
        let (choice, _) = choose(Some(DeviceChoice::Desk), false, &machine).expect("a choice");
        assert_eq!(choice, Choice::DeskWindow);
    }

    #[test]
    fn choose_offscreen_wins_over_a_display() {
        let (choice, _) = choose(None, true, &machine(true)).expect("a choice");
        assert_eq!(choice, Choice::ScriptOffscreen);
    }

    #[test]
    fn choose_reports_the_missing_headset() {
        let error =
            choose(Some(DeviceChoice::Headset), false, &machine(true)).expect_err("none there");
        assert!(error.to_string().contains("no OpenXR loader"), "{error}");
    }

    #[test]
    fn window_possible_needs_a_display_server_on_linux() {
        assert!(window_possible(|name| name == "WAYLAND_DISPLAY").is_ok());
        if cfg!(target_os = "linux") {
            assert!(window_possible(|_| false).is_err());
        }
    }
}
