//! Layers of settings: read, merged, and every value traceable to the line it came from.

use std::fmt;
use std::path::{Path, PathBuf};

use toml::de::DeTable;
use toml::{Table, Value};

use super::origins::Origins;
use super::wording::{of_serde, shortened};
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

impl Layer {
    /// Reads a file.
    ///
    /// # Errors
    /// When it cannot be read.
    pub fn file(path: &Path) -> Result<Self, ConfigError> {
        let bytes = std::fs::read(path).map_err(|error| ConfigError {
            place: path.display().to_string(),
            problem: format!(
                "cannot be read ({error}); give the folder that holds the configuration files"
            ),
        })?;
        let text = String::from_utf8(bytes).map_err(|error| {
            let good = error.utf8_error().valid_up_to();
            let line = 1 + error.as_bytes()[..good]
                .iter()
                .filter(|b| **b == b'\n')
                .count();
            ConfigError {
                place: format!("{}, line {line}", path.display()),
                problem: "is not UTF-8 text; save the file in UTF-8".to_owned(),
            }
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

    /// What an error calls the layer.
    pub(super) fn name(&self) -> String {
        self.name.to_string()
    }

    /// File and line; an argument has no line.
    pub(super) fn place(&self, line: usize) -> String {
        match &self.name {
            Name::File(_) => format!("{}, line {line}", self.name),
            Name::Argument(_) => self.name(),
        }
    }

    /// The layer's text; an argument for a key that holds text in `weaker` layers is that text, without quotes too.
    fn text_over(&self, weaker: &Table) -> String {
        let Name::Argument(argument) = &self.name else {
            return self.text.clone();
        };
        let (key, value) = argument.split_once('=').unwrap_or((argument, ""));
        let (key, value) = (key.trim(), value.trim());
        let mut parts = key.split('.');
        let first = parts.next().and_then(|part| weaker.get(part));
        let known = parts.fold(first, |table, part| table?.get(part));
        let is_bare = !value.starts_with(['"', '\'']);
        if is_bare && known.is_some_and(Value::is_str) {
            return format!("{key} = {}", Value::from(value));
        }
        self.text.clone()
    }
}

impl fmt::Display for Name {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::File(path) => write!(f, "{}", path.display()),
            Self::Argument(argument) => write!(f, "--set {}", shortened(argument)),
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
        let mut origins = Origins::default();
        for (index, layer) in layers.iter().enumerate() {
            let text = layer.text_over(&merged);
            let table = Table::try_from_text(&text).map_err(|error| no_toml(layer, &error))?;
            merge(&mut merged, table);
            let spans = DeTable::parse(&text).map_err(|error| no_toml(layer, &error))?;
            origins.remember(spans.get_ref(), &text, index);
        }
        let config: Self =
            serde_path_to_error::deserialize(Value::Table(merged)).map_err(|error| {
                let key = error.path().to_string();
                origins.blame(layers, &key, &[], &of_serde(error.inner().message()))
            })?;
        validate::validate(&config).map_err(|invalid| {
            origins.blame(layers, &invalid.key, &invalid.related, &invalid.problem)
        })?;
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
            Layer::file(&scene_file(folder, scene)?)?,
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

/// The file of a scene.
fn scene_file(folder: &Path, scene: &str) -> Result<PathBuf, ConfigError> {
    let scenes = folder.join("scenes");
    let path = scenes.join(format!("{scene}.toml"));
    let is_name = |c: char| c.is_alphanumeric() || c == '-' || c == '_';
    if !scene.is_empty() && scene.chars().all(is_name) && path.is_file() {
        return Ok(path);
    }
    let mut names: Vec<String> = std::fs::read_dir(&scenes)
        .into_iter()
        .flatten()
        .flatten()
        .map(|entry| entry.path())
        .filter(|path| path.extension().is_some_and(|end| end == "toml"))
        .filter_map(|path| Some(path.file_stem()?.to_str()?.to_owned()))
        .collect();
    names.sort();
    let names = if names.is_empty() {
        "none".to_owned()
    } else {
        names.join(", ")
    };
    Err(ConfigError {
        place: format!("--scene {}", shortened(scene)),
        problem: format!(
            "there is no such scene in {}; there are: {names}",
            scenes.display()
        ),
    })
}

/// The sentence for text that TOML cannot parse.
fn no_toml(layer: &Layer, error: &toml::de::Error) -> ConfigError {
    let line = error
        .span()
        .map_or(1, |span| line_of(&layer.text, span.start));
    let said = error.message().lines().next().unwrap_or_default();
    ConfigError {
        place: layer.place(line),
        problem: format!("is not valid TOML ({said}); correct the line"),
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

/// Line, from 1, of a byte of `text`.
pub(super) fn line_of(text: &str, byte: usize) -> usize {
    1 + text
        .bytes()
        .take(byte)
        .filter(|byte| *byte == b'\n')
        .count()
}
