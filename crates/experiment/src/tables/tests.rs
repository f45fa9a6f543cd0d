//! Tables of made-up sessions.

use std::fs;
use std::path::Path;

use super::*;
use crate::consent::Ticks;
use crate::files;
use crate::plan::{Button, SessionRules};
use crate::protocol::AnsweredIn;
use crate::questionnaire::{Act, Answer, Form, Stage};
use crate::record::*;
use crate::study::tests::{create, create_with};
use crate::study::{Lock, Study};

const ALL: Ticks = Ticks {
    take_part: true,
    share_data: true,
    share_motion: true,
    contact: false,
};

/// Fills a form in: scales get `step`, the rest an answer of its kind, and the item `skipped` is skipped.
pub(crate) fn filled(study: &Study, stage: Stage, step: u8, skipped: &str) -> FilledForm {
    let each_game = study.plan().session.items_after_each_game;
    let mut form = Form::new(study.questionnaire(), stage, each_game);
    let mut at_s = 0.0;
    while let Some(item) = form.current() {
        let chosen = |id: &str| Answer::Choice {
            chosen: vec![id.to_owned()],
            other: "a\tb".to_owned(),
        };
        let answer = match item.id.as_str() {
            "vr_before" | "noticed" => Answer::YesNo(step > 3),
            "age_band" => Answer::Choice {
                chosen: vec!["25-34".to_owned()],
                other: String::new(),
            },
            "noticed_what" => chosen("bounce"),
            "comments" => Answer::Text("fine, \"really\"".to_owned()),
            _ => Answer::Scale(step),
        };
        let act = if item.id == skipped {
            Act::Skip
        } else {
            Act::Answer(answer)
        };
        at_s += 2.5;
        form.act(at_s, act).unwrap();
    }
    FilledForm {
        answered_in: AnsweredIn::Script,
        answers: form.answers(),
    }
}

fn run(number: u32, button: Button) -> Run {
    let pose = |t: f64| [0.1 * t, 1.6, 4.4, 0.0, 0.0, -1e-9, 1.0];
    let motion = (0..90).map(|frame| {
        let time_s = f64::from(frame) / 90.0;
        MotionRow {
            time_s,
            head: Some(pose(time_s)),
            hand: (frame != 7).then(|| pose(-time_s)),
        }
    });
    let mut throw = EventRow::new(0.25, TrialType::BallRoll);
    throw.duration_s = Some(0.5);
    (throw.button, throw.frame, throw.ball, throw.pins_down) =
        (Some(button), Some(1), Some(1), Some(7));
    let mut toward = EventRow::new(0.5, TrialType::TowardHead);
    toward.object = Some("pin 7".to_owned());
    toward.response = Some(HeadResponse {
        time_to_contact_s: 0.4,
        miss_distance_m: 0.05,
        onset_s: None,
        displacement_m: 0.01,
        speed_mps: 0.02,
        gain_m: 0.01,
        score: 0.7,
    });
    Run {
        number,
        task: Task::Game {
            number: number as u8,
            button,
        },
        began: format!("2026-11-22T10:{:02}:00.000000Z", number * 10),
        sampling_hz: 90.0,
        motion: motion.collect(),
        events: vec![EventRow::new(0.0, TrialType::GameStart), throw, toward],
    }
}

/// A record for each of `count` new participants; the second does not share, the third keeps its motion.
pub(crate) fn records(study: &Study, lock: &Lock, count: u64) -> Vec<SessionRecord> {
    let record = |index: u64| {
        let assignment = study.admit(lock, index).unwrap();
        let ticks = Ticks {
            share_data: index != 1,
            share_motion: index != 1 && index != 2,
            ..ALL
        };
        let consent = study.consent_form().agree(ticks, "2026-11-22").unwrap();
        study
            .record_consent(lock, &assignment.participant, &consent)
            .unwrap();
        let step = 1 + (index % 7) as u8;
        let stages = [
            Stage::Before,
            Stage::AfterGame(1),
            Stage::AfterGame(2),
            Stage::After,
        ];
        SessionRecord {
            session: 1,
            slot: assignment.slot,
            status: if index == 4 {
                Status::Partial
            } else {
                Status::Complete
            },
            consent,
            forms: stages
                .map(|stage| filled(study, stage, step, "q4"))
                .to_vec(),
            runs: vec![run(1, Button::Red), run(2, Button::Blue)],
            pairs: None,
            provenance: Provenance {
                version: "0.1.0".to_owned(),
                commit: "0123abc".to_owned(),
                seed: index,
                device: "script".to_owned(),
                refresh_hz: 90.0,
                settings_digest: study.settings_digest(&assignment.participant, 1, "{}"),
                ..Provenance::default()
            },
            began: "2026-11-22T10:00:00Z".to_owned(),
            immersed_s: 1234.5,
            participant: assignment.participant,
        }
    };
    (0..count).map(record).collect()
}

