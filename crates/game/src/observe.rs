//! What can be known of a game from outside: for the picture, the journal, and the scripted participant.

use glam::{DQuat, DVec2, DVec3};
use physics::Pose;

use crate::Game;
use crate::alley;
use crate::components::{Ball, Journey, Painted, Physical, Pin, PinKeeper, PushButton, Shown};
use crate::condition::{Button, Conditions};
use crate::config::Config;
use crate::event::{Event, ReleaseVelocity};
use crate::score::{Delivery, ScoreSheet};
use crate::throw::{Stage, count, is_down};
use crate::visible::{Model, Visible};

/// What the alley is doing, as a participant would say it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Phase {
    /// No game is played; balls may be thrown for practice.
    Lobby,
    /// The next ball may be delivered.
    Ready,
    /// A ball is on its way.
    Rolling,
    /// The pinsetter works.
    Setting,
}

/// A ball, for a participant that looks for one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BallSeen {
    /// Its number, from 0.
    pub index: u8,
    /// Its centre, world frame [m].
    pub position: DVec3,
    /// Radius [m].
    pub radius: f64,
    /// True when it lies in its cell on the rack.
    pub is_on_rack: bool,
    /// True when the hand could take it: no machine has it.
    pub is_free: bool,
}

/// A pin, for a participant that looks at the deck.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PinSeen {
    /// Number of its spot, from 1.
    pub number: u8,
    /// Centre of gravity, world frame [m].
    pub position: DVec3,
    /// Angle between its axis and the vertical [rad].
    pub lean: f64,
    /// True when it is part of the rack and would count as standing.
    pub is_standing: bool,
}

/// A button in the room.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ButtonSeen {
    /// Which.
    pub button: Button,
    /// Middle of its top while nothing presses it, world frame [m].
    pub top: DVec3,
    /// Radius [m].
    pub radius: f64,
    /// True from the press until it has come up again.
    pub is_pressed: bool,
}

/// How a ball was let go, and whether behind the line.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ThrowSeen {
    /// Speed of the ball's centre [m/s].
    pub speed: f64,
    /// Direction over the floor against the lane's, positive to the right [rad].
    pub angle: f64,
    /// How fast the ball turned, about whatever axis [1/s].
    pub turns: f64,
    /// The head was beyond the foul line.
    pub is_foul: bool,
}

impl ThrowSeen {
    pub(crate) fn of(release: &ReleaseVelocity, is_foul: bool) -> Self {
        let way = release.linear;
        Self {
            speed: way.length(),
            angle: DVec2::new(-way.z, way.x).to_angle(),
            turns: release.angular.length() / std::f64::consts::TAU,
            is_foul,
        }
    }
}

/// What a participant can see.
#[derive(Clone, Debug, PartialEq)]
pub struct Observation {
    /// What the alley is doing.
    pub phase: Phase,
    /// Whether the pins are set and nothing rolls, in a game or out of one.
    pub is_set: bool,
    /// Under which button a game is played.
    pub playing: Option<Button>,
    /// The balls, by number.
    pub balls: Vec<BallSeen>,
    /// The pins, by number.
    pub pins: Vec<PinSeen>,
    /// The buttons: Red, Blue.
    pub buttons: [ButtonSeen; 2],
    /// What the hand holds.
    pub held: Option<Model>,
    /// Middle of the foul line, world frame [m].
    pub foul_line: DVec3,
    /// Spot of the head pin, world frame [m].
    pub head_pin: DVec3,
}

impl Game {
    /// Facts of the last frame, in the order in which they became facts.
    pub fn events(&self) -> &[Event] {
        &self.events
    }

    /// Physics steps since the session began.
    pub fn steps(&self) -> u64 {
        self.steps
    }

    /// Simulated time since the session began [s].
    pub fn time(&self) -> f64 {
        self.steps as f64 / self.room.config.physics.step_hz
    }

    /// What the alley is doing.
    pub fn phase(&self) -> Phase {
        match (&self.playing, &self.stage) {
            (None, _) => Phase::Lobby,
            (_, Stage::Ready { .. }) => Phase::Ready,
            (_, Stage::Rolling(_)) => Phase::Rolling,
            (_, Stage::Setting(_)) => Phase::Setting,
        }
    }

    /// Under which button a game is played.
    pub fn playing(&self) -> Option<Button> {
        self.playing
    }

    /// The button that waits for its second press, while a game is played.
    pub fn confirming(&self) -> Option<Button> {
        self.pending.map(|pending| pending.button)
    }

