//! The balance that a plan has: counted from its rows, whatever made them.

use std::collections::BTreeMap;
use std::fmt;

use super::{Arrangement, Button, Design, Row};

/// Table 2 of the paper: `EFS`, changed parameter, number of subjects.
pub const PAPER_TABLE_2: [(&str, &str, u32); 12] = [
    ("000", "shape", 2),
    ("000", "friction", 2),
    ("000", "elasticity", 2),
    ("100", "shape", 1),
    ("010", "shape", 1),
    ("100", "friction", 1),
    ("001", "friction", 1),
    ("010", "elasticity", 1),
    ("001", "elasticity", 1),
    ("110", "shape", 2),
    ("101", "friction", 2),
    ("011", "elasticity", 2),
];

/// What [`balance`] counts. Spreads are largest count less smallest.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Balance {
    /// Participants.
    pub subjects: u32,
    /// Participants by what changes.
    pub changed: Vec<(String, u32)>,
    /// Participants of each cell: lower condition, what changes, how many.
    pub cells: Vec<(String, String, u32)>,
    /// For each factor its name, how many change it, and how many keep it at each of its levels.
    pub levels: Vec<(String, u32, Vec<u32>)>,
    /// Participants who meet the lower condition first, and second.
    pub order: [u32; 2],
    /// Participants who press Red first, and Blue first.
    pub first_button: [u32; 2],
    /// Participants for whom Red, and for whom Blue, means the higher levels.
    pub high_button: [u32; 2],
    /// Participants of each arrangement, in the order of [`Arrangement::ALL`].
    pub arrangements: [u32; 4],
    /// Largest spread of arrangements among those who have the same change.
    pub spread_within_changed: u32,
    /// Largest spread of arrangements within a cell.
    pub spread_within_cell: u32,
    /// What is not as the design promises; empty when all is.
    pub problems: Vec<String>,
    /// Whether every row of the paper's Table 2 has its number of participants, once per 18; `None` where the design or the
    /// number of participants cannot have it.
    pub table_2: Option<bool>,
}

impl Balance {
    /// Spread of the four arrangements over all participants.
    pub fn spread(&self) -> u32 {
        spread(&self.arrangements)
    }
}

/// Counts the balance of `rows`.
pub fn balance(design: &Design, rows: &[Row]) -> Balance {
    let count = |is: &dyn Fn(&&Row) -> bool| rows.iter().filter(is).count() as u32;
    let arrangements_of = |is: &dyn Fn(&Row) -> bool| {
        Arrangement::ALL.map(|arrangement| count(&|row| row.arrangement == arrangement && is(row)))
    };
    let groups = design.groups();
    let changed = groups
        .iter()
        .map(|(name, _)| (name.clone(), count(&|row| row.changed == *name)));
    let within_changed = groups
        .iter()
        .map(|(name, _)| spread(&arrangements_of(&|row| row.changed == *name)));
    let in_cell = |cell: &super::Cell, row: &Row| row.low == cell.low && row.high == cell.high;
    let within_cell = design
        .cells
        .iter()
        .map(|cell| spread(&arrangements_of(&|row| in_cell(cell, row))));
    let cells = design.cells.iter().map(|cell| {
        let changed = design.changed(&cell.low, &cell.high);
        (
            cell.low.to_string(),
            changed,
            count(&|row| in_cell(cell, row)),
        )
    });
    let two = |is: &dyn Fn(&&Row) -> bool| [count(is), rows.len() as u32 - count(is)];
    let mut balance = Balance {
        subjects: rows.len() as u32,
        changed: changed.collect(),
        cells: cells.collect(),
        levels: levels(design, rows),
        order: two(&|row| row.arrangement.zero_first),
        first_button: two(&|row| row.arrangement.first_button == Button::Red),
        high_button: two(&|row| row.arrangement.red_is_high()),
        arrangements: arrangements_of(&|_| true),
        spread_within_changed: within_changed.max().unwrap_or(0),
        spread_within_cell: within_cell.max().unwrap_or(0),
        problems: Vec::new(),
        table_2: None,
    };
    balance.table_2 = table_2(&balance);
    balance.problems = problems(design, rows, &balance);
    balance
}

