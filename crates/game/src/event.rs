//! What happened: facts for the journal, the sound and the haptics.

use glam::DVec3;
use serde::{Deserialize, Serialize};

use crate::condition::Button;
use crate::score::Roll;
use crate::visible::Model;

/// One fact, and when it became one.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Event {
    /// Physics steps since the session began.
    pub step: u64,
    /// What happened.
    #[serde(flatten)]
    pub kind: EventKind,
}

/// How a release velocity came about.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum ReleaseSource {
    /// `v + w x r` from the velocities that the device supplied.
    Velocity,
    /// A fit to the last poses.
    Poses,
}

/// One way to say how fast a held body's centre moves at the release; world frame.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct ReleaseVelocity {
    /// Velocity of the body's centre of mass [m/s].
    pub linear: DVec3,
    /// Angular velocity [rad/s].
    pub angular: DVec3,
}

/// What a release was helped by.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Assist {
    /// Share of its angle to the lane's axis that it was to lose.
    pub share: f64,
    /// How far it was turned, to the left as positive, about the vertical [rad].
    pub turned_rad: f64,
}

/// Everything about one release.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Release {
    /// What was let go.
    pub model: Model,
    /// What the body got.
    pub used: ReleaseVelocity,
    /// Where that came from.
    pub source: ReleaseSource,
    /// How it was helped; `None` where [`crate::config::ReleaseConfig::assist_share`] is 0 or it was no ball.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub assist: Option<Assist>,
    /// The estimate from the device's velocities, where it supplied them.
    pub from_velocity: Option<ReleaseVelocity>,
    /// The estimate from the last poses, where there were enough.
    pub from_poses: Option<ReleaseVelocity>,
    /// Speed of the body's centre [m/s].
    pub speed: f64,
    /// Where the centre was, world frame [m].
    pub position: DVec3,
}

/// The kinds of facts.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(tag = "event", rename_all = "snake_case")]
pub enum EventKind {
    /// The hand began to touch something.
    Touched {
        /// What it touches.
        model: Model,
    },
    /// The hand closed on something.
    Grabbed {
        /// What it holds.
        model: Model,
    },
    /// The hand let go.
    Released(Release),
    /// The hand has been lost for so long that what it held fell.
    Dropped {
        /// What it held.
        model: Model,
    },
    /// A button in the room, or its key, was pressed.
    Pressed {
        /// Which.
        button: Button,
    },
    /// A button was pressed while it was locked: nothing happens.
    Refused {
        /// Which.
        button: Button,
    },
    /// A game is being played: the button asks for a second press.
    ConfirmAsked {
        /// Which button was pressed.
        button: Button,
    },
    /// A game began.
    GameStarted {
        /// Under which button.
        button: Button,
    },
    /// A ball crossed the foul line.
    ThrowStarted {
        /// Frame, from 1; zero in practice.
        frame: u32,
        /// Ball of the frame, from 1; zero in practice.
        ball: u32,
        /// The ball's velocity, world frame [m/s].
        velocity: DVec3,
    },
    /// The head was beyond the foul line when the ball was let go.
    Foul,
    /// The ball, or what it set moving, struck the first pin of a throw.
    FirstHit {
        /// Pin, from 1.
        pin: u8,
        /// Velocity of the ball just after the strike, world frame [m/s].
        ball_velocity: DVec3,
    },
    /// Two things struck each other. At most one for each pair and frame: the hardest.
    Impact {
        /// One of them.
        a: Model,
        /// The other.
        b: Model,
        /// Where, world frame [m].
        point: DVec3,
        /// Speed of approach [m/s].
        approach_speed: f64,
        /// Size of the impulse [N s].
        impulse: f64,
    },
    /// The throw ended and the pins were counted.
    Settled {
        /// Pins that this throw felled.
        fallen: Vec<u8>,
        /// Pins that stand.
        standing: Vec<u8>,
        /// Which rule ended the throw.
        reason: EndReason,
    },
    /// A delivery was written on the score sheet.
    Rolled {
        /// Under which button.
        button: Button,
        /// Frame, from 1.
        frame: u32,
        /// Ball of the frame, from 1.
        ball: u32,
        /// What is written.
        roll: Roll,
    },
    /// A frame is complete.
    FrameScored {
        /// Under which button.
        button: Button,
        /// Frame, from 1.
        frame: u32,
        /// Its marks, as on a score sheet.
        marks: String,
        /// Sum of the scores that are known.
        total: u32,
    },
    /// The game is over.
    GameOver {
        /// Under which button.
        button: Button,
        /// Final score.
        total: u32,
    },
    /// The pinsetter has finished and the next ball may be delivered.
    PinsReady {
        /// Pins that stand.
        standing: Vec<u8>,
    },
    /// A ball lies on the rack again.
    BallReturned {
        /// Which ball, from 0.
        ball: u8,
    },
    /// The session is paused: nothing moves until it is resumed.
    Paused,
    /// It goes on.
    Resumed,
    /// The participant was put back to the start, facing the lane.
    WentToStart,
    /// Height and reach were measured, and what must be reached was placed.
    Calibrated {
        /// Height of the eyes over the floor that they sit or stand on [m].
        eye_height_m: f64,
        /// From the head to the hand of a stretched arm, over the floor [m].
        reach_m: f64,
        /// They sit, and were lifted.
        is_seated: bool,
        /// Height of the rack's tray from now on [m].
        tray_height_m: f64,
        /// Height of the desk from now on [m].
        desk_height_m: f64,
    },
    /// The tracker lost the head or the hand, or found it again.
    Tracking {
        /// Which.
        part: TrackedPart,
        /// Whether it is tracked now.
        found: bool,
    },
}

/// Why a throw ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum EndReason {
    /// Everything that counts is still.
    Still,
    /// Time since the ball passed the head pin ran out.
    AfterHeadPin,
    /// Time since the ball crossed the foul line ran out.
    AfterFoulLine,
}

/// What a tracker follows.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum TrackedPart {
    /// The head.
    Head,
    /// The hand.
    Hand,
}
