//! `bowling power`: how many subjects a study needs, from simulated ones.

mod figure;

use std::io::Write;
use std::path::Path;

use anyhow::{Context, Result, bail, ensure};
use experiment::analysis::exact::wilson;
use experiment::analysis::power::{
    COLUMNS, Effort, PUBLISHED, PairedPoint, PairedWorld, Point, WANTED, World, curve, enough,
    json, paired_curve,
};
use indicatif::{ProgressBar, ProgressStyle};
use serde_json::{Value, json};

use crate::analyse::report::{Block, Table};
use crate::analyse::text;
use crate::args::PowerArguments;
use crate::output::Draft;

/// Standard deviations that the paired simulation takes, among subjects and among a subject's games [logit].
const SUBJECT_SDS: [f64; 2] = [0.8, 1.5];
const GAME_SD: f64 = 0.6;
/// Numbers of subjects per changed parameter that the paired simulation tries.
const PER_PARAMETER: [u32; 12] = [4, 6, 8, 10, 12, 16, 20, 24, 32, 40, 48, 64];
/// What follows from the published effects and from half of them, which nobody knows beforehand.
const RULE: &str = "Effects are not known beforehand: plan 72 subjects at least, 144 are better; or ask after each game, \
                    which takes 8 per changed parameter for the published effect.";

/// Simulates and reports.
///
/// # Errors
/// When the coefficients cannot be read or the folder cannot be written.
pub fn power(arguments: &PowerArguments) -> Result<()> {
    let (coefficients, factor) = coefficients(&arguments.effect)?;
    let world = World {
        coefficients,
        correlation: arguments.correlation,
    };
    let effort = Effort {
        studies: arguments.studies as usize,
        seed: arguments.seed,
    };
    let (blocks, value, svg) = if arguments.per_game {
        per_game(coefficients[3] * factor, effort, arguments)?
    } else {
        per_session(&world, factor, effort, arguments)?
    };
    let json = serde_json::to_string_pretty(&value)? + "\n";
    let folder = &arguments.out;
    std::fs::create_dir_all(folder).with_context(|| {
        format!(
            "cannot write into {}: choose a writable folder with --out",
            folder.display()
        )
    })?;
    for (name, text) in [("power.json", &json), ("power.svg", &svg)] {
        let mut draft = Draft::at(&folder.join(name))?;
        draft.write_all(text.as_bytes())?;
        draft.finish()?;
    }
    let shown = if arguments.json {
        json
    } else {
        text::text(&blocks)
    };
    // A closed stream leaves nothing to tell; the files are written.
    let _ = std::io::stdout().lock().write_all(shown.as_bytes());
    Ok(())
}

/// The coefficients that `--effect` means, and the factor on the physics' effects.
fn coefficients(effect: &str) -> Result<([f64; 10], f64)> {
    if let Ok(factor) = effect.parse::<f64>() {
        ensure!(
            factor.is_finite() && factor >= 0.0,
            "--effect is a factor from 0 on, or a file, not \"{effect}\""
        );
        return Ok((PUBLISHED, factor));
    }
    let path = Path::new(effect);
    let text = std::fs::read_to_string(path).with_context(|| {
        format!("--effect is neither a number nor a file that can be read: {effect}")
    })?;
    let named: Vec<(String, f64)> = if path.extension().is_some_and(|end| end == "json") {
        of_report(&serde_json::from_str(&text).with_context(|| format!("{effect} is no JSON"))?)
    } else {
        let table: toml::Table =
            toml::from_str(&text).with_context(|| format!("{effect} is no TOML"))?;
        let number =
            |value: &toml::Value| value.as_float().or(value.as_integer().map(|i| i as f64));
        table
            .iter()
            .filter_map(|(name, value)| Some((name.clone(), number(value)?)))
            .collect()
    };
    let mut coefficients = [0.0; 10];
    for (column, coefficient) in COLUMNS.iter().zip(&mut coefficients) {
        let Some((_, value)) = named.iter().find(|(name, _)| name == column) else {
            bail!(
                "{effect} has no number for {column}; it needs one for each of {}",
                COLUMNS.join(", ")
            );
        };
        ensure!(
            value.is_finite(),
            "{effect}: {column} is {value}, and has to be finite"
        );
        *coefficient = *value;
    }
    Ok((coefficients, 1.0))
}

