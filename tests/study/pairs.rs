//! Studies of differences: pairs of throws, what is said of them, and what they come to.

use std::fs;
use std::path::{Path, PathBuf};
use std::sync::OnceLock;

use bowling_app::journal::{self, Changes};
use experiment::random::SplitMix64;
use game::{Event, EventKind, Game};
use serde_json::Value;

use super::{
    begin, comes_out_of_its_journals, copy_folder, entries, go_on, journals, new_study_with,
    refusal, said, text,
};
use crate::support::{bowling, fresh_folder};

const ELASTICITY: [&str; 8] = [
    "--scheme",
    "staircase",
    "--parameter",
    "objects.elasticity",
    "--standard",
    "1.0",
    "--furthest",
    "0.4",
];

/// A simulated study of differences.
fn simulate(folder: &Path, subjects: &str, more: &[&str]) {
    let mut arguments = vec!["study", "simulate", text(folder), "--subjects", subjects];
    arguments.extend(["--training", "0", "--seed", "11"]);
    arguments.extend(ELASTICITY);
    arguments.extend(more);
    said(&arguments);
}

/// The cells of a table with tabs, by column.
fn column(path: &Path, name: &str) -> Vec<String> {
    let table = fs::read_to_string(path).expect("a table");
    let mut lines = table.lines();
    let heading = lines.next().expect("a heading");
    let at = heading.split('\t').position(|column| column == name);
    let at = at.unwrap_or_else(|| panic!("no {name} in {heading}"));
    let cell = |line: &str| line.split('\t').nth(at).expect("a cell").to_owned();
    lines.map(cell).collect()
}

fn numbers(path: &Path, name: &str) -> Vec<f64> {
    let cells = column(path, name).into_iter();
    cells
        .map(|cell| cell.parse().unwrap_or_else(|_| panic!("{name}: {cell}")))
        .collect()
}

/// The files of the pairs.
fn pairs_of(study: &Path) -> Vec<PathBuf> {
    let all = experiment::files::list(&study.join("data")).expect("readable");
    let is_one = |path: &PathBuf| text(path).ends_with("_task-pairs_beh.tsv");
    all.into_iter().filter(is_one).collect()
}

/// What the simulated participants tell apart comes out of the study again, by both rules: 0.12 is a fifth of the range. How well they do
/// over hundreds of seeds is tested where the rules are.
#[test]
fn a_known_threshold_comes_out_again_by_both_rules() {
    for (rule, subjects, pairs) in [("bayesian", 2, 25), ("one-up-two-down", 1, 60)] {
        let study = fresh_folder("study-threshold").join(rule);
        let count = pairs.to_string();
        let more = ["--rule", rule, "--pairs", &count, "--threshold", "0.12"];
        simulate(&study, &subjects.to_string(), &more);
        let thresholds = study.join("data/phenotype/thresholds.tsv");
        let found = numbers(&thresholds, "threshold");
        assert_eq!(found.len(), subjects);
        for threshold in &found {
            // Twice the spread of an estimate from so few pairs, a quarter.
            let off = (threshold / 0.12).ln();
            assert!(off.abs() < 0.5, "{rule}: {found:?}");
        }
        let ends = numbers(&thresholds, "low").into_iter();
        for (low, high) in ends.zip(numbers(&thresholds, "high")) {
            assert!((low..=high).contains(&0.12), "{rule}: {low} {high}");
        }
        // The table is what the pairs say: each has the standard, and a fifth of them twice.
        for path in pairs_of(&study) {
            let (first, second) = (numbers(&path, "first"), numbers(&path, "second"));
            let difference = numbers(&path, "difference");
            assert_eq!(first.len(), pairs);
            for ((first, second), difference) in first.iter().zip(&second).zip(&difference) {
                assert!(*first == 1.0 || *second == 1.0, "{first} {second}");
                assert!(((first - second).abs() - difference).abs() < 2e-6);
            }
            let catches = difference.iter().filter(|off| **off == 0.0);
            assert_eq!(catches.count(), pairs / 5);
            let at = numbers(&path, "at");
            assert!(at.windows(2).all(|pair| pair[0] < pair[1]), "{at:?}");
        }
        let listed = said(&["study", "status", text(&study)]);
        let shown = format!("threshold {:.4}", found[0]);
        assert!(listed.contains(&shown), "{shown}: {listed}");
    }
}

