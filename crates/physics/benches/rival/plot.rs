//! A picture of times against numbers of polygons, both on logarithmic axes.

use std::fmt::Write;

/// A line of the plot.
pub struct Curve {
    pub name: &'static str,
    /// Polygons and time [ns].
    pub points: Vec<(f64, f64)>,
    pub exponent: f64,
}

const COLOURS: [&str; 5] = ["#b8322a", "#1b6ca8", "#5aa5d8", "#8a6fb0", "#3a8f4a"];
/// Inside of the axes: left, top, right, bottom [px].
const FRAME: [f64; 4] = [78.0, 20.0, 590.0, 340.0];
/// Powers of ten at the ends of an axis.
type Decades = (i32, i32);

/// An SVG picture of the curves.
pub fn draw(curves: &[Curve]) -> String {
    let all = || curves.iter().flat_map(|curve| &curve.points);
    let across = decades(all().map(|p| p.0));
    let up = decades(all().map(|p| p.1));
    let mut svg = String::from(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 820 400\" font-family=\"sans-serif\" font-size=\"13\">\n\
         <rect width=\"820\" height=\"400\" fill=\"white\"/>\n",
    );
    grid(&mut svg, across, up);
    for (curve, colour) in curves.iter().zip(COLOURS) {
        let at = |p: &(f64, f64)| (x(across, p.0), y(up, p.1));
        let path: Vec<String> = curve
            .points
            .iter()
            .map(|p| format!("{:.1},{:.1}", at(p).0, at(p).1))
            .collect();
        line(
            &mut svg,
            format_args!(
                "<polyline points=\"{}\" fill=\"none\" stroke=\"{colour}\" stroke-width=\"2\"/>",
                path.join(" ")
            ),
        );
        for p in &curve.points {
            let (x, y) = at(p);
            line(
                &mut svg,
                format_args!("<circle cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"3\" fill=\"{colour}\"/>"),
            );
        }
    }
    legend(&mut svg, curves, up);
    svg.push_str("</svg>\n");
    svg
}

fn line(svg: &mut String, text: std::fmt::Arguments) {
    writeln!(svg, "{text}").expect("a string takes all text");
}

fn decades(values: impl Iterator<Item = f64>) -> Decades {
    let (low, high) = values.fold((f64::INFINITY, 0.0), |(low, high), v| {
        (f64::min(low, v), f64::max(high, v))
    });
    (low.log10().floor() as i32, high.log10().ceil() as i32)
}

fn along(range: Decades, value: f64) -> f64 {
    (value.log10() - f64::from(range.0)) / f64::from(range.1 - range.0)
}

fn x(range: Decades, value: f64) -> f64 {
    FRAME[0] + (FRAME[2] - FRAME[0]) * along(range, value)
}

fn y(range: Decades, value: f64) -> f64 {
    FRAME[3] + (FRAME[1] - FRAME[3]) * along(range, value)
}

fn grid(svg: &mut String, across: Decades, up: Decades) {
    let [left, top, right, bottom] = FRAME;
    for power in across.0..=across.1 {
        let x = x(across, 10f64.powi(power));
        line(
            svg,
            format_args!("<path d=\"M{x:.1} {top}V{bottom}\" stroke=\"#ddd\"/>"),
        );
        line(
            svg,
            format_args!(
                "<text x=\"{x:.1}\" y=\"{}\" text-anchor=\"middle\">{}</text>",
                bottom + 20.0,
                10u64.pow(power.unsigned_abs())
            ),
        );
    }
    for power in up.0..=up.1 {
        let y = y(up, 10f64.powi(power));
        line(
            svg,
            format_args!("<path d=\"M{left} {y:.1}H{right}\" stroke=\"#ddd\"/>"),
        );
        line(
            svg,
            format_args!(
                "<text x=\"{}\" y=\"{:.1}\" text-anchor=\"end\">{}</text>",
                left - 8.0,
                y + 4.0,
                duration(power)
            ),
        );
    }
    line(
        svg,
        format_args!(
            "<text x=\"{}\" y=\"{}\" text-anchor=\"middle\">polygons of the 22 primitives</text>",
            0.5 * (left + right),
            bottom + 45.0
        ),
    );
    line(
        svg,
        format_args!(
            "<text transform=\"translate(16 {}) rotate(-90)\" text-anchor=\"middle\">time for a pair of primitives</text>",
            0.5 * (top + bottom)
        ),
    );
}

/// A power of ten of nanoseconds in words.
fn duration(power: i32) -> String {
    let unit = ["ns", "us", "ms", "s"][(power / 3) as usize];
    format!("{} {unit}", 10u32.pow((power % 3) as u32))
}

/// The curves' names, each at the height of its last point, moved apart where they would overlap.
fn legend(svg: &mut String, curves: &[Curve], up: Decades) {
    let mut entries: Vec<(f64, &Curve, &str)> = curves
        .iter()
        .zip(COLOURS)
        .filter_map(|(curve, colour)| Some((y(up, curve.points.last()?.1), curve, colour)))
        .collect();
    entries.sort_by(|a, b| a.0.total_cmp(&b.0));
    let mut free = 0.0;
    for (wanted, curve, colour) in entries {
        let y = f64::max(wanted + 4.0, free);
        free = y + 18.0;
        let text = format!("{}, power {:.2}", curve.name, curve.exponent);
        line(
            svg,
            format_args!(
                "<text x=\"{}\" y=\"{y:.1}\" fill=\"{colour}\">{text}</text>",
                FRAME[2] + 10.0
            ),
        );
    }
}
