//! Writes docs/detection.md.

use std::fmt::Write;
use std::path::Path;

use crate::{Filter, machine, speed};

const INTRODUCTION: &str = "\
# Detection: how fast, how right

Written by `cargo bench -p physics --bench query -- report`; do not edit by hand.

";

const SPEED: &str = "\
## Speed

Times are medians of rounds in which the query from a cold start, the query from a normal that is 0.02 rad off, and
parry3d-f64's `contact` take turns on the same poses. Shapes measure about 1 m. Far: 1 m apart; near: 20 mm apart;
touching: 0.1 micrometres to 0.1 mm apart or overlapping; deep: at three quarters of the distance of touching. A gap above
50 mm is not refined, by either. `lane-pin` is a pin's base that rests on a half-space, `lanebox-pin` on a box.

";

/// Measures everything with `poses` poses for each pair and class, and writes the file.
pub fn write(poses: usize) {
    let everything = Filter(Vec::new());
    let mut text = format!(
        "{INTRODUCTION}{}\n\n{SPEED}{}\n",
        machine::describe(),
        speed::HEAD
    );
    let (mut met, mut all) = (0, 0);
    for row in speed::rows(&everything, &everything, poses) {
        println!("{row}");
        writeln!(text, "{row}").expect("a string takes all text");
        met += u32::from(row.met());
        all += 1;
    }
    writeln!(text, "\n{met} of {all} rows meet their targets.").expect("a string takes all text");
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/detection.md");
    std::fs::write(&path, text).expect("docs/ is in the repository and can be written");
    println!("{met} of {all} rows meet their targets; written to docs/detection.md");
}
