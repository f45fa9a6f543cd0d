//! The figures: answers by condition, coefficients by three methods, who noticed what, behaviour and frame times.

use anyhow::Result;
use experiment::analysis::behaviour::Behaviour;
use experiment::analysis::exact;
use experiment::analysis::noticed::Noticed;
use experiment::analysis::study::{Analysis, Answers};
use experiment::analysis::subjects::PARAMETERS;
use experiment::analysis::tails;
use plotters::coord::Shift;
use plotters::prelude::*;

use super::paper::papers_name;
use crate::accuracy::figure::{COLOURS, failed, svg_of};

pub(super) type Area<'a> = DrawingArea<SVGBackend<'a>, Shift>;

/// A figure: its name, what it shows, and its SVG.
pub(super) type Figure = (&'static str, String, String);

/// Height of a figure with values upwards [px], and its width.
const UPRIGHT: (u32, u32) = (760, 340);
/// The same with a place for each of twelve conditions.
const WIDE: (u32, u32) = (900, 360);
/// Width of the coefficients [px], and height of each of them.
const ACROSS: u32 = 860;
const ROW: u32 = 34;
/// Beyond this many of the median interval's widths an interval is cut, with an arrow.
const LONGEST: f64 = 4.0;

/// Every figure that the analysis has.
///
/// # Errors
/// When one cannot be drawn.
pub fn figures(analysis: &Analysis) -> Result<Vec<Figure>> {
    let mut figures = Vec::new();
    let conditions = analysis.answers();
    if !conditions.is_empty() {
        let caption = "Share of high answers of each subject by condition: the colour is the parameter that changed, below are the levels of the others; the line is the mean over all that changed it.";
        figures.push((
            "answers",
            caption.to_owned(),
            svg_of(WIDE, |area| answers(area, &conditions))?,
        ));
    }
    let lines = coefficients(analysis);
    if !lines.is_empty() {
        let caption = "Estimates with 95 % intervals: maximum likelihood (profile), quasi-binomial (t), Firth (penalised profile); arrows go on.";
        let size = (ACROSS, 70 + ROW * lines.len() as u32);
        figures.push((
            "coefficients",
            caption.to_owned(),
            svg_of(size, |area| draw_coefficients(area, &lines))?,
        ));
    }
    if let Some(counts) = &analysis.noticed {
        let source = if counts.is_papers {
            " (the paper's counts)"
        } else {
            ""
        };
        let caption = format!(
            "Share of subjects who noticed a difference, with Clopper-Pearson 95 % intervals{source}."
        );
        figures.push((
            "noticed",
            caption,
            svg_of(UPRIGHT, |area| noticed(area, counts))?,
        ));
    }
    if !analysis.behaviour.is_empty() {
        let caption = "Pins of a throw, and intervals between frames (median, 99 in a hundred below), by level of the parameter that changed.";
        figures.push((
            "behaviour",
            caption.to_owned(),
            svg_of(UPRIGHT, |area| behaviour(area, &analysis.behaviour))?,
        ));
    }
    Ok(figures)
}

/// A chart with a name for each of `count` places across, and values upwards.
fn upright<'a, 'b>(
    area: &'b Area<'a>,
    names: &[String],
    range: std::ops::Range<f64>,
    words: &str,
) -> Result<
    ChartContext<
        'b,
        SVGBackend<'a>,
        Cartesian2d<plotters::coord::types::RangedCoordf64, plotters::coord::types::RangedCoordf64>,
    >,
> {
    let mut chart = ChartBuilder::on(area)
        .margin(10)
        .x_label_area_size(30)
        .y_label_area_size(56)
        .build_cartesian_2d(-0.5..names.len() as f64 - 0.5, range)
        .map_err(failed)?;
    let label = |x: &f64| {
        let is_place = (x - x.round()).abs() < 1e-6 && *x >= 0.0;
        is_place
            .then(|| names.get(x.round() as usize).cloned())
            .flatten()
            .unwrap_or_default()
    };
    let mesh = &mut chart.configure_mesh();
    mesh.disable_x_mesh()
        .x_labels(2 * names.len() + 1)
        .x_label_formatter(&label)
        .y_desc(words);
    mesh.light_line_style(WHITE)
        .label_style(("sans-serif", 14))
        .draw()
        .map_err(failed)?;
    Ok(chart)
}

fn answers(area: &Area<'_>, conditions: &[Answers]) -> Result<()> {
    area.fill(&WHITE).map_err(failed)?;
    let names: Vec<String> = conditions
        .iter()
        .map(|one| {
            format!("{} ({})", one.held, one.shares.len())
                .trim()
                .to_owned()
        })
        .collect();
    let (above, below) = area.split_vertically(24);
    let mut chart = upright(&below, &names, -0.05..1.05, "share of high answers")?;
    for (place, one) in conditions.iter().enumerate() {
        let mut sorted = one.shares.clone();
        sorted.sort_by(f64::total_cmp);
        let spots = sorted.iter().enumerate().map(|(i, &share)| {
            // Equal answers side by side, in their order: no chance in a figure.
            let before = sorted[..i].iter().filter(|other| **other == share).count();
            let equal = sorted.iter().filter(|other| **other == share).count();
            let step = (0.6 / equal as f64).min(0.16);
            let x = place as f64 + step * (before as f64 - 0.5 * (equal as f64 - 1.0));
            Circle::new((x, share), 4, COLOURS[one.change].mix(0.6).filled())
        });
        chart.draw_series(spots).map_err(failed)?;
    }
    for (change, parameter) in PARAMETERS.iter().enumerate() {
        let places = (0..conditions.len()).filter(|&place| conditions[place].change == change);
        let (Some(first), Some(last)) = (places.clone().min(), places.max()) else {
            continue;
        };
        let shares = conditions[first..=last].iter().flat_map(|one| &one.shares);
        let mean = shares.clone().sum::<f64>() / shares.count() as f64;
        let ends = [(first as f64 - 0.4, mean), (last as f64 + 0.4, mean)];
        let colour = COLOURS[change];
        chart
            .draw_series([PathElement::new(ends, colour.stroke_width(2))])
            .map_err(failed)?;
        let style = ("sans-serif", 14).into_font().color(&colour);
        let words = format!("{parameter} changed: {mean:.2}");
        above
            .draw(&Text::new(words, (70 + 200 * change as i32, 6), style))
            .map_err(failed)?;
    }
    Ok(())
}

/// A coefficient with an estimate and an interval by each method that has one.
struct Line {
    name: String,
    /// Method, estimate, bounds; infinite where they are.
    methods: Vec<(usize, f64, f64, f64)>,
}

const METHODS: [&str; 3] = ["maximum likelihood", "quasi-binomial", "Firth"];

fn coefficients(analysis: &Analysis) -> Vec<Line> {
    let regression = &analysis.regression;
    let fit = &regression.fit;
    let names = regression.design.names(&fit.aliases.kept);
    let line = |(k, name): (usize, &String)| {
        let mut methods = Vec::new();
        let (estimate, bounds) = (fit.estimate[k], regression.intervals[k]);
        methods.push((0, estimate, bounds.low, bounds.high));
        if let (true, Some(dispersion)) = (fit.is_valid(), regression.dispersion()) {
            let half =
                tails::student_beyond(0.025, fit.df() as f64) * fit.error[k] * dispersion.sqrt();
            methods.push((1, estimate, estimate - half, estimate + half));
        }
        if let Some(firth) = &regression.firth {
            methods.push((
                2,
                firth.maximum.beta[k],
                firth.intervals[k].low,
                firth.intervals[k].high,
            ));
        }
        Line {
            name: papers_name(name),
            methods,
        }
    };
    names.iter().enumerate().map(line).collect()
}

/// The range in which most intervals lie; those beyond it are cut.
fn range(lines: &[Line]) -> std::ops::Range<f64> {
    let all = || lines.iter().flat_map(|line| &line.methods);
    let mut widths: Vec<f64> = all()
        .map(|(_, _, low, high)| high - low)
        .filter(|width| width.is_finite())
        .collect();
    widths.sort_by(f64::total_cmp);
    let typical = widths
        .get(widths.len() / 2)
        .copied()
        .unwrap_or(2.0)
        .max(1e-6);
    let finite = all().filter(|(_, estimate, ..)| estimate.is_finite());
    let bound = |value: f64, estimate: f64| {
        value.clamp(estimate - LONGEST * typical, estimate + LONGEST * typical)
    };
    let (mut from, mut to) = (0.0_f64, 0.0_f64);
    for (_, estimate, low, high) in finite {
        from = from.min(bound(*low, *estimate));
        to = to.max(bound(*high, *estimate));
    }
    let room = 0.05 * (to - from).max(1e-6);
    from - room..to + room
}

fn draw_coefficients(area: &Area<'_>, lines: &[Line]) -> Result<()> {
    area.fill(&WHITE).map_err(failed)?;
    for (method, name) in METHODS.iter().enumerate() {
        let style = ("sans-serif", 14).into_font().color(&COLOURS[method]);
        area.draw(&Text::new(*name, (150 + 170 * method as i32, 6), style))
            .map_err(failed)?;
    }
    let (_, below) = area.split_vertically(24);
    let range = range(lines);
    let mut chart = ChartBuilder::on(&below)
        .margin(6)
        .x_label_area_size(26)
        .y_label_area_size(110)
        .build_cartesian_2d(range.clone(), lines.len() as f64 - 0.5..-0.5)
        .map_err(failed)?;
    let label = |y: &f64| {
        let is_place = (y - y.round()).abs() < 1e-6 && *y >= 0.0;
        is_place
            .then(|| lines.get(y.round() as usize).map(|line| line.name.clone()))
            .flatten()
            .unwrap_or_default()
    };
    let mesh = &mut chart.configure_mesh();
    mesh.disable_y_mesh()
        .y_labels(2 * lines.len() + 1)
        .y_label_formatter(&label);
    mesh.light_line_style(WHITE)
        .label_style(("sans-serif", 14))
        .draw()
        .map_err(failed)?;
    let (top, bottom) = (-0.5, lines.len() as f64 - 0.5);
    chart
        .draw_series([PathElement::new([(0.0, top), (0.0, bottom)], BLACK)])
        .map_err(failed)?;
    for (place, line) in lines.iter().enumerate() {
        for (method, estimate, low, high) in &line.methods {
            let y = place as f64 + 0.24 * (*method as f64 - 1.0);
            let colour = COLOURS[*method];
            let ends = [
                low.clamp(range.start, range.end),
                high.clamp(range.start, range.end),
            ];
            chart
                .draw_series([PathElement::new(
                    ends.map(|x| (x, y)),
                    colour.stroke_width(2),
                )])
                .map_err(failed)?;
            if estimate.is_finite() {
                chart
                    .draw_series([Circle::new(
                        (estimate.clamp(range.start, range.end), y),
                        4,
                        colour.filled(),
                    )])
                    .map_err(failed)?;
            }
            for (is_cut, x, side) in [
                (*low < range.start, ends[0], -1),
                (*high > range.end, ends[1], 1),
            ] {
                if is_cut {
                    let arrow = vec![(0, 0), (-9 * side, -4), (-9 * side, 4)];
                    let arrow = EmptyElement::at((x, y)) + Polygon::new(arrow, colour.filled());
                    chart.draw_series([arrow]).map_err(failed)?;
                }
            }
        }
    }
    Ok(())
}

fn noticed(area: &Area<'_>, counts: &Noticed) -> Result<()> {
    area.fill(&WHITE).map_err(failed)?;
    let rows = &counts.rows;
    let names: Vec<String> = rows
        .iter()
        .map(|(i, [no, yes])| format!("{} ({yes} of {})", PARAMETERS[*i], no + yes))
        .collect();
    let mut chart = upright(area, &names, -0.05..1.05, "share who noticed")?;
    for (place, (_, [no, yes])) in rows.iter().enumerate() {
        let of = no + yes;
        let (x, colour) = (place as f64, COLOURS[place]);
        let [low, high] = exact::clopper_pearson(*yes, of);
        let share = f64::from(*yes) / f64::from(of);
        let bar = Rectangle::new(
            [(x - 0.25, 0.0), (x + 0.25, share)],
            colour.mix(0.35).filled(),
        );
        chart.draw_series([bar]).map_err(failed)?;
        chart
            .draw_series([PathElement::new(
                [(x, low), (x, high)],
                colour.stroke_width(3),
            )])
            .map_err(failed)?;
        chart
            .draw_series([Circle::new((x, share), 5, colour.filled())])
            .map_err(failed)?;
    }
    Ok(())
}

fn behaviour(area: &Area<'_>, conditions: &[Behaviour]) -> Result<()> {
    area.fill(&WHITE).map_err(failed)?;
    let names: Vec<String> = conditions
        .iter()
        .map(|condition| {
            format!(
                "{} {}",
                &PARAMETERS[condition.parameter][..4],
                u8::from(condition.is_high)
            )
        })
        .collect();
    let halves = area.split_evenly((1, 2));
    let mut chart = upright(&halves[0], &names, 0.0..10.0, "pins a throw")?;
    for (place, condition) in conditions.iter().enumerate() {
        let mean = condition.pins.map_or(0.0, |pins| pins.mean);
        let colour = COLOURS[condition.parameter];
        let x = place as f64;
        chart
            .draw_series([Rectangle::new(
                [(x - 0.3, 0.0), (x + 0.3, mean)],
                colour.mix(0.6).filled(),
            )])
            .map_err(failed)?;
    }
    let slowest = conditions
        .iter()
        .filter_map(|condition| condition.frames)
        .map(|frames| 1e3 * frames.p99);
    let top = slowest.fold(1.0, f64::max) * 1.1;
    let mut chart = upright(&halves[1], &names, 0.0..top, "between frames [ms]")?;
    for (place, condition) in conditions.iter().enumerate() {
        let Some(frames) = condition.frames else {
            continue;
        };
        let (x, colour) = (place as f64, COLOURS[condition.parameter]);
        let ends = [(x, 1e3 * frames.median), (x, 1e3 * frames.p99)];
        chart
            .draw_series([PathElement::new(ends, colour.stroke_width(3))])
            .map_err(failed)?;
        chart
            .draw_series([Circle::new(ends[0], 5, colour.filled())])
            .map_err(failed)?;
    }
    Ok(())
}
