//! The motion table: head and hand in the world, one row per frame of the device.
//!
//! Derived: the same code makes it while a session runs and when a journal is played again, so a
//! table that does not agree with its journal was changed.

use std::fmt;

use game::{Game, Input};
use physics::Pose;

/// Column names. World frame: origin at the centre of the foul line on the lane's surface, x to the
/// bowler's right, y up, the lane along -z; quaternions are `world_from_head` and `world_from_hand`.
pub fn heading() -> String {
    let mut columns = vec!["time_s".to_owned()];
    for part in ["head", "hand"] {
        columns.extend(
            ["x_m", "y_m", "z_m", "qx", "qy", "qz", "qw"]
                .map(|column| format!("{part}_world_{column}")),
        );
    }
    columns.extend(["trigger".to_owned(), "walking".to_owned()]);
    columns.join("\t")
}

/// One row; shown, it is the table's line: metres to the micrometre, `n/a` where not tracked, `walking` 1 forward, -1 backward,
/// 0 neither.
#[derive(Debug, Clone, Copy)]
pub struct Row {
    time_s: f64,
    head: Option<Pose>,
    hand: Option<Pose>,
    trigger: f64,
    walking: i8,
}

impl Row {
    /// The row for the frame that `game` has just finished with `input`.
    pub fn new(game: &Game, input: &Input) -> Self {
        Self {
            time_s: game.time(),
            head: game.head_pose_world(),
            hand: game.hand_pose_world(),
            trigger: input.trigger,
            walking: i8::from(input.walk_forward) - i8::from(input.walk_back),
        }
    }
}

impl fmt::Display for Row {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{:.6}", self.time_s)?;
        for pose in [self.head, self.hand] {
            write_pose(f, pose)?;
        }
        write!(f, "\t{:.4}\t{}", self.trigger, self.walking)
    }
}

fn write_pose(f: &mut fmt::Formatter<'_>, pose: Option<Pose>) -> fmt::Result {
    let Some(pose) = pose else {
        return f.write_str(&"\tn/a".repeat(7));
    };
    let position = pose.position.to_array();
    for number in position.into_iter().chain(pose.rotation.to_array()) {
        // Adding zero turns -0 into 0.
        write!(f, "\t{:.6}", number + 0.0)?;
    }
    Ok(())
}

/// Compares a table as it lies on disk, byte for byte, with one line after another as it should be.
#[derive(Debug)]
pub struct Comparison<'a> {
    rest: &'a str,
    number: usize,
}

impl<'a> Comparison<'a> {
    /// Starts with the heading.
    ///
    /// # Errors
    /// A sentence without the file's name when the heading differs.
    pub fn new(table: &'a str) -> Result<Self, String> {
        let mut comparison = Comparison {
            rest: table,
            number: 0,
        };
        comparison.expect_line(&heading())?;
        Ok(comparison)
    }

    /// Compares the next line.
    ///
    /// # Errors
    /// A sentence with the line's number when it differs or is missing.
    pub fn expect_line(&mut self, expected: &str) -> Result<(), String> {
        self.number += 1;
        if self.rest.is_empty() {
            return Err(format!(
                "line {}: the motion table ends here, but the journal goes on",
                self.number
            ));
        }
        let (line, rest) = match self.rest.split_once('\n') {
            Some((line, rest)) if line == expected => {
                self.rest = rest;
                return Ok(());
            }
            Some(parts) => parts,
            None => (self.rest, ""),
        };
        self.rest = rest;
        if line.strip_suffix('\r').unwrap_or(line) == expected {
            return Err(format!(
                "line {}: the line's end was changed after it was recorded (a line ends with a single line feed)",
                self.number
            ));
        }
        Err(format!(
            "line {}: the motion table does not agree with the journal: it says `{}` where the journal gives `{}`",
            self.number,
            first_difference(line, expected),
            first_difference(expected, line)
        ))
    }

    /// Makes sure that nothing follows.
    ///
    /// # Errors
    /// A sentence with the line's number when something does.
    pub fn expect_end(self) -> Result<(), String> {
        if self.rest.is_empty() {
            return Ok(());
        }
        Err(format!(
            "line {}: the motion table goes on where the journal ends",
            self.number + 1
        ))
    }
}

/// The first column of `line` that differs from `other`.
fn first_difference<'a>(line: &'a str, other: &str) -> &'a str {
    let mut others = other.split('\t');
    line.split('\t')
        .find(|column| others.next() != Some(column))
        .unwrap_or("")
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::{DQuat, DVec3};

    #[test]
    fn a_row_has_a_field_for_every_column_tracked_or_not() {
        let head = Some(Pose {
            position: DVec3::new(-0.0, 1.5, -0.25),
            rotation: DQuat::IDENTITY,
        });
        let row = Row {
            time_s: 0.25,
            head,
            hand: None,
            trigger: 1.0,
            walking: -1,
        };
        let zeros = "0.000000\t".repeat(3);
        let expected = format!(
            "0.250000\t0.000000\t1.500000\t-0.250000\t{zeros}1.000000{}\t1.0000\t-1",
            "\tn/a".repeat(7)
        );
        assert_eq!(row.to_string(), expected);
        assert_eq!(heading().split('\t').count(), expected.split('\t').count());
    }

    #[test]
    fn comparison_names_line_and_column_of_the_first_difference() {
        let table = format!("{}\n0.1\t2\t3\n0.2\t2\t4\n", heading());
        let mut comparison = Comparison::new(&table).expect("the heading agrees");
        comparison.expect_line("0.1\t2\t3").expect("agrees");
        let problem = comparison
            .expect_line("0.2\t2\t5")
            .expect_err("a column differs");
        assert!(
            problem.starts_with("line 3:") && problem.contains("`4`") && problem.contains("`5`"),
            "{problem}"
        );
    }

    #[test]
    fn comparison_finds_other_line_ends() {
        for (rows, line) in [("0.1\r\n0.2\n", 2), ("0.1\n0.2", 3)] {
            let table = format!("{}\n{rows}", heading());
            let mut comparison = Comparison::new(&table).expect("the heading agrees");
            let problem = comparison
                .expect_line("0.1")
                .and_then(|()| comparison.expect_line("0.2"))
                .expect_err("one line's end differs");
            let start = format!("line {line}: the line's end was changed");
            assert!(problem.starts_with(&start), "{problem}");
        }
    }

    #[test]
    fn comparison_finds_a_table_that_is_too_short_or_too_long() {
        let table = format!("{}\n0.1\n", heading());
        let mut short = Comparison::new(&table).expect("the heading agrees");
        short.expect_line("0.1").expect("agrees");
        assert!(
            short
                .expect_line("0.2")
                .expect_err("it ends")
                .contains("ends here")
        );
        let long = Comparison::new(&table).expect("the heading agrees");
        assert!(
            long.expect_end()
                .expect_err("a line is left")
                .starts_with("line 2:")
        );
    }
}
