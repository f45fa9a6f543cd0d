//! Ten-pin scoring: a pure function of the rolls, fouls included.

use std::fmt;

use serde::{Deserialize, Serialize};

/// Pins of a full rack.
pub const PINS: u8 = 10;

/// One delivery, as the rules see it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Roll {
    /// Pins that this delivery felled, whether they count or not.
    pub fallen: u8,
    /// True when it was delivered from beyond the foul line: it counts as zero pins.
    pub foul: bool,
}

impl Roll {
    /// A fair delivery that felled `fallen` pins.
    pub fn fair(fallen: u8) -> Self {
        Self {
            fallen,
            foul: false,
        }
    }

    /// A foul: zero pins, whatever fell.
    pub fn foul(fallen: u8) -> Self {
        Self { fallen, foul: true }
    }

    /// Pins that count.
    pub fn pins(self) -> u8 {
        if self.foul { 0 } else { self.fallen }
    }
}

/// What the next delivery is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Delivery {
    /// Frame, from 1.
    pub frame: u32,
    /// Ball within the frame, from 1.
    pub ball: u32,
    /// Pins that stand before it.
    pub standing: u8,
}

/// A roll that the rules of the game cannot hold.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum ScoreError {
    /// Every frame is complete.
    #[error("the game is over: it has no further delivery")]
    Over,
    /// More pins fell than stood.
    #[error("{fallen} pins cannot fall where {standing} stand")]
    TooMany {
        /// Pins said to have fallen.
        fallen: u8,
        /// Pins that stood.
        standing: u8,
    },
}

/// The rolls of one game and everything that follows from them.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct ScoreSheet {
    frames: u32,
    rolls: Vec<Roll>,
}

impl ScoreSheet {
    /// An empty sheet for a game of `frames` frames; the last one has the rules of a tenth frame.
    pub fn new(frames: u32) -> Self {
        Self {
            frames: frames.max(1),
            rolls: Vec::new(),
        }
    }

    /// Number of frames of the game.
    pub fn frames(&self) -> u32 {
        self.frames
    }

    /// Every delivery so far, in order.
    pub fn rolls(&self) -> &[Roll] {
        &self.rolls
    }

    /// Adds one delivery.
    ///
    /// # Errors
    /// When the game is over, or more pins fell than stood.
    pub fn add(&mut self, roll: Roll) -> Result<(), ScoreError> {
        let next = self.next_delivery().ok_or(ScoreError::Over)?;
        if roll.fallen > next.standing {
            return Err(ScoreError::TooMany {
                fallen: roll.fallen,
                standing: next.standing,
            });
        }
        self.rolls.push(roll);
        Ok(())
    }

    /// The delivery that comes next; `None` when the game is over.
    pub fn next_delivery(&self) -> Option<Delivery> {
        let spans = self.spans();
        let open = spans.last().filter(|(_, complete)| !complete);
        let Some((span, _)) = open else {
            let frame = spans.len() as u32 + 1;
            return (frame <= self.frames).then_some(Delivery {
                frame,
                ball: 1,
                standing: PINS,
            });
        };
        let standing = span.iter().fold(PINS, |standing, roll| {
            match standing - roll.pins() {
                0 => PINS, // Strike or spare in the last frame: a new rack.
                left => left,
            }
        });
        Some(Delivery {
            frame: spans.len() as u32,
            ball: span.len() as u32 + 1,
            standing,
        })
    }

    /// True when every frame is complete.
    pub fn is_over(&self) -> bool {
        self.next_delivery().is_none()
    }

