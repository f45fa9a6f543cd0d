//! How tracking and pictures fare: for the experimenter's eyes, and kept nowhere.

use std::collections::VecDeque;
use std::time::{Duration, Instant};

use game::Input;
use serde_json::Value;

/// Pictures are counted over this time.
const WINDOW: Duration = Duration::from_secs(1);

/// How tracking and pictures fare.
#[derive(Debug, Default)]
pub struct Health {
    /// Head and hand.
    tracked: [Tracking; 2],
    /// When the pictures of the last second were shown.
    shown: VecDeque<Instant>,
    /// Pictures that came too late, since the session began.
    missed: u64,
    /// What the headset says of itself.
    worn: Option<bool>,
    focus: Option<String>,
    is_paused: bool,
    lost: Option<String>,
}

#[derive(Debug, Default, Clone, Copy)]
struct Tracking {
    /// Whether it was tracked before, whether it is lost now, and since when [s].
    was_tracked: bool,
    is_missing: bool,
    missing_s: f64,
    losses: u32,
    lost_s: f64,
}

impl Tracking {
    fn follow(&mut self, is_tracked: bool, seconds: f64) {
        if is_tracked {
            *self = Self {
                was_tracked: true,
                is_missing: false,
                missing_s: 0.0,
                ..*self
            };
            return;
        }
        // What was never tracked is not lost.
        self.losses += u32::from(self.was_tracked && !self.is_missing);
        self.is_missing = true;
        self.missing_s += seconds;
        if self.was_tracked {
            self.lost_s += seconds;
        }
    }

    fn text(&self) -> String {
        let now = match (self.was_tracked, self.is_missing) {
            (false, _) => "not tracked yet".to_owned(),
            (true, false) => "tracked".to_owned(),
            (true, true) => format!("LOST for {:.0} s", self.missing_s),
        };
        match self.losses {
            0 => now,
            1 => format!("{now} (lost once, {:.1} s)", self.lost_s),
            losses => format!("{now} (lost {losses} times, {:.1} s in all)", self.lost_s),
        }
    }
}

impl Health {
    /// Takes notice of a frame's input, which lasts `seconds`. In a pause the hand is gone because nobody plays.
    pub fn follow(&mut self, input: &Input, seconds: f64) {
        if input.paused {
            return;
        }
        let [head, hand] = &mut self.tracked;
        head.follow(input.head.is_some(), seconds);
        hand.follow(input.hand.is_some(), seconds);
    }

    /// Takes notice of a picture that was shown at `now`, `missed` pictures after it was due.
    pub fn picture(&mut self, now: Instant, missed: u64) {
        self.shown.push_back(now);
        self.missed += missed;
        self.forget(now);
    }

    /// Takes notice of what a headset says of itself, as its lines of the journal have it.
    pub fn hear(&mut self, line: &Value) {
        if let Some(worn) = line["worn"].as_bool() {
            self.worn = Some(worn);
        }
        if let Some(focus) = line["focus"].as_str() {
            self.focus = Some(focus.to_owned());
        }
        if let Some(is_paused) = line["paused"].as_bool() {
            self.is_paused = is_paused;
        }
        if let Some(lost) = line["lost"].as_str() {
            self.lost = Some(lost.to_owned());
        }
        match line["runtime_answers"].as_bool() {
            Some(true) => self.lost = None,
            Some(false) => self.lost = Some("the runtime does not answer".to_owned()),
            None => {}
        }
        if line.get("reconnected").is_some() {
            self.lost = None;
        }
    }

    /// The lines that the experimenter reads, at `now`.
    pub fn lines(&self, now: Instant) -> Vec<String> {
        let [head, hand] = &self.tracked;
        let recent = |at: &&Instant| now.saturating_duration_since(**at) < WINDOW;
        let mut lines = vec![
            format!("Head {}.", head.text()),
            format!("Hand {}.", hand.text()),
        ];
        if !self.shown.is_empty() {
            let pictures = self.shown.iter().filter(recent).count();
            lines.push(format!(
                "{pictures} pictures in the last second, {} missed in all.",
                self.missed
            ));
        }
        lines.extend(self.why_it_waits());
        lines
    }

