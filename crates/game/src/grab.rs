//! Grab and release: the trigger closes the hand on the nearest thing within reach, and opens it.

use glam::{DQuat, DVec3};
use hecs::Entity;
use physics::advance::{Travel, time_of_impact};
use physics::query::{Limits, separation};
use physics::{Motion, Pose, Shape};

use crate::Game;
use crate::assist;
use crate::components::{Ball, Held, Journey, Pin, PinKeeper, Shown};
use crate::event::{EventKind, Release, ReleaseSource, ReleaseVelocity};
use crate::hand::surface_distance;
use crate::holes;
use crate::input::{Input, Velocity};
use crate::release;
use crate::room::Room;
use crate::visible::Model;

/// How often a held thing is pushed out of the boxes that it is carried into; corners take more than one.
const PUSHES: usize = 3;

/// A held thing may reach this deep into a box [m]: where physics lets resting bodies lie.
const CONTACT: f64 = 1e-6;

impl Game {
    /// Where the hand lets go in this frame, when the device says at which instant the trigger opened.
    pub(crate) fn let_go_within(&self, input: &Input) -> Option<Moment> {
        let opens = input.trigger <= self.room.config.hand.trigger_open;
        let is_due = self.hand.held.is_some() && self.hand.is_closed && opens;
        let change = input
            .trigger_change
            .filter(|change| is_due && change.is_usable())?;
        let step_hz = self.room.config.physics.step_hz;
        let whole = ((change.age_s * step_hz) as u32).min(input.steps);
        // The participant may have walked on since.
        let mut rig = self.world_from_tracking;
        rig.position -= self.rig_velocity * change.age_s;
        Some(Moment {
            before_step: input.steps - whole + 1,
            lead_s: change.age_s - f64::from(whole) / step_hz,
            time: self.steps as f64 / step_hz + f64::from(input.steps) / step_hz - change.age_s,
            hand: rig * change.hand.pose,
            velocity: change.hand.velocity.map(|velocity| self.in_world(velocity)),
            is_measured: true,
        })
    }

    /// Closes or opens the hand. Without a tracked hand the grip stays as it was, for as long as a grip outlasts tracking.
    pub(crate) fn grip(&mut self, input: &Input, let_go: Option<Moment>) {
        let opens = input.trigger <= self.room.config.hand.trigger_open;
        let Some(hand) = self.hand.now else {
            self.hand.candidate = None;
            match let_go {
                // The device knows where the hand was when it opened, if not where it is now.
                Some(moment) => self.release(moment),
                None => self.drop_if_lost(),
            }
            if self.hand.held.is_none() && opens {
                self.hand.is_closed = false;
            }
            return;
        };
        let config = &self.room.config.hand;
        let closes = input.trigger >= config.trigger_close;
        if self.hand.held.is_none() {
            self.hand.candidate = nearest(&self.room, hand);
        }
        if closes && !self.hand.is_closed {
            self.hand.is_closed = true;
            if let Some(entity) = self.hand.candidate {
                self.grab(entity, hand);
            }
        } else if opens && self.hand.is_closed {
            let moment = let_go.unwrap_or(Moment {
                before_step: input.steps + 1,
                lead_s: 0.0,
                time: self.steps as f64 / self.room.config.physics.step_hz,
                hand,
                velocity: self.hand.velocity,
                is_measured: false,
            });
            self.hand.is_closed = false;
            // Nothing is held any more where the moment came between two steps.
            self.release(moment);
        }
    }

    /// A hand that stays lost drops what it holds: nobody can say where it has gone.
    fn drop_if_lost(&mut self) {
        let lost_for = self.steps - self.hand.last_seen;
        if lost_for <= self.room.steps_in(self.room.config.hand.lost_grip_s) {
            return;
        }
        let Some(held) = self.hand.held.take() else {
            return;
        };
        // Still closed: it must open before it takes anything again.
        let id = self.room.id(held.entity);
        self.room.world.set_motion(id, Motion::Dynamic);
        self.room.world.set_velocity(id, DVec3::ZERO, DVec3::ZERO);
        self.note_on_ball(held.entity, Some(self.head_is_beyond()));
        let model = self.room.model(held.entity);
        self.record(EventKind::Dropped { model });
    }

    /// Turns the ball's picture, not the ball, so that the hand closes on the holes.
    fn show_holes_under(&mut self, ball: Entity, hand: Pose) {
        let body = self.room.body(ball).pose();
        let mut shown: Shown = self.room.get(ball);
        let world_from_model = holes::world_from_model(&hand, self.hand.is_left, body.position);
        shown.body_from_model.rotation = body.rotation.inverse() * world_from_model;
        self.room.set(ball, shown);
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
        if matches!(model, Model::Ball(_)) {
            self.show_holes_under(entity, hand);
        }
        self.record(EventKind::Grabbed { model });
    }

