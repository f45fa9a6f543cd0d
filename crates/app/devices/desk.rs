//! The desk: mouse, keys and gamepad stand in for a tracked head and hand.
//!
//! The hand hangs on an arm that swings about the shoulder, as a bowler's does: the cursor's height is the arm's angle,
//! its side the hand's side, the wheel the arm's length. Pulling the mouse back and pushing it forward is a backswing and
//! a throw. A gamepad moves the same arm: it is the 3D mouse of the paper (§3), two thumb buttons to walk, the trigger
//! to grab.

use super::Device;
use game::{Game, Input, Tracked};
use glam::{DQuat, DVec2, DVec3};
use physics::Pose;
use std::collections::VecDeque;
use std::f64::consts::{FRAC_PI_2, PI};

/// Arm angle about the shoulder at the window's lower and upper edge [rad]; 0 hangs down, pi/2 points ahead.
const ARM_ANGLE: [f64; 2] = [-0.75, 2.0];
/// Hand's sideways travel from the shoulder's plane at the window's edges [m].
const SIDE_TRAVEL: f64 = 0.55;
/// Arm length reached with the wheel, shoulder to palm [m].
const ARM_LENGTH: [f64; 2] = [0.30, 0.85];
/// Arm length per notch of the wheel [m].
const ARM_PER_NOTCH: f64 = 0.04;
/// Throwing shoulder from the eyes, before the head turns: right, up, back [m].
const SHOULDER: DVec3 = DVec3::new(0.18, -0.28, 0.0);
/// Head rotation per pixel of a drag [rad].
const LOOK_PER_PIXEL: f64 = 0.004;
/// Head rotation speed by key or stick [rad/s].
const TURN_SPEED: f64 = 1.4;
/// Cursor speed by a gamepad's stick, window half-widths per second.
const STICK_SPEED: f64 = 2.5;
/// A stick this close to its middle counts as at rest.
const STICK_DEAD: f64 = 0.12;

/// What a window or a gamepad tells the desk.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum DeskEvent {
    /// Cursor, -1..1 across the window, y up.
    Cursor(DVec2),
    /// Drag with the right button [pixels], y down: turns the head.
    Look(DVec2),
    /// Wheel notches, positive away from the user: lengthens the arm.
    Wheel(f64),
    /// Trigger by mouse button.
    Grab(bool),
    /// A walking or turning key went down or up.
    Hold(Hold, bool),
    /// Red or Blue was pressed.
    Press(game::Button),
    /// Pause, or go on.
    Pause,
    /// Back to the start, facing the lane.
    Recentre,
}

/// Keys that act while they are held.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Hold {
    /// Walk along the gaze.
    Forward,
    /// Walk backward.
    Back,
    /// Turn the head to the left.
    TurnLeft,
    /// Turn the head to the right.
    TurnRight,
}

/// A gamepad's state: sticks -1..1 (y up), trigger 0..1.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Gamepad {
    /// Moves the hand.
    pub left_stick: DVec2,
    /// Turns the head (x) and lengthens the arm (y).
    pub right_stick: DVec2,
    /// Closes the hand.
    pub trigger: f64,
    /// Left thumb button: walk forward.
    pub forward: bool,
    /// Right thumb button: walk backward.
    pub back: bool,
}

/// A place that the cursor passed, or what the trigger did between two of them.
#[derive(Clone, Copy, Debug)]
enum Mark {
    Cursor(DVec2),
    Grab(bool),
}

/// Head and hand as mouse, keys and gamepad hold them now.
pub struct Desk {
    eye_height: f64,
    steps: u32,
    frame_s: f64,
    /// Inputs over which `trail` is spread, and how many of them have been taken.
    due: u32,
    taken: u32,
    yaw: f64,
    pitch: f64,
    arm: f64,
    /// Where the cursor is at the last input.
    cursor: DVec2,
    grab: bool,
    /// What happened since, in its order.
    trail: VecDeque<Mark>,
    /// Part of the way to the trail's first place that is done, 0 to 1.
    passed: f64,
    held: [bool; 4],
    pressed: [bool; 2],
    is_paused: bool,
    recentre: bool,
    pad: Gamepad,
}

