use std::process::Output;

use crate::support::bowling;

fn effects(arguments: &[&str]) -> Output {
    bowling(&[&["effects", "--throws", "1"], arguments].concat())
}

/// An effect's line: name, state in the plan, numbers.
type Row = (String, String, Vec<f64>);

/// The lines of the effects, and those of the plan.
fn table(arguments: &[&str]) -> (Vec<Row>, Vec<String>) {
    let output = effects(arguments);
    let error = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{arguments:?}: {error}");
    let text = String::from_utf8(output.stdout).expect("UTF-8");
    let parts: Vec<&str> = text.split("\n\n").collect();
    assert_eq!(parts.len(), 3, "{text}");
    let plan = parts[0].lines().map(str::to_owned).collect();
    let row = |line: &str| {
        let words: Vec<&str> = line.split_whitespace().collect();
        let numbers = words[2..].iter().map(|word| word.parse().expect(line));
        (words[0].to_owned(), words[1].to_owned(), numbers.collect())
    };
    (parts[1].lines().skip(2).map(row).collect(), plan)
}

#[test]
fn a_scene_shows_its_plan_and_what_each_effect_costs() {
    let (rows, plan) = table(&[]);
    let names: Vec<&str> = rows.iter().map(|row| row.0.as_str()).collect();
    assert_eq!(names.len(), 11);
    assert!(plan[0].starts_with("Scene alley: "), "{plan:?}");
    for (name, state, numbers) in &rows {
        let [acts, with, without, share, throw, other] = numbers[..] else {
            panic!("{name}: {numbers:?}");
        };
        let is_planned = plan.iter().any(|line| line.contains(name.as_str()));
        let extra = ["oil", "rolling_resistance", "drag"].contains(&name.as_str());
        assert_eq!(state, if extra { "no" } else { "yes" }, "{name}");
        assert_eq!(is_planned, !extra, "{name}");
        assert!(acts > 0.0, "{name} acts {acts} times");
        assert!(
            with > 0.0 && without > 0.0 && throw > 0.0 && other > 0.0,
            "{name}"
        );
        assert!(
            (share - 1e2 * (1.0 - without / with)).abs() < 0.2,
            "{name}: {share}"
        );
    }
}

#[test]
fn what_nothing_calls_for_is_not_in_the_plan() {
    let smooth = [
        "--set",
        "physics.gravity_mps2=0",
        "--set",
        "objects.friction_rate=0",
    ];
    let (rows, plan) = table(&[&smooth[..], &["--set", "physics.air_density_kgpm3=0"]].concat());
    for (name, state, numbers) in &rows {
        let uncalled = ["gravity", "friction"].contains(&name.as_str());
        assert_eq!(state == "uncalled", uncalled, "{name}: {state}");
        if uncalled || name == "drag" || name == "oil" {
            assert_eq!(numbers[0], 0.0, "{name} acts");
            assert!(
                !plan.iter().any(|line| line.contains(name.as_str())),
                "{name}"
            );
        }
    }
}

#[test]
fn an_effect_that_there_is_not_is_named() {
    let output = effects(&["--set", "physics.effects=[\"magnetism\"]"]);
    let text = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(1), "{text}");
    assert!(
        text.contains("`magnetism` does not fit; give one of"),
        "{text}"
    );
    let output = effects(&["--scene", "beach"]);
    let text = String::from_utf8_lossy(&output.stderr);
    assert!(
        output.status.code() == Some(1) && text.contains("there are: alley"),
        "{text}"
    );
}
