//! Designs: the paper's, three beyond it, and any other from a file.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};

use super::{Cell, Condition, Design, Factor, Levels, Value};
use crate::files::{self, FileError};
use crate::questionnaire::line_of;
use crate::staircase::StaircasePlan;

/// Most participants in a block: more is a slip of the pen.
const LARGEST_BLOCK: u32 = 10_000;

/// Where a design comes from.
#[derive(Debug, Clone, PartialEq)]
pub enum Scheme {
    /// Table 2: one factor changes, weight 2 where the other two levels agree, 1 where they differ; blocks of 18.
    Table2,
    /// The same twelve cells with equal weights; blocks of 12.
    Balanced,
    /// Full factorial: all 28 pairs of the eight conditions, so that one, two or three factors change; blocks of 28.
    Full,
    /// The twelve cells with elasticity and friction drawn from their whole range; blocks of 12.
    Continuous,
    /// Factors and cells from a TOML file.
    File(PathBuf),
    /// Pairs of throws instead of games: the two ends of what a staircase tries are one cell; blocks of 1.
    Staircase(StaircasePlan),
}

/// Why a design cannot be used.
#[derive(Debug, thiserror::Error)]
pub enum SchemeError {
    /// The file cannot be read.
    #[error(transparent)]
    File(#[from] FileError),
    /// It is not TOML of the right form.
    #[error("{} is no scheme: line {line}: {message}; docs/study.md shows the form", path.display())]
    Syntax {
        /// Which file.
        path: PathBuf,
        /// Line, from 1.
        line: usize,
        /// What the reader of TOML says.
        message: String,
    },
    /// What it says is no design.
    #[error("{} is no scheme: {problem}", path.display())]
    Content {
        /// Which file.
        path: PathBuf,
        /// What is wrong and what to do.
        problem: String,
    },
}

/// A factor as files have it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct FactorEntry {
    name: String,
    letter: char,
    key: String,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    levels: Option<Vec<Value>>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    range: Option<[f64; 2]>,
}

/// A cell as files have it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct CellEntry {
    from: String,
    to: String,
    weight: u32,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Document {
    factor: Vec<FactorEntry>,
    cell: Vec<CellEntry>,
}

impl Scheme {
    /// The scheme of this name, or else the file.
    pub fn named(name: &str) -> Scheme {
        match name {
            "table2" => Scheme::Table2,
            "balanced" => Scheme::Balanced,
            "full" => Scheme::Full,
            "continuous" => Scheme::Continuous,
            path => Scheme::File(PathBuf::from(path)),
        }
    }

    /// The name that the plan keeps: `file` for one from a file.
    pub fn name(&self) -> &'static str {
        match self {
            Scheme::Table2 => "table2",
            Scheme::Balanced => "balanced",
            Scheme::Full => "full",
            Scheme::Continuous => "continuous",
            Scheme::File(_) => "file",
            Scheme::Staircase(_) => "staircase",
        }
    }

    /// Its design.
    ///
    /// # Errors
    /// When the file cannot be read or has no design.
    pub fn design(&self) -> Result<Design, SchemeError> {
        Ok(match self {
            Scheme::Table2 => Design {
                factors: table_1(),
                // Weight 2 where the two levels that stay agree.
                cells: edges(|low, changed| {
                    let kept: Vec<u8> = (0..3).filter(|f| *f != changed).map(|f| low[f]).collect();
                    if kept[0] == kept[1] { 2 } else { 1 }
                }),
            },
            Scheme::Balanced => Design {
                factors: table_1(),
                cells: edges(|_, _| 1),
            },
            Scheme::Full => Design {
                factors: table_1(),
                cells: all_pairs(),
            },
            Scheme::Continuous => Design {
                factors: whole_range(),
                cells: edges(|_, _| 1),
            },
            Scheme::File(path) => read(path)?,
            Scheme::Staircase(plan) => ends(plan),
        })
    }
}

/// Table 1 of the paper.
fn table_1() -> Vec<Factor> {
    let number = |levels: [f64; 2]| Levels::Fixed(levels.map(Value::Number).to_vec());
    let word =
        |levels: [&str; 2]| Levels::Fixed(levels.map(|l| Value::Text(l.to_owned())).to_vec());
    vec![
        factor('E', "elasticity", "objects.elasticity", number([1.0, 0.7])),
        factor('F', "friction", "objects.friction_rate", number([0.0, 0.7])),
        factor('S', "shape", "objects.shape", word(["ellipsoid", "true"])),
    ]
}

/// The paper's future work, 'a wider range of values': all that Eq. (9) knows, in the directions of Table 1.
fn whole_range() -> Vec<Factor> {
    let mut factors = table_1();
    factors[0].levels = Levels::Range { from: 1.0, to: 0.0 };
    factors[1].levels = Levels::Range { from: 0.0, to: 1.0 };
    factors
}

