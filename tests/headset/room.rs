//! A participant whom the test moves: head and hands through the runtime's port, and a copy of the game that follows the
//! journal, so that the test knows where everything is.

use std::path::Path;
use std::time::{Duration, Instant};

use bowling_app::journal::{Header, InputLine, settings};
use game::{Game, Input};
use glam::{DQuat, DVec3};
use physics::Pose;
use serde_json::Value;

use crate::client::{Client, JournalLines, journal_file};
use crate::remote::{Controller, Packet, Remote};
use crate::service::Service;

/// Longest wait for anything in the room.
pub const PATIENCE: Duration = Duration::from_secs(60);
/// The eyes, above the floor [m].
const EYES: f64 = 1.6;
/// How fast hands are moved where speed does not matter [m/s].
const CALM: f64 = 1.0;

/// A hand.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Hand {
    Left,
    Right,
}

/// The participant, the program's journal, and the copy of its game.
pub struct Room {
    remote: Remote,
    journal: JournalLines,
    pub game: Game,
    /// The last packet, in tracking space.
    pub packet: Packet,
    /// Everything that the journal said besides inputs, as it came.
    pub said: Vec<Value>,
    /// The last input that the game consumed.
    pub input: Input,
    /// From where the runtime has a hand to where its palm is, which plays in the place of a controller that was laid down [m]; of
    /// hands that are not turned.
    palm: DVec3,
    /// How often the game was told that tracking space is a new one.
    pub recentred: usize,
    /// How long before its frame's instant the trigger last changed, at the last release [s].
    pub released_age: Option<f64>,
}

impl Room {
    /// Enters the room of a program that has begun to record into `folder`.
    pub fn enter(service: &Service, client: &mut Client, folder: &Path) -> Self {
        client.wait_for("Recording into", PATIENCE);
        Self::follow_from(service, &folder.join("journal.jsonl"))
    }

    /// Enters the room of a program that has begun to write the journal `path`, a recording's or a study's.
    pub fn follow_from(service: &Service, path: &Path) -> Self {
        let mut journal = journal_file(path, PATIENCE);
        let line = journal.next_within(PATIENCE).expect("a header");
        let line: Value = serde_json::from_str(&line).expect("a line of JSON");
        let header: Header = serde_json::from_value(line["header"].clone()).expect("a header");
        let packet = Packet {
            head: Pose::from_position(DVec3::Y * EYES),
            ..Packet::default()
        };
        let mut room = Self {
            remote: Remote::connect(service.port()).expect("the service listens"),
            journal,
            game: Game::new(
                settings::of(path, &header).expect("the journal's, or the study's"),
                header.frames,
            )
            .expect("the program has it too"),
            packet,
            said: Vec::new(),
            input: Input::default(),
            palm: DVec3::ZERO,
            recentred: 0,
            released_age: None,
        };
        room.send();
        room.wait_until("the focus", |room| room.has_said("focus", "focused"));
        room.wait_until("a tracked hand", |room| room.input.hand.is_some());
        room
    }

    /// Takes the hands again after the service was started anew.
    pub fn reconnect(&mut self, service: &Service) {
        self.remote = Remote::connect(service.port()).expect("the service listens");
        self.send();
    }

    /// Whether the device's lines of the journal have said so.
    pub fn has_said(&self, key: &str, value: &str) -> bool {
        self.said.iter().any(|line| line["device"][key] == value)
    }

    /// What the device's lines of the journal say under a key, as they came.
    pub fn device(&self, key: &str) -> Vec<&Value> {
        let lines = self.said.iter().map(|line| &line["device"][key]);
        lines.filter(|value| !value.is_null()).collect()
    }

    /// The last event of a kind.
    pub fn event(&self, kind: &str) -> Option<&Value> {
        let events = self.said.iter().rev().map(|line| &line["event"]);
        events.into_iter().find(|event| event["event"] == kind)
    }

    /// How many events of a kind there were.
    pub fn count(&self, kind: &str) -> usize {
        let events = self.said.iter().map(|line| &line["event"]);
        events.filter(|event| event["event"] == kind).count()
    }

    /// Shows the runtime the packet.
    pub fn send(&mut self) {
        self.remote.send(&self.packet).expect("the service listens");
    }

