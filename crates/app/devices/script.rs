//! The scripted participant: an input device like the others, with a body and human scatter.
//!
//! It sees what is visible and hears the game's events; it acts only through head, hand, trigger
//! and buttons. The same seed and settings give the same inputs on every system: random numbers are
//! the program's own, sines come from `libm`.

mod action;
mod body;
mod plan;
mod swing;

use std::collections::VecDeque;

use game::{
    BallSeen, Button, Config, EventKind, Game, Input, Model, Observation, ParticipantConfig,
};
use glam::{DVec2, DVec3};
use physics::Pose;

use self::action::{Action, HandGoal, Reach};
use self::body::{Body, HandState, Stance, yaw_towards};
use super::Device;
use experiment::random::SplitMix64;

/// How long the hand takes to open [s]: a finger leaving a trigger.
const OPENING_TIME: f64 = 0.05;
/// Patience with a ball that does not come back, before another is taken [s].
const PATIENCE: f64 = 12.0;
/// Nearer than this to a goal, small steps replace the thumb button [m].
const NEAR: f64 = 0.25;
/// The gaze is this far off before the walk begins [rad]: one does not walk sideways.
const FACING: f64 = 0.15;

/// Whether the device measures velocities or poses alone.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Velocities {
    /// Supplied with every pose, as headsets do.
    Measured,
    /// Not supplied.
    Missing,
}

/// The scripted participant.
#[derive(Debug)]
pub struct Script {
    person: ParticipantConfig,
    trigger_open: f64,
    walking_stop: f64,
    steps: u32,
    dt: f64,
    velocities: Velocities,
    random: SplitMix64,
    games: VecDeque<Button>,
    /// No game is under way.
    has_finished: bool,
    actions: VecDeque<Action>,
    /// Time since the current action began [s].
    time: f64,
    reach: Option<Reach>,
    /// Where a walk backward began, in the world.
    backed_from: Option<DVec2>,
    trigger_from: f64,
    body: Body,
    goal: Stance,
    gaze: DVec3,
    hand: HandState,
    trigger: f64,
    /// How long the own ball has been away [s].
    waited: f64,
    /// Throws to make before the first game.
    practice: u32,
    /// It has looked at the game before.
    has_begun: bool,
}

/// What the participant sees in one frame.
struct Sight {
    alley: Observation,
    /// Where the tracking space lies in the room.
    world_from_tracking: Pose,
}

impl Sight {
    fn of(game: &Game) -> Self {
        Sight {
            alley: game.observe(),
            world_from_tracking: game.world_from_tracking(),
        }
    }

    /// The ball in the hand.
    fn held_ball(&self) -> Option<BallSeen> {
        match self.alley.held {
            Some(Model::Ball(number)) => self
                .alley
                .balls
                .iter()
                .copied()
                .find(|ball| ball.index == number),
            _ => None,
        }
    }
}

impl Script {
    /// A participant who plays a game under each of `games`, in that order.
    pub fn new(config: &Config, seed: u64, velocities: Velocities, games: &[Button]) -> Self {
        let person = config.participant.clone();
        let steps = (config.physics.step_hz / config.tracking.rate_hz)
            .round()
            .max(1.0);
        let body = Body::upright(person.eye_height_m);
        let HandGoal::Body(position, rotation) = plan::relaxed_hand(&person) else {
            unreachable!("a relaxed hand is given in the body frame")
        };
        Script {
            trigger_open: config.hand.trigger_open,
            walking_stop: 0.5 * config.walking.speed_mps * config.walking.ramp_s,
            steps: steps as u32,
            dt: steps / config.physics.step_hz,
            velocities,
            random: SplitMix64::new(seed),
            games: games.iter().copied().collect(),
            has_finished: false,
            actions: VecDeque::new(),
            time: 0.0,
            reach: None,
            backed_from: None,
            trigger_from: 0.0,
            goal: Stance {
                position: DVec2::ZERO,
                yaw: 0.0,
                bend: 0.0,
                nod: 0.0,
            },
            gaze: DVec3::new(0.0, 0.5, config.lane.headpin_z_m),
            hand: HandState::still(position, rotation),
            trigger: 0.0,
            waited: 0.0,
            practice: 0,
            has_begun: false,
            person,
            body,
        }
    }

    /// The same participant, who first makes `throws` throws that do not count.
    #[must_use]
    pub fn practising(mut self, throws: u32) -> Self {
        self.practice = throws;
        self
    }

