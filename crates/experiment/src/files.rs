//! Files that are there whole or not at all, readable by their owner alone.
//!
//! A file is written beside its place, synced, renamed, and its folder synced; a program that is killed leaves the old file or the
//! new one, and at worst a draft named `.NAME.part`.

use std::fs::{self, DirBuilder, File, OpenOptions};
use std::io::{self, Write};
use std::path::{Path, PathBuf};

/// What a draft's name ends with.
pub const DRAFT: &str = ".part";

/// A file or folder that could not be read or written.
#[derive(Debug, thiserror::Error)]
#[error("cannot {action} {path}: {problem}; {}", advice(problem))]
pub struct FileError {
    /// What was tried, as a verb.
    pub action: &'static str,
    /// Which file or folder.
    pub path: PathBuf,
    /// What the system said.
    pub problem: io::Error,
}

impl FileError {
    /// For use in `map_err`.
    pub fn at(action: &'static str, path: &Path) -> impl FnOnce(io::Error) -> FileError {
        let path = path.to_path_buf();
        move |problem| FileError {
            action,
            path,
            problem,
        }
    }
}

fn advice(error: &io::Error) -> &'static str {
    match error.kind() {
        io::ErrorKind::StorageFull | io::ErrorKind::QuotaExceeded => {
            "the disk is full and what was there before is unchanged: free some space and try again"
        }
        io::ErrorKind::PermissionDenied | io::ErrorKind::ReadOnlyFilesystem => {
            "choose a folder that this account may write to"
        }
        io::ErrorKind::NotFound => "check the path",
        io::ErrorKind::AlreadyExists => "nothing is overwritten: choose another name",
        _ => "check the disk and the path",
    }
}

/// Replaces the file at `path`, or makes it, so that it is there whole or not at all.
///
/// # Errors
/// When a step fails; the file is then as it was, and the draft is gone.
pub fn write(path: &Path, bytes: &[u8]) -> Result<(), FileError> {
    let draft = draft_of(path);
    let written = write_draft(&draft, bytes).and_then(|()| fs::rename(&draft, path));
    if written.is_err() {
        // The disk may be full; what remains of the draft is of no use, and its absence is no error.
        fs::remove_file(&draft).ok();
    }
    written.map_err(FileError::at("write", path))?;
    sync_folder(path)
}

/// The draft that [`write()`] makes on the way to `path`.
pub fn draft_of(path: &Path) -> PathBuf {
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    path.with_file_name(format!(".{name}{DRAFT}"))
}

fn write_draft(draft: &Path, bytes: &[u8]) -> io::Result<()> {
    // One that a killed program left has perhaps other rights.
    match fs::remove_file(draft) {
        Err(error) if error.kind() != io::ErrorKind::NotFound => return Err(error),
        _ => {}
    }
    let mut file = private(OpenOptions::new().write(true).create_new(true)).open(draft)?;
    file.write_all(bytes)?;
    file.sync_all()
}

/// Appends one line to a file that only grows, and syncs it.
///
/// # Errors
/// When the file cannot be opened or written; it ends as before then.
pub fn append_line(path: &Path, line: &str) -> Result<(), FileError> {
    let failed = || FileError::at("append to", path);
    let made = !path.exists();
    let mut file = private(OpenOptions::new().append(true).create(true))
        .open(path)
        .map_err(failed())?;
    let before = file.metadata().map_err(failed())?.len();
    let appended = file
        .write_all(format!("{line}\n").as_bytes())
        .and_then(|()| file.sync_all());
    if let Err(error) = appended {
        // A full disk takes part of a line. What was there before is whole without it.
        file.set_len(before).ok();
        return Err(failed()(error));
    }
    if made { sync_folder(path) } else { Ok(()) }
}

/// Makes `path` and the folders above it that are missing, each for its owner alone.
///
/// # Errors
/// When one cannot be made.
pub fn create_folder(path: &Path) -> Result<(), FileError> {
    let mut builder = DirBuilder::new();
    builder.recursive(true);
    #[cfg(unix)]
    std::os::unix::fs::DirBuilderExt::mode(&mut builder, 0o700);
    builder
        .create(path)
        .map_err(FileError::at("make the folder", path))
}

/// The text of a file.
///
/// # Errors
/// When it cannot be read or is not UTF-8.
pub fn read(path: &Path) -> Result<String, FileError> {
    fs::read_to_string(path).map_err(FileError::at("read", path))
}

