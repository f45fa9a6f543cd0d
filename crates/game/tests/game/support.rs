//! A participant for tests: stands, turns, walks, reaches, swings, all through inputs, as a device would.

use std::path::{Path, PathBuf};

use game::{Button, Conditions, Event, EventKind, Game, Input, Phase, Tracked, Velocity};
use glam::{DQuat, DVec3};
use physics::Pose;

/// Physics steps in a frame at 90 Hz.
pub const STEPS: u32 = 8;

/// Displayed frames per second.
pub const RATE: f64 = 90.0;

/// The repository's configuration folder.
pub fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../config")
}

/// The shipped conditions with some settings changed.
pub fn conditions(arguments: &[&str]) -> Conditions {
    let arguments: Vec<String> = arguments
        .iter()
        .map(|argument| (*argument).to_owned())
        .collect();
    Conditions::load(&folder(), "alley", &arguments).unwrap()
}

/// A swing of the arm about the shoulder.
#[derive(Clone, Copy, Debug)]
pub struct Swing {
    /// Speed of the ball at the bottom [m/s].
    pub speed: f64,
    /// Turn of the swing's plane about the vertical, positive to the left [rad].
    pub yaw: f64,
    /// Angle of the arm beyond the vertical at the release [rad].
    pub release_at: f64,
    /// Whether velocities are supplied as a headset would.
    pub with_velocity: bool,
}

impl Swing {
    /// A straight ball.
    pub fn straight() -> Self {
        Self {
            speed: 6.8,
            yaw: 0.0,
            release_at: 0.05,
            with_velocity: true,
        }
    }
}

/// Head and hand in the room, and the game they play.
pub struct Player {
    pub game: Game,
    pub input: Input,
    /// Head, tracking space.
    pub head: Pose,
    /// Hand, world frame.
    pub hand: Option<Pose>,
    pub hand_velocity: Option<Velocity>,
    pub events: Vec<Event>,
    pub inputs: Vec<Input>,
}

impl Player {
    /// At the start, hand at the side.
    pub fn new(conditions: Conditions, frames: u32) -> Self {
        let game = Game::new(conditions, frames).unwrap();
        let hand = game.world_from_tracking().position + DVec3::new(0.25, 1.0, -0.2);
        Self {
            game,
            input: Input {
                steps: STEPS,
                ..Input::default()
            },
            head: Pose::from_position(DVec3::Y * 1.62),
            hand: Some(Pose::from_position(hand)),
            hand_velocity: None,
            events: Vec::new(),
            inputs: Vec::new(),
        }
    }

    /// One displayed frame.
    pub fn frame(&mut self) {
        let tracking_from_world = self.game.world_from_tracking().inverse();
        self.input.head = Some(Tracked::at(self.head));
        self.input.hand = self.hand.map(|hand| Tracked {
            pose: tracking_from_world * hand,
            velocity: self.hand_velocity,
        });
        self.game.step(&self.input);
        self.inputs.push(self.input);
        self.events.extend_from_slice(self.game.events());
    }

    /// Waits.
    pub fn wait(&mut self, seconds: f64) {
        for _ in 0..(seconds * RATE).round() as u32 {
            self.frame();
        }
    }

    /// Waits until something holds, for a minute at most.
    pub fn wait_until(&mut self, what: &str, mut holds: impl FnMut(&Game) -> bool) {
        for _ in 0..(60.0 * RATE) as u32 {
            if holds(&self.game) {
                return;
            }
            self.frame();
        }
        panic!("{what} did not come about within a minute");
    }

    /// Presses a key for one frame.
    pub fn key(&mut self, button: Button) {
        self.input.press_red = button == Button::Red;
        self.input.press_blue = button == Button::Blue;
        self.frame();
        self.input.press_red = false;
        self.input.press_blue = false;
        self.frame();
    }

    /// Turns to a place on the floor and walks there with the thumb button; the hand comes along.
    pub fn walk_to(&mut self, x: f64, z: f64) {
        for _ in 0..3000 {
            let head = self.game.world_from_tracking() * self.head;
            let way = DVec3::new(x - head.position.x, 0.0, z - head.position.z);
            if way.length() < 0.03 {
                break;
            }
            self.head.rotation = DQuat::from_rotation_y((-way.x).atan2(-way.z));
            // Lets go of the button where the ramp will carry it the rest of the way.
            self.input.walk_forward = way.length() > 0.18 || self.inputs.len().is_multiple_of(8);
            let before = self.game.world_from_tracking();
            self.frame();
            let moved = self.game.world_from_tracking().position - before.position;
            if let Some(hand) = &mut self.hand {
                hand.position += moved;
            }
        }
        self.input.walk_forward = false;
        for _ in 0..30 {
            let before = self.game.world_from_tracking();
            self.frame();
            let moved = self.game.world_from_tracking().position - before.position;
            if let Some(hand) = &mut self.hand {
                hand.position += moved;
            }
        }
        self.head.rotation = DQuat::IDENTITY;
    }

