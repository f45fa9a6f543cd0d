//! Every word that a participant can see besides a study's own texts: read from one file, and checked against the shipped one.
//!
//! The shipped file says which texts there are and which names are filled into them; any other file must have the same.

use std::fmt::Display;
use std::path::Path;

use anyhow::{Context, Result, anyhow, bail};
use experiment::questionnaire::names_the_purpose;
use game::{Button, Config};
use serde::Deserialize;
use toml::{Table, Value};

/// The file that comes with the program.
const SHIPPED: &str = include_str!("../../config/words.toml");

/// All of them.
#[derive(Clone, Debug, PartialEq, Eq, Deserialize)]
pub struct Words {
    /// Language, as a BCP 47 tag.
    pub language: String,
    /// What the two buttons are called.
    pub buttons: ButtonWords,
    /// On the scoreboard.
    pub board: BoardWords,
    /// Hints to a newcomer.
    pub hints: HintWords,
    /// In practice.
    pub practice: PracticeWords,
    /// On the panel at the wrist.
    pub pause: PauseWords,
    /// Fixed labels of the panel with questions.
    pub panel: PanelWords,
    /// On the stop sign.
    pub stop_sign: StopWords,
    /// Over the desk's window.
    pub window: WindowWords,
}

/// What the two buttons are called.
#[derive(Clone, Debug, PartialEq, Eq, Deserialize)]
pub struct ButtonWords {
    /// The disc.
    pub red: String,
    /// The square.
    pub blue: String,
}

/// On the scoreboard: how the last ball was let go.
#[derive(Clone, Debug, PartialEq, Eq, Deserialize)]
pub struct BoardWords {
    /// `{speed}` [m/s].
    pub speed: String,
    /// `{angle}` [degrees] to the left of the lane's direction.
    pub left: String,
    /// `{angle}` [degrees] to its right.
    pub right: String,
    /// `{turns}` [1/min].
    pub turns: String,
    /// The foul line was respected.
    pub behind: String,
    /// It was not.
    pub over: String,
    /// Throws are helped by `{percent}`.
    pub assist: String,
}

/// Hints to a newcomer.
#[derive(Clone, Debug, PartialEq, Eq, Deserialize)]
pub struct HintWords {
    /// The hand is far from the balls.
    pub reach: String,
    /// It could take one.
    pub hold: String,
    /// It has one.
    pub swing: String,
    /// A bare hand could take one.
    pub hold_bare: String,
    /// At the desk: the hand is far from the balls.
    pub reach_mouse: String,
    /// At the desk: it could take one.
    pub hold_mouse: String,
    /// At the desk: it has one.
    pub swing_mouse: String,
}

/// In practice.
#[derive(Clone, Debug, PartialEq, Eq, Deserialize)]
pub struct PracticeWords {
    /// Before the first throw.
    pub begin: String,
    /// A ball's weight: `{kg}`.
    pub weight: String,
}

/// On the panel at the wrist.
#[derive(Clone, Debug, PartialEq, Eq, Deserialize)]
pub struct PauseWords {
    /// Pauses.
    pub pause: String,
    /// Ends the pause.
    pub go_on: String,
    /// Goes back to where the session began, facing the lane.
    pub recentre: String,
}

/// Fixed labels of the panel with questions.
#[derive(Clone, Debug, PartialEq, Eq, Deserialize)]
pub struct PanelWords {
    /// `{number}` of the question, and the `{count}` of them.
    pub position: String,
    /// An answer.
    pub yes: String,
    /// An answer.
    pub no: String,
    /// To the question before.
    pub back: String,
    /// No answer.
    pub skip: String,
    /// The end of the session.
    pub stop: String,
    /// How a question without boxes is answered.
    pub own_words: String,
    /// At the end.
    pub thanks: String,
    /// Asks to compare a pair of throws.
    pub compare: String,
    /// A reply.
    pub same: String,
    /// A reply.
    pub different: String,
}

/// On the stop sign.
#[derive(Clone, Debug, PartialEq, Eq, Deserialize)]
pub struct StopWords {
    /// What it does.
    pub stop: String,
    /// How.
    pub how: String,
}

/// Over the desk's window.
#[derive(Clone, Debug, PartialEq, Eq, Deserialize)]
pub struct WindowWords {
    /// The window's title.
    pub title: String,
    /// Before the first game; `{red}`, `{blue}`.
    pub begin: String,
    /// Where the keys are told.
    pub keys: String,
    /// In a pause.
    pub paused: String,
    /// A game has begun under `{button}`.
    pub started: String,
    /// `{button}` asks for a second press.
    pub confirm: String,
    /// A ball was let go at `{speed}` [m/s].
    pub released: String,
    /// It was a foul.
    pub foul: String,
    /// Pins `{fallen}` and `{standing}`.
    pub settled: String,
    /// The game under `{button}` has ended with `{total}` pins.
    pub over: String,
    /// All keys; `{red}`, `{blue}`.
    pub help: String,
}

impl Words {
    /// The words that come with the program.
    pub fn shipped() -> Self {
        toml::from_str(SHIPPED).expect("a test holds the shipped words against this form")
    }

    /// The words that `config` names, from the configuration in `root`.
    ///
    /// # Errors
    /// A sentence with the file and the key that is missing, unknown or wrong.
    pub fn load(root: &Path, config: &Config) -> Result<Self> {
        let path = root.join("config").join(&config.guidance.words);
        let text = std::fs::read_to_string(&path).with_context(|| {
            format!(
                "cannot read {}: `guidance.words` names a file of words in the folder config",
                path.display()
            )
        })?;
        Self::parse(&text).map_err(|problem| anyhow!("{}: {problem}", path.display()))
    }

