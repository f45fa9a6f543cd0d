//! `bowling accuracy`: what each step of accuracy costs in time, dial by dial, as work-precision diagrams.
//!
//! A dial is a function that measures and returns a [`report::Report`]; tables, figures and judgements know nothing of
//! what was measured. Errors depend on nothing but the arguments; times are processor time, taken in turns.

pub mod budget;
pub mod judge;
pub mod report;
pub mod timing;

mod cap;
mod continuous;
pub(crate) mod figure;
mod hits;
mod kernels;
pub(crate) mod ladder;
mod oracle;
mod overlay;
#[cfg(feature = "peers")]
mod peers;
mod poses;
mod precision;
mod profile;
mod racks;
mod reflection;
mod response;
mod simbench;
mod slide;
mod solver;
mod step;
pub mod table;
mod update;

use std::fs;
use std::io::Write;
use std::path::Path;

use anyhow::{Context, Result};
use indicatif::{ProgressBar, ProgressStyle};

use crate::args::AccuracyArguments;
use crate::output::Draft;
use budget::Budget;
use report::Report;

/// A dial: its name for `--dial`, its share of the work, and how it is measured.
struct Dial {
    name: &'static str,
    share: u64,
    measure: fn(&Budget) -> Report,
}

/// All dials, in the order of the reports.
const DIALS: &[Dial] = &[
    Dial {
        name: cap::NAME,
        share: 4,
        measure: cap::measure,
    },
    Dial {
        name: update::NAME,
        share: 1,
        measure: update::measure,
    },
    Dial {
        name: ladder::NAME,
        share: 6,
        measure: ladder::measure,
    },
    Dial {
        name: step::NAME,
        share: 8,
        measure: step::measure,
    },
    Dial {
        name: solver::NAME,
        share: 2,
        measure: solver::measure,
    },
    Dial {
        name: continuous::NAME,
        share: 4,
        measure: continuous::measure,
    },
    Dial {
        name: response::NAME,
        share: 4,
        measure: response::measure,
    },
    Dial {
        name: precision::NAME,
        share: 1,
        measure: precision::measure,
    },
    Dial {
        name: simbench::rolling::NAME,
        share: 4,
        measure: simbench::rolling::measure,
    },
    Dial {
        name: simbench::bouncing::NAME,
        share: 4,
        measure: simbench::bouncing::measure,
    },
    Dial {
        name: simbench::spheres::NAME,
        share: 8,
        measure: simbench::spheres::measure,
    },
    Dial {
        name: simbench::spheres::ELASTIC,
        share: 8,
        measure: simbench::spheres::measure_elastic,
    },
];

/// Checks what was given to `--dial`.
///
/// # Errors
/// A sentence with the names, when there is no such dial.
pub fn known_dial(name: &str) -> Result<String, String> {
    if DIALS.iter().any(|dial| dial.name == name) {
        return Ok(name.to_owned());
    }
    let names: Vec<&str> = DIALS.iter().map(|dial| dial.name).collect();
    Err(format!(
        "no dial is called so; give one of: {}",
        names.join(", ")
    ))
}

/// The dial of that name, or all of them.
fn chosen(only: Option<&str>) -> impl Iterator<Item = &'static Dial> {
    DIALS
        .iter()
        .filter(move |dial| only.is_none_or(|name| name == dial.name))
}

/// Measures one dial or all of them.
///
/// `done` is called after each.
///
/// # Panics
/// On the name of no dial; [`known_dial`] tells.
pub fn reports(
    budget: &Budget,
    only: Option<&str>,
    mut done: impl FnMut(&Report, u64),
) -> Vec<Report> {
    let reports = chosen(only).map(|dial| {
        let report = (dial.measure)(budget);
        done(&report, dial.share);
        report
    });
    let reports: Vec<Report> = reports.collect();
    assert!(!reports.is_empty(), "no dial is called {only:?}");
    reports
}

/// Measures, prints a table per dial, and writes accuracy.csv and the figures.
///
/// Nothing is written before the last dial, and each file appears only once it is whole: an interrupted run leaves the
/// folder as it was.
///
/// # Errors
/// When the scene's settings cannot be read, or the folder or the output not be written.
pub fn accuracy(arguments: &AccuracyArguments, root: &Path) -> Result<()> {
    let budget = Budget::new(arguments.quick, root)?;
    let folder = &arguments.out;
    let unwritten = || {
        format!(
            "cannot write {}: give another folder with --out",
            folder.display()
        )
    };
    // Found out before anything is measured.
    fs::create_dir_all(folder).with_context(unwritten)?;
    drop(Draft::at(&folder.join("accuracy.csv")).with_context(unwritten)?);
    let only = arguments.dial.as_deref();
    let progress = progress(only);
    let mut printed = Ok(());
    let reports = reports(&budget, only, |report, share| {
        progress.inc(share);
        progress.set_message(report.dial);
        let text = table::text(report);
        let print = || std::io::stdout().write_all(text.as_bytes());
        let result = progress.suspend(print);
        if printed.is_ok() {
            printed = result;
        }
    });
    progress.finish_and_clear();
    printed.context("the tables cannot be written")?;
    let mut files = vec![("accuracy.csv".to_owned(), table::csv(&reports).into_bytes())];
    for report in &reports {
        files.push((
            format!("{}.svg", report.dial),
            figure::svg(report)?.into_bytes(),
        ));
        files.push((format!("{}.png", report.dial), figure::png(report)?));
    }
    if only.is_none() {
        files.push((
            "overlay.svg".to_owned(),
            overlay::svg(&reports)?.into_bytes(),
        ));
        files.push(("overlay.png".to_owned(), overlay::png(&reports)?));
    }
    println!();
    for (name, content) in files {
        let mut draft = Draft::at(&folder.join(name))?;
        draft.write_all(&content).with_context(unwritten)?;
        println!("{}", draft.finish()?.display());
    }
    Ok(())
}

/// A bar on the error stream, which shows nothing where that is no terminal.
fn progress(only: Option<&str>) -> ProgressBar {
    let bar = ProgressBar::new(chosen(only).map(|dial| dial.share).sum());
    let style =
        ProgressStyle::with_template("{elapsed_precise} {wide_bar} {percent} %  after {msg}");
    bar.with_style(style.expect("the template is one"))
}