impl Desk {
    /// A desk whose eyes are `eye_height` [m] above the floor, and whose every input advances `steps` physics steps in
    /// `frame_s` [s].
    pub fn new(eye_height: f64, steps: u32, frame_s: f64) -> Self {
        let cursor = DVec2::new(0.1, -0.2);
        Self {
            eye_height,
            steps,
            frame_s,
            due: 1,
            taken: 0,
            yaw: 0.0,
            pitch: -0.2,
            arm: 0.62,
            cursor,
            grab: false,
            trail: VecDeque::new(),
            passed: 0.0,
            held: [false; 4],
            pressed: [false; 2],
            is_paused: false,
            recentre: false,
            pad: Gamepad::default(),
        }
    }

    /// Takes in one event.
    pub fn handle(&mut self, event: DeskEvent) {
        match event {
            DeskEvent::Cursor(at) => self
                .trail
                .push_back(Mark::Cursor(at.clamp(-DVec2::ONE, DVec2::ONE))),
            DeskEvent::Look(pixels) => self.turn(-pixels * LOOK_PER_PIXEL),
            DeskEvent::Wheel(notches) => self.stretch(notches * ARM_PER_NOTCH),
            DeskEvent::Grab(closed) => self.trail.push_back(Mark::Grab(closed)),
            DeskEvent::Hold(key, down) => self.held[key as usize] = down,
            DeskEvent::Press(game::Button::Red) => self.pressed[0] = true,
            DeskEvent::Press(game::Button::Blue) => self.pressed[1] = true,
            DeskEvent::Pause => self.is_paused = !self.is_paused,
            DeskEvent::Recentre => self.recentre = true,
        }
    }

    /// Lets go of everything: the window lost the keyboard, so releases may never arrive.
    pub fn let_go(&mut self) {
        self.held = [false; 4];
        self.handle(DeskEvent::Grab(false));
    }

    /// Takes the gamepad's state; it adds to mouse and keys.
    pub fn set_gamepad(&mut self, pad: Gamepad) {
        let alive = |stick: DVec2| {
            if stick.length() < STICK_DEAD {
                DVec2::ZERO
            } else {
                stick
            }
        };
        self.pad = Gamepad {
            left_stick: alive(pad.left_stick),
            right_stick: alive(pad.right_stick),
            ..pad
        };
    }

    /// Announces that the next `count` inputs are due at once, because a picture took that long.
    ///
    /// What the mouse did since the last one is spread evenly over them, in its order: a throw's speed and the moment of
    /// its release do not depend on how fast the window is drawn.
    pub fn due(&mut self, count: u32) {
        self.due = count.max(1);
        self.taken = 0;
    }

    /// Follows the cursor's trail for one input.
    fn follow(&mut self) {
        let left = f64::from(self.due.saturating_sub(self.taken).max(1));
        self.taken += 1;
        let steps = self
            .trail
            .iter()
            .filter(|mark| matches!(mark, Mark::Cursor(_)))
            .count();
        // An equal share of what is left, so that the last input of a batch ends the trail.
        let mut way = (steps as f64 - self.passed) / left;
        while let Some(mark) = self.trail.front().copied() {
            match mark {
                Mark::Grab(closed) => self.grab = closed,
                Mark::Cursor(at) if way >= 1.0 - self.passed - 1e-9 => {
                    self.cursor = at;
                    way -= 1.0 - self.passed;
                    self.passed = 0.0;
                }
                Mark::Cursor(at) => {
                    self.cursor = self.cursor.lerp(at, way / (1.0 - self.passed));
                    self.passed += way;
                    return;
                }
            }
            self.trail.pop_front();
        }
    }

