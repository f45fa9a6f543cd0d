//! What a table says about each subject, checked cell by cell before anything is computed.

use super::table::{Table, TableError};

/// The parameters of the experiment, in the order of the numbers that the column `change` gives them (Table 6).
pub const PARAMETERS: [&str; 3] = ["elasticity", "friction", "shape"];
/// Their columns: base level 0 or 1, 0 where the parameter is the one that changes.
pub const LEVELS: [&str; 3] = ["E", "F", "S"];
/// The presence items of Appendix A.
const ITEMS: [&str; 6] = ["q1", "q2", "q3", "q4", "q5", "q6"];
/// An answer from here on counts as high (§3).
const HIGH: u32 = 6;
/// More answers than a subject can have given.
const MOST_ANSWERS: u32 = 1_000_000;

/// One subject.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Subject {
    /// Name in reports: the column `id`, else the line.
    pub id: String,
    /// Index of the changed parameter in [`PARAMETERS`].
    pub change: Option<usize>,
    /// Base levels of the three parameters.
    pub levels: [Option<f64>; 3],
    /// High answers and answers.
    pub answers: Option<(f64, f64)>,
    /// Whether a difference between the two games was noticed.
    pub noticed: Option<bool>,
    /// Which, in the subject's words.
    pub noticed_what: Option<String>,
    /// Block of the allocation.
    pub block: Option<String>,
}

/// A checked table.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Subjects {
    /// The cells.
    pub table: Table,
    /// What they say, row by row.
    pub list: Vec<Subject>,
}

impl Subjects {
    /// Checks a table.
    ///
    /// # Errors
    /// By row and column, where a cell holds what its column may not, or two cells contradict each other.
    pub fn new(table: Table) -> Result<Subjects, TableError> {
        let mut subjects = Subjects {
            list: Vec::with_capacity(table.rows.len()),
            table,
        };
        let columns = Columns::of(&subjects.table);
        if columns.items.is_empty() && columns.y.is_none() {
            let why = "counts the high answers (with \"n\", the answers), or else q1 to q6";
            return Err(subjects.table.missing("y", why));
        }
        if columns.y.is_some() && columns.n.is_none() && columns.items.is_empty() {
            return Err(subjects
                .table
                .missing("n", "counts the answers that y is out of"));
        }
        for row in 0..subjects.table.rows.len() {
            let subject = columns.subject(&subjects.table, row)?;
            subjects.list.push(subject);
        }
        Ok(subjects)
    }

    /// The value of an explanatory column for a subject; `None` where it is missing.
    ///
    /// # Errors
    /// When there is no such column, or the cell holds neither a number nor a yes or no.
    pub fn value(&self, row: usize, name: &str) -> Result<Option<f64>, TableError> {
        if let Some(level) = LEVELS.iter().position(|level| *level == name) {
            return Ok(self.list[row].levels[level]);
        }
        let column = self.table.needed(&names_of(name), "the model names")?;
        match self.table.cell(row, column) {
            None => Ok(None),
            Some(text) => match super::table::yes_or_no(text) {
                Some(is) => Ok(Some(f64::from(is))),
                None => self.table.number(row, column),
            },
        }
    }

    /// Whether there is an explanatory column of this name.
    pub fn has(&self, name: &str) -> bool {
        let has_level = LEVELS.contains(&name) && self.table.column(&["efs"]).is_some();
        has_level || self.table.column(&names_of(name)).is_some()
    }

    /// Whether the subjects' changed parameters are known.
    pub fn has_change(&self) -> bool {
        self.table.column(&["change", "changed"]).is_some()
    }
}

/// The names under which a column may stand in a file.
fn names_of(name: &str) -> Vec<&str> {
    if name == "vr" {
        vec!["vr", "vr_before"]
    } else {
        vec![name]
    }
}

/// Where the known columns are.
struct Columns {
    id: Option<usize>,
    change: Option<usize>,
    changed: Option<usize>,
    efs: Option<usize>,
    levels: [Option<usize>; 3],
    y: Option<usize>,
    n: Option<usize>,
    items: Vec<usize>,
    sick: Option<usize>,
    vr: Option<usize>,
    noticed: Option<usize>,
    noticed_what: Option<usize>,
    block: Option<usize>,
}

impl Columns {
    fn of(table: &Table) -> Self {
        Columns {
            id: table.column(&["id", "participant_id"]),
            change: table.column(&["change"]),
            changed: table.column(&["changed"]),
            efs: table.column(&["efs"]),
            levels: LEVELS.map(|level| table.column(&[level])),
            y: table.column(&["y", "presence_count"]),
            n: table.column(&["n", "presence_n"]),
            items: ITEMS
                .iter()
                .filter_map(|item| table.column(&[item]))
                .collect(),
            sick: table.column(&["sick"]),
            vr: table.column(&names_of("vr")),
            noticed: table.column(&["noticed"]),
            noticed_what: table.column(&["noticed_what"]),
            block: table.column(&["block"]),
        }
    }

    fn subject(&self, table: &Table, row: usize) -> Result<Subject, TableError> {
        let text =
            |column: Option<usize>| column.and_then(|c| table.cell(row, c)).map(str::to_owned);
        if let Some(column) = self.sick {
            table.whole(row, column, 1, 7)?;
        }
        if let Some(column) = self.vr {
            table.yes_no(row, column)?;
        }
        let change = self.change(table, row)?;
        Ok(Subject {
            id: text(self.id).unwrap_or_else(|| format!("line {}", table.lines[row])),
            change,
            levels: self.levels(table, row, change)?,
            answers: self.answers(table, row)?,
            noticed: self
                .noticed
                .map_or(Ok(None), |column| table.yes_no(row, column))?,
            noticed_what: text(self.noticed_what),
            block: text(self.block),
        })
    }