    fn parse(text: &str) -> Result<Self> {
        let table: Table = toml::from_str(text).map_err(|error| {
            anyhow!("is not valid TOML ({}): correct it", plain(error.message()))
        })?;
        let shipped: Table = toml::from_str(SHIPPED).expect("a test reads the shipped words");
        compare("", &table, &shipped)?;
        let words: Self = table.try_into()?;
        if words.buttons.red.to_lowercase() == words.buttons.blue.to_lowercase() {
            bail!(
                "keys `buttons.red` and `buttons.blue` say the same: give them words that differ"
            );
        }
        Ok(words)
    }

    /// What a button is called.
    pub fn button(&self, button: Button) -> &str {
        match button {
            Button::Red => &self.buttons.red,
            Button::Blue => &self.buttons.blue,
        }
    }

    /// A text in which both buttons may be named.
    pub fn with_buttons(&self, text: &str) -> String {
        fill(
            text,
            &[("red", &self.buttons.red), ("blue", &self.buttons.blue)],
        )
    }
}

/// A text with every `{name}` replaced by its value.
pub fn fill(text: &str, values: &[(&str, &dyn Display)]) -> String {
    let mut filled = text.to_owned();
    for (name, value) in values {
        filled = filled.replace(&format!("{{{name}}}"), &value.to_string());
    }
    filled
}

/// Every text of `shipped` is in `table`, with the same names in braces, and nothing else.
fn compare(above: &str, table: &Table, shipped: &Table) -> Result<()> {
    for (key, expected) in shipped {
        let name = format!("{above}{key}");
        let found = table
            .get(key)
            .with_context(|| format!("key `{name}` is missing: add it, as words.toml has it"))?;
        match (found, expected) {
            (Value::Table(found), Value::Table(expected)) => {
                compare(&format!("{name}."), found, expected)?;
            }
            (Value::String(found), Value::String(expected)) => check(&name, found, expected)?,
            (_, Value::Table(_)) => bail!("key `{name}` must be a table of texts"),
            _ => bail!("key `{name}` must be a text in quotes"),
        }
    }
    match table.keys().find(|key| !shipped.contains_key(*key)) {
        Some(key) => bail!("key `{above}{key}` is unknown: remove it or correct its spelling"),
        None => Ok(()),
    }
}

fn check(name: &str, text: &str, shipped: &str) -> Result<()> {
    if text.trim().is_empty() {
        bail!("key `{name}` is empty: give it a text");
    }
    if names_the_purpose(text) {
        bail!(
            "key `{name}`: a participant must not read the word \"presence\", and {text:?} has it: say it in other words"
        );
    }
    let (found, expected) = (names(text), names(shipped));
    if found != expected {
        let listed = |names: &[&str]| match names {
            [] => "no name in braces".to_owned(),
            names => names.join(" and "),
        };
        bail!(
            "key `{name}` has {} where {} is filled in: write it so",
            listed(&found),
            listed(&expected)
        );
    }
    Ok(())
}

/// The names in braces, each once, in order of the alphabet.
fn names(text: &str) -> Vec<&str> {
    let mut names: Vec<&str> = text
        .split('{')
        .skip(1)
        .filter_map(|rest| rest.split_once('}'))
        .map(|(name, _)| name)
        .collect();
    names.sort_unstable();
    names.dedup();
    names
}

fn plain(message: &str) -> String {
    message.lines().next().unwrap_or_default().to_owned()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn refused(from: &str, to: &str) -> String {
        assert!(SHIPPED.contains(from), "{from}");
        Words::parse(&SHIPPED.replacen(from, to, 1))
            .expect_err(to)
            .to_string()
    }

    #[test]
    fn the_shipped_words_and_every_other_file_of_words_are_whole() {
        assert_eq!(Words::parse(SHIPPED).expect("whole"), Words::shipped());
        let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("config");
        let files = std::fs::read_dir(folder).expect("the project's configuration");
        let mut count = 0;
        for path in files.flatten().map(|file| file.path()) {
            let name = path.file_name().and_then(|name| name.to_str());
            if name.is_some_and(|name| name.starts_with("words")) {
                let text = std::fs::read_to_string(&path).expect("text");
                let words = Words::parse(&text).unwrap_or_else(|error| panic!("{path:?}: {error}"));
                assert!(!words.language.is_empty());
                count += 1;
            }
        }
        assert!(count >= 2, "words in one language only");
    }

    #[test]
    fn words_that_are_missing_unknown_or_wrong_are_refused_with_their_key() {
        for (from, to, expected) in [
            ("skip = \"Skip\"\n", "", "key `panel.skip` is missing"),
            (
                "skip = ",
                "skipp = \"x\"\nskip = ",
                "key `panel.skipp` is unknown",
            ),
            ("\"Skip\"", "7", "key `panel.skip` must be a text in quotes"),
            ("\"Skip\"", "\" \"", "key `panel.skip` is empty"),
            (
                "{number} of",
                "of",
                "key `panel.position` has count where count and number",
            ),
            ("Reach for", "Feel the Presence of", "the word \"presence\""),
            ("[hints]", "[hints", "is not valid TOML"),
            ("blue = \"Blue\"", "blue = \"red\"", "say the same"),
        ] {
            let error = refused(from, to);
            assert!(
                error.contains(expected) && error.lines().count() == 1,
                "{error}"
            );
        }
    }

    #[test]
    fn fill_replaces_what_is_named_and_nothing_else() {
        let text = fill("{a} of {b}, {c}", &[("a", &1), ("b", &"x")]);
        assert_eq!(text, "1 of x, {c}");
    }
}
