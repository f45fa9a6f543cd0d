//! A strike map as a picture: one field for the share of strikes, one for the mean pins.

use std::fmt::Write;

use super::StrikeMap;
use crate::shot::distribution::Distribution;

/// A cell [px].
const CELL: [f64; 2] = [46.0, 30.0];
/// Room left of a field, above it, and below it [px].
const LEFT: f64 = 64.0;
const ABOVE: f64 = 34.0;
const BELOW: f64 = 52.0;
/// Room for the title [px].
const TITLE: f64 = 34.0;
/// Colours from nothing to everything, evenly spaced; lighter is more.
const SCALE: [[f64; 3]; 5] = [
    [68.0, 1.0, 84.0],
    [59.0, 82.0, 139.0],
    [33.0, 145.0, 140.0],
    [94.0, 201.0, 98.0],
    [253.0, 231.0, 37.0],
];
/// What is published, and where on the map it belongs: offset [m], angle [degrees].
///
/// A straight ball's largest angle is from the lane's edge at the foul line, atan(0.52705 / 18.288); 6 degrees at board
/// 17.5 is the United States Bowling Congress's ideal.
const PUBLISHED: [(f64, f64, &str); 2] = [
    (0.0676, 6.0, "ideal entry, published: 6 degrees at 6.76 cm"),
    (
        0.0676,
        1.65,
        "largest angle of a straight ball: 1.65 degrees",
    ),
];

/// What a field shows of a cell: value from 0 to 1, its text, and its interval's text.
type Reading = fn(&Distribution) -> (f64, String, String);

/// An SVG picture of the map.
pub fn svg(map: &StrikeMap) -> String {
    let (columns, rows) = (f64::from(map.offsets.count), f64::from(map.angles.count));
    let width = (LEFT + CELL[0] * columns + 20.0).max(760.0);
    let field = ABOVE + CELL[1] * rows + BELOW;
    let height = TITLE + 2.0 * field + 24.0;
    let mut text = String::new();
    let mut add = |line: String| writeln!(text, "{line}").expect("a string takes all text");
    add(format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {width} {height}\" font-family=\"sans-serif\" font-size=\"12\">\n\
         <rect width=\"{width}\" height=\"{height}\" fill=\"white\"/>\n\
         <text x=\"{LEFT}\" y=\"22\" font-size=\"14\">{}</text>",
        map.title
    ));
    let fields: [(&str, Reading); 2] = [
        ("Share of strikes [%], below it the 95 % interval", strikes),
        ("Mean pins, below it the 95 % interval", pins),
    ];
    for (index, (name, read)) in fields.into_iter().enumerate() {
        let top = TITLE + field * index as f64 + ABOVE;
        add(format!(
            "<text x=\"{LEFT}\" y=\"{:.1}\" font-weight=\"bold\">{name}</text>",
            top - 10.0
        ));
        cells(map, top, read, &mut add);
        axes(map, top, &mut add);
        published(map, top, &mut add);
    }
    let names: Vec<&str> = PUBLISHED.iter().map(|(_, _, name)| *name).collect();
    add(format!(
        "<text x=\"{LEFT}\" y=\"{:.1}\" fill=\"#b8322a\">circles: {}</text>\n</svg>",
        height - 10.0,
        names.join("; ")
    ));
    text
}

fn strikes(cell: &Distribution) -> (f64, String, String) {
    let (share, [low, high]) = cell.strike_share();
    let percent = |x: f64| format!("{:.0}", 1e2 * x);
    let interval = format!("{} - {}", percent(low), percent(high));
    (share, percent(share), interval)
}

fn pins(cell: &Distribution) -> (f64, String, String) {
    let (mean, [few, many]) = (cell.mean(), cell.mean_interval());
    let interval = format!("{few:.2} - {many:.2}");
    // Nearly all maps lie above five pins.
    (
        ((mean - 5.0) / 5.0).clamp(0.0, 1.0),
        format!("{mean:.2}"),
        interval,
    )
}

/// Middle of a place on the map [px]; the largest angle lies on top.
fn place(map: &StrikeMap, top: f64, offset: f64, angle: f64) -> [f64; 2] {
    let right = (offset - map.offsets.from) / map.offsets.step + 0.5;
    let down = (map.angles.last() - angle) / map.angles.step + 0.5;
    [LEFT + CELL[0] * right, top + CELL[1] * down]
}

