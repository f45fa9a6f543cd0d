//! Who plays what: a design of conditions and how often each pair of them is met, and the allocation of it to slots.
//!
//! A **condition** gives each factor a level. A **cell** is a pair of conditions, one for each game; in the paper's cells
//! exactly one factor differs (Table 2: the twelve edges of the cube of E, F and S). A **slot** is one participant's place in the
//! plan: a cell and one of four **arrangements**, the cell's first condition first or second times Red or Blue first.

mod allocate;
mod scheme;
mod study_file;
mod table;
mod verify;

use std::fmt;

use serde::{Deserialize, Serialize};

pub use allocate::allocate;
pub use scheme::{Scheme, SchemeError};
pub use study_file::{About, Guidance, Plan, PlanError, SCHEMA, SessionRules};
pub use table::{TableError, allocation_csv, parse_allocation};
pub use verify::{Balance, PAPER_TABLE_2, balance};

/// A button of the desk, and the only name a condition has outside the plan.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
pub enum Button {
    /// The red one.
    Red,
    /// The blue one.
    Blue,
}

impl Button {
    /// The other one.
    #[must_use]
    pub fn other(self) -> Button {
        match self {
            Button::Red => Button::Blue,
            Button::Blue => Button::Red,
        }
    }
}

impl fmt::Display for Button {
    fn fmt(&self, formatter: &mut fmt::Formatter) -> fmt::Result {
        formatter.write_str(match self {
            Button::Red => "Red",
            Button::Blue => "Blue",
        })
    }
}

/// In which order a cell's two conditions are met, and under which buttons.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub struct Arrangement {
    /// Whether the condition with the lower levels is game one: `0-first`.
    pub zero_first: bool,
    /// Button of game one.
    pub first_button: Button,
}

impl Arrangement {
    /// All four.
    pub const ALL: [Arrangement; 4] = [
        Arrangement::new(true, Button::Red),
        Arrangement::new(true, Button::Blue),
        Arrangement::new(false, Button::Red),
        Arrangement::new(false, Button::Blue),
    ];

    const fn new(zero_first: bool, first_button: Button) -> Self {
        Arrangement {
            zero_first,
            first_button,
        }
    }

    /// `0-first` or `1-first`.
    pub fn order(self) -> &'static str {
        if self.zero_first {
            "0-first"
        } else {
            "1-first"
        }
    }

    /// Whether the Red button means the condition with the higher levels.
    pub fn red_is_high(self) -> bool {
        self.zero_first == (self.first_button == Button::Blue)
    }
}

/// The level of each factor, from 0, in the order of the design's factors.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Condition(pub Vec<u8>);

impl fmt::Display for Condition {
    fn fmt(&self, formatter: &mut fmt::Formatter) -> fmt::Result {
        self.0
            .iter()
            .try_for_each(|level| write!(formatter, "{level}"))
    }
}

/// What a configuration key is set to.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(untagged)]
pub enum Value {
    /// A number, in the key's unit.
    Number(f64),
    /// A word.
    Text(String),
}

impl fmt::Display for Value {
    /// As TOML: words in quotes, numbers with a point.
    fn fmt(&self, formatter: &mut fmt::Formatter) -> fmt::Result {
        match self {
            Value::Number(number) => write!(formatter, "{number:?}"),
            Value::Text(word) => write!(formatter, "{word:?}"),
        }
    }
}

/// A parameter that the experiment varies.
#[derive(Debug, Clone, PartialEq)]
pub struct Factor {
    /// Its letter in `efs`.
    pub letter: char,
    /// Its name in the column `changed`.
    pub name: String,
    /// The program's configuration key.
    pub key: String,
    /// What its levels mean.
    pub levels: Levels,
}

/// What the levels of a factor mean.
#[derive(Debug, Clone, PartialEq)]
pub enum Levels {
    /// One value for each level, two to ten of them.
    Fixed(Vec<Value>),
    /// Two levels without a value of their own: a slot's level 0 is drawn from the half of the range at `from`, level 1 from
    /// the half at `to`, spread evenly over the slots.
    Range {
        /// The end of level 0.
        from: f64,
        /// The end of level 1.
        to: f64,
    },
}

impl Levels {
    /// How many levels there are.
    pub fn count(&self) -> usize {
        match self {
            Levels::Fixed(values) => values.len(),
            Levels::Range { .. } => 2,
        }
    }
}