    /// Moves the hand to a place in the room at a metre per second.
    pub fn reach(&mut self, target: DVec3) {
        self.move_hand(target, 1.0);
    }

    /// Moves the hand to a place in the room.
    pub fn move_hand(&mut self, target: DVec3, speed: f64) {
        let from = self.hand.unwrap();
        let frames = (from.position.distance(target) / speed * RATE)
            .ceil()
            .max(1.0);
        for frame in 1..=frames as u32 {
            let position = from.position.lerp(target, f64::from(frame) / frames);
            self.hand = Some(Pose::new(position, from.rotation));
            self.frame();
        }
    }

    /// Closes or opens the hand.
    pub fn trigger(&mut self, value: f64) {
        self.input.trigger = value;
        self.frame();
    }

    /// Goes to the rack and takes a ball that lies there, from above.
    pub fn take_ball(&mut self) {
        self.wait_until("a ball on the rack", |game| {
            game.observe().balls.iter().any(|ball| ball.is_on_rack)
        });
        let ball = *self
            .game
            .observe()
            .balls
            .iter()
            .find(|ball| ball.is_on_rack)
            .unwrap();
        self.walk_to(ball.position.x - 0.5, ball.position.z + 0.1);
        let above = ball.position + DVec3::Y * (ball.radius + 0.06);
        self.reach(above + DVec3::Y * 0.3);
        self.reach(above);
        self.trigger(1.0);
        assert!(self.game.held().is_some(), "the hand closed on nothing");
        self.reach(above + DVec3::Y * 0.25);
    }

    /// Swings from the approach at `x`, head at `head_z`, and lets go.
    pub fn swing(&mut self, x: f64, head_z: f64, swing: Swing) {
        self.walk_to(x, head_z);
        let shoulder = DVec3::new(x + 0.0, 1.1, head_z - 0.2);
        let (arm, to_ball) = (0.7, 0.87);
        let turn = DQuat::from_rotation_y(swing.yaw);
        let pose = |angle: f64| {
            let rotation = turn * DQuat::from_rotation_x(angle);
            Pose::new(shoulder + rotation * DVec3::new(0.0, -arm, 0.0), rotation)
        };
        let back = 0.96;
        let rate = swing.speed / to_ball / back;
        self.reach(pose(0.0).position);
        // Back slowly, then forward: the angle is back * -cos(rate t).
        for frame in 0..90 {
            self.hand = Some(pose(-back * f64::from(frame) / 90.0));
            self.frame();
        }
        let mut t = 0.0;
        let mut angle = -back;
        while angle < 0.7 && t * rate < std::f64::consts::PI {
            t += 1.0 / RATE;
            angle = -back * (rate * t).cos();
            let angular = turn * DVec3::X * (back * rate * (rate * t).sin());
            let hand = pose(angle);
            let linear = angular.cross(hand.position - shoulder);
            self.hand = Some(hand);
            self.hand_velocity = swing.with_velocity.then_some(Velocity { linear, angular });
            if angle >= swing.release_at {
                self.input.trigger = 0.0;
            }
            self.frame();
        }
        self.hand_velocity = None;
    }

    /// Takes a ball, throws it, and waits until the next one may be thrown.
    pub fn throw(&mut self, swing: Swing) {
        self.take_ball();
        self.swing(0.0, 0.7, swing);
        self.wait_for_deck();
    }

    /// Waits until the pinsetter has done its work.
    pub fn wait_for_deck(&mut self) {
        let before = self.count(|kind| matches!(kind, EventKind::PinsReady { .. }));
        for _ in 0..(120.0 * RATE) as u32 {
            if self.count(|kind| matches!(kind, EventKind::PinsReady { .. })) > before {
                return;
            }
            self.frame();
        }
        panic!(
            "the deck was not ready within two minutes; phase {:?}",
            self.game.phase()
        );
    }

    /// How many events so far are of a kind.
    pub fn count(&self, wanted: impl Fn(&EventKind) -> bool) -> usize {
        self.events
            .iter()
            .filter(|event| wanted(&event.kind))
            .count()
    }

    /// The last event for which `pick` answers.
    pub fn last<T>(&self, pick: impl Fn(&EventKind) -> Option<T>) -> Option<T> {
        self.events.iter().rev().find_map(|event| pick(&event.kind))
    }

    /// Whether a game waits for a ball.
    pub fn is_ready(&self) -> bool {
        self.game.phase() == Phase::Ready
    }
}
