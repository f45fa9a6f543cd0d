//! How tall somebody is and how far they reach, from one gesture: the arm stretched forward, the trigger closed on nothing.
//!
//! Who sits is lifted to the height of somebody who stands, so that the arm can swing; rack and desk come to a height at which the
//! balls and buttons are within reach. The gesture is read from the inputs, so a replay does the same.

use glam::DVec3;

use crate::Game;
use crate::config::Config;
use crate::event::EventKind;
use crate::input::{Input, Tracked};
use crate::room::Room;
use crate::throw::Stage;

/// An arm that is stretched forward has the hand this far from the head, over the floor [m].
const STRETCHED_M: f64 = 0.35;
/// And not farther below or above the eyes than this [m].
const BELOW_EYES_M: f64 = 0.55;
const ABOVE_EYES_M: f64 = 0.2;
/// Who measures looks ahead: one who bends over a ball that the hand misses looks farther down than this, the sine of 34 degrees.
const LOWEST_GAZE: f64 = -0.56;
/// Height of the shoulders, in heights of the eyes: 1.33 m of 1.62 m.
const SHOULDER_SHARE: f64 = 0.82;
/// Share of the reach that is comfortable.
const COMFORTABLE: f64 = 0.9;
/// Most and least that rack and desk are raised or lowered to [m]: what settings may have.
const TRAY_M: [f64; 2] = [0.4, 1.2];
const DESK_M: [f64; 2] = [0.5, 1.4];
/// Heights are whole centimetres.
const PER_METRE: f64 = 100.0;

/// A hand that may be held out: since when, and where, in tracking space.
#[derive(Clone, Copy, Debug)]
pub(crate) struct HeldOut {
    since: u64,
    at: DVec3,
}

impl Game {
    /// Watches for the gesture, until the first throw is over.
    pub(crate) fn watch_gesture(&mut self, input: &Input) {
        let Some([head, hand]) = self.gesture(input) else {
            self.held_out = None;
            return;
        };
        let settings = &self.room.config.calibration;
        let start = HeldOut {
            since: self.steps,
            at: hand,
        };
        let held = *self.held_out.get_or_insert(start);
        if held.at.distance(hand) > settings.still_m {
            self.held_out = Some(start);
            return;
        }
        // Once for a gesture: the trigger has to open before the next.
        let due = held
            .since
            .saturating_add(self.room.steps_in(settings.hold_s));
        if self.steps >= due && held.since != u64::MAX {
            self.held_out = Some(HeldOut {
                since: u64::MAX,
                ..held
            });
            self.calibrate(head, hand);
        }
    }

    /// Head and hand, in tracking space, while the arm is stretched with the trigger closed on nothing.
    fn gesture(&self, input: &Input) -> Option<[DVec3; 2]> {
        let is_time = self.room.config.calibration.gesture
            && self.throws_over == 0
            && matches!(self.stage, Stage::Ready { .. })
            && self.hand.held.is_none()
            && input.trigger >= self.room.config.hand.trigger_close;
        let tracked = |thing: Option<Tracked>| Some(thing.filter(Tracked::is_usable)?.pose);
        let (head, hand) = (tracked(input.head)?, tracked(input.hand)?);
        let looks_ahead = (head.rotation * DVec3::NEG_Z).y > LOWEST_GAZE;
        let (head, hand) = (head.position, hand.position);
        let is_stretched = over_floor(head, hand) >= STRETCHED_M
            && (-BELOW_EYES_M..=ABOVE_EYES_M).contains(&(hand.y - head.y));
        (is_time && is_stretched && looks_ahead).then_some([head, hand])
    }

