//! Writes docs/detection.md.

use std::fmt::Write;
use std::path::Path;

use crate::accuracy::{self, Tally};
use crate::judge::cases::Class;
use crate::{Filter, dial, machine, speed};

const INTRODUCTION: &str = "\
# Detection: how fast, how right

Written by `cargo bench -p physics --features peers --bench query -- report [POSES TO TIME] [POSES TO JUDGE]`; do not edit by hand.

";

const SPEED: &str = "\
## How fast

Times are medians of rounds in which the query from a cold start, the query from a normal that is 0.02 rad off, and
parry3d-f64's `contact` take turns on the same poses. Shapes measure about 1 m. Far: 1 m apart; near: 20 mm apart;
touching: 0.1 micrometres to 0.1 mm apart or overlapping; deep: at three quarters of the distance of touching. A gap above
50 mm is not refined, by either. `lane-pin` is a pin's base that rests on a half-space, `lanebox-pin` on a box.

";

const ACCURACY: &str = "\
## How right

Answers from a cold start, cap 20, before a judge that shares no code with the solver (`crates/physics/tests/detection/judge`):
half of the near and touching poses are built so that gap and normal are known; of the others a pair of points and a normal
bound the gap from both sides by the judge's own formulas, and where these do not meet, which is where bodies overlap, a dense
search over all normals decides. Wrong: off by more than 1e-6 of the size (the larger bounding radius), deep 1e-4; a normal off
by more than 1e-4 rad. Outside: the true gap lies outside the answer's interval. Too wide: converged, apart, and the interval is
wider than 1e-7 of the size. Unsaid: wrong, and not marked as capped or local. Warm: from a normal 0.02 rad off the answer.

";

const DIAL: &str = "\
## The dial

What an iteration buys: poses 20 mm apart whose gap is known, pairs without spheres and clouds; how far below the truth the proven gap is.

";

/// Measures everything, `timed` and `judged` poses for each pair and class, and writes the file.
pub fn write(timed: usize, judged: usize) {
    let mut text = format!(
        "{INTRODUCTION}{}\n\n{SPEED}{}\n",
        machine::describe(),
        speed::HEAD
    );
    add_speed(&mut text, timed);
    text.push_str(&format!("\n{ACCURACY}Seed {}.\n\n", accuracy::SEED));
    add_accuracy(&mut text, judged);
    text.push_str(&format!("\n{DIAL}{}\n", dial::HEAD));
    for line in dial::lines() {
        line_of(&mut text, &line);
    }
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/detection.md");
    std::fs::write(&path, text).expect("docs/ is in the repository and can be written");
    println!("written to docs/detection.md");
}

fn line_of(text: &mut String, line: &impl std::fmt::Display) {
    println!("{line}");
    writeln!(text, "{line}").expect("a string takes all text");
}

fn add_speed(text: &mut String, poses: usize) {
    let everything = Filter::everything();
    let (mut met, mut all) = (0, 0);
    for row in speed::rows(&everything, &everything, poses) {
        line_of(text, &row);
        met += u32::from(row.met());
        all += 1;
    }
    text.push('\n');
    line_of(text, &format!("{met} of {all} rows meet their targets."));
}

/// A row for each class over all pairs, then the rows of the pairs that have anything wrong.
fn add_accuracy(text: &mut String, poses: usize) {
    let everything = Filter::everything();
    let mut sums = Class::ALL.map(|class| Tally::new("all".to_owned(), class));
    let mut unclean = Vec::new();
    for tally in accuracy::tallies(&everything, &everything, poses, accuracy::SEED) {
        println!("{tally}");
        if !tally.is_clean() {
            unclean.push(tally.to_string());
        }
        if let Some(sum) = Class::ALL.iter().position(|class| *class == tally.class) {
            sums[sum].merge(tally);
        }
    }
    line_of(text, &accuracy::HEAD);
    for sum in &sums {
        line_of(text, sum);
    }
    if !unclean.is_empty() {
        text.push_str("\nThe pairs of which any answer was wrong, outside its interval, too wide or missed:\n\n");
        line_of(text, &accuracy::HEAD);
        for line in &unclean {
            line_of(text, line);
        }
    }
}