/// The standard value against the one that is furthest from it.
fn ends(plan: &StaircasePlan) -> Design {
    let values = [plan.standard, plan.furthest].map(Value::Number);
    let levels = Levels::Fixed(values.to_vec());
    Design {
        factors: vec![factor('D', "difference", &plan.key, levels)],
        cells: vec![Cell {
            low: Condition(vec![0]),
            high: Condition(vec![1]),
            weight: 1,
        }],
    }
}

fn factor(letter: char, name: &str, key: &str, levels: Levels) -> Factor {
    Factor {
        letter,
        name: name.to_owned(),
        key: key.to_owned(),
        levels,
    }
}

/// The twelve edges of the cube, weighted by the lower end's levels and the factor that changes.
fn edges(weight: impl Fn(&[u8], usize) -> u32) -> Vec<Cell> {
    let mut cells = Vec::new();
    for low in cube() {
        for changed in (0..3).filter(|f| low[*f] == 0) {
            let mut high = low.clone();
            high[changed] = 1;
            let weight = weight(&low, changed);
            cells.push(Cell {
                low: Condition(low.clone()),
                high: Condition(high),
                weight,
            });
        }
    }
    cells
}

fn all_pairs() -> Vec<Cell> {
    let conditions = cube();
    let mut cells = Vec::new();
    for (index, low) in conditions.iter().enumerate() {
        for high in &conditions[index + 1..] {
            let (low, high) = (Condition(low.clone()), Condition(high.clone()));
            cells.push(Cell {
                low,
                high,
                weight: 1,
            });
        }
    }
    cells
}

/// The eight conditions of three factors, in the order of their levels.
fn cube() -> Vec<Vec<u8>> {
    (0..8u8)
        .map(|bits| vec![bits >> 2 & 1, bits >> 1 & 1, bits & 1])
        .collect()
}

fn read(path: &Path) -> Result<Design, SchemeError> {
    let text = files::read(path)?;
    let document: Document = toml::from_str(&text).map_err(|error| SchemeError::Syntax {
        path: path.to_path_buf(),
        line: line_of(&text, error.span()),
        message: error.message().trim().replace('\n', " "),
    })?;
    design_of(document.factor, document.cell).map_err(|problem| SchemeError::Content {
        path: path.to_path_buf(),
        problem,
    })
}

/// The design of entries from a file, checked.
pub(super) fn design_of(
    factors: Vec<FactorEntry>,
    cells: Vec<CellEntry>,
) -> Result<Design, String> {
    let factors = factors
        .into_iter()
        .map(FactorEntry::check)
        .collect::<Result<Vec<_>, _>>()?;
    let mut seen = BTreeSet::new();
    for factor in &factors {
        for name in [
            factor.name.clone(),
            factor.key.clone(),
            factor.letter.to_string(),
        ] {
            if !seen.insert(name.clone()) {
                return Err(format!(
                    "two factors share {name:?}: give each its own name, letter and key"
                ));
            }
        }
    }
    let design = Design {
        cells: cells
            .into_iter()
            .map(|cell| cell.check(&factors))
            .collect::<Result<_, _>>()?,
        factors,
    };
    let mut seen = BTreeSet::new();
    for cell in &design.cells {
        if !seen.insert((&cell.low, &cell.high)) {
            return Err(format!(
                "the cell {} to {} is there twice: add the weights",
                cell.low, cell.high
            ));
        }
    }
    match design.block_size() {
        0 => Err("it has no cell: add [[cell]] with from, to and weight".to_owned()),
        size if size > LARGEST_BLOCK => Err(format!(
            "the weights add up to {size}, more than {LARGEST_BLOCK}: divide them"
        )),
        _ => Ok(design),
    }
}

/// A design as entries of a file.
pub(super) fn entries_of(design: &Design) -> (Vec<FactorEntry>, Vec<CellEntry>) {
    let factors = design.factors.iter().map(|factor| {
        let (levels, range) = match &factor.levels {
            Levels::Fixed(values) => (Some(values.clone()), None),
            Levels::Range { from, to } => (None, Some([*from, *to])),
        };
        FactorEntry {
            name: factor.name.clone(),
            letter: factor.letter,
            key: factor.key.clone(),
            levels,
            range,
        }
    });
    let cells = design.cells.iter().map(|cell| CellEntry {
        from: cell.low.to_string(),
        to: cell.high.to_string(),
        weight: cell.weight,
    });
    (factors.collect(), cells.collect())
}

