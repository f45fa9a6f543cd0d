//! The paper's dial: the largest number of iterations of the detection, for each class of pair, cold and warm.

use std::hint::black_box;

use glam::DVec3;
use physics::query::{Limits, Separation, separation};

use super::budget::Budget;
use super::oracle;
use super::poses::{self, CLASSES, Case, Class};
use super::report::{Line, Measure, Point, Reference, Report, p95};
use super::timing::{Task, in_turns};
use crate::random::SplitMix64;

pub const NAME: &str = "cap";

/// Seed of all poses.
const SEED: u64 = 1996;
/// The cap that the program runs with.
const DEFAULT: u32 = 20;
/// Errors of answers that are right to the last bits [m], [rad].
const ROUNDING: [f64; 2] = [1e-14, 1e-7];
/// What the search of the sphere can tell [m], [rad]: golden section ends where the gap's rounding hides the slope.
const SEARCHED: [f64; 2] = [1e-11, 3e-5];

const MEASURES: [Measure; 2] = [
    Measure {
        name: "gap_p95_m",
        words: "gap or depth is off by [m], 95 of 100 below",
        noise: 0.2,
    },
    Measure {
        name: "normal_p95_rad",
        words: "normal is off by [rad], 95 of 100 below",
        noise: 0.2,
    },
];

const CLOSED: &str = "a closed form answers, no iteration is made";

const TOLERANCE: &str = "a search ends where it expects to gain less than 1e-13 m, and a gap is flat at its top: (1e-13 m / 0.1 m)^(1/2) is 1e-6";
const WARM: &str =
    "from a warm start most searches end after one or two iterations, whatever the cap";

/// How poses lie, and where the search starts.
#[derive(Clone, Copy)]
struct Panel {
    name: &'static str,
    is_deep: bool,
    is_warm: bool,
}

const PANELS: [Panel; 4] = {
    const fn panel(name: &'static str, is_deep: bool, is_warm: bool) -> Panel {
        Panel {
            name,
            is_deep,
            is_warm,
        }
    }
    [
        panel("apart cold", false, false),
        panel("apart warm", false, true),
        panel("overlapping cold", true, false),
        panel("overlapping warm", true, true),
    ]
};

/// Measures the dial.
pub fn measure(budget: &Budget) -> Report {
    let mut report = Report {
        dial: NAME,
        title: "largest number of iterations of the detection, by class of pair",
        axis: "iteration cap",
        is_ordered: true,
        measures: MEASURES.to_vec(),
        lines: Vec::new(),
        references: Vec::new(),
        findings: Vec::new(),
    };
    let all: Vec<[Vec<Case>; 2]> = CLASSES.iter().map(|class| cases(class, budget)).collect();
    for panel in PANELS {
        for (class, cases) in CLASSES.iter().zip(&all) {
            let cases = &cases[usize::from(panel.is_deep)];
            report.lines.push(line(class, panel, cases, budget));
        }
    }
    report.references = references(&all);
    report
}

/// Poses apart, 1e-6 to 1e-1 of a metre scale, and overlapping ones.
fn cases(class: &Class, budget: &Budget) -> [Vec<Case>; 2] {
    let apart = (0..budget.poses).map(|index| {
        let mut random = SplitMix64::for_index(SEED ^ 7, index as u64);
        // From a thousandth of a millimetre to a decimetre.
        let gap = 0.1 * libm::pow(10.0, -5.0 * random.uniform());
        poses::case(class, gap, SEED, index)
    });
    let deep = (0..budget.deep_poses).map(|index| poses::deep(class, SEED, index, 1500, 6));
    [apart.collect(), deep.collect()]
}

fn ask(case: &Case, panel: Panel, cap: u32) -> Separation {
    let (a, b) = case.placed();
    let start = panel.is_warm.then_some(case.warm);
    let limits = Limits {
        iteration_cap: cap,
        ..Limits::default()
    };
    separation(a, b, start, limits)
}

fn line(class: &Class, panel: Panel, cases: &[Case], budget: &Budget) -> Line {
    let mut line = Line::new(class.name, panel.name, MEASURES.len(), "query");
    line.floors = if panel.is_deep { SEARCHED } else { ROUNDING }.to_vec();
    line.reasons[1] = Some(TOLERANCE);
    line.time_reason = panel.is_warm.then_some(WARM);
    let mut iterations = 0;
    let mut errors = Vec::new();
    for cap in 1..=DEFAULT {
        let answers: Vec<Separation> = cases.iter().map(|case| ask(case, panel, cap)).collect();
        iterations += answers.iter().map(|answer| answer.iterations).sum::<u32>();
        let pairs = || answers.iter().zip(cases);
        let gaps = pairs().map(|(answer, case)| (answer.gap - case.gap).abs());
        let normals = pairs().map(|(answer, case)| angle(answer.normal, case.normal));
        errors.push(vec![p95(gaps.collect()), p95(normals.collect())]);
    }
    let mut tasks: Vec<Task> = Vec::new();
    for cap in 1..=DEFAULT {
        tasks.push(Box::new(move || {
            for case in cases {
                black_box(ask(black_box(case), panel, cap));
            }
            cases.len() as u64
        }));
    }
    let times = in_turns(budget.rounds, &mut tasks);
    drop(tasks);
    for ((cap, errors), time) in (1..=DEFAULT).zip(errors).zip(times) {
        line.points.push(Point {
            setting: cap.to_string(),
            value: f64::from(cap),
            is_default: cap == DEFAULT,
            errors,
            time,
            step_hz: None,
        });
    }
    if iterations == 0 {
        (line.reasons, line.time_reason) = (vec![Some(CLOSED); 2], Some(CLOSED));
    }
    line
}

/// Angle between two unit vectors [rad].
pub fn angle(a: DVec3, b: DVec3) -> f64 {
    libm::atan2(a.cross(b).length(), a.dot(b))
}

/// Constructed truth against the search of the sphere, and that search against one that looks three times as hard.
fn references(all: &[[Vec<Case>; 2]]) -> Vec<Reference> {
    let (mut built, mut searched): (f64, f64) = (0.0, 0.0);
    for [apart, deep] in all {
        for case in apart.iter().step_by(10) {
            let (a, b) = case.placed();
            built = built.max((oracle::largest(a, b, 600, 3).gap - case.gap).abs());
        }
        for case in deep.iter().step_by(4) {
            let (a, b) = case.placed();
            searched = searched.max((oracle::largest(a, b, 5000, 12).gap - case.gap).abs());
        }
    }
    vec![
        Reference {
            truth: "gaps that the poses were built with".to_owned(),
            other: "a search of the sphere by support points alone".to_owned(),
            difference: built,
            allowed: SEARCHED[0],
            unit: "m",
        },
        Reference {
            truth: "depths by a search of the sphere from 1500 normals".to_owned(),
            other: "from 5000 normals, twice as many followed up".to_owned(),
            difference: searched,
            allowed: SEARCHED[0],
            unit: "m",
        },
    ]
}