    /// Remembers what matters later from what has just happened.
    fn notice(&mut self, game: &Game) {
        self.waited += self.dt;
        // What a game that is taken up again told last was before this participant's time.
        let is_own = std::mem::replace(&mut self.has_begun, true);
        let events = if is_own { game.events() } else { &[] };
        for event in events {
            match &event.kind {
                EventKind::GameStarted { button } => self.games.retain(|wanted| wanted != button),
                EventKind::Released(_) => self.waited = 0.0,
                EventKind::Settled { .. } => self.practice = self.practice.saturating_sub(1),
                _ => {}
            }
        }
    }

    /// Fills the list of actions when it has run out; leaves it empty while there is nothing to do but wait.
    fn decide(&mut self, sight: &Sight) {
        let from = self.world_ground(sight);
        let actions = if sight.alley.playing.is_none() && self.practice == 0 {
            self.games
                .front()
                .map(|button| plan::press(*button, &sight.alley, &self.person, from))
        } else if let Some(ball) = sight.held_ball() {
            let is_ready = sight.alley.is_set;
            let lateness = 0.5 * self.dt;
            is_ready.then(|| {
                plan::deliver(&sight.alley, ball, &self.person, lateness, &mut self.random)
            })
        } else if self.trigger > 0.0 {
            // Closed on nothing: open again before another try.
            Some(vec![
                Action::Trigger(0.0, 0.1),
                Action::Reach(plan::relaxed_hand(&self.person), 0.6),
            ])
        } else {
            self.ball_to_fetch(sight)
                .map(|ball| plan::fetch(ball, from))
        };
        self.actions.extend(actions.into_iter().flatten());
        self.time = 0.0;
    }

    /// The own ball, number 0, or after some patience another that is on the rack.
    fn ball_to_fetch(&self, sight: &Sight) -> Option<BallSeen> {
        let mut on_rack = sight
            .alley
            .balls
            .iter()
            .copied()
            .filter(|ball| ball.is_on_rack);
        on_rack.find(|ball| ball.index == 0 || self.waited > PATIENCE)
    }

    /// The body as it is tracked now.
    fn input(&self, walk_forward: bool, walk_back: bool) -> Input {
        let measured = self.velocities == Velocities::Measured;
        Input {
            head: Some(self.body.head(measured)),
            hand: Some(self.body.tracked(&self.hand, measured)),
            trigger: self.trigger,
            walk_forward,
            walk_back,
            press_red: false,
            press_blue: false,
            locked: [false; 2],
            recentred: false,
            paused: false,
            recentre: false,
            is_left: false,
            steps: self.steps,
            trigger_change: None,
        }
    }

    fn world_from_body(&self, sight: &Sight) -> Pose {
        sight.world_from_tracking * self.body.pose()
    }

    fn world_ground(&self, sight: &Sight) -> DVec2 {
        let position = self.world_from_body(sight).position;
        DVec2::new(position.x, position.z)
    }

    /// Turns a world yaw into one of the tracking space.
    fn tracking_yaw(sight: &Sight, world_yaw: f64) -> f64 {
        let ahead = sight.world_from_tracking.rotation * DVec3::NEG_Z;
        world_yaw - yaw_towards(DVec2::new(ahead.x, ahead.z))
    }

    /// Works on the current action for one frame; returns the buttons (forward, back).
    fn act(&mut self, sight: &Sight) -> (bool, bool) {
        let Some(action) = self.actions.front().cloned() else {
            self.hand = HandState::still(self.hand.position, self.hand.rotation);
            return (false, false);
        };
        self.time += self.dt;
        let mut buttons = (false, false);
        let is_done = match action {
            Action::Walk(to) => self.walk(to, sight, &mut buttons.0),
            Action::BackOff(distance) => {
                let here = self.world_ground(sight);
                let begin = *self.backed_from.get_or_insert(here);
                buttons.1 = here.distance(begin) + self.walking_stop < distance;
                // The walk ends by itself a ramp later, or at once against a wall.
                !buttons.1 && self.time > 0.5 || self.time > 4.0
            }
            Action::Stand(at, yaw) => {
                let here = self.world_ground(sight);
                let way = sight.world_from_tracking.rotation.inverse()
                    * DVec3::new(at.x - here.x, 0.0, at.y - here.y);
                self.goal.position = self.body.position + DVec2::new(way.x, way.z);
                self.goal.yaw = Self::tracking_yaw(sight, yaw);
                way.length() < 1e-3 && swing::wrapped(self.goal.yaw - self.body.yaw).abs() < 1e-3
            }
            Action::Bend(depth) => {
                self.goal.bend = depth;
                true
            }
            Action::Look(at) => {
                self.gaze = at;
                true
            }
            Action::Reach(goal, duration) => self.reach(goal, duration, sight),
            Action::Trigger(value, duration) => {
                let part = (self.time / duration).min(1.0);
                self.trigger = self.trigger_from + (value - self.trigger_from) * part;
                part >= 1.0
            }
            Action::Throw(swing, release) => {
                self.hand = swing.hand(self.time);
                let opened = (self.time - release) / OPENING_TIME + (1.0 - self.trigger_open);
                self.trigger = 1.0 - opened.clamp(0.0, 1.0);
                self.time >= swing.duration()
            }
            Action::Wait(duration) => {
                self.hand = HandState::still(self.hand.position, self.hand.rotation);
                self.time >= duration
            }
        };
        if is_done {
            self.actions.pop_front();
            self.time = 0.0;
            self.reach = None;
            self.backed_from = None;
            self.trigger_from = self.trigger;
        }
        buttons
    }

