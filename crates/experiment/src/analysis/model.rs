//! Models as a person writes them: terms joined by `+`.
//!
//! | term | columns |
//! |---|---|
//! | `1` | a constant, `constant` |
//! | `change` | an indicator for each changed parameter, `change1` to `change3`, which stand in place of a constant |
//! | `F` | the column of that name: a number, or yes and no |
//! | `F:change` or `change:F` | the column where each parameter changes: `change1_F`, `change3_F`. E, F and S have none where they are what changes |
//! | `sick:vr` | the product of two columns, `sick_vr` |
//!
//! `constant`, `elasticity`, `friction`, `shape`, `sickness`, `vr_before` and `vrbefore` are other words for `1`, `E`, `F`, `S`, `sick`, `vr`.

use std::fmt;
use std::str::FromStr;

use thiserror::Error;

use super::subjects::LEVELS;

/// The paper's model: ten columns, no constant (Table 6).
pub const PAPER: &str = "change + F + sick + vr + S:change + E:change";

/// Why a model cannot be used.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum ModelError {
    /// No term between two plus signs.
    #[error("the model \"{0}\" has an empty term; write terms joined by +, as in \"{PAPER}\"")]
    Empty(String),
    /// A term that is no term.
    #[error(
        "the model's term \"{0}\" is neither a column, nor \"change\", nor \"1\", nor two of them joined by a colon"
    )]
    Term(String),
    /// A term twice.
    #[error("the model has the term \"{0}\" twice")]
    Twice(String),
}

/// One term.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Term {
    /// `1`
    Constant,
    /// `change`
    Change,
    /// A column.
    Column(String),
    /// A column where each parameter changes.
    ByChange(String),
    /// The product of two columns.
    Product(String, String),
}

impl Term {
    /// The term's name among the groups that are deleted, as in `change.S`.
    pub fn group(&self) -> String {
        match self {
            Term::Constant => "constant".to_owned(),
            Term::Change => "change".to_owned(),
            Term::Column(name) => name.clone(),
            Term::ByChange(name) => format!("change.{name}"),
            Term::Product(a, b) => format!("{a}.{b}"),
        }
    }

    /// Whether the term has to do with the base level of a parameter.
    pub fn is_physics(&self) -> bool {
        let is_level = |name: &String| LEVELS.contains(&name.as_str());
        match self {
            Term::Constant | Term::Change => false,
            Term::Column(name) | Term::ByChange(name) => is_level(name),
            Term::Product(a, b) => is_level(a) || is_level(b),
        }
    }

    /// Whether the term belongs to the place in the design, at least in part.
    pub fn is_design(&self) -> bool {
        matches!(self, Term::Change | Term::ByChange(_)) || self.is_physics()
    }

    /// The names of the table's columns that it takes.
    pub fn columns(&self) -> Vec<&str> {
        match self {
            Term::Constant | Term::Change => Vec::new(),
            Term::Column(name) | Term::ByChange(name) => vec![name],
            Term::Product(a, b) => vec![a, b],
        }
    }
}

impl fmt::Display for Term {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Term::Constant => write!(f, "1"),
            Term::Change => write!(f, "change"),
            Term::Column(name) => write!(f, "{name}"),
            Term::ByChange(name) => write!(f, "{name}:change"),
            Term::Product(a, b) => write!(f, "{a}:{b}"),
        }
    }
}

/// A model.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Model {
    /// Its terms, in the order of the columns.
    pub terms: Vec<Term>,
}

impl Model {
    /// The paper's model.
    pub fn paper() -> Model {
        PAPER.parse().expect("a constant of this file")
    }

    /// Whether it is the paper's, in any order.
    pub fn is_paper(&self) -> bool {
        let paper = Model::paper();
        self.terms.len() == paper.terms.len()
            && paper.terms.iter().all(|term| self.terms.contains(term))
    }
}

impl fmt::Display for Model {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let terms: Vec<String> = self.terms.iter().map(Term::to_string).collect();
        write!(f, "{}", terms.join(" + "))
    }
}

impl FromStr for Model {
    type Err = ModelError;

    fn from_str(text: &str) -> Result<Model, ModelError> {
        let mut model = Model { terms: Vec::new() };
        for word in text.split('+').map(str::trim) {
            if word.is_empty() {
                return Err(ModelError::Empty(text.trim().to_owned()));
            }
            let term = term(word)?;
            if model.terms.contains(&term) {
                return Err(ModelError::Twice(word.to_owned()));
            }
            model.terms.push(term);
        }
        Ok(model)
    }
}

fn term(word: &str) -> Result<Term, ModelError> {
    let parts: Vec<&str> = word.split(':').map(|part| canonical(part.trim())).collect();
    let is_name = |part: &&str| {
        !part.is_empty()
            && part
                .chars()
                .all(|c| c.is_alphanumeric() || "_.-".contains(c))
    };
    if !parts.iter().all(is_name) {
        return Err(ModelError::Term(word.to_owned()));
    }
    match parts[..] {
        ["1"] => Ok(Term::Constant),
        ["change"] => Ok(Term::Change),
        [name] => Ok(Term::Column(name.to_owned())),
        ["change" | "1", "change" | "1"] | ["1", _] | [_, "1"] => {
            Err(ModelError::Term(word.to_owned()))
        }
        ["change", name] | [name, "change"] => Ok(Term::ByChange(name.to_owned())),
        [a, b] => {
            let (a, b) = if a <= b { (a, b) } else { (b, a) };
            Ok(Term::Product(a.to_owned(), b.to_owned()))
        }
        _ => Err(ModelError::Term(word.to_owned())),
    }
}

/// The one name of what has several.
fn canonical(name: &str) -> &str {
    match name {
        "constant" => "1",
        "changed" => "change",
        "elasticity" => "E",
        "friction" => "F",
        "shape" => "S",
        "sickness" => "sick",
        "vr_before" | "vrbefore" => "vr",
        other => other,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn from_str_knows_orders_and_other_words() {
        let model: Model = "change + friction + sickness + vr_before + change:S + E:change"
            .parse()
            .unwrap();
        assert!(model.is_paper());
        assert_eq!(model.to_string(), PAPER);
        assert_eq!("vr:sick".parse::<Model>(), "sick:vr".parse::<Model>());
    }

    #[test]
    fn from_str_refuses_what_is_no_model() {
        let problem = |text: &str| text.parse::<Model>().unwrap_err();
        assert_eq!(
            problem("change + "),
            ModelError::Empty("change +".to_owned())
        );
        assert_eq!(
            problem("F + friction"),
            ModelError::Twice("friction".to_owned())
        );
        for text in ["a:b:c", "change:change", "F - 1", "1:F", "log(sick)"] {
            assert!(matches!(problem(text), ModelError::Term(_)), "{text}");
        }
    }
}
