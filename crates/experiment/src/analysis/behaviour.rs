//! What a study's recordings say beside the questionnaire: pins, answers of the head to what came towards it, frame times.

use std::path::{Path, PathBuf};

use serde_json::{Value, json};

use super::subjects::PARAMETERS;
use super::table::{Table, TableError};

/// An interval between frames longer than this is a pause between two recordings [s].
const LONGEST_FRAME_S: f64 = 1.0;

/// What happened in one game.
#[derive(Debug, Clone, PartialEq)]
pub struct Game {
    /// The participant.
    pub id: String,
    /// Index of the changed parameter.
    pub parameter: usize,
    /// Whether it was the game with the parameter at its high level.
    pub is_high: bool,
    /// Pins of each throw.
    pub pins: Vec<f64>,
    /// Objects that came towards the head, and of these the ones that it answered.
    pub approaches: (usize, usize),
    /// Intervals between frames [s].
    pub intervals: Vec<f64>,
}

/// Reads the recordings of a study; empty where it has none.
///
/// # Errors
/// When a table of a recording cannot be read.
pub fn read(study: &Path) -> Result<Vec<Game>, TableError> {
    let mut games = Vec::new();
    let (participants, allocation) = (
        study.join("data/participants.tsv"),
        study.join("plan/allocation.csv"),
    );
    if !participants.is_file() || !allocation.is_file() {
        return Ok(games);
    }
    let (participants, allocation) = (Table::read(&participants)?, Table::read(&allocation)?);
    let id = participants.needed(&["participant_id"], "names the participants")?;
    let slot = participants.needed(&["slot"], "joins participants and allocation")?;
    let allocated = allocation.needed(&["slot"], "joins participants and allocation")?;
    for row in &participants.rows {
        let Some(place) = (0..allocation.rows.len())
            .find(|&place| allocation.rows[place][allocated] == row[slot])
        else {
            continue;
        };
        for events in files(&study.join("data").join(&row[id]), "_events.tsv") {
            games.extend(game(&row[id], &events, &allocation, place)?);
        }
    }
    Ok(games)
}

/// The files below a folder whose names end so, in order.
fn files(folder: &Path, end: &str) -> Vec<PathBuf> {
    let mut found = Vec::new();
    let mut folders = vec![folder.to_path_buf()];
    while let Some(folder) = folders.pop() {
        // What is not there has no files.
        for entry in std::fs::read_dir(folder).into_iter().flatten().flatten() {
            let path = entry.path();
            if path.is_dir() {
                folders.push(path);
            } else if path
                .file_name()
                .is_some_and(|name| name.to_string_lossy().ends_with(end))
            {
                found.push(path);
            }
        }
    }
    found.sort();
    found
}

/// The game of one table of events; `None` where nothing in it says which button it was.
fn game(
    id: &str,
    path: &Path,
    allocation: &Table,
    place: usize,
) -> Result<Option<Game>, TableError> {
    let text = std::fs::read_to_string(path).unwrap_or_default();
    if text.lines().count() < 2 {
        // A game that ended before anything happened.
        return Ok(None);
    }
    let events = Table::parse(&path.display().to_string(), &text)?;
    let button = events.needed(&["button"], "says which game it was")?;
    let pins_down = events.needed(&["pins_down"], "counts the pins")?;
    let Some(button) = (0..events.rows.len()).find_map(|row| events.cell(row, button)) else {
        return Ok(None);
    };
    let cell = |name: &str| {
        allocation
            .column(&[name])
            .and_then(|column| allocation.cell(place, column))
    };
    let parameter =
        cell("changed").and_then(|word| PARAMETERS.iter().position(|name| *name == word));
    let levels = cell(if button == "Red" {
        "red_efs"
    } else {
        "blue_efs"
    });
    let Some((parameter, levels)) = parameter.zip(levels) else {
        return Ok(None);
    };
    let mut game = Game {
        id: id.to_owned(),
        parameter,
        is_high: levels.as_bytes().get(parameter) == Some(&b'1'),
        pins: Vec::new(),
        approaches: (0, 0),
        intervals: intervals(path),
    };
    let (displacement, onset) = (
        events.column(&["head_displacement"]),
        events.column(&["head_onset"]),
    );
    for row in 0..events.rows.len() {
        game.pins.extend(events.number(row, pins_down)?);
        let is_there =
            |column: Option<usize>| column.is_some_and(|column| events.cell(row, column).is_some());
        game.approaches.0 += usize::from(is_there(displacement));
        game.approaches.1 += usize::from(is_there(displacement) && is_there(onset));
    }
    Ok(Some(game))
}

/// The intervals between the frames of the motion table beside a table of events, whose first column is the time [s].
fn intervals(events: &Path) -> Vec<f64> {
    let name = events
        .to_string_lossy()
        .replace("_events.tsv", "_motion.tsv");
    let text = std::fs::read_to_string(name).unwrap_or_default();
    let times = text
        .lines()
        .filter_map(|line| line.split('\t').next()?.parse::<f64>().ok());
    let times: Vec<f64> = times.collect();
    times
        .windows(2)
        .map(|two| two[1] - two[0])
        .filter(|interval| (0.0..LONGEST_FRAME_S).contains(interval))
        .collect()
}

