//! Do as many pins fall whatever the step? The same jittered throws at two step rates, under each law.
//!
//!     cargo run --release --example step_rates              4000 throws, 1/90 and 1/1440 s
//!     cargo run --release --example step_rates 500 60 720

use std::path::Path;

use anyhow::{Result, bail};
use bowling_app::args::{Arguments, Command};
use bowling_app::shot::distribution::NORMAL_99;
use bowling_app::shot::fallen_counts;
use clap::Parser;

/// Fixed before the first run.
const SEED: &str = "1997";
/// Throws from a clean miss on one side to one on the other, of every strength.
const JITTER: [&str; 6] = [
    "--jitter-offset",
    "0.08",
    "--jitter-angle",
    "0.5",
    "--jitter-speed",
    "0.4",
];

fn main() -> Result<()> {
    let given: Vec<String> = std::env::args().skip(1).collect();
    let word = |index: usize, default| given.get(index).map_or(default, String::as_str);
    let (throws, rates) = (word(0, "4000"), [word(1, "90"), word(2, "1440")]);
    println!(
        "law         pins at 1/{} s   at 1/{} s   difference, 99 % interval",
        rates[0], rates[1]
    );
    for model in ["uno_slater", "guarded", "coulomb"] {
        let [coarse, fine] = rates.map(|rate| fallen(model, rate, throws));
        println!("{model:<12}{}", difference(&coarse?, &fine?));
    }
    Ok(())
}

/// Pins that fell in each throw.
fn fallen(model: &str, rate: &str, throws: &str) -> Result<Vec<f64>> {
    let words = ["bowling", "shot", "--model", model, "--frame-rate", rate];
    let more = ["--repeat", throws, "--seed", SEED];
    let all = words.iter().chain(&more).chain(&JITTER);
    let Some(Command::Shot(shot)) = Arguments::try_parse_from(all)?.command else {
        bail!("the second word is no longer `shot`");
    };
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let counts = fallen_counts(&shot, root)?;
    Ok(counts.into_iter().map(|count| count as f64).collect())
}

/// Both means, and their difference from throw to throw with its 99 % interval.
fn difference(coarse: &[f64], fine: &[f64]) -> String {
    let n = coarse.len() as f64;
    let mean = |values: &[f64]| values.iter().sum::<f64>() / n;
    let each: Vec<f64> = coarse.iter().zip(fine).map(|(a, b)| a - b).collect();
    let middle = mean(&each);
    let variance = each.iter().map(|x| (x - middle).powi(2)).sum::<f64>() / (n - 1.0);
    let half = NORMAL_99 * (variance / n).sqrt();
    let (low, high) = (middle - half, middle + half);
    let verdict = if low.abs().max(high.abs()) <= 0.3 {
        "within 0.3"
    } else {
        "NOT within 0.3"
    };
    format!(
        "{:>10.3}      {:>10.3}     {middle:+.3}, {low:+.3} to {high:+.3}: {verdict}",
        mean(coarse),
        mean(fine)
    )
}