    /// Moves what the mouse, a held key or a stick moves in one frame.
    fn advance(&mut self) {
        self.follow();
        let frame_s = self.frame_s;
        self.cursor += self.pad.left_stick * STICK_SPEED * frame_s;
        self.cursor = self.cursor.clamp(-DVec2::ONE, DVec2::ONE);
        let held = |key: Hold| f64::from(u8::from(self.held[key as usize]));
        let turn = held(Hold::TurnLeft) - held(Hold::TurnRight) - self.pad.right_stick.x;
        let stretch = self.pad.right_stick.y * 0.5 * frame_s;
        self.turn(DVec2::new(turn * TURN_SPEED * frame_s, 0.0));
        self.stretch(stretch);
    }

    /// The next input: needs no game, since a person looks at the window instead.
    fn take(&mut self) -> Input {
        self.advance();
        self.input()
    }

    fn turn(&mut self, by: DVec2) {
        self.yaw = (self.yaw + by.x + PI).rem_euclid(2.0 * PI) - PI;
        self.pitch = (self.pitch + by.y).clamp(-1.3, 1.3);
    }

    fn stretch(&mut self, by: f64) {
        self.arm = (self.arm + by).clamp(ARM_LENGTH[0], ARM_LENGTH[1]);
    }

    fn input(&mut self) -> Input {
        let heading = DQuat::from_rotation_y(self.yaw);
        let head = Pose {
            position: DVec3::Y * self.eye_height,
            rotation: heading * DQuat::from_rotation_x(self.pitch),
        };
        let up = 0.5 * (self.cursor.y + 1.0);
        let angle = ARM_ANGLE[0] + (ARM_ANGLE[1] - ARM_ANGLE[0]) * up;
        let arm = DQuat::from_rotation_x(angle) * (DVec3::NEG_Y * self.arm);
        let side = DVec3::X * (self.cursor.x * SIDE_TRAVEL);
        let hand = Pose {
            position: head.position + heading * (SHOULDER + side + arm),
            rotation: heading * DQuat::from_rotation_x(angle - FRAC_PI_2),
        };
        let [press_red, press_blue] = std::mem::take(&mut self.pressed);
        Input {
            head: Some(Tracked {
                pose: head,
                velocity: None,
            }),
            hand: Some(Tracked {
                pose: hand,
                velocity: None,
            }),
            trigger: if self.grab { 1.0 } else { self.pad.trigger },
            walk_forward: self.held[Hold::Forward as usize] || self.pad.forward,
            walk_back: self.held[Hold::Back as usize] || self.pad.back,
            press_red,
            press_blue,
            locked: [false; 2],
            recentred: false,
            paused: self.is_paused,
            recentre: std::mem::take(&mut self.recentre),
            is_left: false,
            steps: if self.is_paused { 0 } else { self.steps },
            trigger_change: None,
        }
    }
}

impl Device for Desk {
    fn next(&mut self, _game: &Game) -> Input {
        self.take()
    }

