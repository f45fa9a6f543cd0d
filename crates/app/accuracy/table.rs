//! Reports as tables to read and as comma-separated values.

use std::borrow::Cow;
use std::fmt::Write;

use super::judge;
use super::report::{Line, Report};

/// Names of the columns; a time's low and high are quartiles of the rounds.
const HEAD: &str = "dial,panel,line,setting,value,is_default,measure,error,reference_error,time_of,time_median_ns,\
time_low_ns,time_high_ns,step_hz,time_per_step_us";
const WRITES: &str = "a string takes all text";

/// One row per measurement.
pub fn csv(reports: &[Report]) -> String {
    let mut text = format!("{HEAD}\n");
    for report in reports {
        for line in &report.lines {
            for point in &line.points {
                let time = point.time;
                let hz = point.step_hz.map_or(String::new(), |hz| format!("{hz}"));
                let step = point.step_hz.map_or(String::new(), |hz| {
                    format!("{:.4}", 1e-3 * time.median / hz)
                });
                for (index, measure) in report.measures.iter().enumerate() {
                    if !point.errors[index].is_finite() {
                        continue;
                    }
                    writeln!(
                        text,
                        "{},{},{},{},{},{},{},{:e},{:e},{},{:.2},{:.2},{:.2},{hz},{step}",
                        report.dial,
                        field(&line.panel),
                        field(&line.name),
                        field(&point.setting),
                        point.value,
                        point.is_default,
                        measure.name,
                        point.errors[index],
                        line.floors[index],
                        field(line.time_of),
                        time.median,
                        time.low,
                        time.high
                    )
                    .expect(WRITES);
                }
            }
        }
    }
    text
}

/// A cell, in quotes where a comma in it would end it (RFC 4180).
fn field(text: &str) -> Cow<'_, str> {
    if text.contains([',', '"']) {
        Cow::Owned(format!("\"{}\"", text.replace('"', "\"\"")))
    } else {
        Cow::Borrowed(text)
    }
}

/// The table of one dial, what it shows, and how its references were checked.
pub fn text(report: &Report) -> String {
    let mut text = format!("\n== {}: {}\n", report.dial, report.title);
    for line in &report.lines {
        rows(&mut text, report, line);
    }
    for reference in &report.references {
        writeln!(
            text,
            "reference: {} against {}: at most {:.1e} {} apart{}",
            reference.truth,
            reference.other,
            reference.difference,
            reference.unit,
            if reference.holds() { "" } else { " (TOO MUCH)" }
        )
        .expect(WRITES);
    }
    for finding in &report.findings {
        writeln!(text, "finding: {finding}").expect(WRITES);
    }
    for complaint in judge::unexplained(report) {
        writeln!(text, "NOT EXPLAINED: {complaint}").expect(WRITES);
    }
    text
}

fn rows(text: &mut String, report: &Report, line: &Line) {
    let (unit, scale) = unit_of(line);
    writeln!(text, "\n{}, {}", line.panel, line.name).expect(WRITES);
    write!(text, "  {:<22}{unit:>12} {:>19}", report.axis, "quartiles").expect(WRITES);
    for measure in &report.measures {
        write!(text, " {:>20}", measure.name).expect(WRITES);
    }
    text.push('\n');
    for point in &line.points {
        let mark = if point.is_default { " default" } else { "" };
        let setting = format!("{}{mark}", point.setting);
        let time = point.time;
        let [low, median, high] = [time.low, time.median, time.high].map(|t| digits(t * scale));
        write!(text, "  {setting:<22}{median:>12} {low:>9} {high:>9}").expect(WRITES);
        for error in &point.errors {
            let error = if error.is_finite() {
                format!("{error:.2e}")
            } else {
                "-".to_owned()
            };
            write!(text, " {error:>20}").expect(WRITES);
        }
        text.push('\n');
    }
    if line.points.len() < 2 {
        return;
    }
    for (index, measure) in report.measures.iter().enumerate() {
        if line.errors(index).iter().any(|e| !e.is_finite()) {
            continue;
        }
        let knee = judge::knee(line, index).map_or("none", |knee| &line.points[knee].setting);
        let words = if report.is_ordered {
            judge::sentence(line, index, measure).0
        } else {
            "no order".to_owned()
        };
        writeln!(text, "  {}: knee {knee}; {words}", measure.name).expect(WRITES);
    }
    if let Some(reason) = line.time_reason.filter(|_| judge::time_is_constant(line)) {
        writeln!(text, "  time: does not depend on the dial: {reason}").expect(WRITES);
    }
}

/// Name of the table's unit of time, and a nanosecond in it.
pub fn unit_of(line: &Line) -> (String, f64) {
    match line.time_of {
        "simulated second" => ("ms/s".to_owned(), 1e-6),
        _ => (format!("ns/{}", line.time_of), 1.0),
    }
}

/// A time with about three digits.
fn digits(time: f64) -> String {
    match time {
        t if t >= 100.0 => format!("{t:.0}"),
        t if t >= 10.0 => format!("{t:.1}"),
        t if t >= 1.0 => format!("{t:.2}"),
        t => format!("{t:.4}"),
    }
}