    /// The next delivery of the game that is played.
    pub fn next_delivery(&self) -> Option<Delivery> {
        self.delivery()
    }

    /// The score sheet of the last game under a button; empty before the first.
    pub fn score_sheet(&self, button: Button) -> &ScoreSheet {
        &self.sheets[button as usize]
    }

    /// The last ball that crossed the foul line out of a hand; `None` before the first of a game.
    pub fn last_throw(&self) -> Option<ThrowSeen> {
        self.last_throw
    }

    /// Throws that have ended since the session began, in practice too.
    pub fn throws_over(&self) -> u32 {
        self.throws_over
    }

    /// How fast the participant walks by button, forward or back [m/s].
    pub fn walking_speed(&self) -> f64 {
        self.walking_speed.abs()
    }

    /// Whether the session is paused.
    pub fn is_paused(&self) -> bool {
        self.is_paused
    }

    /// Whether the hand could take a ball now.
    pub fn could_take_a_ball(&self) -> bool {
        self.hand.held.is_none()
            && self
                .hand
                .candidate
                .is_some_and(|entity| matches!(self.room.model(entity), Model::Ball(_)))
    }

    /// The settings of the room that is there now.
    pub fn config(&self) -> &Config {
        &self.room.config
    }

    /// The settings of the session.
    pub fn conditions(&self) -> &Conditions {
        &self.conditions
    }

    /// Where the tracking space lies in the room: walking moves it.
    pub fn world_from_tracking(&self) -> Pose {
        self.world_from_tracking
    }

    /// The head in the room; `None` while it is not tracked.
    pub fn head_pose_world(&self) -> Option<Pose> {
        self.head.map(|head| self.world_from_tracking * head.pose)
    }

    /// The hand in the room; `None` while it is not tracked.
    pub fn hand_pose_world(&self) -> Option<Pose> {
        self.hand.now
    }

    /// What the hand holds.
    pub fn held(&self) -> Option<Model> {
        self.hand.held.map(|held| self.room.model(held.entity))
    }

    /// Numbers of the pins that stand.
    pub fn standing(&self) -> Vec<u8> {
        count(&self.room).1
    }

    /// How far the trigger is pulled, from 0 to 1: how far the hand has closed.
    pub fn trigger(&self) -> f64 {
        self.hand.trigger.clamp(0.0, 1.0)
    }

    /// Whether the hand that plays is a left one.
    pub fn hand_is_left(&self) -> bool {
        self.hand.is_left
    }

    /// Everything that can be seen now.
    pub fn visible(&self) -> Vec<Visible> {
        self.visible_at(1.0)
    }

    /// Everything that can be seen at a share of the last step, from 0 to 1: a display's instants lie between steps. What a
    /// hand holds is where the hand is.
    pub fn visible_at(&self, share: f64) -> Vec<Visible> {
        let mut visible = Vec::new();
        for (entity, shown, body, painted) in
            &mut self
                .room
                .ecs
                .query::<(hecs::Entity, &Shown, Option<&Physical>, Option<&Painted>)>()
        {
            let pose = match (body, painted) {
                (Some(Physical(id)), _) => {
                    let now = self.room.world.body(*id).pose();
                    let is_held = self.hand.held.is_some_and(|held| held.entity == entity);
                    if is_held || share >= 1.0 {
                        now
                    } else {
                        self.room.pose_at(entity, now, share)
                    }
                }
                (None, Some(Painted(pose))) => *pose,
                (None, None) => continue,
            };
            if shown.is_hidden {
                continue;
            }
            visible.push(Visible {
                model: shown.model,
                pose: pose * shown.body_from_model,
                size: shown.size,
                is_highlighted: self.is_highlighted(entity),
            });
        }
        visible
    }

    /// Whether the hand could take it or has it, where the scene lets that glow, or it is a button that is down.
    fn is_highlighted(&self, entity: hecs::Entity) -> bool {
        let glows = self.room.config.guidance.glow;
        let is_held = self.hand.held.is_some_and(|held| held.entity == entity);
        let is_near = self.hand.held.is_none() && self.hand.candidate == Some(entity);
        let is_down = self
            .room
            .ecs
            .get::<&PushButton>(entity)
            .is_ok_and(|button| button.is_pressed);
        glows && (is_held || is_near) || is_down
    }

