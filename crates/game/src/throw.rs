//! One throw: when it starts, when it ends, and which pins are down then.

use glam::DVec3;
use hecs::Entity;
use physics::{Body, Pose};

use crate::Game;
use crate::alley;
use crate::components::{Ball, Journey, Pin, PinKeeper};
use crate::config::Config;
use crate::event::{EndReason, EventKind};
use crate::observe::ThrowSeen;
use crate::pinsetter::Cycle;
use crate::room::Room;
use crate::visible::Model;

/// Distance of a pin's farthest point from its centre of gravity, for its fastest point [m].
const PIN_REACH: f64 = 0.23;

/// A base higher than this above the deck has left it [m]: the pin is in a hand, or still flies.
const LEFT_DECK_ABOVE: f64 = 0.1;

/// What the alley is doing.
#[derive(Clone, Debug)]
pub(crate) enum Stage {
    /// Waiting for a ball. The step since which pins have been out of place though none was delivered.
    Ready { disturbed_since: Option<u64> },
    /// A ball is on its way.
    Rolling(Throw),
    /// The pinsetter works.
    Setting(Cycle),
}

/// A ball on its way.
#[derive(Clone, Debug)]
pub(crate) struct Throw {
    pub ball: Entity,
    pub began: u64,
    pub passed_headpin: Option<u64>,
    pub still_since: Option<u64>,
    pub is_foul: bool,
    pub has_hit: bool,
}

impl Game {
    /// Watches the foul line, and starts a throw when the deck is ready for one.
    ///
    /// A ball is delivered once: one that comes back over the line and crosses it again, or that crosses it while the
    /// pinsetter works, is no delivery until a hand or the rack has had it.
    pub(crate) fn watch_foul_line(&mut self) {
        for entity in self.room.balls.clone() {
            let mut ball: Ball = self.room.get(entity);
            let is_held = self.hand.held.is_some_and(|held| held.entity == entity);
            let body = self.room.body(entity);
            let (z, velocity) = (body.pose().position.z, body.linear_velocity());
            let is_beyond = z < 0.0 && !is_held && ball.journey == Journey::InRoom;
            let has_crossed = is_beyond && !ball.is_beyond;
            ball.is_beyond = is_beyond;
            self.room.set(entity, ball);
            if !has_crossed || ball.is_spent {
                continue;
            }
            ball.is_spent = true;
            self.room.set(entity, ball);
            if matches!(self.stage, Stage::Ready { .. }) {
                let is_foul = ball.foul.unwrap_or_else(|| self.head_is_beyond());
                self.start_throw(entity, velocity, is_foul);
            }
        }
    }

    fn start_throw(&mut self, ball: Entity, velocity: DVec3, is_foul: bool) {
        self.stage = Stage::Rolling(Throw {
            ball,
            began: self.steps,
            passed_headpin: None,
            still_since: None,
            is_foul,
            has_hit: false,
        });
        self.last_throw = self
            .let_go
            .filter(|(entity, _)| *entity == ball)
            .map(|(_, used)| ThrowSeen::of(&used, is_foul));
        let next = self.delivery();
        self.record(EventKind::ThrowStarted {
            frame: next.map_or(0, |next| next.frame),
            ball: next.map_or(0, |next| next.ball),
            velocity,
        });
        if is_foul {
            self.record(EventKind::Foul);
        }
    }

