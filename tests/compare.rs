//! One recorded throw under several conditions: the real program, its tables and its pictures.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Output;
use std::sync::OnceLock;

use crate::recording::recording;
use crate::support::{bowling, fresh_folder};

/// A table by its first column and its header.
type Table = BTreeMap<String, BTreeMap<String, String>>;

fn table(path: &Path) -> Table {
    let text = fs::read_to_string(path).expect("a CSV file");
    let mut lines = text.lines();
    let head: Vec<&str> = lines.next().expect("a header").split(',').collect();
    lines
        .map(|line| {
            let fields: Vec<&str> = line.split(',').collect();
            assert_eq!(fields.len(), head.len(), "{line}");
            let named = head.iter().zip(&fields);
            let row = named.map(|(name, field)| (name.to_string(), field.to_string()));
            (fields[0].to_owned(), row.collect())
        })
        .collect()
}

fn number(row: &BTreeMap<String, String>, column: &str) -> f64 {
    row[column]
        .parse()
        .unwrap_or_else(|_| panic!("{column} is {}", row[column]))
}

fn text(path: &Path) -> String {
    path.display().to_string()
}

/// Compares and expects success; returns the folder and what was printed.
fn compare(name: &str, throw: &Path, arguments: &[&str]) -> (PathBuf, String) {
    let folder = fresh_folder(name).join("new");
    let (throw, out) = (text(throw), text(&folder));
    let mut all = vec!["compare", &throw, "--out", &out];
    all.extend(arguments);
    let output = bowling(&all);
    let printed = String::from_utf8(output.stdout).expect("UTF-8");
    let errors = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{errors}");
    (folder, printed)
}

/// Mass, radius and radius of gyration of the scene's first ball do not matter but for this ratio: how much of its slip a
/// ball loses in speed until it rolls, rg^2 / (rg^2 + r^2).
const SLIP_TO_SPEED: f64 = 0.0635 * 0.0635 / (0.0635 * 0.0635 + 0.108585 * 0.108585);
/// Speed of the shot [m/s], and its steps a second.
const SPEED: f64 = 7.0;
const RATE: f64 = 1440.0;

/// A ball that begins 18 m before the pins and hardly turns, kept in a file; and its result.
fn shot() -> &'static (PathBuf, serde_json::Value) {
    static SHOT: OnceLock<(PathBuf, serde_json::Value)> = OnceLock::new();
    SHOT.get_or_init(|| {
        let file = fresh_folder("compare-shot").join("throw.jsonl");
        let path = text(&file);
        let throw = "--speed 7 --start 18 --offset 0.05 --revs 1 --frame-rate 1440 --duration 4 --model uno_slater --json";
        let mut arguments = vec!["shot", "--record", &path];
        arguments.extend(throw.split(' '));
        let output = bowling(&arguments);
        assert!(output.status.success());
        let result = serde_json::from_slice(&output.stdout).expect("JSON");
        (file, result)
    })
}

#[test]
fn a_session_s_throw_falls_again_under_its_own_condition() {
    let (session, _) = recording();
    let arguments = "--conditions 101,red,111 --base red --no-video --tile 64 --at 0.4,3";
    let arguments: Vec<&str> = arguments.split(' ').collect();
    let (folder, printed) = compare("compare-session", session, &arguments);
    let rows = table(&folder.join("compare.csv"));
    // The journal says itself what fell.
    let journal = fs::read_to_string(session.join("journal.jsonl")).expect("the journal");
    let settled = journal
        .lines()
        .find(|line| line.contains("\"settled\""))
        .expect("a throw");
    let (_, fallen) = settled.split_once("\"fallen\":[").expect("a list");
    let (fallen, _) = fallen.split_once(']').expect("a list");
    assert_eq!(rows["red"]["fallen"].replace(' ', ","), fallen, "{printed}");
    // Red is E1 F1 S1: the same bits.
    assert_eq!(rows["111"]["apart_1cm_s"], "n/a");
    assert_eq!(number(&rows["111"], "largest_angle_deg"), 0.0);
    assert_eq!(rows["111"]["fallen"], rows["red"]["fallen"]);
    // Without friction the ball keeps its speed and meets the pins sooner.
    let sooner = number(&rows["111"], "first_hit_s") - number(&rows["101"], "first_hit_s");
    assert!(sooner > 0.3, "{sooner}");
    assert!(number(&rows["101"], "apart_1cm_s") < 1.0);
    let sheet = image::open(folder.join("contact-sheet.png"))
        .expect("a PNG")
        .to_rgb8();
    // Two rows of three pictures of 64 x 48, with room for names.
    assert!(
        sheet.width() > 3 * 64 && sheet.width() < 3 * 64 + 140,
        "{}",
        sheet.width()
    );
    assert!(
        sheet.height() > 2 * 48 && sheet.height() < 2 * 48 + 90,
        "{}",
        sheet.height()
    );
    // The same instant under the same condition looks the same, and under another one does not.
    let column =
        |index: u32| image::imageops::crop_imm(&sheet, 96 + index * 68, 64, 64, 48).to_image();
    assert_eq!(column(1).as_raw(), column(2).as_raw());
    assert_ne!(column(0).as_raw(), column(1).as_raw());
}

