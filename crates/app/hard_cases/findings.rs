//! What a case measured, judged as it is noted down.

/// What came out of a case.
pub struct Outcome {
    /// What was measured, with units.
    pub measured: String,
    /// Whether every criterion was met.
    pub pass: bool,
}

/// Figures and their verdict, gathered while a case runs. What breaks its limit says so; a NaN breaks every limit.
pub struct Findings {
    said: Vec<String>,
    pass: bool,
}

impl Findings {
    /// Nothing measured yet.
    pub fn new() -> Findings {
        Findings {
            said: Vec::new(),
            pass: true,
        }
    }

    /// Notes a figure that must not exceed `limit`, both in `unit`.
    pub fn at_most(&mut self, what: &str, value: f64, limit: f64, unit: &str) {
        let over = if value <= limit {
            String::new()
        } else {
            self.pass = false;
            format!(" (limit {})", with_unit(limit, unit))
        };
        self.note(format!("{what} {}{over}", with_unit(value, unit)));
    }

    /// Notes a figure that must not fall below `limit`, both in `unit`.
    pub fn at_least(&mut self, what: &str, value: f64, limit: f64, unit: &str) {
        let under = if value >= limit {
            String::new()
        } else {
            self.pass = false;
            format!(" (at least {})", with_unit(limit, unit))
        };
        self.note(format!("{what} {}{under}", with_unit(value, unit)));
    }

    /// Notes a figure that must be `right` but for the share `tolerance`.
    pub fn near(&mut self, what: &str, value: f64, right: f64, tolerance: f64, unit: &str) {
        let off = if (value - right).abs() <= tolerance * right.abs() {
            String::new()
        } else {
            self.pass = false;
            format!(" (right {})", with_unit(right, unit))
        };
        self.note(format!("{what} {}{off}", with_unit(value, unit)));
    }

    /// Notes how many of `all` were wrong; none may be.
    pub fn none_of(&mut self, what: &str, wrong: usize, all: usize) {
        self.pass &= wrong == 0 && all > 0;
        self.note(format!("{wrong} of {all} {what}"));
    }

    /// Notes what went wrong, unless it holds.
    pub fn holds(&mut self, yes: bool, wrong: impl FnOnce() -> String) {
        if !yes {
            self.pass = false;
            self.note(wrong());
        }
    }

    /// Notes something that nothing is required of.
    pub fn note(&mut self, what: String) {
        self.said.push(what);
    }

    /// All of it in one line.
    pub fn outcome(self) -> Outcome {
        Outcome {
            measured: self.said.join(", "),
            pass: self.pass,
        }
    }
}

/// The larger of two figures; a NaN wins, so that it shows.
pub fn worse(a: f64, b: f64) -> f64 {
    if a.is_nan() || a > b { a } else { b }
}

fn with_unit(value: f64, unit: &str) -> String {
    let figure = figure(value);
    match unit {
        "" => figure,
        unit => format!("{figure} {unit}"),
    }
}

/// Four digits where that is readable, a power of ten elsewhere.
fn figure(value: f64) -> String {
    let size = value.abs();
    if value == 0.0 {
        "0".to_owned()
    } else if !(1e-3..1e5).contains(&size) {
        format!("{value:.1e}")
    } else {
        let digits = (3 - size.log10().floor() as i32).clamp(0, 6) as usize;
        let text = format!("{value:.digits$}");
        if text.contains('.') {
            text.trim_end_matches('0').trim_end_matches('.').to_owned()
        } else {
            text
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_broken_limit_fails_and_is_named() {
        let mut findings = Findings::new();
        findings.at_most("drift", 0.5, 1.0, "um");
        findings.at_most("tilt", 2.0, 1.0, "deg");
        let outcome = findings.outcome();
        assert!(!outcome.pass);
        assert_eq!(outcome.measured, "drift 0.5 um, tilt 2 deg (limit 1 deg)");
    }

    #[test]
    fn a_nan_breaks_every_limit() {
        let judged = |note: fn(&mut Findings)| {
            let mut findings = Findings::new();
            note(&mut findings);
            findings.outcome().pass
        };
        assert!(!judged(|f| f.at_most("", f64::NAN, 1.0, "")));
        assert!(!judged(|f| f.at_least("", f64::NAN, 1.0, "")));
        assert!(!judged(|f| f.near("", f64::NAN, 1.0, 0.1, "")));
        assert!(worse(f64::NAN, 1.0).is_nan() && worse(1.0, f64::NAN).is_nan());
        assert_eq!(worse(1.0, 2.0), 2.0);
    }

    #[test]
    fn figures_are_short() {
        for (value, text) in [
            (0.0, "0"),
            (12.0, "12"),
            (5.026_41, "5.026"),
            (1234.56, "1235"),
            (1.3e-7, "1.3e-7"),
            (f64::NAN, "NaN"),
        ] {
            assert_eq!(figure(value), text);
        }
    }
}
