//! A study on a disk that is full, read-only or gone, or in the hands of another program: each a sentence, and nothing is lost.
//!
//! The disk is a file system of its own, which only an administrator may mount; without, these tests name themselves as skipped.
#![cfg(target_os = "linux")]
#![expect(clippy::unwrap_used, reason = "a test that cannot go on fails")]

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use experiment::consent::ConsentForm;
use experiment::plan::{About, Plan, Scheme, SessionRules};
use experiment::study::{Study, StudyError};
use experiment::tables::Tables;

/// A small disk, gone when dropped.
struct Disk {
    folder: tempfile::TempDir,
}

impl Disk {
    /// One of 256 KiB, or `None` where this account may not have it.
    fn mount() -> Option<Disk> {
        let folder = tempfile::tempdir().unwrap();
        let options = ["-t", "tmpfs", "-o", "size=256k,mode=700", "tmpfs"];
        let mounted = Command::new("mount")
            .args(options)
            .arg(folder.path())
            .output();
        if mounted.is_ok_and(|output| output.status.success()) {
            return Some(Disk { folder });
        }
        eprintln!("skipped: this account may not mount a disk");
        None
    }

    fn path(&self) -> &Path {
        self.folder.path()
    }

    fn set(&self, option: &str) {
        let done = Command::new("mount")
            .args(["-o", &format!("remount,{option}")])
            .arg(self.path())
            .status();
        assert!(done.unwrap().success());
    }

    /// Takes all room that is left.
    fn fill(&self) -> PathBuf {
        let path = self.path().join("filler");
        // Writing ends where the disk does.
        fs::write(&path, vec![0; 1 << 20]).unwrap_err();
        path
    }
}

impl Drop for Disk {
    fn drop(&mut self) {
        Command::new("umount")
            .arg("-l")
            .arg(self.path())
            .status()
            .ok();
    }
}

fn create(root: &Path) -> Result<Study, String> {
    let about = About {
        title: "A study".to_owned(),
        laboratory: "A laboratory".to_owned(),
        contact: "its door".to_owned(),
        withdrawal_until: "2027-06-30".to_owned(),
        retention_until: "2036-12-31".to_owned(),
    };
    let form = include_str!("../../../config/consent.md").to_owned();
    let form = ConsentForm::parse(form, Path::new("consent.md")).unwrap();
    let (plan, rows) = Plan::new(&Scheme::Table2, 18, 1, about, SessionRules::default()).unwrap();
    let questionnaire = include_str!("../../../config/questionnaire.toml");
    Study::create(root, &plan, &rows, questionnaire, &form.text, 3)
        .map_err(|error| error.to_string())
}

/// Every file below a folder with its content.
fn contents(folder: &Path) -> Vec<(PathBuf, Vec<u8>)> {
    let paths = experiment::files::list(folder).unwrap();
    paths
        .into_iter()
        .map(|path| (path.clone(), fs::read(path).unwrap()))
        .collect()
}

#[test]
fn full_disk_is_named_and_nothing_is_lost() {
    let Some(disk) = Disk::mount() else { return };
    let root = disk.path().join("study");
    let study = create(&root).unwrap();
    let lock = study.lock().unwrap();
    let first = study.admit(&lock, 1).unwrap();
    Tables::of(&study, &lock).write_study(&[]).unwrap();
    study.unblind(&lock, "x", "2026-11-22", "y").unwrap();
    let before = contents(&root);
    let filler = disk.fill();
    for error in [
        study.admit(&lock, 2).unwrap_err().to_string(),
        study
            .unblind(&lock, "x", "2026-11-22", &"y".repeat(9000))
            .unwrap_err()
            .to_string(),
        study
            .keep_settings(&lock, &"x".repeat(5000))
            .unwrap_err()
            .to_string(),
        Tables::of(&study, &lock)
            .write_study(&[])
            .unwrap_err()
            .to_string(),
        create(&disk.path().join("another")).unwrap_err(),
    ] {
        assert!(
            error.contains("the disk is full") && error.lines().count() == 1,
            "{error}"
        );
    }
    assert_eq!(contents(&root), before);
    assert!(!disk.path().join("another").exists());
    fs::remove_file(filler).unwrap();
    assert_eq!(study.admit(&lock, 2).unwrap().slot, first.slot + 1);
}

#[test]
fn read_only_or_removed_folder_is_named() {
    let Some(disk) = Disk::mount() else { return };
    let root = disk.path().join("study");
    let study = create(&root).unwrap();
    disk.set("ro");
    let error = study.lock().unwrap_err().to_string();
    assert!(
        error.contains("choose a folder that this account may write to"),
        "{error}"
    );
    let error = create(&disk.path().join("another")).unwrap_err();
    assert!(
        error.contains("choose a folder that this account may write to"),
        "{error}"
    );
    // Reading needs no right to write.
    Study::open(&root).unwrap();
    disk.set("rw");
    let lock = study.lock().unwrap();
    fs::remove_dir_all(&root).unwrap();
    let error = study.admit(&lock, 1).unwrap_err().to_string();
    assert!(error.contains("check the path"), "{error}");
    assert!(
        !root.exists(),
        "a folder that was removed is not made again"
    );
}

#[test]
fn another_program_keeps_the_study_until_it_is_killed() {
    let folder = tempfile::tempdir().unwrap();
    let study = create(&folder.path().join("study")).unwrap();
    let file = study.root().join("study.lock");
    // util-linux' flock takes the same lock; -o keeps it from the program that it starts.
    let mut other = Command::new("flock")
        .args(["-x", "-o"])
        .arg(&file)
        .args(["sleep", "10"])
        .spawn()
        .unwrap();
    // The other program waits for this one's turns to end, so that it gets the lock in the end.
    let refused = (0..10_000_000).find_map(|_| study.lock().err());
    assert!(
        matches!(refused, Some(StudyError::InUse { .. })),
        "{refused:?}"
    );
    other.kill().unwrap();
    other.wait().unwrap();
    // What it had just started lets go of the lock a moment later.
    let regained = (0..10_000_000).find_map(|_| study.lock().ok());
    assert!(regained.is_some());
}