    /// A person ends a session by closing the window.
    fn is_done(&self) -> bool {
        false
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const FRAME_S: f64 = 1.0 / 90.0;

    fn desk() -> Desk {
        Desk::new(1.6, 8, FRAME_S)
    }

    fn hand(input: &Input) -> DVec3 {
        input
            .hand
            .as_ref()
            .expect("the desk always tracks the hand")
            .pose
            .position
    }

    #[test]
    fn pushing_the_mouse_swings_the_arm_forward_and_up() {
        let mut desk = desk();
        desk.handle(DeskEvent::Cursor(DVec2::new(0.0, -1.0)));
        let back = hand(&desk.take());
        desk.handle(DeskEvent::Cursor(DVec2::new(0.0, 0.4)));
        let front = hand(&desk.take());
        assert!(back.z > 0.2, "backswing lies behind the body: {back}");
        assert!(
            front.z < -0.3 && front.y > back.y,
            "the hand comes forward and up: {front}"
        );
    }

    #[test]
    fn inputs_spread_the_cursor_over_a_slow_frame() {
        let mut desk = desk();
        desk.handle(DeskEvent::Cursor(DVec2::new(-0.5, 0.0)));
        desk.take();
        desk.handle(DeskEvent::Cursor(DVec2::new(0.5, 0.0)));
        desk.due(5);
        let xs: Vec<f64> = (0..5).map(|_| hand(&desk.take()).x).collect();
        for pair in xs.windows(2) {
            assert!(
                (pair[1] - pair[0] - 0.2 * SIDE_TRAVEL).abs() < 1e-12,
                "uneven steps {xs:?}"
            );
        }
    }

    #[test]
    fn a_release_happens_where_the_cursor_was_in_mid_swing() {
        let mut desk = desk();
        desk.handle(DeskEvent::Grab(true));
        desk.handle(DeskEvent::Cursor(DVec2::new(0.0, -0.5)));
        desk.take();
        for y in [-0.3, -0.1, 0.1] {
            desk.handle(DeskEvent::Cursor(DVec2::new(0.0, y)));
        }
        desk.handle(DeskEvent::Grab(false));
        for y in [0.3, 0.5, 0.7] {
            desk.handle(DeskEvent::Cursor(DVec2::new(0.0, y)));
        }
        desk.due(12);
        let inputs: Vec<Input> = (0..12).map(|_| desk.take()).collect();
        let triggers: Vec<bool> = inputs.iter().map(|input| input.trigger > 0.5).collect();
        let expected: Vec<bool> = (1..=12).map(|i| i < 6).collect();
        assert_eq!(
            triggers, expected,
            "half of the trail is before the release"
        );
        let steps: Vec<f64> = inputs
            .windows(2)
            .map(|w| hand(&w[0]).distance(hand(&w[1])))
            .collect();
        let (least, most) = (
            steps.iter().copied().fold(9.0, f64::min),
            steps.iter().copied().fold(0.0, f64::max),
        );
        assert!(most < 1.05 * least, "the swing keeps its pace: {steps:?}");
    }

    #[test]
    fn a_press_is_reported_once() {
        let mut desk = desk();
        desk.handle(DeskEvent::Press(game::Button::Blue));
        let inputs: Vec<Input> = (0..3).map(|_| desk.take()).collect();
        let presses: Vec<bool> = inputs.iter().map(|i| i.press_blue).collect();
        assert_eq!(presses, [true, false, false]);
        assert!(inputs.iter().all(|i| !i.press_red));
    }

    #[test]
    fn a_pause_lasts_until_the_key_is_pressed_again() {
        let mut desk = desk();
        let mut take = |event: Option<DeskEvent>| {
            event.into_iter().for_each(|event| desk.handle(event));
            let input = desk.take();
            (input.paused, input.steps, input.recentre)
        };
        assert_eq!(take(None), (false, 8, false));
        assert_eq!(take(Some(DeskEvent::Pause)), (true, 0, false));
        assert_eq!(take(Some(DeskEvent::Recentre)), (true, 0, true));
        assert_eq!(take(None), (true, 0, false));
        assert_eq!(take(Some(DeskEvent::Pause)), (false, 8, false));
    }

    #[test]
    fn turning_carries_the_hand_around_the_head() {
        let mut desk = desk();
        let ahead = hand(&desk.take());
        desk.handle(DeskEvent::Look(DVec2::new(
            -FRAC_PI_2 / LOOK_PER_PIXEL,
            0.0,
        )));
        let left = hand(&desk.take());
        let turned = DQuat::from_rotation_y(FRAC_PI_2) * ahead;
        assert!((left - turned).length() < 1e-9, "{left} is not {turned}");
    }

    #[test]
    fn a_gamepad_walks_grabs_and_moves_the_hand() {
        let mut desk = desk();
        let before = hand(&desk.take());
        desk.set_gamepad(Gamepad {
            left_stick: DVec2::new(1.0, 0.0),
            trigger: 0.8,
            forward: true,
            ..Gamepad::default()
        });
        let input = desk.take();
        assert!(input.walk_forward && !input.walk_back);
        assert_eq!(input.trigger, 0.8);
        assert!(hand(&input).x > before.x);
    }

    #[test]
    fn losing_the_keyboard_lets_go() {
        let mut desk = desk();
        desk.handle(DeskEvent::Hold(Hold::Forward, true));
        desk.handle(DeskEvent::Grab(true));
        desk.let_go();
        let input = desk.take();
        assert!(!input.walk_forward && input.trigger == 0.0);
    }
}
