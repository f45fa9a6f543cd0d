//! The journal: everything that the game consumed, one JSON line each, in the order it happened.
//!
//! A line is handed to the writer before the game sees it. How lines are numbered, checked and written is
//! [`experiment::journal`]'s; here is what they mean.

mod changes;
pub mod older;
mod read;
pub mod settings;
mod write;

use game::{Conditions, Input, Tracked, TriggerChange, Velocity};
use glam::{DQuat, DVec3};
use physics::Pose;
use serde::{Deserialize, Serialize, Serializer};
use serde_json::Value;

pub use changes::Changes;
pub use experiment::journal::SCHEMA;
pub use read::{DeviceLine, Recording, Story, kept, read, read_open};
pub use write::Journal;

use crate::boundary::Refused;

/// One line's content: read as any version wrote it; written with the game's own events, and with what may still be put
/// into words.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Entry<E = Value, D = Value> {
    /// The first line.
    Header(Box<Header>),
    /// What the game consumed in one frame.
    Input(InputLine),
    /// Something that happened in the frame of the last input line.
    Event(E),
    /// What the device said of itself in that frame, or before the first. The game never reads it.
    Device(D),
    /// What the experiment noted: a stage, an answer, a remark. The game never reads it.
    Study(Value),
    /// The last line of a session that was closed in order.
    End(End),
}

/// What a device says: a value, or what the thread that writes puts into words, which takes a frame no time.
pub enum Said {
    /// A value.
    Now(Value),
    /// What makes one: of nothing that the experimenter is told, for only the journal hears it.
    Later(Box<dyn Fn() -> Value + Send>),
}

impl Said {
    /// What `words` will say.
    pub fn later(words: impl Fn() -> Value + Send + 'static) -> Self {
        Self::Later(Box::new(words))
    }
}

impl From<Value> for Said {
    fn from(value: Value) -> Self {
        Self::Now(value)
    }
}

impl Serialize for Said {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        match self {
            Self::Now(value) => value.serialize(serializer),
            Self::Later(words) => words().serialize(serializer),
        }
    }
}

/// What a session was.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Header {
    /// [`SCHEMA`] of the program that wrote it.
    pub schema: u32,
    /// Version of that program.
    pub program: String,
    /// Commit that it was built from, or `unknown`.
    pub commit: String,
    /// Who bowled: `headset`, `desk` or `script`.
    pub device: String,
    /// Seed of the scripted participant.
    pub seed: u64,
    /// Frames per second of the device [Hz].
    pub rate_hz: f64,
    /// Display profile of pictures and videos.
    pub display: String,
    /// Bowling frames per game.
    pub frames: u32,
    /// Scene that the configurations came from.
    pub scene: String,
    /// Resolved settings of the room and of both conditions; a study keeps them with its plan instead, because they
    /// would tell which condition is which.
    #[serde(
        default,
        skip_serializing_if = "Option::is_none",
        deserialize_with = "older::of_header"
    )]
    pub conditions: Option<Conditions>,
    /// In a study: the salted SHA-256 of the settings, which tells that the plan's are those that were played.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub settings_digest: Option<String>,
    /// Where this journal takes up a session that was broken off.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub continues: Option<Continues>,
}

/// The place in earlier journals at which a resumed session begins.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Continues {
    /// File name of the journal before this one, in the same folder.
    pub journal: String,
    /// How many of its inputs count; the session began anew behind them.
    pub inputs: u64,
    /// State hash of the game behind them, sixteen hexadecimal digits.
    pub hash: String,
}

/// How a session ended.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct End {
    /// State hash of the game, sixteen hexadecimal digits.
    pub hash: String,
    /// Inputs of the whole session, those that count of earlier journals included.
    pub inputs: u64,
    /// False when somebody ended the session before both games were over.
    pub complete: bool,
    /// Final or last score under Red; `None` when no such game was started.
    pub red: Option<u32>,
    /// The same under Blue.
    pub blue: Option<u32>,
    /// Readings that the device boundary refused.
    pub refused: Refused,
}

/// A state hash as it is printed and recorded.
pub fn hash_text(hash: u64) -> String {
    format!("{hash:016x}")
}

/// One input as an array: steps, buttons, trigger, head, hand, and the trigger's last change where it is known.
///
/// Buttons are a sum: 1 walk forward, 2 walk back, 4 Red, 8 Blue, 16 Red locked, 32 Blue locked, 64 a new tracking space, 128 paused,
/// 256 back to the start, 512 a left hand.
/// Head and hand are `null` when not tracked, else position, rotation (x, y, z, w) and, when measured, linear and angular
/// velocity. The change is its age in seconds and the hand then; it is left out where there is none.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct InputLine(
    u32,
    u16,
    f64,
    Option<TrackedLine>,
    Option<TrackedLine>,
    #[serde(default, skip_serializing_if = "Option::is_none")] Option<Box<(f64, TrackedLine)>>,
);