#[test]
fn friction_parts_paths_when_the_formula_says() {
    let (file, _) = shot();
    let arguments = ["--sweep", "friction=0..0.7:0.35", "--duration", "0.5"];
    let (folder, _) = compare("compare-friction", file, &arguments);
    let rows = table(&folder.join("friction.csv"));
    assert_eq!(rows.len(), 3, "{rows:?}");
    assert_eq!(rows["0.7"]["apart_1cm_s"], "n/a");
    assert_eq!(number(&rows["0.7"], "largest_angle_deg"), 0.0);
    // A lasting contact keeps (1 - f^2)^(60 t) of its slip; the ball's lag is its integral, times the share.
    let slip = SPEED - 0.108585 * std::f64::consts::TAU / 60.0;
    let lag = |rate: f64, time: f64| {
        let decay = -60.0 * (1.0 - rate * rate).ln();
        slip * SLIP_TO_SPEED * (time - (1.0 - (-decay * time).exp()) / decay)
    };
    for (name, other) in [("0", None), ("0.35", Some(0.35))] {
        let apart = |time: f64| lag(0.7, time) - other.map_or(0.0, |rate| lag(rate, time)) > 0.01;
        let when = (1..720)
            .map(|step| f64::from(step) / RATE)
            .find(|time| apart(*time));
        let when = when.expect("half a second is enough");
        let measured = number(&rows[name], "apart_1cm_s");
        assert!(
            (measured - when).abs() < 1.5 / RATE,
            "{name}: {measured}, not {when}"
        );
    }
    for ending in ["svg", "png"] {
        assert!(folder.join(format!("friction.{ending}")).exists());
    }
}

#[test]
fn a_shot_s_file_is_thrown_again_to_the_same_pins() {
    let (file, result) = shot();
    let arguments = "--conditions 011,111 --no-video --tile 64 --at 0.2";
    let arguments: Vec<&str> = arguments.split(' ').collect();
    let (folder, _) = compare("compare-shot-again", file, &arguments);
    let rows = table(&folder.join("compare.csv"));
    let mut fallen: Vec<u64> = result["fallen"]
        .as_array()
        .expect("a list")
        .iter()
        .filter_map(|n| n.as_u64())
        .collect();
    fallen.sort_unstable();
    let fallen: Vec<String> = fallen.iter().map(u64::to_string).collect();
    assert_eq!(rows["111"]["fallen"], fallen.join(" "));
    assert_eq!(rows["111"]["base"], "111", "what was thrown is the base");
    let hit = result["first_hit_s"].as_f64().expect("it hits");
    assert!((number(&rows["111"], "first_hit_s") - hit).abs() < 1.0 / RATE);
}

#[test]
fn all_conditions_come_with_pairs_a_verdict_and_a_video() {
    let (file, _) = shot();
    let arguments = ["--duration", "0.1", "--tile", "64", "--at", "0,0.1"];
    let (folder, printed) = compare("compare-all", file, &arguments);
    assert_eq!(table(&folder.join("compare.csv")).len(), 8);
    let pairs = fs::read_to_string(folder.join("pairs.csv")).expect("the pairs of Table 2");
    assert_eq!(pairs.lines().count(), 13, "{pairs}");
    // In a tenth of a second nothing but friction has done anything, and not much.
    let row = printed.lines().find(|line| line.starts_with("friction"));
    let words: Vec<&str> = row
        .expect("a line of the verdict")
        .split_whitespace()
        .collect();
    assert_eq!(
        words,
        ["friction", "6", "of", "6", "0", "of", "4", "n/a", "0.00"]
    );
    assert!(
        printed.contains("this throw contradicts Table 4"),
        "{printed}"
    );
    let video = fs::read(folder.join("compare.avi")).expect("a video");
    assert_eq!((&video[..4], &video[8..12]), (&b"RIFF"[..], &b"AVI "[..]));
    // Frames at 0, 1/30, 2/30 and 3/30 s.
    assert_eq!(
        u32::from_le_bytes(video[48..52].try_into().expect("four bytes")),
        4
    );
    let mut names: Vec<_> = fs::read_dir(&folder)
        .expect("the folder")
        .flatten()
        .map(|e| e.file_name())
        .collect();
    names.sort();
    assert_eq!(
        names,
        [
            "compare.avi",
            "compare.csv",
            "contact-sheet.png",
            "pairs.csv"
        ]
    );
}