/// A summary of several numbers.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Summary {
    /// How many there are.
    pub count: usize,
    /// Mean.
    pub mean: f64,
    /// Median.
    pub median: f64,
    /// What 99 in a hundred stay below.
    pub p99: f64,
    /// Largest.
    pub most: f64,
}

/// Summarises; `None` where there is nothing.
pub fn summary(values: &[f64]) -> Option<Summary> {
    let mut sorted = values.to_vec();
    sorted.sort_by(f64::total_cmp);
    let at = |share: f64| sorted[((sorted.len() - 1) as f64 * share).round() as usize];
    let most = *sorted.last()?;
    let mean = sorted.iter().sum::<f64>() / sorted.len() as f64;
    Some(Summary {
        count: sorted.len(),
        mean,
        median: at(0.5),
        p99: at(0.99),
        most,
    })
}

/// The games of one parameter and level.
#[derive(Debug, Clone, PartialEq)]
pub struct Behaviour {
    /// Index of the changed parameter.
    pub parameter: usize,
    /// Whether at its high level.
    pub is_high: bool,
    /// Games.
    pub games: usize,
    /// Pins of a throw.
    pub pins: Option<Summary>,
    /// Objects that came towards the head, and those that it answered.
    pub approaches: (usize, usize),
    /// Intervals between frames [s].
    pub frames: Option<Summary>,
}

/// The games by parameter and level, in their order; what nobody played is left out.
pub fn by_condition(games: &[Game]) -> Vec<Behaviour> {
    let mut conditions = Vec::new();
    for parameter in 0..PARAMETERS.len() {
        for is_high in [false, true] {
            let of: Vec<&Game> = games
                .iter()
                .filter(|game| game.parameter == parameter && game.is_high == is_high)
                .collect();
            if of.is_empty() {
                continue;
            }
            let pins: Vec<f64> = of
                .iter()
                .flat_map(|game| game.pins.iter().copied())
                .collect();
            let intervals: Vec<f64> = of
                .iter()
                .flat_map(|game| game.intervals.iter().copied())
                .collect();
            let add = |sum: (usize, usize), game: &&Game| {
                (sum.0 + game.approaches.0, sum.1 + game.approaches.1)
            };
            conditions.push(Behaviour {
                parameter,
                is_high,
                games: of.len(),
                pins: summary(&pins),
                approaches: of.iter().fold((0, 0), add),
                frames: summary(&intervals),
            });
        }
    }
    conditions
}

/// Every number.
pub fn json(conditions: &[Behaviour]) -> Value {
    let summary = |summary: Option<Summary>| {
        summary.map(|s| json!({"count": s.count, "mean": s.mean, "median": s.median, "p99": s.p99, "max": s.most}))
    };
    let condition = |condition: &Behaviour| {
        json!({
            "changed": PARAMETERS[condition.parameter],
            "level": u8::from(condition.is_high),
            "games": condition.games,
            "pins_per_throw": summary(condition.pins),
            "approaches": condition.approaches.0,
            "approaches_answered": condition.approaches.1,
            "frame_interval_s": summary(condition.frames),
        })
    };
    conditions.iter().map(condition).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn read_tells_games_by_button_and_plan() {
        let folder = tempfile::tempdir().unwrap();
        let put = |name: &str, text: &str| {
            let path = folder.path().join(name);
            std::fs::create_dir_all(path.parent().unwrap()).unwrap();
            std::fs::write(path, text).unwrap();
        };
        put("data/participants.tsv", "participant_id\tslot\nsub-a\t1\n");
        put(
            "plan/allocation.csv",
            "slot,changed,red_efs,blue_efs\n1,friction,000,010\n",
        );
        let head = "onset\tbutton\tpins_down\thead_displacement\thead_onset\n";
        let stem = "data/sub-a/ses-01/motion/sub-a_ses-01_run-";
        put(
            &format!("{stem}1_events.tsv"),
            &format!(
                "{head}0\tBlue\t7\tn/a\tn/a\n1\tBlue\tn/a\t0.1\t0.2\n2\tBlue\tn/a\t0.0\tn/a\n"
            ),
        );
        put(
            &format!("{stem}1_motion.tsv"),
            "0.00\t1\n0.01\t1\n0.03\t1\n9.0\t1\n",
        );
        put(
            &format!("{stem}2_events.tsv"),
            &format!("{head}0\tRed\t3\tn/a\tn/a\n"),
        );
        let games = read(folder.path()).unwrap();
        assert_eq!(games.len(), 2);
        assert!(games[0].is_high && !games[1].is_high && games[0].parameter == 1);
        assert_eq!(
            (games[0].pins.as_slice(), games[0].approaches),
            ([7.0].as_slice(), (2, 1))
        );
        let frames = by_condition(&games)[1].frames.unwrap();
        assert!(frames.count == 2 && (frames.most - 0.02).abs() < 1e-12);
    }
}
