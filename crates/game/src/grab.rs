//! Grab and release: the trigger closes the hand on the nearest thing within reach, and opens it.

use glam::DVec3;
use hecs::Entity;
use physics::query::{Limits, separation};
use physics::{Motion, Pose, Shape};

use crate::Game;
use crate::components::{Ball, Held, Journey, Pin, PinKeeper};
use crate::event::{EventKind, Release, ReleaseSource, ReleaseVelocity};
use crate::hand::surface_distance;
use crate::input::Input;
use crate::release;
use crate::room::Room;

/// How often a held thing is pushed out of the boxes that it is carried into; corners take more than one.
const PUSHES: usize = 3;

/// A held thing may reach this deep into a box [m]: where physics lets resting bodies lie.
const CONTACT: f64 = 1e-6;

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
        self.note_on_ball(entity, None);
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
        self.note_on_ball(held.entity, Some(is_foul));
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

    /// Notes on a ball that a hand has had it, and whether the head was beyond the foul line at its release.
    fn note_on_ball(&self, entity: Entity, foul: Option<bool>) {
        if let Ok(mut ball) = self.room.ecs.get::<&mut Ball>(entity) {
            ball.foul = foul;
            ball.is_beyond = false;
            ball.is_spent = false;
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
///
/// Each box that the target reaches into holds it back on the side where the thing is now, along the normal between the two;
/// the shallowest way out of a deep overlap would often be the far side.
pub(crate) fn kept_out(room: &Room, entity: Entity, target: Pose) -> Pose {
    let body = room.body(entity);
    let (compound, now) = (body.compound(), body.pose());
    let limits = Limits::default();
    let mut pose = target;
    for _ in 0..PUSHES {
        let mut is_clear = true;
        for (box_pose, half, shape) in &room.obstacles {
            let local = box_pose.inverse().transform_point(pose.position);
            let outside = (local - local.clamp(-*half, *half)).length();
            if outside > compound.bounding_radius() {
                continue;
            }
            for part in compound.parts() {
                let (part_now, part_then) = (now * part.pose, pose * part.pose);
                let overlap =
                    separation((shape, box_pose), (&part.shape, &part_then), None, limits).gap;
                if overlap < -CONTACT {
                    let normal =
                        separation((shape, box_pose), (&part.shape, &part_now), None, limits)
                            .normal;
                    let way_out = -gap_along(normal, (shape, box_pose), (&part.shape, &part_then));
                    pose.position += normal * way_out.max(0.0);
                    is_clear = false;
                }
            }
        }
        if is_clear {
            break;
        }
    }
    pose
}

/// Gap between the tangent planes of two shapes along a normal that points from the first to the second [m].
fn gap_along(normal: DVec3, (a, pose_a): (&Shape, &Pose), (b, pose_b): (&Shape, &Pose)) -> f64 {
    let farthest = |shape: &Shape, pose: &Pose, direction: DVec3| {
        pose.transform_point(shape.support(pose.rotation.conjugate() * direction))
    };
    normal.dot(farthest(b, pose_b, -normal) - farthest(a, pose_a, normal))
}
