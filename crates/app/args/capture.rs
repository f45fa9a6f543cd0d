//! Arguments of `bowling capture`.

use std::path::PathBuf;

use clap::{Args, ValueEnum};

use super::DisplayChoice;

/// Whose eyes a picture is seen with.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum ViewChoice {
    /// The participant's, both; the bird's while the head was not tracked.
    Eye,
    /// From under the ceiling, the approach and the lane down to the pins.
    Bird,
}

/// Arguments of `bowling capture`.
#[derive(Debug, Args)]
pub struct CaptureArguments {
    /// Folder of a recording or of a study's session, or its journal.
    #[arg(value_name = "SESSION")]
    pub session: PathBuf,

    /// When, in seconds since the session began.
    #[arg(long, value_name = "S", allow_negative_numbers = true, value_parser = time)]
    pub at: f64,

    /// Film up to this time instead of drawing one picture.
    #[arg(long, value_name = "S", allow_negative_numbers = true, value_parser = time)]
    pub until: Option<f64>,

    /// Display that is imitated [default: that of the session].
    #[arg(long, value_enum)]
    pub profile: Option<DisplayChoice>,

    /// Whose eyes.
    #[arg(long, value_enum, default_value = "eye")]
    pub view: ViewChoice,

    /// The file [default: capture.png or capture.avi here].
    #[arg(long, value_name = "FILE")]
    pub out: Option<PathBuf>,
}

fn time(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(seconds) if (0.0..=1e6).contains(&seconds) => Ok(seconds),
        _ => Err("give seconds from 0 up".to_owned()),
    }
}
