//! Journals: written by the real thread into real files, read back, and damaged on purpose.
#![expect(clippy::unwrap_used, reason = "a test that cannot go on fails")]

use std::fs;
use std::path::Path;
use std::time::{Duration, Instant};

use experiment::journal::{Appender, LineProblem, Lines, Torn};
use experiment::random::SplitMix64;
use serde::ser::Error;
use serde::{Serialize, Serializer};
use serde_json::{Value, json};

fn header() -> Value {
    json!({ "header": { "schema": 3, "program": "0.1.0" } })
}

/// A journal that has its header.
fn begun(path: &Path) -> Appender<Value> {
    let mut journal = Appender::create(path).unwrap();
    journal.append(header()).unwrap();
    journal
}

/// A journal of a header and `count` lines.
fn written(path: &Path, count: u64) -> Vec<u8> {
    let mut journal = begun(path);
    for number in 0..count {
        journal
            .append(json!({ "input": [number, 1.0 / 3.0] }))
            .unwrap();
    }
    drop(journal);
    fs::read(path).unwrap()
}

fn read(bytes: &[u8]) -> (Vec<String>, Option<Torn>, Option<(usize, LineProblem)>) {
    let mut lines = Lines::new(bytes);
    let mut contents = Vec::new();
    loop {
        match lines.next_content() {
            Ok(Some(content)) => contents.push(content),
            Ok(None) => return (contents, lines.torn(), None),
            Err(problem) => return (contents, None, Some((lines.number(), problem))),
        }
    }
}

#[test]
fn what_is_appended_is_read_back_in_its_order() {
    let folder = tempfile::tempdir().unwrap();
    let bytes = written(&folder.path().join("a.jsonl"), 1000);
    let (contents, torn, problem) = read(&bytes);
    assert_eq!((contents.len(), torn, problem), (1001, None, None));
    assert_eq!(contents[0], header().to_string());
    assert_eq!(contents[1000], "{\"input\":[999,0.3333333333333333]}");
}

#[test]
fn sync_has_everything_on_disk_while_the_journal_is_open() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.jsonl");
    let mut journal = begun(&path);
    journal.append(json!({ "note": 1 })).unwrap();
    journal.sync().unwrap();
    assert_eq!(read(&fs::read(&path).unwrap()).0.len(), 2);
    drop(journal);
}

#[test]
fn a_journal_cut_anywhere_keeps_its_whole_lines_and_names_the_torn_one() {
    let folder = tempfile::tempdir().unwrap();
    let bytes = written(&folder.path().join("a.jsonl"), 20);
    for length in "{\"line\":".len()..bytes.len() {
        let whole = bytes[..length]
            .iter()
            .filter(|byte| **byte == b'\n')
            .count();
        let (contents, torn, problem) = read(&bytes[..length]);
        assert_eq!((contents.len(), problem), (whole, None), "cut at {length}");
        let begun = length
            - bytes[..length]
                .iter()
                .rposition(|b| *b == b'\n')
                .map_or(0, |at| at + 1);
        let expected = (begun > 0).then_some(Torn {
            line: whole + 1,
            bytes: begun,
        });
        assert_eq!(torn, expected, "cut at {length}");
    }
}

#[test]
fn a_flipped_bit_is_found_on_its_line_or_the_next() {
    let folder = tempfile::tempdir().unwrap();
    let bytes = written(&folder.path().join("a.jsonl"), 50);
    let seed = 7;
    let mut random = SplitMix64::new(seed);
    for _ in 0..2000 {
        let at = (random.next_u64() % bytes.len() as u64) as usize;
        let mut damaged = bytes.clone();
        damaged[at] ^= 1 << (random.next_u64() % 8);
        let line = 1 + bytes[..at].iter().filter(|byte| **byte == b'\n').count();
        let (contents, torn, problem) = read(&damaged);
        let found = problem
            .map(|(number, _)| number)
            .or(torn.map(|torn| torn.line));
        // The last line end lost is a torn line; another one joins two lines.
        let found = found.unwrap_or_else(|| panic!("seed {seed}: byte {at} unnoticed"));
        assert_eq!(found, line, "seed {seed}: byte {at}");
        assert_eq!(contents.len(), line - 1, "seed {seed}: byte {at}");
    }
}

