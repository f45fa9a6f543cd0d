//! What the hands feel: a pulse for the strongest of what happened to each in a frame.

use game::{Button, Event, EventKind, Model};
use renderer::headset::Side;
use serde_json::{Value, json};

/// One pulse of the controller.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pulse {
    /// From 0 to 1.
    pub amplitude: f32,
    /// How long [s].
    pub seconds: f64,
}

impl Pulse {
    /// Its line in the journal, once a hand has had it: what is felt is a cue as what is seen and heard is.
    pub fn line(self, side: Side) -> Value {
        json!({ "pulse": {
            "hand": format!("{side:?}").to_lowercase(),
            "amplitude": self.amplitude,
            "seconds": self.seconds,
        }})
    }
}

/// The impulse that is felt as strongly as a controller can [N s]: a 15 lb ball that is knocked against a wall at 1.5 m/s.
const STRONGEST_IMPULSE: f64 = 10.0;

/// Who presses Red and Blue. The game is told of a press and not by whom; each has a way of its own to the game.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Presses {
    /// The thumb of the hand that does not play, in this frame and in the one before.
    thumb: [[bool; 2]; 2],
    /// The experimenter, by key.
    key: [bool; 2],
}

impl Presses {
    /// A frame in which these buttons were held down by the thumb, and by the experimenter's keys.
    pub fn follow(&mut self, thumb: [bool; 2], key: [bool; 2]) {
        let [now, _] = self.thumb;
        *self = Self {
            thumb: [thumb, now],
            key,
        };
    }

    /// Who has pressed a button in this frame: what neither thumb nor key went down for was pushed down in the room.
    fn by(&self, button: Button) -> Option<Whose> {
        let [now, before] = self.thumb.map(|down| down[button as usize]);
        match (now && !before, self.key[button as usize]) {
            (true, _) => Some(Whose::Other),
            (false, true) => None,
            (false, false) => Some(Whose::Playing),
        }
    }
}

/// Of which hand.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Whose {
    /// The one that throws, and that is in the room.
    Playing,
    /// The one beside it.
    Other,
}

/// The pulse for what happened to one of the hands, or to what it held; `None` when nothing did.
pub fn of(events: &[Event], held: Option<Model>, presses: &Presses, whose: Whose) -> Option<Pulse> {
    let is_felt = |kind: &EventKind| match kind {
        EventKind::Refused { button } => presses.by(*button) == Some(whose),
        _ => whose == Whose::Playing,
    };
    events
        .iter()
        .filter(|event| is_felt(&event.kind))
        .filter_map(|event| felt(&event.kind, held))
        .max_by(|a, b| a.amplitude.total_cmp(&b.amplitude))
}

fn felt(kind: &EventKind, held: Option<Model>) -> Option<Pulse> {
    let pulse = |amplitude, seconds| Some(Pulse { amplitude, seconds });
    match kind {
        EventKind::Touched { .. } => pulse(0.2, 0.015),
        EventKind::Grabbed { .. } => pulse(0.6, 0.04),
        EventKind::Released(_) => pulse(0.4, 0.025),
        // Light and long: unlike a grip or a blow.
        EventKind::Refused { .. } => pulse(0.25, 0.08),
        EventKind::Impact { a, b, impulse, .. } => {
            let is_mine = |model: &Model| *model == Model::Hand || Some(*model) == held;
            let share = (impulse / STRONGEST_IMPULSE).min(1.0);
            (is_mine(a) || is_mine(b))
                .then_some(share)
                .filter(|share| *share > 0.01)
                .and_then(|share| pulse(share.sqrt() as f32, 0.01 + 0.03 * share))
        }
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use game::Button;
    use glam::DVec3;

    fn impact(a: Model, impulse: f64) -> Event {
        Event {
            step: 1,
            kind: EventKind::Impact {
                a,
                b: Model::Lane,
                point: DVec3::ZERO,
                approach_speed: 1.0,
                impulse,
            },
        }
    }

    /// What the hand that plays feels, where nobody presses anything.
    fn played(events: &[Event], held: Option<Model>) -> Option<Pulse> {
        of(events, held, &Presses::default(), Whose::Playing)
    }

    #[test]
    fn a_refused_press_is_felt_lightly_and_one_that_is_taken_is_not() {
        let event = |kind| [Event { step: 1, kind }];
        let button = Button::Red;
        let refused = played(&event(EventKind::Refused { button }), None).expect("it is felt");
        let grabbed = played(
            &event(EventKind::Grabbed {
                model: Model::Ball(0),
            }),
            None,
        );
        assert!(refused.amplitude < grabbed.expect("it is felt").amplitude);
        assert_eq!(played(&event(EventKind::Pressed { button }), None), None);
    }

    /// Whether the hand that plays feels a refused press of Red, and whether the other does.
    fn feel_a_refused_red(presses: &Presses) -> [bool; 2] {
        let kind = EventKind::Refused {
            button: Button::Red,
        };
        let events = [Event { step: 1, kind }];
        [Whose::Playing, Whose::Other].map(|whose| of(&events, None, presses, whose).is_some())
    }

    #[test]
    fn a_refused_press_is_felt_by_the_hand_that_pressed() {
        let [none, red, blue] = [[false; 2], [true, false], [false, true]];
        let mut presses = Presses::default();
        assert_eq!(feel_a_refused_red(&presses), [true, false], "in the room");
        presses.follow(red, none);
        assert_eq!(feel_a_refused_red(&presses), [false, true], "by the thumb");
        presses.follow(red, none);
        assert_eq!(
            feel_a_refused_red(&presses),
            [true, false],
            "the thumb is still down, and the hand pushes the button in the room"
        );
        presses.follow(blue, red);
        assert_eq!(feel_a_refused_red(&presses), [false; 2], "by the key");
        presses.follow(blue, none);
        assert_eq!(feel_a_refused_red(&presses), [true, false], "Blue's thumb");
    }

    #[test]
    fn what_happens_to_the_hand_that_plays_is_not_felt_by_the_other() {
        let events = [impact(Model::Hand, 8.0)];
        let other = of(&events, None, &Presses::default(), Whose::Other);
        assert!(played(&events, None).is_some() && other.is_none());
    }

    #[test]
    fn an_impact_is_felt_by_its_impulse_and_only_in_the_hand() {
        let held = Some(Model::Ball(0));
        let strength =
            |impulse| played(&[impact(Model::Ball(0), impulse)], held).map(|p| p.amplitude);
        assert!(strength(0.5) < strength(2.0) && strength(2.0) < strength(8.0));
        assert_eq!(strength(50.0), Some(1.0));
        assert_eq!(strength(0.01), None);
        assert_eq!(played(&[impact(Model::Pin(3), 8.0)], held), None);
    }
}
