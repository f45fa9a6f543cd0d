//! Writes docs/rival.md and docs/rival.svg.

use std::fmt::Write;
use std::path::Path;
use std::time::Instant;

use crate::contenders::{ARRANGEMENTS, Contender, DataSet, Workload};
use crate::{machine, plot};

/// Polygons of the data sets that are measured; the first two are the paper's.
const SIZES: [usize; 7] = [419, 970, 2_000, 5_000, 10_000, 30_000, 100_000];
/// The size for which the issue of the detection sets a target.
const TARGET_POLYGONS: usize = 970;
/// All pairs of a heap.
const HEAP: [Workload; 2] = [Workload::Apart, Workload::Touching];
/// How many times as fast the parametric shapes are to be there.
const TARGET: f64 = 100.0;
/// Rounds in which the contenders take turns; figures are medians over them.
const ROUNDS: usize = 15;
/// Rounds end early after this time [s], but not before the third.
const PATIENCE: f64 = 20.0;
/// A turn goes on for at least this long [s], so that the clock's own step does not show.
const TURN: f64 = 0.005;

const INTRODUCTION: &str = "\
# The paper's rival

Written by `cargo bench -p physics --bench rival -- report`; do not edit by hand.

";

const WHAT: &str = "\
The paper compares its detection with a test of polyhedra, in which each point and edge of one is tested against the inside
of the other, on two data sets of 7 composite objects, 22 primitives, 419 and 970 polygons, and finds it 2.5 to 8 times as
fast (§2.1). Both data sets are rebuilt (`physics::rival`), and larger ones of the same objects.

Every method gets the same pairs of primitives in the same places: all that bounding spheres about objects and primitives do
not part. In a heap the objects are pushed together until they are between 1 mm deep and 1 mm apart; in a muddle they are
put down anywhere, which a simulation that answers contacts does not come to. The rival stops at the first point or edge inside, and for each at the first plane that has it outside.
*Parametric* is `query::apart` on the shapes themselves, from the line of centres; *warm* the same from the normal of 1/90 s
earlier (0.5 m/s, 3 rad/s); *contact* is `query::separation`, which also says where and how deep; *clouds* is `query::apart` on
the vertices of the polyhedra. Times are ns for a pair of primitives, medians of rounds in which the methods take turns.
";

const HEAD: &str = "\
| polygons | rival | parametric | warm | contact | clouds | rival / parametric | rival / warm | rival / contact | rival / clouds |
|--:|--:|--:|--:|--:|--:|--:|--:|--:|--:|
";

const GROWTH: &str = "\
## Growth

![Time for a pair of primitives against the number of polygons](rival.svg)

