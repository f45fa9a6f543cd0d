//! `bowling hard-cases`: what is hard for a rigid-body engine, each with the value that is right and a limit.
//!
//! A case compares with analysis or with what its source says, never with an earlier run of this program. One that
//! fails is listed as failing, with the reason where it is known. docs/hard-cases.md says how to read the table.

mod convergence;
mod detection;
mod determinism;
mod edges;
mod exact;
mod findings;
mod free_motion;
mod friction;
mod impacts;
mod laws;
mod oracle;
mod resting;
mod rocking;
pub(crate) mod scene;
mod shots;
mod stacks;
mod swarm;
mod tunnelling;

use std::io::{self, IsTerminal, Write};
use std::panic::catch_unwind;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::mpsc;
use std::time::Instant;

use anyhow::{Context, Result, bail};
use serde_json::{Value, json};

use crate::args::HardCasesArguments;
use findings::Outcome;

/// One hard case.
struct Case {
    /// Short name, for `--only`.
    name: &'static str,
    /// Section of docs/hard-cases.md that lists it.
    section: &'static str,
    /// What is right, and from where.
    expected: &'static str,
    /// When it counts as passed.
    criterion: &'static str,
    /// Tries it.
    run: fn() -> Outcome,
}

/// Begun before all others, because nothing takes as long: no core is idle while another works on them alone.
const LONGEST: [&str; 3] = ["fallen-pins-converge", "all-pairs", "same-bits-again"];

/// What came out of one case.
struct Report {
    outcome: Outcome,
    seconds: f64,
}

/// All cases, in the order of their sections.
fn all() -> Vec<&'static Case> {
    let tables = [
        free_motion::CASES,
        impacts::CASES,
        laws::CASES,
        shots::CASES,
        resting::CASES,
        rocking::CASES,
        friction::CASES,
        edges::CASES,
        stacks::CASES,
        tunnelling::CASES,
        detection::CASES,
        exact::CASES,
        swarm::CASES,
        determinism::CASES,
        convergence::CASES,
    ];
    let mut cases: Vec<&Case> = tables.into_iter().flatten().collect();
    cases.sort_by_key(|case| case.number());
    cases
}

impl Case {
    /// Its section as numbers: 3.10 comes after 3.9.
    fn number(&self) -> Vec<u32> {
        let parts = self.section.split('.');
        parts.filter_map(|part| part.parse().ok()).collect()
    }

    /// Whether `--only` asks for it: its name, the beginning of its name, its section or the chapter of that.
    fn is_meant(&self, only: &str) -> bool {
        let chapter = only.trim_end_matches('.');
        self.name.starts_with(only)
            || self.section == chapter
            || self.section.starts_with(&format!("{chapter}."))
    }
}

/// The cases that `only` asks for; one that is called exactly so is meant alone.
fn chosen(only: &str) -> Vec<&'static Case> {
    let cases = all();
    match cases.iter().find(|case| case.name == only) {
        Some(case) => vec![*case],
        None => cases
            .into_iter()
            .filter(|case| case.is_meant(only))
            .collect(),
    }
}

/// Checks what was given to `--only`.
///
/// # Errors
/// A sentence with the names, when no case is meant.
pub fn known_name(only: &str) -> Result<String, String> {
    if !only.is_empty() && !chosen(only).is_empty() {
        return Ok(only.to_owned());
    }
    let names: Vec<&str> = all().iter().map(|case| case.name).collect();
    Err(format!(
        "no hard case is called so; give a section, as 3 or 3.1, a name or the beginning of one of: {}",
        names.join(", ")
    ))
}

/// Tries the cases and prints what came out.
///
/// # Errors
/// When a case fails, or the table cannot be written.
pub fn hard_cases(arguments: &HardCasesArguments) -> Result<()> {
    let cases = match &arguments.only {
        Some(only) => chosen(only),
        None => all(),
    };
    let table = Table::new(&cases, arguments.json);
    let mut out = io::stdout().lock();
    let mut reports = Vec::new();
    let printed = table.head(&mut out).and_then(|()| {
        try_all(&cases, |case, report| {
            table.row(&mut out, case, &report)?;
            reports.push((case, report));
            Ok(())
        })?;
        table.foot(&mut out, &reports)
    });
    printed.context("the table cannot be written")?;
    let failed = reports.iter().filter(|(_, report)| !report.outcome.pass);
    let names: Vec<&str> = failed.map(|(case, _)| case.name).collect();
    if !names.is_empty() {
        bail!(
            "{} of {} hard cases fail: {}",
            names.len(),
            cases.len(),
            names.join(", ")
        );
    }
    Ok(())
}

