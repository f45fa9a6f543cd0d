//! What the hands did around each throw, as the runtime told it: with these poses any estimate of a release can be made anew.
//!
//! The line `throw` comes in the frame of the release and has what was read up to then, `after_throw` has what was read
//! behind it. Nothing is filtered, converted or rounded; poses are in tracking space, times on the runtime's clock.

use std::collections::VecDeque;

use renderer::headset::{BareHand, Change, HandReading, Readings, TrackedPose};
use serde_json::{Value, json};

use crate::journal::Said;

/// How far before a release readings are kept [ns].
const BEFORE: i64 = 200_000_000;
/// How far behind it they are taken down [ns].
const AFTER: i64 = 100_000_000;

/// Recent readings, and the throw whose end is still to be seen.
#[derive(Debug, Default)]
pub struct Throws {
    /// Readings with the time of display that they were made for [ns], oldest first.
    recent: VecDeque<(i64, Readings)>,
    thrown: Option<Thrown>,
}

/// A throw that was let go a moment ago.
#[derive(Debug)]
struct Thrown {
    step: u64,
    display_ns: i64,
    readings: Vec<(i64, Readings)>,
}

/// What the journal keeps around a throw that was let go at a step.
#[derive(Debug)]
pub enum Line {
    /// Time of display [ns], and what was read up to then.
    Throw(u64, i64, Vec<(i64, Readings)>),
    /// What was read behind it.
    AfterThrow(u64, Vec<(i64, Readings)>),
}

impl Line {
    fn value(&self) -> Value {
        let read = |all: &[(i64, Readings)]| -> Vec<Value> {
            all.iter()
                .map(|(at, readings)| reading(*at, readings))
                .collect()
        };
        match self {
            Self::Throw(step, display_ns, readings) => json!({ "throw": {
                "step": step,
                "xr_time_ns": display_ns,
                "readings": read(readings),
            }}),
            Self::AfterThrow(step, readings) => json!({ "after_throw": {
                "step": step,
                "readings": read(readings),
            }}),
        }
    }
}

impl From<Line> for Said {
    fn from(line: Line) -> Self {
        Self::later(move || line.value())
    }
}

impl Throws {
    /// Takes down what was read for the picture seen at `display_ns`, in which a hand let go at the step `released`, if one
    /// did. Returns the lines for the journal that are due.
    pub fn follow(
        &mut self,
        display_ns: i64,
        readings: &Readings,
        released: Option<u64>,
    ) -> Vec<Line> {
        let mut due = Vec::new();
        if let Some(thrown) = &mut self.thrown {
            let is_over = display_ns > thrown.display_ns + AFTER;
            if !is_over {
                thrown.readings.push((display_ns, *readings));
            }
            if is_over || released.is_some() {
                due.extend(self.finish());
            }
        }
        self.recent.push_back((display_ns, *readings));
        if let Some(step) = released {
            let begin = let_go_ns(display_ns, readings) - BEFORE;
            let seen = self.recent.iter().filter(|(at, _)| *at >= begin);
            due.push(Line::Throw(step, display_ns, seen.copied().collect()));
            self.thrown = Some(Thrown {
                step,
                display_ns,
                readings: Vec::new(),
            });
        }
        // As far back as the oldest change of a trigger that is believed in reaches, and what is wanted before it.
        let oldest = (game::TriggerChange::LONGEST_AGE_S * 1e9) as i64 + BEFORE;
        self.recent.retain(|(at, _)| *at >= display_ns - oldest);
        due
    }

    /// The last throw's line, whatever is still missing of its time: nothing more will be read.
    pub fn finish(&mut self) -> Option<Line> {
        let thrown = self.thrown.take()?;
        Some(Line::AfterThrow(thrown.step, thrown.readings))
    }
}

/// When a trigger last changed, of either hand; the time of display where none did.
fn let_go_ns(display_ns: i64, readings: &Readings) -> i64 {
    let changes = readings.hands.iter().flat_map(|hand| hand.changes);
    let times = changes.flatten().map(|change| change.time_ns);
    times.min().map_or(display_ns, |at| at.min(display_ns))
}

fn reading(display_ns: i64, readings: &Readings) -> Value {
    let [left, right] = readings.hands.each_ref().map(hand);
    json!({ "xr_time_ns": display_ns, "left": left, "right": right })
}

