/// What the answers say.
mod answers;
/// What is no query, and what is said then.
mod refusals;

use std::fs;
use std::io::{BufRead, BufReader, Write};
use std::path::Path;
use std::process::{Command, Stdio};

use serde_json::{Value, json};

use crate::support::{bowling, fresh_folder};

/// The program with `query`, all three streams in our hands.
fn program(arguments: &[&str]) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_bowling"));
    command
        .arg("query")
        .args(arguments)
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped());
    command
}

/// What the program said to lines on its standard input.
struct Said {
    code: Option<i32>,
    lines: Vec<String>,
    error: String,
}

impl Said {
    fn values(&self) -> Vec<Value> {
        let value = |line: &String| serde_json::from_str(line).expect(line);
        self.lines.iter().map(value).collect()
    }

    /// The only answer.
    fn answer(&self) -> Value {
        assert_eq!(
            (self.code, self.lines.len()),
            (Some(0), 1),
            "{}",
            self.error
        );
        self.values().remove(0)
    }
}

fn ask(arguments: &[&str], input: impl Into<String>) -> Said {
    let mut child = program(arguments).spawn().expect("the program starts");
    let mut stdin = child.stdin.take().expect("it is a pipe");
    let input = input.into();
    let writer = std::thread::spawn(move || stdin.write_all(input.as_bytes()));
    let output = child.wait_with_output().expect("the program ends");
    writer
        .join()
        .expect("the writer does not panic")
        .expect("the program reads all lines");
    let text = String::from_utf8(output.stdout).expect("JSON is UTF-8");
    Said {
        code: output.status.code(),
        lines: text.lines().map(str::to_owned).collect(),
        error: String::from_utf8_lossy(&output.stderr).into_owned(),
    }
}

fn number(value: &Value) -> f64 {
    value
        .as_f64()
        .unwrap_or_else(|| panic!("{value} is no number"))
}

fn vector(value: &Value) -> [f64; 3] {
    [0, 1, 2].map(|k| number(&value[k]))
}

#[track_caller]
fn near(value: &Value, wanted: f64) {
    let value = number(value);
    assert!(
        (value - wanted).abs() < 1e-12,
        "{value} instead of {wanted}"
    );
}

fn sphere(radius: f64, x: f64) -> Value {
    json!({"shape": "sphere", "radius": radius, "position": [x, 0.0, 0.0]})
}

fn spheres(distance: f64) -> String {
    json!({"a": sphere(0.5, 0.0), "b": sphere(0.25, distance)}).to_string()
}

#[test]
fn a_line_is_answered_before_the_next_is_asked() {
    let mut child = program(&[]).spawn().expect("the program starts");
    let mut stdin = child.stdin.take().expect("it is a pipe");
    let mut answers = BufReader::new(child.stdout.take().expect("it is a pipe"));
    for distance in [2.0, 3.0, 1.0] {
        writeln!(stdin, "{}", spheres(distance)).expect("the program reads");
        let mut line = String::new();
        answers.read_line(&mut line).expect("the program answers");
        near(
            &serde_json::from_str::<Value>(&line).expect("JSON")["gap"],
            distance - 0.75,
        );
    }
    drop(stdin);
    assert!(child.wait().expect("the program ends").success());
}

#[test]
fn a_file_is_answered_in_its_order() {
    let folder = fresh_folder("query-order");
    let file = folder.join("pairs.jsonl");
    let lines: Vec<String> = (0..3_000).map(|k| spheres(1.0 + f64::from(k))).collect();
    // The last line has no end.
    fs::write(&file, lines.join("\n")).expect("writable");
    let output = bowling(&["query", &file.display().to_string()]);
    assert!(output.status.success());
    let text = String::from_utf8(output.stdout).expect("UTF-8");
    assert_eq!(text.lines().count(), 3_000);
    for (k, line) in text.lines().enumerate() {
        let gap = number(&serde_json::from_str::<Value>(line).expect("JSON")["gap"]);
        assert!((gap - (0.25 + k as f64)).abs() < 1e-9, "line {k}: {line}");
    }
}

#[test]
fn a_reader_that_goes_away_ends_it_quietly() {
    let mut child = program(&[]).spawn().expect("the program starts");
    let mut stdin = child.stdin.take().expect("it is a pipe");
    let mut answers = BufReader::new(child.stdout.take().expect("it is a pipe"));
    let input = format!("{}\n", spheres(2.0)).repeat(20_000);
    let writer = std::thread::spawn(move || {
        // Ends with an error when the program has gone before the last line.
        let _ = stdin.write_all(input.as_bytes());
    });
    let mut line = String::new();
    answers.read_line(&mut line).expect("an answer");
    drop(answers);
    let output = child.wait_with_output().expect("the program ends");
    writer.join().expect("the writer does not panic");
    assert_eq!(output.status.code(), Some(0));
    assert!(
        output.stderr.is_empty(),
        "{}",
        String::from_utf8_lossy(&output.stderr)
    );
}

#[test]
fn times_go_to_the_error_stream() {
    let input = format!("{}\n{}\n", spheres(2.0), spheres(0.5));
    let (timed, plain) = (ask(&["--time"], input.clone()), ask(&[], input));
    assert_eq!(timed.lines, plain.lines);
    assert!(plain.error.is_empty(), "{}", plain.error);
    let (time, rest) = timed.error.split_once(" ns per query").expect("a time");
    let time: f64 = time.parse().expect("a number");
    assert!(time > 0.0 && time < 1e6, "{time} ns");
    assert!(rest.contains("through 2"), "{rest}");
    assert_eq!(ask(&["--time"], "").error.trim(), "no query to time");
}

/// Answers to clouds from files, asked in the folder where they lie.
fn ask_in(folder: &Path, input: &Value) -> Value {
    let file = folder.join("pairs.jsonl");
    fs::write(&file, input.to_string()).expect("writable");
    let output = program(&["pairs.jsonl"])
        .current_dir(folder)
        .output()
        .expect("the program starts");
    serde_json::from_slice(&output.stdout).expect("one answer")
}

#[test]
fn a_cloud_comes_from_a_file_too() {
    let folder = fresh_folder("query-cloud");
    let mut text = "# a box\no box\n".to_owned();
    for k in 0..8 {
        let sign = |bit: i32| if k >> bit & 1 == 1 { 1.0 } else { -1.0 };
        text += &format!("v {} {} {}\n", 0.1 * sign(0), 0.2 * sign(1), 0.3 * sign(2));
    }
    fs::write(folder.join("box.obj"), text + "f 1 2 4 3\n").expect("writable");
    let cloud = json!({"shape": "cloud", "file": "box.obj", "position": [1.0, 0.0, 0.0]});
    let answer = ask_in(&folder, &json!({"a": sphere(0.5, 0.0), "b": cloud}));
    near(&answer["gap"], 1.0 - 0.1 - 0.5);

    fs::write(folder.join("bad.obj"), "v 0 0 0\nv 0 nan 0\n").expect("writable");
    for (file, words) in [
        ("bad.obj", ["bad.obj, line 2", "three numbers"]),
        ("pairs.jsonl", ["pairs.jsonl", "no vertices"]),
        ("none.obj", ["none.obj", "cannot be read"]),
    ] {
        let cloud = json!({"shape": "cloud", "file": file});
        let answer = ask_in(&folder, &json!({"a": cloud, "b": cloud}));
        let error = answer["error"].as_str().expect("a sentence");
        assert!(words.iter().all(|word| error.contains(word)), "{error}");
    }
}
