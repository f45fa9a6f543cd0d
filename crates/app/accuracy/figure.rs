//! A dial as a work-precision diagram: error upwards, time to the right, both logarithmic; down and left is better.

use anyhow::{Result, anyhow};
use plotters::coord::Shift;
use plotters::prelude::*;

use super::judge;
use super::report::{Line, Report};
use super::table::unit_of;

/// A panel, and the room for the names of the lines [px].
const PANEL: (u32, u32) = (430, 320);
const LEGEND: u32 = 250;
const TITLE: u32 = 30;
/// Colours that are told apart by most eyes.
pub const COLOURS: [RGBColor; 10] = [
    RGBColor(31, 119, 180),
    RGBColor(255, 127, 14),
    RGBColor(44, 160, 44),
    RGBColor(214, 39, 40),
    RGBColor(148, 103, 189),
    RGBColor(140, 86, 75),
    RGBColor(227, 119, 194),
    RGBColor(100, 100, 100),
    RGBColor(188, 189, 34),
    RGBColor(23, 190, 207),
];

/// Ends the name of a line that is parry's answer to what the line of the rest of the name is ours.
pub const PARRY: &str = ", parry";

/// The name without whose answer it is: what shares a colour.
fn subject(line: &Line) -> &str {
    line.name.strip_suffix(PARRY).unwrap_or(&line.name)
}

/// Makes text in pictures possible without a library of the system; the font is egui's.
pub fn prepare_font() -> Result<()> {
    let font = epaint_default_fonts::UBUNTU_LIGHT;
    plotters::style::register_font("sans-serif", FontStyle::Normal, font)
        .map_err(|_| anyhow!("the program's own font cannot be read"))
}

/// The dial as an SVG picture.
///
/// # Errors
/// When it cannot be drawn.
pub fn svg(report: &Report) -> Result<String> {
    let size = size(report);
    svg_of(size, |area| draw(area, report))
}

/// The dial as a PNG picture.
///
/// # Errors
/// When it cannot be drawn.
pub fn png(report: &Report) -> Result<Vec<u8>> {
    let size = size(report);
    png_of(size, |area| draw(area, report))
}

/// An SVG picture of so many pixels.
pub fn svg_of(
    size: (u32, u32),
    draw: impl FnOnce(&DrawingArea<SVGBackend, Shift>) -> Result<()>,
) -> Result<String> {
    prepare_font()?;
    let mut text = String::new();
    {
        let area = SVGBackend::with_string(&mut text, size).into_drawing_area();
        draw(&area)?;
        area.present()?;
    }
    Ok(text)
}

/// A PNG picture of so many pixels.
pub fn png_of(
    size: (u32, u32),
    draw: impl FnOnce(&DrawingArea<BitMapBackend, Shift>) -> Result<()>,
) -> Result<Vec<u8>> {
    prepare_font()?;
    let mut pixels = vec![0; (size.0 * size.1 * 3) as usize];
    {
        let area = BitMapBackend::with_buffer(&mut pixels, size).into_drawing_area();
        draw(&area)?;
        area.present()?;
    }
    let image = image::RgbImage::from_raw(size.0, size.1, pixels)
        .ok_or_else(|| anyhow!("the picture has another size than its pixels"))?;
    let mut file = std::io::Cursor::new(Vec::new());
    image.write_to(&mut file, image::ImageFormat::Png)?;
    Ok(file.into_inner())
}

/// What drawing refused, as an error without the backend's type.
pub fn failed(error: impl std::fmt::Display) -> anyhow::Error {
    anyhow!("the figure cannot be drawn: {error}")
}

/// Names of the panels and of the lines, each once, in their order.
fn names<'a>(lines: &'a [Line], name: impl Fn(&'a Line) -> &'a str) -> Vec<&'a str> {
    let mut names = Vec::new();
    for line in lines {
        if !names.contains(&name(line)) {
            names.push(name(line));
        }
    }
    names
}

/// The panels of the figure: a name and a measure of which there is something to show.
fn cells(report: &Report) -> Vec<(&str, usize)> {
    let mut cells = Vec::new();
    for name in names(&report.lines, |line| &line.panel) {
        for measure in 0..report.measures.len() {
            let shown = |line: &Line| {
                line.panel == name && line.errors(measure).iter().any(|e| e.is_finite())
            };
            if report.lines.iter().any(shown) {
                cells.push((name, measure));
            }
        }
    }
    cells
}

