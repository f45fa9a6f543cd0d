//! What a throw is repeated under: the eight cells of Table 1, Red and Blue, or a file's conditions.

use std::path::Path;

use anyhow::{Context, Result, anyhow, bail};
use game::{Conditions, Config, Game, GameError, Layer};
use serde::Deserialize;

use super::thrown::Thrown;
use crate::args::{CompareArguments, unusable};

/// Most conditions side by side.
const MOST: usize = 8;

/// A condition with its settings.
#[derive(Clone, Debug)]
pub struct Condition {
    /// Its name: three digits E, F, S for a cell of Table 1.
    pub name: String,
    /// All settings.
    pub config: Config,
}

/// The file of Tables 1 and 4.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Table1 {
    /// E, F, S, in this order.
    #[serde(rename = "factor")]
    pub factors: [Factor; 3],
}

/// What the experiment changed, and who noticed.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Factor {
    /// Its name.
    pub name: String,
    /// Key of the setting.
    key: String,
    /// Values at level 0 and at level 1.
    levels: [String; 2],
    /// Subjects who noticed the change, Table 4.
    pub noticed: u32,
    /// Subjects who met the change.
    pub subjects: u32,
}

/// A file of conditions.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct File {
    condition: Vec<Named>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Named {
    name: String,
    set: Vec<String>,
}

impl Table1 {
    /// Reads `config/table1.toml`.
    ///
    /// # Errors
    /// When it cannot be read, or is not what this program expects.
    pub fn load(root: &Path) -> Result<Self> {
        let path = root.join("config/table1.toml");
        let text = std::fs::read_to_string(&path)
            .with_context(|| format!("cannot read {}", path.display()))?;
        toml::from_str(&text).map_err(|error| refused(&path, &error))
    }

    /// The eight cells, 000 first.
    pub fn cells() -> impl Iterator<Item = [usize; 3]> {
        (0..8).map(|cell| [cell >> 2 & 1, cell >> 1 & 1, cell & 1])
    }

    /// The settings of a cell, over others.
    fn cell(&self, over: &Config, levels: [usize; 3]) -> Result<Condition> {
        let factors = self.factors.iter().zip(levels);
        let set: Vec<String> = factors
            .map(|(factor, level)| format!("{}={}", factor.key, factor.levels[level]))
            .collect();
        let name = name_of(levels);
        let config = with(over, &set).with_context(|| format!("condition {name}"))?;
        Ok(Condition { name, config })
    }
}

/// The digits of a cell.
pub fn name_of(levels: [usize; 3]) -> String {
    levels.map(|level| level.to_string()).concat()
}

/// What was asked for, and which of it is the base.
///
/// # Errors
/// A sentence with what is allowed.
pub fn chosen(
    arguments: &CompareArguments,
    thrown: &Thrown,
    table: &Table1,
    root: &Path,
) -> Result<(Vec<Condition>, usize)> {
    let asked = arguments.conditions.trim();
    let conditions = if asked == "all" {
        let cells = Table1::cells().map(|levels| table.cell(&thrown.config, levels));
        cells.collect::<Result<Vec<_>>>()?
    } else if asked.split(',').all(|word| is_word(word.trim())) {
        let words = asked.split(',').map(str::trim);
        let named = words.map(|word| named(word, arguments, thrown, table, root));
        named.collect::<Result<Vec<_>>>()?
    } else {
        from_file(Path::new(asked), &thrown.config)?
    };
    check(&conditions, thrown)?;
    let base = match &arguments.base {
        Some(name) => conditions
            .iter()
            .position(|c| c.name == *name)
            .ok_or_else(|| {
                let names: Vec<&str> = conditions.iter().map(|c| c.name.as_str()).collect();
                unusable(format!(
                    "--base {name} is none of the conditions: give one of {}",
                    names.join(", ")
                ))
            })?,
        None => {
            let recorded = |c: &Condition| c.config == thrown.config;
            conditions.iter().position(recorded).unwrap_or(0)
        }
    };
    Ok((conditions, base))
}