/// A pair of conditions and how many participants of a block meet it.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Cell {
    /// The condition that comes first by its levels: the paper's `EFS`.
    pub low: Condition,
    /// The other.
    pub high: Condition,
    /// Participants of a block.
    pub weight: u32,
}

/// Factors and cells, checked: see [`Scheme`].
#[derive(Debug, Clone, PartialEq)]
pub struct Design {
    /// The factors in the order of `efs`.
    pub factors: Vec<Factor>,
    /// The cells.
    pub cells: Vec<Cell>,
}

impl Design {
    /// Names of the factors in which a cell's conditions differ, joined by `+`.
    pub fn changed(&self, low: &Condition, high: &Condition) -> String {
        let levels = low.0.iter().zip(&high.0);
        let differing = self.factors.iter().zip(levels).filter(|(_, (a, b))| a != b);
        let names: Vec<&str> = differing.map(|(factor, _)| factor.name.as_str()).collect();
        names.join("+")
    }

    /// Participants in a whole block: 18 for Table 2.
    pub fn block_size(&self) -> u32 {
        self.cells.iter().map(|cell| cell.weight).sum()
    }

    /// The cells by what changes, in the order in which they first appear.
    pub fn groups(&self) -> Vec<(String, Vec<usize>)> {
        let mut groups: Vec<(String, Vec<usize>)> = Vec::new();
        for (index, cell) in self.cells.iter().enumerate() {
            let changed = self.changed(&cell.low, &cell.high);
            match groups.iter_mut().find(|(name, _)| *name == changed) {
                Some((_, cells)) => cells.push(index),
                None => groups.push((changed, vec![index])),
            }
        }
        groups
    }

    /// What a condition sets: configuration keys and their values; of a range the end that the level is drawn near.
    pub fn settings(&self, condition: &Condition) -> Vec<(&str, Value)> {
        let levels = self.factors.iter().zip(&condition.0);
        let set = levels.filter_map(|(factor, level)| {
            let value = match &factor.levels {
                Levels::Fixed(values) => values.get(usize::from(*level))?.clone(),
                Levels::Range { from, to } => Value::Number(if *level == 0 { *from } else { *to }),
            };
            Some((factor.key.as_str(), value))
        });
        set.collect()
    }

    /// Whether some factor's values are drawn slot by slot.
    pub fn is_continuous(&self) -> bool {
        let drawn = |factor: &Factor| matches!(factor.levels, Levels::Range { .. });
        self.factors.iter().any(drawn)
    }
}

/// One participant's place in the plan.
#[derive(Debug, Clone, PartialEq)]
pub struct Row {
    /// Number of the slot, from 1.
    pub slot: u32,
    /// Number of the block, from 1.
    pub block: u32,
    /// The cell's lower condition: the paper's `EFS`.
    pub low: Condition,
    /// The cell's other condition.
    pub high: Condition,
    /// The factors that differ.
    pub changed: String,
    /// Order and buttons.
    pub arrangement: Arrangement,
    /// The value of each factor in the lower condition.
    pub low_values: Vec<Value>,
    /// The same in the other condition.
    pub high_values: Vec<Value>,
}

impl Row {
    /// Button of game 1 or 2.
    pub fn button(&self, game: u8) -> Button {
        let first = self.arrangement.first_button;
        if game == 1 { first } else { first.other() }
    }

    /// What a button means.
    pub fn condition(&self, button: Button) -> &Condition {
        if self.is_high(button) {
            &self.high
        } else {
            &self.low
        }
    }

    /// The value of each factor under a button.
    pub fn values(&self, button: Button) -> &[Value] {
        if self.is_high(button) {
            &self.high_values
        } else {
            &self.low_values
        }
    }

    /// What a button sets: configuration keys and their values.
    pub fn settings<'a>(&'a self, design: &'a Design, button: Button) -> Vec<(&'a str, &'a Value)> {
        let keys = design.factors.iter().map(|factor| factor.key.as_str());
        keys.zip(self.values(button)).collect()
    }

    fn is_high(&self, button: Button) -> bool {
        (button == Button::Red) == self.arrangement.red_is_high()
    }
}

#[cfg(test)]
pub(crate) use study_file::tests::about as about_for_tests;
