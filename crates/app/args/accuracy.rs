//! Arguments of `bowling accuracy`.

use std::path::PathBuf;

use clap::Args;

/// Arguments of `bowling accuracy`.
#[derive(Debug, Args)]
pub struct AccuracyArguments {
    /// Fewer poses, throws and rounds: under a minute, coarser figures.
    #[arg(long)]
    pub quick: bool,

    /// Folder for accuracy.csv and the figures.
    #[arg(long, value_name = "DIR", default_value = "out/accuracy")]
    pub out: PathBuf,

    /// Only this dial, and no overlay.
    #[arg(long, value_name = "NAME", value_parser = crate::accuracy::known_dial)]
    pub dial: Option<String>,
}