#[test]
fn a_missing_line_a_foreign_file_and_another_version_are_named() {
    let folder = tempfile::tempdir().unwrap();
    let bytes = written(&folder.path().join("a.jsonl"), 5);
    let text = String::from_utf8(bytes).unwrap();
    let mut lines: Vec<&str> = text.lines().collect();
    lines.remove(2);
    let gap = lines.join("\n") + "\n";
    let says = "4".to_owned();
    let expected = LineProblem::OutOfOrder { says };
    assert_eq!(read(gap.as_bytes()).2, Some((3, expected)));
    let foreign = b"participant_id\tage\n";
    assert_eq!(read(foreign).2, Some((1, LineProblem::Foreign)));
    assert_eq!(read(b"no line end").2, Some((1, LineProblem::Foreign)));
    assert_eq!(read(&[0xff, 0xfe, 0]).2, Some((1, LineProblem::NoText)));
    let newer =
        "{\"line\":1,\"check\":\"00000000\",\"header\":{\"schema\":9,\"program\":\"2.0\"}}\n";
    let expected = LineProblem::Schema {
        schema: 9,
        program: "2.0".to_owned(),
    };
    assert_eq!(read(newer.as_bytes()).2, Some((1, expected)));
}

#[test]
fn a_line_reaches_the_system_though_nobody_syncs() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.jsonl");
    let mut journal = begun(&path);
    let since = Instant::now();
    for lines in 2..=21 {
        journal.append(json!({ "note": lines })).unwrap();
        while read(&fs::read(&path).unwrap()).0.len() < lines {
            assert!(since.elapsed() < Duration::from_secs(20), "line {lines}");
            std::thread::yield_now();
        }
    }
    // A sync a line at most, one a second, would take twenty seconds.
    assert!(since.elapsed() < Duration::from_secs(10));
}

/// An entry that cannot be put into words, or at which the program is at fault.
enum Faulty {
    No,
    Unwritable,
    Panics,
}

impl Serialize for Faulty {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        match self {
            Self::No => header().serialize(serializer),
            Self::Unwritable => Err(S::Error::custom("no words")),
            Self::Panics => panic!("this is part of the test"),
        }
    }
}

#[test]
fn a_fault_in_an_entry_is_reported_and_loses_no_line_before_it() {
    let folder = tempfile::tempdir().unwrap();
    for (name, faulty, said) in [
        ("a.jsonl", Faulty::Unwritable, "no words"),
        ("b.jsonl", Faulty::Panics, "fault of the program"),
    ] {
        let path = folder.path().join(name);
        let mut journal = Appender::create(&path).unwrap();
        journal.append(Faulty::No).unwrap();
        journal.append(faulty).unwrap();
        let error = journal.sync().unwrap_err().to_string();
        assert!(error.contains(name) && error.contains(said), "{error}");
        assert!(journal.append(Faulty::No).is_err());
        drop(journal);
        assert_eq!(read(&fs::read(&path).unwrap()).0.len(), 1);
    }
}

#[cfg(unix)]
#[test]
fn a_journal_that_somebody_removes_is_missed() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.jsonl");
    let mut journal = begun(&path);
    journal.sync().unwrap();
    fs::remove_file(&path).unwrap();
    journal.append(json!({ "note": 1 })).unwrap();
    let error = journal.sync().unwrap_err().to_string();
    assert!(
        error.contains("a.jsonl") && error.contains("removed"),
        "{error}"
    );
    assert!(journal.append(json!({ "note": 2 })).is_err());
}

#[test]
fn create_refuses_a_file_that_is_there_and_leaves_it_alone() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.jsonl");
    fs::write(&path, "mine").unwrap();
    let error = Appender::<Value>::create(&path).unwrap_err();
    assert!(error.to_string().contains("a.jsonl"), "{error}");
    assert_eq!(fs::read(&path).unwrap(), b"mine");
}
