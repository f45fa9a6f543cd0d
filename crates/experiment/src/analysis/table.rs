//! A plain table from a file, every cell with its place, so that what cannot be used is refused by row and column.

use thiserror::Error;

/// Why a table cannot be used.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum TableError {
    /// Nothing below the header.
    #[error("{table}: there is no row below the header line")]
    Empty {
        /// The table's name.
        table: String,
    },
    /// Two columns of one name.
    #[error("{table}, line 1: there are two columns \"{column}\"; name one of them differently")]
    Twice {
        /// The table's name.
        table: String,
        /// The column's name.
        column: String,
    },
    /// A row with too few or too many cells.
    #[error("{table}, line {line}: {found} cells under {expected} columns")]
    Ragged {
        /// The table's name.
        table: String,
        /// Line of the file, from 1.
        line: usize,
        /// Cells in the row.
        found: usize,
        /// Columns in the header.
        expected: usize,
    },
    /// A cell that says nothing that its column may say.
    #[error("{table}, line {line}, column {column}: \"{found}\" is not {expected}")]
    Cell {
        /// The table's name.
        table: String,
        /// Line of the file, from 1.
        line: usize,
        /// The column's name.
        column: String,
        /// What the cell holds.
        found: String,
        /// What it may hold.
        expected: String,
    },
    /// Two cells that contradict each other.
    #[error("{table}, line {line}: {problem}")]
    Contradiction {
        /// The table's name.
        table: String,
        /// Line of the file, from 1.
        line: usize,
        /// What contradicts what.
        problem: String,
    },
    /// A column that is needed and not there.
    #[error("{table}: there is no column {needed}; the columns are {present}")]
    Missing {
        /// The table's name.
        table: String,
        /// The column that is needed, and by what.
        needed: String,
        /// The columns that are there.
        present: String,
    },
    /// A file that cannot be read.
    #[error("cannot read {table}: {reason}")]
    Unreadable {
        /// The file.
        table: String,
        /// Why.
        reason: String,
    },
}

/// A table of text.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Table {
    /// What it is called in messages: its path.
    pub name: String,
    /// Names of the columns.
    pub header: Vec<String>,
    /// The cells, row by row.
    pub rows: Vec<Vec<String>>,
    /// The line of the file where each row began, from 1.
    pub lines: Vec<usize>,
}

impl Table {
    /// Reads comma- or tab-separated text; the header decides which, and quotation marks may enclose a cell.
    ///
    /// # Errors
    /// When there is no row, a column twice, or a row of another length.
    pub fn parse(name: &str, text: &str) -> Result<Table, TableError> {
        let text = text.strip_prefix('\u{feff}').unwrap_or(text);
        let first = text.lines().next().unwrap_or("");
        let separator = if first.contains('\t') { '\t' } else { ',' };
        let mut records = records(text, separator).into_iter();
        let mut table = Table {
            name: name.to_owned(),
            ..Table::default()
        };
        if let Some((_, header)) = records.next() {
            table.header = header.iter().map(|name| name.trim().to_owned()).collect();
        }
        for (i, column) in table.header.iter().enumerate() {
            if table.header[..i].contains(column) {
                return Err(TableError::Twice {
                    table: name.to_owned(),
                    column: column.clone(),
                });
            }
        }
        for (line, cells) in records {
            if cells.len() != table.header.len() {
                let (found, expected) = (cells.len(), table.header.len());
                return Err(TableError::Ragged {
                    table: name.to_owned(),
                    line,
                    found,
                    expected,
                });
            }
            table.rows.push(cells);
            table.lines.push(line);
        }
        if table.rows.is_empty() {
            return Err(TableError::Empty {
                table: name.to_owned(),
            });
        }
        Ok(table)
    }

    /// Reads a file.
    ///
    /// # Errors
    /// As [`Table::parse`], and when the file cannot be read as text.
    pub fn read(path: &std::path::Path) -> Result<Table, TableError> {
        let table = path.display().to_string();
        match std::fs::read_to_string(path) {
            Ok(text) => Table::parse(&table, &text),
            Err(error) => Err(TableError::Unreadable {
                table,
                reason: error.to_string(),
            }),
        }
    }

    /// The place of the first of these columns that is there.
    pub fn column(&self, names: &[&str]) -> Option<usize> {
        names
            .iter()
            .find_map(|name| self.header.iter().position(|column| column == name))
    }

    /// The place of the first of these columns that is there.
    ///
    /// # Errors
    /// When none is.
    pub fn needed(&self, names: &[&str], why: &str) -> Result<usize, TableError> {
        self.column(names)
            .ok_or_else(|| self.missing(names[0], why))
    }

    /// The refusal of a table that lacks a column.
    pub fn missing(&self, column: &str, why: &str) -> TableError {
        let needed = format!("\"{column}\", which {why}");
        TableError::Missing {
            table: self.name.clone(),
            needed,
            present: self.header.join(", "),
        }
    }

    /// A cell's text; `None` where nothing was answered: blank, `n/a` or `NA`.
    pub fn cell(&self, row: usize, column: usize) -> Option<&str> {
        let text = self.rows[row][column].trim();
        (!matches!(text, "" | "n/a" | "N/A" | "NA")).then_some(text)
    }