/// Six pairs are enough for what has nothing to do with their number; made once.
fn short_study() -> &'static Path {
    static STUDY: OnceLock<PathBuf> = OnceLock::new();
    STUDY.get_or_init(|| {
        let study = fresh_folder("study-pairs").join("short");
        simulate(&study, "2", &["--pairs", "6"]);
        study
    })
}

#[test]
fn pairs_replay_to_the_last_bit_rebuild_and_tell_no_value_in_the_journal() {
    let study = fresh_folder("study-pairs-rebuilt").join("study");
    copy_folder(short_study(), &study);
    for journal in journals(&study) {
        let folder = journal.parent().expect("a folder");
        let replayed = said(&["replay", text(folder)]);
        assert!(replayed.contains("agree."), "{replayed}");
        let content = fs::read_to_string(&journal).expect("text");
        for word in ["elasticity", "objects.", "difference", "standard"] {
            assert!(!content.contains(word), "{word} in {}", journal.display());
        }
        let throws = entries(&journal)
            .iter()
            .filter(|entry| entry["study"]["note"] == "throw")
            .count();
        assert_eq!(throws, 12);
    }
    comes_out_of_its_journals(&study);
    let copy = fresh_folder("study-pairs-copy").join("csv");
    said(&[
        "study",
        "export",
        text(&study),
        "--csv",
        "--out",
        text(&copy),
    ]);
    let pairs = fs::read_to_string(copy.join("pairs.csv")).expect("the pairs");
    assert_eq!(pairs.lines().count(), 1 + 12, "{pairs}");
    let script = Path::new(env!("CARGO_MANIFEST_DIR")).join("scripts/bids-validate.sh");
    let validated = std::process::Command::new(script)
        .arg(study.join("data"))
        .output()
        .expect("the script starts");
    let is_missing = validated.status.code() == Some(3);
    assert!(
        validated.status.success() || is_missing && std::env::var_os("BOWLING_NO_BIDS").is_some(),
        "{}{}",
        String::from_utf8_lossy(&validated.stdout),
        String::from_utf8_lossy(&validated.stderr)
    );
}

/// The room of each throw has the value that the table says, and nothing else differs.
#[test]
fn each_throw_is_made_with_the_value_of_the_table() {
    let study = short_study();
    let journal = journals(study).remove(0);
    let participant = journal.ancestors().nth(2).and_then(Path::file_name);
    let participant = participant.and_then(|name| name.to_str()).expect("an id");
    let table = pairs_of(study)
        .into_iter()
        .find(|path| text(path).contains(participant))
        .expect("the participant's");
    let pairs = numbers(&table, "first")
        .into_iter()
        .zip(numbers(&table, "second"));
    let expected: Vec<f64> = pairs.flat_map(|(first, second)| [first, second]).collect();
    let story = journal::read_open(&journal).expect("whole");
    let changes = Changes::of(&journal, &story.header, &story.notes).expect("they fit");
    let conditions = journal::settings::of(&journal, &story.header).expect("kept");
    let standard = conditions.lobby.clone();
    let mut game = Game::new(conditions, story.header.frames).expect("an alley");
    let mut thrown = Vec::new();
    for (index, input) in story.inputs.iter().enumerate() {
        changes.before(index, &mut game).expect("it is laid out");
        game.step(input);
        let is_settled = |event: &Event| matches!(event.kind, EventKind::Settled { .. });
        if game.events().iter().any(is_settled) {
            let mut config = game.config().clone();
            thrown.push(config.objects.elasticity);
            config.objects.elasticity = standard.objects.elasticity;
            assert_eq!(config, standard);
        }
    }
    assert_eq!(thrown.len(), 12);
    for (value, said) in thrown.iter().zip(&expected) {
        // The table has six decimals.
        assert!((value - said).abs() < 1e-6, "{thrown:?} {expected:?}");
    }
    assert!(thrown.iter().any(|value| *value != 1.0), "{thrown:?}");
}

/// There are no games whose order and buttons could be balanced.
#[test]
fn a_study_of_pairs_is_verified_by_what_it_compares() {
    let verified = said(&["study", "verify", text(short_study())]);
    assert!(
        verified.contains("2 participants, 6 pairs of throws each, 20 % of them"),
        "{verified}"
    );
    assert!(
        verified.contains("objects.elasticity is 1 in one"),
        "{verified}"
    );
    for word in ["Red", "Blue", "game", "level"] {
        assert!(!verified.contains(word), "{verified}");
    }
}

