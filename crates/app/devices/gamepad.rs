//! A gamepad as 3D mouse (§3 of the paper): sticks move the hand, two thumb buttons walk, the trigger grabs.

use super::desk::{DeskEvent, Gamepad};
use gilrs::{Axis, Button, EventType, Gilrs};

/// The gamepads of this machine; none is not an error.
pub struct Gamepads {
    source: Option<Gilrs>,
    state: PadState,
}

impl Gamepads {
    /// Opens the machine's gamepads. A system without gamepad support counts as one without gamepads.
    pub fn open() -> Self {
        Self {
            source: Gilrs::new().ok(),
            state: PadState::default(),
        }
    }

    /// Reads what happened since the last call: the state now, and presses of Red and Blue on the way.
    pub fn poll(&mut self) -> (Gamepad, Vec<DeskEvent>) {
        let mut presses = Vec::new();
        if let Some(source) = &mut self.source {
            while let Some(event) = source.next_event() {
                presses.extend(PadEvent::from_gilrs(event.event).and_then(|e| self.state.apply(e)));
            }
        }
        (self.state.pad, presses)
    }
}

/// The gilrs events that matter, without its hardware codes, so that recorded ones can be fed to tests.
#[derive(Clone, Copy, Debug, PartialEq)]
enum PadEvent {
    Button(Button, f32),
    Axis(Axis, f32),
    Gone,
}

impl PadEvent {
    fn from_gilrs(event: EventType) -> Option<Self> {
        match event {
            EventType::ButtonChanged(button, value, _) => Some(Self::Button(button, value)),
            EventType::AxisChanged(axis, value, _) => Some(Self::Axis(axis, value)),
            EventType::Disconnected => Some(Self::Gone),
            _ => None,
        }
    }
}

#[derive(Default)]
struct PadState {
    pad: Gamepad,
    red: bool,
    blue: bool,
}

impl PadState {
    /// Applies one event; a fresh press of Red or Blue is returned.
    fn apply(&mut self, event: PadEvent) -> Option<DeskEvent> {
        match event {
            PadEvent::Axis(Axis::LeftStickX, x) => self.pad.left_stick.x = f64::from(x),
            PadEvent::Axis(Axis::LeftStickY, y) => self.pad.left_stick.y = f64::from(y),
            PadEvent::Axis(Axis::RightStickX, x) => self.pad.right_stick.x = f64::from(x),
            PadEvent::Axis(Axis::RightStickY, y) => self.pad.right_stick.y = f64::from(y),
            PadEvent::Button(Button::RightTrigger2, value) => self.pad.trigger = f64::from(value),
            PadEvent::Button(Button::South, value) => self.pad.forward = value > 0.5,
            PadEvent::Button(Button::East, value) => self.pad.back = value > 0.5,
            PadEvent::Button(Button::West, value) => {
                return Self::edge(&mut self.red, value, game::Button::Red);
            }
            PadEvent::Button(Button::North, value) => {
                return Self::edge(&mut self.blue, value, game::Button::Blue);
            }
            // A pad that is unplugged while it walks must not walk on.
            PadEvent::Gone => *self = Self::default(),
            PadEvent::Axis(..) | PadEvent::Button(..) => {}
        }
        None
    }

    fn edge(was_down: &mut bool, value: f32, button: game::Button) -> Option<DeskEvent> {
        let down = value > 0.5;
        let pressed = down && !*was_down;
        *was_down = down;
        pressed.then_some(DeskEvent::Press(button))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DVec2;

    #[test]
    fn recorded_events_walk_grab_and_press_once() {
        let mut state = PadState::default();
        let recorded = [
            PadEvent::Axis(Axis::LeftStickX, 0.5),
            PadEvent::Axis(Axis::LeftStickY, -0.25),
            PadEvent::Button(Button::South, 1.0),
            PadEvent::Button(Button::RightTrigger2, 0.6),
            PadEvent::Button(Button::West, 1.0),
            PadEvent::Button(Button::West, 0.9),
            PadEvent::Button(Button::North, 1.0),
        ];
        let presses: Vec<_> = recorded
            .into_iter()
            .filter_map(|e| state.apply(e))
            .collect();
        assert_eq!(
            presses,
            [
                DeskEvent::Press(game::Button::Red),
                DeskEvent::Press(game::Button::Blue)
            ]
        );
        assert_eq!(state.pad.left_stick, DVec2::new(0.5, -0.25));
        assert!(state.pad.forward && !state.pad.back);
        assert_eq!(state.pad.trigger, f64::from(0.6_f32));
    }

    #[test]
    fn an_unplugged_pad_stops_walking() {
        let mut state = PadState::default();
        state.apply(PadEvent::Button(Button::South, 1.0));
        state.apply(PadEvent::Gone);
        assert_eq!(state.pad, Gamepad::default());
    }
}
