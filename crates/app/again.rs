//! The last throw, to be watched again: remembered while it happens, shown after its pins are counted.

use std::sync::Arc;

use game::{Config, EventKind, Game, Model, Visible};

/// Pictures remembered of each second [Hz].
const RATE_HZ: f64 = 30.0;
/// What is shown: so long before the first pin was struck, and so long after [s]. Of a ball that struck none, the end.
const BEFORE_S: f64 = 1.0;
const AFTER_S: f64 = 2.5;
/// More of a throw is not remembered [s]: its first part is forgotten.
const LONGEST_S: f64 = 20.0;

/// Everything that moved at an instant of a throw.
pub type Moment = Arc<[Visible]>;

/// Remembers the throw that is on, and shows the last one.
#[derive(Debug, Default)]
pub struct Again {
    /// Of the throw that is on or was counted last, in the order of time [s].
    moments: Vec<(f64, Moment)>,
    is_thrown: bool,
    first_hit: Option<f64>,
    /// When it was begun to be shown, and the span that is [s].
    shown: Option<(f64, [f64; 2])>,
}

impl Again {
    /// A memory for a scene; `None` where it shows no replay.
    pub fn of(config: &Config) -> Option<Self> {
        config.shows.replay.then(Self::default)
    }

    /// Takes notice of the frame that the game has just finished.
    pub fn notice(&mut self, game: &Game) {
        let now = game.time();
        for event in game.events() {
            match event.kind {
                EventKind::Released(_) => *self = Self::of_throw(),
                EventKind::FirstHit { .. } => self.first_hit = Some(now),
                EventKind::Settled { .. } if self.is_thrown => self.begin(now),
                _ => {}
            }
        }
        if self.is_thrown && self.is_due(now) {
            let moving = game.visible().into_iter();
            let seen = moving.filter(|thing| thing.model != Model::Hand);
            self.moments.push((now, seen.collect()));
            self.moments.retain(|(time, _)| now - time < LONGEST_S);
        }
    }

    fn of_throw() -> Self {
        Self {
            is_thrown: true,
            ..Self::default()
        }
    }

    fn is_due(&self, now: f64) -> bool {
        let last = self.moments.last();
        last.is_none_or(|(time, _)| now - time >= (1.0 - 1e-6) / RATE_HZ)
    }

    /// The pins are counted: what is remembered is shown from now on.
    fn begin(&mut self, now: f64) {
        self.is_thrown = false;
        let middle = self.first_hit.unwrap_or(now - AFTER_S);
        let span = [middle - BEFORE_S, (middle + AFTER_S).min(now)];
        self.shown = Some((now, span));
    }

    /// What is shown at the game's time `now` [s], at the pace at which it happened.
    pub fn at(&self, now: f64) -> Option<Moment> {
        let (since, [from, to]) = self.shown?;
        let time = from + (now - since);
        let after = self.moments.partition_point(|(at, _)| *at <= time);
        let (_, moment) = self.moments.get(after.checked_sub(1)?)?;
        (time <= to).then(|| Arc::clone(moment))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::devices::script::Velocities;
    use crate::rehearsal::rehearse;
    use game::{Button, Conditions};
    use std::path::Path;

    /// The ball's way and the pins' are shown as they were, a known time later.
    #[test]
    fn a_throw_is_shown_again_as_it_was_once_its_pins_are_counted() {
        let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("config");
        let conditions = Conditions::load(&folder, "test", &[]).unwrap();
        let mut again = Again::default();
        // What was seen when, who was struck and counted when, and what was shown when.
        let (mut seen, mut shown) = (Vec::new(), Vec::new());
        let (mut struck, mut counted) = (None, None);
        rehearse(
            &conditions,
            1,
            3,
            Velocities::Measured,
            &[Button::Red],
            |game| {
                if counted.is_none() {
                    seen.push((game.time(), pins_and_balls(&game.visible())));
                }
                for event in game.events() {
                    match event.kind {
                        EventKind::FirstHit { .. } => struck = struck.or(Some(game.time())),
                        EventKind::Rolled { .. } => counted = counted.or(Some(game.time())),
                        _ => {}
                    }
                }
                again.notice(game);
                let moment = again.at(game.time());
                if counted.is_none() {
                    assert!(
                        moment.is_none(),
                        "at {} s nothing was counted yet",
                        game.time()
                    );
                } else if let Some(moment) = moment {
                    shown.push((game.time(), pins_and_balls(&moment)));
                }
            },
        )
        .unwrap();
        let (struck, counted) = (struck.unwrap(), counted.unwrap());
        let first = &shown[0];
        assert_eq!(first.0, counted, "it begins when the pins are counted");
        let delay = counted - (struck - BEFORE_S);
        for (time, things) in shown
            .iter()
            .take_while(|(time, _)| time - counted < BEFORE_S + AFTER_S)
        {
            let then = time - delay;
            let at = seen.partition_point(|(at, _)| *at <= then);
            let earlier = &seen[at.saturating_sub(4)..(at + 1).min(seen.len())];
            assert!(
                earlier.iter().any(|(_, as_it_was)| as_it_was == things),
                "what is shown at {time} s was not seen at {then} s"
            );
        }
        let last = shown
            .iter()
            .rfind(|(time, _)| time - counted <= BEFORE_S + AFTER_S);
        let length = last.unwrap().0 - counted;
        assert!(length > BEFORE_S + 0.5, "{length} s are shown");
    }

    fn pins_and_balls(things: &[Visible]) -> Vec<[f64; 3]> {
        let moving = things
            .iter()
            .filter(|thing| matches!(thing.model, Model::Pin(_) | Model::Ball(_)));
        moving.map(|thing| thing.pose.position.to_array()).collect()
    }
}
