//! The Red and Blue buttons: things on the desk that a hand pushes down.

use physics::Pose;

use crate::Game;
use crate::components::PushButton;
use crate::condition::Button;
use crate::config::DeskConfig;
use crate::room::button_pose;

/// A button counts as up again at this share of the depression that counts as pressed, so that a trembling hand presses once.
const REARM: f64 = 0.5;

impl Game {
    /// Pushes the buttons down as far as the hand is in them, and notes a press on the way down.
    pub(crate) fn push_buttons(&mut self, share: f64) {
        let hand = match (self.hand.before, self.hand.now) {
            (Some(before), Some(now)) => Some(before.position.lerp(now.position, share)),
            (_, now) => now.map(|now: Pose| now.position),
        };
        for (button, entity) in Button::BOTH.into_iter().zip(self.room.buttons) {
            let config = &self.room.config;
            let mut state: PushButton = self.room.get(entity);
            let depression = hand.map_or(0.0, |hand| {
                depression(&config.desk, config.hand.radius_m, &state, hand)
            });
            if depression == state.depression {
                continue;
            }
            let threshold = config.desk.button_press_at * config.desk.button_travel_m;
            if depression >= threshold && !state.is_pressed {
                state.is_pressed = true;
                self.pressed.push(button);
            } else if depression < REARM * threshold {
                state.is_pressed = false;
            }
            state.depression = depression;
            let pose = button_pose(config, &state);
            self.room.set(entity, state);
            let id = self.room.id(entity);
            self.room.world.drive_to(id, pose);
        }
    }
}

/// How far a hand pushes a button down [m].
fn depression(desk: &DeskConfig, hand_radius: f64, button: &PushButton, hand: glam::DVec3) -> f64 {
    let from_foot = hand - button.foot;
    let beside = (from_foot.x * from_foot.x + from_foot.z * from_foot.z).sqrt();
    // A hand under the desk's top is not on the button.
    if beside > desk.button_radius_m || from_foot.y < 0.0 {
        return 0.0;
    }
    (desk.button_travel_m + hand_radius - from_foot.y).clamp(0.0, desk.button_travel_m)
}