fn hand(hand: &HandReading) -> Value {
    json!({
        "grip": hand.grip.map(pose),
        "trigger": hand.trigger,
        "squeeze": hand.squeeze,
        "changes": hand.changes.map(|change| change.map(changed)),
        "bare": hand.bare.map(bare),
    })
}

fn bare(hand: BareHand) -> Value {
    json!({
        "palm": pose(hand.palm),
        "bends": hand.bends,
        "grasp": hand.grasp,
        "pinch": hand.pinch,
    })
}

fn changed(change: Change) -> Value {
    json!({ "xr_time_ns": change.time_ns, "grip": change.grip.map(pose) })
}

fn pose(pose: TrackedPose) -> Value {
    let [linear, angular] = match pose.velocity {
        Some(velocity) => velocity.map(|velocity| Some(velocity.to_array())),
        None => [None; 2],
    };
    json!({
        "position": pose.position.to_array(),
        "rotation": pose.rotation.to_array(),
        "linear": linear,
        "angular": angular,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::{DQuat, DVec3};

    const FRAME: i64 = 11_111_111;

    fn readings(frame: i64) -> Readings {
        let mut readings = Readings::default();
        readings.hands[1].grip = Some(TrackedPose {
            position: DVec3::new(frame as f64, 1.0, 0.0),
            rotation: DQuat::IDENTITY,
            velocity: Some([DVec3::X, DVec3::Y]),
        });
        readings
    }

    /// Frames of the lines, by the number that stands in the right hand's place.
    fn frames(line: &Value) -> Vec<i64> {
        let readings = line["readings"].as_array().expect("a list");
        let frames = readings.iter().map(|reading| {
            let x = reading["right"]["grip"]["position"][0].as_f64();
            let frame = x.expect("a place") as i64;
            assert_eq!(reading["xr_time_ns"], frame * FRAME);
            assert!(reading["left"]["grip"].is_null());
            frame
        });
        frames.collect()
    }

    #[test]
    fn a_throw_has_the_200_ms_before_it_and_the_100_ms_behind() {
        let mut throws = Throws::default();
        let mut said = Vec::new();
        for frame in 0..70 {
            let released = (frame == 50).then_some(4000);
            for line in throws.follow(frame * FRAME, &readings(frame), released) {
                said.push((frame, line.value()));
            }
        }
        let [(50, thrown), (60, after)] = said.as_slice() else {
            panic!("{said:?}");
        };
        assert_eq!(thrown["throw"]["step"], 4000);
        // 18 periods of 90 Hz are 200 ms, one nanosecond less.
        assert_eq!(frames(&thrown["throw"]), (32..=50).collect::<Vec<_>>());
        assert_eq!(frames(&after["after_throw"]), (51..=59).collect::<Vec<_>>());
        assert_eq!(after["after_throw"]["step"], 4000);
    }

    #[test]
    fn the_time_before_a_throw_is_that_before_the_triggers_own() {
        let mut throws = Throws::default();
        let mut said = Vec::new();
        for frame in 0..=50 {
            let mut readings = readings(frame);
            readings.hands[1].changes[0] = (frame == 50).then_some(Change {
                time_ns: 45 * FRAME,
                grip: None,
            });
            said = throws.follow(frame * FRAME, &readings, (frame == 50).then_some(1));
        }
        let thrown = said[0].value();
        let thrown = &thrown["throw"];
        assert_eq!(frames(thrown), (27..=50).collect::<Vec<_>>());
        let last = &thrown["readings"][23]["right"]["changes"];
        assert_eq!(last[0]["xr_time_ns"], 45 * FRAME);
        assert!(last[0]["grip"].is_null() && last[1].is_null());
    }

    #[test]
    fn a_throw_that_is_followed_by_another_or_by_the_end_is_not_lost() {
        let mut throws = Throws::default();
        assert_eq!(throws.follow(0, &readings(0), Some(1)).len(), 1);
        let lines = throws.follow(FRAME, &readings(1), Some(2));
        assert_eq!(frames(&lines[0].value()["after_throw"]), [1]);
        assert_eq!(lines[1].value()["throw"]["step"], 2);
        let last = throws.finish().expect("the second throw").value();
        assert_eq!(last["after_throw"]["step"], 2);
        assert!(throws.finish().is_none());
    }
}
