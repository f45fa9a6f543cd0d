//! The whole analysis of a study or a table: what a report is made from.

use std::collections::BTreeMap;
use std::path::Path;

use serde_json::{Value, json};
use thiserror::Error;

use super::behaviour::{self, Behaviour};
use super::design::{Design, DesignError};
use super::model::Model;
use super::noticed::Noticed;
use super::paired::{self, Paired};
use super::randomisation::{Plan, Randomisation};
use super::regression::Regression;
use super::subjects::{LEVELS, PARAMETERS, Subjects};
use super::table::TableError;
use super::{folder, json};

/// Why a study cannot be analysed.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum AnalysisError {
    /// A file cannot be used.
    #[error(transparent)]
    Table(#[from] TableError),
    /// The model does not fit the table.
    #[error(transparent)]
    Design(#[from] DesignError),
    /// The plan of a study cannot be used.
    #[error("{0}")]
    Study(String),
}

/// The analysis of a study.
#[derive(Debug, Clone)]
pub struct Analysis {
    /// The file or folder.
    pub source: String,
    /// The subjects.
    pub subjects: Subjects,
    /// The regression.
    pub regression: Regression,
    /// Who noticed what, where it is known what changed.
    pub noticed: Option<Noticed>,
    /// Randomisation tests, where the model has a design.
    pub randomisation: Option<Randomisation>,
    /// Tests of the differences between the games, where presence was asked after each.
    pub paired: Vec<Paired>,
    /// What recordings say, by condition.
    pub behaviour: Vec<Behaviour>,
}

/// What the subjects of one condition answered.
#[derive(Debug, Clone, PartialEq)]
pub struct Answers {
    /// Index of the changed parameter in [`PARAMETERS`].
    pub change: usize,
    /// Levels of the other parameters, as in "F0 S1"; empty where a table does not say them.
    pub held: String,
    /// Share of high answers of each subject, in the order of the table; not empty.
    pub shares: Vec<f64>,
}

impl Answers {
    /// The mean share.
    pub fn mean(&self) -> f64 {
        self.shares.iter().sum::<f64>() / self.shares.len() as f64
    }
}

impl Analysis {
    /// Reads and analyses a study's folder or a plain table.
    ///
    /// # Errors
    /// When a file cannot be used, by row and column, or the model does not fit it.
    pub fn of(path: &Path, model: &Model, plan: Plan) -> Result<Analysis, AnalysisError> {
        let subjects = Subjects::new(folder::read(path)?)?;
        let regression = Regression::new(Design::new(&subjects, model)?);
        let games = if path.is_dir() {
            behaviour::read(path)?
        } else {
            Vec::new()
        };
        Ok(Analysis {
            source: path.display().to_string(),
            noticed: Noticed::of(&subjects),
            randomisation: Randomisation::of(&regression, plan),
            paired: paired::paired(&subjects),
            behaviour: behaviour::by_condition(&games),
            regression,
            subjects,
        })
    }

    /// How many subjects reported each level of sickness, 1 to 7 (Table 3); empty where it was not asked.
    pub fn sickness(&self) -> Vec<usize> {
        if !self.subjects.has("sick") {
            return Vec::new();
        }
        let mut levels = vec![0; 7];
        for row in 0..self.subjects.list.len() {
            // Levels were checked when the table was read.
            if let Ok(Some(level)) = self.subjects.value(row, "sick") {
                levels[level as usize - 1] += 1;
            }
        }
        levels
    }

    /// Share of high answers of each subject, by condition; where a table does not say the levels, by changed parameter.
    pub fn answers(&self) -> Vec<Answers> {
        let mut conditions: BTreeMap<(usize, String), Vec<f64>> = BTreeMap::new();
        for subject in &self.subjects.list {
            if let (Some(change), Some((y, n))) = (subject.change, subject.answers)
                && n > 0.0
            {
                let others = (0..LEVELS.len()).filter(|&parameter| parameter != change);
                let held = others.filter_map(|parameter| {
                    let level = subject.levels[parameter]?;
                    Some(format!("{}{level}", LEVELS[parameter]))
                });
                let held = held.collect::<Vec<_>>().join(" ");
                conditions.entry((change, held)).or_default().push(y / n);
            }
        }
        let answers = conditions
            .into_iter()
            .map(|((change, held), shares)| Answers {
                change,
                held,
                shares,
            });
        answers.collect()
    }

    /// Every number.
    pub fn json(&self) -> Value {
        let mut value = json::regression(&self.regression);
        let sickness = self.sickness();
        let all: usize = sickness.iter().sum();
        let percent = sickness
            .iter()
            .map(|&count| 100.0 * count as f64 / all.max(1) as f64);
        let answers = self.answers().into_iter().map(|answers| {
            json!({
                "changed": PARAMETERS[answers.change],
                "held": answers.held,
                "subjects": answers.shares.len(),
                "mean_share_of_high_answers": answers.mean(),
            })
        });
        value["source"] = json!(self.source);
        value["table3_sickness"] =
            json!({"counts": sickness, "percent": percent.collect::<Vec<_>>()});
        value["table4_noticed"] = self.noticed.as_ref().map_or(Value::Null, Noticed::json);
        value["answers_by_condition"] = answers.collect();
        value["randomisation"] = self
            .randomisation
            .as_ref()
            .map_or(Value::Null, Randomisation::json);
        value["paired"] = paired::json(&self.paired);
        value["behaviour"] = behaviour::json(&self.behaviour);
        value
    }
}