    /// Reads the journal up to its end, or for one line at most `limit`.
    pub fn follow(&mut self, limit: Duration) {
        let mut limit = limit;
        while let Some(line) = self.journal.next_within(limit) {
            limit = Duration::ZERO;
            let line: Value = serde_json::from_str(&line).expect("a line of JSON");
            if line["input"].is_null() {
                if line["event"]["event"] == "released" {
                    self.released_age = self.input.trigger_change.map(|change| change.age_s);
                }
                self.said.push(line);
                continue;
            }
            let input: InputLine = serde_json::from_value(line["input"].clone()).expect("an input");
            self.input = Input::from(&input);
            self.recentred += usize::from(self.input.recentred);
            self.game.step(&self.input);
        }
    }

    /// Follows the journal until something holds.
    pub fn wait_until(&mut self, what: &str, holds: impl Fn(&Self) -> bool) {
        let begun = Instant::now();
        while !holds(self) {
            assert!(begun.elapsed() < PATIENCE, "{what} did not come about");
            self.follow(Duration::from_millis(100));
        }
    }

    /// A hand's controller.
    pub fn hand(&mut self, hand: Hand) -> &mut Controller {
        match hand {
            Hand::Left => &mut self.packet.left,
            Hand::Right => &mut self.packet.right,
        }
    }

    /// Where something of the world is for the runtime.
    pub fn tracked(&self, world: DVec3) -> DVec3 {
        self.game
            .world_from_tracking()
            .inverse()
            .transform_point(world)
    }

    /// Moves a hand to a place in the world, at leisure.
    pub fn reach(&mut self, hand: Hand, world: DVec3) {
        let target = self.tracked(world);
        let from = self.hand(hand).pose.position + self.palm;
        let seconds = (target.distance(from) / CALM).max(0.05);
        let begun = Instant::now();
        loop {
            let share = (begun.elapsed().as_secs_f64() / seconds).min(1.0);
            let position = from.lerp(target, share) - self.palm;
            let controller = self.hand(hand);
            controller.pose = Pose::new(position, DQuat::IDENTITY);
            (controller.linear_velocity, controller.angular_velocity) = (DVec3::ZERO, DVec3::ZERO);
            self.send();
            self.follow(Duration::from_millis(5));
            if share == 1.0 {
                break;
            }
        }
        self.wait_until("the hand at its place", |room| {
            let seen = room.input.hand.map(|hand| hand.pose.position);
            seen.is_some_and(|seen| seen.distance(target) < 1e-4)
        });
    }

    /// Lays down a hand's controller, and the other's too: the runtime sees hands from now on.
    pub fn lay_down_controllers(&mut self, hand: Hand) {
        for hand in [Hand::Left, Hand::Right] {
            self.hand(hand).is_bare = true;
        }
        self.send();
        let held = self.hand(hand).pose.position;
        self.wait_until("a bare hand", |room| {
            let seen = room.input.hand.map(|hand| hand.pose.position);
            seen.is_some_and(|seen| seen.distance(held) > 0.01)
        });
        let seen = self.input.hand.expect("just seen").pose.position;
        self.palm = seen - held;
    }

    /// Takes the controllers up again.
    pub fn take_up_controllers(&mut self) {
        for hand in [Hand::Left, Hand::Right] {
            self.hand(hand).is_bare = false;
        }
        self.palm = DVec3::ZERO;
        let held = self.hand(Hand::Right).pose.position;
        self.send();
        self.wait_until("a controller", |room| {
            let seen = room.input.hand.map(|hand| hand.pose.position);
            seen.is_some_and(|seen| seen.distance(held) < 1e-4)
        });
    }

    /// Holds an open hand over a ball on the rack, so that it could take it; where the hand is then.
    pub fn reach_ball(&mut self, hand: Hand) -> DVec3 {
        self.wait_until("a ball on the rack", |room| {
            room.game.observe().balls.iter().any(|ball| ball.is_on_rack)
        });
        let balls = self.game.observe().balls;
        let ball = balls
            .iter()
            .find(|ball| ball.is_on_rack)
            .expect("one is there");
        let above = ball.position + DVec3::Y * (ball.radius + 0.06);
        // The hand that closes is the one that plays: closing it first, away from everything, makes it so.
        self.hand(hand).close(1.0);
        self.send();
        let x = self.hand(hand).pose.position.x + self.palm.x;
        self.wait_until("the hand that plays", |room| {
            let seen = room.input.hand.map(|hand| hand.pose.position.x);
            seen.is_some_and(|seen| (seen - x).abs() < 1e-4) && room.input.trigger == 1.0
        });
        self.hand(hand).close(0.0);
        self.send();
        self.wait_until("an open hand", |room| room.input.trigger == 0.0);
        self.reach(hand, above + DVec3::Y * 0.3);
        self.reach(hand, above);
        above
    }