fn write_all(study: &Study, lock: &Lock, records: &[SessionRecord]) {
    let tables = Tables::of(study, lock);
    for record in records {
        tables.write_session(record).unwrap();
    }
    let summaries: Vec<SessionRecord> = records.iter().map(SessionRecord::summary).collect();
    tables.write_study(&summaries).unwrap();
}

fn contents(folder: &Path) -> Vec<(String, Vec<u8>)> {
    let relative = |path: &Path| {
        path.strip_prefix(folder)
            .unwrap()
            .to_string_lossy()
            .into_owned()
    };
    files::list(folder)
        .unwrap()
        .iter()
        .map(|path| (relative(path), fs::read(path).unwrap()))
        .collect()
}

fn column<'a>(text: &'a str, name: &str) -> Vec<&'a str> {
    let mut lines = text.lines();
    let index = lines
        .next()
        .unwrap()
        .split('\t')
        .position(|column| column == name)
        .unwrap();
    lines
        .map(|line| line.split('\t').nth(index).unwrap())
        .collect()
}

#[test]
fn tables_are_the_same_bytes_from_the_same_records() {
    let folder = tempfile::tempdir().unwrap();
    let study = create(folder.path(), 18);
    let lock = study.lock().unwrap();
    let mut records = records(&study, &lock, 5);
    write_all(&study, &lock, &records);
    let first = contents(&study.data_folder());
    assert_eq!(first.len(), 7 + 5 * (2 + 1 + 2 * 5));
    fs::remove_dir_all(study.data_folder()).unwrap();
    records.reverse();
    write_all(&study, &lock, &records);
    assert_eq!(contents(&study.data_folder()), first);
    // Whoever reads the data does not learn what a button meant.
    for (name, bytes) in &first {
        let text = String::from_utf8_lossy(bytes);
        for word in ["elasticity", "friction", "ellipsoid"] {
            assert!(!text.contains(word), "{name} has {word}");
        }
    }
}

#[test]
fn participants_and_answers_are_what_was_said() {
    let folder = tempfile::tempdir().unwrap();
    let study = create(folder.path(), 18);
    let lock = study.lock().unwrap();
    let records = records(&study, &lock, 7);
    write_all(&study, &lock, &records);
    let read = |name: &str| fs::read_to_string(study.data_folder().join(name)).unwrap();
    let participants = read("participants.tsv");
    let heading = "participant_id\tslot\tage_band\tvr_before\tsick_before\tstatus";
    assert_eq!(participants.lines().next(), Some(heading));
    let ids = column(&participants, "participant_id");
    assert!(ids.is_sorted() && ids.len() == 7);
    let presence = read("phenotype/presence.tsv");
    let of = |id: &str, name: &str| {
        column(&presence, name)[ids.iter().position(|other| *other == id).unwrap()].to_owned()
    };
    for (index, record) in records.iter().enumerate() {
        let step = 1 + index as u8;
        let id = record.participant.to_string();
        assert_eq!(of(&id, "q1"), step.to_string());
        assert_eq!(of(&id, "q4"), "n/a");
        assert_eq!(of(&id, "presence_n"), "5");
        // Section 3: an answer counts when it is 6 or 7.
        assert_eq!(of(&id, "presence_count"), if step >= 6 { "5" } else { "0" });
        assert_eq!(
            of(&id, "noticed_what"),
            if step > 3 {
                "bounce; other: a b"
            } else {
                "n/a"
            }
        );
        assert_eq!(of(&id, "sick_between"), step.to_string());
    }
    let dictionary: Value = serde_json::from_str(&read("phenotype/presence.json")).unwrap();
    assert_eq!(dictionary["q1"]["Levels"]["7"], "very much");
    for name in presence.lines().next().unwrap().split('\t').skip(1) {
        assert!(dictionary[name]["Description"].is_string(), "{name}");
    }
}

#[test]
fn items_after_each_game_have_columns_of_their_own() {
    let folder = tempfile::tempdir().unwrap();
    let rules = SessionRules {
        items_after_each_game: true,
        ..SessionRules::default()
    };
    let study = create_with(folder.path(), 18, rules).unwrap();
    let lock = study.lock().unwrap();
    write_all(&study, &lock, &records(&study, &lock, 7));
    let presence = fs::read_to_string(study.data_folder().join("phenotype/presence.tsv")).unwrap();
    assert!(!presence.lines().next().unwrap().contains("\tq1\t"));
    for name in ["presence_n_game1", "presence_n_game2"] {
        assert_eq!(column(&presence, name), ["5"; 7]);
    }
    assert_eq!(
        column(&presence, "presence_count_game1")
            .iter()
            .filter(|count| **count == "5")
            .count(),
        2
    );
}

