//! A pause, and the way back to the start: what a participant asks of the session instead of the alley.

use glam::{DQuat, DVec2, DVec3};
use physics::Pose;

use crate::Game;
use crate::event::EventKind;
use crate::input::Input;
use crate::walk::heading;

impl Game {
    /// What of an input counts: in a pause the head alone, and no step is taken.
    pub(crate) fn heed_pause(&mut self, input: &Input) -> Input {
        if input.paused != self.is_paused {
            self.is_paused = input.paused;
            self.record(if input.paused {
                EventKind::Paused
            } else {
                EventKind::Resumed
            });
        }
        if !input.paused {
            return *input;
        }
        Input {
            head: input.head,
            locked: input.locked,
            recentred: input.recentred,
            recentre: input.recentre,
            is_left: input.is_left,
            paused: true,
            ..Input::default()
        }
    }

    /// Lays tracking space so that the head is where a session begins, and looks down the lane; heights stay.
    pub(crate) fn go_to_start(&mut self, input: &Input) {
        let Some(head) = self.head.filter(|_| input.recentre) else {
            return;
        };
        let start = &self.room.config.start;
        let ahead = heading(head.pose);
        // The angle from the lane's direction to the heading, to the left.
        let turn = DQuat::from_rotation_y(-DVec2::new(-ahead.z, -ahead.x).to_angle());
        let away = turn * head.pose.position;
        self.world_from_tracking = Pose {
            position: DVec3::new(
                start.x_m - away.x,
                self.world_from_tracking.position.y,
                start.z_m - away.z,
            ),
            rotation: turn,
        };
        self.walking_speed = 0.0;
        self.record(EventKind::WentToStart);
    }
}