/// Columns and rows of panels.
fn layout(report: &Report) -> (u32, u32) {
    let count = cells(report).len().max(1) as u32;
    let columns = count.min(2);
    (columns, count.div_ceil(columns))
}

fn size(report: &Report) -> (u32, u32) {
    let (columns, rows) = layout(report);
    (PANEL.0 * columns + LEGEND, TITLE + PANEL.1 * rows)
}

fn draw<B: DrawingBackend>(area: &DrawingArea<B, Shift>, report: &Report) -> Result<()> {
    area.fill(&WHITE).map_err(failed)?;
    let title = format!("{}: {}", report.dial, report.title);
    area.draw(&Text::new(title, (10, 8), ("sans-serif", 17)))
        .map_err(failed)?;
    let (_, below) = area.split_vertically(TITLE);
    let (columns, rows) = layout(report);
    let (left, right) = below.split_horizontally(PANEL.0 * columns);
    let lines = names(&report.lines, subject);
    let areas = left.split_evenly((rows as usize, columns as usize));
    for (area, (name, measure)) in areas.iter().zip(cells(report)) {
        let members: Vec<(&Line, RGBColor)> = report
            .lines
            .iter()
            .filter(|line| line.panel == name)
            .map(|line| {
                let place = lines.iter().position(|name| *name == subject(line));
                (line, COLOURS[place.unwrap_or(0) % COLOURS.len()])
            })
            .collect();
        panel(area, report, name, measure, &members)?;
    }
    let has_parry = report.lines.iter().any(|line| subject(line) != line.name);
    legend(&right, &lines, has_parry)
}

fn legend<B: DrawingBackend>(
    area: &DrawingArea<B, Shift>,
    lines: &[&str],
    has_parry: bool,
) -> Result<()> {
    let mut y = 26;
    for (index, name) in lines.iter().enumerate() {
        let colour = COLOURS[index % COLOURS.len()];
        let stroke = PathElement::new([(6, y + 6), (28, y + 6)], colour.stroke_width(3));
        area.draw(&stroke).map_err(failed)?;
        area.draw(&Text::new(name.to_string(), (34, y), ("sans-serif", 13)))
            .map_err(failed)?;
        y += 18;
    }
    y += 10;
    area.draw(&Circle::new((16, y + 6), 7, BLACK.stroke_width(2)))
        .map_err(failed)?;
    area.draw(&Text::new("default", (34, y), ("sans-serif", 13)))
        .map_err(failed)?;
    y += 22;
    area.draw(&TriangleMarker::new((16, y + 8), 8, BLACK.stroke_width(2)))
        .map_err(failed)?;
    if has_parry {
        let cross = Cross::new((16, y + 28), 6, BLACK.stroke_width(2));
        area.draw(&cross).map_err(failed)?;
        let words = Text::new("parry: GJK and EPA", (34, y + 22), ("sans-serif", 13));
        area.draw(&words).map_err(failed)?;
    }
    let words = "knee, with its setting";
    area.draw(&Text::new(words, (34, y), ("sans-serif", 13)))
        .map_err(failed)
}

/// Time and error of every point, errors no smaller than what the reference can tell.
fn places(line: &Line, measure: usize, scale: f64, least: f64) -> Vec<(f64, f64)> {
    let point = |p: &super::report::Point| (p.time.median * scale, p.errors[measure].max(least));
    let all = line.points.iter().map(point);
    all.filter(|(time, error)| *time > 0.0 && error.is_finite())
        .collect()
}

/// The smallest error that a panel shows: nothing, on a logarithmic axis, has to lie somewhere.
fn least(members: &[(&Line, RGBColor)], measure: usize) -> f64 {
    let errors = members.iter().flat_map(|(line, _)| line.errors(measure));
    let smallest = errors
        .filter(|e| *e > 0.0 && e.is_finite())
        .fold(f64::INFINITY, f64::min);
    let floors = members.iter().map(|(line, _)| line.floors[measure]);
    let floor = floors.filter(|f| *f > 0.0).fold(f64::INFINITY, f64::min);
    // Rounding far below the reference's own error says nothing.
    if floor.is_finite() {
        smallest.max(floor).min(1.0)
    } else if smallest.is_finite() {
        0.3 * smallest
    } else {
        1e-16
    }
}