Power of the number of polygons with which the time for all pairs grows, by least squares on the logarithms (the paper:
its method in proportion, the rival \"geometrically\"):

| method | power |
|---|--:|
";

/// What one data set costs.
struct Row {
    polygons: usize,
    /// Median time for a pair of primitives [ns], for each workload, in the order of `Contender::ALL`.
    times: [Vec<f64>; 3],
    /// Pairs of primitives in each workload, and those of the heap that the rival finds to overlap.
    counts: [usize; 3],
    found: usize,
}

impl Row {
    fn measure(polygons: usize) -> Row {
        let data_set = DataSet::new(polygons);
        let scene = data_set.scene();
        let found = |workload| scene.runner(Contender::Rival, workload)();
        Row {
            polygons,
            times: Workload::ALL.map(|workload| {
                let count = scene.count(workload);
                let runners = Contender::ALL.map(|c| scene.runner(c, workload));
                taking_turns(runners, count)
            }),
            counts: Workload::ALL.map(|workload| scene.count(workload)),
            found: found(Workload::Apart) + found(Workload::Touching),
        }
    }

    fn count(&self, workload: Workload) -> usize {
        self.counts[workload as usize]
    }

    /// Mean over the pairs of some workloads [ns].
    fn time(&self, workloads: &[Workload], contender: Contender) -> f64 {
        let count: usize = workloads.iter().map(|&w| self.count(w)).sum();
        let time = |w: Workload| self.times[w as usize][contender as usize] * self.count(w) as f64;
        workloads.iter().map(|&w| time(w)).sum::<f64>() / count as f64
    }

    fn ratio(&self, workloads: &[Workload], contender: Contender) -> f64 {
        self.time(workloads, Contender::Rival) / self.time(workloads, contender)
    }

    fn line(&self, workloads: &[Workload]) -> String {
        let mut line = format!("| {} |", self.polygons);
        for contender in Contender::ALL {
            write!(line, " {:.0} |", self.time(workloads, contender)).expect("a string takes all");
        }
        for contender in &Contender::ALL[1..] {
            let ratio = self.ratio(workloads, *contender);
            write!(line, " {ratio:.1} |").expect("a string takes all");
        }
        line
    }
}

/// Median time of each runner for one of `count` pairs [ns].
fn taking_turns<const N: usize>(mut runners: [impl FnMut() -> usize; N], count: usize) -> Vec<f64> {
    let mut times = vec![Vec::new(); N];
    let started = Instant::now();
    for round in 0..ROUNDS {
        if round >= 3 && started.elapsed().as_secs_f64() > PATIENCE {
            break;
        }
        for (run, times) in runners.iter_mut().zip(&mut times) {
            let (turn, mut passes) = (Instant::now(), 0);
            while passes == 0 || turn.elapsed().as_secs_f64() < TURN {
                std::hint::black_box(run());
                passes += 1;
            }
            times.push(turn.elapsed().as_secs_f64() * 1e9 / f64::from(passes) / count as f64);
        }
    }
    let median = |mut values: Vec<f64>| {
        values.sort_by(f64::total_cmp);
        values[values.len() / 2]
    };
    times.into_iter().map(median).collect()
}

/// Slope of the line of least squares through the logarithms.
fn exponent(rows: &[Row], contender: Contender) -> f64 {
    let points: Vec<(f64, f64)> = rows
        .iter()
        .map(|row| {
            let time = row.time(&HEAP, contender);
            ((row.polygons as f64).ln(), time.ln())
        })
        .collect();
    let n = points.len() as f64;
    let x = points.iter().map(|p| p.0).sum::<f64>() / n;
    let y = points.iter().map(|p| p.1).sum::<f64>() / n;
    let rise: f64 = points.iter().map(|p| (p.0 - x) * (p.1 - y)).sum();
    let run: f64 = points.iter().map(|p| (p.0 - x) * (p.0 - x)).sum();
    rise / run
}

/// Measures the sizes and prints their tables.
pub fn print(sizes: &[usize]) {
    let rows: Vec<Row> = sizes.iter().map(|&size| Row::measure(size)).collect();
    print!("{}", tables(&rows));
}

/// Measures all data sets and writes both files.
pub fn write() {
    let mut rows = Vec::new();
    for polygons in SIZES {
        let row = Row::measure(polygons);
        println!("{}", row.line(&HEAP));
        rows.push(row);
    }
    let curves = Contender::ALL.map(|contender| plot::Curve {
        name: contender.name(),
        points: rows
            .iter()
            .map(|row| (row.polygons as f64, row.time(&HEAP, contender)))
            .collect(),
        exponent: exponent(&rows, contender),
    });
    let docs = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs");
    let machine = machine::describe();
    let text = format!(
        "{INTRODUCTION}{machine}\n\n{WHAT}\n{}{}",
        tables(&rows),
        growth(&rows)
    );
    for (name, text) in [("rival.md", text), ("rival.svg", plot::draw(&curves))] {
        std::fs::write(docs.join(name), text).expect("docs/ is in the repository and writable");
    }
    println!("written to docs/rival.md and docs/rival.svg");
}

fn tables(rows: &[Row]) -> String {
    let parts: [(&str, &[Workload]); 4] = [
        ("A heap", &HEAP),
        ("Those pairs of the heap that are apart", &[Workload::Apart]),
        (
            "Those pairs of the heap that overlap, by up to 1 mm",
            &[Workload::Touching],
        ),
        ("A muddle, pairs deeper than 5 mm", &[Workload::Deep]),
    ];
    let mut text = String::new();
    for (title, workloads) in parts {
        let count: usize = workloads.iter().map(|&w| rows[0].count(w)).sum();
        write!(text, "## {title}: {count} pairs\n\n{HEAD}").expect("a string takes all");
        for row in rows {
            writeln!(text, "{}", row.line(workloads)).expect("a string takes all");
        }
        text.push('\n');
    }
    if let Some(row) = rows.iter().find(|row| row.polygons == TARGET_POLYGONS) {
        text.push_str(&verdict(row));
    }
    let hundredfold = rows
        .iter()
        .find(|row| row.ratio(&HEAP, Contender::Parametric) >= TARGET);
    if let Some(row) = hundredfold {
        let polygons = row.polygons;
        writeln!(
            text,
            "Of these sizes {polygons} polygons are the first to reach {TARGET} times.\n"
        )
        .expect("a string takes all");
    }
    text
}

fn verdict(row: &Row) -> String {
    let ratio = |workloads: &[Workload]| row.ratio(workloads, Contender::Parametric);
    let all = ratio(&HEAP);
    let met = if all >= TARGET { "met" } else { "missed" };
    format!(
        "At {TARGET_POLYGONS} polygons parametric shapes are {all:.0} times as fast as the rival in a heap (target \
         {TARGET}: {met}),\nfrom the normal of 1/90 s earlier {:.0} times. Where pairs are apart it is {:.0} times, where \
         they touch {:.0}; in a muddle {:.1},\nbecause there the rival's first points decide. In {ARRANGEMENTS} heaps {} \
         pairs overlap; the rival finds {} of them, because its\npolyhedra are inscribed.\n\n\
         On the polyhedra's vertices the detection is {:.1} times as fast as the rival: the comparison that the paper \
         made, where\nits own method took time in proportion to the polygons, and in which it found 2.5 to 8.\n\n",
        row.ratio(&HEAP, Contender::Warm),
        ratio(&[Workload::Apart]),
        ratio(&[Workload::Touching]),
        ratio(&[Workload::Deep]),
        row.count(Workload::Touching),
        row.found,
        row.ratio(&HEAP, Contender::Cloud),
    )
}

fn growth(rows: &[Row]) -> String {
    let mut text = GROWTH.to_owned();
    for contender in Contender::ALL {
        let power = exponent(rows, contender);
        writeln!(text, "| {} | {power:.2} |", contender.name()).expect("a string takes all");
    }
    text
}
