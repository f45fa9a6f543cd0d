//! How fast is the detection, and how right? Against the targets, parry and the judge of the tests.
//!
//! `cargo bench -p physics --features peers --bench query` runs criterion's groups, and
//! `cargo bench -p physics --features peers --bench query -- speed [PAIRS] [CLASSES] [POSES]` prints the table of ratios, in which all
//! three contenders take turns in every round: `-- speed cyl-ell,box near,deep 500`. A pair is chosen by any part of
//! its name. `-- accuracy [PAIRS] [CLASSES] [POSES] [SEED]` judges the answers, on all cores, and prints the first wrong
//! ones of each row; `-- case PAIR CLASS INDEX [SEED]` shows one of them in full. `-- dial` tables accuracy against the cap. `-- report` writes docs/detection.md.
#![allow(
    clippy::disallowed_methods,
    reason = "a report may come from any library"
)]

#[path = "query/accuracy.rs"]
mod accuracy;
#[path = "query/dial.rs"]
mod dial;
#[path = "../tests/detection/judge/mod.rs"]
mod judge;
#[path = "query/machine.rs"]
mod machine;
#[path = "query/parry.rs"]
mod parry;
#[path = "query/report.rs"]
mod report;
#[path = "query/speed.rs"]
mod speed;
#[path = "../tests/support/mod.rs"]
mod support;
#[path = "query/targets.rs"]
mod targets;

use std::hint::black_box;

use criterion::Criterion;

/// Poses of a pair and class that a measurement goes through.
const POSES: usize = 200;

/// Which pairs and classes are meant: those whose name holds one of the words; no words mean all.
pub struct Filter(Vec<String>);

impl Filter {
    /// All pairs or classes.
    pub fn everything() -> Filter {
        Filter(Vec::new())
    }

    fn new(words: Option<&String>) -> Filter {
        let words = words.map_or("all", String::as_str);
        if words == "all" {
            return Filter::everything();
        }
        Filter(words.split(',').map(str::to_owned).collect())
    }

    /// Whether `name` is meant.
    pub fn takes(&self, name: &str) -> bool {
        self.0.is_empty() || self.0.iter().any(|word| name.contains(word.as_str()))
    }
}

/// A whole number from the command line.
fn number(word: Option<&String>, name: &str, default: usize) -> usize {
    let Some(word) = word else { return default };
    match word.parse() {
        Ok(number) => number,
        Err(_) => {
            eprintln!("{name}: `{word}` is not a whole number");
            std::process::exit(2);
        }
    }
}

fn main() {
    let words: Vec<String> = std::env::args()
        .skip(1)
        .filter(|word| word != "--bench")
        .collect();
    match words.first().map(String::as_str) {
        Some("speed") => {
            let (pairs, classes) = (Filter::new(words.get(1)), Filter::new(words.get(2)));
            let poses = words.get(3).map_or(POSES, |n| {
                n.parse()
                    .expect("the third word after `speed` counts poses")
            });
            println!("{}", machine::describe());
            println!("{}", speed::HEAD);
            for row in speed::rows(&pairs, &classes, poses) {
                println!("{row}");
            }
        }
        Some("accuracy") => {
            let (pairs, classes) = (Filter::new(words.get(1)), Filter::new(words.get(2)));
            let poses = number(words.get(3), "poses", accuracy::POSES);
            let seed = number(words.get(4), "seed", accuracy::SEED as usize) as u64;
            println!("{}", accuracy::HEAD);
            for tally in accuracy::tallies(&pairs, &classes, poses, seed) {
                println!("{tally}");
                for example in &tally.examples {
                    println!("    {example}");
                }
            }
        }
        Some("case") => {
            let pairs = Filter::new(words.get(1));
            let index = number(words.get(3), "index", 0);
            let seed = number(words.get(4), "seed", accuracy::SEED as usize) as u64;
            accuracy::show(&pairs, &Filter::new(words.get(2)), index, seed);
        }
        Some("dial") => {
            println!("{}", dial::HEAD);
            for line in dial::lines() {
                println!("{line}");
            }
        }
        Some("report") => {
            let timed = number(words.get(1), "poses to time", POSES);
            report::write(
                timed,
                number(words.get(2), "poses to judge", accuracy::POSES),
            );
        }
        _ => groups(),
    }
}

/// Criterion's own measurements: a group for each pair and class, with the three contenders in it.
fn groups() {
    let mut criterion = Criterion::default().configure_from_args();
    for scene in speed::scenes(&Filter::everything(), &Filter::everything(), POSES) {
        let mut group = criterion.benchmark_group(scene.name());
        let mut next = 0;
        let mut turn = || {
            next = (next + 1) % scene.trials.len();
            &scene.trials[next]
        };
        group.bench_function("cold", |b| b.iter(|| black_box(turn().cold())));
        group.bench_function("warm", |b| b.iter(|| black_box(turn().warm())));
        group.bench_function("parry", |b| b.iter(|| black_box(turn().parry())));
        group.finish();
    }
    criterion.final_summary();
}
