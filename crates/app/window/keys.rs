//! What keys and mouse mean. The tests hold the help and the README against the table of keys.

use glam::DVec2;
use winit::dpi::PhysicalSize;
use winit::event::{ElementState, MouseButton, MouseScrollDelta, WindowEvent};
use winit::keyboard::{KeyCode, PhysicalKey};

use crate::devices::desk::{DeskEvent, Hold};

/// What a key does.
#[derive(Clone, Copy, Debug)]
enum Meaning {
    /// Acts while it is held.
    Hold(Hold),
    /// Acts once when it goes down.
    Once(Command),
}

/// Every key that means something.
const KEYS: [(KeyCode, Meaning); 15] = [
    (KeyCode::KeyW, Meaning::Hold(Hold::Forward)),
    (KeyCode::KeyS, Meaning::Hold(Hold::Back)),
    (KeyCode::KeyA, Meaning::Hold(Hold::TurnLeft)),
    (KeyCode::ArrowLeft, Meaning::Hold(Hold::TurnLeft)),
    (KeyCode::KeyD, Meaning::Hold(Hold::TurnRight)),
    (KeyCode::ArrowRight, Meaning::Hold(Hold::TurnRight)),
    (KeyCode::Digit1, RED),
    (KeyCode::Numpad1, RED),
    (KeyCode::Digit2, BLUE),
    (KeyCode::Numpad2, BLUE),
    (
        KeyCode::KeyP,
        Meaning::Once(Command::Desk(DeskEvent::Pause)),
    ),
    (
        KeyCode::KeyR,
        Meaning::Once(Command::Desk(DeskEvent::Recentre)),
    ),
    (KeyCode::F1, Meaning::Once(Command::Help)),
    (KeyCode::F3, Meaning::Once(Command::Cost)),
    (KeyCode::Escape, Meaning::Once(Command::End)),
];

const RED: Meaning = Meaning::Once(Command::Desk(DeskEvent::Press(game::Button::Red)));
const BLUE: Meaning = Meaning::Once(Command::Desk(DeskEvent::Press(game::Button::Blue)));

/// Pixels of a touchpad that count as one notch of a wheel.
const PIXELS_PER_NOTCH: f64 = 40.0;

/// What an event of the window asks for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Command {
    /// Something for the desk.
    Desk(DeskEvent),
    /// The keyboard went elsewhere: keys that are down will not be seen to go up.
    LetGo,
    /// Show or hide the help.
    Help,
    /// Show or hide what frames and physics cost.
    Cost,
    /// End the session and save.
    End,
}

/// Turns window events into commands; remembers what a drag needs.
#[derive(Debug, Default)]
pub struct Keys {
    cursor: Option<DVec2>,
    is_looking: bool,
}

impl Keys {
    /// The command in `event`, for a window of `size` pixels.
    pub fn command(&mut self, event: &WindowEvent, size: PhysicalSize<u32>) -> Option<Command> {
        match event {
            WindowEvent::CloseRequested => Some(Command::End),
            WindowEvent::Focused(false) => {
                self.is_looking = false;
                Some(Command::LetGo)
            }
            WindowEvent::KeyboardInput { event, .. } => {
                let PhysicalKey::Code(code) = event.physical_key else {
                    return None;
                };
                key(code, event.state.is_pressed(), event.repeat)
            }
            WindowEvent::MouseInput { state, button, .. } => self.button(*button, *state),
            WindowEvent::CursorMoved { position, .. } => {
                self.moved(DVec2::new(position.x, position.y), size)
            }
            WindowEvent::MouseWheel { delta, .. } => {
                let notches = match delta {
                    MouseScrollDelta::LineDelta(_, lines) => f64::from(*lines),
                    MouseScrollDelta::PixelDelta(pixels) => pixels.y / PIXELS_PER_NOTCH,
                };
                Some(Command::Desk(DeskEvent::Wheel(notches)))
            }
            _ => None,
        }
    }

    fn button(&mut self, button: MouseButton, state: ElementState) -> Option<Command> {
        match button {
            MouseButton::Left => Some(Command::Desk(DeskEvent::Grab(state.is_pressed()))),
            MouseButton::Right => {
                self.is_looking = state.is_pressed();
                None
            }
            _ => None,
        }
    }

