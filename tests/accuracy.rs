use std::fs;
use std::io::{BufRead, BufReader};
use std::path::Path;
use std::process::{Command, Stdio};
use std::sync::LazyLock;

use bowling_app::accuracy::budget::Budget;
use bowling_app::accuracy::report::Report;
use bowling_app::accuracy::table::csv;
use bowling_app::accuracy::{judge, reports};

use crate::support::{bowling, fresh_folder};

fn measured(dial: &str) -> Report {
    let budget = Budget::new(true, Path::new(env!("CARGO_MANIFEST_DIR"))).expect("the settings");
    reports(&budget, Some(dial), |_, _| ()).remove(0)
}

/// Measured once for all tests.
static CAP: LazyLock<Report> = LazyLock::new(|| measured("cap"));

/// Errors along a line.
fn errors(report: &Report, panel: &str, name: &str, measure: usize) -> Vec<f64> {
    let mut lines = report.lines.iter();
    let line = lines.find(|line| line.panel == panel && line.name == name);
    line.expect("a line of this panel and name").errors(measure)
}

/// What is not as promised, apart from times, which other programs on the machine move.
fn complaints(report: &Report) -> Vec<String> {
    let mut all = judge::unexplained(report);
    all.retain(|complaint| !complaint.contains("the time does not depend"));
    all
}

#[test]
fn a_run_leaves_a_table_and_figures_and_the_same_errors_again() {
    let errors_of = |name: &str| {
        let folder = fresh_folder(name).join("new");
        let out = folder.display().to_string();
        let output = bowling(&["accuracy", "--quick", "--dial", "cap", "--out", &out]);
        assert!(output.status.success(), "{output:?}");
        let said = String::from_utf8_lossy(&output.stdout);
        assert!(
            said.contains("20 default") && said.contains("knee"),
            "{said}"
        );
        assert!(
            fs::read(folder.join("cap.png"))
                .expect("a picture")
                .starts_with(b"\x89PNG")
        );
        let svg = fs::read_to_string(folder.join("cap.svg")).expect("a figure");
        assert!(svg.starts_with("<svg") && svg.contains("frustum-frustum"));
        let table = fs::read_to_string(folder.join("accuracy.csv")).expect("a table");
        let mut rows = table.lines().map(|row| row.split(',').collect::<Vec<_>>());
        let head = rows.next().expect("a head");
        let column = |name: &str| head.iter().position(|h| *h == name).expect("a column");
        let (measure, error) = (column("measure"), column("error"));
        let (time, reference) = (column("time_median_ns"), column("reference_error"));
        let rows: Vec<Vec<String>> = rows
            .map(|row| {
                assert_eq!(row.len(), head.len());
                assert!(row[time].parse::<f64>().expect("a time") > 0.0);
                assert!(row[reference].parse::<f64>().expect("an error") > 0.0);
                let kept = [0, 1, 2, 3, measure, error];
                kept.map(|column| row[column].to_owned()).to_vec()
            })
            .collect();
        // Nine classes, four panels, twenty caps, two measures.
        assert!(rows.len() >= 9 * 4 * 20 * 2, "{}", rows.len());
        rows
    };
    assert!(errors_of("accuracy-a") == errors_of("accuracy-b"));
}

#[test]
fn errors_of_the_detection_fall_along_the_cap_to_rounding() {
    assert_eq!(complaints(&CAP), Vec::<String>::new());
    for name in ["ellipsoid-ellipsoid", "frustum-frustum", "frustum-box"] {
        let gaps = errors(&CAP, "apart cold", name, 0);
        assert!(
            gaps[0] > 1e6 * gaps[19] && gaps[19] < 1e-12,
            "{name} {gaps:?}"
        );
        // A warm start saves iterations.
        let warm = errors(&CAP, "apart warm", name, 0);
        assert!(warm[1] < gaps[1], "{name} {} {}", warm[1], gaps[1]);
    }
}

#[test]
fn a_reflection_leaves_close_pairs_unproven_and_the_second_order_does_not() {
    let report = measured("update");
    assert_eq!(complaints(&report), Vec::<String>::new());
    let first = errors(&report, "apart by 0.01 mm", "first order (reflection)", 0);
    let second = errors(&report, "apart by 0.01 mm", "second order", 0);
    assert!(
        first[19] > 0.02 && second[19] == 0.0,
        "{first:?} {second:?}"
    );
}

