//! From what a headset reads to what the game consumes: which hand throws, how many steps are due.

use crate::scenery::hand::Fingers;
use game::{Input, Tracked, TriggerChange, Velocity};
use glam::{DMat3, DQuat, DVec3};
use physics::Pose;
use renderer::headset::{Change, HandReading, Readings, Side, TrackedPose};

use super::LONGEST_CATCH_UP_S;
use crate::wrist::Arms;

/// A hand that closes further than this takes over from one that is open.
const TAKES_OVER: f64 = 0.5;
/// Times of display jitter by less than this share of a step, which must not cost a step.
const JITTER: f64 = 0.02;

/// The participant in a headset.
#[derive(Debug)]
pub struct Participant {
    step_hz: f64,
    throwing: Side,
    /// Trigger and squeeze of the hand that throws, in the last frame.
    before: [f64; 2],
    /// Hands whose buttons were down when hands changed roles: they mean nothing until all are up.
    ignored: [bool; 2],
    /// Whether the hand that throws was bare in the last frame.
    was_bare: bool,
    /// Time of display of the last frame that was played [ns].
    played_ns: Option<i64>,
    /// Steps by which the alley is ahead of the display, because steps are whole, from 0 to 1.
    ahead: f64,
    /// Time of display from which on tracking space is a new one [ns], while no frame has been played in it.
    recentre_ns: Option<i64>,
}

impl Participant {
    /// Somebody whose right hand throws until the left one closes.
    pub fn new(step_hz: f64) -> Self {
        Self {
            step_hz,
            throwing: Side::Right,
            before: [0.0; 2],
            ignored: [false; 2],
            was_bare: false,
            played_ns: None,
            ahead: 0.0,
            recentre_ns: None,
        }
    }

    /// The hand that throws.
    pub fn throwing(&self) -> Side {
        self.throwing
    }

    fn is_left(&self) -> bool {
        self.throwing == Side::Left
    }

    /// Hears that tracking space is laid anew for what is seen at `display_ns` or later.
    pub fn recentre(&mut self, display_ns: i64) {
        self.recentre_ns = Some(display_ns);
    }

    /// The share of the last step at which the frame is seen, from 0 to 1.
    pub fn share(&self) -> f64 {
        1.0 - self.ahead
    }

    /// What a frame without the participant's attention is: the head moves, time stands still, the hand is gone.
    pub fn pause(&mut self, readings: &Readings) -> Input {
        self.played_ns = None;
        Input {
            head: readings.head.map(tracked),
            paused: true,
            is_left: self.is_left(),
            ..Input::default()
        }
    }

    /// The input of a frame that is seen at `display_ns`, `period_s` after the one before; `is_holding` is the game's word.
    pub fn input(
        &mut self,
        readings: &Readings,
        display_ns: i64,
        period_s: f64,
        is_holding: bool,
    ) -> Input {
        let recentred = self.recentre_ns.take_if(|at| *at <= display_ns).is_some();
        let hands = &in_use(readings);
        let other = self.throwing.other();
        let is_free = !is_holding && closure(&hands[self.throwing as usize]) < TAKES_OVER;
        let takes_over = is_free && closure(&hands[other as usize]) >= TAKES_OVER;
        if takes_over {
            self.throwing = other;
            self.ignored = [true; 2];
        }
        if self.changes_kind(&hands[self.throwing as usize], is_holding) || takes_over {
            // One frame without a hand: it has not moved from one side to the other, or from a controller's grip to a palm, and
            // the old one's grip is over.
            return Input {
                head: readings.head.map(tracked),
                recentred,
                is_left: self.is_left(),
                steps: self.due(display_ns, period_s),
                ..Input::default()
            };
        }
        for (ignored, hand) in self.ignored.iter_mut().zip(hands) {
            *ignored &= hand.forward || hand.back || hand.red || hand.blue;
        }
        let hand = &hands[self.throwing as usize];
        // Noise of what did not hold it closed, trigger or squeeze, does not count.
        let [trigger, squeeze] = std::mem::replace(&mut self.before, [hand.trigger, hand.squeeze]);
        let change = hand.changes[usize::from(squeeze > trigger)];
        let choosing = &hands[self.throwing.other() as usize];
        let [walks, chooses] =
            [self.throwing, self.throwing.other()].map(|side| !self.ignored[side as usize]);
        Input {
            head: readings.head.map(tracked),
            hand: hand.grip.map(tracked),
            trigger: closure(hand),
            walk_forward: walks && hand.forward,
            walk_back: walks && hand.back,
            press_red: chooses && choosing.red,
            press_blue: chooses && choosing.blue,
            locked: [false; 2],
            recentred,
            paused: false,
            recentre: false,
            is_left: self.is_left(),
            steps: self.due(display_ns, period_s),
            // Where the hand was before is told in a space that is no more.
            trigger_change: change
                .filter(|_| !recentred)
                .and_then(|change| aged(change, display_ns)),
        }
    }

