//! What the hand feels: a pulse for the strongest of what happened to it in a frame.

use game::{Event, EventKind, Model};
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

/// The pulse for what happened to the hand, or to what it held; `None` when nothing did.
pub fn of(events: &[Event], held: Option<Model>) -> Option<Pulse> {
    events
        .iter()
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

    #[test]
    fn a_refused_press_is_felt_lightly_and_one_that_is_taken_is_not() {
        let event = |kind| [Event { step: 1, kind }];
        let button = Button::Red;
        let refused = of(&event(EventKind::Refused { button }), None).expect("it is felt");
        let grabbed = of(
            &event(EventKind::Grabbed {
                model: Model::Ball(0),
            }),
            None,
        );
        assert!(refused.amplitude < grabbed.expect("it is felt").amplitude);
        assert_eq!(of(&event(EventKind::Pressed { button }), None), None);
    }

    #[test]
    fn an_impact_is_felt_by_its_impulse_and_only_in_the_hand() {
        let held = Some(Model::Ball(0));
        let strength = |impulse| of(&[impact(Model::Ball(0), impulse)], held).map(|p| p.amplitude);
        assert!(strength(0.5) < strength(2.0) && strength(2.0) < strength(8.0));
        assert_eq!(strength(50.0), Some(1.0));
        assert_eq!(strength(0.01), None);
        assert_eq!(of(&[impact(Model::Pin(3), 8.0)], held), None);
    }
}
