//! The allocation as a table: written, and read back to the same bytes.

use std::fmt::Write;

use super::{Arrangement, Button, Condition, Design, Levels, Row, Value};

const COLUMNS: &str = "slot,block,efs,changed,order,first_button,game1_button,game1_efs,game2_button,game2_efs,red_efs,blue_efs";
/// Added where some factor's values are drawn: the factors' values, separated by semicolons.
const DRAWN_COLUMNS: &str = ",red_values,blue_values";

/// A table that is not the plan's.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error(
    "line {line} of the allocation is not as a plan writes it: it was changed, so restore it from a backup"
)]
pub struct TableError {
    /// Line, from 1.
    pub line: usize,
}

/// The table of `rows`.
pub fn allocation_csv(design: &Design, rows: &[Row]) -> String {
    let mut text = heading(design);
    for row in rows {
        text.push_str(&line(design, row));
    }
    text
}

fn heading(design: &Design) -> String {
    let drawn = if design.is_continuous() {
        DRAWN_COLUMNS
    } else {
        ""
    };
    format!("{COLUMNS}{drawn}\n")
}

fn line(design: &Design, row: &Row) -> String {
    let (first, second) = (row.button(1), row.button(2));
    let mut text = format!(
        "{},{},{},{},{},{first},{first},{},{second},{},{},{}",
        row.slot,
        row.block,
        row.low,
        row.changed,
        row.arrangement.order(),
        row.condition(first),
        row.condition(second),
        row.condition(Button::Red),
        row.condition(Button::Blue),
    );
    if design.is_continuous() {
        for button in [Button::Red, Button::Blue] {
            let values: Vec<String> = row.values(button).iter().map(plain).collect();
            write!(text, ",{}", values.join(";")).expect("a String takes everything");
        }
    }
    text + "\n"
}

fn plain(value: &Value) -> String {
    match value {
        Value::Number(number) => format!("{number:?}"),
        Value::Text(word) => word.clone(),
    }
}

/// The rows of a table that [`allocation_csv`] wrote for `design`.
///
/// # Errors
/// When a line is not exactly as it would be written.
pub fn parse_allocation(design: &Design, text: &str) -> Result<Vec<Row>, TableError> {
    let mut lines = text.split_inclusive('\n');
    if lines.next() != Some(&heading(design)) {
        return Err(TableError { line: 1 });
    }
    let mut rows = Vec::new();
    for (found, number) in lines.zip(2..) {
        let row = parse_line(design, found.trim_end_matches('\n'));
        let row =
            row.filter(|row| line(design, row) == found && row.slot as usize == rows.len() + 1);
        rows.push(row.ok_or(TableError { line: number })?);
    }
    Ok(rows)
}

fn parse_line(design: &Design, text: &str) -> Option<Row> {
    let cells: Vec<&str> = text.split(',').collect();
    let first_button = match *cells.get(5)? {
        "Red" => Button::Red,
        _ => Button::Blue,
    };
    let arrangement = Arrangement {
        zero_first: *cells.get(4)? == "0-first",
        first_button,
    };
    let (red, blue) = (
        condition(design, cells.get(10)?)?,
        condition(design, cells.get(11)?)?,
    );
    let values = |cell: usize, condition: &Condition| match cells.get(cell) {
        Some(text) => parse_values(design, text),
        None => fixed_values(design, condition),
    };
    let (red_values, blue_values) = (values(12, &red)?, values(13, &blue)?);
    let (low, high) = if arrangement.red_is_high() {
        ((blue, blue_values), (red, red_values))
    } else {
        ((red, red_values), (blue, blue_values))
    };
    Some(Row {
        slot: cells[0].parse().ok()?,
        block: cells[1].parse().ok()?,
        changed: design.changed(&low.0, &high.0),
        low: low.0,
        high: high.0,
        arrangement,
        low_values: low.1,
        high_values: high.1,
    })
}

fn condition(design: &Design, text: &str) -> Option<Condition> {
    let known = design.cells.iter().flat_map(|cell| [&cell.low, &cell.high]);
    known
        .into_iter()
        .find(|condition| condition.to_string() == text)
        .cloned()
}

fn fixed_values(design: &Design, condition: &Condition) -> Option<Vec<Value>> {
    let levels = design.factors.iter().zip(&condition.0);
    levels
        .map(|(factor, level)| match &factor.levels {
            Levels::Fixed(values) => values.get(usize::from(*level)).cloned(),
            Levels::Range { .. } => None,
        })
        .collect()
}

fn parse_values(design: &Design, text: &str) -> Option<Vec<Value>> {
    let parts: Vec<&str> = text.split(';').collect();
    let value = |(factor, part): (&super::Factor, &str)| match &factor.levels {
        Levels::Fixed(values) => values.iter().find(|value| plain(value) == part).cloned(),
        Levels::Range { .. } => part.parse().ok().map(Value::Number),
    };
    let values = design
        .factors
        .iter()
        .zip(parts)
        .map(value)
        .collect::<Option<Vec<_>>>()?;
    (values.len() == design.factors.len()).then_some(values)
}

#[cfg(test)]
mod tests {
    use super::super::{Scheme, allocate};
    use super::*;

    #[test]
    fn table_is_read_back_to_the_same_rows() {
        for scheme in [Scheme::Table2, Scheme::Full, Scheme::Continuous] {
            let design = scheme.design().unwrap();
            let rows = allocate(&design, 40, 9);
            let text = allocation_csv(&design, &rows);
            assert_eq!(
                parse_allocation(&design, &text).unwrap(),
                rows,
                "{scheme:?}"
            );
        }
    }

    #[test]
    fn heading_and_columns_are_those_of_the_layout() {
        let design = Scheme::Table2.design().unwrap();
        // A row of the layout's own example, which another program wrote.
        let example = "slot,block,efs,changed,order,first_button,game1_button,game1_efs,game2_button,game2_efs,red_efs,blue_efs\n\
            1,1,110,shape,1-first,Red,Red,111,Blue,110,111,110\n2,1,000,elasticity,0-first,Red,Red,000,Blue,100,000,100\n\
            3,1,110,shape,0-first,Blue,Blue,110,Red,111,111,110\n4,1,000,friction,1-first,Blue,Blue,010,Red,000,000,010\n";
        let rows = parse_allocation(&design, example).unwrap();
        assert_eq!(allocation_csv(&design, &rows), example);
        let settings = rows[3].settings(&design, Button::Blue);
        let text: Vec<String> = settings
            .iter()
            .map(|(key, value)| format!("{key}={value}"))
            .collect();
        assert_eq!(
            text,
            [
                "objects.elasticity=1.0",
                "objects.friction_rate=0.7",
                "objects.shape=\"ellipsoid\""
            ]
        );
    }

    #[test]
    fn parse_refuses_every_changed_byte() {
        let design = Scheme::Continuous.design().unwrap();
        let text = allocation_csv(&design, &allocate(&design, 3, 9));
        let mut unseen = Vec::new();
        for at in 0..text.len() {
            let mut bytes = text.clone().into_bytes();
            bytes[at] ^= 1;
            let changed = String::from_utf8(bytes).unwrap();
            // Block numbers and drawn values may be others; the plan's digest guards those.
            if parse_allocation(&design, &changed).is_ok() {
                unseen.push(text.as_bytes()[at]);
            }
        }
        assert!(unseen.iter().all(u8::is_ascii_digit), "{unseen:?}");
        assert_eq!(
            parse_allocation(&design, &text.replace("\n2,", "\n5,")),
            Err(TableError { line: 3 })
        );
    }
}