/// Head and hand are in one table from the first pair on, and the events have each throw of each pair once, within it.
#[test]
fn pairs_have_motion_and_events() {
    let study = short_study();
    let all = experiment::files::list(&study.join("data")).expect("readable");
    let named = |end: &str| -> Vec<&PathBuf> {
        let of = all.iter().filter(|path| text(path).ends_with(end));
        of.collect()
    };
    let motion = named("_task-pairs_tracksys-script_run-1_motion.tsv");
    let events = named("_task-pairs_tracksys-script_run-1_events.tsv");
    assert_eq!((motion.len(), events.len()), (2, 2));
    for (motion, events) in motion.into_iter().zip(events) {
        let table = fs::read_to_string(motion).expect("a table");
        let time = |line: &str| -> f64 {
            let cell = line.split('\t').next().expect("a cell");
            cell.parse().expect("a number")
        };
        let times: Vec<f64> = table.lines().map(time).collect();
        assert_eq!(times[0], 0.0);
        assert!(times.windows(2).all(|two| two[1] > two[0]));
        let kinds = column(events, "trial_type").into_iter();
        let (pairs, throws) = (column(events, "frame"), column(events, "ball"));
        let (onset, duration) = (numbers(events, "onset"), column(events, "duration"));
        let mut thrown = Vec::new();
        for (row, kind) in kinds.enumerate().filter(|(_, kind)| kind == "ball_roll") {
            let cell = |cells: &[String]| -> u32 { cells[row].parse().expect(&kind) };
            thrown.push((cell(&pairs), cell(&throws)));
            let rest = onset[row] + duration[row].parse::<f64>().expect("a number");
            assert!(onset[row] > 0.0 && rest <= *times.last().expect("rows"));
        }
        let all: Vec<(u32, u32)> = (1..=6).flat_map(|pair| [(pair, 1), (pair, 2)]).collect();
        assert_eq!(thrown, all);
    }
}

/// What `analyse` says of pairs, against counts from the tables here.
#[test]
fn a_study_of_pairs_is_analysed() {
    let study = short_study();
    let out = fresh_folder("study-pairs-analysed");
    let arguments = ["analyse", text(study), "--out", text(&out)];
    let printed = said(&arguments);
    let report = fs::read_to_string(out.join("report.json")).expect("a report");
    let report: Value = serde_json::from_str(&report).expect("JSON");
    let close = |found: &Value, expected: f64| {
        let found = found.as_f64().expect("a number");
        assert!((found - expected).abs() < 2e-6, "{found} {expected}");
    };
    assert_eq!(report["parameter"], "objects.elasticity");
    let thresholds = study.join("data/phenotype/thresholds.tsv");
    let ids = column(&thresholds, "participant_id");
    let values = numbers(&thresholds, "threshold");
    let (mut alarms, mut catches, mut logs) = (0, 0, 0.0);
    for (row, id) in ids.iter().enumerate() {
        let one = &report["participants"][row];
        assert_eq!(
            (&one["id"], &one["pairs"]),
            (&id.as_str().into(), &6.into())
        );
        close(&one["rule"]["threshold"], values[row]);
        close(&one["rule"]["low"], numbers(&thresholds, "low")[row]);
        // The rule is the Bayesian one: the fit to its pairs is its own estimate.
        close(&one["fitted"]["threshold"], values[row]);
        let slope = one["fitted"]["slope"].as_f64().expect("a number");
        assert!((1.0..=5.0).contains(&slope), "{slope}");
        let pairs = pairs_of(study);
        let pairs = pairs.iter().find(|path| text(path).contains(id.as_str()));
        let pairs = pairs.expect("the participant's");
        let replies = column(pairs, "reply").into_iter();
        for (off, reply) in numbers(pairs, "difference").into_iter().zip(replies) {
            catches += u32::from(off == 0.0);
            alarms += u32::from(off == 0.0 && reply == "different");
        }
        logs += values[row].ln() / ids.len() as f64;
        assert!(printed.contains(&format!("  {id}")), "{printed}");
    }
    let together = &report["together"];
    assert_eq!(together["pairs"], 12);
    assert_eq!(together["false_alarms"]["catches"], catches);
    assert_eq!(together["false_alarms"]["alarms"], alarms);
    close(&together["threshold"]["geometric_mean"], logs.exp());
    let page = fs::read_to_string(out.join("report.html")).expect("a page");
    assert_eq!(page.matches("<svg").count(), 2);
    assert!(page.contains("false alarms") && page.contains("geometric mean"));
    for figure in ["thresholds.svg", "shares.svg"] {
        assert!(out.join(figure).is_file(), "{figure}");
    }
    let output = bowling(&[&arguments[..], &["--seed", "2"]].concat());
    assert_eq!(output.status.code(), Some(2));
    let refused = String::from_utf8_lossy(&output.stderr);
    assert!(refused.contains("belong to studies of games"), "{refused}");
}