/// A file's path could be anything else.
fn is_word(word: &str) -> bool {
    let is_cell = word.len() == 3 && word.bytes().all(|digit| matches!(digit, b'0' | b'1'));
    is_cell || word == "red" || word == "blue"
}

fn named(
    word: &str,
    arguments: &CompareArguments,
    thrown: &Thrown,
    table: &Table1,
    root: &Path,
) -> Result<Condition> {
    let place = match word {
        "red" => 0,
        "blue" => 1,
        digits => {
            let level = |digit: u8| usize::from(digit == b'1');
            let digits = digits.as_bytes();
            return table.cell(
                &thrown.config,
                [level(digits[0]), level(digits[1]), level(digits[2])],
            );
        }
    };
    let config = match &thrown.buttons {
        Some(buttons) => with(&buttons[place], &arguments.settings)?,
        None => {
            let layer = Layer::file(&root.join("config").join(format!("{word}.toml")))?;
            Config::from_layers(&[recorded(&thrown.config)?, layer])?
        }
    };
    Ok(Condition {
        name: word.to_owned(),
        config,
    })
}

fn from_file(path: &Path, over: &Config) -> Result<Vec<Condition>> {
    let text = std::fs::read_to_string(path).map_err(|error| {
        unusable(format!(
            "--conditions {}: no such conditions and no file that can be read ({error}); give all, some of red, blue and \
             three digits E, F, S such as 101 with commas between, or a TOML file",
            path.display()
        ))
    })?;
    let file: File = toml::from_str(&text).map_err(|error| refused(path, &error))?;
    let conditions = file.condition.into_iter().map(|named| {
        let config = with(over, &named.set)
            .with_context(|| format!("{}: condition {}", path.display(), named.name))?;
        Ok(Condition {
            name: named.name,
            config,
        })
    });
    conditions.collect()
}

fn refused(path: &Path, error: &toml::de::Error) -> anyhow::Error {
    let said = error.message().lines().next().unwrap_or_default();
    anyhow!(
        "{}: {said}; a condition is [[condition]] with name = \"..\" and set = [\"key=value\", ..]",
        path.display()
    )
}

/// Settings as a layer of their own.
fn recorded(config: &Config) -> Result<Layer> {
    let text =
        toml::to_string(config).context("the recorded settings cannot be written as TOML")?;
    Ok(Layer::text(Path::new("recorded settings"), text))
}

/// Settings with some of them changed, each as `key=value`.
///
/// # Errors
/// A sentence with the key.
pub fn with(config: &Config, set: &[String]) -> Result<Config> {
    let mut layers = vec![recorded(config)?];
    for argument in set {
        layers.push(Layer::argument(argument)?);
    }
    Ok(Config::from_layers(&layers)?)
}

/// There must be two to eight, with names of their own, in one room.
fn check(conditions: &[Condition], thrown: &Thrown) -> Result<()> {
    if !(2..=MOST).contains(&conditions.len()) {
        let count = conditions.len();
        let problem = format!("--conditions gives {count}: give from 2 to {MOST} to compare");
        bail!(unusable(problem));
    }
    for (index, condition) in conditions.iter().enumerate() {
        let name = &condition.name;
        if conditions[..index].iter().any(|other| other.name == *name) {
            bail!(unusable(format!(
                "--conditions has {name} twice: give each once"
            )));
        }
        let both = Conditions {
            lobby: thrown.config.clone(),
            red: condition.config.clone(),
            blue: condition.config.clone(),
        };
        match Game::new(both, 1) {
            Err(GameError::DifferingCondition(setting)) => bail!(unusable(format!(
                "condition {name} changes {setting}, which the recorded room has once: change objects or physics"
            ))),
            other => other
                .map(|_| ())
                .with_context(|| format!("condition {name}"))?,
        }
    }
    Ok(())
}
