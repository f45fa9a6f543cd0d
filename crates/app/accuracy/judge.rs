//! Where more accuracy stops paying, and whether an error behaves as a dial promises.

use super::report::{Line, Measure, Report};

/// Errors that lie this close together, as a share, are the same.
const SAME: f64 = 0.1;
/// Times that lie this close together, as a share, do not depend on the dial.
const SAME_TIME: f64 = 0.05;
/// The knee is the first setting whose error is at most this many times the best.
const KNEE: f64 = 2.0;

/// How an error goes along an ordered dial.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Course {
    /// It is the reference's own all along.
    Nothing,
    /// It falls as far as the reference can tell, or to the dial's end.
    Falls,
    /// It falls and stays above what the reference can tell, from the setting with this number.
    Plateau(usize),
    /// It does not depend on the dial.
    Constant,
    /// It rises by more than noise at the setting with this number.
    Rises(usize),
}

/// The course of an error along a dial.
pub fn course(errors: &[f64], floor: f64, noise: f64) -> Course {
    let told: Vec<f64> = errors.iter().map(|e| e.max(floor)).collect();
    let same = |x: f64, y: f64| x <= y * (1.0 + SAME) && y <= x * (1.0 + SAME);
    let (Some(first), Some(last)) = (told.first().copied(), told.last().copied()) else {
        return Course::Nothing;
    };
    if told.iter().all(|e| *e <= floor) {
        return Course::Nothing;
    }
    if told.iter().all(|e| same(*e, first)) {
        return Course::Constant;
    }
    if let Some(at) = (1..told.len()).find(|i| told[*i] > told[*i - 1] * (1.0 + noise)) {
        return Course::Rises(at);
    }
    let from = told.iter().position(|e| same(*e, last));
    match from {
        Some(from) if last > floor && told.len() - from >= 3 => Course::Plateau(from),
        _ => Course::Falls,
    }
}

/// The cheapest setting whose error is at most twice the best of the line, or the reference's own.
pub fn knee(line: &Line, measure: usize) -> Option<usize> {
    let errors = line.errors(measure);
    let best = errors.iter().copied().fold(f64::INFINITY, f64::min);
    let enough = (KNEE * best).max(line.floors[measure]);
    let good = (0..errors.len()).filter(|i| errors[*i].is_finite() && errors[*i] <= enough);
    good.min_by(|i, j| {
        let time = |k: &usize| line.points[*k].time.median;
        // Where times are as good as equal the earlier setting is the cheaper.
        if (time(i) - time(j)).abs() <= SAME_TIME * time(j) {
            i.cmp(j)
        } else {
            time(i).total_cmp(&time(j))
        }
    })
}

/// What the errors of a line do, in words; the second says whether that needs a reason that is missing.
pub fn sentence(line: &Line, index: usize, measure: &Measure) -> (String, bool) {
    let errors = line.errors(index);
    let at = |place: usize| line.points[place].setting.clone();
    // The words, and the errors that need a reason.
    let (words, odd) = match course(&errors, line.floors[index], measure.noise) {
        Course::Nothing => ("no more than the reference's own error".to_owned(), None),
        Course::Falls => (
            "falls to the end or to the reference's own error".to_owned(),
            None,
        ),
        Course::Constant => ("does not depend on the dial".to_owned(), Some(&errors[..])),
        Course::Plateau(from) => (format!("stays from {} on", at(from)), Some(&errors[from..])),
        Course::Rises(place) => (format!("rises at {}", at(place)), Some(&errors[place..])),
    };
    match (odd, line.reasons[index]) {
        (None, _) => (words, false),
        (Some(errors), Some(reason)) if errors.iter().all(|e| *e <= reason.most) => {
            (format!("{words}: {}", reason.words), false)
        }
        _ => (words, true),
    }
}

/// Whether no setting takes longer than another.
pub fn time_is_constant(line: &Line) -> bool {
    let times = line.points.iter().map(|p| p.time.median);
    let (least, most) = times.fold((f64::INFINITY, 0.0_f64), |(a, b), t| (a.min(t), b.max(t)));
    most <= least * (1.0 + SAME_TIME)
}

/// What is not as an ordered dial promises and has no reason.
pub fn unexplained(report: &Report) -> Vec<String> {
    if !report.is_ordered {
        return Vec::new();
    }
    let mut complaints = Vec::new();
    let ours = |line: &&Line| !line.is_peer && line.points.len() > 1;
    for line in report.lines.iter().filter(ours) {
        for (index, measure) in report.measures.iter().enumerate() {
            let errors = line.errors(index);
            if errors.iter().any(|e| e.is_nan()) {
                complaints.push(format!(
                    "{}, {}, {}: {} is not a number",
                    report.dial, line.panel, line.name, measure.name
                ));
            }
            if errors.iter().any(|e| !e.is_finite()) {
                continue;
            }
            let (words, needs) = sentence(line, index, measure);
            if needs {
                complaints.push(format!(
                    "{}, {}, {}: {} {words}",
                    report.dial, line.panel, line.name, measure.name
                ));
            }
        }
        if time_is_constant(line) && line.time_reason.is_none() {
            complaints.push(format!(
                "{}, {}, {}: the time does not depend on the dial",
                report.dial, line.panel, line.name
            ));
        }
    }
    for reference in report.references.iter().filter(|r| !r.holds()) {
        complaints.push(format!(
            "{}: {} and {} differ by {:.1e} {}, more than {:.1e}",
            report.dial,
            reference.truth,
            reference.other,
            reference.difference,
            reference.unit,
            reference.allowed
        ));
    }
    complaints
}

#[cfg(test)]
mod tests {
    use super::super::report::{Point, Reason};
    use super::super::timing::Time;
    use super::*;

    #[test]
    fn course_tells_falling_from_plateau_and_noise() {
        let course = |errors: &[f64]| course(errors, 1e-9, 0.2);
        assert_eq!(course(&[1.0, 0.1, 0.01]), Course::Falls);
        assert_eq!(course(&[1.0, 1e-10, 1e-12, 1e-11]), Course::Falls);
        assert_eq!(course(&[1.0, 0.5, 0.5, 0.5]), Course::Plateau(1));
        assert_eq!(course(&[0.5, 0.51, 0.5]), Course::Constant);
        assert_eq!(course(&[1.0, 1.15, 0.1]), Course::Falls);
        assert_eq!(course(&[1.0, 0.1, 0.2]), Course::Rises(2));
        assert_eq!(course(&[1e-12, 1e-10]), Course::Nothing);
    }

    #[test]
    fn sentence_takes_a_reason_for_small_errors_alone() {
        let measure = Measure {
            name: "length_m",
            words: "length",
            noise: 0.2,
        };
        let needs = |errors: [f64; 3], reason| {
            let mut line = Line::new("line", "panel", 1, "query");
            line.reasons[0] = reason;
            line.points = errors.map(point).to_vec();
            sentence(&line, 0, &measure).1
        };
        let reason = Some(Reason::up_to(1e-6, "because"));
        assert!(!needs([1.0, 0.1, 0.01], None));
        assert!(needs([1e-7, 1e-7, 1e-7], None));
        assert!(!needs([1e-7, 1e-7, 1e-7], reason));
        assert!(needs([1e-7, 1e-7, 0.4], reason));
    }

    fn point(error: f64) -> Point {
        Point {
            setting: String::new(),
            value: 0.0,
            is_default: false,
            errors: vec![error],
            time: Time::default(),
            step_hz: None,
        }
    }
}
