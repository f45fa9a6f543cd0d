//! What a report says, as blocks that the terminal and the page show in their own ways.

use experiment::analysis::study::Analysis;

use super::{honest, paper};

/// A piece of a report.
#[derive(Debug, Clone, PartialEq)]
pub enum Block {
    /// A heading.
    Heading(String),
    /// A sentence or several.
    Text(String),
    /// A table.
    Table(Table),
    /// A figure that only a page can show: its name among the figures.
    Figure(&'static str),
}

/// A table of a report.
#[derive(Debug, Clone, PartialEq)]
pub struct Table {
    /// What it shows.
    pub caption: String,
    /// Names of the columns.
    pub header: Vec<String>,
    /// The rows; the first cell names the row.
    pub rows: Vec<Vec<String>>,
}

impl Table {
    /// An empty table.
    pub fn new(caption: impl Into<String>, header: &[&str]) -> Table {
        let header = header.iter().map(|name| (*name).to_owned()).collect();
        Table {
            caption: caption.into(),
            header,
            rows: Vec::new(),
        }
    }
}

/// The report.
pub fn blocks(analysis: &Analysis) -> Vec<Block> {
    let mut blocks = who(analysis);
    blocks.extend(paper::blocks(analysis));
    blocks.extend(honest::blocks(analysis));
    blocks
}

/// Who is in it, and who is not.
fn who(analysis: &Analysis) -> Vec<Block> {
    let regression = &analysis.regression;
    let design = &regression.design;
    let mut blocks = vec![
        Block::Heading(format!("Analysis of {}", analysis.source)),
        Block::Text(format!(
            "{} of {} subjects, {} answers; {} columns of rank {}; model: {}.",
            design.used.len(),
            analysis.subjects.list.len(),
            design.asked.iter().sum::<f64>(),
            design.columns.len(),
            regression.fit.rank(),
            design.model,
        )),
    ];
    for excluded in &design.excluded {
        blocks.push(Block::Text(format!(
            "Left out: {}, because {}.",
            excluded.id, excluded.reason
        )));
    }
    let aliased = design.names(&regression.fit.aliases.aliased);
    if !aliased.is_empty() {
        blocks.push(Block::Text(format!(
            "Aliased, that is, zero or a combination of columns before them, and left out of every fit: {}.",
            aliased.join(", ")
        )));
    }
    if design.used.len() < design.columns.len() {
        blocks.push(Block::Text(format!(
            "Fewer rows ({}) than columns ({}): not every coefficient can be told, and nothing is left to judge the fit by.",
            design.used.len(),
            design.columns.len()
        )));
    }
    blocks
}

/// A number with the paper's four digits.
pub fn digits(value: f64) -> String {
    if value.is_nan() {
        return "-".to_owned();
    }
    if value.is_infinite() {
        return if value > 0.0 { "+Inf" } else { "-Inf" }.to_owned();
    }
    if value == 0.0 {
        return "0".to_owned();
    }
    let magnitude = value.abs().log10().floor() as i32;
    if !(-4..=6).contains(&magnitude) {
        return format!("{value:.3e}");
    }
    format!("{value:.*}", (3 - magnitude).max(0) as usize)
}

/// A probability.
pub fn p(value: Option<f64>) -> String {
    match value {
        None => "-".to_owned(),
        Some(p) if p < 1e-4 => format!("{p:.1e}"),
        Some(p) => format!("{p:.4}"),
    }
}

/// An interval.
pub fn interval(low: f64, high: f64) -> String {
    format!("{} to {}", digits(low), digits(high))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn digits_are_the_papers() {
        let pairs = [
            (0.69802, "0.6980"),
            (-3.8361, "-3.836"),
            (12.727, "12.73"),
            (0.71494, "0.7149"),
            (1234567.0, "1234567"),
        ];
        for (value, text) in pairs {
            assert_eq!(digits(value), text);
        }
        assert_eq!(
            (digits(f64::INFINITY), digits(f64::NAN), digits(0.0)),
            ("+Inf".to_owned(), "-".to_owned(), "0".to_owned())
        );
        assert_eq!(p(Some(0.00672)), "0.0067");
        assert_eq!(p(Some(3.2e-9)), "3.2e-9");
    }
}