    /// A drag with the right button turns the head and leaves the hand where it is.
    fn moved(&mut self, to: DVec2, size: PhysicalSize<u32>) -> Option<Command> {
        let from = self.cursor.replace(to).unwrap_or(to);
        if self.is_looking {
            return Some(Command::Desk(DeskEvent::Look(to - from)));
        }
        let half = 0.5 * DVec2::new(f64::from(size.width.max(1)), f64::from(size.height.max(1)));
        let at = (to - half) / half;
        Some(Command::Desk(DeskEvent::Cursor(DVec2::new(at.x, -at.y))))
    }
}

fn key(code: KeyCode, down: bool, is_repeat: bool) -> Option<Command> {
    let (_, meaning) = KEYS.iter().find(|(known, _)| *known == code)?;
    match meaning {
        Meaning::Hold(hold) => Some(Command::Desk(DeskEvent::Hold(*hold, down))),
        Meaning::Once(command) => (down && !is_repeat).then_some(*command),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const SIZE: PhysicalSize<u32> = PhysicalSize {
        width: 800,
        height: 600,
    };

    #[test]
    fn cursor_runs_from_minus_one_to_one_with_y_up() {
        let mut keys = Keys::default();
        let at = |keys: &mut Keys, x, y| keys.moved(DVec2::new(x, y), SIZE);
        let cursor = |x, y| Some(Command::Desk(DeskEvent::Cursor(DVec2::new(x, y))));
        assert_eq!(at(&mut keys, 0.0, 0.0), cursor(-1.0, 1.0));
        assert_eq!(at(&mut keys, 800.0, 600.0), cursor(1.0, -1.0));
        assert_eq!(at(&mut keys, 400.0, 150.0), cursor(0.0, 0.5));
    }

    #[test]
    fn a_right_drag_looks_and_does_not_move_the_hand() {
        let mut keys = Keys::default();
        keys.moved(DVec2::new(100.0, 100.0), SIZE);
        keys.button(MouseButton::Right, ElementState::Pressed);
        let look = keys.moved(DVec2::new(110.0, 95.0), SIZE);
        assert_eq!(
            look,
            Some(Command::Desk(DeskEvent::Look(DVec2::new(10.0, -5.0))))
        );
        keys.button(MouseButton::Right, ElementState::Released);
        let moved = keys.moved(DVec2::new(110.0, 95.0), SIZE);
        assert!(matches!(moved, Some(Command::Desk(DeskEvent::Cursor(_)))));
    }

    #[test]
    fn holding_a_button_key_presses_once() {
        let press = Some(Command::Desk(DeskEvent::Press(game::Button::Red)));
        assert_eq!(key(KeyCode::Digit1, true, false), press);
        assert_eq!(key(KeyCode::Digit1, true, true), None);
        assert_eq!(key(KeyCode::Digit1, false, false), None);
    }

    /// What is printed on a key.
    fn printed(code: KeyCode) -> String {
        let name = format!("{code:?}");
        match code {
            KeyCode::ArrowLeft | KeyCode::ArrowRight => "arrows".to_owned(),
            KeyCode::Escape => "Esc".to_owned(),
            _ => ["Key", "Digit", "Numpad"]
                .iter()
                .find_map(|start| name.strip_prefix(start))
                .unwrap_or(&name)
                .to_owned(),
        }
    }

    #[test]
    fn help_and_readme_name_every_key() {
        let words = crate::words::Words::shipped();
        let help = words.with_buttons(&words.window.help);
        let readme = include_str!("../../../README.md");
        let (_, readme) = readme.split_once("## Keys").expect("a section of keys");
        let (readme, _) = readme.split_once("\n## ").expect("another section");
        let others = ["mouse", "wheel", "left", "drag", "gamepad"];
        let names = KEYS.iter().map(|(code, _)| printed(*code));
        for name in names.chain(others.map(str::to_owned)) {
            for (place, text) in [("help", help.as_str()), ("README", readme)] {
                let mut words = text.split(|c: char| !c.is_alphanumeric());
                assert!(
                    words.any(|word| word == name),
                    "{name} is not in the {place}"
                );
            }
        }
    }
}
