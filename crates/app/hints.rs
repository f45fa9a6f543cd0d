//! Three short hints to a newcomer, until the first throw is over: reach, hold, swing and let go.
//!
//! Which one is due follows from the game alone, so nothing has to be remembered, and a session that is taken up after its first
//! throw has none. The second hangs at the hand that plays, whichever it is.

use game::{Game, Model};
use glam::DVec3;

use crate::signs::{Ground, Sign, facing};
use crate::words::HintWords;

/// A hint.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Hint {
    /// The hand is far from the balls.
    Reach,
    /// It could take one.
    Hold,
    /// It has one.
    Swing,
}

/// What a participant takes a ball with.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Grip {
    /// A controller's trigger.
    Trigger,
    /// A hand without one.
    BareHand,
    /// The mouse at the desk.
    Mouse,
}

/// Height of a hint over the balls, and over the hand [m].
const OVER_BALLS_M: f64 = 0.45;
const OVER_HAND_M: f64 = 0.17;
/// Where the last one hangs: beyond the foul line, above the line of sight to the pins, where a ball passes under it [m].
const OVER_LANE: DVec3 = DVec3::new(0.0, 1.85, -1.2);

impl Hint {
    /// All, in their order.
    pub const ALL: [Self; 3] = [Self::Reach, Self::Hold, Self::Swing];

    /// The hint that is due.
    pub fn of(game: &Game) -> Option<Self> {
        if !game.config().guidance.hints || game.throws_over() > 0 || game.is_paused() {
            return None;
        }
        match game.held() {
            Some(Model::Ball(_)) => Some(Self::Swing),
            Some(_) => None,
            // A ball is on its way: there is something to look at.
            None if !is_quiet(game) => None,
            None if game.could_take_a_ball() => Some(Self::Hold),
            None => Some(Self::Reach),
        }
    }

    /// Size of its letters [m], and from how far it is read at most [m].
    pub fn letter_and_distance(self) -> [f64; 2] {
        match self {
            // From the start.
            Self::Reach => [0.06, 3.0],
            Self::Hold => [0.02, 0.9],
            Self::Swing => [0.105, 5.7],
        }
    }

    /// Who has never held it is told what to do with what is in the hand.
    fn words(self, grip: Grip, words: &HintWords) -> &str {
        match (self, grip) {
            (Self::Reach, Grip::Mouse) => &words.reach_mouse,
            (Self::Reach, _) => &words.reach,
            (Self::Hold, Grip::Trigger) => &words.hold,
            (Self::Hold, Grip::BareHand) => &words.hold_bare,
            (Self::Hold, Grip::Mouse) => &words.hold_mouse,
            (Self::Swing, Grip::Mouse) => &words.swing_mouse,
            (Self::Swing, _) => &words.swing,
        }
    }

    fn place(self, game: &Game) -> Option<DVec3> {
        match self {
            Self::Reach => {
                let balls = game.observe().balls;
                let on_rack = balls.iter().filter(|ball| ball.is_on_rack);
                let (sum, count) = on_rack.fold((DVec3::ZERO, 0.0), |(sum, count), ball| {
                    (sum + ball.position, count + 1.0)
                });
                (count > 0.0).then(|| sum / count + DVec3::Y * OVER_BALLS_M)
            }
            Self::Hold => Some(game.hand_pose_world()?.position + DVec3::Y * OVER_HAND_M),
            Self::Swing => Some(OVER_LANE),
        }
    }
}

/// Whether the pins are set and no ball is anywhere but on the rack.
fn is_quiet(game: &Game) -> bool {
    let seen = game.observe();
    let astray = |ball: &game::BallSeen| ball.is_free && !ball.is_on_rack;
    seen.is_set && !seen.balls.iter().any(astray)
}

/// The sign of the hint that is due, if one is, for who takes balls so.
pub fn sign(game: &Game, grip: Grip, words: &HintWords) -> Option<Sign> {
    let hint = Hint::of(game)?;
    let eye = game.head_pose_world()?.position;
    let [letter_m, _] = hint.letter_and_distance();
    Some(Sign {
        text: hint.words(grip, words).to_owned(),
        letter_m,
        pose: facing(hint.place(game)?, eye),
        ground: Ground::Plain,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::convert::tests::config;
    use crate::devices::Device;
    use crate::devices::script::{Script, Velocities};
    use crate::words::Words;
    use game::{Button, Conditions};

    fn game(hints: bool) -> Game {
        let mut config = config();
        config.guidance.hints = hints;
        let conditions = Conditions {
            lobby: config.clone(),
            red: config.clone(),
            blue: config,
        };
        Game::new(conditions, 1).expect("the shipped room")
    }

    #[test]
    fn hints_come_in_their_order_and_stay_away_after_the_first_throw() {
        let mut game = game(true);
        let mut script = Script::new(game.config(), 3, Velocities::Measured, &[Button::Red]);
        let words = Words::shipped();
        let mut seen: Vec<Option<Hint>> = Vec::new();
        while !script.is_done() {
            let input = script.next(&game);
            game.step(&input);
            let hint = Hint::of(&game);
            if seen.last() != Some(&hint) {
                seen.push(hint);
            }
            let sign = sign(&game, Grip::Trigger, &words.hints);
            if hint == Some(Hint::Hold) {
                let hand = game.hand_pose_world().expect("it is tracked").position;
                let away = sign.expect("a head").pose.position - hand;
                assert!(away.distance(DVec3::Y * OVER_HAND_M) < 1e-12);
            }
        }
        assert!(game.throws_over() >= 2, "a frame of two balls");
        assert_eq!(
            seen,
            [Some(Hint::Reach), Some(Hint::Hold), Some(Hint::Swing), None]
        );
    }

    /// There is no trigger at the desk, and none in a bare hand: whoever is told to hold one looks for it.
    #[test]
    fn a_hint_names_what_is_in_the_hand() {
        let words = Words::shipped().hints;
        let all = |grip| Hint::ALL.map(|hint| hint.words(grip, &words).to_lowercase());
        let trigger = all(Grip::Trigger).concat();
        assert!(trigger.contains("trigger") && !trigger.contains("mouse"));
        for grip in [Grip::BareHand, Grip::Mouse] {
            assert!(!all(grip).concat().contains("trigger"), "{grip:?}");
        }
        assert!(all(Grip::BareHand)[1].contains("hand"));
        assert!(all(Grip::Mouse)[1].contains("button") && all(Grip::Mouse)[2].contains("mouse"));
    }

    #[test]
    fn there_are_no_hints_where_the_settings_have_none() {
        let mut game = game(false);
        let mut script = Script::new(game.config(), 3, Velocities::Measured, &[Button::Red]);
        for _ in 0..2000 {
            let input = script.next(&game);
            game.step(&input);
            assert_eq!(Hint::of(&game), None);
        }
    }
}
