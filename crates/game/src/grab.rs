//! Grab and release: the trigger closes the hand on the nearest thing within reach, and opens it.

use glam::DVec3;
use hecs::Entity;
use physics::{Motion, Pose};

use crate::Game;
use crate::components::{Ball, Held, Journey, Pin, PinKeeper};
use crate::event::{EventKind, Release, ReleaseSource, ReleaseVelocity};
use crate::hand::surface_distance;
use crate::input::Input;
use crate::release;
use crate::room::Room;

/// How often a held thing is pushed out of the boxes that it is carried into; corners take more than one.
const PUSHES: usize = 3;

impl Game {
    /// Closes or opens the hand. Without a tracked hand the grip stays as it was.
    pub(crate) fn grip(&mut self, input: &Input) {
        let Some(hand) = self.hand.now else {
            self.hand.candidate = None;
            return;
        };
        let config = &self.room.config.hand;
        let (closes, opens) = (
            input.trigger >= config.trigger_close,
            input.trigger <= config.trigger_open,
        );
        if self.hand.held.is_none() {
            self.hand.candidate = nearest(&self.room, hand);
        }
        if closes && !self.hand.is_closed {
            self.hand.is_closed = true;
            if let Some(entity) = self.hand.candidate {
                self.grab(entity, hand);
            }
        } else if opens && self.hand.is_closed {
            self.hand.is_closed = false;
            self.release(hand);
        }
    }

    /// The hand takes hold of a thing as it lies to it now.
    fn grab(&mut self, entity: Entity, hand: Pose) {
        let id = self.room.id(entity);
        let hand_from_body = hand.inverse() * self.room.world.body(id).pose();
        self.room.world.set_motion(id, Motion::Driven);
        self.room.world.set_velocity(id, DVec3::ZERO, DVec3::ZERO);
        self.hand.held = Some(Held {
            entity,
            hand_from_body,
        });
        self.hand.let_go = None;
        self.set_foul(entity, None);
        let model = self.room.model(entity);
        self.record(EventKind::Grabbed { model });
    }

    /// The hand lets go: the thing flies on as the hand carried its centre.
    fn release(&mut self, hand: Pose) {
        let Some(held) = self.hand.held.take() else {
            return;
        };
        let id = self.room.id(held.entity);
        let position = self.room.world.body(id).pose().position;
        let arm = position - hand.position;
        let config = &self.room.config.release;
        let (measured, fitted) =
            release::estimate(&self.hand.history, self.hand.velocity, arm, config);
        let (used, source) = match (measured, fitted) {
            (Some(measured), _) => (measured, ReleaseSource::Velocity),
            (None, Some(fitted)) => (fitted, ReleaseSource::Poses),
            // The tracker has only just found the hand: it has no motion yet.
            (None, None) => (
                ReleaseVelocity {
                    linear: DVec3::ZERO,
                    angular: DVec3::ZERO,
                },
                ReleaseSource::Poses,
            ),
        };
        self.room.world.set_motion(id, Motion::Dynamic);
        self.room.world.set_velocity(id, used.linear, used.angular);
        self.hand.let_go = Some(held.entity);
        let is_foul = self.head_is_beyond();
        self.set_foul(held.entity, Some(is_foul));
        self.record(EventKind::Released(Release {
            model: self.room.model(held.entity),
            used,
            source,
            from_velocity: measured,
            from_poses: fitted,
            speed: used.linear.length(),
            position,
        }));
    }

    /// Notes on a ball where the head was at its release.
    fn set_foul(&self, entity: Entity, foul: Option<bool>) {
        if let Ok(mut ball) = self.room.ecs.get::<&mut Ball>(entity) {
            ball.foul = foul;
            ball.is_beyond = false;
        }
    }
}

/// The nearest thing that the hand could close on.
fn nearest(room: &Room, hand: Pose) -> Option<Entity> {
    let things = room.pins.iter().chain(&room.balls).copied();
    things
        .filter(|entity| is_free(room, *entity))
        .map(|entity| (surface_distance(room, entity, hand), entity))
        .filter(|(distance, _)| *distance <= room.config.hand.reach_m)
        .min_by(|(a, _), (b, _)| a.total_cmp(b))
        .map(|(_, entity)| entity)
}

/// Whether no machine has it.
fn is_free(room: &Room, entity: Entity) -> bool {
    if let Ok(pin) = room.ecs.get::<&Pin>(entity) {
        return pin.keeper == PinKeeper::Nobody;
    }
    room.ecs
        .get::<&Ball>(entity)
        .is_ok_and(|ball| ball.journey == Journey::InRoom)
}

/// The pose nearest to `target` in which a held thing does not reach into the building: a hand can pass through a floor, a
/// ball must not be let go inside it.
pub(crate) fn kept_out(room: &Room, entity: Entity, target: Pose) -> Pose {
    let compound = room.body(entity).compound();
    let mut pose = target;
    for _ in 0..PUSHES {
        let mut deepest: Option<(f64, DVec3)> = None;
        for (box_pose, half, shape) in &room.obstacles {
            let local = box_pose.inverse().transform_point(pose.position);
            let outside = (local - local.clamp(-*half, *half)).length();
            if outside > compound.bounding_radius() {
                continue;
            }
            for part in compound.parts() {
                let part_pose = pose * part.pose;
                let limits = physics::query::Limits::default();
                let found = physics::query::separation(
                    (shape, box_pose),
                    (&part.shape, &part_pose),
                    None,
                    limits,
                );
                if found.gap < deepest.map_or(0.0, |(gap, _)| gap) {
                    deepest = Some((found.gap, found.normal));
                }
            }
        }
        let Some((gap, normal)) = deepest else { break };
        pose.position -= normal * gap;
    }
    pose
}
