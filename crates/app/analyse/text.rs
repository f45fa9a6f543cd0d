//! A report in the terminal.

use super::report::{Block, Table};

/// Widest line of running text.
const WIDTH: usize = 110;

/// The report as text.
pub fn text(blocks: &[Block]) -> String {
    let mut text = String::new();
    for block in blocks {
        match block {
            Block::Heading(heading) => {
                text += &format!("\n{heading}\n{}\n", "=".repeat(heading.chars().count()));
            }
            Block::Text(words) => text += &format!("\n{}", wrapped(words)),
            Block::Table(table) => {
                text += &format!("\n{}{}", wrapped(&table.caption), columns(table))
            }
            Block::Figure(_) => {}
        }
    }
    text
}

fn wrapped(words: &str) -> String {
    let mut text = String::new();
    let mut length = 0;
    for word in words.split_whitespace() {
        let room = word.chars().count() + usize::from(length > 0);
        if length > 0 && length + room > WIDTH {
            text.push('\n');
            length = 0;
        } else if length > 0 {
            text.push(' ');
            length += 1;
        }
        text += word;
        length += word.chars().count();
    }
    text + "\n"
}

/// The table with its first column to the left and the others to the right, in columns of their own width.
fn columns(table: &Table) -> String {
    let rows: Vec<&Vec<String>> = std::iter::once(&table.header).chain(&table.rows).collect();
    let width = |column: usize| {
        rows.iter()
            .map(|row| row[column].chars().count())
            .max()
            .unwrap_or(0)
    };
    let widths: Vec<usize> = (0..table.header.len()).map(width).collect();
    let is_words = |column: usize| {
        let letters = |cell: &String| cell.chars().filter(|c| c.is_alphabetic()).count();
        table.rows.iter().any(|row| letters(&row[column]) > 6)
    };
    let mut text = String::new();
    for row in rows {
        let cells = row.iter().enumerate().map(|(column, cell)| {
            let width = widths[column];
            if column == 0 || is_words(column) {
                format!("{cell:<width$}")
            } else {
                format!("{cell:>width$}")
            }
        });
        let line = cells.collect::<Vec<_>>().join("  ");
        text += &format!("  {}\n", line.trim_end());
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn text_aligns_columns_and_breaks_lines() {
        let mut table = Table::new("Caption", &["name", "x"]);
        table.rows = vec![
            vec!["a".to_owned(), "10.5".to_owned()],
            vec!["long".to_owned(), "2".to_owned()],
        ];
        let words = "word ".repeat(60);
        let text = text(&[Block::Table(table), Block::Text(words)]);
        assert!(
            text.starts_with("\nCaption\n  name     x\n  a     10.5\n  long     2\n"),
            "{text}"
        );
        assert!(text.lines().all(|line| line.len() <= WIDTH));
    }
}