#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(untagged)]
enum TrackedLine {
    Moving([f64; 13]),
    Still([f64; 7]),
}

impl From<&Input> for InputLine {
    fn from(input: &Input) -> Self {
        let buttons = [
            input.walk_forward,
            input.walk_back,
            input.press_red,
            input.press_blue,
            input.locked[0],
            input.locked[1],
            input.recentred,
            input.paused,
            input.recentre,
            input.is_left,
        ];
        let sum = buttons
            .iter()
            .enumerate()
            .map(|(bit, pressed)| u16::from(*pressed) << bit)
            .sum();
        let (head, hand) = (input.head.as_ref(), input.hand.as_ref());
        InputLine(
            input.steps,
            sum,
            input.trigger,
            head.map(TrackedLine::from),
            hand.map(TrackedLine::from),
            input
                .trigger_change
                .map(|change| Box::new((change.age_s, TrackedLine::from(&change.hand)))),
        )
    }
}

impl From<&InputLine> for Input {
    fn from(line: &InputLine) -> Self {
        let InputLine(steps, buttons, trigger, head, hand, change) = line;
        let pressed = |bit: u16| buttons & (1 << bit) != 0;
        Input {
            head: head.as_ref().map(Tracked::from),
            hand: hand.as_ref().map(Tracked::from),
            trigger: *trigger,
            walk_forward: pressed(0),
            walk_back: pressed(1),
            press_red: pressed(2),
            press_blue: pressed(3),
            locked: [pressed(4), pressed(5)],
            recentred: pressed(6),
            paused: pressed(7),
            recentre: pressed(8),
            is_left: pressed(9),
            steps: *steps,
            trigger_change: change.as_deref().map(|(age_s, hand)| TriggerChange {
                age_s: *age_s,
                hand: Tracked::from(hand),
            }),
        }
    }
}

impl From<&Tracked> for TrackedLine {
    fn from(tracked: &Tracked) -> Self {
        let p = tracked.pose.position;
        let r = tracked.pose.rotation;
        match tracked.velocity {
            None => TrackedLine::Still([p.x, p.y, p.z, r.x, r.y, r.z, r.w]),
            Some(Velocity {
                linear: v,
                angular: w,
            }) => TrackedLine::Moving([
                p.x, p.y, p.z, r.x, r.y, r.z, r.w, v.x, v.y, v.z, w.x, w.y, w.z,
            ]),
        }
    }
}

impl From<&TrackedLine> for Tracked {
    fn from(line: &TrackedLine) -> Self {
        let (numbers, velocity): (&[f64], _) = match line {
            TrackedLine::Still(numbers) => (numbers, None),
            TrackedLine::Moving(numbers) => (
                numbers,
                Some(Velocity {
                    linear: DVec3::from_slice(&numbers[7..]),
                    angular: DVec3::from_slice(&numbers[10..]),
                }),
            ),
        };
        Tracked {
            pose: Pose {
                position: DVec3::from_slice(numbers),
                rotation: DQuat::from_slice(&numbers[3..]),
            },
            velocity,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn input_line_keeps_every_bit_of_an_input() {
        let tracked = Tracked {
            pose: Pose {
                position: DVec3::new(0.1, -1e-17, 3.0),
                rotation: DQuat::from_rotation_z(0.3),
            },
            velocity: Some(Velocity {
                linear: DVec3::new(1.0 / 3.0, 2.0, 3.0),
                angular: DVec3::NEG_X,
            }),
        };
        let input = Input {
            head: Some(Tracked {
                velocity: None,
                ..tracked
            }),
            hand: Some(tracked),
            trigger: 0.1 + 0.2,
            walk_forward: true,
            walk_back: false,
            press_red: false,
            press_blue: true,
            locked: [false, true],
            recentred: true,
            paused: true,
            recentre: true,
            is_left: true,
            steps: 8,
            trigger_change: None,
        };
        let text = serde_json::to_string(&InputLine::from(&input)).expect("plain numbers");
        let line: InputLine = serde_json::from_str(&text).expect("just written");
        assert_eq!(Input::from(&line), input);
        assert!(text.starts_with("[8,1001,0.30000000000000004,["), "{text}");
        let changed = Input {
            trigger_change: Some(TriggerChange {
                age_s: 0.1 / 3.0,
                hand: tracked,
            }),
            ..input
        };
        let text = serde_json::to_string(&InputLine::from(&changed)).expect("plain numbers");
        let line: InputLine = serde_json::from_str(&text).expect("just written");
        assert_eq!(Input::from(&line), changed);
    }
}
