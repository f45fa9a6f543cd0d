//! Programs that are killed, and two programs on one study.

use std::collections::BTreeSet;
use std::fs;
use std::io::Read;
use std::path::{Path, PathBuf};
use std::time::Duration;

use experiment::random::SplitMix64;
use serde_json::Value;

use super::{
    begin, copy, entries, go_on, journals, journals_of, new_study, refusal, said, simulated, text,
    whole_lines,
};

#[test]
fn two_programs_do_not_share_a_study() {
    let study = new_study("study-shared", "10");
    let mut first = begin(&["run".to_owned()], &study);
    let journal =
        || experiment::files::list(&study.join("data")).is_ok_and(|files| !files.is_empty());
    while !journal() {
        assert!(first.try_wait().expect("known").is_none(), "it ended");
        std::thread::yield_now();
    }
    let refused = refusal(&["study", "run", text(&study), "--device", "script"]);
    assert!(refused.contains("in use by another program"), "{refused}");
    first.kill().expect("it runs");
    first.wait().expect("it ended");
    // A killed program leaves no lock behind.
    said(&["study", "status", text(&study)]);
    let refused = refusal(&["study", "run", text(&study), "--device", "script"]);
    assert!(refused.contains("all 1 slots"), "{refused}");
}

/// Kills of running sessions in all, half of them by each of two threads.
const KILLS: u32 = 200;

#[test]
fn two_hundred_kills_lose_nothing() {
    let seed = 2026;
    std::thread::scope(|scope| {
        for half in 0..2 {
            scope.spawn(move || {
                let mut left = KILLS / 2;
                for session in (half..).step_by(2) {
                    left -= kill_again_and_again(seed, session, left);
                    if left == 0 {
                        return;
                    }
                }
            });
        }
    });
}

/// Kills one session over and over, at most `most` times, resumes it each time, and plays it to its end; returns how often
/// it was killed.
fn kill_again_and_again(seed: u64, session: u32, most: u32) -> u32 {
    let study = new_study(&format!("study-killed-{session}"), "2");
    let mut random = SplitMix64::for_index(seed, u64::from(session));
    let mut kept: Vec<(PathBuf, Vec<u8>)> = Vec::new();
    let mut kills = 0;
    while kills < most {
        let kill = kills;
        let context = format!("seed {seed}, session {session}, kill {kill}");
        let mut child = begin(&go_on(&study), &study);
        // No synchronisation: the instant of the kill is what is random.
        let wait = Duration::from_secs_f64(0.02 + 0.5 * random.uniform().powi(2));
        std::thread::sleep(wait);
        let seen = whole_lines(&study);
        if child
            .try_wait()
            .expect("known")
            .is_some_and(|status| status.success())
        {
            // Played to its end before the kill.
            break;
        }
        child.kill().expect("it runs or has ended");
        kills += 1;
        let mut errors = String::new();
        let status = child.wait().expect("it ended");
        let mut stream = child.stderr.take().expect("a pipe");
        stream.read_to_string(&mut errors).expect("text");
        assert!(
            status.code().is_none_or(|code| code == 0),
            "{context}: {errors}"
        );
        // What was there before is there still, to the byte, and what was seen of the new journal too.
        for (path, bytes) in kept.iter().chain(&seen) {
            let now = fs::read(path).expect("a journal stays");
            assert!(now.starts_with(bytes), "{context}: {}", path.display());
        }
        kept = if journals_of(&study).is_empty() {
            Vec::new()
        } else {
            whole_lines(&study)
        };
        let listed = said(&["study", "status", text(&study)]);
        assert!(!listed.contains("DAMAGED"), "{context}: {listed}");
        resumes_at_the_last_frame(&study, &context);
    }
    let listed = said(&["study", "status", text(&study)]);
    if !listed.contains("complete") {
        let finished = begin(&go_on(&study), &study);
        let output = finished.wait_with_output().expect("it ended");
        let errors = String::from_utf8_lossy(&output.stderr);
        assert!(
            output.status.success(),
            "seed {seed}, session {session}: {errors}"
        );
    }
    said(&["study", "rebuild", text(&study)]);
    let listed = said(&["study", "status", text(&study)]);
    assert!(listed.contains("  complete"), "seed {seed}: {listed}");
    kills
}

