use std::process::Output;

use crate::support::bowling;

fn effects(arguments: &[&str]) -> Output {
    bowling(&[&["effects", "--throws", "1"], arguments].concat())
}

/// An effect's line: name, state in the plan, numbers.
type Row = (String, String, Vec<f64>);

/// The lines of the effects, and those of the plan.
fn table(arguments: &[&str]) -> (Vec<Row>, Vec<String>) {
    let output = effects(&[&["--of", "physics"], arguments].concat());
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

/// Lines of `--of pictures`: key, words after it.
fn pictures(arguments: &[&str]) -> Vec<(String, Vec<String>)> {
    let output = effects(&[&["--of", "pictures"], arguments].concat());
    let error = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{error}");
    let text = String::from_utf8(output.stdout).expect("UTF-8");
    let lines = text.lines().skip_while(|line| !line.starts_with("shown"));
    lines
        .skip(1)
        .map(|line| {
            let mut words = line.split_whitespace().map(str::to_owned);
            (words.next().expect("a key"), words.collect())
        })
        .collect()
}

#[test]
fn what_is_seen_has_its_time_with_and_without_its_triangles_and_its_passes() {
    // Faces of one colour would need no pass but one, whatever is asked for.
    let rows = pictures(&["--scene", "test", "--set", "shows.materials=true"]);
    let names: Vec<&str> = rows.iter().map(|row| row.0.as_str()).collect();
    let all = [
        "shadows",
        "reflection",
        "ambient_occlusion",
        "neighbouring_lanes",
        "furnishings",
        "materials",
        "smooth_edges",
        "low_polygon",
    ];
    assert_eq!(names, all);
    for (name, words) in &rows {
        let is_on = ["low_polygon", "materials"].contains(&name.as_str());
        assert_eq!(words[0], if is_on { "yes" } else { "no" }, "{name}");
        let number = |word: usize| words[word].parse::<f64>().expect(name);
        let (with, without, share) = (number(1), number(2), number(3));
        assert!(with > 0.0 && without > 0.0, "{name}: {with} {without}");
        assert!(
            (share - 1e2 * (1.0 - without / with)).abs() < 1.0,
            "{name}: {share}"
        );
        let triangles = number(4);
        match name.as_str() {
            // The hall of the test scene is too narrow for neighbours.
            "furnishings" => assert!(triangles > 0.0, "{triangles}"),
            "low_polygon" => assert!(triangles < -10_000.0, "{triangles}"),
            // Without textures stripes and holes are meshes.
            "materials" => assert!((-1000.0..0.0).contains(&triangles), "{triangles}"),
            _ => assert_eq!(triangles, 0.0, "{name}"),
        }
        let passes = words[5..].join(" ");
        match name.as_str() {
            "shadows" => assert!(passes.contains("+shadow"), "{passes}"),
            "neighbouring_lanes" | "furnishings" | "smooth_edges" | "low_polygon" => {
                assert_eq!(passes, "", "{name}")
            }
            _ => {}
        }
    }
}

#[test]
fn sound_costs_nothing_where_a_scene_shows_none() {
    let line = |scene: &str| {
        let output = effects(&["--of", "sound", "--scene", scene]);
        let text = String::from_utf8(output.stdout).expect("UTF-8");
        let line = text.lines().find(|line| line.starts_with("sound "));
        let words = line.expect("its line").split_whitespace();
        words.map(str::to_owned).collect::<Vec<_>>()
    };
    let alley = line("alley");
    assert_eq!(alley[1], "yes");
    let number = |word: usize| alley[word].parse::<f64>().expect("a number");
    let (with, without, blows) = (number(2), number(3), number(4));
    assert!(blows >= 10.0, "{blows} blows in a frame of bowling");
    assert!(
        with > 20.0 * without.max(0.001),
        "{with} with, {without} without"
    );
    assert_eq!(line("test")[1], "no");
}