impl FactorEntry {
    fn check(self) -> Result<Factor, String> {
        let name = self.name;
        let plain = |c: char| c.is_ascii_lowercase() || c == '_';
        if name.is_empty() || !name.chars().all(plain) || !self.letter.is_ascii_uppercase() {
            return Err(format!(
                "factor {name:?}: a name has small letters and _, a letter is a capital"
            ));
        }
        let levels = match (self.levels, self.range) {
            (Some(values), None) if (2..=10).contains(&values.len()) => Levels::Fixed(values),
            (None, Some([from, to])) if from.is_finite() && to.is_finite() && from != to => {
                Levels::Range { from, to }
            }
            _ => {
                return Err(format!(
                    "factor {name:?} needs either two to ten `levels` or a `range` of two numbers"
                ));
            }
        };
        Ok(Factor {
            letter: self.letter,
            name,
            key: self.key,
            levels,
        })
    }
}

impl CellEntry {
    fn check(self, factors: &[Factor]) -> Result<Cell, String> {
        let condition = |text: &str| -> Result<Condition, String> {
            let digits: Vec<u8> = text.bytes().map(|byte| byte.wrapping_sub(b'0')).collect();
            let fits = digits.len() == factors.len()
                && digits
                    .iter()
                    .zip(factors)
                    .all(|(digit, factor)| usize::from(*digit) < factor.levels.count());
            if fits {
                Ok(Condition(digits))
            } else {
                Err(format!(
                    "the condition {text:?} of a cell has to have one digit for each factor, below its number of levels"
                ))
            }
        };
        let (from, to) = (condition(&self.from)?, condition(&self.to)?);
        if from == to {
            return Err(format!("the cell {from} to {to} changes nothing"));
        }
        let (low, high) = if from < to { (from, to) } else { (to, from) };
        if self.weight > LARGEST_BLOCK {
            return Err(format!(
                "the weight of the cell {low} to {high} is above {LARGEST_BLOCK}"
            ));
        }
        Ok(Cell {
            low,
            high,
            weight: self.weight,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn schemes_have_the_blocks_that_are_promised() {
        let sizes = [
            ("table2", 12, 18),
            ("balanced", 12, 12),
            ("full", 28, 28),
            ("continuous", 12, 12),
        ];
        for (name, cells, block) in sizes {
            let design = Scheme::named(name).design().unwrap();
            assert_eq!(
                (design.cells.len(), design.block_size()),
                (cells, block),
                "{name}"
            );
            // What a plan keeps is the same design.
            let (factor, cell) = entries_of(&design);
            assert_eq!(design_of(factor, cell).unwrap(), design);
        }
        let full = Scheme::Full.design().unwrap();
        let groups: Vec<usize> = full.groups().iter().map(|(_, cells)| cells.len()).collect();
        // Three single changes, three of two factors, one of all: four cells each.
        assert_eq!(groups, [4; 7]);
    }

    #[test]
    fn file_is_a_design_or_a_sentence() {
        let good = "[[factor]]\nname = \"elasticity\"\nletter = \"E\"\nkey = \"objects.elasticity\"\nlevels = [1.0, 0.85, 0.7]\n\
            [[factor]]\nname = \"oil\"\nletter = \"O\"\nkey = \"oil.middle_factor\"\nrange = [0.0, 1.0]\n\
            [[cell]]\nfrom = \"20\"\nto = \"00\"\nweight = 2\n[[cell]]\nfrom = \"01\"\nto = \"00\"\nweight = 1\n";
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("scheme.toml");
        let design = |text: &str| {
            std::fs::write(&path, text).unwrap();
            Scheme::named(&path.to_string_lossy())
                .design()
                .map_err(|error| error.to_string())
        };
        let read = design(good).unwrap();
        assert_eq!(read.cells[0].low.to_string(), "00");
        assert_eq!(read.groups()[1].0, "oil");
        let cases = [
            ("\"20\"", "\"30\"", "the condition \"30\""),
            ("\"20\"", "\"2\"", "the condition \"2\""),
            ("\"20\"", "\"00\"", "changes nothing"),
            ("\"20\"", "\"01\"", "is there twice"),
            ("[1.0, 0.85, 0.7]", "[1.0]", "two to ten `levels`"),
            ("[0.0, 1.0]", "[1.0, 1.0]", "a `range`"),
            ("\"O\"", "\"E\"", "two factors share \"E\""),
            ("weight = 2", "weigth = 2", "line 14: unknown field"),
            ("weight = 2", "weight = 200000", "is above 10000"),
        ];
        for (from, to, expected) in cases {
            assert!(good.contains(from), "{from}");
            let error = design(&good.replacen(from, to, 1)).unwrap_err();
            assert!(
                error.contains(expected) && error.lines().count() == 1,
                "{error}"
            );
        }
        let error = Scheme::named("nowhere.toml")
            .design()
            .unwrap_err()
            .to_string();
        assert!(error.starts_with("cannot read nowhere.toml"), "{error}");
    }
}
