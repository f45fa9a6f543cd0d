//! Power curves with their intervals.

use anyhow::Result;
use experiment::analysis::exact::wilson;
use experiment::analysis::power::{PairedPoint, Point, WANTED};
use plotters::prelude::*;

use crate::accuracy::figure::{COLOURS, failed, svg_of};

const SIZE: (u32, u32) = (820, 420);
/// The tests that are drawn, by their places: F, change.S, change.E, and the physics together.
const DRAWN: [usize; 4] = [0, 1, 2, 5];

/// A line: its name, its colour, and subjects, rejections and studies of each point.
struct Line {
    name: String,
    colour: RGBColor,
    points: Vec<(u32, u32, u32)>,
}

/// The quasi-binomial test's power, and the type I error of the physics together.
pub fn curve(effects: &[Point], nothing: &[Point]) -> Result<String> {
    let line = |points: &[Point], t: usize, colour: RGBColor, name: String| Line {
        name,
        colour,
        points: points
            .iter()
            .map(|point| (point.subjects, point.tests[t].quasi, point.studies))
            .collect(),
    };
    let mut lines: Vec<Line> = DRAWN
        .iter()
        .enumerate()
        .filter_map(|(i, &t)| {
            Some(line(
                effects,
                t,
                COLOURS[i],
                effects.first()?.tests[t].name.to_owned(),
            ))
        })
        .collect();
    lines.push(line(
        nothing,
        DRAWN[3],
        COLOURS[7],
        "physics, no effect".to_owned(),
    ));
    draw("subjects", &lines)
}

/// The paired test's power, a line for each standard deviation among subjects.
pub fn paired(curves: &[Vec<PairedPoint>], subject_sds: &[f64]) -> Result<String> {
    let line = |(i, (points, sd)): (usize, (&Vec<PairedPoint>, &f64))| Line {
        name: format!("SD among subjects {sd}"),
        colour: COLOURS[i],
        points: points
            .iter()
            .map(|point| (point.subjects, point.rejections, point.studies))
            .collect(),
    };
    draw(
        "subjects per changed parameter",
        &curves
            .iter()
            .zip(subject_sds)
            .enumerate()
            .map(line)
            .collect::<Vec<_>>(),
    )
}

fn draw(words: &str, lines: &[Line]) -> Result<String> {
    svg_of(SIZE, |area| {
        area.fill(&WHITE).map_err(failed)?;
        let mut x = 70;
        for line in lines {
            let style = ("sans-serif", 14).into_font().color(&line.colour);
            area.draw(&Text::new(line.name.clone(), (x, 6), style))
                .map_err(failed)?;
            x += 40 + 7 * line.name.len() as i32;
        }
        let most = lines
            .iter()
            .flat_map(|line| &line.points)
            .map(|(n, ..)| *n)
            .max()
            .unwrap_or(1);
        let right = f64::from(most) * 1.03;
        let (_, below) = area.split_vertically(24);
        let mut chart = ChartBuilder::on(&below)
            .margin(8)
            .x_label_area_size(40)
            .y_label_area_size(52)
            .build_cartesian_2d(0.0..right, 0.0..1.02)
            .map_err(failed)?;
        let mesh = &mut chart.configure_mesh();
        mesh.x_desc(words)
            .y_desc("share of studies that reject")
            .light_line_style(WHITE)
            .label_style(("sans-serif", 14));
        mesh.x_label_formatter(&|x| format!("{x:.0}"))
            .draw()
            .map_err(failed)?;
        for level in [WANTED, 0.05] {
            chart
                .draw_series([PathElement::new(
                    vec![(0.0, level), (right, level)],
                    BLACK.mix(0.5),
                )])
                .map_err(failed)?;
        }
        for line in lines {
            let share = |(n, count, of): &(u32, u32, u32)| {
                (f64::from(*n), f64::from(*count) / f64::from(*of))
            };
            let path: Vec<(f64, f64)> = line.points.iter().map(share).collect();
            chart
                .draw_series([PathElement::new(path, line.colour.stroke_width(2))])
                .map_err(failed)?;
            for (n, count, of) in &line.points {
                let bounds = wilson(*count, *of).map(|bound| (f64::from(*n), bound));
                chart
                    .draw_series([PathElement::new(
                        bounds.to_vec(),
                        line.colour.stroke_width(1),
                    )])
                    .map_err(failed)?;
            }
            chart
                .draw_series(
                    line.points
                        .iter()
                        .map(|point| Circle::new(share(point), 3, line.colour.filled())),
                )
                .map_err(failed)?;
        }
        Ok(())
    })
}