#[test]
fn a_session_of_pairs_that_is_killed_goes_on_and_is_the_same_person() {
    let study = fresh_folder("study-pairs-killed").join("study");
    let plan = [&["--training", "1", "--pairs", "8"][..], &ELASTICITY].concat();
    new_study_with(&study, &plan);
    let seed = 5;
    let mut random = SplitMix64::new(seed);
    let mut kills = 0;
    loop {
        let mut child = begin(&go_on(&study), &study);
        // No synchronisation: the instant of the kill is what is random.
        let wait = 0.05 + 0.4 * random.uniform();
        std::thread::sleep(std::time::Duration::from_secs_f64(wait));
        let ended = child.try_wait().expect("known");
        if ended.is_none() && kills < 12 {
            child.kill().expect("it runs");
            child.wait().expect("it ended");
            kills += 1;
            continue;
        }
        let output = child.wait_with_output().expect("it ended");
        let errors = String::from_utf8_lossy(&output.stderr);
        assert!(
            output.status.success(),
            "seed {seed}, {kills} kills: {errors}"
        );
        break;
    }
    assert!(kills > 0, "it was too fast to be killed");
    said(&["study", "rebuild", text(&study)]);
    let listed = said(&["study", "status", text(&study)]);
    assert!(listed.contains("  complete"), "{listed}");
    let last = journals(&study).pop().expect("a journal");
    let replayed = said(&["replay", text(last.parent().expect("a folder"))]);
    assert!(replayed.contains("agree."), "{replayed}");
    assert_eq!(column(&pairs_of(&study)[0], "reply").len(), 8);
}

#[test]
fn what_cannot_be_compared_is_refused_in_a_sentence() {
    let folder = fresh_folder("study-pairs-refused");
    let study = folder.join("study");
    let new = |arguments: &[&'static str]| {
        let mut all = vec!["study", "simulate", text(&study), "--scheme", "staircase"];
        all.extend(arguments);
        all
    };
    let ends = ["--standard", "1", "--furthest", "0"];
    let with = |key: &'static str| [&["--parameter", key][..], &ends].concat();
    for (arguments, words) in [
        (with("objects.bounce"), "objects.bounce is no number"),
        (with("objects.shape"), "objects.shape is no number"),
        (with("lane.width_m"), "lane.width_m"),
        (
            [&with("objects.elasticity")[..], &["--pairs", "0"]].concat(),
            "trials is 0",
        ),
    ] {
        let refused = refusal(&new(&arguments));
        assert!(refused.contains(words), "{refused}");
    }
    let output = bowling(&new(&["--parameter", "objects.elasticity"]));
    assert_eq!(output.status.code(), Some(2));
    let refused = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(
        refused.contains("needs --parameter, --standard"),
        "{refused}"
    );
    for (more, words) in [
        (["--threshold", "0"], "has to be a number above 0"),
        (["--threshold", "nan"], "has to be a number above 0"),
        (
            ["--training-in-the-scene", "--items-after-each-game"],
            "belong to games",
        ),
    ] {
        let asked = [&with("objects.elasticity")[..], &more].concat();
        let output = bowling(&new(&asked));
        assert_eq!(output.status.code(), Some(2), "{more:?}");
        let refused = String::from_utf8_lossy(&output.stderr).into_owned();
        assert!(refused.contains(words), "{refused}");
    }
    assert!(!study.exists(), "nothing is left behind");
}
