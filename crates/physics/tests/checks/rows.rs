//! The table of what is to be checked.

use std::fmt;

/// A value that a simulation has to meet.
pub struct Row {
    /// Name, once in the table.
    pub id: String,
    /// What is set up, and what is measured of it.
    what: String,
    /// From and to, the tolerance included.
    range: (f64, f64),
    unit: String,
    source: String,
}

impl Row {
    /// Whether a measured value lies in the range.
    pub fn holds(&self, value: f64) -> bool {
        (self.range.0..=self.range.1).contains(&value)
    }

    fn new(line: &str) -> Row {
        let fields: Vec<&str> = line.split(',').collect();
        let [
            id,
            setup,
            quantity,
            low,
            high,
            tolerance,
            unit,
            _kind,
            source,
        ] = fields[..]
        else {
            panic!("checks.csv: a row has nine fields: {line}");
        };
        let number = |text: &str| {
            text.parse::<f64>()
                .expect("low, high and tolerance are numbers")
        };
        let (low, high) = (number(low), number(high));
        let (below, above) = match tolerance.strip_suffix('%') {
            Some(share) => {
                let share = 0.01 * number(share);
                (share * low, share * high)
            }
            None => (number(tolerance), number(tolerance)),
        };
        Row {
            id: id.to_owned(),
            what: format!("{quantity} ({setup})"),
            range: (low - below, high + above),
            unit: unit.to_owned(),
            source: source.to_owned(),
        }
    }
}

impl fmt::Display for Row {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (low, high) = self.range;
        let (id, what, unit, source) = (&self.id, &self.what, &self.unit, &self.source);
        write!(f, "{id}, {what}: {low:.5} to {high:.5} {unit} by {source}")
    }
}

/// All rows.
pub fn rows() -> Vec<Row> {
    let lines = include_str!("../data/checks.csv").lines();
    lines.skip(1).map(Row::new).collect()
}
