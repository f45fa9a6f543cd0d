//! The files of `plan/` that never change, and the sums that show a changed byte.

use std::fs;
use std::path::Path;

use super::StudyError;
use crate::digest;
use crate::files::{self, FileError};

/// Files of `plan/` that never change.
pub(super) const FIXED: [&str; 5] = [
    "study.toml",
    "allocation.csv",
    "questionnaire.toml",
    "consent.md",
    "salt",
];
pub(super) const SUMS: &str = "SHA256SUMS";

/// Makes the folders of a study and writes these files, in the order of [`FIXED`].
///
/// # Errors
/// When one cannot be written.
pub(super) fn write(root: &Path, texts: &[String; 5]) -> Result<(), FileError> {
    files::create_folder(root)?;
    let folder = root.join("plan");
    files::create_folder(&folder)?;
    files::create_folder(&root.join("data"))?;
    let mut sums = String::new();
    for (name, text) in FIXED.iter().zip(texts) {
        files::write(&folder.join(name), text.as_bytes())?;
        // As `sha256sum` writes and checks it.
        sums += &format!("{}  {name}\n", digest::sha256(text.as_bytes()));
    }
    files::write(&folder.join(SUMS), sums.as_bytes())
}

/// Reads them, in the order of [`FIXED`].
///
/// # Errors
/// When one is missing or was changed.
pub(super) fn read(folder: &Path) -> Result<[String; 5], StudyError> {
    let mut texts: [String; 5] = Default::default();
    let mut sums = String::new();
    for (name, text) in FIXED.iter().zip(&mut texts) {
        let path = folder.join(name);
        let bytes = fs::read(&path).map_err(FileError::at("read", &path))?;
        sums += &format!("{}  {name}\n", digest::sha256(&bytes));
        *text = String::from_utf8(bytes).map_err(|_| StudyError::Changed(path))?;
    }
    let path = folder.join(SUMS);
    let kept = fs::read(&path).map_err(FileError::at("read", &path))?;
    if kept == sums.as_bytes() {
        return Ok(texts);
    }
    let kept = String::from_utf8_lossy(&kept);
    let changed = FIXED
        .iter()
        .zip(sums.lines())
        .find(|(_, line)| !kept.lines().any(|kept| kept == *line));
    let name = changed.map_or(SUMS, |(name, _)| name);
    Err(StudyError::Changed(folder.join(name)))
}