    /// Follows a throw, and ends it when its rules say so.
    pub(crate) fn follow_throw(&mut self) {
        let Stage::Rolling(throw) = &mut self.stage else {
            return;
        };
        let rules = &self.room.config.rules;
        if !throw.has_hit
            && let Some(pin) = struck_pin(&self.room)
        {
            throw.has_hit = true;
            let ball_velocity = self.room.body(throw.ball).linear_velocity();
            self.events.push(crate::event::Event {
                step: self.steps,
                kind: EventKind::FirstHit { pin, ball_velocity },
            });
        }
        let ball = self.room.body(throw.ball).pose().position;
        if ball.z < self.room.config.lane.headpin_z_m && throw.passed_headpin.is_none() {
            throw.passed_headpin = Some(self.steps);
        }
        let is_still = pins_are_still(&self.room) && ball_is_done(&self.room, throw.ball);
        throw.still_since = is_still.then(|| throw.still_since.unwrap_or(self.steps));
        let over = |since: u64, seconds: f64| self.steps >= since + self.room.steps_in(seconds);
        let reason = if throw
            .still_since
            .is_some_and(|since| over(since, rules.still_for_s))
        {
            EndReason::Still
        } else if throw
            .passed_headpin
            .is_some_and(|since| over(since, rules.end_after_headpin_s))
        {
            EndReason::AfterHeadPin
        } else if over(throw.began, rules.end_after_foul_line_s) {
            EndReason::AfterFoulLine
        } else {
            return;
        };
        let is_foul = throw.is_foul;
        self.throws_over += 1;
        self.end_throw(is_foul, reason);
    }

    /// Counts, scores, and hands the deck to the pinsetter.
    fn end_throw(&mut self, is_foul: bool, reason: EndReason) {
        let (fallen, standing) = count(&self.room);
        let full_rack = self.score(fallen.len() as u8, is_foul);
        self.record(EventKind::Settled {
            fallen,
            standing,
            reason,
        });
        self.stage = Stage::Setting(Cycle::after_throw(&self.room, self.steps, full_rack));
    }

    /// Before a delivery: pins that something has moved are put back once they are still again.
    pub(crate) fn watch_pins(&mut self) {
        let Stage::Ready { disturbed_since } = &mut self.stage else {
            return;
        };
        let held = self.hand.held.map(|held| held.entity);
        let is_disturbed = self
            .room
            .pins
            .iter()
            .any(|pin| Some(*pin) != held && is_out_of_place(&self.room, *pin));
        if !is_disturbed {
            *disturbed_since = None;
            return;
        }
        let since = *disturbed_since.get_or_insert(self.steps);
        let rules = &self.room.config.rules;
        let settled = self.steps >= since + self.room.steps_in(rules.still_for_s)
            && pins_are_still(&self.room);
        let given_up = self.steps >= since + self.room.steps_in(rules.end_after_headpin_s);
        if settled || given_up {
            self.stage = Stage::Setting(Cycle::put_back(&self.room, self.steps));
        }
    }
}

/// The first pin that anything struck in the last step.
fn struck_pin(room: &Room) -> Option<u8> {
    let ball_or_pin = |model| matches!(model, Model::Ball(_) | Model::Pin(_));
    room.world.impacts().iter().find_map(|impact| {
        let (a, b) = (
            room.model(room.owner(impact.a)),
            room.model(room.owner(impact.b)),
        );
        match (a, b) {
            (Model::Pin(pin), other) | (other, Model::Pin(pin)) if ball_or_pin(other) => Some(pin),
            _ => None,
        }
    })
}

/// Whether every pin that could still change the count is still.
fn pins_are_still(room: &Room) -> bool {
    room.pins.iter().all(|pin| {
        let is_out = room.get::<Pin>(*pin).keeper != PinKeeper::Nobody || !is_over_deck(room, *pin);
        is_out || room.body(*pin).is_asleep() || is_still(room, *pin)
    })
}

/// Whether a pin moves too slowly to matter, or only rocks on its base.
fn is_still(room: &Room, pin: Entity) -> bool {
    let rules = &room.config.rules;
    let body = room.body(pin);
    let axis = body.pose().rotation * DVec3::Y;
    // Spin about its own axis moves no surface: such a pin stands or lies as if it were still.
    let turning = body.angular_velocity().cross(axis).length();
    let only_rocks = axis.angle_between(DVec3::Y) < rules.rocking_lean_deg.to_radians()
        && turning < rules.rocking_turn_radps;
    let turning = if only_rocks { 0.0 } else { turning };
    body.linear_velocity().length() + turning * PIN_REACH < rules.still_speed_mps
}

