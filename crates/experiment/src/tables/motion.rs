//! One run: head and hand, their channels, and what happened.

use std::fmt::Write;

use serde_json::{Value, json};

use super::{Column, Table, number, optional};
use crate::record::{MotionRow, Run, SessionRecord, Task, TrialType};

/// The world frame, in which poses are given.
const FRAME: &str = "world";
const AXES: [&str; 3] = ["x", "y", "z"];
const QUATERNION: [&str; 4] = ["quat_x", "quat_y", "quat_z", "quat_w"];

/// Names of the motion table's columns; the file itself has no heading, as BIDS wants it.
pub(super) fn columns() -> Vec<String> {
    channels()
        .rows
        .into_iter()
        .map(|mut row| row.swap_remove(0))
        .collect()
}

/// What each column of the motion table is.
pub(super) fn channels() -> Table {
    let mut table = Table::new(vec![
        Column::new("name", "column of the motion table"),
        Column::new("component", "axis"),
        Column::new("type", "kind of channel"),
        Column::new("tracked_point", "head or hand"),
        Column::new("units", "unit"),
        Column::new("reference_frame", "frame in which it is given"),
    ]);
    let mut push = |cells: [&str; 6]| table.push(cells.map(str::to_owned).to_vec());
    push(["t", "n/a", "LATENCY", "n/a", "s", "n/a"]);
    for (point, name) in [("Head", "head"), ("Hand", "hand")] {
        for axis in AXES {
            push([
                &format!("{name}_pos_{axis}"),
                axis,
                "POS",
                point,
                "m",
                FRAME,
            ]);
        }
        for part in QUATERNION {
            push([&format!("{name}_{part}"), part, "ORNT", point, "n/a", FRAME]);
        }
        push([&format!("{name}_valid"), "n/a", "MISC", point, "n/a", "n/a"]);
    }
    table
}

/// What the frame is.
pub(super) fn channels_dictionary() -> Value {
    json!({
        "reference_frame": {
            "Description": "frame in which a channel is given",
            "Levels": {
                (FRAME): {
                    "SpatialAxes": "RSP",
                    "RotationRule": "right-hand",
                    "Description": "+x to the bowler's right, +y up, the lane along -z; origin at the middle of the foul line, on the lane's surface; walking included; metres; unit quaternions world_from_head and world_from_hand",
                }
            }
        }
    })
}

/// The rows: time, then position, quaternion and validity of head and hand; `n/a` and 0 where not tracked.
pub(super) fn motion(run: &Run) -> String {
    // About 130 characters a row.
    let mut text = String::with_capacity(run.motion.len() * 160);
    for row in &run.motion {
        line(&mut text, row);
    }
    text
}

fn line(text: &mut String, row: &MotionRow) {
    write!(text, "{:.6}", row.time_s).expect("a String takes everything");
    for pose in [&row.head, &row.hand] {
        match pose {
            Some(numbers) => {
                for number in numbers {
                    // Less than half a millionth below zero would be written -0.000000.
                    let number = if number.abs() < 5e-7 { 0.0 } else { *number };
                    write!(text, "\t{number:.6}").expect("a String takes everything");
                }
                text.push_str("\t1");
            }
            None => text.push_str("\tn/a\tn/a\tn/a\tn/a\tn/a\tn/a\tn/a\t0"),
        }
    }
    text.push('\n');
}