    /// Whether the hand that throws has put its controller away or taken it up. What the one held the other does not take over:
    /// until the game has let it fall, the hand counts as lost.
    fn changes_kind(&mut self, hand: &HandReading, is_holding: bool) -> bool {
        let is_bare = match hand.grip {
            Some(_) => hand.bare.is_some(),
            None => self.was_bare,
        };
        let changes = is_bare != self.was_bare;
        if !is_holding {
            self.was_bare = is_bare;
        }
        changes
    }

    /// The fingers of the hand that throws, where it is bare.
    pub fn fingers(&self, readings: &Readings) -> Option<Fingers> {
        let bare = readings.hands[self.throwing as usize].bare?;
        Some(Fingers::tracked(&bare.bends))
    }

    /// Head and hands in the room: the panel hangs at the hand that does not play, where it is tracked, and the other points at it.
    pub fn arms(&self, readings: &Readings, world_from_tracking: Pose) -> Option<Arms> {
        let placed = |pose: TrackedPose| world_from_tracking * tracked(pose).pose;
        let hands = in_use(readings);
        let hand = |side: Side| hands[side as usize].grip.map(placed);
        let (playing, other) = (hand(self.throwing), hand(self.throwing.other()));
        let trigger = closure(&hands[self.throwing as usize]);
        Some(Arms {
            head: placed(readings.head?),
            wrist: other.or(playing)?,
            pointer: playing
                .filter(|_| other.is_some())
                .map(|hand| (hand, trigger)),
        })
    }

    /// Whole steps up to the time of display, or less than one beyond it.
    fn due(&mut self, display_ns: i64, period_s: f64) -> u32 {
        let elapsed = self
            .played_ns
            .map_or(period_s, |last| (display_ns - last) as f64 * 1e-9);
        self.played_ns = Some(display_ns);
        let wanted = elapsed.clamp(0.0, LONGEST_CATCH_UP_S) * self.step_hz - self.ahead;
        let steps = (wanted - JITTER).ceil().max(0.0);
        self.ahead = (steps - wanted).clamp(0.0, 1.0);
        steps as u32
    }
}

/// Hands as they play, left first: each where its palm is, fingers along -z and out of the palm along -y. A bare one holds by a fist or
/// a pinch, and has no buttons. When it closed is known to a frame only, as of a device without a trigger.
fn in_use(readings: &Readings) -> [HandReading; 2] {
    Side::BOTH.map(|side| {
        let hand = readings.hands[side as usize];
        let palm = |grip: TrackedPose| TrackedPose {
            rotation: grip.rotation * grip_from_palm(side),
            ..grip
        };
        match hand.bare {
            Some(bare) => HandReading {
                grip: Some(bare.palm),
                bare: hand.bare,
                trigger: bare.grasp,
                squeeze: bare.pinch,
                ..HandReading::default()
            },
            None => HandReading {
                grip: hand.grip.map(palm),
                changes: hand.changes.map(|change| {
                    change.map(|change| Change {
                        grip: change.grip.map(palm),
                        ..change
                    })
                }),
                ..hand
            },
        }
    })
}

/// The palm in the axes of a grip (OpenXR, standard pose identifiers): its z runs through the fist from the thumb's side to the little finger's,
/// its x out of the left palm and into the right one.
fn grip_from_palm(side: Side) -> DQuat {
    let axes = match side {
        Side::Left => DMat3::from_cols(DVec3::NEG_Z, DVec3::NEG_X, DVec3::Y),
        Side::Right => DMat3::from_cols(DVec3::Z, DVec3::X, DVec3::Y),
    };
    DQuat::from_mat3(&axes)
}

/// How far a hand is closed, whichever of its two ways the participant took.
fn closure(hand: &HandReading) -> f64 {
    hand.trigger.max(hand.squeeze).clamp(0.0, 1.0)
}

fn aged(change: Change, display_ns: i64) -> Option<TriggerChange> {
    Some(TriggerChange {
        age_s: (display_ns - change.time_ns) as f64 * 1e-9,
        hand: tracked(change.grip?),
    })
    .filter(TriggerChange::is_usable)
}

fn tracked(pose: TrackedPose) -> Tracked {
    Tracked {
        pose: Pose {
            position: pose.position,
            rotation: pose.rotation,
        },
        velocity: pose
            .velocity
            .map(|[linear, angular]| Velocity { linear, angular }),
    }
}

#[cfg(test)]
mod tests;
