//! All dials in one picture: what each saves and costs, as shares of its own coarsest error and of its default's time.

use anyhow::Result;
use plotters::coord::Shift;
use plotters::prelude::*;

use super::figure::{COLOURS, failed, png_of, segments, short, svg_of};
use super::judge;
use super::report::{Line, Report};

const SIZE: (u32, u32) = (1060, 620);
const LEGEND: u32 = 330;
/// The least share of an error that is shown.
const LEAST: f64 = 1e-12;

/// One dial's line: time over the default's, error over the largest.
struct Course {
    name: String,
    points: Vec<(f64, f64)>,
    default: usize,
    knee: Option<(usize, String)>,
}

/// The picture as SVG.
///
/// # Errors
/// When it cannot be drawn.
pub fn svg(reports: &[Report]) -> Result<String> {
    svg_of(SIZE, |area| draw(area, &courses(reports)))
}

/// The picture as PNG.
///
/// # Errors
/// When it cannot be drawn.
pub fn png(reports: &[Report]) -> Result<Vec<u8>> {
    png_of(SIZE, |area| draw(area, &courses(reports)))
}

/// The first line of every ordered dial whose error depends on it.
fn courses(reports: &[Report]) -> Vec<Course> {
    let ordered = reports.iter().filter(|report| report.is_ordered);
    ordered.filter_map(course).collect()
}

fn course(report: &Report) -> Option<Course> {
    let has_default = |line: &&Line| line.points.iter().any(|p| p.is_default);
    let choices = report
        .lines
        .iter()
        .filter(has_default)
        .flat_map(|line| (0..report.measures.len()).map(move |measure| (line, measure)));
    // The line that the dial moves most shows what the dial is for, unless it goes up and down.
    let (line, measure, _) = choices
        .map(|(line, measure)| (line, measure, span(line, measure)))
        .filter(|(_, _, span)| *span > 2.0)
        .max_by(|x, y| {
            let key = |(line, measure, span): &(&Line, usize, f64)| {
                (!goes_up(report, line, *measure), *span)
            };
            let (x, y) = (key(x), key(y));
            x.0.cmp(&y.0).then(x.1.total_cmp(&y.1))
        })?;
    let default = line.points.iter().position(|p| p.is_default)?;
    let time = line.points[default].time.median;
    let most = line.errors(measure).into_iter().fold(0.0, f64::max);
    let point = |p: &super::report::Point| {
        let error = p.errors[measure].max(line.floors[measure]) / most;
        (p.time.median / time, error.max(LEAST))
    };
    let knee = judge::knee(line, measure);
    Some(Course {
        name: format!("{} ({})", report.dial, line.name),
        points: line.points.iter().map(point).collect(),
        default,
        knee: knee.map(|i| (i, line.points[i].setting.clone())),
    })
}

/// Whether an error rises by far somewhere along the dial.
fn goes_up(report: &Report, line: &Line, measure: usize) -> bool {
    let noise = report.measures[measure].noise.max(1.0);
    let course = judge::course(&line.errors(measure), line.floors[measure], noise);
    matches!(course, judge::Course::Rises(_))
}

/// How many times smaller the smallest error of a line is than the largest.
fn span(line: &Line, measure: usize) -> f64 {
    let errors = line.errors(measure);
    if errors.len() < 2 || errors.iter().any(|e| !e.is_finite()) {
        return 0.0;
    }
    let told = errors
        .iter()
        .map(|e| e.max(line.floors[measure]).max(1e-300));
    let (least, most) = told.fold((f64::INFINITY, 0.0_f64), |(a, b), e| (a.min(e), b.max(e)));
    most / least
}

fn draw<B: DrawingBackend>(area: &DrawingArea<B, Shift>, courses: &[Course]) -> Result<()> {
    area.fill(&WHITE).map_err(failed)?;
    let (left, right) = area.split_horizontally(SIZE.0 - LEGEND);
    let times = courses.iter().flat_map(|c| c.points.iter().map(|p| p.0));
    let (least, most) = times.fold((0.5, 2.0_f64), |(a, b), t| (f64::min(a, t), b.max(t)));
    let mut chart = ChartBuilder::on(&left)
        .caption(
            "What accuracy costs: down and left is better",
            ("sans-serif", 17),
        )
        .margin(8)
        .x_label_area_size(40)
        .y_label_area_size(66)
        .build_cartesian_2d(
            ((least / 1.3)..(most * 1.3)).log_scale(),
            ((LEAST / 2.0)..2.0).log_scale(),
        )
        .map_err(failed)?;
    chart
        .configure_mesh()
        .x_desc("time, times the default's")
        .y_desc("error, as a share of the dial's largest")
        .label_style(("sans-serif", 12))
        .axis_desc_style(("sans-serif", 13))
        .x_label_formatter(&|x| short(*x))
        .y_label_formatter(&|y| short(*y))
        .light_line_style(WHITE)
        .draw()
        .map_err(failed)?;
    for (course, colour) in courses.iter().zip(COLOURS.iter().cycle()) {
        let stroke = colour.stroke_width(2);
        let points = course.points.iter().copied();
        chart
            .draw_series(segments(&course.points, stroke))
            .map_err(failed)?;
        let dots = points.map(|p| Circle::new(p, 2, colour.filled()));
        chart.draw_series(dots).map_err(failed)?;
        let circle = Circle::new(course.points[course.default], 6, stroke);
        chart.draw_series([circle]).map_err(failed)?;
        if let Some((index, setting)) = &course.knee {
            let place = course.points[*index];
            chart
                .draw_series([TriangleMarker::new(place, 7, stroke)])
                .map_err(failed)?;
            let style = ("sans-serif", 12).into_font().color(colour);
            chart
                .draw_series(
                    [EmptyElement::at(place) + Text::new(setting.clone(), (5, -17), style)],
                )
                .map_err(failed)?;
        }
    }
    legend(&right, courses)
}

fn legend<B: DrawingBackend>(area: &DrawingArea<B, Shift>, courses: &[Course]) -> Result<()> {
    let mut y = 40;
    for (course, colour) in courses.iter().zip(COLOURS.iter().cycle()) {
        let stroke = PathElement::new([(6, y + 6), (28, y + 6)], colour.stroke_width(3));
        area.draw(&stroke).map_err(failed)?;
        area.draw(&Text::new(course.name.clone(), (34, y), ("sans-serif", 12)))
            .map_err(failed)?;
        y += 20;
    }
    for words in ["circle: default", "triangle: knee, with its setting"] {
        y += 20;
        area.draw(&Text::new(words, (6, y), ("sans-serif", 12)))
            .map_err(failed)?;
    }
    Ok(())
}
