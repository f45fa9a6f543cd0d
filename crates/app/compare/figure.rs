//! A sweep as three panels over one parameter: when paths part, how far, and what falls.

use std::ops::Range;

use anyhow::Result;
use plotters::coord::Shift;
use plotters::prelude::*;

use super::sweep::{Step, Swept};
use crate::accuracy::figure::{COLOURS, failed, png_of, short, svg_of};

const SIZE: (u32, u32) = (1080, 330);
const TITLE: u32 = 30;
const GREY: RGBColor = RGBColor(130, 130, 130);

/// One line of a panel: its name, its colour, and a value for every step that has one.
struct Series<'a> {
    name: &'a str,
    colour: RGBColor,
    value: fn(&Step) -> Option<f64>,
}

/// The figure as SVG.
///
/// # Errors
/// When it cannot be drawn.
pub fn svg(swept: &Swept, duration: f64) -> Result<String> {
    svg_of(SIZE, |area| draw(area, swept, duration))
}

/// The figure as PNG.
///
/// # Errors
/// When it cannot be drawn.
pub fn png(swept: &Swept, duration: f64) -> Result<Vec<u8>> {
    png_of(SIZE, |area| draw(area, swept, duration))
}

fn draw<B: DrawingBackend>(
    area: &DrawingArea<B, Shift>,
    swept: &Swept,
    duration: f64,
) -> Result<()> {
    area.fill(&WHITE).map_err(failed)?;
    let times = [
        Series {
            name: "1 cm",
            colour: COLOURS[0],
            value: |step| step.divergence.apart,
        },
        Series {
            name: "5 degrees for the eye",
            colour: COLOURS[1],
            value: |step| step.divergence.seen,
        },
    ];
    let title = format!("One release along {}, against the recorded one", swept.axis);
    area.draw(&Text::new(title, (10, 8), ("sans-serif", 17)))
        .map_err(failed)?;
    legend(area, &times, swept)?;
    let (_, below) = area.split_vertically(TITLE);
    let panels = below.split_evenly((1, 3));
    panel(
        &panels[0],
        swept,
        "paths are apart after [s]",
        0.0..duration,
        &times,
    )?;
    let angle = [Series {
        name: "angle",
        colour: COLOURS[2],
        value: |step| Some(step.divergence.most_deg),
    }];
    let most = swept.steps.iter().map(|step| step.divergence.most_deg);
    let most = most.fold(1.0, f64::max);
    let words = "largest angle for the eye [degrees]";
    panel(&panels[1], swept, words, 0.0..1.05 * most, &angle)?;
    let pins = [Series {
        name: "pins",
        colour: COLOURS[3],
        value: |step| Some(step.pins as f64),
    }];
    panel(&panels[2], swept, "pins that fall", 0.0..10.5, &pins)
}

/// What the marks mean, in the row of the title.
fn legend<B: DrawingBackend>(
    area: &DrawingArea<B, Shift>,
    times: &[Series<'_>],
    swept: &Swept,
) -> Result<()> {
    let named = times.iter();
    let mut words: Vec<(&str, RGBColor, i32)> = named
        .map(|series| {
            (
                series.name,
                series.colour,
                10 + 7 * series.name.len() as i32,
            )
        })
        .collect();
    words.push(("triangle: never", BLACK, 110));
    if swept.recorded.is_some() {
        words.push(("grey line: as recorded", GREY, 150));
    }
    let mut x = 560;
    for (text, colour, width) in words {
        let style = ("sans-serif", 13).into_font().color(&colour);
        area.draw(&Text::new(text, (x, 11), style))
            .map_err(failed)?;
        x += width;
    }
    Ok(())
}

/// The axis of the parameter, with room beside its ends.
fn range(swept: &Swept) -> Range<f64> {
    let all = swept.steps.iter().map(|step| step.x).chain(swept.recorded);
    let (low, high) = all.fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), x| {
        (a.min(x), b.max(x))
    });
    let room = (0.06 * (high - low)).max(1e-3);
    low - room..high + room
}

fn panel<B: DrawingBackend>(
    area: &DrawingArea<B, Shift>,
    swept: &Swept,
    words: &str,
    values: Range<f64>,
    all: &[Series<'_>],
) -> Result<()> {
    let across = range(swept);
    let mut chart = ChartBuilder::on(area)
        .margin(8)
        .x_label_area_size(38)
        .y_label_area_size(52)
        .build_cartesian_2d(across, values.clone())
        .map_err(failed)?;
    let label = |x: &f64| match swept.is_named {
        false => short_or_zero(*x),
        true => {
            let is_rung = (x - x.round()).abs() < 1e-6 && *x >= 0.0;
            let rung = is_rung
                .then(|| swept.steps.get(x.round() as usize))
                .flatten();
            rung.map_or(String::new(), |step| step.name.replace("one ", ""))
        }
    };
    chart
        .configure_mesh()
        .x_labels(swept.steps.len().clamp(2, 11))
        .x_desc(swept.axis)
        .y_desc(words)
        .label_style(("sans-serif", 11))
        .axis_desc_style(("sans-serif", 12))
        .x_label_formatter(&label)
        .y_label_formatter(&|y| short_or_zero(*y))
        .light_line_style(WHITE)
        .draw()
        .map_err(failed)?;
    if let Some(recorded) = swept.recorded {
        let ends = [(recorded, values.start), (recorded, values.end)];
        let line = PathElement::new(ends, GREY.stroke_width(2));
        chart.draw_series([line]).map_err(failed)?;
    }
    for (row, series) in (0_u8..).zip(all) {
        let stroke = series.colour.stroke_width(2);
        let places: Vec<Option<(f64, f64)>> = swept
            .steps
            .iter()
            .map(|step| (series.value)(step).map(|value| (step.x, value)))
            .collect();
        let pairs = places
            .windows(2)
            .filter_map(|pair| Some([pair[0]?, pair[1]?]));
        let segments = pairs.map(|pair| PathElement::new(pair, stroke));
        chart.draw_series(segments).map_err(failed)?;
        let dots = places.iter().flatten();
        let dots = dots.map(|place| Circle::new(*place, 3, series.colour.filled()));
        chart.draw_series(dots).map_err(failed)?;
        // What never happens lies at the upper edge, a row for each line.
        let height = (0.98 - 0.05 * f64::from(row)) * values.end;
        let never = swept
            .steps
            .iter()
            .filter(|step| (series.value)(step).is_none());
        let marks = never.map(|step| TriangleMarker::new((step.x, height), 5, stroke));
        chart.draw_series(marks).map_err(failed)?;
    }
    Ok(())
}

/// A number on an axis in few characters.
fn short_or_zero(x: f64) -> String {
    if x.abs() < 1e-9 {
        "0".to_owned()
    } else {
        short(x)
    }
}