fn spread(counts: &[u32]) -> u32 {
    let largest = counts.iter().max().copied().unwrap_or(0);
    largest - counts.iter().min().copied().unwrap_or(0)
}

fn levels(design: &Design, rows: &[Row]) -> Vec<(String, u32, Vec<u32>)> {
    let factors = design.factors.iter().enumerate();
    factors
        .map(|(index, factor)| {
            let mut kept = vec![0; factor.levels.count()];
            let mut changed = 0;
            for row in rows {
                let (low, high) = (row.low.0[index], row.high.0[index]);
                if low == high {
                    kept[usize::from(low)] += 1;
                } else {
                    changed += 1;
                }
            }
            (factor.name.clone(), changed, kept)
        })
        .collect()
}

fn table_2(balance: &Balance) -> Option<bool> {
    let paper: BTreeMap<(&str, &str), u32> = PAPER_TABLE_2
        .iter()
        .map(|(efs, changed, n)| ((*efs, *changed), *n))
        .collect();
    let rows = balance
        .cells
        .iter()
        .map(|(efs, changed, n)| ((efs.as_str(), changed.as_str()), *n));
    let rows: BTreeMap<_, _> = rows.collect();
    let comparable =
        balance.subjects > 0 && balance.subjects.is_multiple_of(18) && rows.keys().eq(paper.keys());
    let times = balance.subjects / 18;
    comparable.then(|| rows.iter().all(|(row, n)| *n == paper[row] * times))
}

fn problems(design: &Design, rows: &[Row], balance: &Balance) -> Vec<String> {
    let mut problems = Vec::new();
    let whole = design.block_size();
    let blocks = balance.subjects / whole;
    for (cell, (low, changed, count)) in design.cells.iter().zip(&balance.cells) {
        let (least, most) = match balance.subjects % whole {
            0 => (blocks * cell.weight, blocks * cell.weight),
            _ => (blocks * cell.weight, (blocks + 1) * cell.weight),
        };
        if !(least..=most).contains(count) {
            problems.push(format!("cell {low} with {changed} changed has {count} participants instead of {least} to {most}"));
        }
    }
    for ((name, cells), (_, count)) in design.groups().iter().zip(&balance.changed) {
        let weight: u32 = cells.iter().map(|cell| design.cells[*cell].weight).sum();
        // Each group's exact share, times the block's size; a share apart is one participant.
        let off = (count * whole).abs_diff(balance.subjects * weight);
        if off >= whole {
            problems.push(format!(
                "{name} changes for {count} participants, which is a whole one off its share"
            ));
        }
    }
    for (what, spread) in [
        ("over all participants", balance.spread()),
        (
            "among those with the same change",
            balance.spread_within_changed,
        ),
    ] {
        if spread > 1 {
            problems.push(format!("the numbers of the four arrangements differ by {spread} {what}, and by 1 at most in a plan of this program"));
        }
    }
    let strangers = rows.iter().filter(|row| {
        let is = |cell: &super::Cell| cell.low == row.low && cell.high == row.high;
        !design.cells.iter().any(is)
    });
    problems.extend(strangers.map(|row| {
        format!(
            "slot {} has a pair of conditions that is no cell of the design",
            row.slot
        )
    }));
    problems
}

