//! What happens in a session and in which order: questions before, training throws, game one and two, questions after.
//!
//! The protocol is told what happened and says what is due: which buttons are locked, which form is to be filled in, what the
//! experimenter does next. It knows no condition, only Red and Blue. Fed with the same happenings it is in the same place, so
//! that a session that was broken off is taken up from its journal.

mod note;
mod outline;

use serde::{Deserialize, Serialize};

pub use note::{AnsweredIn, Note, Who};
pub use outline::{Part, Standing};

use crate::plan::{Button, SessionRules};
use crate::questionnaire::{Questionnaire, Stage};

/// Where a session is.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Place {
    /// A form is to be filled in.
    Form(Stage),
    /// Throws that do not count, and how many are left.
    Training {
        /// Throws to go.
        left: u32,
    },
    /// The button of game 1 or 2 is to be pressed.
    Waiting(u8),
    /// Game 1 or 2 is played.
    Playing(u8),
    /// In a study of differences: a throw of a pair is to be made.
    Pair {
        /// Number of the pair, from 1.
        number: u32,
        /// Throw of the pair, 1 or 2.
        throw: u8,
    },
    /// The participant says whether the throws of this pair were the same.
    Comparing(u32),
    /// The participant is told what the study is about.
    Debriefing,
    /// Everything is done.
    Complete,
    /// Somebody stopped the session.
    Stopped,
}

/// What moves a session on.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Happening {
    /// A throw outside a game has come to rest.
    PracticeThrow,
    /// A game began.
    GameStarted(Button),
    /// A game is over.
    GameOver,
    /// The form that was due has been filled in.
    FormDone,
    /// The participant said whether a pair of throws was the same.
    Compared,
    /// The participant was told what the study is about.
    Debriefed,
    /// Somebody stopped the session.
    Stop,
}

/// A session's course.
#[derive(Debug, Clone)]
pub struct Protocol {
    rules: SessionRules,
    first: Button,
    /// Pairs of throws that take the place of the games, in a study of differences.
    pairs: Option<u32>,
    /// Forms that ask something.
    forms: Vec<Stage>,
    place: Place,
    /// Buttons of the games that were begun.
    played: Vec<Button>,
}

/// Something that has no place where the session is.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("{happening:?} does not fit where the session is, {place:?}")]
pub struct Unfit {
    /// Where the session is.
    pub place: Place,
    /// What does not fit.
    pub happening: Happening,
}

impl Protocol {
    /// A session whose game one is under `first`. What `questionnaire` does not ask at some stage is passed over.
    pub fn new(rules: SessionRules, first: Button, questionnaire: &Questionnaire) -> Self {
        let all = [
            Stage::Before,
            Stage::AfterGame(1),
            Stage::AfterGame(2),
            Stage::After,
        ];
        let asks = |stage: &Stage| {
            let items = questionnaire.asked_at(*stage, rules.items_after_each_game);
            !items.is_empty()
        };
        let mut protocol = Self {
            forms: all.into_iter().filter(asks).collect(),
            rules,
            first,
            pairs: None,
            place: Place::Form(Stage::Before),
            played: Vec::new(),
        };
        protocol.place = protocol.form_or(Stage::Before, protocol.training());
        protocol
    }

    /// The same session with pairs of throws instead of games; what is asked after games is not asked then.
    #[must_use]
    pub fn comparing(mut self, pairs: u32) -> Self {
        self.pairs = Some(pairs);
        self.forms.retain(|stage| *stage == Stage::Before);
        self.place = self.form_or(Stage::Before, self.training());
        self
    }

    /// Where the session is.
    pub fn place(&self) -> Place {
        self.place
    }

    /// Whether the session is over, in whatever way.
    pub fn is_over(&self) -> bool {
        matches!(self.place, Place::Complete | Place::Stopped)
    }

    /// Whether throws are to be made where the session is.
    pub fn is_played(&self) -> bool {
        matches!(
            self.place,
            Place::Training { .. } | Place::Waiting(_) | Place::Playing(_) | Place::Pair { .. }
        )
    }

    /// Buttons of the games that were begun, in their order.
    pub fn played(&self) -> &[Button] {
        &self.played
    }

    /// The button that is to be pressed.
    pub fn due(&self) -> Option<Button> {
        match self.place {
            Place::Waiting(1) => Some(self.first),
            Place::Waiting(_) => Some(self.played.first().map_or(self.first, |b| b.other())),
            _ => None,
        }
    }

    /// Whether presses of Red and of Blue are refused now.
    pub fn locked(&self) -> [bool; 2] {
        let is_free = self.rules.undue_presses_allowed
            && matches!(self.place, Place::Waiting(_) | Place::Playing(_));
        [Button::Red, Button::Blue].map(|button| !is_free && self.due() != Some(button))
    }