#[test]
fn motion_has_a_cell_for_each_channel() {
    let folder = tempfile::tempdir().unwrap();
    let study = create(folder.path(), 18);
    let lock = study.lock().unwrap();
    let records = records(&study, &lock, 1);
    write_all(&study, &lock, &records);
    let id = &records[0].participant;
    let stem = format!("{id}/ses-01/motion/{id}_ses-01_task-bowling_tracksys-script_run-1");
    let read =
        |end: &str| fs::read_to_string(study.data_folder().join(format!("{stem}_{end}"))).unwrap();
    let motion = read("motion.tsv");
    assert_eq!(motion.lines().count(), 90);
    assert!(motion.lines().all(|line| line.split('\t').count() == 17));
    let first = "0.000000\t0.000000\t1.600000\t4.400000\t0.000000\t0.000000\t0.000000\t1.000000\t1\t0.000000";
    assert!(motion.starts_with(first), "{motion}");
    let lost = format!("1\t{}0", "n/a\t".repeat(7));
    assert!(motion.lines().nth(7).unwrap().ends_with(&lost));
    let channels = read("channels.tsv");
    assert_eq!(channels.lines().count(), 1 + 17);
    let about: Value = serde_json::from_str(&read("motion.json")).unwrap();
    let number = |key: &str| about[key].as_f64().unwrap();
    assert!((number("SamplingFrequencyEffective") - 90.0).abs() < 1e-3);
    assert!((number("RecordingDuration") - 89.0 / 90.0).abs() < 1e-6);
    for kind in ["POS", "ORNT", "LATENCY", "MISC"] {
        let count = channels
            .lines()
            .filter(|line| line.split('\t').nth(2) == Some(kind))
            .count();
        assert_eq!(about[format!("{kind}ChannelCount")], count, "{kind}");
    }
    let events = read("events.tsv");
    assert_eq!(column(&events, "pins_down"), ["n/a", "7", "n/a"]);
    assert_eq!(column(&events, "head_onset"), ["n/a"; 3]);
    assert_eq!(column(&events, "miss_distance"), ["n/a", "n/a", "0.050000"]);
}

#[test]
fn export_has_only_what_was_agreed_to() {
    let folder = tempfile::tempdir().unwrap();
    let study = create(&folder.path().join("study"), 18);
    let lock = study.lock().unwrap();
    let records = records(&study, &lock, 4);
    let [first, silent, still, _] = [0, 1, 2, 3].map(|index| records[index].participant.clone());
    let place = |name: &str| folder.path().join(name);
    let export = |with_motion, format, to: &Path| {
        Export {
            with_motion,
            format,
        }
        .write(&study, &records, to)
    };
    let bids = export(true, Format::Bids, &place("bids")).unwrap();
    assert_eq!(
        (bids.left_out, bids.without_motion),
        (vec![silent.clone()], vec![still.clone()])
    );
    let names = |folder: &str| -> Vec<String> {
        contents(&place(folder))
            .into_iter()
            .map(|(name, _)| name)
            .collect()
    };
    for (name, bytes) in contents(&place("bids")) {
        assert!(
            !name.contains(silent.label())
                && !String::from_utf8_lossy(&bytes).contains(silent.label()),
            "{name}"
        );
        assert!(
            !(name.contains(still.label()) && name.contains("motion")),
            "{name}"
        );
    }
    assert!(
        names("bids")
            .iter()
            .any(|name| name.contains(still.label()) && name.contains("/beh/"))
    );
    assert!(
        names("bids")
            .iter()
            .any(|name| name.contains(first.label()) && name.ends_with("_motion.tsv"))
    );
    let none = export(false, Format::Bids, &place("none")).unwrap();
    assert_eq!(none.without_motion.len(), 3);
    assert!(names("none").iter().all(|name| !name.contains("motion")));
    export(true, Format::Csv, &place("csv")).unwrap();
    assert_eq!(names("csv").len(), 4 + 2 * 2);
    let events = fs::read_to_string(place("csv/events.csv")).unwrap();
    assert_eq!(events.lines().count(), 1 + 3 * 2 * 3);
    assert!(events.starts_with("participant_id,session_id,run,game,onset,"));
    let answers = fs::read_to_string(place("csv/presence.csv")).unwrap();
    assert!(
        answers.contains(",NA,") && answers.contains("\"fine, \"\"really\"\"\""),
        "{answers}"
    );
    let error = export(true, Format::Csv, &place("csv"))
        .unwrap_err()
        .to_string();
    assert!(error.contains("is not empty"), "{error}");
    let error = export(true, Format::Csv, &place("study/data/copy"))
        .unwrap_err()
        .to_string();
    assert!(error.contains("outside it"), "{error}");
}

#[test]
fn erase_takes_a_participant_out_of_every_table() {
    let folder = tempfile::tempdir().unwrap();
    let study = create(folder.path(), 18);
    let lock = study.lock().unwrap();
    let mut records = records(&study, &lock, 3);
    write_all(&study, &lock, &records);
    let gone = records.remove(1);
    study
        .erase(&lock, &gone.participant, "x", "2026-11-23")
        .unwrap();
    let after = contents(&study.data_folder());
    // Rebuilt from the other records, the folder is the same but for the number of sessions in the README.
    write_all(&study, &lock, &records);
    let rebuilt = contents(&study.data_folder());
    for ((name, bytes), (other, again)) in after.iter().zip(&rebuilt) {
        assert_eq!(name, other);
        assert!(bytes == again || name == "README.md", "{name}");
    }
}