    fn change(&self, table: &Table, row: usize) -> Result<Option<usize>, TableError> {
        let number = self
            .change
            .map_or(Ok(None), |column| table.whole(row, column, 1, 3))?;
        let number = number.map(|number| number as usize - 1);
        let Some((column, word)) = self.changed.and_then(|c| Some((c, table.cell(row, c)?))) else {
            return Ok(number);
        };
        let named = PARAMETERS.iter().position(|name| *name == word);
        let named =
            named.ok_or_else(|| table.refuse(row, column, "elasticity, friction or shape"))?;
        match number {
            Some(number) if number != named => {
                let problem = format!("change is {}, but changed is {word}", number + 1);
                Err(table.contradiction(row, problem))
            }
            _ => Ok(Some(named)),
        }
    }

    fn levels(
        &self,
        table: &Table,
        row: usize,
        change: Option<usize>,
    ) -> Result<[Option<f64>; 3], TableError> {
        let mut levels = [None; 3];
        if let Some((column, text)) = self.efs.and_then(|c| Some((c, table.cell(row, c)?))) {
            let digits: Vec<f64> = text
                .chars()
                .filter_map(|c| c.to_digit(2))
                .map(f64::from)
                .collect();
            if digits.len() != 3 || text.len() != 3 {
                return Err(table.refuse(
                    row,
                    column,
                    "three digits 0 or 1, the levels of E, F and S",
                ));
            }
            levels = [0, 1, 2].map(|i| Some(digits[i]));
        }
        for (i, column) in self.levels.iter().enumerate() {
            let Some(column) = *column else { continue };
            let Some(level) = table.whole(row, column, 0, 1)?.map(f64::from) else {
                continue;
            };
            if levels[i].is_some_and(|other| other != level) {
                return Err(table.contradiction(
                    row,
                    format!("{} is {level}, but efs says otherwise", LEVELS[i]),
                ));
            }
            levels[i] = Some(level);
        }
        match change {
            Some(i) if levels[i].is_some_and(|level| level != 0.0) => {
                let (parameter, level) = (PARAMETERS[i], LEVELS[i]);
                let problem = format!(
                    "{parameter} is what changes, so its base level {level} is listed as 0, not 1"
                );
                Err(table.contradiction(row, problem))
            }
            _ => Ok(levels),
        }
    }

    fn answers(&self, table: &Table, row: usize) -> Result<Option<(f64, f64)>, TableError> {
        let mut counted = None;
        if !self.items.is_empty() {
            let (mut high, mut asked) = (0, 0);
            for &column in &self.items {
                if let Some(answer) = table.whole(row, column, 1, 7)? {
                    asked += 1;
                    high += u32::from(answer >= HIGH);
                }
            }
            counted = Some((high, asked));
        }
        let n = self
            .n
            .map_or(Ok(None), |column| table.whole(row, column, 0, MOST_ANSWERS))?;
        let n = n.or(counted.map(|(_, asked)| asked));
        let y = match self.y {
            Some(column) => table.whole(row, column, 0, n.unwrap_or(MOST_ANSWERS))?,
            None => counted.map(|(high, _)| high),
        };
        if let (Some((high, asked)), Some(y), Some(n)) = (counted, y, n)
            && (high, asked) != (y, n)
        {
            let problem =
                format!("y = {y} of n = {n}, but {high} of {asked} answered items are 6 or 7");
            return Err(table.contradiction(row, problem));
        }
        Ok(y.zip(n).map(|(y, n)| (f64::from(y), f64::from(n))))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn problem(text: &str) -> String {
        Subjects::new(Table::parse("f.csv", text).unwrap())
            .unwrap_err()
            .to_string()
    }

    #[test]
    fn new_counts_items_and_leaves_out_what_is_missing() {
        let text = "id,q1,q2,q3,q4,q5,q6,noticed\na,6,7,,5,n/a,1,yes\nb,,,,,,,0\n";
        let subjects = Subjects::new(Table::parse("f.csv", text).unwrap()).unwrap();
        assert_eq!(subjects.list[0].answers, Some((2.0, 4.0)));
        assert_eq!(subjects.list[1].answers, Some((0.0, 0.0)));
        assert_eq!(subjects.list[1].noticed, Some(false));
    }

    #[test]
    fn new_refuses_contradictions() {
        assert_eq!(
            problem("y,n\n5,4\n"),
            "f.csv, line 2, column y: \"5\" is not a whole number from 0 to 4"
        );
        assert!(problem("y,n,q1\n1,1,3\n").contains("y = 1 of n = 1, but 0 of 1"));
        assert!(
            problem("y,n,change,changed\n1,6,1,shape\n")
                .contains("change is 1, but changed is shape")
        );
        assert!(problem("y,n,change,F\n1,6,2,1\n").contains("friction is what changes"));
        assert!(problem("y,n,efs\n1,6,012\n").contains("column efs"));
        assert!(problem("y,n,efs,E\n1,6,011,1\n").contains("E is 1, but efs says otherwise"));
        assert!(problem("id\na\n").contains("no column \"y\""));
        assert!(problem("y\n3\n").contains("no column \"n\""));
    }
}
