//! Red and Blue: two labels, and the settings that each stands for. Nothing else in the game looks at the label.

use std::path::Path;

use serde::{Deserialize, Serialize};

use crate::config::{Config, ConfigError};

/// The two buttons, which is all that a participant knows of the conditions.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Button {
    /// The Red button.
    Red,
    /// The Blue button.
    Blue,
}

impl Button {
    /// Both, in the order in which lists show them.
    pub const BOTH: [Self; 2] = [Self::Red, Self::Blue];

    /// The name of the condition's file, without `.toml`.
    pub fn file_stem(self) -> &'static str {
        match self {
            Self::Red => "red",
            Self::Blue => "blue",
        }
    }
}

impl std::fmt::Display for Button {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(match self {
            Self::Red => "Red",
            Self::Blue => "Blue",
        })
    }
}

/// The resolved settings of a session.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Conditions {
    /// Before a button is pressed: the scene without any condition.
    pub lobby: Config,
    /// What the Red button stands for.
    pub red: Config,
    /// What the Blue button stands for.
    pub blue: Config,
}

impl Conditions {
    /// Reads `default.toml`, `scenes/SCENE.toml`, `red.toml` and `blue.toml` in `folder`; `arguments` are `key.path=value`.
    ///
    /// # Errors
    /// One sentence with file, line and key.
    pub fn load(folder: &Path, scene: &str, arguments: &[String]) -> Result<Self, ConfigError> {
        let load = |button: Option<Button>| {
            Config::load(folder, scene, button.map(Button::file_stem), arguments)
        };
        Ok(Self {
            lobby: load(None)?,
            red: load(Some(Button::Red))?,
            blue: load(Some(Button::Blue))?,
        })
    }

    /// What a button stands for.
    pub fn of(&self, button: Button) -> &Config {
        match button {
            Button::Red => &self.red,
            Button::Blue => &self.blue,
        }
    }
}
