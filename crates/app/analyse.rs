//! `bowling analyse`: the paper's tables, and what an honest reader needs beside them, as text, page and JSON; of a study of pairs
//! of throws, what differences are noticed.

mod differences;
mod figure;
mod honest;
mod html;
mod paper;
pub mod report;
pub mod text;

use std::io::Write;

use anyhow::{Context, Result, bail};
use experiment::analysis::differences::Differences;
use experiment::analysis::model::Model;
use experiment::analysis::randomisation::Plan;
use experiment::analysis::study::Analysis;
use serde_json::Value;

use crate::args::{AnalyseArguments, unusable};
use crate::output::Draft;
use figure::Figure;
use report::Block;

/// Re-allocations of the randomisation tests where nobody says.
const USUAL_RANDOMISATIONS: u32 = 10_000;
/// Seed of the re-allocations where nobody says.
const USUAL_SEED: u64 = 1;

/// What an analysis leaves.
struct Report {
    source: String,
    blocks: Vec<Block>,
    figures: Vec<Figure>,
    json: Value,
}

/// Analyses a study or a table.
///
/// # Errors
/// When the input cannot be used, by row and column, or the folder cannot be written.
pub fn analyse(arguments: &AnalyseArguments) -> Result<()> {
    let Report {
        source,
        blocks,
        figures,
        json,
    } = report(arguments)?;
    let text = text::text(&blocks);
    let json = serde_json::to_string_pretty(&json)? + "\n";
    let title = format!("Analysis of {source}");
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

/// The report on what the arguments name: a study of differences, or else a regression.
fn report(arguments: &AnalyseArguments) -> Result<Report> {
    if let Some(found) = Differences::of(&arguments.input)? {
        let of_games = (&arguments.model, arguments.randomisations, arguments.seed);
        if of_games != (&None, None, None) {
            bail!(unusable(
                "--model, --randomisations and --seed belong to studies of games, and this is one of differences"
            ));
        }
        return Ok(Report {
            blocks: differences::blocks(&found),
            figures: differences::figures(&found)?,
            json: found.json(),
            source: found.source,
        });
    }
    let plan = Plan {
        draws: arguments.randomisations.unwrap_or(USUAL_RANDOMISATIONS) as usize,
        seed: arguments.seed.unwrap_or(USUAL_SEED),
    };
    let model = arguments.model.clone().unwrap_or_else(Model::paper);
    let analysis = Analysis::of(&arguments.input, &model, plan)?;
    Ok(Report {
        blocks: report::blocks(&analysis),
        figures: figure::figures(&analysis)?,
        json: analysis.json(),
        source: analysis.source,
    })
}
