//! The update of the normal: first order by reflection, as in Chung and Wang 1996, against second order.

use physics::query::{self, Limits};

use super::budget::Budget;
use super::oracle;
use super::poses::{self, CLASSES, Case};
use super::reflection;
use super::report::{Line, Measure, Point, Reason, Reference, Report, largest};
use super::timing::{Task, each, in_turns};

pub const NAME: &str = "update";

const SEED: u64 = 1997;
/// The largest cap that is tried.
const MOST: u32 = 20;
/// Gaps of the poses [m], and their names.
const GAPS: [(f64, &str); 3] = [
    (1e-3, "apart by 1 mm"),
    (1e-4, "apart by 0.1 mm"),
    (1e-5, "apart by 0.01 mm"),
];

const MEASURES: [Measure; 1] = [Measure {
    name: "unproven_share",
    words: "share of pairs apart that are not proven so",
    noise: 0.2,
}];

const SWINGS: &str = "a reflection does not shorten as it nears the normal that parts two shapes, and swings past it";

/// What is asked, and by which update.
#[derive(Clone, Copy, PartialEq)]
enum Method {
    Reflection,
    SecondOrder,
}

impl Method {
    fn name(self) -> &'static str {
        match self {
            Method::Reflection => "first order (reflection)",
            Method::SecondOrder => "second order",
        }
    }

    /// Whether it proves two shapes apart.
    fn proves(self, case: &Case, cap: u32) -> bool {
        let (a, b) = case.placed();
        match self {
            Method::Reflection => reflection::apart(a, b, cap).0,
            Method::SecondOrder => {
                let limits = Limits {
                    iteration_cap: cap,
                    ..Limits::default()
                };
                query::apart(a, b, None, limits).is_some()
            }
        }
    }
}

/// Measures the dial.
pub fn measure(budget: &Budget) -> Report {
    let mut lines = Vec::new();
    let mut differences = Vec::new();
    for (gap, panel) in GAPS {
        let cases: Vec<Case> = CLASSES
            .iter()
            .flat_map(|class| (0..budget.poses).map(|index| poses::case(class, gap, SEED, index)))
            .collect();
        for case in cases.iter().step_by(budget.poses / 5 + 1) {
            let (a, b) = case.placed();
            differences.push((oracle::along(a, b, case.normal) - gap).abs());
        }
        for method in [Method::Reflection, Method::SecondOrder] {
            lines.push(line(method, panel, &cases, budget));
        }
    }
    Report {
        dial: NAME,
        title: "first-order update by reflection (Chung and Wang 1996) against the second-order one",
        axis: "iteration cap",
        is_ordered: true,
        measures: MEASURES.to_vec(),
        lines,
        references: vec![Reference {
            truth: "all pairs are apart, as built".to_owned(),
            other: "the gap of their support planes along the known normal".to_owned(),
            difference: largest(differences),
            allowed: 1e-14,
            unit: "m",
        }],
        findings: Vec::new(),
    }
}

fn line(method: Method, panel: &str, cases: &[Case], budget: &Budget) -> Line {
    let mut line = Line::new(method.name(), panel, 1, "query");
    if method == Method::Reflection {
        line.reasons[0] = Some(Reason::up_to(0.2, SWINGS));
    }
    let mut tasks: Vec<Task> = Vec::new();
    for cap in 1..=MOST {
        tasks.push(each(cases, move |case| method.proves(case, cap)));
    }
    let times = in_turns(budget.rounds, &mut tasks);
    for (cap, time) in (1..=MOST).zip(times) {
        let missed = cases
            .iter()
            .filter(|case| !method.proves(case, cap))
            .count();
        line.points.push(Point {
            setting: cap.to_string(),
            value: f64::from(cap),
            is_default: method == Method::SecondOrder && cap == MOST,
            errors: vec![missed as f64 / cases.len() as f64],
            time,
            step_hz: None,
        });
    }
    line
}
