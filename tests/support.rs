//! What several tests need: folders of their own, and the real program.

use std::path::{Path, PathBuf};
use std::process::{Command, Output};

/// An empty folder for one test; what the last run left there is removed first.
pub fn fresh_folder(name: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
    if folder.exists() {
        std::fs::remove_dir_all(&folder).expect("a test's own folder can be removed");
    }
    std::fs::create_dir_all(&folder).expect("the target folder can be written to");
    folder
}

/// What every new study has to be told of who answers for it.
pub const NEW_STUDY: [&str; 8] = [
    "--laboratory",
    "a test",
    "--contact",
    "nobody",
    "--withdrawal-until",
    "2099-12-31",
    "--retention-until",
    "2099-12-31",
];

/// Runs the program to its end, without a screen.
pub fn bowling(arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_bowling"))
        .args(arguments)
        .env_remove("DISPLAY")
        .env_remove("WAYLAND_DISPLAY")
        .current_dir(env!("CARGO_MANIFEST_DIR"))
        .output()
        .expect("the program starts")
}
