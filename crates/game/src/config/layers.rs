//! Layers of settings: read, merged, and every value traceable to the line it came from.

use std::collections::BTreeMap;
use std::fmt;
use std::path::{Path, PathBuf};

use toml::de::{DeTable, DeValue};
use toml::{Table, Value};

use super::{Config, validate};

/// A setting that cannot be used, said in one sentence.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{place}: {problem}")]
pub struct ConfigError {
    /// File and line, or the command-line argument.
    pub place: String,
    /// What is wrong and what to do.
    pub problem: String,
}

/// One source of settings.
#[derive(Clone, Debug)]
pub struct Layer {
    name: Name,
    text: String,
}

/// What a layer is called in an error.
#[derive(Clone, Debug)]
enum Name {
    File(PathBuf),
    Argument(String),
}

/// Where a value was written.
#[derive(Clone, Debug)]
struct Origin {
    layer: usize,
    line: usize,
}

impl Layer {
    /// Reads a file.
    ///
    /// # Errors
    /// When it cannot be read.
    pub fn file(path: &Path) -> Result<Self, ConfigError> {
        let text = std::fs::read_to_string(path).map_err(|error| ConfigError {
            place: path.display().to_string(),
            problem: format!(
                "cannot be read ({error}); give the folder that holds the configuration files"
            ),
        })?;
        Ok(Self::text(path, text))
    }

    /// Settings from text already read; errors call it `path`.
    pub fn text(path: &Path, text: impl Into<String>) -> Self {
        Self {
            name: Name::File(path.to_owned()),
            text: text.into(),
        }
    }

    /// One `key.path=value` of the command line. A value that is no TOML is taken as a string.
    ///
    /// # Errors
    /// When there is no `=` or no key before it.
    pub fn argument(argument: &str) -> Result<Self, ConfigError> {
        let name = Name::Argument(argument.to_owned());
        let refuse = || ConfigError {
            place: name.to_string(),
            problem: "is not of the form key=value; write for example --set objects.elasticity=1.0"
                .to_owned(),
        };
        let (key, value) = argument.split_once('=').ok_or_else(refuse)?;
        let is_key = |part: &str| {
            !part.is_empty()
                && part
                    .chars()
                    .all(|c| c.is_ascii_alphanumeric() || c == '_' || c == '-')
        };
        if !key.trim().split('.').all(is_key) || value.contains('\n') {
            return Err(refuse());
        }
        let plain = format!("{key} = {value}");
        let text = match Table::try_from_text(&plain) {
            Ok(_) => plain,
            Err(_) => format!("{key} = {}", Value::from(value.trim())),
        };
        Ok(Self { name, text })
    }
}

impl fmt::Display for Name {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::File(path) => write!(f, "{}", path.display()),
            Self::Argument(argument) => write!(f, "--set {argument}"),
        }
    }
}

/// Parsing a table without a type annotation at each call.
trait TryFromText: Sized {
    fn try_from_text(text: &str) -> Result<Self, toml::de::Error>;
}

impl TryFromText for Table {
    fn try_from_text(text: &str) -> Result<Self, toml::de::Error> {
        toml::from_str(text)
    }
}

impl Config {
    /// Merges layers, weakest first, and checks the result.
    ///
    /// # Errors
    /// A sentence with file, line and key for: text that is no TOML, an unknown or missing key, a value of the wrong type or
    /// out of range.
    pub fn from_layers(layers: &[Layer]) -> Result<Self, ConfigError> {
        let mut merged = Table::new();
        let mut origins = BTreeMap::new();
        for (index, layer) in layers.iter().enumerate() {
            let table =
                Table::try_from_text(&layer.text).map_err(|error| no_toml(layer, &error))?;
            merge(&mut merged, table);
            let spans = DeTable::parse(&layer.text).map_err(|error| no_toml(layer, &error))?;
            remember(spans.get_ref(), &layer.text, "", index, &mut origins);
        }
        let blame = |key: &str, problem: String| blame(layers, &origins, key, &problem);
        let config: Self =
            serde_path_to_error::deserialize(Value::Table(merged)).map_err(|error| {
                let key = error.path().to_string();
                blame(&key, first_line(error.inner().message()))
            })?;
        validate::validate(&config).map_err(|invalid| blame(&invalid.key, invalid.problem))?;
        Ok(config)
    }

