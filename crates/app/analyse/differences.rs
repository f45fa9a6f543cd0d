//! The report on a study of differences: thresholds, slopes and false alarms, of each participant and together.

use anyhow::Result;
use experiment::analysis::differences::{Common, Differences, FalseAlarms, Observed};
use experiment::analysis::exact;
use experiment::staircase::{Rule, TARGET};
use plotters::prelude::*;

use super::figure::{Area, Figure};
use super::report::{Block, Table, digits, interval};
use crate::accuracy::figure::{COLOURS, failed, svg_of};

/// Width of the figures [px].
const WIDTH: u32 = 760;
/// Height of a participant's line, and of all that is not one [px].
const LINE: u32 = 26;
const REST: u32 = 80;
/// Height of the shares' figure [px].
const SHARES: u32 = 340;
/// Stretches of differences in which answers are counted together.
const BINS: usize = 8;

/// What the report says.
pub fn blocks(found: &Differences) -> Vec<Block> {
    let mut blocks = vec![
        Block::Heading(format!("Analysis of {}", found.source)),
        Block::Text(introduction(found)),
        Block::Table(participants(found)),
    ];
    let none = found.observed.iter().filter(|one| one.rule.is_none());
    let none: Vec<&str> = none.map(|one| one.id.as_str()).collect();
    if !none.is_empty() {
        blocks.push(Block::Text(format!(
            "Without a threshold, because their pairs do not tell: {}.",
            none.join(", ")
        )));
    }
    let beyond = found.observed.iter().filter(|one| {
        let threshold = one.rule.map(|rule| rule.value);
        threshold.is_some_and(|threshold| threshold > found.range())
    });
    let beyond: Vec<&str> = beyond.map(|one| one.id.as_str()).collect();
    if !beyond.is_empty() {
        blocks.push(Block::Text(format!(
            "Beyond the largest difference that was tried, so that the number is a guess of the model: {}.",
            beyond.join(", ")
        )));
    }
    blocks.push(Block::Figure("thresholds"));
    blocks.push(Block::Table(together(found)));
    blocks.push(Block::Figure("shares"));
    blocks
}

fn introduction(found: &Differences) -> String {
    let plan = &found.plan;
    let rule = match plan.rule {
        Rule::OneUpTwoDown => {
            "one-up two-down; its intervals are of stretches of four turns (nominally 95 %)"
        }
        Rule::Bayesian => "Bayesian; its intervals have 95 % of the posterior",
    };
    format!(
        "{} participants, {} pairs of throws: {} is {} in one throw of each and up to {} away from it in the other. A threshold is the \
         difference, in that unit, which is called different {:.1} % of the time, false alarms included. Rule: {rule}. The fit is a \
         Weibull function with false alarms and 2 % of slips to all pairs of a participant (posterior means); its slope is looked for \
         from 1 to 5.",
        found.observed.len(),
        found.pairs(),
        plan.key,
        plan.standard,
        digits(found.range()),
        100.0 * TARGET,
    )
}

/// A value with its interval, or a dash.
fn with_interval(found: Option<(f64, [f64; 2])>) -> [String; 2] {
    match found {
        Some((value, [low, high])) => [digits(value), interval(low, high)],
        None => ["-".to_owned(), "-".to_owned()],
    }
}

fn alarms(found: FalseAlarms) -> [String; 2] {
    let share = found.rate().zip(found.interval());
    let share = share.map_or("-".to_owned(), |(rate, [low, high])| {
        format!(
            "{:.0} % ({:.0} to {:.0})",
            100.0 * rate,
            100.0 * low,
            100.0 * high
        )
    });
    [format!("{} of {}", found.alarms, found.catches), share]
}

fn participants(found: &Differences) -> Table {
    let header = [
        "participant",
        "pairs",
        "threshold",
        "95 %",
        "fitted",
        "95 %",
        "slope",
        "95 %",
        "false alarms",
        "share (Wilson 95 %)",
    ];
    let mut table = Table::new("Each participant", &header);
    for one in &found.observed {
        let mut row = vec![one.id.clone(), one.answers.len().to_string()];
        row.extend(with_interval(
            one.rule.map(|rule| (rule.value, rule.interval)),
        ));
        let range = found.range();
        row.extend(with_interval(one.fitted.map(|fit| {
            (fit.threshold * range, fit.interval.map(|end| end * range))
        })));
        row.extend(with_interval(
            one.fitted.map(|fit| (fit.slope, fit.slope_interval)),
        ));
        row.extend(alarms(one.false_alarms()));
        table.rows.push(row);
    }
    table
}

fn together(found: &Differences) -> Table {
    let header = [
        "",
        "participants",
        "geometric mean",
        "95 % between participants (t)",
        "spread, as a factor",
    ];
    let mut table = Table::new("All together", &header);
    let mut put = |name: &str, common: Option<Common>| {
        let Some(common) = common else { return };
        let bounds = common.interval;
        table.rows.push(vec![
            name.to_owned(),
            common.count.to_string(),
            digits(common.mean),
            bounds.map_or("-".to_owned(), |[low, high]| interval(low, high)),
            common.spread.map_or("-".to_owned(), digits),
        ]);
    };
    put("threshold", found.threshold());
    put("fitted threshold", found.fitted_threshold());
    put("slope", found.slope());
    let [count, share] = alarms(found.false_alarms());
    table.rows.push(vec![
        "false alarms".to_owned(),
        found.observed.len().to_string(),
        count,
        share,
        "-".to_owned(),
    ]);
    table
}