    /// Cumulative score after each frame that has been started; `None` while a bonus is still open.
    pub fn frame_scores(&self) -> Vec<Option<u32>> {
        let mut first = 0;
        let mut total = Some(0);
        let mut scores = Vec::new();
        for (index, (span, complete)) in self.spans().into_iter().enumerate() {
            let is_last = index as u32 + 1 == self.frames;
            // A strike counts the next two balls, a spare the next one; the last frame bowls its own bonus balls.
            let counted = match span {
                _ if is_last => span.len(),
                [one] if one.pins() == PINS => 3,
                [one, two] if one.pins() + two.pins() == PINS => 3,
                _ => span.len(),
            };
            let balls = self.rolls.get(first..first + counted).filter(|_| complete);
            let frame =
                balls.map(|balls| balls.iter().map(|roll| u32::from(roll.pins())).sum::<u32>());
            total = total.zip(frame).map(|(total, frame)| total + frame);
            scores.push(total);
            first += span.len();
        }
        scores
    }

    /// The score of the frames whose bonuses are known.
    pub fn total(&self) -> u32 {
        self.frame_scores()
            .into_iter()
            .flatten()
            .last()
            .unwrap_or(0)
    }

    /// The marks of each started frame, as they are written on a score sheet: `X`, `9/`, `-7`, `F9`.
    pub fn marks(&self) -> Vec<String> {
        self.spans()
            .iter()
            .map(|(span, _)| frame_marks(span))
            .collect()
    }

    /// Each started frame's rolls, and whether the frame is complete.
    fn spans(&self) -> Vec<(&[Roll], bool)> {
        let mut rest = &self.rolls[..];
        let mut spans = Vec::new();
        while !rest.is_empty() {
            let is_last = spans.len() as u32 + 1 == self.frames;
            let wanted = frame_length(rest, is_last);
            let (span, tail) = rest.split_at(wanted.min(rest.len()));
            spans.push((span, span.len() == wanted));
            rest = tail;
        }
        spans
    }
}

/// Balls in the frame that starts with `rolls`.
fn frame_length(rolls: &[Roll], is_last: bool) -> usize {
    let first = rolls[0].pins();
    if !is_last {
        return if first == PINS { 1 } else { 2 };
    }
    let two = first + rolls.get(1).map_or(0, |roll| roll.pins());
    if two >= PINS { 3 } else { 2 }
}

/// Marks of one frame.
fn frame_marks(span: &[Roll]) -> String {
    let mut standing = PINS;
    let mut marks = String::new();
    for roll in span {
        let is_fresh = standing == PINS && !marks.ends_with(['-', 'F']);
        standing -= roll.pins();
        marks.push(match (roll.foul, roll.pins()) {
            (true, _) => 'F',
            (_, 0) => '-',
            (_, PINS) if is_fresh => 'X',
            _ if standing == 0 => '/',
            (_, pins) => char::from(b'0' + pins),
        });
        if standing == 0 {
            standing = PINS;
        }
    }
    marks
}

impl fmt::Display for ScoreSheet {
    /// Three lines in boxes: frame, marks, cumulative score.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let marks = self.marks();
        let scores = self.frame_scores();
        let frames = self.frames as usize;
        let width = |frame: usize| if frame + 1 == frames { 5 } else { 3 };
        let row = |cell: &dyn Fn(usize) -> String| -> String {
            (0..frames)
                .map(|frame| format!("|{:>1$} ", cell(frame), width(frame)))
                .chain(["|".to_owned()])
                .collect()
        };
        let rule: String = (0..frames)
            .map(|frame| format!("+{}", "-".repeat(width(frame) + 1)))
            .chain(["+".to_owned()])
            .collect();
        let spaced = |frame: usize| {
            let marks = marks.get(frame).map_or("", String::as_str);
            let letters: Vec<String> = marks.chars().map(String::from).collect();
            letters.join(" ")
        };
        let score = |frame: usize| {
            let score = scores.get(frame).copied().flatten();
            score.map_or(String::new(), |score| score.to_string())
        };
        writeln!(f, "{rule}")?;
        writeln!(f, "{}", row(&|frame| (frame + 1).to_string()))?;
        writeln!(f, "{rule}")?;
        writeln!(f, "{}", row(&spaced))?;
        writeln!(f, "{}", row(&score))?;
        write!(f, "{rule}")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The rolls of a game of `scores.csv`; a foul is an `F` among the marks.
    fn sheet(marks: &str, rolls: &str) -> ScoreSheet {
        let letters = marks.chars().filter(|mark| *mark != ' ');
        let fallen = rolls.split(' ').map(|roll| roll.parse::<u8>().unwrap());
        let mut sheet = ScoreSheet::new(10);
        for (mark, fallen) in letters.zip(fallen) {
            let roll = Roll {
                fallen,
                foul: mark == 'F',
            };
            sheet.add(roll).unwrap();
        }
        sheet
    }

