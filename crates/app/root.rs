//! Finds the folder with the program's data: `config/`, `assets/` and `shaders/`.

use std::path::{Path, PathBuf};

use anyhow::{Result, bail};

/// Every data folder has this file.
const MARK: &str = "config/default.toml";

/// The folder that was asked for, else the first that holds the data: above the program, the
/// current one, the one that the program was built in.
///
/// # Errors
/// When none holds `config/default.toml`.
pub fn find(asked: Option<&Path>) -> Result<PathBuf> {
    if let Some(folder) = asked {
        if folder.join(MARK).is_file() {
            return Ok(folder.to_path_buf());
        }
        bail!(
            "{} holds no {MARK}: give the folder that holds config/ and assets/",
            folder.display()
        );
    }
    let program = std::env::current_exe().ok();
    let above = program.iter().flat_map(|path| path.ancestors().skip(1));
    let others = [Path::new("."), Path::new(env!("CARGO_MANIFEST_DIR"))];
    match above
        .chain(others)
        .find(|folder| folder.join(MARK).is_file())
    {
        Some(folder) => Ok(folder.to_path_buf()),
        None => bail!(
            "the program's data ({MARK} and the rest) was not found beside the program or in the current folder: start it from the project's folder"
        ),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn find_names_the_folder_that_lacks_the_data() {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let error = find(Some(folder.path()))
            .expect_err("it is empty")
            .to_string();
        assert!(
            error.contains(&folder.path().display().to_string()) && error.contains(MARK),
            "{error}"
        );
    }

    #[test]
    fn find_takes_the_folder_that_was_asked_for() {
        let folder = tempfile::tempdir().expect("a temporary folder");
        std::fs::create_dir(folder.path().join("config")).expect("writable");
        std::fs::write(folder.path().join(MARK), "").expect("writable");
        assert_eq!(
            find(Some(folder.path())).expect("it has the mark"),
            folder.path()
        );
    }
}