    fn calibrate(&mut self, head: DVec3, hand: DVec3) {
        let settings = &self.room.config.calibration;
        let (eye_height_m, reach_m) = (head.y, over_floor(head, hand));
        let is_seated = eye_height_m < settings.seated_below_m;
        let lift = if is_seated {
            settings.eye_height_m - eye_height_m
        } else {
            0.0
        };
        self.world_from_tracking.position.y = lift;
        let fitted = Fitted::of(
            &self.room.config,
            self.furniture,
            eye_height_m + lift,
            reach_m,
        );
        let conditions = &mut self.conditions;
        for config in [
            &mut conditions.lobby,
            &mut conditions.red,
            &mut conditions.blue,
        ] {
            fitted.put(config);
        }
        let config = match self.playing {
            Some(button) => self.conditions.of(button),
            None => &self.conditions.lobby,
        };
        let room = Room::new(config).expect("furniture of another height stands as well");
        self.enter(room);
        self.record(EventKind::Calibrated {
            eye_height_m,
            reach_m,
            is_seated,
            tray_height_m: fitted.tray_m,
            desk_height_m: fitted.desk_m,
        });
    }

    /// Settings whose rack and desk are where those of the session are, if they were made for it.
    pub(crate) fn within_reach(&self, config: &Config) -> Config {
        let mut config = config.clone();
        if Fitted::as_set(&config) == self.furniture {
            Fitted::as_set(&self.conditions.lobby).put(&mut config);
        }
        config
    }
}

fn over_floor(a: DVec3, b: DVec3) -> f64 {
    let way = b - a;
    DVec3::new(way.x, 0.0, way.z).length()
}

/// Heights of rack and desk.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Fitted {
    tray_m: f64,
    desk_m: f64,
}

impl Fitted {
    /// As settings have them.
    pub(crate) fn as_set(config: &Config) -> Self {
        Self {
            tray_m: config.rack.tray_height_m,
            desk_m: config.desk.height_m,
        }
    }

    fn put(self, config: &mut Config) {
        config.rack.tray_height_m = self.tray_m;
        config.desk.height_m = self.desk_m;
    }

    /// Those that are set, in proportion to the eyes' height, but never so low that a short arm does not reach down.
    fn of(config: &Config, set: Self, eye_m: f64, reach_m: f64) -> Self {
        let share = eye_m / config.calibration.eye_height_m;
        let shoulder = SHOULDER_SHARE * eye_m;
        let margin = config.walking.furniture_margin_m;
        let lowest = |away: f64| {
            let arm = COMFORTABLE * reach_m;
            shoulder - (arm * arm - away * away).max(0.0).sqrt()
        };
        let widest = config
            .balls
            .iter()
            .map(|ball| ball.diameter_m)
            .fold(0.0, f64::max);
        let tray = (set.tray_m * share).max(lowest(margin + 0.5 * widest) - widest);
        let desk = (set.desk_m * share).max(lowest(margin + 0.5 * config.desk.depth_m));
        let whole = |height: f64, [low, high]: [f64; 2]| {
            (height.clamp(low, high) * PER_METRE).round() / PER_METRE
        };
        Self {
            tray_m: whole(tray, TRAY_M),
            desk_m: whole(desk, DESK_M),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::config::tests::default_config;

    #[test]
    fn furniture_follows_the_eyes_and_comes_up_to_a_short_arm() {
        let config = default_config();
        let fitted = |eye, reach| {
            let Fitted { tray_m, desk_m } =
                Fitted::of(&config, Fitted::as_set(&config), eye, reach);
            (tray_m, desk_m)
        };
        assert_eq!(
            fitted(1.62, 0.75),
            (0.70, 0.85),
            "the settings' own measure"
        );
        let (tall, tall_desk) = fitted(1.86, 0.85);
        assert!(tall > 0.75 && tall_desk > 0.9, "{tall} {tall_desk}");
        let (short_arm, desk) = fitted(1.62, 0.45);
        assert!(short_arm > 0.75 && desk > 1.0, "{short_arm} {desk}");
        // What is then lowest is within a comfortable reach of the shoulder.
        let down = SHOULDER_SHARE * 1.62 - (short_arm + 0.21717);
        let away = config.walking.furniture_margin_m + 0.5 * 0.21717;
        assert!(down.hypot(away) <= 0.9 * 0.45 + 0.005);
    }
}
