use serde_json::json;

use super::{ask, near, sphere, spheres};
use crate::support::bowling;

#[test]
fn a_bad_line_is_answered_in_its_place() {
    let cases: [(&str, &[&str]); 20] = [
        ("", &["empty"]),
        ("   ", &["empty"]),
        ("{\"a\":", &["not JSON", "column"]),
        ("7", &["object", "a number"]),
        ("{}", &["no a"]),
        (r#"{"a":{"shape":"sphere","radius":1}}"#, &["no b"]),
        (
            r#"{"a":{"shape":"sphere","radius":1},"b":{"shape":"sphere","radius":1},"c":1}"#,
            &["\"c\""],
        ),
        (r#"{"a":3,"b":3}"#, &["a: ", "a number"]),
        (
            r#"{"a":{"radius":1},"b":{}}"#,
            &["a: ", "shape", "ellipsoid"],
        ),
        (
            r#"{"a":{"shape":"torus"},"b":{}}"#,
            &["\"torus\"", "half_space"],
        ),
        (r#"{"a":{"shape":"sphere"},"b":{}}"#, &["sphere", "radius"]),
        (
            r#"{"a":{"shape":"sphere","radius":1,"colour":"red"},"b":{}}"#,
            &["\"colour\"", "position"],
        ),
        (
            r#"{"a":{"shape":"sphere","radius":"1"},"b":{}}"#,
            &["radius", "a text"],
        ),
        (
            r#"{"a":{"shape":"sphere","radius":-1},"b":{}}"#,
            &["sphere", "radius", "-1"],
        ),
        (
            r#"{"a":{"shape":"sphere","radius":NaN},"b":{}}"#,
            &["not JSON", "column 33"],
        ),
        (
            r#"{"a":{"shape":"sphere","radius":1e999},"b":{}}"#,
            &["out of range"],
        ),
        (
            r#"{"a":{"shape":"box","half_extents":[1,2]},"b":{}}"#,
            &["half_extents", "three", "2 of them"],
        ),
        (
            r#"{"a":{"shape":"sphere","radius":1,"rotation":[0,0,0,0]},"b":{}}"#,
            &["rotation", "zero"],
        ),
        (r#"{"a":{"shape":"cloud"},"b":{}}"#, &["points", "file"]),
        (
            r#"{"a":{"shape":"half_space","normal":[0,0,0]},"b":{}}"#,
            &["normal"],
        ),
    ];
    let mut input = String::new();
    for (line, _) in &cases {
        input += &format!("{line}\n{}\n", spheres(2.0));
    }
    let said = ask(&[], input);
    assert_eq!(said.code, Some(1), "{}", said.error);
    assert_eq!(said.lines.len(), 2 * cases.len());
    for (k, (line, words)) in cases.iter().enumerate() {
        let answers = &said.values()[2 * k..][..2];
        assert_eq!(answers[0]["line"], json!(2 * k + 1), "{line}");
        let error = answers[0]["error"].as_str().expect("a sentence");
        for word in *words {
            assert!(error.contains(word), "no {word:?} in {error:?} for {line}");
        }
        near(&answers[1]["gap"], 1.25);
    }
    assert!(
        said.error.contains("20 of 40 lines") && said.error.contains("line 1"),
        "{}",
        said.error
    );
}

#[test]
fn answers_without_a_number_are_refused() {
    let floor = json!({"shape": "half_space", "normal": [0.0, 1.0, 0.0]});
    let far = json!({"shape": "sphere", "radius": 1.0, "position": [1e300, 1e300, 1e300]});
    let lines = format!(
        "{}\n{}\n",
        json!({"a": floor, "b": floor}),
        json!({"a": sphere(1e300, -1e308), "b": far}),
    );
    let said = ask(&[], lines);
    assert_eq!(said.code, Some(1));
    assert!(
        said.lines[0].contains("two half-spaces"),
        "{}",
        said.lines[0]
    );
    for line in &said.lines {
        assert!(!line.contains("NaN") && !line.contains("inf,"), "{line}");
    }
}

#[test]
fn arguments_out_of_range_end_with_code_2() {
    let cases: [(&[&str], &str); 6] = [
        (&["--cap", "0"], "--cap"),
        (&["--cap", "-1"], "--cap"),
        (&["--tolerance", "0"], "positive"),
        (&["--tolerance", "-1"], "positive"),
        (&["--tolerance", "nan"], "positive"),
        (&["--question", "why"], "apart"),
    ];
    for (arguments, word) in cases {
        let output = bowling(&[&["query"], arguments].concat());
        assert_eq!(output.status.code(), Some(2), "{arguments:?}");
        let text = String::from_utf8_lossy(&output.stderr).into_owned();
        assert!(text.contains(word), "{text}");
    }
}

#[test]
fn a_missing_file_is_named() {
    for name in ["no/such.jsonl", "tests"] {
        let output = bowling(&["query", name]);
        assert_eq!(output.status.code(), Some(1));
        let text = String::from_utf8_lossy(&output.stderr).into_owned();
        assert!(
            text.contains(name) && text.contains("cannot be read"),
            "{text}"
        );
    }
}
