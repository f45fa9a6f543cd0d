//! From what a headset reads to what the game consumes: which hand throws, how many steps are due.

use game::{Input, Tracked, TriggerChange, Velocity};
use physics::Pose;
use renderer::headset::{Change, HandReading, Readings, Side, TrackedPose};

use super::LONGEST_CATCH_UP_S;

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
            played_ns: None,
            ahead: 0.0,
            recentre_ns: None,
        }
    }

    /// The hand that throws.
    pub fn throwing(&self) -> Side {
        self.throwing
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
        let hands = &readings.hands;
        let other = self.throwing.other();
        let is_free = !is_holding && closure(&hands[self.throwing as usize]) < TAKES_OVER;
        if is_free && closure(&hands[other as usize]) >= TAKES_OVER {
            self.throwing = other;
            self.ignored = [true; 2];
            // One frame without a hand: it has not moved from one side to the other, and the old one's grip is over.
            return Input {
                head: readings.head.map(tracked),
                recentred,
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
            steps: self.due(display_ns, period_s),
            // Where the hand was before is told in a space that is no more.
            trigger_change: change
                .filter(|_| !recentred)
                .and_then(|change| aged(change, display_ns)),
        }
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
mod tests {
    use super::*;
    use glam::{DQuat, DVec3};

    fn grip(x: f64) -> Option<TrackedPose> {
        Some(TrackedPose {
            position: DVec3::new(x, 1.0, 0.0),
            rotation: DQuat::IDENTITY,
            velocity: None,
        })
    }

    fn readings(left: f64, right: f64) -> Readings {
        let mut readings = Readings::default();
        for (hand, (x, trigger)) in readings.hands.iter_mut().zip([(-0.3, left), (0.3, right)]) {
            hand.grip = grip(x);
            hand.trigger = trigger;
        }
        readings
    }

    #[test]
    fn input_follows_the_hand_that_closes_and_stays_with_what_it_holds() {
        let mut participant = Participant::new(720.0);
        let mut x = |left, right, holding| {
            let input = participant.input(&readings(left, right), 0, 0.01, holding);
            input.hand.map(|hand| hand.pose.position.x)
        };
        assert_eq!(x(0.0, 0.0, false), Some(0.3));
        assert_eq!(x(0.9, 0.0, false), None, "no hand moves from right to left");
        assert_eq!(x(0.9, 0.0, false), Some(-0.3));
        assert_eq!(
            x(0.9, 0.9, true),
            Some(-0.3),
            "the ball is in the left hand"
        );
        assert_eq!(x(0.0, 0.9, true), Some(-0.3), "until it is let go");
        assert_eq!(x(0.0, 0.9, false), None);
        assert_eq!(x(0.0, 0.9, false), Some(0.3));
    }

    #[test]
    fn buttons_of_the_other_hand_choose_and_those_of_the_throwing_hand_walk() {
        let mut participant = Participant::new(720.0);
        let mut both = readings(0.0, 0.0);
        for hand in &mut both.hands {
            (hand.forward, hand.red) = (true, true);
        }
        both.hands[0].forward = false;
        let input = participant.input(&both, 0, 0.01, false);
        assert!(input.walk_forward && input.press_red && !input.press_blue);
        both.hands[0].red = false;
        assert!(!participant.input(&both, 0, 0.01, false).press_red);
    }

    /// A thumb that walks while the other hand takes over must not choose a game.
    #[test]
    fn buttons_that_are_down_when_hands_change_roles_mean_nothing() {
        let mut participant = Participant::new(720.0);
        let mut both = readings(0.9, 0.0);
        (both.hands[1].forward, both.hands[1].blue) = (true, true);
        for _ in 0..3 {
            assert!(!participant.input(&both, 0, 0.01, false).press_blue);
        }
        (both.hands[1].forward, both.hands[1].blue) = (false, false);
        participant.input(&both, 0, 0.01, false);
        (both.hands[1].forward, both.hands[1].blue) = (true, true);
        assert!(participant.input(&both, 0, 0.01, false).press_blue);
    }

    /// 75 Hz does not divide 720: the steps of any stretch of frames are those of its time, to one.
    #[test]
    fn steps_follow_the_clock_at_any_rate() {
        for hz in [45.0, 72.0, 75.0, 90.0, 120.0] {
            let mut participant = Participant::new(720.0);
            let (mut steps, mut longest) = (0, 0);
            for frame in 0..1000 {
                let display_ns = (f64::from(frame) / hz * 1e9) as i64;
                let input = participant.input(&readings(0.0, 0.0), display_ns, 1.0 / hz, false);
                longest = longest.max(input.steps);
                steps += input.steps;
            }
            let exact = 1000.0 / hz * 720.0;
            assert!(
                (f64::from(steps) - exact).abs() <= 1.0,
                "{hz} Hz: {steps}, not {exact}"
            );
            assert!(f64::from(longest) < 720.0 / hz + 1.0);
        }
    }

    #[test]
    fn a_pause_stops_time_and_hides_the_hand() {
        let mut participant = Participant::new(720.0);
        participant.input(&readings(0.0, 0.0), 0, 0.01, false);
        let paused = participant.pause(&readings(0.0, 0.0));
        assert_eq!((paused.steps, paused.hand), (0, None));
        let ten_seconds = 10_000_000_000;
        let input = participant.input(&readings(0.0, 0.0), ten_seconds, 1.0 / 90.0, false);
        assert_eq!(input.steps, 8, "what passed meanwhile is not made up for");
    }

    /// The runtime tells of a new space ahead of its first frame; the game must hear of it in that frame, and once.
    #[test]
    fn a_new_space_is_told_with_the_first_frame_in_it() {
        let mut participant = Participant::new(720.0);
        let mut with_change = readings(0.0, 0.0);
        with_change.hands[1].changes[0] = Some(Change {
            time_ns: 1_000_000_000,
            grip: grip(0.1),
        });
        participant.recentre(1_020_000_000);
        let mut told = |milliseconds: i64| {
            let input = participant.input(&with_change, milliseconds * 1_000_000, 0.01, true);
            (input.recentred, input.trigger_change.is_some())
        };
        assert_eq!(told(1_010), (false, true));
        assert_eq!(
            told(1_020),
            (true, false),
            "the old pose is of the old space"
        );
        assert_eq!(told(1_030), (false, true));
    }

    /// Nothing is played in a pause: the first frame behind it hears of what happened meanwhile.
    #[test]
    fn a_new_space_in_a_pause_is_told_behind_it() {
        let mut participant = Participant::new(720.0);
        participant.recentre(5);
        assert!(!participant.pause(&readings(0.0, 0.0)).recentred);
        assert!(
            participant
                .input(&readings(0.0, 0.0), 10, 0.01, false)
                .recentred
        );
    }

    #[test]
    fn a_change_is_aged_from_the_time_of_display() {
        let mut participant = Participant::new(720.0);
        let mut with_change = readings(0.0, 0.0);
        with_change.hands[1].changes[0] = Some(Change {
            time_ns: 1_000_000_000,
            grip: grip(0.1),
        });
        let mut age = |display_ns| {
            let input = participant.input(&with_change, display_ns, 0.01, true);
            input.trigger_change.map(|change| change.age_s)
        };
        assert!((age(1_030_000_000).expect("a recent change") - 0.03).abs() < 1e-12);
        assert_eq!(age(2_000_000_000), None, "too old to be believed");
    }
}