    fn walk(&mut self, to: DVec2, sight: &Sight, forward: &mut bool) -> bool {
        let way = to - self.world_ground(sight);
        if way.length() < NEAR {
            return true;
        }
        self.goal.yaw = Self::tracking_yaw(sight, yaw_towards(way));
        // Small steps in the room are taken back while the button carries the rest of the way.
        self.goal.position = DVec2::ZERO;
        let is_facing = swing::wrapped(self.goal.yaw - self.body.yaw).abs() < FACING;
        *forward = is_facing && way.length() > self.walking_stop;
        self.time > 20.0
    }

    fn reach(&mut self, goal: HandGoal, duration: f64, sight: &Sight) -> bool {
        let from = self.hand;
        let body_from_world = self.world_from_body(sight).inverse();
        let reach = *self.reach.get_or_insert_with(|| {
            let to = match goal {
                HandGoal::Body(position, rotation) => HandState::still(position, rotation),
                HandGoal::World(point, rotation) => {
                    HandState::still(body_from_world.transform_point(point), rotation)
                }
            };
            Reach::new(from, to, duration)
        });
        self.hand = reach.hand(self.time);
        reach.is_over(self.time)
    }

    /// Downward angle from the eyes to what is looked at [rad].
    fn nod_towards(&self, sight: &Sight) -> f64 {
        let eyes = self.body.eye_height - self.body.bend;
        let distance = self
            .world_ground(sight)
            .distance(DVec2::new(self.gaze.x, self.gaze.z));
        libm::atan2(eyes - self.gaze.y, distance.max(0.3)).clamp(-0.3, 1.0)
    }
}

impl Device for Script {
    fn next(&mut self, game: &Game) -> Input {
        self.notice(game);
        self.has_finished = game.playing().is_none();
        let sight = Sight::of(game);
        if self.actions.is_empty() {
            self.decide(&sight);
        }
        let (walk_forward, walk_back) = self.act(&sight);
        self.goal.nod = self.nod_towards(&sight);
        self.body.approach(&self.goal, self.dt);
        self.input(walk_forward, walk_back)
    }

    /// Stands still and reads; what was begun goes on afterwards.
    fn wait(&mut self, game: &Game) -> Input {
        self.notice(game);
        self.hand = HandState::still(self.hand.position, self.hand.rotation);
        self.input(false, false)
    }

    fn is_done(&self) -> bool {
        self.games.is_empty() && self.practice == 0 && self.has_finished
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use game::Conditions;
    use std::path::Path;

    /// A session was broken off right behind a throw: whoever goes on has not made it.
    #[test]
    fn a_throw_before_its_time_is_not_counted() {
        let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("config");
        let conditions = Conditions::load(&folder, "test", &[]).unwrap();
        let config = conditions.lobby.clone();
        let person = || Script::new(&config, 4, Velocities::Measured, &[]).practising(1);
        let mut game = Game::new(conditions, 1).unwrap();
        let mut first = person();
        let is_settled = |game: &Game| {
            let mut events = game.events().iter();
            events.any(|event| matches!(event.kind, EventKind::Settled { .. }))
        };
        while !is_settled(&game) {
            let input = first.next(&game);
            game.step(&input);
            assert!(game.time() < 120.0, "no throw");
        }
        let mut second = person();
        second.next(&game);
        assert!(!second.is_done(), "it has a throw to make");
        first.next(&game);
        assert!(first.is_done(), "the other has made it");
    }
}
