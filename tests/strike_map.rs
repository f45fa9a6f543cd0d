use std::fs;
use std::path::Path;
use std::process::Output;

use crate::support::{bowling, fresh_folder};

/// A map of two offsets by three angles, four throws a cell, short.
const SMALL: [&str; 12] = [
    "strike-map",
    "--offsets",
    "0.05:0.07:0.02",
    "--angles",
    "0:6:3",
    "--shots",
    "4",
    "--duration",
    "1.5",
    "--start",
    "1",
    "--seed",
];

fn map(folder: &Path, more: &[&str]) -> Output {
    let name = folder.display().to_string();
    bowling(&[&SMALL[..], &["3", "--out", &name], more].concat())
}

fn read(folder: &Path, name: &str) -> String {
    fs::read_to_string(folder.join(name)).expect("the file is there")
}

#[test]
fn a_map_has_a_line_and_a_field_for_every_cell() {
    let folder = fresh_folder("strike-map").join("new/deep");
    let output = map(&folder, &[]);
    let said = String::from_utf8_lossy(&output.stdout);
    assert!(
        output.status.success(),
        "{}",
        String::from_utf8_lossy(&output.stderr)
    );
    assert!(
        said.contains("strike-map.csv") && said.contains("most strikes: "),
        "{said}"
    );
    let text = read(&folder, "strike-map.csv");
    let mut lines = text.lines();
    let names: Vec<&str> = lines.next().expect("a head").split(',').collect();
    let mut places = Vec::new();
    for line in lines {
        let cells: Vec<&str> = line.split(',').collect();
        assert_eq!((cells.len(), cells[0]), (names.len(), "guarded"), "{line}");
        let number = |name| {
            let column = names.iter().position(|other| *other == name).expect(name);
            cells[column].parse::<f64>().expect(line)
        };
        places.push((number("entry_offset_m"), number("entry_angle_deg")));
        assert_eq!(number("throws"), 4.0);
        assert!((number("strike_share") - number("strikes") / 4.0).abs() < 1e-6);
        assert!(number("strike_share_low") <= number("strike_share"));
        assert!(number("strike_share_high") >= number("strike_share"));
        // Wilson: four throws never tell a share to less than 49 points.
        assert!(
            number("strike_share_high") - number("strike_share_low") > 0.48,
            "{line}"
        );
        assert!(number("mean_pins_low") <= number("mean_pins") && number("mean_pins") > 4.0);
    }
    let expected = [0.0, 3.0, 6.0]
        .map(|angle| [(0.05, angle), (0.07, angle)])
        .concat();
    assert_eq!(places, expected);
    let picture = read(&folder, "strike-map.svg");
    // Two fields, the ground, and the published points in both.
    assert_eq!(picture.matches("<rect ").count(), 2 * 6 + 1);
    assert_eq!(picture.matches("<circle ").count(), 4);
    assert!(picture.starts_with("<svg ") && picture.ends_with("</svg>\n"));
    assert_eq!(fs::read_dir(&folder).expect("there").count(), 2);
}

#[test]
fn a_map_does_not_depend_on_the_number_of_threads_but_on_the_law() {
    let folder = fresh_folder("strike-map-threads");
    let run = |name: &str, more: &[&str]| {
        let folder = folder.join(name);
        assert!(map(&folder, more).status.success());
        (
            read(&folder, "strike-map.csv"),
            read(&folder, "strike-map.svg"),
        )
    };
    let one = run("one", &["--threads", "1"]);
    assert_eq!(one, run("three", &["--threads", "3"]));
    let coulomb = run("coulomb", &["--model", "coulomb"]);
    assert_ne!(one.0.replace("guarded", "coulomb"), coulomb.0);
}

#[test]
fn what_cannot_be_mapped_ends_with_code_2_and_leaves_nothing() {
    let folder = fresh_folder("strike-map-refused").join("out");
    for (more, words) in [
        (&["--offsets", "0.1:0:0.01"][..], "--offsets"),
        (&["--offsets", "0:0.1"], "FROM:TO:STEP"),
        (&["--offsets", "0:0.4:0.0001"], "at most 400"),
        (&["--angles", "0:1:nan"], "--angles"),
        (&["--angles", "-60:0:1"], "--angles"),
        (&["--angles", "20:24:1", "--start", "3"], "beside the lane"),
        (&["--start", "0.1"], "inside pin 1"),
        (&["--shots", "0"], "--shots"),
        (&["--jitter-speed", "2"], "--jitter-speed"),
    ] {
        let name = folder.display().to_string();
        let output = bowling(&[&["strike-map", "--out", &name], more].concat());
        let text = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(2), "{more:?}: {text}");
        assert!(
            text.starts_with("error: ") && text.contains(words),
            "{more:?}: {text}"
        );
        assert!(!folder.exists(), "{more:?}");
    }
}
