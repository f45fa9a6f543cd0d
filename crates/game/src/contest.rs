//! Games of bowling: which button's game is played, what the next delivery is, what the sheets say.

use crate::components::PushButton;
use crate::condition::Button;
use crate::config::Config;
use crate::event::EventKind;
use crate::room::Room;
use crate::score::{Delivery, Roll, ScoreSheet};
use crate::throw::Stage;
use crate::{Game, GameError, differing};

/// A press that waits for its confirmation.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Pending {
    pub button: Button,
    pub until: u64,
}

impl Game {
    /// The next delivery of the game that is played.
    pub(crate) fn delivery(&self) -> Option<Delivery> {
        self.playing
            .and_then(|button| self.sheet(button).next_delivery())
    }

    /// Acts on presses: starts a game, or asks for a second press while one is played; refuses those of locked buttons.
    pub(crate) fn press(&mut self, locked: [bool; 2]) {
        if self
            .pending
            .is_some_and(|pending| self.steps > pending.until)
        {
            self.pending = None;
        }
        for button in std::mem::take(&mut self.pressed) {
            if locked[button as usize] {
                self.record(EventKind::Refused { button });
                continue;
            }
            self.record(EventKind::Pressed { button });
            let is_confirmed = self.pending.is_some_and(|pending| pending.button == button);
            if self.playing.is_none() || is_confirmed {
                self.start_game(button);
            } else {
                let wait = self.room.steps_in(self.room.config.rules.confirm_within_s);
                self.pending = Some(Pending {
                    button,
                    until: self.steps + wait,
                });
                self.record(EventKind::ConfirmAsked { button });
            }
        }
    }

    /// Builds the room of a button's condition and begins a new sheet.
    fn start_game(&mut self, button: Button) {
        let room = Room::new(self.conditions.of(button))
            .expect("every condition's room was built once when the session began");
        self.enter(room);
        self.playing = Some(button);
        *self.sheet_mut(button) = ScoreSheet::new(self.frames);
        self.record(EventKind::GameStarted { button });
    }

    /// Lays the alley out anew with `config`, between two inputs: all pins stand, the balls lie on their rack, nothing is in the
    /// hand, no game is played. Nothing is recorded: who plays the inputs again does the same before the same input.
    ///
    /// # Errors
    /// When something differs that a session has once, or physics refuses a setting; nothing has changed then.
    pub fn lay_out(&mut self, config: &Config) -> Result<(), GameError> {
        let config = self.within_reach(config);
        if let Some(setting) = differing(&config, &self.conditions.lobby) {
            return Err(GameError::DifferingCondition(setting));
        }
        let room = Room::new(&config)?;
        self.enter(room);
        self.playing = None;
        Ok(())
    }

    /// Goes on in another room. What the hand held stays behind in the old one.
    pub(crate) fn enter(&mut self, room: Room) {
        let buttons = self
            .room
            .buttons
            .map(|entity| self.room.get::<PushButton>(entity));
        self.room = room;
        // The hand that pressed is still on the button: in the new room it must not press again.
        for (entity, before) in self.room.buttons.into_iter().zip(buttons) {
            let mut button: PushButton = self.room.get(entity);
            button.is_pressed = before.is_pressed;
            self.room.set(entity, button);
        }
        self.stage = Stage::Ready {
            disturbed_since: None,
        };
        self.pending = None;
        // Entities of the old room are nobody in the new one.
        (self.let_go, self.last_throw) = (None, None);
        self.hand.held = None;
        self.hand.let_go = None;
        self.hand.candidate = None;
        // The new room's hand has been nowhere yet: it appears where it is.
        self.hand.before = None;
        self.place_hand();
    }

    /// Writes a delivery on the sheet; returns whether the next one needs a full rack.
    pub(crate) fn score(&mut self, fallen: u8, is_foul: bool) -> bool {
        let (Some(button), Some(delivery)) = (self.playing, self.delivery()) else {
            // Practice: one ball at ten pins, again and again.
            return true;
        };
        let roll = Roll {
            fallen: fallen.min(delivery.standing),
            foul: is_foul,
        };
        let sheet = self.sheet_mut(button);
        sheet
            .add(roll)
            .expect("no more pins are counted than stood");
        let next = sheet.next_delivery();
        let frame_is_over = next.is_none_or(|next| next.frame != delivery.frame);
        let marks = sheet.marks().pop().unwrap_or_default();
        let total = sheet.total();
        let (frame, ball) = (delivery.frame, delivery.ball);
        self.record(EventKind::Rolled {
            button,
            frame,
            ball,
            roll,
        });
        if frame_is_over {
            self.record(EventKind::FrameScored {
                button,
                frame,
                marks,
                total,
            });
        }
        if next.is_none() {
            self.record(EventKind::GameOver { button, total });
            self.playing = None;
            self.pending = None;
        }
        next.is_none_or(|next| next.standing == crate::score::PINS)
    }

    fn sheet(&self, button: Button) -> &ScoreSheet {
        &self.sheets[button as usize]
    }

    fn sheet_mut(&mut self, button: Button) -> &mut ScoreSheet {
        &mut self.sheets[button as usize]
    }
}
