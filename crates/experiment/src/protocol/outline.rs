//! The parts of a session in their order, and where each stands: what the experimenter's window lists.

use super::{Place, Protocol};
use crate::plan::Button;
use crate::questionnaire::Stage;

/// Where a part of a session stands.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Standing {
    /// It is over.
    Done,
    /// It is on.
    On,
    /// It comes next.
    Next,
    /// It comes after that.
    Later,
}

/// A part of a session.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Part {
    /// What it is: Red and Blue, nothing of a condition.
    pub name: String,
    /// Where it stands.
    pub standing: Standing,
}

impl Protocol {
    /// All parts of the session in their order; of one that was stopped none is on.
    pub fn outline(&self) -> Vec<Part> {
        let kinds = self.kinds();
        let on = match self.place {
            Place::Complete => kinds.len(),
            Place::Stopped => usize::MAX,
            place => kinds
                .iter()
                .position(|kind| *kind == Kind::of(place))
                .unwrap_or(usize::MAX),
        };
        let standing = |index: usize| match on {
            usize::MAX => Standing::Later,
            on if index < on => Standing::Done,
            on if index == on => Standing::On,
            on if index == on + 1 => Standing::Next,
            _ => Standing::Later,
        };
        let part = |(index, kind): (usize, &Kind)| Part {
            name: self.name(*kind),
            standing: standing(index),
        };
        kinds.iter().enumerate().map(part).collect()
    }

    fn kinds(&self) -> Vec<Kind> {
        let all = [
            Kind::Form(Stage::Before),
            Kind::Training,
            Kind::Pairs,
            Kind::Game(1),
            Kind::Form(Stage::AfterGame(1)),
            Kind::Game(2),
            Kind::Form(Stage::AfterGame(2)),
            Kind::Form(Stage::After),
            Kind::Debriefing,
        ];
        let happens = |kind: &Kind| match kind {
            Kind::Form(stage) => self.forms.contains(stage),
            Kind::Training => self.rules.training_throws > 0,
            Kind::Pairs => self.pairs.is_some(),
            Kind::Game(_) => self.pairs.is_none(),
            Kind::Debriefing => true,
        };
        all.into_iter().filter(happens).collect()
    }

    fn name(&self, kind: Kind) -> String {
        match kind {
            Kind::Form(Stage::Before) => "Questions before the games".to_owned(),
            Kind::Form(Stage::AfterGame(game)) => format!("Questions after game {game}"),
            Kind::Form(Stage::After) => "Questions after the games".to_owned(),
            Kind::Training => match self.rules.training_throws {
                1 => "1 training throw".to_owned(),
                throws => format!("{throws} training throws"),
            },
            Kind::Pairs => format!("{} pairs of throws", self.pairs.unwrap_or(0)),
            Kind::Game(game) => format!("Game {game}: {}", self.button(game)),
            Kind::Debriefing => "Debriefing".to_owned(),
        }
    }

    /// The button that game 1 or 2 is played under, or is to be.
    fn button(&self, game: u8) -> Button {
        let first = self.played.first().copied().unwrap_or(self.first);
        match game {
            1 => first,
            _ => self.played.get(1).copied().unwrap_or(first.other()),
        }
    }
}

/// What a part is, however far it has got.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Kind {
    Form(Stage),
    Training,
    Pairs,
    Game(u8),
    Debriefing,
}

impl Kind {
    /// The part that a place of a session under way belongs to.
    fn of(place: Place) -> Self {
        match place {
            Place::Form(stage) => Kind::Form(stage),
            Place::Training { .. } => Kind::Training,
            Place::Waiting(game) | Place::Playing(game) => Kind::Game(game),
            Place::Pair { .. } | Place::Comparing(_) => Kind::Pairs,
            Place::Debriefing | Place::Complete | Place::Stopped => Kind::Debriefing,
        }
    }
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::*;
    use crate::plan::SessionRules;
    use crate::protocol::Happening;
    use crate::questionnaire::Questionnaire;

    fn protocol(rules: SessionRules) -> Protocol {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../config/questionnaire.toml");
        Protocol::new(rules, Button::Blue, &Questionnaire::read(&path).unwrap())
    }

    fn on_and_next(protocol: &Protocol) -> (Option<String>, Option<String>) {
        let parts = protocol.outline();
        let at = |standing| {
            let mut with = parts.iter().filter(|part| part.standing == standing);
            let found = with.next().map(|part| part.name.clone());
            assert_eq!(with.next(), None, "one at most");
            found
        };
        (at(Standing::On), at(Standing::Next))
    }

    #[test]
    fn outline_has_one_part_on_and_the_one_behind_it_next() {
        let mut protocol = protocol(SessionRules::default());
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
        let mut seen = Vec::new();
        for happening in happenings {
            let (on, next) = on_and_next(&protocol);
            let on = on.expect("something is on");
            if seen.last() != Some(&on) {
                seen.push(on);
            }
            assert_eq!(
                next.is_none(),
                seen.last().is_some_and(|on| on == "Debriefing")
            );
            protocol.happen(happening).unwrap();
        }
        assert_eq!(
            seen,
            [
                "Questions before the games",
                "3 training throws",
                "Game 1: Blue",
                "Questions after game 1",
                "Game 2: Red",
                "Questions after the games",
                "Debriefing"
            ]
        );
        let parts = protocol.outline();
        assert!(parts.iter().all(|part| part.standing == Standing::Done));
    }

    #[test]
    fn outline_of_a_stopped_session_has_nothing_on() {
        let mut protocol = protocol(SessionRules {
            training_throws: 0,
            ..SessionRules::default()
        });
        protocol.happen(Happening::Stop).unwrap();
        assert_eq!(on_and_next(&protocol), (None, None));
        assert!(
            protocol
                .outline()
                .iter()
                .all(|part| !part.name.contains("training"))
        );
    }
}