fn panel<B: DrawingBackend>(
    area: &DrawingArea<B, Shift>,
    report: &Report,
    name: &str,
    measure: usize,
    members: &[(&Line, RGBColor)],
) -> Result<()> {
    let Some((first, _)) = members.first() else {
        return Ok(());
    };
    let (unit, scale) = unit_of(first);
    let least = least(members, measure);
    let all: Vec<Vec<(f64, f64)>> = members
        .iter()
        .map(|(line, _)| places(line, measure, scale, least))
        .collect();
    let points = || all.iter().flatten();
    if points().next().is_none() {
        return Ok(());
    }
    let range = |of: fn(&(f64, f64)) -> f64| {
        let ends = points()
            .map(of)
            .fold((f64::INFINITY, 0.0_f64), |(a, b), x| (a.min(x), b.max(x)));
        (ends.0 / 1.6)..(ends.1 * 1.6)
    };
    let mut chart = ChartBuilder::on(area)
        .caption(name, ("sans-serif", 14))
        .margin(8)
        .x_label_area_size(38)
        .y_label_area_size(62)
        .build_cartesian_2d(range(|p| p.0).log_scale(), range(|p| p.1).log_scale())
        .map_err(failed)?;
    chart
        .configure_mesh()
        .x_labels(6)
        .x_desc(format!("time [{unit}]"))
        .y_desc(report.measures[measure].words)
        .label_style(("sans-serif", 11))
        .axis_desc_style(("sans-serif", 12))
        .x_label_formatter(&|x| short(*x))
        .y_label_formatter(&|y| short(*y))
        .light_line_style(WHITE)
        .draw()
        .map_err(failed)?;
    for ((line, colour), places) in members.iter().zip(&all) {
        let stroke = colour.stroke_width(2);
        chart
            .draw_series(segments(places, stroke))
            .map_err(failed)?;
        if subject(line) != line.name {
            let crosses = places.iter().map(|p| Cross::new(*p, 6, stroke));
            chart.draw_series(crosses).map_err(failed)?;
            continue;
        }
        let dots = places.iter().map(|p| Circle::new(*p, 2, colour.filled()));
        chart.draw_series(dots).map_err(failed)?;
        let marked = |index: usize| {
            let p = &line.points[index];
            (p.time.median * scale, p.errors[measure].max(least))
        };
        let finite = |index: &usize| line.points[*index].errors[measure].is_finite();
        let default = line.points.iter().position(|p| p.is_default).filter(finite);
        let circle = default.map(|i| Circle::new(marked(i), 6, colour.stroke_width(2)));
        chart.draw_series(circle).map_err(failed)?;
        let knee = judge::knee(line, measure).filter(|_| line.points.len() > 1);
        let triangle = knee.map(|i| TriangleMarker::new(marked(i), 7, colour.stroke_width(2)));
        chart.draw_series(triangle).map_err(failed)?;
        let style = ("sans-serif", 12).into_font().color(colour);
        let words = knee.map(|i| {
            let setting = line.points[i].setting.clone();
            EmptyElement::at(marked(i)) + Text::new(setting, (5, -17), style.clone())
        });
        chart.draw_series(words).map_err(failed)?;
    }
    Ok(())
}

/// A line piece by piece: where one of a piece turns back sharply, its corner would stick out far.
pub fn segments(places: &[(f64, f64)], stroke: ShapeStyle) -> Vec<PathElement<(f64, f64)>> {
    let pairs = places.windows(2);
    pairs.map(|pair| PathElement::new(pair, stroke)).collect()
}

/// A number on a logarithmic axis in few characters.
pub fn short(x: f64) -> String {
    if (1e-2..1e5).contains(&x) {
        let text = format!("{x:.2}");
        text.trim_end_matches('0').trim_end_matches('.').to_owned()
    } else {
        format!("{x:.0e}")
    }
}
