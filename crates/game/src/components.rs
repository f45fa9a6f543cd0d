//! What entities are made of.

use glam::DVec3;
use hecs::Entity;
use physics::{BodyId, Pose};

use crate::visible::Model;

/// It is a body of the physics world.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Physical(pub BodyId);

/// It is only seen, and stays where it is: `world_from_model`.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Painted(pub Pose);

/// It can be seen.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Shown {
    pub model: Model,
    /// Full extents of the model [m].
    pub size: DVec3,
    /// The model's origin in the body's frame.
    pub body_from_model: Pose,
    pub is_hidden: bool,
}

/// The hand may close on it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Grabbable;

/// A pin of the rack.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Pin {
    /// Number of its spot, from 1.
    pub number: u8,
    /// Its spot on the deck [m].
    pub spot: DVec3,
    /// Where it stood when the next delivery was made ready; `None` when it is out of this rack.
    pub ready: Option<Pose>,
    /// Since which step it has lain in the pit.
    pub in_pit_since: Option<u64>,
    /// Who has it.
    pub keeper: PinKeeper,
}

/// Who has a pin.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum PinKeeper {
    /// Nobody: it stands, lies or flies.
    Nobody,
    /// The pinsetter moves it.
    Pinsetter,
    /// The pinsetter has put it away.
    Store,
}

/// A ball of the rack.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Ball {
    /// Its number, from 0.
    pub index: u8,
    /// Its centre when it lies in its cell [m].
    pub home: DVec3,
    /// Radius [m].
    pub radius: f64,
    /// True once it has crossed the foul line, out of a hand.
    pub is_beyond: bool,
    /// True from its crossing until a hand or the rack has it again: it cannot be delivered twice.
    pub is_spent: bool,
    /// Whether the head was beyond the foul line when the hand last let it go.
    pub foul: Option<bool>,
    /// Since which step it has lain outside its cell.
    pub astray_since: Option<u64>,
    /// Where the ball return has it.
    pub journey: Journey,
}

/// The way of a ball back to the rack.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Journey {
    /// None: it is in the room.
    InRoom,
    /// Under the floor, since this step.
    Below(u64),
    /// On the lift into its cell, since this step.
    Lift(u64),
}

/// A button on the desk.
#[derive(Clone, Copy, Debug)]
pub(crate) struct PushButton {
    /// Middle of its foot on the desk [m].
    pub foot: DVec3,
    /// How far it is pressed down [m].
    pub depression: f64,
    /// True from the press until it has come up again.
    pub is_pressed: bool,
}

/// Something in the hand.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Held {
    pub entity: Entity,
    pub hand_from_body: Pose,
}