/// The estimates of a report: maximum likelihood where it is valid, else Firth's.
fn of_report(report: &Value) -> Vec<(String, f64)> {
    let fit = if report["ml_valid"] == true {
        &report["ml"]
    } else {
        &report["firth"]
    };
    let terms = fit["terms"].as_array().into_iter().flatten();
    let estimates = fit["estimate"].as_array().into_iter().flatten();
    terms
        .zip(estimates)
        .filter_map(|(term, value)| Some((term.as_str()?.to_owned(), value.as_f64()?)))
        .collect()
}

fn progress(studies: usize) -> ProgressBar {
    let bar = ProgressBar::new(studies as u64);
    let style = ProgressStyle::with_template("{bar:40} {pos} of {len} studies, {eta} left");
    bar.with_style(style.expect("a template of this file"))
}

type Report = (Vec<Block>, Value, String);

fn per_session(
    world: &World,
    factor: f64,
    effort: Effort,
    arguments: &PowerArguments,
) -> Result<Report> {
    let sizes = &arguments.subjects;
    let bar = progress(2 * sizes.len() * effort.studies);
    let done = |studies: usize| bar.inc(studies as u64);
    let effects = curve(&world.with_effect(factor), sizes, effort, &done)?;
    let nothing = curve(&world.with_effect(0.0), sizes, effort, &done)?;
    bar.finish_and_clear();
    let (together, each) = enough(&effects);
    let words = |found: Option<u32>| {
        found.map_or("more subjects than were tried".to_owned(), |n| {
            format!("{n} subjects")
        })
    };
    let mut advice = format!(
        "For {:.0} % power by the quasi-binomial test it takes {} to see that the physics matters at all, and {} to see each of F, change.S and change.E.",
        100.0 * WANTED,
        words(together),
        words(each),
    );
    if world.coefficients == PUBLISHED {
        advice = format!("{advice} {RULE}");
    }
    let title = format!(
        "Power at 5 %: {} studies of each size, effects {} x {}, correlation of answers {}, seed {}",
        effort.studies,
        factor,
        if world.coefficients == PUBLISHED {
            "the published ones"
        } else {
            &arguments.effect
        },
        world.correlation,
        effort.seed
    );
    let quasi: fn(&Point, usize) -> u32 = |point, t| point.tests[t].quasi;
    let papers: fn(&Point, usize) -> u32 = |point, t| point.tests[t].chi_squared;
    let blocks = vec![
        Block::Heading(title),
        table(
            "Quasi-binomial F test, dispersion at least 1 (95 % intervals)",
            &effects,
            quasi,
        ),
        table("The paper's chi-squared test", &effects, papers),
        table(
            "Type I error of the quasi-binomial F test: E, F and S without effect, so that 0.05 is right for F, change and physics",
            &nothing,
            quasi,
        ),
        table(
            "Type I error of the paper's chi-squared test",
            &nothing,
            papers,
        ),
        Block::Text(advice.clone()),
    ];
    let value = json!({
        "effect": factor,
        "coefficients": COLUMNS.iter().zip(world.coefficients).map(|(name, b)| ((*name).to_owned(), json!(b))).collect::<serde_json::Map<_, _>>(),
        "correlation": world.correlation,
        "seed": effort.seed,
        "power": json(&effects),
        "type_1_error": json(&nothing),
        "subjects_for_80_percent": {"physics": together, "each": each},
        "advice": advice,
    });
    let svg = figure::curve(&effects, &nothing)?;
    Ok((blocks, value, svg))
}

fn table(caption: &str, points: &[Point], count: fn(&Point, usize) -> u32) -> Block {
    let mut header = vec!["subjects"];
    if let Some(point) = points.first() {
        header.extend(point.tests.iter().map(|test| test.name));
    }
    let mut table = Table::new(caption, &header);
    for point in points {
        let shares = (0..point.tests.len()).map(|t| share(count(point, t), point.studies));
        table.rows.push(
            std::iter::once(point.subjects.to_string())
                .chain(shares)
                .collect(),
        );
    }
    Block::Table(table)
}

fn share(count: u32, of: u32) -> String {
    let [low, high] = wilson(count, of);
    format!(
        "{:.3} ({low:.3}-{high:.3})",
        f64::from(count) / f64::from(of)
    )
}