fn cells(map: &StrikeMap, top: f64, read: Reading, add: &mut impl FnMut(String)) {
    for (offset, angle, cell) in map.entries() {
        let [x, y] = place(map, top, offset, angle);
        let (value, number, interval) = read(cell);
        let ink = if value > 0.6 { "black" } else { "white" };
        let [width, height] = CELL;
        add(format!(
            "<rect x=\"{:.1}\" y=\"{:.1}\" width=\"{width}\" height=\"{height}\" fill=\"{}\"/>\n\
             <text x=\"{x:.1}\" y=\"{:.1}\" text-anchor=\"middle\" fill=\"{ink}\">{number}</text>\n\
             <text x=\"{x:.1}\" y=\"{:.1}\" text-anchor=\"middle\" fill=\"{ink}\" font-size=\"8\">{interval}</text>",
            x - width / 2.0,
            y - height / 2.0,
            colour(value),
            y + 1.0,
            y + 11.0
        ));
    }
}

fn axes(map: &StrikeMap, top: f64, add: &mut impl FnMut(String)) {
    let bottom = top + CELL[1] * f64::from(map.angles.count);
    for column in 0..map.offsets.count {
        let offset = map.offsets.at(column);
        let [x, _] = place(map, top, offset, map.angles.from);
        add(format!(
            "<text x=\"{x:.1}\" y=\"{:.1}\" text-anchor=\"middle\">{}</text>",
            bottom + 16.0,
            tidy(1e2 * offset)
        ));
    }
    for row in 0..map.angles.count {
        let angle = map.angles.at(row);
        let [_, y] = place(map, top, map.offsets.from, angle);
        add(format!(
            "<text x=\"{:.1}\" y=\"{:.1}\" text-anchor=\"end\">{}</text>",
            LEFT - 8.0,
            y + 4.0,
            tidy(angle)
        ));
    }
    let middle = 0.5 * (top + bottom);
    add(format!(
        "<text x=\"{LEFT}\" y=\"{:.1}\">ball's middle to the right of the head pin [cm]</text>\n\
         <text transform=\"translate(16 {middle:.1}) rotate(-90)\" text-anchor=\"middle\">entry angle, to the left [degrees]</text>",
        bottom + 34.0
    ));
}

fn published(map: &StrikeMap, top: f64, add: &mut impl FnMut(String)) {
    for (offset, angle, _) in PUBLISHED {
        let [x, y] = place(map, top, offset, angle);
        let within = |span: &crate::args::Span, value: f64| {
            (span.from - span.step / 2.0..=span.last() + span.step / 2.0).contains(&value)
        };
        if within(&map.offsets, offset) && within(&map.angles, angle) {
            add(format!(
                "<circle cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"7\" fill=\"none\" stroke=\"#b8322a\" stroke-width=\"2\"/>"
            ));
        }
    }
}

/// A number with as few digits as it needs, up to three behind the point.
fn tidy(value: f64) -> String {
    let text = format!("{:.3}", value + 0.0);
    text.trim_end_matches('0').trim_end_matches('.').to_owned()
}

/// The colour of a value from 0 to 1.
fn colour(value: f64) -> String {
    let along = value.clamp(0.0, 1.0) * (SCALE.len() - 1) as f64;
    let low = (along as usize).min(SCALE.len() - 2);
    let share = along - low as f64;
    let mix = |k: usize| (SCALE[low][k] * (1.0 - share) + SCALE[low + 1][k] * share).round() as u8;
    format!("#{:02x}{:02x}{:02x}", mix(0), mix(1), mix(2))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn colours_run_from_dark_to_light() {
        assert_eq!(colour(0.0), "#440154");
        assert_eq!(colour(0.5), "#21918c");
        assert_eq!(colour(1.0), "#fde725");
        assert_eq!((colour(-1.0), colour(2.0)), (colour(0.0), colour(1.0)));
    }

    #[test]
    fn numbers_have_the_digits_that_they_need() {
        assert_eq!(
            [tidy(6.0), tidy(1.65), tidy(-0.0), tidy(10.0)],
            ["6", "1.65", "0", "10"]
        );
    }
}
