//! A whole game at the desk as somebody plays it who has just started the program: ten frames by mouse and keys, to the final score.

use std::path::Path;

use bowling_app::journal::Entry;
use game::{Button, EventKind, Phase};

use super::{Person, SCREEN, ended, entry, open_window};
use crate::shared::screen::Screen;
use crate::support;

/// A hall in which nobody waits long: the balls lie beside the foul line, the machine works at once. Lane, balls, pins and rules are the
/// alley's.
const QUICK: [&str; 12] = [
    "start.z_m=1.6",
    "rack.x_m=0.7",
    "rack.z_m=1.1",
    "rules.end_after_headpin_s=3.0",
    "rules.end_after_foul_line_s=12.0",
    "pinsetter.pause_s=0.05",
    "pinsetter.lift_s=0.2",
    "pinsetter.bar_drop_s=0.1",
    "pinsetter.sweep_s=0.2",
    "pinsetter.set_s=0.2",
    "pinsetter.ball_return_s=0.1",
    "pinsetter.ball_lift_s=0.1",
];

/// Score of a game of ten frames after the pins of its deliveries, by the rule book: a strike counts ten and the next two, a spare ten
/// and the next one; the tenth frame counts its own balls alone.
fn score(pins: &[u32]) -> u32 {
    let (mut total, mut ball) = (0, 0);
    for _ in 0..10 {
        let counted = match pins[ball..] {
            [10, ..] => 3,
            [first, second, ..] if first + second == 10 => 3,
            _ => 2,
        };
        total += pins[ball..ball + counted].iter().sum::<u32>();
        ball += if pins[ball] == 10 { 1 } else { 2 };
    }
    total
}

/// What fell in each delivery of the first game in a journal, as its events tell; nothing for a foul.
fn fallen(events: &[EventKind]) -> Vec<u32> {
    let mut pins = Vec::new();
    let mut is_foul = false;
    for event in events {
        match event {
            EventKind::ThrowStarted { .. } => is_foul = false,
            EventKind::Foul => is_foul = true,
            EventKind::Settled { fallen, .. } => {
                pins.push(if is_foul { 0 } else { fallen.len() as u32 });
            }
            _ => {}
        }
    }
    pins
}

/// Every event of a recording's journal, and its last line.
fn journal(recording: &Path) -> (Vec<EventKind>, Entry) {
    let text = std::fs::read_to_string(recording.join("journal.jsonl")).expect("a journal");
    let entries: Vec<Entry> = text.lines().map(entry).collect();
    let events = entries.iter().filter_map(|entry| match entry {
        Entry::Event(event) => {
            let event: game::Event = serde_json::from_value(event.clone()).expect("an event");
            Some(event.kind)
        }
        _ => None,
    });
    let events = events.collect();
    (events, entries[entries.len() - 1].clone())
}

#[test]
fn scores_are_those_of_the_rule_book() {
    assert_eq!(score(&[10; 12]), 300);
    assert_eq!(score(&[5; 21]), 150);
    assert_eq!(score(&[[9, 0]; 10].concat()), 90);
    let mixed = [10, 7, 3, 9, 0, 10, 0, 8, 8, 2, 0, 6, 10, 10, 10, 8, 1];
    assert_eq!(score(&mixed), 167);
}

#[test]
fn a_person_bowls_a_whole_game_from_a_cold_start_to_the_final_score() {
    let folder = support::fresh_folder("window-game");
    let screen = Screen::open(SCREEN);
    let recording = folder.join("recording");
    let mut arguments = vec!["--scene", "test"];
    for setting in QUICK {
        arguments.extend(["--set", setting]);
    }
    let program = open_window(&screen, &recording, &arguments);
    let mut person = Person::before(screen, &recording);
    for (key, button) in [("1", Button::Red), ("2", Button::Blue)] {
        if button == Button::Blue {
            // The other version is chosen after the first game is over, without a question.
            person.play_to_the_end(&folder);
        }
        person.screen.act(&["key", key]);
        person.eyes.look_for("the game to begin", |game, seen| {
            let is_it = seen.contains(&EventKind::GameStarted { button });
            (is_it && game.phase() == Phase::Ready).then_some(())
        });
    }
    person.screen.act(&["key", "Escape"]);
    let output = ended(program);

    let (events, end) = journal(&recording);
    let pins = fallen(&events);
    println!("pins: {pins:?}");
    let expected = score(&pins);
    let told = events.iter().find_map(|kind| match kind {
        EventKind::GameOver { button, total } => Some((*button, *total)),
        _ => None,
    });
    assert_eq!(told, Some((Button::Red, expected)), "{pins:?}");
    let Entry::End(end) = end else {
        panic!("the journal ends with {end:?}");
    };
    assert_eq!((end.red, end.blue), (Some(expected), Some(0)));
    assert!(!end.complete, "a game under Blue has only begun");
    assert!(
        pins.iter().sum::<u32>() > 20,
        "hardly a pin was hit: {pins:?}"
    );
    let table = std::fs::read_to_string(recording.join("red-score.tsv")).expect("a sheet");
    assert_eq!(table.lines().count(), 11, "{table}");
    assert!(
        table.trim_end().ends_with(&format!("\t{expected}")),
        "{table}"
    );
    assert!(output.contains("State hash"), "{output}");
    let replay = support::bowling(&["replay", recording.to_str().expect("a plain path")]);
    let said = String::from_utf8_lossy(&replay.stderr);
    assert!(replay.status.success(), "{said}");
}
