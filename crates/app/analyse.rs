//! `bowling analyse`: the paper's tables, and what an honest reader needs beside them, as text, page and JSON.

mod figure;
mod honest;
mod html;
mod paper;
pub mod report;
pub mod text;

use std::io::Write;

use anyhow::{Context, Result};
use experiment::analysis::randomisation::Plan;
use experiment::analysis::study::Analysis;

use crate::args::AnalyseArguments;
use crate::output::Draft;

/// Analyses a study or a table.
///
/// # Errors
/// When the input cannot be used, by row and column, or the folder cannot be written.
pub fn analyse(arguments: &AnalyseArguments) -> Result<()> {
    let plan = Plan {
        draws: arguments.randomisations as usize,
        seed: arguments.seed,
    };
    let analysis = Analysis::of(&arguments.input, &arguments.model, plan)?;
    let blocks = report::blocks(&analysis);
    let figures = figure::figures(&analysis)?;
    let text = text::text(&blocks);
    let json = serde_json::to_string_pretty(&analysis.json())? + "\n";
    let title = format!("Analysis of {}", analysis.source);
    let page = html::page(&title, &blocks, &figures);
    let folder = &arguments.out;
    std::fs::create_dir_all(folder).with_context(|| {
        format!(
            "cannot write into {}: choose a writable folder with --out",
            folder.display()
        )
    })?;
    let put = |name: &str, text: &str| -> Result<()> {
        let mut draft = Draft::at(&folder.join(name))?;
        draft.write_all(text.as_bytes())?;
        draft.finish().map(|_| ())
    };
    put("report.txt", &text)?;
    put("report.json", &json)?;
    put("report.html", &page)?;
    for (name, _, svg) in &figures {
        put(&format!("{name}.svg"), svg)?;
    }
    let mut out = std::io::stdout().lock();
    let shown = if arguments.json { &json } else { &text };
    // A closed stream leaves nothing to tell; the files are written.
    let _ = out.write_all(shown.as_bytes());
    if !arguments.json {
        let _ = writeln!(
            out,
            "\nWritten: {} with figures inside, report.json, report.txt.",
            folder.join("report.html").display()
        );
    }
    Ok(())
}