impl fmt::Display for Balance {
    fn fmt(&self, out: &mut fmt::Formatter) -> fmt::Result {
        writeln!(out, "{} participants", self.subjects)?;
        writeln!(out, "\nchanged             participants")?;
        for (name, count) in &self.changed {
            writeln!(out, "{name:<28} {count:>3}")?;
        }
        writeln!(
            out,
            "\nfactor              changed  kept at level 0, 1, ..."
        )?;
        for (name, changed, kept) in &self.levels {
            let kept: Vec<String> = kept.iter().map(|count| format!("{count:>3}")).collect();
            writeln!(out, "{name:<20} {changed:>6}  {}", kept.join(" "))?;
        }
        writeln!(
            out,
            "\nlower condition  changed                  participants"
        )?;
        for (low, changed, count) in &self.cells {
            writeln!(out, "{low:<16} {changed:<28} {count:>8}")?;
        }
        let [zero, one] = self.order;
        let [red, blue] = self.first_button;
        let [red_high, blue_high] = self.high_button;
        writeln!(
            out,
            "\nlower levels first {zero}, second {one}; Red first {red}, Blue first {blue}"
        )?;
        writeln!(
            out,
            "Red has the higher levels {red_high} times, Blue {blue_high} times"
        )?;
        for (arrangement, count) in Arrangement::ALL.iter().zip(self.arrangements) {
            writeln!(
                out,
                "{}, {:<4} first {count:>4}",
                arrangement.order(),
                arrangement.first_button
            )?;
        }
        writeln!(
            out,
            "spread of the arrangements: {} over all, at most {} among those with the same change, at most {} within a cell",
            self.spread(),
            self.spread_within_changed,
            self.spread_within_cell
        )?;
        match self.table_2 {
            Some(true) => writeln!(
                out,
                "Table 2 of the paper: all 12 rows agree ({} times its 18 participants)",
                self.subjects / 18
            )?,
            Some(false) => writeln!(out, "Table 2 of the paper: NOT met")?,
            None => writeln!(
                out,
                "Table 2 of the paper: does not apply to this design and number of participants"
            )?,
        }
        for problem in &self.problems {
            writeln!(out, "problem: {problem}")?;
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::super::{Condition, Scheme, allocate};
    use super::*;

    #[test]
    fn balance_reports_what_is_there() {
        let design = Scheme::Table2.design().unwrap();
        let text = balance(&design, &allocate(&design, 18, 1997)).to_string();
        for line in [
            "18 participants",
            "elasticity                     6",
            "000              shape                               2",
            "lower levels first 9, second 9",
            "Red has the higher levels 9 times, Blue 9 times",
            "spread of the arrangements: 1 over all, at most 1 among those with the same change",
            "Table 2 of the paper: all 12 rows agree (1 times its 18 participants)",
        ] {
            assert!(text.contains(line), "{line} in\n{text}");
        }
        assert!(!text.contains("problem"), "{text}");
        let other = balance(&design, &allocate(&design, 19, 1997)).to_string();
        assert!(
            other.contains("Table 2 of the paper: does not apply"),
            "{other}"
        );
    }

    #[test]
    fn balance_names_what_is_wrong() {
        let design = Scheme::Table2.design().unwrap();
        let good = allocate(&design, 18, 1997);
        let with = |change: &dyn Fn(&mut Vec<Row>)| {
            let mut rows = good.clone();
            change(&mut rows);
            balance(&design, &rows)
        };
        let cell = with(&|rows| {
            let other = rows
                .iter()
                .find(|row| row.low != rows[0].low && row.changed == rows[0].changed)
                .unwrap()
                .clone();
            (rows[0].low, rows[0].high) = (other.low, other.high);
        });
        assert_eq!(cell.table_2, Some(false));
        assert!(
            cell.problems[0].contains("participants instead of"),
            "{:?}",
            cell.problems
        );
        assert!(cell.to_string().contains("Table 2 of the paper: NOT met"));
        let one_way = with(&|rows| {
            rows.iter_mut()
                .for_each(|row| row.arrangement = Arrangement::ALL[0])
        });
        assert_eq!((one_way.order, one_way.spread()), ([18, 0], 18));
        assert!(
            one_way
                .problems
                .iter()
                .any(|problem| problem.contains("differ by 18 over all")),
            "{:?}",
            one_way.problems
        );
        let stranger = with(&|rows| {
            let row = rows
                .iter_mut()
                .find(|row| row.low.to_string() == "000")
                .unwrap();
            row.high = Condition(vec![1, 1, 1]);
        });
        let named = stranger
            .problems
            .iter()
            .any(|problem| problem.contains("has a pair of conditions that is no cell"));
        assert!(named, "{:?}", stranger.problems);
        let group = with(&|rows| {
            let shape = rows
                .iter()
                .find(|row| row.changed == "shape")
                .unwrap()
                .clone();
            let index = rows
                .iter()
                .position(|row| row.changed == "friction")
                .unwrap();
            rows[index] = shape;
        });
        assert!(
            group
                .problems
                .iter()
                .any(|problem| problem.contains("a whole one off its share")),
            "{:?}",
            group.problems
        );
    }
}
