//! What a dial leaves: lines of points, each with its errors and its time.

use super::timing::Time;

/// A kind of error; its name carries the unit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Measure {
    /// Name in the table, as `gap_p95_m`.
    pub name: &'static str,
    /// What it is, with the unit in brackets, for figures.
    pub words: &'static str,
    /// How much more than its predecessor an error may be before it counts as rising, as a share.
    pub noise: f64,
}

/// What a dial is set to, and what that costs and leaves.
#[derive(Clone, Debug)]
pub struct Point {
    /// The setting in words, as `20` or `1/720 s`.
    pub setting: String,
    /// The setting as a number on the dial's axis; the place in the list where there is no order.
    pub value: f64,
    /// Whether the program runs so unless it is told otherwise.
    pub is_default: bool,
    /// One for each measure of the report; infinite where it was not measured.
    pub errors: Vec<f64>,
    /// What it took.
    pub time: Time,
    /// Steps per simulated second [1/s], where it is a world that was timed.
    pub step_hz: Option<f64>,
}

/// Why an error stops falling, and what that is good for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Reason {
    /// In words.
    pub words: &'static str,
    /// The largest error that it explains.
    pub most: f64,
}

impl Reason {
    /// A reason for errors up to `most`.
    pub fn up_to(most: f64, words: &'static str) -> Reason {
        Reason { words, most }
    }
}

/// Points of one method over a dial.
#[derive(Clone, Debug)]
pub struct Line {
    /// The method or the pair.
    pub name: String,
    /// The picture that it belongs to.
    pub panel: String,
    /// What the times are of: `query`, `impact` or `simulated second`.
    pub time_of: &'static str,
    /// Error of the reference itself, for each measure: less cannot be told from nothing.
    pub floors: Vec<f64>,
    /// For each measure why an error stops falling above its floor, where that is known.
    pub reasons: Vec<Option<Reason>>,
    /// Why the time does not depend on the dial, where it does not.
    pub time_reason: Option<&'static str>,
    /// Whether it is somebody else's method, of which nothing is promised.
    pub is_peer: bool,
    /// In the dial's order, cheapest first.
    pub points: Vec<Point>,
}

/// Two ways to the same reference, and how far they are apart.
#[derive(Clone, Debug)]
pub struct Reference {
    /// What is taken for true.
    pub truth: String,
    /// What it was compared with.
    pub other: String,
    /// Largest difference of the two.
    pub difference: f64,
    /// The most that is taken for agreement.
    pub allowed: f64,
    /// Unit of both.
    pub unit: &'static str,
}

/// All that was measured on a dial.
#[derive(Clone, Debug)]
pub struct Report {
    /// Name on the command line.
    pub dial: &'static str,
    /// What it is, in a few words.
    pub title: &'static str,
    /// What is turned, for the head of the table.
    pub axis: &'static str,
    /// Whether a later setting is meant to be better than an earlier one.
    pub is_ordered: bool,
    /// Kinds of error, in the order of each point's.
    pub measures: Vec<Measure>,
    /// The lines.
    pub lines: Vec<Line>,
    /// How the references were checked.
    pub references: Vec<Reference>,
    /// What was found besides, in sentences.
    pub findings: Vec<String>,
}

impl Reference {
    /// Whether the two ways agree.
    pub fn holds(&self) -> bool {
        self.difference <= self.allowed
    }
}

impl Line {
    /// Errors of one measure along the line.
    pub fn errors(&self, measure: usize) -> Vec<f64> {
        self.points.iter().map(|p| p.errors[measure]).collect()
    }

    /// A line without points, whose errors nothing limits and nothing explains.
    pub fn new(
        name: impl Into<String>,
        panel: impl Into<String>,
        measures: usize,
        time_of: &'static str,
    ) -> Line {
        Line {
            name: name.into(),
            panel: panel.into(),
            time_of,
            floors: vec![0.0; measures],
            reasons: vec![None; measures],
            time_reason: None,
            is_peer: false,
            points: Vec::new(),
        }
    }
}

/// The largest of all; not a number if one of them is none.
pub fn largest(values: impl IntoIterator<Item = f64>) -> f64 {
    let worse = |x: f64, y: f64| if y > x || y.is_nan() { y } else { x };
    values.into_iter().fold(0.0, worse)
}

/// Value below which 95 of 100 lie; 0 of none.
pub fn p95(values: Vec<f64>) -> f64 {
    share_below(values, 0.95)
}

/// Value below which this share lies; 0 of none.
pub fn share_below(mut values: Vec<f64>, share: f64) -> f64 {
    values.sort_by(f64::total_cmp);
    let place = (share * values.len() as f64).ceil() as usize;
    values.get(place.saturating_sub(1)).copied().unwrap_or(0.0)
}
