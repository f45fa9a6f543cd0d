//! Head and hand: from the tracker to the world, and from frame to frame through the physics steps.

use glam::DVec3;
use physics::{Pose, Shape};

use crate::components::Held;
use crate::event::{EventKind, TrackedPart};
use crate::input::{Input, Tracked, Velocity};
use crate::release::PoseHistory;
use crate::room::{Room, between};
use crate::visible::Model;
use crate::{Game, grab};

/// What the game remembers of the hand between frames.
#[derive(Clone, Debug, Default)]
pub(crate) struct Hand {
    /// World pose at the start of the frame; `None` right after the tracker found it.
    pub before: Option<Pose>,
    /// World pose at the end of the frame; `None` while it is not tracked.
    pub now: Option<Pose>,
    /// The step at whose end it was last tracked.
    pub last_seen: u64,
    /// Measured velocity, world axes, walking included.
    pub velocity: Option<Velocity>,
    pub history: PoseHistory,
    /// True while the trigger holds it closed.
    pub is_closed: bool,
    /// The trigger, from 0 to 1, for the picture.
    pub trigger: f64,
    /// It is a left one, for the picture.
    pub is_left: bool,
    pub held: Option<Held>,
    /// What it let go and has not yet drawn clear of: the two pass through each other.
    pub let_go: Option<hecs::Entity>,
    /// What it could grab now.
    pub candidate: Option<hecs::Entity>,
    /// What it touches.
    pub touched: Vec<Model>,
    /// What it has touched since the frame began.
    pub touching: Vec<Model>,
}

impl Game {
    /// Follows the head. Poses that hold no usable number count as not tracked; the device boundary has counted them.
    pub(crate) fn track_head(&mut self, input: &Input) {
        let head = input.head.filter(Tracked::is_usable);
        if head.is_some() != self.head.is_some() {
            let found = head.is_some();
            self.record(EventKind::Tracking {
                part: TrackedPart::Head,
                found,
            });
        }
        self.head = head;
    }

    /// Takes the hand's pose from tracking space to the world. What the tracker has lost pushes nothing; a held thing then
    /// stays where it was, in the grip that it was in, until the loss has lasted too long.
    pub(crate) fn track_hand(&mut self, input: &Input) {
        let hand = input.hand.filter(Tracked::is_usable);
        if hand.is_some() != self.hand.now.is_some() {
            let found = hand.is_some();
            self.record(EventKind::Tracking {
                part: TrackedPart::Hand,
                found,
            });
        }
        self.hand.trigger = input.trigger;
        self.hand.is_left = input.is_left;
        let rig = self.world_from_tracking;
        let before = self.hand.now;
        let now = hand.map(|tracked| rig * tracked.pose);
        self.hand.velocity = hand
            .and_then(|tracked| tracked.velocity)
            .map(|velocity| self.in_world(velocity));
        let follows = |before: &Pose| {
            now.is_some_and(|now| !self.has_jumped(*before, now, input.steps))
                && !input.recentred
                && !input.recentre
        };
        self.hand.before = before.filter(follows);
        if self.hand.before.is_none() {
            self.hand.history.clear();
        }
        self.hand.now = now;
        if let Some(now) = now {
            self.hand.last_seen = self.steps + u64::from(input.steps);
            let time = self.hand.last_seen as f64 / self.room.config.physics.step_hz;
            self.hand
                .history
                .push(time, now, self.room.config.release.window_s);
        }
        self.place_hand();
    }

    /// A velocity of tracking space in the world, walking included.
    pub(crate) fn in_world(&self, velocity: Velocity) -> Velocity {
        let rig = self.world_from_tracking;
        Velocity {
            linear: rig.transform_vector(velocity.linear) + self.rig_velocity,
            angular: rig.transform_vector(velocity.angular),
        }
    }

    /// Whether two poses of neighbouring frames lie too far apart for a hand.
    fn has_jumped(&self, before: Pose, now: Pose, steps: u32) -> bool {
        let seconds = f64::from(steps.max(1)) / self.room.config.physics.step_hz;
        before.position.distance(now.position) > self.room.config.hand.jump_speed_mps * seconds
    }