#[test]
fn a_file_s_conditions_are_compared_by_their_names() {
    let (file, _) = shot();
    let conditions = fresh_folder("compare-file").join("mine.toml");
    let lines = "[[condition]]\nname = \"as it was\"\nset = []\n[[condition]]\nname = \"hop-free\"\nset = [\"physics.response=guarded\"]\n";
    fs::write(&conditions, lines).expect("writable");
    let path = text(&conditions);
    let arguments = [
        "--conditions",
        &path,
        "--duration",
        "0.1",
        "--tile",
        "64",
        "--at",
        "0",
        "--no-video",
    ];
    let (folder, printed) = compare("compare-file-out", file, &arguments);
    let rows = table(&folder.join("compare.csv"));
    assert_eq!(rows["hop-free"]["base"], "as it was", "{printed}");
    assert!(!printed.contains("Table 4"), "{printed}");
}

/// It must fail with one sentence that holds every one of `words`, and leave nothing.
fn assert_refused(throw: &Path, arguments: &[&str], words: &[&str]) {
    let out = fresh_folder("compare-refused").join("new");
    let (throw, path) = (text(throw), text(&out));
    let mut all = vec!["compare", &throw, "--out", &path];
    all.extend(arguments);
    let Output { status, stderr, .. } = bowling(&all);
    let said = String::from_utf8_lossy(&stderr);
    let errors: Vec<&str> = said
        .lines()
        .filter(|line| line.starts_with("error: ") && !line.contains("XDG_RUNTIME_DIR"))
        .collect();
    assert!(!status.success(), "{arguments:?}");
    assert_eq!(errors.len(), 1, "{said}");
    for word in words {
        assert!(errors[0].contains(word), "no `{word}` in: {said}");
    }
    assert!(!out.exists(), "something was written: {arguments:?}");
}

#[test]
fn what_cannot_be_compared_is_refused_in_a_sentence() {
    let (session, _) = recording();
    let (file, _) = shot();
    assert_refused(
        session,
        &["--throw", "99"],
        &["--throw 99", "give from 1 to"],
    );
    assert_refused(
        file,
        &["--conditions", "green"],
        &["green", "red, blue", "101"],
    );
    assert_refused(file, &["--conditions", "111"], &["from 2 to 8"]);
    assert_refused(file, &["--conditions", "111,111"], &["111 twice"]);
    assert_refused(file, &["--base", "112"], &["--base 112", "000, 001"]);
    assert_refused(
        file,
        &["--sweep", "mass=0..1:0.1"],
        &["--sweep", "cap=FROM..TO:STEP"],
    );
    assert_refused(
        file,
        &["--at", "3", "--duration", "2"],
        &["--at 3", "--duration"],
    );
    assert_refused(
        file,
        &["--set", "objects.elasticity=2"],
        &["objects.elasticity"],
    );
    assert_refused(
        Path::new("no-such-throw"),
        &[],
        &["no-such-throw", "bowling shot --record"],
    );
    assert_refused(
        Path::new("README.md"),
        &[],
        &["README.md line 1", "bowling play"],
    );
}

#[test]
fn a_throw_that_was_cut_short_or_a_room_that_changes_is_refused() {
    let folder = fresh_folder("compare-damaged");
    let (file, _) = shot();
    let whole = fs::read_to_string(file).expect("the shot");
    let cut = folder.join("cut.jsonl");
    let end = whole.trim_end().rfind('\n').expect("many lines");
    fs::write(&cut, &whole[..end]).expect("writable");
    assert_refused(&cut, &[], &["cut short"]);
    let conditions = folder.join("room.toml");
    let lines = "[[condition]]\nname = \"a\"\nset = []\n[[condition]]\nname = \"b\"\nset = [\"lane.width_m=1.0\"]\n";
    fs::write(&conditions, lines).expect("writable");
    let path = text(&conditions);
    assert_refused(file, &["--conditions", &path], &["condition b", "lane"]);
}
