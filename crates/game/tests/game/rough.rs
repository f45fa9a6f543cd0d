use game::{Button, Model};
use glam::{DQuat, DVec3};
use physics::{Effort, Motion, Pose};

use crate::support::{Player, RATE, STEPS, conditions};

/// Fastest that the hand is moved [m/s]: just what the game still takes for a movement.
const FASTEST: f64 = 29.0;

/// Most events, and most impulses, of a physics step for each movable body.
const BLOWS: u64 = 64;

/// Movable bodies of the alley: pins and balls.
const MOVABLE: u64 = 13;

/// Looks at pairs of parts that a step may take in the mean of a frame; at rest it is none.
const LOOKS: u64 = 5000;

/// A hand out of control: the same one for the same seed.
struct Rough {
    player: Player,
    random: u64,
    last: Effort,
    /// Largest efforts of any frame.
    worst: Effort,
    /// Fastest that anything free moved [m/s].
    top_speed: f64,
}

impl Rough {
    fn new(arguments: &[&str], seed: u64) -> Self {
        let player = Player::new(conditions(arguments), 10);
        let last = player.game.world().effort();
        Self {
            player,
            random: seed,
            last,
            worst: Effort::default(),
            top_speed: 0.0,
        }
    }

    /// A number between two, evenly.
    fn between(&mut self, low: f64, high: f64) -> f64 {
        self.random = self
            .random
            .wrapping_mul(6364136223846793005)
            .wrapping_add(1442695040888963407);
        low + (high - low) * ((self.random >> 11) as f64 / (1u64 << 53) as f64)
    }

    fn direction(&mut self) -> DVec3 {
        let y = self.between(-1.0, 1.0);
        let turn = self.between(0.0, std::f64::consts::TAU);
        let r = (1.0 - y * y).sqrt();
        DVec3::new(r * turn.cos(), y, r * turn.sin())
    }

    /// Where a ball or a pin, drawn by lot, is now [m].
    fn target(&mut self) -> DVec3 {
        let seen = self.player.game.observe();
        if self.between(0.0, 1.0) < 0.5 {
            let number = self.between(0.0, seen.balls.len() as f64) as usize;
            return seen.balls[number].position;
        }
        let pins: Vec<DVec3> = self
            .player
            .game
            .visible()
            .iter()
            .filter(|thing| matches!(thing.model, Model::Pin(_)))
            .map(|thing| thing.pose.position)
            .collect();
        let number = self.between(0.0, pins.len() as f64) as usize;
        pins.get(number).copied().unwrap_or(seen.balls[0].position) + DVec3::Y * 0.15
    }

    /// One frame with the hand at a place.
    fn frame(&mut self, at: DVec3) {
        let turn = DQuat::from_scaled_axis(self.direction() * 0.3);
        self.player.hand = Some(Pose::new(at, turn));
        self.player.frame();
        self.check();
    }

    /// What must hold after every frame, whatever the hand did.
    fn check(&mut self) {
        let world = self.player.game.world();
        for body in world.ids().map(|id| world.body(id)) {
            let (pose, linear) = (body.pose(), body.linear_velocity());
            assert!(pose.position.is_finite() && pose.rotation.is_finite() && !body.is_frozen());
            assert!(linear.is_finite() && body.angular_velocity().is_finite());
            if body.motion() == Motion::Dynamic {
                self.top_speed = self.top_speed.max(linear.length());
            }
        }
        let now = world.effort();
        // A new game is a new world.
        let spent = |now: u64, last: u64| if now < last { now } else { now - last };
        let frame = Effort {
            stretches: spent(now.stretches, self.last.stretches),
            events: spent(now.events, self.last.events),
            impulses: spent(now.impulses, self.last.impulses),
            looks: spent(now.looks, self.last.looks),
            passes: spent(now.passes, self.last.passes),
            ..Effort::default()
        };
        self.last = now;
        let blows = BLOWS * MOVABLE * u64::from(STEPS);
        assert!(
            frame.impulses <= blows && frame.events <= blows,
            "{frame:?}"
        );
        self.worst.events = self.worst.events.max(frame.events);
        self.worst.impulses = self.worst.impulses.max(frame.impulses);
        self.worst.looks = self.worst.looks.max(frame.looks);
        self.worst.passes = self.worst.passes.max(frame.passes);
    }