    /// Shows and hides the hand, and puts it where it reappears or jumps to without a push on the way.
    pub(crate) fn place_hand(&mut self) {
        let hand = self.room.hand;
        let id = self.room.id(hand);
        let is_solid = self.hand.now.is_some() && self.hand.let_go.is_none();
        self.room.set_hidden(hand, self.hand.now.is_none());
        if self.room.world.body(id).collides() != is_solid {
            self.room.world.set_collides(id, is_solid);
        }
        let Some(now) = self.hand.now else { return };
        if self.hand.before.is_some() {
            return;
        }
        self.room.world.set_pose(id, now);
        if let Some(held) = self.hand.held {
            let target = grab::kept_out(&self.room, held.entity, now * held.hand_from_body);
            let id = self.room.id(held.entity);
            self.room.world.set_pose(id, target);
        }
    }

    /// Drives the hand, and what it holds, to where it is at a share of the frame, from 0 to 1.
    pub(crate) fn reach(&mut self, share: f64) {
        let (Some(before), Some(now)) = (self.hand.before, self.hand.now) else {
            return;
        };
        let pose = between(before, now, share);
        let id = self.room.id(self.room.hand);
        self.room.world.drive_to(id, pose);
        if let Some(held) = self.hand.held {
            let target = grab::kept_out(&self.room, held.entity, pose * held.hand_from_body);
            let id = self.room.id(held.entity);
            let way = self
                .room
                .world
                .body(id)
                .pose()
                .position
                .distance(target.position);
            if way > self.room.config.hand.jump_speed_mps * self.room.world.dt() {
                // It slipped round a corner of what held it back: it must not strike anything on that way.
                self.room.world.set_pose(id, target);
                self.room.world.set_velocity(id, DVec3::ZERO, DVec3::ZERO);
            } else {
                self.room.world.drive_to(id, target);
            }
        }
    }

    /// After the steps: whether the hand has drawn clear of what it let go, and what it has begun to touch.
    pub(crate) fn feel(&mut self) {
        let clearance = 0.01;
        if let (Some(entity), Some(now)) = (self.hand.let_go, self.hand.now)
            && surface_distance(&self.room, entity, now)
                > self.room.config.hand.radius_m + clearance
        {
            self.hand.let_go = None;
        }
        let hand = self.room.id(self.room.hand);
        let things = self
            .room
            .pins
            .iter()
            .chain(&self.room.balls)
            .chain(&self.room.buttons);
        let mut touching = std::mem::take(&mut self.hand.touching);
        for thing in things {
            if self.room.world.touching(hand, self.room.id(*thing)) {
                touching.push(self.room.model(*thing));
            }
        }
        touching.sort_unstable();
        touching.dedup();
        let fresh: Vec<Model> = touching
            .iter()
            .copied()
            .filter(|model| !self.hand.touched.contains(model))
            .collect();
        for model in fresh {
            self.record(EventKind::Touched { model });
        }
        self.hand.touched = touching;
    }
}

/// Distance [m] from the hand's middle to the surface of a body; negative inside.
pub(crate) fn surface_distance(room: &Room, entity: hecs::Entity, hand: Pose) -> f64 {
    let body = room.body(entity);
    let near = hand.position.distance(body.pose().position) - body.compound().bounding_radius();
    // Farther than any arm: no need to be exact.
    if near > 1.0 {
        return near;
    }
    let radius = room.config.hand.radius_m;
    let sphere = Shape::sphere(radius).expect("a checked configuration has a positive radius");
    let gap = |part: &physics::Part| {
        let pose = body.pose() * part.pose;
        physics::query::separation(
            (&sphere, &hand),
            (&part.shape, &pose),
            None,
            physics::query::Limits::default(),
        )
        .gap
    };
    body.compound()
        .parts()
        .iter()
        .map(gap)
        .fold(f64::INFINITY, f64::min)
        + radius
}