/// Whether the ball lies in the pit, is on its way back, or is still.
fn ball_is_done(room: &Room, entity: Entity) -> bool {
    let ball: Ball = room.get(entity);
    let body = room.body(entity);
    ball.journey != Journey::InRoom
        || body.is_asleep()
        || body.pose().position.z < room.config.lane.deck_end_z_m
        || body.linear_velocity().length() < room.config.rules.still_speed_mps
}

/// Where the middle of a pin's base is [m], and its axis.
pub(crate) fn base_and_axis(config: &Config, pin: Pose) -> (DVec3, DVec3) {
    let axis = pin.rotation * DVec3::Y;
    (pin.position - axis * config.pin.cg_height_m, axis)
}

/// Whether a pin is above the deck, and so could fall or stand on it.
fn is_over_deck(room: &Room, pin: Entity) -> bool {
    let at = room.body(pin).pose().position;
    let lane = &room.config.lane;
    at.x.abs() < lane.width_m / 2.0
        && (lane.deck_end_z_m..alley::deck_front_z(&room.config)).contains(&at.z)
        && at.y > -room.config.rules.left_deck_below_m
}

/// Whether a pin counts as fallen.
pub(crate) fn is_down(room: &Room, pin: Entity) -> bool {
    let body = room.body(pin);
    room.get::<Pin>(pin).keeper == PinKeeper::Store || body_is_down(&room.config, body)
}

/// Whether a pin's body counts as fallen: it leans, has left the deck, or lies against a kickback.
pub(crate) fn body_is_down(config: &Config, pin: &Body) -> bool {
    let (base, axis) = base_and_axis(config, pin.pose());
    pin.is_frozen()
        || leans(config, axis)
        || has_left_deck(config, base)
        || lies_against_kickback(config, base, axis)
}

fn leans(config: &Config, axis: DVec3) -> bool {
    axis.angle_between(DVec3::Y) > config.rules.down_lean_deg.to_radians()
}

fn has_left_deck(config: &Config, base: DVec3) -> bool {
    let lane = &config.lane;
    let beside = base.x.abs() > lane.width_m / 2.0;
    let before_or_behind = !(lane.deck_end_z_m..alley::deck_front_z(config)).contains(&base.z);
    let height = -config.rules.left_deck_below_m..LEFT_DECK_ABOVE;
    beside || before_or_behind || !height.contains(&base.y)
}

/// The pin's widest place and its head are what can touch a kickback.
fn lies_against_kickback(config: &Config, base: DVec3, axis: DVec3) -> bool {
    let parts = &config.pin.parts;
    let reach = |height: f64, radius: f64| (base + axis * height).x.abs() + radius;
    let widest = reach(parts.belly_height_m, parts.belly_radius_m)
        .max(reach(parts.head_height_m, parts.head_radius_m));
    widest > alley::kickback_x(config) - config.rules.against_kickback_m
}

/// Pins of this rack that are down, and those that stand.
pub(crate) fn count(room: &Room) -> (Vec<u8>, Vec<u8>) {
    let in_play = room
        .pins
        .iter()
        .filter(|pin| room.get::<Pin>(**pin).ready.is_some());
    let (down, up): (Vec<_>, Vec<_>) = in_play.partition(|pin| is_down(room, **pin));
    let numbers = |pins: Vec<&Entity>| {
        pins.into_iter()
            .map(|pin| room.get::<Pin>(*pin).number)
            .collect()
    };
    (numbers(down), numbers(up))
}

/// Whether a pin is not where it was made ready.
fn is_out_of_place(room: &Room, pin: Entity) -> bool {
    let state: Pin = room.get(pin);
    let Some(ready) = state.ready.filter(|_| state.keeper == PinKeeper::Nobody) else {
        return false;
    };
    let away = room.body(pin).pose().position.distance(ready.position);
    away > room.config.rules.disturbed_pin_m || is_down(room, pin)
}