/// The figures.
///
/// # Errors
/// When one cannot be drawn.
pub fn figures(found: &Differences) -> Result<Vec<Figure>> {
    let mut figures = Vec::new();
    let known: Vec<&Observed> = found
        .observed
        .iter()
        .filter(|one| one.rule.is_some())
        .collect();
    if !known.is_empty() {
        let caption = "Threshold of each participant with its 95 % interval; the line is the geometric mean, the strip its interval between participants.";
        let size = (WIDTH, REST + LINE * known.len() as u32);
        let svg = svg_of(size, |area| thresholds(area, found, &known))?;
        figures.push(("thresholds", caption.to_owned(), svg));
    }
    let bins = shares(found);
    if !bins.is_empty() {
        let caption = "Share of pairs that all participants together called different, by difference, with Wilson 95 % intervals; at 0 the catch trials; the line is at 70.7 %.";
        let svg = svg_of((WIDTH, SHARES), |area| draw_shares(area, found, &bins))?;
        figures.push(("shares", caption.to_owned(), svg));
    }
    Ok(figures)
}

fn thresholds(area: &Area<'_>, found: &Differences, known: &[&Observed]) -> Result<()> {
    area.fill(&WHITE).map_err(failed)?;
    let ends = known.iter().filter_map(|one| Some(one.rule?.interval[1]));
    let top = ends.fold(0.0, f64::max) * 1.05;
    let bottom = known.len() as f64 - 0.5;
    let mut chart = ChartBuilder::on(area)
        .margin(8)
        .x_label_area_size(44)
        .y_label_area_size(110)
        .build_cartesian_2d(0.0..top, bottom..-0.5)
        .map_err(failed)?;
    let label = |y: &f64| {
        let is_place = (y - y.round()).abs() < 1e-6 && *y >= 0.0;
        let name = known.get(y.round() as usize).filter(|_| is_place);
        name.map(|one| one.id.clone()).unwrap_or_default()
    };
    chart
        .configure_mesh()
        .disable_y_mesh()
        .y_labels(2 * known.len() + 1)
        .y_label_formatter(&label)
        .x_desc(format!("difference of {}", found.plan.key))
        .light_line_style(WHITE)
        .label_style(("sans-serif", 14))
        .draw()
        .map_err(failed)?;
    if let Some(common) = found.threshold() {
        if let Some([low, high]) = common.interval {
            let strip = [(low, -0.5), (high.min(top), bottom)];
            let strip = Rectangle::new(strip, COLOURS[1].mix(0.2).filled());
            chart.draw_series([strip]).map_err(failed)?;
        }
        let line = [(common.mean, -0.5), (common.mean, bottom)];
        let line = PathElement::new(line, COLOURS[1].stroke_width(2));
        chart.draw_series([line]).map_err(failed)?;
    }
    for (place, one) in known.iter().enumerate() {
        let Some(rule) = one.rule else { continue };
        let y = place as f64;
        let line = rule.interval.map(|end| (end, y));
        let line = PathElement::new(line, COLOURS[0].stroke_width(2));
        chart.draw_series([line]).map_err(failed)?;
        let spot = Circle::new((rule.value, y), 4, COLOURS[0].filled());
        chart.draw_series([spot]).map_err(failed)?;
    }
    Ok(())
}

/// Answers to differences that lie near each other.
struct Bin {
    /// Mean of the differences.
    difference: f64,
    different: u32,
    of: u32,
}

/// Catch trials, and all other pairs in stretches of as many pairs each.
fn shares(found: &Differences) -> Vec<Bin> {
    let mut all: Vec<(f64, bool)> = Vec::new();
    for one in &found.observed {
        all.extend(&one.answers);
    }
    all.sort_by(|a, b| a.0.total_cmp(&b.0));
    let catches = all.partition_point(|(difference, _)| *difference == 0.0);
    let (catches, compared) = all.split_at(catches);
    let length = compared.len().div_ceil(BINS).max(1);
    let stretches = std::iter::once(catches).chain(compared.chunks(length));
    let counted = stretches.filter(|stretch| !stretch.is_empty());
    let bin = |stretch: &[(f64, bool)]| Bin {
        difference: stretch.iter().map(|(off, _)| off).sum::<f64>() / stretch.len() as f64,
        different: stretch.iter().filter(|(_, is)| *is).count() as u32,
        of: stretch.len() as u32,
    };
    counted.map(bin).collect()
}

fn draw_shares(area: &Area<'_>, found: &Differences, bins: &[Bin]) -> Result<()> {
    area.fill(&WHITE).map_err(failed)?;
    let top = bins.iter().map(|bin| bin.difference).fold(0.0, f64::max) * 1.08;
    let top = if top > 0.0 { top } else { found.range() };
    let mut chart = ChartBuilder::on(area)
        .margin(8)
        .x_label_area_size(44)
        .y_label_area_size(56)
        .build_cartesian_2d(-0.03 * top..top, -0.02..1.02)
        .map_err(failed)?;
    chart
        .configure_mesh()
        .x_desc(format!("difference of {}", found.plan.key))
        .y_desc("called different")
        .light_line_style(WHITE)
        .label_style(("sans-serif", 14))
        .draw()
        .map_err(failed)?;
    let level = PathElement::new([(0.0, TARGET), (top, TARGET)], BLACK.mix(0.4));
    chart.draw_series([level]).map_err(failed)?;
    for bin in bins {
        let share = f64::from(bin.different) / f64::from(bin.of);
        let bounds = exact::wilson(bin.different, bin.of);
        let line = bounds.map(|end| (bin.difference, end));
        let line = PathElement::new(line, COLOURS[0].stroke_width(2));
        chart.draw_series([line]).map_err(failed)?;
        let spot = Circle::new((bin.difference, share), 4, COLOURS[0].filled());
        chart.draw_series([spot]).map_err(failed)?;
    }
    Ok(())
}
