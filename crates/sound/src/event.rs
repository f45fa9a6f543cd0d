//! What the mixer is told: contacts, rolling, the machine, and where the ears are. Plain numbers.

use glam::{DQuat, DVec3};

use crate::material::Material;

/// Two bodies struck each other.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Impact {
    /// Where, world frame [m].
    pub point: DVec3,
    /// What the two are made of, in any order.
    pub materials: [Material; 2],
    /// Their masses [kg], in the same order; infinite for what does not move.
    pub masses: [f64; 2],
    /// Size of the impulse between them [N s].
    pub impulse: f64,
    /// Speed at which they approached along the normal [m/s].
    pub approach_speed: f64,
}

/// A ball rolls on something, as told once per frame.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Rolling {
    /// Which ball: each number is a source of its own, below [`ROLLERS`](crate::ROLLERS).
    pub body: u8,
    /// Where it touches, world frame [m].
    pub point: DVec3,
    /// How fast its centre moves [m/s].
    pub speed: f64,
    /// What it rolls on.
    pub surface: Material,
}

/// Where the participant's head is.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Listener {
    /// Midway between the ears, world frame [m].
    pub position: DVec3,
    /// `world_from_head`: x to the right ear, -z ahead.
    pub orientation: DQuat,
}

impl Default for Listener {
    /// A standing bowler's head at the foul line, looking down the lane.
    fn default() -> Self {
        Listener {
            position: DVec3::new(0.0, 1.6, 0.0),
            orientation: DQuat::IDENTITY,
        }
    }
}

/// Something that the mixer hears of.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Sounding {
    /// Two bodies struck each other.
    Impact(Impact),
    /// A ball rolls; when it is not told of for 0.1 s it fades.
    Rolling(Rolling),
    /// The pinsetter's motor runs, or stops.
    Machine {
        /// Whether it runs now.
        is_running: bool,
        /// Where it stands, world frame [m].
        point: DVec3,
    },
    /// A button was pressed that is not due: a soft, dull note, unlike any blow of the alley.
    Refusal {
        /// Where the button is, world frame [m].
        point: DVec3,
    },
    /// The head moved.
    Listener(Listener),
}

/// Something that sounds, and when.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Event {
    /// Time since the sound began [s], in the clock of what is simulated.
    pub time_s: f64,
    /// What.
    pub sounding: Sounding,
}
