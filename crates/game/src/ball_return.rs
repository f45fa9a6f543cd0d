//! The way of the balls back to the rack: below the floor, then up a lift into their own cell.

use glam::DVec3;
use hecs::Entity;
use physics::Pose;

use crate::Game;
use crate::alley;
use crate::components::{Ball, Journey};
use crate::event::EventKind;
use crate::room::Room;
use crate::throw::Stage;

/// A ball lies in its cell while its centre is no farther than this from the cell's [m].
const CELL: f64 = 0.08;

/// How far below its cell the lift takes a ball [m].
const LIFT: f64 = 0.35;

impl Game {
    /// Moves the balls that are on their way back, and fetches those that lie about.
    pub(crate) fn return_strays(&mut self) {
        for entity in self.room.balls.clone() {
            let mut ball: Ball = self.room.get(entity);
            match ball.journey {
                Journey::InRoom => self.mind(entity),
                Journey::Below(since) => {
                    if self.steps
                        >= since + self.room.steps_in(self.room.config.pinsetter.ball_return_s)
                    {
                        ball.journey = Journey::Lift(self.steps);
                        self.room.set(entity, ball);
                        self.room.set_hidden(entity, false);
                    }
                }
                Journey::Lift(since) => self.lift(entity, since),
            }
        }
    }

    /// Puts a ball on its way back.
    pub(crate) fn send_back(&mut self, entity: Entity) {
        let mut ball: Ball = self.room.get(entity);
        ball.journey = Journey::Below(self.steps);
        ball.astray_since = None;
        ball.foul = None;
        ball.is_beyond = false;
        ball.is_spent = false;
        self.room.set(entity, ball);
        self.room.set_hidden(entity, true);
        self.room.take_out(entity);
        let id = self.room.id(entity);
        let below = Pose::from_position(ball.home - DVec3::Y * LIFT);
        self.room.world.set_pose(id, below);
    }

    /// Sends a ball back that has lain about for too long, or that nobody can reach any more.
    fn mind(&mut self, entity: Entity) {
        let mut ball: Ball = self.room.get(entity);
        let is_held = self.hand.held.is_some_and(|held| held.entity == entity);
        let is_thrown = matches!(&self.stage, Stage::Rolling(throw) if throw.ball == entity);
        let body = self.room.body(entity);
        let at = body.pose().position;
        let is_home = at.distance(ball.home) < CELL;
        if body.is_frozen() || (!is_held && is_outside(&self.room, at)) {
            self.send_back(entity);
            return;
        }
        let astray = !is_held && !is_home && !is_thrown;
        let since = astray.then(|| ball.astray_since.unwrap_or(self.steps));
        if since != ball.astray_since {
            ball.astray_since = since;
            self.room.set(entity, ball);
        }
        let patience = self.room.steps_in(self.room.config.rules.stray_ball_s);
        if since.is_some_and(|since| self.steps >= since + patience) {
            self.send_back(entity);
        }
    }

    /// Raises a ball into its cell.
    fn lift(&mut self, entity: Entity, since: u64) {
        let mut ball: Ball = self.room.get(entity);
        let steps = self
            .room
            .steps_in(self.room.config.pinsetter.ball_lift_s)
            .max(1);
        let share = (self.steps - since) as f64 / steps as f64;
        let id = self.room.id(entity);
        if share < 1.0 {
            let pose = Pose::from_position(ball.home - DVec3::Y * (LIFT * (1.0 - share)));
            self.room.world.drive_to(id, pose);
            return;
        }
        ball.journey = Journey::InRoom;
        self.room.set(entity, ball);
        self.room.world.set_pose(id, Pose::from_position(ball.home));
        self.room.let_loose(entity);
        self.record(EventKind::BallReturned { ball: ball.index });
    }
}

/// Whether a point lies where no participant gets to.
fn is_outside(room: &Room, at: DVec3) -> bool {
    let config = &room.config;
    let rear = alley::cushion_z(config) - config.pit.cushion_thickness_m;
    at.y < -1.0
        || at.y > config.room.height_m
        || at.x.abs() > config.room.half_width_m
        || !(rear..config.room.depth_m).contains(&at.z)
}