    /// Checks settings that came from elsewhere than files and arguments, such as a recording.
    ///
    /// # Errors
    /// A sentence with the key that is out of range.
    pub fn check(&self) -> Result<(), ConfigError> {
        validate::validate(self).map_err(|invalid| ConfigError {
            place: "recorded settings".to_owned(),
            problem: format!("key `{}`: {}", invalid.key, invalid.problem),
        })
    }

    /// The folder's `default.toml`, then `scenes/SCENE.toml`, then `CONDITION.toml` where one is named, then the arguments.
    ///
    /// # Errors
    /// As [`Config::from_layers`], and when a file cannot be read.
    pub fn load(
        folder: &Path,
        scene: &str,
        condition: Option<&str>,
        arguments: &[String],
    ) -> Result<Self, ConfigError> {
        let mut layers = vec![
            Layer::file(&folder.join("default.toml"))?,
            Layer::file(&folder.join("scenes").join(format!("{scene}.toml")))?,
        ];
        if let Some(condition) = condition {
            layers.push(Layer::file(&folder.join(format!("{condition}.toml")))?);
        }
        for argument in arguments {
            layers.push(Layer::argument(argument)?);
        }
        Self::from_layers(&layers)
    }
}

/// The sentence for text that TOML cannot parse.
fn no_toml(layer: &Layer, error: &toml::de::Error) -> ConfigError {
    let line = error
        .span()
        .map_or(1, |span| line_of(&layer.text, span.start));
    ConfigError {
        place: place(layer, line),
        problem: format!(
            "is not valid TOML ({}); correct the line",
            first_line(error.message())
        ),
    }
}

/// The sentence for a bad key, with the place that wrote it last.
fn blame(
    layers: &[Layer],
    origins: &BTreeMap<String, Origin>,
    key: &str,
    problem: &str,
) -> ConfigError {
    // A missing key was written nowhere: its table, or else the weakest layer, is where it belongs.
    let mut known = key;
    loop {
        if let Some(origin) = origins.get(known) {
            let place = place(&layers[origin.layer], origin.line);
            return ConfigError {
                place,
                problem: format!("key `{key}`: {problem}"),
            };
        }
        match known.rfind(['.', '[']) {
            Some(end) => known = &known[..end],
            None => break,
        }
    }
    ConfigError {
        place: layers.first().map_or_else(
            || "configuration".to_owned(),
            |layer| layer.name.to_string(),
        ),
        problem: format!("key `{key}`: {problem}"),
    }
}

/// File and line; an argument has no line.
fn place(layer: &Layer, line: usize) -> String {
    match &layer.name {
        Name::File(_) => format!("{}, line {line}", layer.name),
        Name::Argument(_) => layer.name.to_string(),
    }
}

/// Tables merge key by key; anything else, arrays included, is replaced.
fn merge(into: &mut Table, from: Table) {
    for (key, value) in from {
        match (into.get_mut(&key), value) {
            (Some(Value::Table(into)), Value::Table(from)) => merge(into, from),
            (_, value) => {
                into.insert(key, value);
            }
        }
    }
}

/// Notes the line of every key of `table`, under its dotted path.
fn remember(
    table: &DeTable<'_>,
    text: &str,
    path: &str,
    layer: usize,
    origins: &mut BTreeMap<String, Origin>,
) {
    for (key, value) in table {
        let dot = if path.is_empty() { "" } else { "." };
        let path = format!("{path}{dot}{}", key.get_ref());
        let line = line_of(text, key.span().start);
        remember_value(
            value.get_ref(),
            text,
            &path,
            Origin { layer, line },
            origins,
        );
    }
}

/// Notes one value and, in tables and arrays, those within.
fn remember_value(
    value: &DeValue<'_>,
    text: &str,
    path: &str,
    origin: Origin,
    origins: &mut BTreeMap<String, Origin>,
) {
    let layer = origin.layer;
    match value {
        DeValue::Table(table) => remember(table, text, path, layer, origins),
        DeValue::Array(items) => {
            for (index, item) in items.iter().enumerate() {
                let line = line_of(text, item.span().start);
                let path = format!("{path}[{index}]");
                remember_value(item.get_ref(), text, &path, Origin { layer, line }, origins);
            }
        }
        _ => {}
    }
    origins.insert(path.to_owned(), origin);
}

/// Line, from 1, of a byte of `text`.
fn line_of(text: &str, byte: usize) -> usize {
    text.bytes()
        .take(byte)
        .filter(|byte| *byte == b'\n')
        .count()
        + 1
}

/// One sentence has one line.
fn first_line(message: &str) -> String {
    message.lines().next().unwrap_or_default().to_owned()
}
