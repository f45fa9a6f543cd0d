//! Nothing is lost while a session runs: the disk is full, the folder is read-only or gone, the clock jumps back.
//!
//! Each is a sentence, nothing that was there is overwritten, and `resume` or `rebuild` goes on. The disk is a file system of its
//! own, which only an administrator may mount; without, these tests name themselves as skipped.
#![cfg(target_os = "linux")]

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Output};

use super::{begin, go_on, journals_of, new_study_in, refusal, said, scripted, text, whole_lines};
use crate::support::fresh_folder;

/// Something that is mounted until this is dropped.
struct Mounted(PathBuf);

impl Mounted {
    /// `None` where this account may not mount.
    fn new(folder: &Path, options: &[&str]) -> Option<Self> {
        let done = Command::new("mount").args(options).arg(folder).output();
        if done.is_ok_and(|output| output.status.success()) {
            return Some(Self(folder.to_owned()));
        }
        eprintln!("skipped: this account may not mount a disk");
        None
    }

    fn remount(&self, options: &str) {
        let done = Command::new("mount")
            .args(["-o", &format!("remount,{options}")])
            .arg(&self.0)
            .status();
        assert!(done.expect("mount starts").success(), "{options}");
    }
}

impl Drop for Mounted {
    fn drop(&mut self) {
        // Lazily: whoever still has it open does not keep the test's folder.
        Command::new("umount").arg("-l").arg(&self.0).status().ok();
    }
}

/// The only sentence of a program that could not go on.
fn sentence(output: &Output) -> String {
    let errors = String::from_utf8_lossy(&output.stderr).into_owned();
    assert_eq!(output.status.code(), Some(1), "{errors}");
    assert_eq!(errors.trim_end().lines().count(), 1, "{errors}");
    errors
}

/// Waits until the session's journals have `count` lines.
fn wait_for_lines(study: &Path, count: usize, child: &mut Child) {
    loop {
        let lines: usize = whole_lines(study)
            .iter()
            .map(|(_, bytes)| bytes.iter().filter(|byte| **byte == b'\n').count())
            .sum();
        if lines >= count {
            return;
        }
        assert!(child.try_wait().expect("known").is_none(), "it ended");
        std::thread::yield_now();
    }
}

/// What was there is there still, and the session can be taken up to its end and rebuilt.
fn goes_on(study: &Path, kept: &[(PathBuf, Vec<u8>)]) {
    for (path, bytes) in kept {
        let now = fs::read(path).expect("a journal stays");
        assert!(now.starts_with(bytes), "{}", path.display());
    }
    let listed = said(&["study", "status", text(study)]);
    assert!(!listed.contains("DAMAGED"), "{listed}");
    let resumed = begin(&go_on(study), study)
        .wait_with_output()
        .expect("it ended");
    let errors = String::from_utf8_lossy(&resumed.stderr);
    assert!(resumed.status.success(), "{errors}");
    said(&["study", "rebuild", text(study)]);
    let listed = said(&["study", "status", text(study)]);
    assert!(listed.contains("  complete"), "{listed}");
    for (path, bytes) in kept {
        let now = fs::read(path).expect("a journal stays");
        assert!(now.starts_with(bytes), "{}", path.display());
    }
}

#[test]
fn a_disk_that_fills_up_while_a_session_runs_is_named_and_the_session_goes_on_later() {
    let folder = fresh_folder("study-disk-full");
    let options = ["-t", "tmpfs", "-o", "size=1500k,mode=700", "tmpfs"];
    let Some(disk) = Mounted::new(&folder, &options) else {
        return;
    };
    let study = new_study_in(&folder.join("study"), "2");
    let output = begin(&["run".to_owned()], &study)
        .wait_with_output()
        .expect("it ended");
    let said = sentence(&output);
    assert!(
        said.contains("session.jsonl") && said.contains("No space left"),
        "{said}"
    );
    let kept = whole_lines(&study);
    let bytes: usize = kept.iter().map(|(_, bytes)| bytes.len()).sum();
    assert!(bytes > 1_000_000, "the disk was full of it: {bytes}");
    disk.remount("size=64m");
    goes_on(&study, &kept);
}

#[test]
fn a_folder_that_is_removed_under_a_session_is_named_and_is_not_made_again() {
    let study = new_study_in(&fresh_folder("study-removed").join("study"), "10");
    let mut child = begin(&["run".to_owned()], &study);
    wait_for_lines(&study, 200, &mut child);
    fs::remove_dir_all(study.join("data")).expect("writable");
    let said = sentence(&child.wait_with_output().expect("it ended"));
    assert!(said.contains("somebody has removed it"), "{said}");
    assert!(journals_of(&study).is_empty(), "nothing is made up");
}

#[test]
fn a_folder_that_turns_read_only_keeps_the_journal_and_the_tables_come_later() {
    let folder = fresh_folder("study-read-only");
    let study = new_study_in(&folder.join("study"), "3");
    let mut child = begin(&["run".to_owned()], &study);
    wait_for_lines(&study, 200, &mut child);
    let data = study.join("data");
    let Some(bound) = Mounted::new(&data, &["--bind", text(&data)]) else {
        child.kill().expect("it runs");
        child.wait().expect("it ended");
        return;
    };
    bound.remount("bind,ro");
    let said = sentence(&child.wait_with_output().expect("it ended"));
    assert!(
        said.contains("choose a folder that this account may write to"),
        "{said}"
    );
    let listed = super::said(&["study", "status", text(&study)]);
    assert!(
        listed.contains("  complete"),
        "the journal has it all: {listed}"
    );
    let refused = refusal(&["study", "rebuild", text(&study)]);
    assert!(refused.contains("may write to"), "{refused}");
    let kept = whole_lines(&study);
    drop(bound);
    super::said(&["study", "rebuild", text(&study)]);
    assert_eq!(whole_lines(&study), kept);
    assert!(data.join("participants.tsv").is_file());
}

