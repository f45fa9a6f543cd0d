//! What is refused, what is damaged, who is erased: nothing is overwritten and nothing half-written stays.

use std::fs;
use std::path::Path;

use super::{copy, files, journals, refusal, said, text};
use crate::support::{bowling, fresh_folder};

#[test]
fn an_erased_participant_is_nowhere_and_the_slot_is_free() {
    let study = copy("erased");
    let journal = journals(&study).remove(0);
    let participant = journal
        .ancestors()
        .nth(2)
        .and_then(Path::file_name)
        .and_then(|name| name.to_str())
        .expect("an id")
        .to_owned();
    let label = participant.strip_prefix("sub-").expect("an id");
    let text = said(&[
        "study",
        "erase",
        text(&study),
        &participant,
        "--who",
        "nobody",
    ]);
    assert!(text.contains("is free again"), "{text}");
    for (name, bytes) in files(&study) {
        let content = String::from_utf8_lossy(&bytes);
        let is_there = content.contains(&participant) || name.to_string_lossy().contains(label);
        assert!(!is_there, "{}", name.display());
    }
}

#[test]
fn damage_is_named_and_nothing_is_overwritten() {
    let study = copy("damaged");
    let journal = journals(&study).remove(0);
    let bytes = fs::read(&journal).expect("readable");
    let middle = bytes.len() / 2;
    let mut flipped = bytes.clone();
    flipped[middle] ^= 1;
    let lines: Vec<&[u8]> = bytes.split_inclusive(|byte| *byte == b'\n').collect();
    let without: Vec<u8> = [&lines[..100], &lines[101..]].concat().concat();
    for (damaged, words) in [
        (flipped, "after it was recorded"),
        (without, "line 101"),
        (b"participant_id\tage\n".to_vec(), "not a journal"),
    ] {
        fs::write(&journal, &damaged).expect("writable");
        let output = bowling(&["study", "status", text(&study)]);
        assert_eq!(output.status.code(), Some(1));
        let listed = String::from_utf8_lossy(&output.stdout);
        assert!(
            listed.contains(words) && listed.contains("DAMAGED"),
            "{listed}"
        );
        let refused = refusal(&["study", "rebuild", text(&study)]);
        assert!(refused.contains(words), "{refused}");
        assert_eq!(fs::read(&journal).expect("readable"), damaged);
    }
}

#[test]
fn a_folder_that_holds_something_and_one_that_is_none_are_refused() {
    let folder = fresh_folder("study-full");
    fs::write(folder.join("mine.txt"), "mine").expect("writable");
    let refused = refusal(&["study", "simulate", text(&folder), "--subjects", "1"]);
    assert!(
        refused.contains("nothing in it is overwritten"),
        "{refused}"
    );
    let refused = refusal(&["study", "status", text(&folder)]);
    assert!(refused.contains("is no study"), "{refused}");
    assert_eq!(files(&folder).len(), 1);
}

/// A scheme's file with one factor.
fn scheme(folder: &Path, key: &str, levels: &str) -> String {
    let path = folder.join("scheme.toml");
    let content = format!(
        "[[factor]]\nname = \"elasticity\"\nletter = \"E\"\nkey = \"{key}\"\n{levels}\n\
         [[cell]]\nfrom = \"0\"\nto = \"1\"\nweight = 1\n"
    );
    fs::write(&path, content).expect("writable");
    text(&path).to_owned()
}

/// What no session could be played with is found before the folder is made, so that the same one can be used the next time.
#[test]
fn settings_that_cannot_be_played_leave_no_study_behind() {
    let folder = fresh_folder("study-settings");
    let study = folder.join("study");
    for (key, levels, words) in [
        ("objects.bounce", "levels = [1.0, 0.7]", "objects.bounce"),
        (
            "objects.elasticity",
            "levels = [1.0, 7.0]",
            "objects.elasticity",
        ),
        (
            "objects.elasticity",
            "range = [1.0, -2.0]",
            "objects.elasticity",
        ),
        (
            "objects.shape",
            "levels = [\"true\", \"cube\"]",
            "objects.shape",
        ),
        ("lane.width_m", "levels = [1.0, 1.2]", "one session"),
    ] {
        let scheme = scheme(&folder, key, levels);
        for command in ["simulate", "new"] {
            let mut arguments = vec!["study", command, text(&study), "--subjects", "1"];
            arguments.extend(["--frames", "1", "--scheme", &scheme]);
            if command == "new" {
                arguments.extend(["--withdrawal-until", "2099-12-31"]);
                arguments.extend(["--retention-until", "2099-12-31"]);
            }
            let refused = refusal(&arguments);
            assert!(refused.contains(words), "{command}: {refused}");
            assert!(!study.exists(), "{command} left a folder: {refused}");
        }
    }
    for (arguments, words) in [
        (&["--threshold", "0.1"][..], "--threshold belongs to"),
        (&["--pairs", "7"], "belong to --scheme staircase"),
        (&["--rule", "bayesian"], "belong to --scheme staircase"),
        (&["--scheme", "nowhere.toml"], "cannot read nowhere.toml"),
        (&["--seed", "-1"], "invalid value"),
        (&["--frames", "11"], "invalid value"),
    ] {
        let all = [&["study", "simulate", text(&study)][..], arguments].concat();
        let output = bowling(&all);
        assert!(!output.status.success(), "{arguments:?}");
        let refused = String::from_utf8_lossy(&output.stderr).into_owned();
        assert!(refused.contains(words), "{refused}");
        assert!(!study.exists(), "{arguments:?} left a folder");
    }
    // And with settings that can be played the same folder is taken.
    let scheme = scheme(&folder, "objects.elasticity", "levels = [1.0, 0.7]");
    let good = [
        "--subjects",
        "1",
        "--frames",
        "1",
        "--training",
        "0",
        "--scheme",
        &scheme,
    ];
    said(&[&["study", "simulate", text(&study)][..], &good].concat());
}

#[test]
fn a_copy_into_the_study_is_refused_and_makes_no_folder() {
    let study = copy("inside");
    for inside in ["copy", "data/copy/deep", "plan/../copy"] {
        let out = study.join(inside);
        let refused = refusal(&["study", "export", text(&study), "--out", text(&out)]);
        assert!(
            refused.contains("lies in the study's own folder"),
            "{refused}"
        );
        assert!(!out.exists(), "{inside}");
    }
}