    /// A number.
    ///
    /// # Errors
    /// When the cell holds something else.
    pub fn number(&self, row: usize, column: usize) -> Result<Option<f64>, TableError> {
        let Some(text) = self.cell(row, column) else {
            return Ok(None);
        };
        match text.parse::<f64>() {
            Ok(value) if value.is_finite() => Ok(Some(value)),
            _ => Err(self.refuse(row, column, "a number")),
        }
    }

    /// A whole number of a range.
    ///
    /// # Errors
    /// When the cell holds something else.
    pub fn whole(
        &self,
        row: usize,
        column: usize,
        low: u32,
        high: u32,
    ) -> Result<Option<u32>, TableError> {
        let Some(text) = self.cell(row, column) else {
            return Ok(None);
        };
        match text.parse::<f64>() {
            Ok(value)
                if value.fract() == 0.0 && value >= f64::from(low) && value <= f64::from(high) =>
            {
                Ok(Some(value as u32))
            }
            _ => Err(self.refuse(row, column, &format!("a whole number from {low} to {high}"))),
        }
    }

    /// A yes or no, in words or as 1 and 0.
    ///
    /// # Errors
    /// When the cell holds something else.
    pub fn yes_no(&self, row: usize, column: usize) -> Result<Option<bool>, TableError> {
        match self.cell(row, column) {
            None => Ok(None),
            Some(text) => match yes_or_no(text) {
                Some(is) => Ok(Some(is)),
                None => Err(self.refuse(row, column, "yes or no, nor 1 or 0")),
            },
        }
    }

    /// The refusal of a cell.
    pub fn refuse(&self, row: usize, column: usize, expected: &str) -> TableError {
        TableError::Cell {
            table: self.name.clone(),
            line: self.lines[row],
            column: self.header[column].clone(),
            found: self.rows[row][column].trim().to_owned(),
            expected: expected.to_owned(),
        }
    }

    /// The refusal of a row that contradicts itself.
    pub fn contradiction(&self, row: usize, problem: String) -> TableError {
        TableError::Contradiction {
            table: self.name.clone(),
            line: self.lines[row],
            problem,
        }
    }
}

/// Both codings of yes and no: words and 1 and 0.
pub fn yes_or_no(text: &str) -> Option<bool> {
    match text.to_ascii_lowercase().as_str() {
        "yes" | "1" => Some(true),
        "no" | "0" => Some(false),
        _ => None,
    }
}

/// The records of separated text with the line where each begins; blank lines are left out.
fn records(text: &str, separator: char) -> Vec<(usize, Vec<String>)> {
    let mut records = Vec::new();
    let (mut cells, mut cell) = (Vec::new(), String::new());
    let (mut line, mut began, mut is_quoted) = (1, 1, false);
    let mut characters = text.chars().peekable();
    while let Some(character) = characters.next() {
        match character {
            '"' if is_quoted && characters.peek() == Some(&'"') => {
                characters.next();
                cell.push('"');
            }
            '"' if is_quoted || cell.trim().is_empty() => is_quoted = !is_quoted,
            '\n' if !is_quoted => {
                line += 1;
                close(&mut records, &mut cells, &mut cell, began);
                began = line;
            }
            '\r' if !is_quoted => {}
            _ if character == separator && !is_quoted => cells.push(std::mem::take(&mut cell)),
            _ => {
                line += usize::from(character == '\n');
                cell.push(character);
            }
        }
    }
    close(&mut records, &mut cells, &mut cell, began);
    records
}

fn close(
    records: &mut Vec<(usize, Vec<String>)>,
    cells: &mut Vec<String>,
    cell: &mut String,
    line: usize,
) {
    if !cells.is_empty() || !cell.trim().is_empty() {
        cells.push(std::mem::take(cell));
        records.push((line, std::mem::take(cells)));
    }
    cell.clear();
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn parse_reads_quotes_tabs_and_blank_lines() {
        let table = Table::parse("t", "id,said\r\n1,\"a, \"\"b\"\"\nc\"\n\n2,n/a\n").unwrap();
        assert_eq!(table.cell(0, 1), Some("a, \"b\"\nc"));
        assert_eq!((table.cell(1, 1), table.lines[1]), (None, 5));
        assert_eq!(
            Table::parse("t", "a\tb\n1,5\t2\n").unwrap().rows[0],
            ["1,5", "2"]
        );
    }

    #[test]
    fn parse_refuses_what_is_no_table() {
        let problem = |text: &str| Table::parse("f.csv", text).unwrap_err().to_string();
        assert_eq!(
            problem("a,b\n"),
            "f.csv: there is no row below the header line"
        );
        assert_eq!(
            problem("a,b\n1,2\n3\n"),
            "f.csv, line 3: 1 cells under 2 columns"
        );
        assert!(problem("a,a\n1,2\n").contains("two columns \"a\""));
    }

    #[test]
    fn cells_are_refused_by_row_and_column() {
        let table = Table::parse("f.csv", "vr,sick\nyes,3\nmaybe,8\n1,x\n").unwrap();
        assert_eq!(
            (table.yes_no(0, 0), table.yes_no(2, 0)),
            (Ok(Some(true)), Ok(Some(true)))
        );
        let problem = table.yes_no(1, 0).unwrap_err().to_string();
        assert_eq!(
            problem,
            "f.csv, line 3, column vr: \"maybe\" is not yes or no, nor 1 or 0"
        );
        assert!(
            table
                .whole(1, 1, 1, 7)
                .unwrap_err()
                .to_string()
                .contains("line 3, column sick: \"8\"")
        );
        assert!(table.number(2, 1).is_err());
    }
}