    /// The hand lets go: the thing flies on as the hand carried its centre.
    pub(crate) fn release(&mut self, moment: Moment) {
        let Some(held) = self.hand.held.take() else {
            return;
        };
        let id = self.room.id(held.entity);
        let config = &self.room.config.release;
        if moment.is_measured {
            // Later poses were guesses of the runtime at a hand that still held on.
            self.hand
                .history
                .push(moment.time, moment.hand, config.window_s);
            let carried = moment.hand * held.hand_from_body;
            let carried = kept_out(&self.room, held.entity, carried);
            self.room.world.set_pose(id, carried);
        }
        let position = self.room.world.body(id).pose().position;
        let arm = position - moment.hand.position;
        let (measured, fitted) =
            release::estimate(&self.hand.history, moment.velocity, arm, config);
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
        let model = self.room.model(held.entity);
        let (used, assist) = match model {
            Model::Ball(_) => assist::help(used, config.assist_share),
            _ => (used, None),
        };
        self.room.world.set_motion(id, Motion::Dynamic);
        self.room.world.set_velocity(id, used.linear, used.angular);
        self.fly(held.entity, used, moment.lead_s);
        self.hand.let_go = Some(held.entity);
        // At once, also between two steps: the ball leaves through the fingers.
        let hand = self.room.id(self.room.hand);
        self.room.world.set_collides(hand, false);
        let is_foul = self.head_is_beyond();
        self.note_on_ball(held.entity, Some(is_foul));
        self.let_go = Some((held.entity, used));
        self.record(EventKind::Released(Release {
            model,
            used,
            source,
            assist,
            from_velocity: measured,
            from_poses: fitted,
            speed: used.linear.length(),
            position,
        }));
    }

    /// Lets a thing fly freely for less than a step, or for as long as it was let go before the frame began; at most up to
    /// the first pin or ball on its way, which the next step then lets it strike.
    fn fly(&mut self, entity: Entity, start: ReleaseVelocity, seconds: f64) {
        let id = self.room.id(entity);
        let fall = DVec3::NEG_Y * self.room.config.physics.gravity_mps2;
        let seconds = free_way(&self.room, entity, start, fall, seconds);
        if seconds <= 0.0 {
            return;
        }
        let from = self.room.world.body(id).pose();
        let to = Pose {
            position: from.position + (start.linear + 0.5 * fall * seconds) * seconds,
            rotation: DQuat::from_scaled_axis(start.angular * seconds) * from.rotation,
        };
        let to = kept_out(&self.room, entity, to);
        self.room.world.set_pose(id, to);
        self.room
            .world
            .set_velocity(id, start.linear + fall * seconds, start.angular);
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

/// The instant at which a hand lets go.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Moment {
    /// The step of the frame, from 1, before which it comes; one more than the frame has when it comes after them.
    pub before_step: u32,
    /// How long before that step [s].
    pub lead_s: f64,
    /// Since the session began [s].
    pub time: f64,
    /// The hand then, world frame.
    pub hand: Pose,
    /// Its measured velocity, world axes.
    pub velocity: Option<Velocity>,
    /// Whether the device measured the instant; it is that of the frame's poses else.
    pub is_measured: bool,
}

/// How much of `seconds` a thing that flies off with `start` has before it meets a pin or a ball [s]; its way is taken for
/// straight, which over the longest age of a release is 5 cm of fall at its end.
fn free_way(room: &Room, entity: Entity, start: ReleaseVelocity, fall: DVec3, seconds: f64) -> f64 {
    let flying = room.body(entity);
    let flying = Travel {
        compound: flying.compound(),
        pose: flying.pose(),
        linear_velocity: start.linear + 0.5 * fall * seconds,
        angular_velocity: start.angular,
    };
    let others = room.pins.iter().chain(&room.balls).copied();
    let in_the_way = others.filter(|other| *other != entity && is_free(room, *other));
    let meetings = in_the_way.filter_map(|other| {
        let other = room.body(other);
        let standing = Travel {
            compound: other.compound(),
            pose: other.pose(),
            linear_velocity: DVec3::ZERO,
            angular_velocity: DVec3::ZERO,
        };
        time_of_impact(&flying, &standing, seconds)
    });
    meetings.map(|meeting| meeting.time).fold(seconds, f64::min)
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
