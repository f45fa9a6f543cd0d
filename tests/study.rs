//! Studies: simulated whole, killed at any instant, damaged on purpose, and given away.

/// Moments and spans of a session, drawn.
mod captured;
/// Programs that are killed, and two on one study.
mod kills;
/// The disk, the folder and the clock while a session runs.
mod loss;
/// Studies of differences.
mod pairs;
/// What is refused, what is damaged, who is erased.
mod refused;
/// What participant and experimenter are shown, and how they answer.
mod room;
/// A study that was simulated whole.
mod simulated;

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::sync::OnceLock;

use experiment::journal::Lines;
use serde_json::Value;

use crate::support::{NEW_STUDY, bowling, fresh_folder};

/// The program's output, which has to be a success.
fn said(arguments: &[&str]) -> String {
    let output = bowling(arguments);
    let errors = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{arguments:?}: {errors}");
    String::from_utf8(output.stdout).expect("text")
}

fn refusal(arguments: &[&str]) -> String {
    let output = bowling(arguments);
    assert_eq!(output.status.code(), Some(1), "{arguments:?}");
    let text = String::from_utf8(output.stderr).expect("text");
    assert_eq!(text.trim_end().lines().count(), 1, "one sentence: {text}");
    text
}

fn text(path: &Path) -> &str {
    path.to_str().expect("a plain name")
}

/// Two simulated participants with a game of one frame each way; made once, read by several tests.
fn simulated() -> &'static Path {
    static STUDY: OnceLock<PathBuf> = OnceLock::new();
    STUDY.get_or_init(|| {
        let folder = fresh_folder("study").join("simulated");
        simulate(&folder, "2", "1");
        folder
    })
}

fn simulate(folder: &Path, subjects: &str, frames: &str) {
    said(&[
        "study",
        "simulate",
        text(folder),
        "--subjects",
        subjects,
        "--frames",
        frames,
        "--training",
        "1",
        "--seed",
        "7",
    ]);
}

/// A copy of the simulated study that a test may change.
fn copy(name: &str) -> PathBuf {
    // A folder for each: a fresh one takes what was in it away, also from a test beside this one.
    let to = fresh_folder(&format!("study-copy-{name}")).join("study");
    copy_folder(simulated(), &to);
    to
}

fn copy_folder(from: &Path, to: &Path) {
    fs::create_dir_all(to).expect("writable");
    for entry in fs::read_dir(from).expect("readable") {
        let entry = entry.expect("readable");
        let target = to.join(entry.file_name());
        if entry.file_type().expect("known").is_dir() {
            copy_folder(&entry.path(), &target);
        } else {
            fs::copy(entry.path(), &target).expect("writable");
        }
    }
}

/// Every file below `folder`, by its path from there.
fn files(folder: &Path) -> Vec<(PathBuf, Vec<u8>)> {
    let mut found = Vec::new();
    for path in experiment::files::list(folder).expect("readable") {
        let name = path.strip_prefix(folder).expect("it is below").to_owned();
        found.push((name, fs::read(&path).expect("readable")));
    }
    found.sort();
    found
}

fn journals(study: &Path) -> Vec<PathBuf> {
    let mut paths = experiment::files::list(&study.join("data/sourcedata")).expect("readable");
    paths.sort();
    paths
}

/// The contents of a journal's whole lines.
fn entries(journal: &Path) -> Vec<Value> {
    let bytes = fs::read(journal).expect("readable");
    let mut lines = Lines::new(&bytes);
    let mut entries = Vec::new();
    while let Some(content) = lines.next_content().unwrap_or_else(|problem| {
        panic!("{} line {}: {problem}", journal.display(), lines.number())
    }) {
        entries.push(serde_json::from_str(&content).expect("JSON"));
    }
    entries
}

/// A study for one participant, without a session.
fn new_study(name: &str, frames: &str) -> PathBuf {
    new_study_in(&fresh_folder(name).join("study"), frames)
}

/// The same in a folder that is named.
fn new_study_in(folder: &Path, frames: &str) -> PathBuf {
    new_study_with(folder, &["--frames", frames, "--training", "1"])
}

/// A study for one participant, and of what else its plan has.
fn new_study_with(folder: &Path, plan: &[&str]) -> PathBuf {
    let mut arguments = vec!["study", "new", text(folder), "--subjects", "1"];
    arguments.extend(NEW_STUDY);
    arguments.extend(plan);
    said(&arguments);
    folder.to_owned()
}

/// What goes on with a study of one participant: its first session, one whose program was killed before the first line, or
/// one that was broken off.
fn go_on(study: &Path) -> Vec<String> {
    let listed = said(&["study", "status", text(study)]);
    let participant = listed.lines().nth(1).map(str::trim);
    let words = match participant.and_then(|line| line.split_once("  ")) {
        None => vec!["run"],
        Some((id, "has not begun")) => vec!["run", "--participant", id],
        Some(_) => vec!["resume"],
    };
    words.into_iter().map(str::to_owned).collect()
}

/// Starts a scripted session in the background.
fn begin(command: &[String], study: &Path) -> Child {
    scripted(command, study)
        .spawn()
        .expect("the program starts")
}

/// What begins, or takes up, a scripted session.
fn scripted(command: &[String], study: &Path) -> Command {
    let mut program = Command::new(env!("CARGO_BIN_EXE_bowling"));
    program
        .args(["study", &command[0], text(study), "--device", "script"])
        .args(&command[1..])
        .env_remove("DISPLAY")
        .env_remove("WAYLAND_DISPLAY")
        .current_dir(env!("CARGO_MANIFEST_DIR"))
        .stdin(Stdio::null())
        .stdout(Stdio::null())
        .stderr(Stdio::piped());
    program
}

/// Takes all tables of a study away and has them made anew from its journals: nothing differs.
fn comes_out_of_its_journals(study: &Path) {
    let before = files(&study.join("data"));
    for (name, _) in &before {
        if !name.starts_with("sourcedata") {
            fs::remove_file(study.join("data").join(name)).expect("writable");
        }
    }
    said(&["study", "rebuild", text(study)]);
    let after = files(&study.join("data"));
    let names = |files: &[(PathBuf, Vec<u8>)]| -> Vec<PathBuf> {
        files.iter().map(|(name, _)| name.clone()).collect()
    };
    assert_eq!(names(&before), names(&after));
    for (one, other) in before.iter().zip(&after) {
        assert!(one == other, "{} has changed", one.0.display());
    }
}

fn journals_of(study: &Path) -> Vec<PathBuf> {
    let folder = study.join("data/sourcedata");
    if folder.exists() {
        journals(study)
    } else {
        Vec::new()
    }
}

/// Every journal with its whole lines.
fn whole_lines(study: &Path) -> Vec<(PathBuf, Vec<u8>)> {
    let read = |path: PathBuf| {
        let mut bytes = fs::read(&path).expect("readable");
        let end = bytes
            .iter()
            .rposition(|byte| *byte == b'\n')
            .map_or(0, |at| at + 1);
        bytes.truncate(end);
        (path, bytes)
    };
    journals_of(study).into_iter().map(read).collect()
}
