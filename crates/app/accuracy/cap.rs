//! The paper's dial: the largest number of iterations of the detection, for each class of pair, cold and warm.

use glam::DVec3;
use physics::query::{Limits, Separation, separation};

use super::budget::Budget;
use super::oracle;
use super::poses::{self, CLASSES, Case, Class};
use super::report::{Line, Measure, Point, Reason, Reference, Report, largest, p95};
use super::timing::{Task, each, in_turns};
use experiment::random::SplitMix64;

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
            #[cfg(feature = "peers")]
            // For two boxes parry has an algorithm of its own, which docs/detection.md measures.
            if !panel.is_warm && class.name != "box-box" {
                report.lines.push(parry(class, panel, cases, budget));
            }
        }
    }
    report.references = references(&all);
    report.findings = findings(&report.lines);
    report
}

/// What a small cap saves, and how much longer parry takes where it is in the build.
fn findings(lines: &[Line]) -> Vec<String> {
    let mut all = Vec::new();
    for panel in PANELS {
        let here = || lines.iter().filter(move |line| line.panel == panel.name);
        let searched = here().filter(|line| line.points.len() > 1 && line.reasons[0].is_none());
        let shares = searched.map(|line| {
            let time = |index: usize| line.points[index].time.median;
            format!("{} {:.2}", line.name, time(0) / time(DEFAULT as usize - 1))
        });
        let shares: Vec<String> = shares.collect();
        all.push(format!(
            "{}: time of cap 1 over cap {DEFAULT}: {}",
            panel.name,
            shares.join(", ")
        ));
        let peers = here().filter(|line| line.is_peer).filter_map(|peer| {
            let name = peer.name.strip_suffix(super::figure::PARRY)?;
            let ours = here().find(|line| line.name == name)?.points.last()?;
            let theirs = peer.points.first()?;
            Some(format!(
                "{name} {:.1}",
                theirs.time.median / ours.time.median
            ))
        });
        let peers: Vec<String> = peers.collect();
        if !peers.is_empty() {
            all.push(format!(
                "{}: time of parry over ours: {}",
                panel.name,
                peers.join(", ")
            ));
        }
    }
    all
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
    line.reasons[1] = Some(Reason::up_to(1e-5, TOLERANCE));
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
        tasks.push(each(cases, move |case| ask(case, panel, cap)));
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
        (line.reasons, line.time_reason) =
            (vec![Some(Reason::up_to(1e-10, CLOSED)); 2], Some(CLOSED));
    }
    line
}

/// parry's GJK and EPA on the same support points, which have no dial.
#[cfg(feature = "peers")]
fn parry(class: &Class, panel: Panel, cases: &[Case], budget: &Budget) -> Line {
    let ask = |case: &Case| {
        let (a, b) = case.placed();
        super::peers::gap(a, b)
    };
    let name = format!("{}{}", class.name, super::figure::PARRY);
    let mut line = Line::new(name, panel.name, MEASURES.len(), "query");
    line.is_peer = true;
    let answers: Vec<_> = cases.iter().map(ask).collect();
    // No answer is as far off as the case is deep or apart, and knows no normal.
    let pairs = || answers.iter().zip(cases);
    let gaps =
        pairs().map(|(answer, case)| answer.map_or(case.gap.abs(), |a| (a.0 - case.gap).abs()));
    let normals = pairs().map(|(answer, case)| answer.map_or(1.0, |a| angle(a.1, case.normal)));
    let errors = vec![p95(gaps.collect()), p95(normals.collect())];
    let time = in_turns(budget.rounds, &mut [each(cases, ask)])[0];
    line.points.push(Point {
        setting: "GJK and EPA".to_owned(),
        value: 0.0,
        is_default: false,
        errors,
        time,
        step_hz: None,
    });
    line
}

/// Angle between two unit vectors [rad].
pub fn angle(a: DVec3, b: DVec3) -> f64 {
    libm::atan2(a.cross(b).length(), a.dot(b))
}

/// Constructed truth against the search of the sphere, and that search against one that looks three times as hard.
fn references(all: &[[Vec<Case>; 2]]) -> Vec<Reference> {
    let off = |case: &Case, samples, starts| {
        let (a, b) = case.placed();
        (oracle::largest(a, b, samples, starts).gap - case.gap).abs()
    };
    let apart = all.iter().flat_map(|[apart, _]| apart.iter().step_by(10));
    let built = largest(apart.map(|case| off(case, 600, 3)));
    let deep = all.iter().flat_map(|[_, deep]| deep.iter().step_by(4));
    let searched = largest(deep.map(|case| off(case, 5000, 12)));
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