    /// Moves on.
    ///
    /// # Errors
    /// When `happening` has no place here; the protocol is then as before.
    pub fn happen(&mut self, happening: Happening) -> Result<Place, Unfit> {
        use Happening::{
            Compared, Debriefed, FormDone, GameOver, GameStarted, PracticeThrow, Stop,
        };
        self.place = match (self.place, happening) {
            (Place::Complete | Place::Stopped, Stop) => self.place,
            (_, Stop) => Place::Stopped,
            (Place::Training { left: 0 | 1 }, PracticeThrow) => self.trained(),
            (Place::Training { left }, PracticeThrow) => Place::Training { left: left - 1 },
            // Whoever waits may throw; nothing counts.
            (
                Place::Waiting(_) | Place::Form(_) | Place::Comparing(_) | Place::Debriefing,
                PracticeThrow,
            ) => self.place,
            (Place::Pair { number, throw: 1 }, PracticeThrow) => Place::Pair { number, throw: 2 },
            (Place::Pair { number, .. }, PracticeThrow) => Place::Comparing(number),
            (Place::Comparing(number), Compared) if Some(number) == self.pairs => {
                self.after_games()
            }
            (Place::Comparing(number), Compared) => Place::Pair {
                number: number + 1,
                throw: 1,
            },
            (Place::Waiting(game), GameStarted(button)) => {
                self.played.push(button);
                Place::Playing(game)
            }
            // Where undue presses are allowed a game may be begun anew, under either button.
            (Place::Playing(game), GameStarted(button)) => {
                self.played.pop();
                self.played.push(button);
                Place::Playing(game)
            }
            (Place::Playing(1), GameOver) => self.form_or(Stage::AfterGame(1), Place::Waiting(2)),
            (Place::Playing(_), GameOver) => self.form_or(Stage::AfterGame(2), self.after_games()),
            (Place::Form(Stage::Before), FormDone) => self.training(),
            (Place::Form(Stage::AfterGame(1)), FormDone) => Place::Waiting(2),
            (Place::Form(Stage::AfterGame(_)), FormDone) => self.after_games(),
            (Place::Form(Stage::After), FormDone) => Place::Debriefing,
            (Place::Debriefing, Debriefed) => Place::Complete,
            (place, happening) => return Err(Unfit { place, happening }),
        };
        Ok(self.place)
    }

    /// The next step in words for the experimenter: Red and Blue, nothing of a condition.
    pub fn next_step(&self) -> String {
        match self.place {
            Place::Form(Stage::Before) => "Questions before the games".to_owned(),
            Place::Form(Stage::AfterGame(game)) => format!("Questions after game {game}"),
            Place::Form(Stage::After) => "Questions after the games".to_owned(),
            Place::Training { left: 1 } => "1 training throw to go".to_owned(),
            Place::Training { left } => format!("{left} training throws to go"),
            Place::Waiting(game) => {
                let button = self.due().unwrap_or(self.first);
                format!("Game {game}: the participant presses {button}")
            }
            Place::Playing(game) => format!("Game {game} is played"),
            Place::Pair { number, throw } => {
                let (of, throw) = (
                    self.pairs.unwrap_or(number),
                    ["first", "second"][usize::from(throw > 1)],
                );
                format!("Pair {number} of {of}: the {throw} throw")
            }
            Place::Comparing(number) => {
                let of = self.pairs.unwrap_or(number);
                format!("Pair {number} of {of}: did the two throws feel the same or different?")
            }
            Place::Debriefing => "Tell the participant what the study is about".to_owned(),
            Place::Complete => "The session is complete".to_owned(),
            Place::Stopped => "The session was stopped".to_owned(),
        }
    }

    fn training(&self) -> Place {
        match self.rules.training_throws {
            0 => self.trained(),
            left => Place::Training { left },
        }
    }

    /// What comes behind the training.
    fn trained(&self) -> Place {
        match self.pairs {
            Some(_) => Place::Pair {
                number: 1,
                throw: 1,
            },
            None => Place::Waiting(1),
        }
    }

    fn after_games(&self) -> Place {
        self.form_or(Stage::After, Place::Debriefing)
    }

    fn form_or(&self, form: Stage, otherwise: Place) -> Place {
        if self.forms.contains(&form) {
            Place::Form(form)
        } else {
            otherwise
        }
    }
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::*;

    fn protocol(rules: SessionRules) -> Protocol {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../config/questionnaire.toml");
        Protocol::new(rules, Button::Blue, &Questionnaire::read(&path).unwrap())
    }

    fn play(protocol: &mut Protocol, button: Button) {
        protocol.happen(Happening::GameStarted(button)).unwrap();
        assert_eq!(protocol.locked(), [true, true]);
        protocol.happen(Happening::GameOver).unwrap();
    }