/// A library that takes the hours in the file `BOWLING_TEST_BACK` off the clock of the day, whenever it is asked.
const CLOCK: &str = r#"
#define _GNU_SOURCE
#include <dlfcn.h>
#include <stdio.h>
#include <stdlib.h>
#include <time.h>
int clock_gettime(clockid_t clock, struct timespec *at) {
    static int (*real)(clockid_t, struct timespec *);
    if (!real) real = dlsym(RTLD_NEXT, "clock_gettime");
    int answer = real(clock, at);
    if (clock == CLOCK_REALTIME) {
        long hours = 0;
        FILE *file = fopen(getenv("BOWLING_TEST_BACK"), "r");
        if (file) { if (fscanf(file, "%ld", &hours) != 1) hours = 0; fclose(file); }
        at->tv_sec -= hours * 3600;
    }
    return answer;
}
"#;

fn clock_library(folder: &Path) -> PathBuf {
    let (source, library) = (folder.join("clock.c"), folder.join("clock.so"));
    fs::write(&source, CLOCK).expect("writable");
    let built = Command::new("cc")
        .args(["-shared", "-fPIC", "-o"])
        .args([&library, &source])
        .arg("-ldl")
        .status();
    assert!(built.expect("cc links Rust programs").success());
    library
}

#[test]
fn a_clock_that_jumps_back_changes_no_order_and_overwrites_nothing() {
    let folder = fresh_folder("study-clock");
    let library = clock_library(&folder);
    let back = folder.join("hours");
    fs::write(&back, "0").expect("writable");
    let study = new_study_in(&folder.join("study"), "2");
    let start = |command: &[String]| {
        scripted(command, &study)
            .env("LD_PRELOAD", &library)
            .env("BOWLING_TEST_BACK", &back)
            .spawn()
            .expect("the program starts")
    };
    let mut child = start(&["run".to_owned()]);
    wait_for_lines(&study, 300, &mut child);
    // Ten days back in the middle of the session, and again before it is taken up.
    fs::write(&back, "240").expect("writable");
    wait_for_lines(&study, 1500, &mut child);
    child.kill().expect("it runs");
    child.wait().expect("it ended");
    let kept = whole_lines(&study);
    fs::write(&back, "480").expect("writable");
    let resumed = start(&go_on(&study)).wait_with_output().expect("it ended");
    let errors = String::from_utf8_lossy(&resumed.stderr);
    assert!(resumed.status.success(), "{errors}");
    for (path, bytes) in &kept {
        assert_eq!(&fs::read(path).expect("it stays")[..bytes.len()], bytes);
    }
    // The later journal says an earlier time, as the clock did: the jump was seen.
    let clocks: Vec<String> = journals_of(&study)
        .iter()
        .flat_map(|path| super::entries(path))
        .filter(|entry| entry["study"]["note"] == "clock")
        .map(|entry| entry["study"]["utc"].as_str().expect("a time").to_owned())
        .collect();
    assert!(clocks.len() >= 2 && clocks[1] < clocks[0], "{clocks:?}");
    // Times in the tables are counted from the beginning by the simulation, and never run back.
    for path in experiment::files::list(&study.join("data")).expect("readable") {
        if !text(&path).ends_with("_events.tsv") {
            continue;
        }
        let table = fs::read_to_string(&path).expect("text");
        let onsets: Vec<f64> = table
            .lines()
            .skip(1)
            .map(|line| line.split('\t').next().expect("a cell"))
            .map(|cell| cell.parse().expect("a number"))
            .collect();
        assert!(onsets.len() > 2, "{table}");
        assert!(onsets.windows(2).all(|two| two[0] <= two[1]), "{table}");
    }
    let listed = said(&["study", "status", text(&study)]);
    assert!(listed.contains("  complete"), "{listed}");
}

/// Neither to a network nor to a neighbour: every file that a running session has open is looked at.
#[test]
fn a_running_session_has_no_socket_open() {
    let study = new_study_in(&fresh_folder("study-sockets").join("study"), "2");
    let mut child = begin(&["run".to_owned()], &study);
    let open = format!("/proc/{}/fd", child.id());
    let mut looks = 0;
    while child.try_wait().expect("known").is_none() {
        // It may end, and a file be closed, while this looks.
        let Ok(files) = fs::read_dir(&open) else {
            break;
        };
        let targets = files
            .flatten()
            .filter_map(|file| fs::read_link(file.path()).ok());
        let targets: Vec<String> = targets.map(|target| target.display().to_string()).collect();
        assert!(
            !targets.iter().any(|target| target.starts_with("socket:")),
            "{targets:?}"
        );
        looks += usize::from(
            targets
                .iter()
                .any(|target| target.contains("session.jsonl")),
        );
        std::thread::yield_now();
    }
    let output = child.wait_with_output().expect("it ended");
    assert!(output.status.success());
    assert!(looks > 10, "it was seen {looks} times");
}