fn per_game(effect: f64, effort: Effort, arguments: &PowerArguments) -> Result<Report> {
    let bar = progress(2 * SUBJECT_SDS.len() * PER_PARAMETER.len() * effort.studies);
    let done = |studies: usize| bar.inc(studies as u64);
    let curve = |effect: f64, subject_sd: f64| {
        paired_curve(
            &PairedWorld {
                effect,
                subject_sd,
                game_sd: GAME_SD,
            },
            &PER_PARAMETER,
            effort,
            &done,
        )
    };
    let with: Vec<Vec<PairedPoint>> = SUBJECT_SDS.iter().map(|sd| curve(effect, *sd)).collect();
    let without: Vec<Vec<PairedPoint>> = SUBJECT_SDS.iter().map(|sd| curve(0.0, *sd)).collect();
    bar.finish_and_clear();
    let mut rows = Table::new(
        "Rejections of the paired t test of two counts of 0 to 6 (95 % intervals), and without an effect",
        &[
            "subjects per changed parameter",
            "power, SD 0.8",
            "power, SD 1.5",
            "type I, SD 0.8",
            "type I, SD 1.5",
        ],
    );
    for (i, &subjects) in PER_PARAMETER.iter().enumerate() {
        let shares = with
            .iter()
            .chain(&without)
            .map(|points| share(points[i].rejections, points[i].studies));
        rows.rows.push(
            std::iter::once(subjects.to_string())
                .chain(shares)
                .collect(),
        );
    }
    let reaches = |points: &Vec<PairedPoint>| {
        let enough = points
            .iter()
            .find(|point| f64::from(point.rejections) >= WANTED * f64::from(point.studies));
        enough.map(|point| point.subjects)
    };
    let found: Vec<Option<u32>> = with.iter().map(reaches).collect();
    let advice = match found
        .iter()
        .copied()
        .collect::<Option<Vec<u32>>>()
        .and_then(|all| all.into_iter().max())
    {
        Some(subjects) => format!(
            "Asked after each game, an effect of {effect:.2} logit takes {subjects} subjects per changed parameter, {} in all, for {:.0} % power.",
            3 * subjects,
            100.0 * WANTED
        ),
        None => format!(
            "Asked after each game, an effect of {effect:.2} logit takes more than {} subjects per changed parameter.",
            PER_PARAMETER[PER_PARAMETER.len() - 1]
        ),
    };
    let title = format!(
        "Power at 5 % when presence is asked after each game: {} studies of each size, game SD {GAME_SD} logit, seed {}",
        effort.studies, arguments.seed
    );
    let points = |curves: &[Vec<PairedPoint>]| -> Value {
        let curve = |(sd, points): (&f64, &Vec<PairedPoint>)| {
            let point = |p: &PairedPoint| json!({"subjects_per_parameter": p.subjects, "studies": p.studies, "rejections": p.rejections, "wilson95": wilson(p.rejections, p.studies)});
            json!({"subject_sd": sd, "points": points.iter().map(point).collect::<Vec<_>>()})
        };
        SUBJECT_SDS.iter().zip(curves).map(curve).collect()
    };
    let value = json!({
        "effect_logit": effect,
        "game_sd": GAME_SD,
        "seed": effort.seed,
        "power": points(&with),
        "type_1_error": points(&without),
        "subjects_per_parameter_for_80_percent": found,
        "advice": advice,
    });
    let svg = figure::paired(&with, &SUBJECT_SDS)?;
    Ok((
        vec![
            Block::Heading(title),
            Block::Table(rows),
            Block::Text(advice),
        ],
        value,
        svg,
    ))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn coefficients_come_from_numbers_and_files() {
        assert_eq!(coefficients("0.5").unwrap(), (PUBLISHED, 0.5));
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("mine.toml");
        let lines: String = COLUMNS
            .iter()
            .enumerate()
            .map(|(i, name)| format!("{name} = {i}\n"))
            .collect();
        std::fs::write(&path, &lines).unwrap();
        let (found, factor) = coefficients(path.to_str().unwrap()).unwrap();
        assert_eq!((found[9], factor), (9.0, 1.0));
        std::fs::write(&path, lines.replace("vr = 5\n", "")).unwrap();
        let problem = coefficients(path.to_str().unwrap())
            .unwrap_err()
            .to_string();
        assert!(problem.contains("has no number for vr"), "{problem}");
        assert!(coefficients("-1").is_err() && coefficients("no-such-file").is_err());
    }
}
