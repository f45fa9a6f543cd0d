//! Which functions a shot's instructions go to.

use std::fmt::Write;
use std::process::Command;

use physics::Response;

use crate::scenes::{DURATION, MODELS, counted_steps, shot};

/// Throws that are counted; each is the fourth of those that are timed.
pub const THROWS: u32 = 4;
/// Functions that are listed.
const LISTED: usize = 10;

/// What runs under valgrind: the profile's throws.
pub fn run(model: &str, rate: u32) {
    let (_, response) = MODELS
        .into_iter()
        .find(|(name, _)| *name == model)
        .expect("the report names a model that there is");
    for i in 0..THROWS {
        let mut world = shot(response, rate, 4 * i + 2);
        counted_steps(&mut world, rate * DURATION);
    }
}

/// The functions with the largest shares of the instructions of the steps, as a table.
pub fn of_a_shot(response: Response, rate: u32) -> String {
    let (model, _) = MODELS
        .into_iter()
        .find(|(_, other)| *other == response)
        .expect("every model has a name");
    let counts = std::env::temp_dir().join(format!("step-{}.callgrind", std::process::id()));
    let program = std::env::current_exe().expect("a running program has a path");
    let counted = Command::new("valgrind")
        .args([
            "--tool=callgrind",
            "--collect-atstart=no",
            "--toggle-collect=*counted_steps*",
        ])
        .arg(format!("--callgrind-out-file={}", counts.display()))
        .arg(program)
        .args(["run", model, &rate.to_string()])
        .output()
        .expect("valgrind has to be installed");
    assert!(
        counted.status.success(),
        "{}",
        String::from_utf8_lossy(&counted.stderr)
    );
    let told = Command::new("callgrind_annotate")
        .args(["--threshold=100", "--auto=no"])
        .arg(&counts)
        .output()
        .expect("callgrind_annotate comes with valgrind");
    std::fs::remove_file(&counts).expect("the counts were written");
    table(&String::from_utf8_lossy(&told.stdout))
}

/// Lines of callgrind_annotate, `COUNT (SHARE%) FILE:FUNCTION [OBJECT]`, as a table.
fn table(told: &str) -> String {
    let mut functions: Vec<(String, u64)> = Vec::new();
    let mut total = 0;
    for line in told.lines() {
        let Some((count, rest)) = line.split_once('(') else {
            continue;
        };
        let Ok(count) = count.trim().replace(',', "").parse::<u64>() else {
            continue;
        };
        if rest.contains("PROGRAM TOTALS") {
            total = count;
            continue;
        }
        let name = function(rest);
        match functions.iter_mut().find(|(other, _)| *other == name) {
            Some((_, sum)) => *sum += count,
            None => functions.push((name, count)),
        }
    }
    functions.sort_by_key(|(_, count)| u64::MAX - count);
    let per_second = total / u64::from(THROWS * DURATION);
    let mut text = format!(
        "{} million instructions per simulated second.\n\n| function | share |\n|---|--:|\n",
        per_second / 1_000_000
    );
    for (name, count) in functions.iter().take(LISTED) {
        let share = 100.0 * *count as f64 / total.max(1) as f64;
        let _ = writeln!(text, "| `{name}` | {share:.1} % |");
    }
    text
}

/// The function's name without file, object and hash: what stands behind the `:` of `SHARE%) FILE:NAME [OBJECT]`.
fn function(rest: &str) -> String {
    let named = rest.split_once(") ").map_or(rest, |(_, named)| named);
    let named = named
        .split_once(" [")
        .map_or(named, |(name, _)| name)
        .trim();
    // The file ends at the first single colon.
    let bytes = named.as_bytes();
    let single = (1..bytes.len().saturating_sub(1))
        .find(|&i| bytes[i] == b':' && bytes[i - 1] != b':' && bytes[i + 1] != b':');
    let name = single.map_or(named, |i| &named[i + 1..]);
    name.trim_end_matches("'2").to_owned()
}
