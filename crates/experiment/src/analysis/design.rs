//! A model applied to subjects: the columns, the rows that can be used, and the groups that are deleted together.

use thiserror::Error;

use super::model::{Model, Term};
use super::rows::Rows;
use super::subjects::{LEVELS, PARAMETERS, Subjects};
use super::table::TableError;

/// Why a model cannot be applied to a table.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum DesignError {
    /// The table lacks something or holds what it may not.
    #[error(transparent)]
    Table(#[from] TableError),
    /// No subject has all that the model needs.
    #[error(
        "{table}: none of the {subjects} subjects has all that the model \"{model}\" needs; {first}"
    )]
    Nobody {
        /// The table's name.
        table: String,
        /// How many rows it has.
        subjects: usize,
        /// The model.
        model: String,
        /// What is the matter with the first.
        first: String,
    },
}

/// A column of the design: its value is the product of what belongs to the place and what belongs to the subject there.
#[derive(Debug, Clone, PartialEq)]
pub struct Column {
    /// Its name, as in `change1_S`.
    pub name: String,
    /// The part that follows from the allocation, row by row.
    pub place: Vec<f64>,
    /// The part that a subject brings along, row by row.
    pub person: Vec<f64>,
}

/// Columns that come from one term.
#[derive(Debug, Clone, PartialEq)]
pub struct Group {
    /// The term.
    pub term: Term,
    /// Indices of its columns.
    pub columns: Vec<usize>,
}

/// A row that is left out, and why.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Excluded {
    /// The subject.
    pub id: String,
    /// What is missing.
    pub reason: String,
}

/// A model applied to subjects.
#[derive(Debug, Clone, PartialEq)]
pub struct Design {
    /// The model.
    pub model: Model,
    /// Its columns.
    pub columns: Vec<Column>,
    /// The columns of each term.
    pub groups: Vec<Group>,
    /// Indices of the subjects that are used.
    pub used: Vec<usize>,
    /// The subjects that are not.
    pub excluded: Vec<Excluded>,
    /// High answers of each row that is used.
    pub high: Vec<f64>,
    /// Answers of each row that is used.
    pub asked: Vec<f64>,
    /// Block of the allocation of each row that is used; all the same where the table has none.
    pub blocks: Vec<Option<String>>,
}

impl Design {
    /// Applies `model` to `subjects`.
    ///
    /// # Errors
    /// When the table has no such column, a cell of it is no number, or no row is complete.
    pub fn new(subjects: &Subjects, model: &Model) -> Result<Design, DesignError> {
        let takes_change = model
            .terms
            .iter()
            .any(|term| matches!(term, Term::Change | Term::ByChange(_)));
        if takes_change && !subjects.has_change() {
            let why =
                "says which parameter changed (1 elasticity, 2 friction, 3 shape); or give --model";
            return Err(subjects.table.missing("change", why).into());
        }
        let names: Vec<&str> = model.terms.iter().flat_map(Term::columns).collect();
        for name in &names {
            if !subjects.has(name) {
                return Err(subjects.table.missing(name, "the model names").into());
            }
        }
        let mut design = Design::empty(model);
        for row in 0..subjects.list.len() {
            match lacks(subjects, row, &names, takes_change)? {
                Some(reason) => {
                    design.excluded.push(Excluded {
                        id: subjects.list[row].id.clone(),
                        reason,
                    });
                }
                None => design.used.push(row),
            }
        }
        if let (true, Some(first)) = (design.used.is_empty(), design.excluded.first()) {
            return Err(DesignError::Nobody {
                table: subjects.table.name.clone(),
                subjects: subjects.list.len(),
                model: model.to_string(),
                first: format!("of {}, {}", first.id, first.reason),
            });
        }
        let answers = design
            .used
            .iter()
            .filter_map(|&row| subjects.list[row].answers);
        (design.high, design.asked) = answers.unzip();
        let blocks = design
            .used
            .iter()
            .map(|&row| subjects.list[row].block.clone());
        design.blocks = blocks.collect();
        design.fill(subjects)?;
        Ok(design)
    }

    fn empty(model: &Model) -> Design {
        Design {
            model: model.clone(),
            columns: Vec::new(),
            groups: Vec::new(),
            used: Vec::new(),
            excluded: Vec::new(),
            high: Vec::new(),
            asked: Vec::new(),
            blocks: Vec::new(),
        }
    }