    #[test]
    fn a_session_goes_through_its_places_and_only_the_due_button_is_free() {
        let mut protocol = protocol(SessionRules::default());
        assert_eq!(protocol.place(), Place::Form(Stage::Before));
        protocol.happen(Happening::FormDone).unwrap();
        for left in [3, 2, 1] {
            assert_eq!(protocol.place(), Place::Training { left });
            assert_eq!(protocol.locked(), [true, true]);
            protocol.happen(Happening::PracticeThrow).unwrap();
        }
        assert_eq!(protocol.due(), Some(Button::Blue));
        assert_eq!(protocol.locked(), [true, false]);
        play(&mut protocol, Button::Blue);
        // Sickness is asked between the games.
        assert_eq!(protocol.place(), Place::Form(Stage::AfterGame(1)));
        protocol.happen(Happening::FormDone).unwrap();
        assert_eq!(protocol.locked(), [false, true]);
        assert_eq!(protocol.next_step(), "Game 2: the participant presses Red");
        play(&mut protocol, Button::Red);
        assert_eq!(protocol.place(), Place::Form(Stage::After));
        protocol.happen(Happening::FormDone).unwrap();
        assert_eq!(protocol.place(), Place::Debriefing);
        protocol.happen(Happening::Debriefed).unwrap();
        assert_eq!(protocol.place(), Place::Complete);
        assert_eq!(protocol.played(), [Button::Blue, Button::Red]);
    }

    #[test]
    fn a_plan_may_allow_what_is_not_due() {
        let mut protocol = protocol(SessionRules {
            undue_presses_allowed: true,
            training_throws: 0,
            ..SessionRules::default()
        });
        protocol.happen(Happening::FormDone).unwrap();
        assert_eq!(protocol.locked(), [false, false]);
        protocol
            .happen(Happening::GameStarted(Button::Red))
            .unwrap();
        assert_eq!(
            protocol.locked(),
            [false, false],
            "a game may be begun anew"
        );
        protocol.happen(Happening::GameOver).unwrap();
        assert_eq!(protocol.locked(), [true, true], "a form is filled in");
        protocol.happen(Happening::FormDone).unwrap();
        // Whatever was first: the other one is due now.
        assert_eq!(protocol.due(), Some(Button::Blue));
    }

    #[test]
    fn pairs_take_the_place_of_games_and_no_button_is_free() {
        let mut protocol = protocol(SessionRules {
            training_throws: 1,
            ..SessionRules::default()
        })
        .comparing(2);
        let mut places = Vec::new();
        let happenings = [
            Happening::FormDone,
            Happening::PracticeThrow,
            Happening::PracticeThrow,
            Happening::PracticeThrow,
            Happening::Compared,
            Happening::PracticeThrow,
            Happening::PracticeThrow,
            // A throw while the question is asked changes nothing.
            Happening::PracticeThrow,
            Happening::Compared,
            Happening::Debriefed,
        ];
        for happening in happenings {
            assert_eq!(protocol.locked(), [true, true]);
            assert!(
                protocol
                    .happen(Happening::GameStarted(Button::Red))
                    .is_err()
            );
            places.push(protocol.happen(happening).unwrap());
        }
        let pair = |number, throw| Place::Pair { number, throw };
        assert_eq!(
            places,
            [
                Place::Training { left: 1 },
                pair(1, 1),
                pair(1, 2),
                Place::Comparing(1),
                pair(2, 1),
                pair(2, 2),
                Place::Comparing(2),
                Place::Comparing(2),
                Place::Debriefing,
                Place::Complete
            ]
        );
    }

    #[test]
    fn what_has_no_place_is_refused_and_a_stop_always_has_one() {
        let mut protocol = protocol(SessionRules::default());
        let before = protocol.place();
        for happening in [
            Happening::GameOver,
            Happening::GameStarted(Button::Red),
            Happening::Debriefed,
        ] {
            assert!(protocol.happen(happening).is_err(), "{happening:?}");
            assert_eq!(protocol.place(), before);
        }
        assert_eq!(protocol.happen(Happening::Stop), Ok(Place::Stopped));
        assert!(protocol.is_over());
        assert!(protocol.happen(Happening::FormDone).is_err());
    }

    #[test]
    fn next_step_names_no_condition() {
        let mut protocol = protocol(SessionRules::default());
        let mut said = vec![protocol.next_step()];
        let happenings = [
            Happening::FormDone,
            Happening::PracticeThrow,
            Happening::PracticeThrow,
            Happening::PracticeThrow,
            Happening::GameStarted(Button::Blue),
            Happening::GameOver,
            Happening::FormDone,
            Happening::GameStarted(Button::Red),
            Happening::GameOver,
            Happening::FormDone,
            Happening::Debriefed,
        ];
        for happening in happenings {
            protocol.happen(happening).unwrap();
            said.push(protocol.next_step());
        }
        let said = said.join(" ").to_lowercase();
        for word in ["elastic", "friction", "shape", "presence", "condition"] {
            assert!(!said.contains(word), "{said}");
        }
    }
}
