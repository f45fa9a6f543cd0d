//! The stop sign: hangs over the desk while a study's session is played, and ends it when somebody points at it and holds the
//! trigger. One action, always in sight, and nothing that a throw does by accident.

use anyhow::Result;
use experiment::protocol::Who;
use game::Game;
use glam::{DQuat, DVec2, DVec3};
use physics::Pose;

use super::{Pointing, share};
use crate::session::Session;
use crate::trigger::PULLED;

/// Size of the sign [m].
pub const SIZE_M: DVec2 = DVec2::new(0.48, 0.32);
/// How far above the buttons its middle is [m].
const ABOVE_M: f64 = 0.45;
/// How long the trigger has to be held on it [s].
const HOLD_S: f64 = 1.0;

/// The stop sign, whether it hangs or not.
#[derive(Debug, Default)]
pub struct StopSign {
    /// Where it hangs; `None` while nothing is played.
    pub pose: Option<Pose>,
    /// Since when it is held, in simulated time [s].
    held_since: Option<f64>,
}

impl StopSign {
    /// Hangs it up or takes it down, and ends the session when it was held for long enough.
    ///
    /// # Errors
    /// When the journal cannot be written.
    pub fn attend(&mut self, session: &mut Session, pointing: Option<Pointing>) -> Result<()> {
        let is_played = session
            .course()
            .is_some_and(|course| course.protocol().is_played());
        self.pose = is_played.then(|| over_the_desk(session.game()));
        let is_held = match (self.pose, pointing) {
            (Some(pose), Some(pointing)) => {
                let is_pulled = session.trigger() > PULLED;
                is_pulled && session.game().held().is_none() && is_on(&pose, &pointing)
            }
            _ => false,
        };
        if !is_held {
            self.held_since = None;
            return Ok(());
        }
        let now = session.game().time();
        if now - *self.held_since.get_or_insert(now) < HOLD_S {
            return Ok(());
        }
        session.stop(Who::Participant, "held the stop sign".to_owned())
    }
}

/// Whether the participant points at the sign.
fn is_on(sign: &Pose, pointing: &Pointing) -> bool {
    let at = pointing
        .hand
        .and_then(|hand| share(sign, SIZE_M, pointing.head.position, hand.position));
    at.is_some()
}

/// Above the buttons, facing who stands on the approach.
fn over_the_desk(game: &Game) -> Pose {
    over(game.config())
}

/// Where it hangs in a room.
pub(super) fn over(config: &game::Config) -> Pose {
    let desk = &config.desk;
    let top = desk.height_m + desk.button_travel_m;
    let position = DVec3::new(desk.x_m, top + ABOVE_M, desk.z_m);
    let way = DVec3::new(-position.x, 0.0, 1.0);
    let yaw = libm::atan2(way.x, way.z);
    Pose {
        position,
        rotation: DQuat::from_rotation_y(yaw),
    }
}