    fn fill(&mut self, subjects: &Subjects) -> Result<(), DesignError> {
        let many = self.used.len();
        let ones = vec![1.0; many];
        for term in self.model.terms.clone() {
            let first = self.columns.len();
            match &term {
                Term::Constant => self.push("constant".to_owned(), ones.clone(), ones.clone()),
                Term::Change => {
                    for i in 0..PARAMETERS.len() {
                        self.push(
                            format!("change{}", i + 1),
                            self.indicator(subjects, i),
                            ones.clone(),
                        );
                    }
                }
                Term::Column(name) => {
                    let (place, person) = self.parts(subjects, name)?;
                    self.push(name.clone(), place, person);
                }
                Term::ByChange(name) => {
                    let (place, person) = self.parts(subjects, name)?;
                    for i in (0..PARAMETERS.len()).filter(|&i| LEVELS[i] != name) {
                        let place = product(&place, &self.indicator(subjects, i));
                        self.push(format!("change{}_{name}", i + 1), place, person.clone());
                    }
                }
                Term::Product(a, b) => {
                    let ((place_a, person_a), (place_b, person_b)) =
                        (self.parts(subjects, a)?, self.parts(subjects, b)?);
                    self.push(
                        format!("{a}_{b}"),
                        product(&place_a, &place_b),
                        product(&person_a, &person_b),
                    );
                }
            }
            self.groups.push(Group {
                term,
                columns: (first..self.columns.len()).collect(),
            });
        }
        Ok(())
    }

    fn push(&mut self, name: String, place: Vec<f64>, person: Vec<f64>) {
        self.columns.push(Column {
            name,
            place,
            person,
        });
    }

    /// What of a table's column belongs to the place, and what to the person.
    fn parts(&self, subjects: &Subjects, name: &str) -> Result<(Vec<f64>, Vec<f64>), DesignError> {
        let values: Result<Vec<f64>, TableError> = self
            .used
            .iter()
            .map(|&row| Ok(subjects.value(row, name)?.unwrap_or(f64::NAN)))
            .collect();
        let (values, ones) = (values?, vec![1.0; self.used.len()]);
        Ok(if LEVELS.contains(&name) {
            (values, ones)
        } else {
            (ones, values)
        })
    }

    fn indicator(&self, subjects: &Subjects, parameter: usize) -> Vec<f64> {
        let is = |&row: &usize| f64::from(subjects.list[row].change == Some(parameter));
        self.used.iter().map(is).collect()
    }

    /// The rows of the regression.
    pub fn rows(&self) -> Rows {
        let own: Vec<usize> = (0..self.used.len()).collect();
        self.allocated(&own)
    }

    /// The rows if the person of row `who[i]` had been at the place of row i.
    pub fn allocated(&self, who: &[usize]) -> Rows {
        let mut rows = Rows {
            columns: self.columns.len(),
            ..Rows::default()
        };
        rows.x.reserve(who.len() * self.columns.len());
        for (place, &person) in who.iter().enumerate() {
            rows.x.extend(
                self.columns
                    .iter()
                    .map(|column| column.place[place] * column.person[person]),
            );
        }
        rows.high = who.iter().map(|&person| self.high[person]).collect();
        rows.asked = who.iter().map(|&person| self.asked[person]).collect();
        rows
    }

    /// Names of these columns.
    pub fn names(&self, columns: &[usize]) -> Vec<String> {
        columns
            .iter()
            .map(|&j| self.columns[j].name.clone())
            .collect()
    }
}

fn product(a: &[f64], b: &[f64]) -> Vec<f64> {
    a.iter().zip(b).map(|(a, b)| a * b).collect()
}

/// What a subject lacks for the model, in words.
fn lacks(
    subjects: &Subjects,
    row: usize,
    names: &[&str],
    takes_change: bool,
) -> Result<Option<String>, TableError> {
    let subject = &subjects.list[row];
    match subject.answers {
        None => return Ok(Some("the answers are missing".to_owned())),
        Some((_, 0.0)) => {
            return Ok(Some("no presence item was answered".to_owned()));
        }
        Some(_) => {}
    }
    if takes_change && subject.change.is_none() {
        return Ok(Some("the changed parameter is missing".to_owned()));
    }
    for name in names {
        if subjects.value(row, name)?.is_none() {
            return Ok(Some(format!("{name} is missing")));
        }
    }
    Ok(None)
}