    #[test]
    fn reference_games_agree() {
        let table = include_str!("../tests/data/scores.csv");
        let mut games = 0;
        for line in table.lines().skip(1) {
            let columns: Vec<&str> = line.split(',').collect();
            let sheet = sheet(columns[1], columns[2]);
            let scores: Vec<u32> = sheet.frame_scores().into_iter().flatten().collect();
            let expected: Vec<u32> = columns[3..13]
                .iter()
                .map(|score| score.parse().unwrap())
                .collect();
            assert_eq!(scores, expected, "{}", columns[0]);
            assert_eq!(sheet.total().to_string(), columns[13], "{}", columns[0]);
            assert_eq!(sheet.marks().join(" "), columns[1], "{}", columns[0]);
            assert!(sheet.is_over(), "{}", columns[0]);
            games += 1;
        }
        assert_eq!(games, 15);
    }

    #[test]
    fn next_delivery_follows_the_rules() {
        let mut sheet = ScoreSheet::new(2);
        let mut next = Vec::new();
        // Foul with seven down: the rack is set again. Then a spare, then a last frame with two new racks.
        for roll in [
            Roll::foul(7),
            Roll::fair(10),
            Roll::fair(10),
            Roll::fair(4),
            Roll::fair(6),
        ] {
            let delivery = sheet.next_delivery().unwrap();
            next.push((delivery.frame, delivery.ball, delivery.standing));
            sheet.add(roll).unwrap();
        }
        assert_eq!(
            next,
            [(1, 1, 10), (1, 2, 10), (2, 1, 10), (2, 2, 10), (2, 3, 6)]
        );
        assert_eq!(sheet.next_delivery(), None);
        assert_eq!(sheet.total(), 40);
    }

    #[test]
    fn a_foul_after_seven_leaves_the_frame_at_seven() {
        let mut sheet = ScoreSheet::new(1);
        sheet.add(Roll::fair(7)).unwrap();
        sheet.add(Roll::foul(3)).unwrap();
        assert!(sheet.is_over());
        assert_eq!(sheet.total(), 7);
        assert_eq!(sheet.marks(), ["7F"]);
    }

    #[test]
    fn impossible_rolls_are_refused() {
        let mut sheet = ScoreSheet::new(1);
        sheet.add(Roll::fair(7)).unwrap();
        let too_many = ScoreError::TooMany {
            fallen: 4,
            standing: 3,
        };
        assert_eq!(sheet.add(Roll::fair(4)), Err(too_many));
        sheet.add(Roll::fair(2)).unwrap();
        assert_eq!(sheet.add(Roll::fair(1)), Err(ScoreError::Over));
    }

    #[test]
    fn an_open_bonus_has_no_score_yet() {
        let mut sheet = ScoreSheet::new(3);
        sheet.add(Roll::fair(10)).unwrap();
        sheet.add(Roll::fair(3)).unwrap();
        assert_eq!(sheet.frame_scores(), [None, None]);
        sheet.add(Roll::fair(4)).unwrap();
        assert_eq!(sheet.frame_scores(), [Some(17), Some(24)]);
    }

    #[test]
    fn a_sheet_prints_in_boxes() {
        let mut sheet = ScoreSheet::new(3);
        for pins in [10, 7, 3, 9, 0] {
            sheet.add(Roll::fair(pins)).unwrap();
        }
        let expected = "\
+----+----+------+
|  1 |  2 |    3 |
+----+----+------+
|  X |7 / |  9 - |
| 20 | 39 |   48 |
+----+----+------+";
        assert_eq!(sheet.to_string(), expected);
    }
}
