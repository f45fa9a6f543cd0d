//! The tables of a study in BIDS, each rebuilt from records: the same records give the same bytes.
//!
//! Layout: `docs/study.md`. K. J. Gorgolewski et al. (2016), *The brain imaging data structure*, Scientific Data 3; its motion
//! part: S. Jeung et al. (2024), *Motion-BIDS*, Scientific Data 11.

mod answers;
mod export;
mod layout;
mod motion;
mod pairs;
mod sessions;

use serde_json::{Map, Value, json};

pub use export::{Export, ExportError, Exported, Format};
pub use layout::Tables;

/// A table and the dictionary of its columns.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Table {
    columns: Vec<Column>,
    rows: Vec<Vec<String>>,
}

/// A column and what its dictionary says.
#[derive(Debug, Clone, PartialEq)]
struct Column {
    name: String,
    about: Value,
}

impl Column {
    fn new(name: impl Into<String>, description: impl Into<String>) -> Self {
        Column {
            name: name.into(),
            about: json!({ "Description": description.into() }),
        }
    }

    fn with_units(mut self, units: &str) -> Self {
        self.about["Units"] = units.into();
        self
    }

    fn with_levels<'a>(mut self, levels: impl IntoIterator<Item = (&'a str, &'a str)>) -> Self {
        let levels = levels
            .into_iter()
            .map(|(level, text)| (level.to_owned(), text.into()));
        self.about["Levels"] = Value::Object(levels.collect::<Map<_, _>>());
        self
    }
}

impl Table {
    fn new(columns: Vec<Column>) -> Self {
        Table {
            columns,
            rows: Vec::new(),
        }
    }

    /// Adds a row; an empty cell is `n/a`.
    fn push(&mut self, row: Vec<String>) {
        assert_eq!(
            row.len(),
            self.columns.len(),
            "a row has a cell for each column"
        );
        self.rows.push(row);
    }

    fn names(&self) -> Vec<&str> {
        self.columns
            .iter()
            .map(|column| column.name.as_str())
            .collect()
    }

    fn tsv(&self) -> String {
        let mut text = self.names().join("\t") + "\n";
        for row in &self.rows {
            let cells: Vec<String> = row.iter().map(|cell| tsv_cell(cell)).collect();
            text += &(cells.join("\t") + "\n");
        }
        text
    }

    fn csv(&self) -> String {
        let mut text = self.names().join(",") + "\n";
        for row in &self.rows {
            let cells: Vec<String> = row.iter().map(|cell| csv_cell(&tsv_cell(cell))).collect();
            text += &(cells.join(",") + "\n");
        }
        text
    }

    /// The dictionary: what each column means.
    fn dictionary(&self) -> Map<String, Value> {
        self.columns
            .iter()
            .map(|column| (column.name.clone(), column.about.clone()))
            .collect()
    }
}

fn tsv_cell(cell: &str) -> String {
    if cell.is_empty() {
        return "n/a".to_owned();
    }
    cell.replace(['\t', '\n', '\r'], " ")
}

/// RFC 4180, with `NA` as R and pandas have it.
fn csv_cell(cell: &str) -> String {
    match cell {
        "n/a" => "NA".to_owned(),
        cell if cell.contains([',', '"']) => format!("\"{}\"", cell.replace('"', "\"\"")),
        cell => cell.to_owned(),
    }
}

/// JSON as files have it.
fn pretty(value: &Value) -> String {
    serde_json::to_string_pretty(value).expect("values have a form in JSON") + "\n"
}

/// Seconds or metres to the millionth; never `-0`.
fn number(value: f64) -> String {
    let text = format!("{value:.6}");
    if text == "-0.000000" {
        "0.000000".to_owned()
    } else {
        text
    }
}

fn optional<T>(value: Option<T>, text: impl Fn(T) -> String) -> String {
    value.map_or_else(String::new, text)
}

#[cfg(test)]
pub(crate) mod tests;
