//! A study that was simulated whole: what it leaves, and that it comes out again.

use std::fs;
use std::os::unix::fs::PermissionsExt;
use std::path::Path;
use std::process::Command;

use serde_json::Value;

use super::{
    comes_out_of_its_journals, copy, entries, files, journals, said, simulate, simulated, text,
};
use crate::support::fresh_folder;

#[test]
fn a_simulated_study_is_complete_and_its_tables_come_out_of_the_journals_again() {
    let study = copy("rebuilt");
    let status = said(&["study", "status", text(&study)]);
    assert_eq!(status.matches("  complete").count(), 2, "{status}");
    comes_out_of_its_journals(&study);
}

/// Nobody answers everything at one instant: each answer comes 2 to 8 s after the one before it, and the questions behind a
/// game after its end.
#[test]
fn simulated_answers_take_their_time() {
    for journal in journals(simulated()) {
        let entries = entries(&journal);
        let at = |entry: &Value| entry["study"]["act"]["at_s"].as_f64();
        let times: Vec<f64> = entries.iter().filter_map(at).collect();
        assert!(times.len() > 8, "{times:?}");
        for two in times.windows(2) {
            assert!(two[1] - two[0] >= 2.0, "{times:?}");
        }
        let within = times.windows(2).filter(|two| two[1] - two[0] <= 8.1);
        // All but the first of each of the three forms.
        assert_eq!(within.count(), times.len() - 3, "{times:?}");
        let step = |entry: &&Value| entry["event"]["event"] == "game_over";
        let over = entries.iter().rfind(step).expect("two games");
        let over_s = over["event"]["step"].as_f64().expect("a number") / 720.0;
        assert!(times.last().is_some_and(|last| *last > over_s + 2.0));
    }
}

#[test]
fn the_same_seed_simulates_the_same_study() {
    let again = fresh_folder("study-again").join("again");
    simulate(&again, "2", "1");
    let shared = |study: &Path| files(&study.join("data"));
    assert!(shared(simulated()) == shared(&again));
}

#[test]
fn a_session_of_a_study_replays_to_the_last_bit() {
    for journal in journals(simulated()) {
        let folder = journal.parent().expect("a folder");
        let text = said(&["replay", text(folder)]);
        assert!(text.contains("agree."), "{text}");
    }
}

#[test]
fn data_can_be_read_by_their_owner_alone_and_tell_no_condition() {
    for path in experiment::files::list(simulated()).expect("readable") {
        let mode = fs::metadata(&path).expect("there").permissions().mode() & 0o777;
        assert_eq!(mode, 0o600, "{}", path.display());
    }
    for (name, bytes) in files(&simulated().join("data")) {
        let content = String::from_utf8(bytes).expect("text");
        for word in ["friction_rate", "ellipsoid", "objects."] {
            assert!(!content.contains(word), "{word} in {}", name.display());
        }
    }
}

#[test]
fn both_games_are_played_under_the_buttons_of_the_plan() {
    let plan = fs::read_to_string(simulated().join("plan/allocation.csv")).expect("readable");
    let assignments =
        fs::read_to_string(simulated().join("plan/assignments.csv")).expect("readable");
    for line in assignments.lines().skip(1) {
        let (slot, participant) = line.split_once(',').expect("two columns");
        let row = plan
            .lines()
            .find(|row| row.split(',').next() == Some(slot))
            .expect("the slot's row");
        let first = row.split(',').nth(5).expect("first_button");
        let journal = simulated().join(format!(
            "data/sourcedata/{participant}/ses-01/session.jsonl"
        ));
        let started: Vec<String> = entries(&journal)
            .iter()
            .filter(|entry| entry["event"]["event"] == "game_started")
            .map(|entry| {
                entry["event"]["button"]
                    .as_str()
                    .expect("a name")
                    .to_owned()
            })
            .collect();
        let other = if first == "Red" { "blue" } else { "red" };
        assert_eq!(started, [first.to_lowercase(), other.to_owned()]);
    }
}

#[test]
fn the_dataset_passes_the_bids_validator() {
    let script = Path::new(env!("CARGO_MANIFEST_DIR")).join("scripts/bids-validate.sh");
    let output = Command::new(script)
        .arg(simulated().join("data"))
        .output()
        .expect("the script starts");
    let said = String::from_utf8_lossy(&output.stdout);
    let errors = String::from_utf8_lossy(&output.stderr);
    if output.status.code() == Some(3) && std::env::var_os("BOWLING_NO_BIDS").is_some() {
        println!("skipped: {errors}");
        return;
    }
    assert!(output.status.success(), "{said}{errors}");
}