    /// Takes a ball from the rack and lifts it.
    pub fn take_ball(&mut self, hand: Hand) {
        let above = self.reach_ball(hand);
        self.hand(hand).close(1.0);
        self.send();
        self.wait_until("a ball in the hand", |room| room.game.held().is_some());
        self.reach(hand, above + DVec3::Y * 0.3);
    }

    /// Looks at a place on the floor and walks there with the thumb button of `hand`.
    pub fn walk_to(&mut self, hand: Hand, x: f64, z: f64) {
        let begun = Instant::now();
        loop {
            assert!(begun.elapsed() < PATIENCE, "({x}, {z}) is out of reach");
            let head = self.game.world_from_tracking() * self.packet.head;
            let way = DVec3::new(x - head.position.x, 0.0, z - head.position.z);
            self.hand(hand).a = way.length() > 0.25;
            if way.length() > 0.25 {
                self.packet.head.rotation = DQuat::from_rotation_y((-way.x).atan2(-way.z));
            } else {
                self.packet.head.rotation = DQuat::IDENTITY;
            }
            self.send();
            let is_walking = self.hand(hand).a;
            let before = self.game.world_from_tracking().position;
            self.follow(Duration::from_millis(200));
            let moved = self.game.world_from_tracking().position.distance(before);
            if !is_walking && moved < 1e-4 && !self.input.walk_forward {
                return;
            }
        }
    }
}

/// The ball's velocity and place as the swing has them at the packet that opened the trigger, world frame.
#[derive(Clone, Copy, Debug)]
pub struct Released {
    pub velocity: DVec3,
    pub position: DVec3,
}

/// A swing of a straight arm about the shoulder, whose angle from hanging down grows at a constant rate.
pub struct Swing {
    /// At the ball, about [m/s].
    pub speed: f64,
    /// Angle of the arm beyond the vertical at the release, forward [rad].
    pub release_at: f64,
}

impl Swing {
    /// Swings the hand that holds a ball and lets go; the runtime then shows that packet until the program has seen it.
    pub fn throw(&self, room: &mut Room, hand: Hand) -> Released {
        const ARM: f64 = 0.6;
        let head = room.game.world_from_tracking() * room.packet.head;
        let side = if hand == Hand::Left { -0.2 } else { 0.2 };
        let shoulder = DVec3::new(head.position.x + side, 1.15, head.position.z - 0.1);
        let held = room.game.world_from_tracking() * room.hand(hand).pose;
        let model = room.game.held().expect("a ball is held");
        let things = room.game.visible();
        let ball = things
            .iter()
            .find(|seen| seen.model == model)
            .expect("it is seen");
        let in_hand = held.inverse().transform_point(ball.pose.position);
        let rate = self.speed / (ARM + in_hand.length());
        let pose = |angle: f64| {
            let rotation = DQuat::from_rotation_x(angle);
            Pose::new(shoulder + rotation * DVec3::new(0.0, -ARM, 0.0), rotation)
        };
        let back = -0.9;
        room.reach(hand, pose(0.0).position);
        let tracking_from_world = room.game.world_from_tracking().inverse();
        // Back at leisure, forward at the swing's own rate.
        let swing = |room: &mut Room, from: f64, to: f64, rate: f64| {
            let begun = Instant::now();
            loop {
                let angle = from + begun.elapsed().as_secs_f64() * rate;
                let is_over = (angle - to) * rate.signum() >= 0.0;
                let at = pose(if is_over { to } else { angle });
                let angular = DVec3::X * rate;
                let controller = room.hand(hand);
                controller.pose = tracking_from_world * at;
                controller.angular_velocity = angular;
                controller.linear_velocity = angular.cross(at.position - shoulder);
                if is_over {
                    return at;
                }
                room.send();
                room.follow(Duration::from_millis(2));
            }
        };
        swing(room, 0.0, back, -1.2);
        room.send();
        let last = swing(room, back, self.release_at, rate);
        let before = room.count("released");
        room.hand(hand).trigger = 0.0;
        room.send();
        room.wait_until("the release", |room| room.count("released") > before);
        let position = last.transform_point(in_hand);
        room.hand(hand).linear_velocity = DVec3::ZERO;
        room.hand(hand).angular_velocity = DVec3::ZERO;
        room.send();
        Released {
            velocity: (DVec3::X * rate).cross(position - shoulder),
            position,
        }
    }
}
