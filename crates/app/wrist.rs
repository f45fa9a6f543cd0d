//! A small panel at the wrist of the hand that does not play: pause, go on, and the way back to the start.
//!
//! It is there while a controller has no menu button, or while the session is paused, and only while somebody looks at the wrist and has
//! nothing in the hand, nor anything to take: a ball that is carried in both hands is looked at for longer than a choice takes.
//! A button is chosen by pointing at it with the hand that plays and pulling the trigger, or by looking at it for a while.

use glam::{DVec2, DVec3};
use physics::Pose;

use crate::signs::{Ground, Sign, facing};
use crate::trigger::Trigger;
use crate::words::PauseWords;

/// Size of the letters [m], and from how far they are read at most: an arm's length [m].
pub const LETTER_AND_DISTANCE: [f64; 2] = [0.02, 0.75];
/// A button's size [m].
const BUTTON_M: DVec2 = DVec2::new(0.17, 0.05);
/// Distance of the buttons' middles from each other, and of the lower one from the wrist [m].
const APART_M: f64 = 0.06;
const OVER_WRIST_M: f64 = 0.09;
/// Who looks so near to the wrist looks at it [rad].
const LOOKS_WITHIN: f64 = 0.45;
/// How long a look chooses [s].
const DWELL_S: f64 = 1.5;

/// What is asked for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Wish {
    /// Pause, or go on.
    Pause,
    /// Back to the start.
    Recentre,
}

impl Wish {
    /// Both, from the upper button to the lower one.
    const ALL: [Self; 2] = [Self::Pause, Self::Recentre];
}

/// Head and hands of an instant, world frame.
#[derive(Clone, Copy, Debug)]
pub struct Arms {
    /// The head.
    pub head: Pose,
    /// The hand that bears the panel.
    pub wrist: Pose,
    /// The hand that plays and its trigger, where it is another one.
    pub pointer: Option<(Pose, f64)>,
}

/// The panel, whether it is seen or not.
#[derive(Debug, Default)]
pub struct Wrist {
    /// Where it hangs, while it is seen.
    pose: Option<Pose>,
    /// What is looked or pointed at.
    at: Option<Wish>,
    /// Since when it is looked at [s].
    since_s: f64,
    /// A look has chosen: it has to leave before the next.
    is_done: bool,
    trigger: Trigger,
}

impl Wrist {
    /// Follows the arms at a time of display [s], where the panel `is_due`; tells what was chosen.
    pub fn attend(&mut self, arms: Option<Arms>, is_due: bool, now_s: f64) -> Option<Wish> {
        let trigger = arms
            .and_then(|arms| arms.pointer)
            .map_or(0.0, |(_, trigger)| trigger);
        let arms = arms.filter(|arms| is_due && looks_at_wrist(arms));
        self.pose = arms.map(|arms| facing(hung(arms.wrist.position), arms.head.position));
        // Also while nothing is seen of the panel: a trigger that is pulled already chooses nothing.
        let is_pulled = self.trigger.press(trigger);
        let (Some(arms), Some(pose)) = (arms, self.pose) else {
            (self.at, self.is_done) = (None, false);
            return None;
        };
        let ahead = arms.head.position + arms.head.rotation * DVec3::NEG_Z;
        let looked = hit(&pose, arms.head.position, ahead);
        let pointed = arms
            .pointer
            .and_then(|(hand, _)| hit(&pose, arms.head.position, hand.position));
        let at = pointed.or(looked);
        if at != self.at {
            (self.at, self.since_s, self.is_done) = (at, now_s, false);
        }
        let is_pressed = pointed.is_some() && is_pulled;
        let is_dwelt =
            looked.is_some() && looked == at && !self.is_done && now_s - self.since_s >= DWELL_S;
        self.is_done |= is_dwelt || is_pressed;
        at.filter(|_| is_pressed || is_dwelt)
    }

    /// What is to be drawn.
    pub fn signs(&self, is_paused: bool, words: &PauseWords) -> Vec<Sign> {
        let Some(pose) = &self.pose else {
            return Vec::new();
        };
        let text = |wish| match wish {
            Wish::Pause if is_paused => &words.go_on,
            Wish::Pause => &words.pause,
            Wish::Recentre => &words.recentre,
        };
        let sign = |wish| Sign {
            text: text(wish).clone(),
            letter_m: LETTER_AND_DISTANCE[0],
            pose: Pose {
                position: pose.transform_point(middle(wish)),
                rotation: pose.rotation,
            },
            ground: if self.at == Some(wish) {
                Ground::Chosen
            } else {
                Ground::Button
            },
        };
        Wish::ALL.map(sign).to_vec()
    }
}

/// The panel's middle over a wrist.
fn hung(wrist: DVec3) -> DVec3 {
    wrist + DVec3::Y * (OVER_WRIST_M + 0.5 * APART_M)
}

/// A button's middle on the panel [m].
fn middle(wish: Wish) -> DVec3 {
    let up = match wish {
        Wish::Pause => 0.5,
        Wish::Recentre => -0.5,
    };
    DVec3::Y * (up * APART_M)
}