    fn why_it_waits(&self) -> Option<String> {
        if let Some(lost) = &self.lost {
            return Some(format!("THE GAME WAITS: {lost}."));
        }
        let why = if self.worn == Some(false) {
            "the headset is off"
        } else if self.is_paused {
            "the participant paused it"
        } else if self
            .focus
            .as_deref()
            .is_some_and(|focus| focus != "focused")
        {
            "the participant is in a menu of the system, or the headset is idle"
        } else {
            return None;
        };
        Some(format!("THE GAME WAITS: {why}."))
    }

    fn forget(&mut self, now: Instant) {
        while self
            .shown
            .front()
            .is_some_and(|at| now.saturating_duration_since(*at) >= WINDOW)
        {
            self.shown.pop_front();
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use game::Tracked;
    use physics::Pose;
    use serde_json::json;

    fn input(hand: bool) -> Input {
        let tracked = Tracked::at(Pose::IDENTITY);
        Input {
            head: Some(tracked),
            hand: hand.then_some(tracked),
            ..Input::default()
        }
    }

    #[test]
    fn losses_are_counted_once_each_and_only_after_something_was_tracked() {
        let now = Instant::now();
        let mut health = Health::default();
        for hand in [false, false] {
            health.follow(&input(hand), 0.5);
        }
        assert_eq!(health.lines(now)[1], "Hand not tracked yet.");
        for hand in [true, false, false, true, false] {
            health.follow(&input(hand), 0.5);
        }
        let lines = health.lines(now);
        assert_eq!(lines[0], "Head tracked.");
        // The half second is rounded to an even number.
        assert_eq!(lines[1], "Hand LOST for 0 s (lost 2 times, 1.5 s in all).");
    }

    #[test]
    fn a_pause_is_no_loss_and_a_loss_without_time_is_one() {
        let mut health = Health::default();
        health.follow(&input(true), 0.5);
        let pause = Input {
            paused: true,
            ..Input::default()
        };
        for _ in 0..10 {
            health.follow(&pause, 0.0);
        }
        assert_eq!(health.lines(Instant::now())[1], "Hand tracked.");
        for _ in 0..10 {
            health.follow(&input(false), 0.0);
        }
        let lines = health.lines(Instant::now());
        assert_eq!(lines[1], "Hand LOST for 0 s (lost once, 0.0 s).");
    }

    #[test]
    fn pictures_are_those_of_the_last_second_and_missed_ones_add_up() {
        let begun = Instant::now();
        let mut health = Health::default();
        assert_eq!(health.lines(begun).len(), 2, "none was shown");
        for number in 0..19 {
            let at = begun + Duration::from_millis(100 * number);
            health.picture(at, 2);
        }
        let lines = health.lines(begun + Duration::from_millis(1850));
        assert_eq!(
            lines[2],
            "10 pictures in the last second, 38 missed in all."
        );
    }

    #[test]
    fn what_keeps_the_game_waiting_is_said_until_it_is_over() {
        let now = Instant::now();
        let mut health = Health::default();
        let waits = |health: &Health| health.lines(now).get(2).cloned();
        let cases = [
            (json!({"worn": false}), json!({"worn": true}), "is off"),
            (json!({"paused": true}), json!({"paused": false}), "paused"),
            (
                json!({"focus": "visible"}),
                json!({"focus": "focused"}),
                "menu",
            ),
            (json!({"lost": "gone"}), json!({"reconnected": "x"}), "gone"),
            (
                json!({"runtime_answers": false}),
                json!({"runtime_answers": true}),
                "does not answer",
            ),
        ];
        for (begins, ends, words) in cases {
            health.hear(&begins);
            let line = waits(&health).expect("it waits");
            assert!(line.contains(words) && line.contains("WAITS"), "{line}");
            health.hear(&ends);
            assert_eq!(waits(&health), None);
        }
    }
}