#[test]
fn errors_fall_along_the_other_dials_or_the_report_says_why_not() {
    for dial in [
        "ladder",
        "step",
        "solver",
        "continuous",
        "precision",
        "rolling",
        "bouncing",
        "response",
        "666",
        "elastic-666",
    ] {
        assert_eq!(complaints(&measured(dial)), Vec::<String>::new(), "{dial}");
    }
}

#[test]
fn a_column_without_change_or_explanation_is_a_complaint() {
    let mut report = CAP.clone();
    let line = report.lines.iter_mut().find(|line| line.name == "box-box");
    let line = line.expect("boxes are among the classes");
    line.reasons = vec![None; 2];
    line.floors = vec![1e-20; 2];
    line.time_reason = None;
    for point in &mut line.points {
        point.errors = vec![1e-5; 2];
        point.time.median = 100.0;
    }
    // Both errors and the time.
    assert_eq!(
        judge::unexplained(&report).len(),
        3 + judge::unexplained(&CAP).len()
    );
}

#[test]
fn a_comma_in_a_name_ends_no_cell() {
    let mut report = CAP.clone();
    report.lines.truncate(1);
    report.lines[0].points.truncate(1);
    report.lines[0].name = "a peer, \"quick\"".into();
    let table = csv(&[report]);
    let mut lines = table.lines();
    let cells = lines.next().expect("a head").split(',').count();
    let row = lines.next().expect("a row");
    assert!(row.contains(r#","a peer, ""quick""","#), "{row}");
    // As many commas outside of quotes as in the head.
    let outside = row.split('"').step_by(2);
    let commas: usize = outside.map(|part| part.matches(',').count()).sum();
    assert_eq!(commas, cells - 1, "{row}");
}

#[test]
fn an_interrupted_run_leaves_the_folder_as_it_was() {
    let folder = fresh_folder("accuracy-interrupted");
    fs::write(folder.join("accuracy.csv"), "of last time").expect("writable");
    let mut child = Command::new(env!("CARGO_BIN_EXE_bowling"))
        .args(["accuracy", "--quick", "--out"])
        .arg(&folder)
        .current_dir(env!("CARGO_MANIFEST_DIR"))
        .stdout(Stdio::piped())
        .spawn()
        .expect("the program starts");
    // The first table is there, and most dials are not measured yet.
    let mut lines = BufReader::new(child.stdout.take().expect("piped")).lines();
    assert!(lines.any(|line| line.expect("text").contains("== cap")));
    child.kill().expect("it still runs");
    child.wait().expect("it ends");
    let names: Vec<_> = fs::read_dir(&folder).expect("there").collect();
    assert_eq!(names.len(), 1);
    let kept = fs::read_to_string(folder.join("accuracy.csv")).expect("there");
    assert_eq!(kept, "of last time");
}

#[test]
fn a_dial_that_there_is_not_is_refused_with_the_dials() {
    let output = bowling(&["accuracy", "--dial", "colour"]);
    let said = String::from_utf8_lossy(&output.stderr).into_owned();
    assert_eq!(output.status.code(), Some(2), "{said}");
    for dial in [
        "cap",
        "update",
        "ladder",
        "step",
        "solver",
        "continuous",
        "response",
        "precision",
    ] {
        assert!(said.contains(dial), "{said}");
    }
    assert!(
        said.contains("rolling") && said.contains("elastic-666"),
        "{said}"
    );
}

#[test]
fn a_folder_that_cannot_be_written_is_refused_before_anything_is_measured() {
    let folder = fresh_folder("accuracy-unwritable");
    let file = folder.join("file");
    fs::write(&file, "in the way").expect("writable");
    let output = bowling(&["accuracy", "--out", &file.join("out").display().to_string()]);
    let said = String::from_utf8_lossy(&output.stderr).into_owned();
    assert_eq!(output.status.code(), Some(1), "{said}");
    assert!(said.contains("--out") && output.stdout.is_empty(), "{said}");
}