/// Tries the cases on all cores and hands over what came out, in their order.
fn try_all<'a>(
    cases: &[&'a Case],
    mut hand_over: impl FnMut(&'a Case, Report) -> io::Result<()>,
) -> io::Result<()> {
    let workers = std::thread::available_parallelism().map_or(1, |n| n.get());
    let progress = Progress::new(cases.len());
    let mut order: Vec<usize> = (0..cases.len()).collect();
    order.sort_by_key(|at| !LONGEST.contains(&cases[*at].name));
    let next = AtomicUsize::new(0);
    let (send, receive) = mpsc::channel();
    std::thread::scope(|scope| {
        for _ in 0..workers {
            let (send, next, order, progress) = (send.clone(), &next, &order, &progress);
            scope.spawn(move || {
                while let Some(at) = order.get(next.fetch_add(1, Ordering::Relaxed)) {
                    progress.begins(cases[*at]);
                    if send.send((*at, try_one(cases[*at]))).is_err() {
                        // Nobody reads any more.
                        return;
                    }
                }
            });
        }
        drop(send);
        let mut waiting: Vec<Option<Report>> = cases.iter().map(|_| None).collect();
        let mut due = 0;
        while let Ok((at, report)) = receive.recv() {
            waiting[at] = Some(report);
            while let Some(report) = waiting.get_mut(due).and_then(Option::take) {
                progress.clear();
                hand_over(cases[due], report)?;
                due += 1;
            }
        }
        Ok(())
    })
}

/// Tries one case; a panic is a failure like others.
fn try_one(case: &Case) -> Report {
    let begun = Instant::now();
    let outcome = catch_unwind(case.run).unwrap_or_else(|_| Outcome {
        measured: "it panics; see the error stream".to_owned(),
        pass: false,
    });
    Report {
        outcome,
        seconds: begun.elapsed().as_secs_f64(),
    }
}

/// Says on a terminal's error stream what is being tried.
struct Progress {
    shown: bool,
    count: usize,
    begun: AtomicUsize,
}

impl Progress {
    fn new(count: usize) -> Progress {
        Progress {
            shown: io::stderr().is_terminal(),
            count,
            begun: AtomicUsize::new(0),
        }
    }

    fn begins(&self, case: &Case) {
        let number = self.begun.fetch_add(1, Ordering::Relaxed) + 1;
        if self.shown {
            eprint!("\r\x1b[K{number} of {}: {}", self.count, case.name);
        }
    }

    fn clear(&self) {
        if self.shown {
            eprint!("\r\x1b[K");
        }
    }
}

/// How the outcomes are written: a table for people, or JSON.
struct Table {
    json: bool,
    name: usize,
    expected: usize,
    criterion: usize,
}

impl Table {
    fn new(cases: &[&Case], json: bool) -> Table {
        let width = |text: fn(&Case) -> &str| {
            let widths = cases.iter().map(|case| text(case).chars().count());
            widths.max().unwrap_or(0)
        };
        Table {
            json,
            name: width(|case| case.name),
            expected: width(|case| case.expected),
            criterion: width(|case| case.criterion),
        }
    }

    fn head(&self, out: &mut impl Write) -> io::Result<()> {
        if self.json {
            return Ok(());
        }
        let Table {
            name,
            expected,
            criterion,
            ..
        } = *self;
        writeln!(
            out,
            "         time  case  {:name$}  {:expected$}  {:criterion$}  measured",
            "", "right", "criterion"
        )
    }

    fn row(&self, out: &mut impl Write, case: &Case, report: &Report) -> io::Result<()> {
        if self.json {
            return Ok(());
        }
        let Table {
            name,
            expected,
            criterion,
            ..
        } = *self;
        let verdict = if report.outcome.pass { "pass" } else { "FAIL" };
        writeln!(
            out,
            "{verdict}  {:5.1} s  {:4}  {:name$}  {:expected$}  {:criterion$}  {}",
            report.seconds,
            case.section,
            case.name,
            case.expected,
            case.criterion,
            report.outcome.measured
        )?;
        out.flush()
    }

    fn foot(&self, out: &mut impl Write, reports: &[(&Case, Report)]) -> io::Result<()> {
        if self.json {
            let all: Vec<Value> = reports.iter().map(|(c, r)| in_json(c, r)).collect();
            return writeln!(out, "{:#}", Value::from(all));
        }
        let passed = reports.iter().filter(|(_, r)| r.outcome.pass).count();
        writeln!(out, "{passed} of {} pass", reports.len())
    }
}

fn in_json(case: &Case, report: &Report) -> Value {
    json!({
        "name": case.name,
        "section": case.section,
        "expected": case.expected,
        "criterion": case.criterion,
        "measured": report.outcome.measured,
        "pass": report.outcome.pass,
        "seconds": report.seconds,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_unique_and_sections_are_numbers() {
        let cases = all();
        let is_known = |name: &&str| cases.iter().any(|case| case.name == *name);
        assert!(LONGEST.iter().all(is_known));
        for (i, case) in cases.iter().enumerate() {
            assert_eq!(case.number().len(), 2, "{}: {}", case.name, case.section);
            assert!(
                cases[..i].iter().all(|other| other.name != case.name),
                "two are called {}",
                case.name
            );
        }
    }

    #[test]
    fn a_section_means_its_cases_and_no_others() {
        let sections = |only: &str| -> Vec<&str> {
            let cases = chosen(only);
            cases.iter().map(|case| case.section).collect()
        };
        assert!(sections("3.1").iter().all(|section| *section == "3.1"));
        assert!(
            sections("2")
                .iter()
                .all(|section| section.starts_with("2."))
        );
        assert!(sections("2").len() > 5);
        assert_eq!(chosen("dzhanibekov").len(), 1);
    }

    #[test]
    fn an_unknown_name_is_answered_with_all_names() {
        let sentence = known_name("ball-dorp").expect_err("there is no such case");
        assert!(sentence.contains("ball-drop-elastic") && sentence.contains("dzhanibekov"));
        assert!(known_name("").is_err());
    }

    #[test]
    fn a_panic_is_a_failure() {
        let case = Case {
            name: "stumbles",
            section: "0.0",
            expected: "",
            criterion: "",
            run: || panic!("on purpose"),
        };
        let report = try_one(&case);
        assert!(!report.outcome.pass && report.outcome.measured.contains("panic"));
    }
}