/// Every file below `folder`, folders in the order of their names; links are listed, not followed.
///
/// # Errors
/// When a folder cannot be read.
pub fn list(folder: &Path) -> Result<Vec<PathBuf>, FileError> {
    let mut files = Vec::new();
    let mut entries: Vec<_> = fs::read_dir(folder)
        .and_then(Iterator::collect::<io::Result<_>>)
        .map_err(FileError::at("list", folder))?;
    entries.sort_by_key(fs::DirEntry::file_name);
    for entry in entries {
        let kind = entry
            .file_type()
            .map_err(FileError::at("look at", &entry.path()))?;
        if kind.is_dir() {
            files.extend(list(&entry.path())?);
        } else {
            files.push(entry.path());
        }
    }
    Ok(files)
}

/// Removes a file, or a folder with all that is in it; what is not there is fine.
///
/// # Errors
/// When something that is there cannot be removed.
pub fn remove(path: &Path) -> Result<(), FileError> {
    let removed = match fs::symlink_metadata(path) {
        Ok(found) if found.is_dir() => fs::remove_dir_all(path),
        Ok(_) => fs::remove_file(path),
        Err(error) => Err(error),
    };
    match removed {
        Err(error) if error.kind() == io::ErrorKind::NotFound => Ok(()),
        Err(error) => Err(FileError::at("remove", path)(error)),
        Ok(()) => sync_folder(path),
    }
}

/// Sets the rights of a file that is about to be made: read and written by its owner alone.
pub fn private(options: &mut OpenOptions) -> &mut OpenOptions {
    #[cfg(unix)]
    std::os::unix::fs::OpenOptionsExt::mode(options, 0o600);
    options
}

/// A new name in a folder outlasts a power cut only when the folder is synced too.
fn sync_folder(path: &Path) -> Result<(), FileError> {
    let folder = match path.parent() {
        Some(parent) if !parent.as_os_str().is_empty() => parent,
        _ => Path::new("."),
    };
    // Only Unix opens folders.
    if cfg!(unix) {
        File::open(folder)
            .and_then(|folder| folder.sync_all())
            .map_err(FileError::at("sync", folder))?;
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::os::unix::fs::PermissionsExt;

    fn mode(path: &Path) -> u32 {
        fs::metadata(path).unwrap().permissions().mode() & 0o777
    }

    #[test]
    fn write_replaces_and_leaves_no_draft() {
        let folder = tempfile::tempdir().unwrap();
        let deep = folder.path().join("a/b");
        create_folder(&deep).unwrap();
        let path = deep.join("table.tsv");
        // As a killed program leaves it.
        fs::write(draft_of(&path), "torn").unwrap();
        write(&path, b"one").unwrap();
        write(&path, b"two").unwrap();
        assert_eq!(read(&path).unwrap(), "two");
        assert_eq!(list(folder.path()).unwrap(), std::slice::from_ref(&path));
        assert_eq!(
            (mode(&path), mode(&deep), mode(&folder.path().join("a"))),
            (0o600, 0o700, 0o700)
        );
    }

    #[test]
    fn write_that_fails_keeps_the_old_file_and_says_why() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("table.tsv");
        write(&path, b"old").unwrap();
        // A folder where the draft goes: it can neither be removed as a file nor replaced.
        fs::create_dir(draft_of(&path)).unwrap();
        let error = write(&path, b"new").unwrap_err().to_string();
        assert!(error.starts_with("cannot write "), "{error}");
        assert_eq!(read(&path).unwrap(), "old");
        let missing = read(&folder.path().join("none")).unwrap_err().to_string();
        assert!(missing.ends_with("check the path"), "{missing}");
    }

    #[test]
    fn append_line_to_a_full_disk_says_so() {
        let error = append_line(Path::new("/dev/full"), "line").unwrap_err();
        assert!(error.to_string().contains("the disk is full"), "{error}");
    }

    #[test]
    fn remove_takes_files_and_folders_and_nothing() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("x");
        remove(&path).unwrap();
        create_folder(&path.join("y")).unwrap();
        append_line(&path.join("y/z"), "line").unwrap();
        remove(&path).unwrap();
        assert_eq!(list(folder.path()).unwrap(), Vec::<PathBuf>::new());
    }
}