    /// Moves the hand along a line.
    fn line(&mut self, to: DVec3, speed: f64) {
        let from = self.player.hand.unwrap().position;
        let frames = (from.distance(to) / speed * RATE).ceil().max(1.0);
        for frame in 1..=frames as u32 {
            self.frame(from.lerp(to, f64::from(frame) / frames));
        }
    }

    /// Puts the hand somewhere without a way: the tracker lost it in between.
    fn appear(&mut self, at: DVec3) {
        self.player.hand = None;
        self.player.frame();
        self.frame(at);
    }

    /// Through something and out again.
    fn jab(&mut self) {
        let (target, way) = (self.target(), self.direction() * 0.35);
        let speed = self.between(0.5, FASTEST);
        self.appear(target - way);
        self.line(target + way, speed);
        self.line(target - way, speed);
    }

    /// Along the rack, or across the deck.
    fn sweep(&mut self) {
        let along = DVec3::Z * self.between(0.4, 0.9);
        let target = self.target() + self.direction() * 0.1;
        let speed = self.between(0.5, 12.0);
        self.appear(target - along);
        self.line(target + along, speed);
        let across = DVec3::X * self.between(-0.7, 0.7);
        self.line(target + across, speed);
    }

    /// Presses something against what is behind it, and stays there.
    fn squeeze(&mut self) {
        let target = self.target();
        let mut way = self.direction();
        if self.between(0.0, 1.0) < 0.6 {
            way = (way * 0.3 - DVec3::Y)
                .try_normalize()
                .unwrap_or(DVec3::NEG_Y);
        }
        let speed = self.between(0.1, 3.0);
        self.appear(target - way * 0.25);
        self.line(target + way * 0.15, speed);
        let held = self.player.hand.unwrap().position;
        for _ in 0..20 {
            let tremble = self.direction() * 0.02;
            self.frame(held + tremble);
        }
        self.line(target - way * 0.25, speed);
    }

    /// Takes something and pushes it into something else.
    fn carry(&mut self) {
        let from = self.target() + self.direction() * 0.12;
        self.appear(from);
        self.player.input.trigger = 1.0;
        self.frame(from);
        for _ in 0..3 {
            let to = if self.between(0.0, 1.0) < 0.5 {
                self.target()
            } else {
                from + self.direction() * 0.5
            };
            let speed = self.between(0.5, 15.0);
            if to.distance(from) < 2.0 {
                self.line(to, speed);
            } else {
                self.appear(to - DVec3::Y * 0.1);
            }
        }
        self.player.input.trigger = 0.0;
        let last = self.player.hand.unwrap().position;
        self.frame(last);
    }

    /// A cursor that jumps.
    fn jump(&mut self) {
        let target = self.target();
        self.appear(target + DVec3::Y * 0.4);
        let mut at = target + DVec3::Y * 0.4;
        for _ in 0..25 {
            let wish = target + self.direction() * self.between(0.0, 0.25);
            at += (wish - at).clamp_length_max(FASTEST / RATE);
            self.frame(at);
        }
    }

    fn play(&mut self, bouts: u32) {
        for _ in 0..bouts {
            match self.between(0.0, 5.0) as u32 {
                0 => self.jab(),
                1 => self.sweep(),
                2 => self.squeeze(),
                3 => self.carry(),
                _ => self.jump(),
            }
        }
    }
}

/// However the hand moves, a frame is a bounded amount of work, nothing is lost, and nothing gets much faster than the hand:
/// twice for what it strikes, more for what slips out of a wedge, but no endless gain between two walls.
#[test]
fn rough_hands_neither_stall_nor_break_the_alley() {
    let corners = [
        ("0.7", "0.7", 11),
        ("0.7", "0.0", 12),
        ("0.0", "0.7", 13),
        ("0.0", "0.0", 14),
        ("0.95", "1.0", 15),
    ];
    for (elasticity, friction, seed) in corners {
        let elastic = format!("objects.elasticity={elasticity}");
        let rough = format!("objects.friction_rate={friction}");
        let mut hand = Rough::new(&[&elastic, &rough], seed);
        hand.player.key(Button::Red);
        hand.play(120);
        let limit = LOOKS * u64::from(STEPS);
        assert!(hand.worst.looks < limit, "{:?}", hand.worst);
        assert!(
            hand.top_speed < 6.0 * FASTEST,
            "elasticity {elasticity}, friction rate {friction}: {} m/s",
            hand.top_speed
        );
    }
}