fn looks_at_wrist(arms: &Arms) -> bool {
    let way = hung(arms.wrist.position) - arms.head.position;
    (arms.head.rotation * DVec3::NEG_Z).angle_between(way) < LOOKS_WITHIN
}

/// The button that the line from the eye through a point meets.
fn hit(panel: &Pose, eye: DVec3, through: DVec3) -> Option<Wish> {
    Wish::ALL.into_iter().find(|wish| {
        let button = Pose {
            position: panel.transform_point(middle(*wish)),
            rotation: panel.rotation,
        };
        crate::panel::share(&button, BUTTON_M, eye, through).is_some()
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::words::Words;
    use glam::DQuat;

    const EYE: DVec3 = DVec3::new(0.2, 1.65, 3.0);
    const WRIST: DVec3 = DVec3::new(0.0, 1.3, 2.6);

    /// Somebody who looks at a point of the world, the wrist before them.
    fn looking(at: DVec3) -> Arms {
        let pose = facing(EYE, at);
        // Faces with +z; a head looks along -z.
        let head = Pose {
            position: EYE,
            rotation: pose.rotation * DQuat::from_rotation_y(std::f64::consts::PI),
        };
        Arms {
            head,
            wrist: Pose::from_position(WRIST),
            pointer: None,
        }
    }

    fn button(wish: Wish) -> DVec3 {
        facing(hung(WRIST), EYE).transform_point(middle(wish))
    }

    #[test]
    fn a_look_of_a_second_and_a_half_chooses_once() {
        let mut wrist = Wrist::default();
        let arms = looking(button(Wish::Recentre));
        let mut chosen = Vec::new();
        for frame in 0..400 {
            let now = f64::from(frame) / 90.0;
            chosen.extend(wrist.attend(Some(arms), true, now).map(|wish| (wish, now)));
        }
        assert_eq!(chosen.len(), 1, "{chosen:?}");
        let (wish, at) = chosen[0];
        assert_eq!(wish, Wish::Recentre);
        assert!((1.5..1.52).contains(&at), "{at}");
        // Who looks away and again chooses again.
        wrist.attend(Some(looking(EYE + DVec3::NEG_Z)), true, 5.0);
        assert_eq!(wrist.attend(Some(arms), true, 5.1), None);
        assert_eq!(wrist.attend(Some(arms), true, 6.7), Some(Wish::Recentre));
    }

    #[test]
    fn a_hand_that_points_chooses_by_its_trigger_at_once() {
        let mut wrist = Wrist::default();
        let pointing = |wish, trigger| Arms {
            pointer: Some((Pose::from_position(EYE.lerp(button(wish), 0.6)), trigger)),
            ..looking(hung(WRIST) + DVec3::Y * 0.15)
        };
        let mut attend = |wish, trigger| wrist.attend(Some(pointing(wish, trigger)), true, 0.0);
        assert_eq!(attend(Wish::Pause, 0.0), None);
        assert_eq!(attend(Wish::Pause, 0.9), Some(Wish::Pause));
        assert_eq!(attend(Wish::Pause, 0.9), None, "it is held");
        assert_eq!(attend(Wish::Recentre, 0.9), None, "it was pulled elsewhere");
        attend(Wish::Recentre, 0.0);
        assert_eq!(attend(Wish::Recentre, 0.9), Some(Wish::Recentre));
    }

    #[test]
    fn a_trigger_that_was_pulled_elsewhere_chooses_nothing_on_its_way_over_the_panel() {
        let mut wrist = Wrist::default();
        let through = |target: DVec3| Some((Pose::from_position(EYE.lerp(target, 0.6)), 0.9));
        let away = Arms {
            pointer: through(button(Wish::Pause)),
            ..looking(EYE + DVec3::NEG_Z)
        };
        let over = Arms {
            pointer: through(button(Wish::Pause)),
            ..looking(hung(WRIST) + DVec3::Y * 0.15)
        };
        assert_eq!(wrist.attend(Some(away), true, 0.0), None);
        assert_eq!(wrist.attend(Some(over), true, 0.1), None);
        let let_go = Arms {
            pointer: over.pointer.map(|(hand, _)| (hand, 0.0)),
            ..over
        };
        assert_eq!(wrist.attend(Some(let_go), true, 0.2), None);
        assert_eq!(wrist.attend(Some(over), true, 0.3), Some(Wish::Pause));
    }

    #[test]
    fn the_panel_is_seen_where_it_is_due_and_looked_for() {
        let words = Words::shipped().pause;
        let mut wrist = Wrist::default();
        let mut seen = |arms, is_due| {
            wrist.attend(arms, is_due, 0.0);
            let signs = wrist.signs(false, &words);
            signs.into_iter().map(|sign| sign.text).collect::<Vec<_>>()
        };
        let there = Some(looking(hung(WRIST)));
        assert_eq!(seen(there, true), ["Pause", "To the start"]);
        assert!(seen(there, false).is_empty());
        assert!(seen(Some(looking(EYE + DVec3::NEG_Z)), true).is_empty());
        assert!(seen(None, true).is_empty());
        let mut wrist = Wrist::default();
        wrist.attend(there, true, 0.0);
        assert_eq!(wrist.signs(true, &words)[0].text, "Go on");
    }
}