/// A frame scores and ends its game in one instant, and is written line by line: whoever is killed behind one of these lines plays from
/// the mark before on, instead of a game that is over and was never heard of to end.
#[test]
fn a_kill_between_two_events_of_one_instant_loses_neither() {
    let kind = |entry: &Value| entry["event"]["event"].as_str().map(str::to_owned);
    let mut torn = BTreeSet::new();
    // How many inputs there were before the marks so far.
    let (mut inputs, mut marks, mut has_begun) = (0, vec![0], false);
    for (line, entry) in entries(&journals(simulated())[0]).iter().enumerate() {
        inputs += u64::from(entry.get("input").is_some());
        let Some(kind) = kind(entry) else { continue };
        let is_training = kind == "settled" && !has_begun;
        has_begun |= kind == "game_started";
        if !is_training && !["game_started", "frame_scored", "game_over"].contains(&&*kind) {
            continue;
        }
        let before = marks.iter().rev().find(|mark| **mark < inputs);
        let before = *before.expect("the beginning is one");
        marks.push(inputs);
        if !torn.insert(kind.clone()) {
            continue;
        }
        let study = copy(&format!("torn-{kind}"));
        let journal = journals(&study).remove(0);
        let content = fs::read_to_string(&journal).expect("text");
        let kept: String = content.split_inclusive('\n').take(line + 1).collect();
        fs::write(&journal, kept).expect("writable");
        said(&["study", "resume", text(&study), "--device", "script"]);
        let next = entries(&journal.with_file_name("session_part-2.jsonl"));
        assert_eq!(next[0]["header"]["continues"]["inputs"], before, "{kind}");
        let listed = said(&["study", "status", text(&study)]);
        assert_eq!(listed.matches("  complete").count(), 2, "{kind}: {listed}");
        let replayed = said(&["replay", text(journal.parent().expect("a folder"))]);
        assert!(replayed.contains("agree."), "{kind}: {replayed}");
    }
    assert_eq!(torn.len(), 4, "{torn:?}");
}

/// Every journal that goes on begins where the one before it had its last complete frame, game or training throw.
fn resumes_at_the_last_frame(study: &Path, context: &str) {
    let folder = journals_of(study)
        .first()
        .and_then(|path| path.parent())
        .map(Path::to_owned);
    let Some(folder) = folder else { return };
    let part = |number: usize| match number {
        1 => folder.join("session.jsonl"),
        _ => folder.join(format!("session_part-{number}.jsonl")),
    };
    // How many inputs count before each part, and where its last mark is.
    let mut mark = 0;
    for number in (1..).take_while(|number| part(*number).exists()) {
        let entries = entries(&part(number));
        // A program that was killed before its first lines did nothing.
        let Some(header) = entries.first() else {
            continue;
        };
        if entries.len() == 1 && header["header"]["continues"].is_null() {
            continue;
        }
        let begins = header["header"]["continues"]["inputs"]
            .as_u64()
            .unwrap_or(0);
        assert_eq!(begins, mark, "{context}: part {number}");
        let mut inputs = begins;
        let mut games = 0;
        // Events are written one by one: a mark counts once something else follows them.
        let mut reached = mark;
        for entry in &entries {
            if entry.get("event").is_none() {
                mark = reached;
            }
            inputs += u64::from(entry.get("input").is_some());
            let kind = entry["event"]["event"].as_str().unwrap_or_default();
            games += u32::from(kind == "game_started");
            let is_training = kind == "settled" && begins == 0 && games == 0;
            if is_training || ["game_started", "frame_scored", "game_over"].contains(&kind) {
                reached = inputs;
            }
        }
    }
}