    /// What a participant can see, in words and numbers.
    pub fn observe(&self) -> Observation {
        let lane = &self.room.config.lane;
        Observation {
            phase: self.phase(),
            is_set: matches!(self.stage, Stage::Ready { .. }),
            playing: self.playing,
            balls: self
                .room
                .balls
                .iter()
                .map(|ball| self.see_ball(*ball))
                .collect(),
            pins: self
                .room
                .pins
                .iter()
                .map(|pin| self.see_pin(*pin))
                .collect(),
            buttons: [self.see_button(Button::Red), self.see_button(Button::Blue)],
            held: self.held(),
            foul_line: DVec3::ZERO,
            head_pin: DVec3::new(0.0, 0.0, lane.headpin_z_m),
        }
    }

    fn see_ball(&self, entity: hecs::Entity) -> BallSeen {
        let ball: Ball = self.room.get(entity);
        let position = self.room.body(entity).pose().position;
        let is_free = ball.journey == Journey::InRoom;
        BallSeen {
            index: ball.index,
            position,
            radius: ball.radius,
            is_on_rack: is_free
                && ball.astray_since.is_none()
                && position.distance(ball.home) < ball.radius,
            is_free,
        }
    }

    fn see_pin(&self, entity: hecs::Entity) -> PinSeen {
        let pin: Pin = self.room.get(entity);
        let pose = self.room.body(entity).pose();
        PinSeen {
            number: pin.number,
            position: pose.position,
            lean: (pose.rotation * DVec3::Y).angle_between(DVec3::Y),
            is_standing: pin.ready.is_some()
                && pin.keeper == PinKeeper::Nobody
                && !is_down(&self.room, entity),
        }
    }

    fn see_button(&self, button: Button) -> ButtonSeen {
        let state: PushButton = self.room.get(self.room.buttons[button as usize]);
        let desk = &self.room.config.desk;
        ButtonSeen {
            button,
            top: state.foot + DVec3::Y * desk.button_travel_m,
            radius: desk.button_radius_m,
            is_pressed: state.is_pressed,
        }
    }

    /// Whether the head's ground point is beyond the foul line; as it was last tracked, while it is not.
    pub(crate) fn head_is_beyond(&self) -> bool {
        self.head_pose_world()
            .map_or(self.head_was_beyond, |head| head.position.z < 0.0)
    }

    /// The bodies of the alley, to look at: what tests of the physics and measurements need.
    pub fn world(&self) -> &physics::World {
        &self.room.world
    }

    /// A number that differs as soon as any bit of the simulated state does: FNV-1a over world, room and sheets.
    pub fn hash(&self) -> u64 {
        let mut hash = Fnv::new();
        hash.add(self.room.world.hash());
        hash.add(self.steps);
        hash.pose(self.world_from_tracking);
        hash.add(self.walking_speed.to_bits());
        hash.add(u64::from(self.hand.is_closed));
        hash.pose(self.hand.now.unwrap_or(Pose::IDENTITY));
        hash.add(self.hand.held.map_or(0, |held| held.entity.to_bits().get()));
        hash.add(self.phase() as u64);
        hash.add(self.playing.map_or(2, |button| button as u64));
        for pin in &self.room.pins {
            let pin: Pin = self.room.get(*pin);
            hash.add(u64::from(pin.ready.is_some()) << 8 | pin.keeper as u64);
        }
        for sheet in &self.sheets {
            for roll in sheet.rolls() {
                hash.add(u64::from(roll.fallen) << 1 | u64::from(roll.foul));
            }
            hash.add(u64::MAX);
        }
        hash.0
    }

    /// Inner edges of the alley that a plan view needs: half the lane's width, the kickbacks, the cushion [m].
    pub fn plan(&self) -> [f64; 3] {
        let config = &self.room.config;
        [
            config.lane.width_m / 2.0,
            alley::kickback_x(config),
            alley::cushion_z(config),
        ]
    }
}

/// FNV-1a, 64 bits.
struct Fnv(u64);

impl Fnv {
    fn new() -> Self {
        Self(0xcbf2_9ce4_8422_2325)
    }

    fn add(&mut self, value: u64) {
        for byte in value.to_le_bytes() {
            self.0 = (self.0 ^ u64::from(byte)).wrapping_mul(0x0000_0100_0000_01b3);
        }
    }

    fn pose(&mut self, pose: Pose) {
        let DQuat { x, y, z, w } = pose.rotation;
        let position = pose.position;
        for number in [position.x, position.y, position.z, x, y, z, w] {
            self.add(number.to_bits());
        }
    }
}