/// What the recording is.
pub(super) fn motion_dictionary(record: &SessionRecord, run: &Run, system: &str) -> Value {
    let duration = match (run.motion.first(), run.motion.last()) {
        (Some(first), Some(last)) => last.time_s - first.time_s,
        _ => 0.0,
    };
    let effective = if duration > 0.0 {
        (run.motion.len() - 1) as f64 / duration
    } else {
        run.sampling_hz
    };
    let made = &record.provenance;
    let or_unknown = |text: &str| {
        if text.is_empty() {
            "n/a".to_owned()
        } else {
            text.to_owned()
        }
    };
    let part = match run.task {
        Task::Game { number, button } => format!("game {number} of 2, {button} button"),
        Task::Pairs => "pairs of throws".to_owned(),
    };
    json!({
        "TaskName": run.task.name(),
        "TaskDescription": format!("ten-pin bowling in a virtual room, {part}"),
        "SamplingFrequency": run.sampling_hz,
        "SamplingFrequencyEffective": (effective * 1e6).round() / 1e6,
        "RecordingDuration": (duration * 1e6).round() / 1e6,
        "TrackingSystemName": system,
        "Manufacturer": or_unknown(&made.manufacturer),
        "ManufacturersModelName": or_unknown(&made.model),
        "SoftwareVersions": format!("bowling {} ({})", made.version, made.commit),
        "TrackedPointsCount": 2,
        "MotionChannelCount": 17,
        "POSChannelCount": 6,
        "ORNTChannelCount": 8,
        "LATENCYChannelCount": 1,
        "MISCChannelCount": 2,
        "SubjectArtefactDescription": "n/a",
        "MissingValues": "n/a",
    })
}

fn event_columns() -> Vec<Column> {
    let types = TrialType::ALL.map(|kind| (kind.name(), kind.description()));
    vec![
        Column::new("onset", "since the run began").with_units("s"),
        Column::new("duration", "how long").with_units("s"),
        Column::new("trial_type", "what happened").with_levels(types),
        Column::new("button", "label of the condition")
            .with_levels([("Red", "the red button"), ("Blue", "the blue button")]),
        Column::new(
            "frame",
            "bowling frame, 1 to 10; where pairs of throws are compared, the pair",
        ),
        Column::new(
            "ball",
            "ball in the frame; where pairs of throws are compared, throw of the pair",
        ),
        Column::new("pins_down", "pins knocked down by this ball"),
        Column::new("object", "what came towards the head"),
        Column::new(
            "time_to_contact",
            "from onset to the foreseen closest approach to the head",
        )
        .with_units("s"),
        Column::new(
            "miss_distance",
            "distance of that approach, from the object's surface to the head's centre",
        )
        .with_units("m"),
        Column::new(
            "head_onset",
            "from onset to the head's answer; n/a when it did not answer",
        )
        .with_units("s"),
        Column::new("head_displacement", "largest way of the head off its place").with_units("m"),
        Column::new("head_speed", "largest speed of the head").with_units("m/s"),
        Column::new(
            "head_gain",
            "how much farther it passed than it would have passed a head that went on as before",
        )
        .with_units("m"),
        Column::new(
            "head_score",
            "largest way in standard deviations of the head's own sway",
        ),
    ]
}

/// The events of one run, or of several with `prefix` columns before them.
pub(super) fn events(run: &Run) -> Table {
    let mut table = Table::new(event_columns());
    for event in &run.events {
        let answer = event.response.as_ref();
        table.push(vec![
            number(event.onset_s),
            optional(event.duration_s, number),
            event.trial_type.name().to_owned(),
            optional(event.button, |button| button.to_string()),
            optional(event.frame, |frame| frame.to_string()),
            optional(event.ball, |ball| ball.to_string()),
            optional(event.pins_down, |pins| pins.to_string()),
            event.object.clone().unwrap_or_default(),
            optional(answer, |answer| number(answer.time_to_contact_s)),
            optional(answer, |answer| number(answer.miss_distance_m)),
            optional(answer.and_then(|answer| answer.onset_s), number),
            optional(answer, |answer| number(answer.displacement_m)),
            optional(answer, |answer| number(answer.speed_mps)),
            optional(answer, |answer| number(answer.gain_m)),
            optional(answer, |answer| number(answer.score)),
        ]);
    }
    table
}

/// The dictionary of all events tables.
pub(super) fn events_dictionary() -> Value {
    Value::Object(Table::new(event_columns()).dictionary())
}
