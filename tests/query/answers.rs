use serde_json::{Value, json};

use super::{ask, near, number, sphere, spheres, vector};

#[test]
fn a_gap_comes_with_bounds_normal_and_point() {
    let answer = ask(&[], spheres(2.0)).answer();
    near(&answer["gap"], 1.25);
    assert!(number(&answer["lower"]) <= 1.25 + 1e-15 && number(&answer["upper"]) >= 1.25 - 1e-15);
    assert_eq!(vector(&answer["normal"]), [1.0, 0.0, 0.0]);
    // Half way between x = 0.5 and x = 1.75.
    near(&answer["point"][0], 1.125);
    assert_eq!(answer["capped"], json!(false));
    let keys: Vec<&String> = answer.as_object().expect("an object").keys().collect();
    let wanted = [
        "capped",
        "gap",
        "iterations",
        "lower",
        "normal",
        "point",
        "upper",
    ];
    assert_eq!(keys, wanted, "in the order in which the parser sorts them");
    near(&ask(&[], spheres(0.7)).answer()["gap"], -0.05);
}

#[test]
fn numbers_have_seventeen_digits() {
    let line = &ask(&[], spheres(0.75 + 0.1)).lines[0];
    let gap = line
        .split_once("\"gap\":")
        .and_then(|(_, rest)| rest.split_once(','))
        .expect("a gap is first")
        .0;
    let digits = gap.trim_start_matches(['0', '.', '-']);
    let digits = digits.split('e').next().expect("a mantissa");
    assert_eq!(digits.replace('.', "").len(), 17, "{gap}");
}

/// Every shape above a slanted plane. The distance is the plane's from the origin less the shape's support height, by
/// formulas on paper: half-space normal n = (0.36, 0.48, 0.8), so the shape's height is the one along -n.
#[test]
fn every_shape_has_its_sizes_and_its_axis() {
    let across = 0.36f64.hypot(0.8);
    let shapes = [
        (json!({"shape": "sphere", "radius": 0.3}), 0.3),
        (
            json!({"shape": "ellipsoid", "semi_axes": [0.5, 0.25, 0.125]}),
            (0.18f64.powi(2) + 0.12f64.powi(2) + 0.1f64.powi(2)).sqrt(),
        ),
        (
            json!({"shape": "capsule", "radius": 0.1, "half_height": 0.5}),
            0.1 + 0.24,
        ),
        (
            json!({"shape": "cylinder", "radius": 0.2, "half_height": 0.5}),
            0.2 * across + 0.24,
        ),
        // The base, at -y, is nearer to the plane below than the apex at +y.
        (
            json!({"shape": "cone", "radius": 0.2, "half_height": 0.5}),
            0.2 * across + 0.24,
        ),
        (
            json!({"shape": "frustum", "radius_bottom": 0.1, "radius_top": 0.4, "half_height": 0.05}),
            0.4 * across - 0.024,
        ),
        (
            json!({"shape": "box", "half_extents": [0.1, 0.2, 0.3]}),
            0.036 + 0.096 + 0.24,
        ),
        (
            json!({"shape": "cloud", "points": [[0.0, 1.0, 0.0], [0.0, -0.5, 0.0], [0.1, 0.0, 0.1]]}),
            0.24,
        ),
        (
            json!({"shape": "truncated_ellipsoid", "semi_axes": [0.5, 0.5, 0.5], "cut": -0.1}),
            {
                // The rim: its radius across the axis, and the cut.
                (0.25f64 - 0.01).sqrt() * across + 0.048
            },
        ),
    ];
    let plane =
        json!({"shape": "half_space", "normal": [3.6, 4.8, 8.0], "position": [-0.36, -0.48, -0.8]});
    for (shape, height) in shapes {
        let line = json!({"a": plane, "b": shape}).to_string();
        let answer = ask(&[], line).answer();
        near(&answer["gap"], 1.0 - height);
        for (got, wanted) in vector(&answer["normal"]).iter().zip([0.36, 0.48, 0.8]) {
            assert!((got - wanted).abs() < 1e-12, "{shape}: {answer}");
        }
    }
}

#[test]
fn a_cone_points_upwards() {
    let ceiling =
        json!({"shape": "half_space", "normal": [0.0, -1.0, 0.0], "position": [0.0, 1.0, 0.0]});
    let cone = json!({"shape": "cone", "radius": 0.2, "half_height": 0.5});
    let answer = ask(&[], json!({"a": cone, "b": ceiling}).to_string()).answer();
    near(&answer["gap"], 0.5);
    near(&answer["point"][1], 0.75);
    near(&answer["point"][0], 0.0);
}

#[test]
fn a_rotation_need_not_be_a_unit_quaternion() {
    let bar = |rotation: Value| {
        let capsule =
            json!({"shape": "capsule", "radius": 0.1, "half_height": 0.5, "rotation": rotation});
        let line = json!({"a": capsule, "b": sphere(0.2, 1.0)});
        let answer = ask(&[], line.to_string()).answer();
        (number(&answer["gap"]), vector(&answer["normal"])[0])
    };
    // A quarter turn about z lays the capsule along x.
    for length in [1.0, 3.0, 1e-200, 1e200] {
        let part = length * std::f64::consts::FRAC_1_SQRT_2;
        let (gap, ahead) = bar(json!([0.0, 0.0, part, part]));
        assert!((gap - 0.2).abs() < 1e-12, "{gap} at length {length}");
        assert!(ahead > 1.0 - 1e-12, "{ahead} at length {length}");
    }
}

#[test]
fn apart_gives_a_normal_and_what_it_proves() {
    let said = ask(
        &["--question", "apart"],
        format!("{}\n{}\n", spheres(2.0), spheres(0.5)),
    );
    assert_eq!(said.code, Some(0));
    let values = said.values();
    assert_eq!(values[0]["apart"], json!(true));
    assert_eq!(vector(&values[0]["normal"]), [1.0, 0.0, 0.0]);
    let proven = number(&values[0]["gap_at_least"]);
    assert!(proven > 0.0 && proven <= 1.25 + 1e-15, "{proven}");
    assert_eq!(
        values[1],
        json!({"apart": false, "normal": null, "gap_at_least": null})
    );
}

#[test]
fn a_contact_has_a_depth() {
    let floor = json!({"shape": "half_space", "normal": [0.0, 1e-200, 0.0]});
    let ball = json!({"shape": "sphere", "radius": 0.1, "position": [1.0, 0.0999, 0.0]});
    let line = json!({"a": floor, "b": ball}).to_string();
    let answer = ask(&["--question", "contact"], line).answer();
    near(&answer["depth"], 1e-4);
    near(&answer["gap"], -1e-4);
    near(&answer["point"][1], -0.5e-4);
    assert_eq!(vector(&answer["normal"]), [0.0, 1.0, 0.0]);
}

#[test]
fn a_contact_has_the_points_of_its_face() {
    let floor = json!({"shape": "half_space", "normal": [0.0, 1.0, 0.0]});
    let crate_ =
        json!({"shape": "box", "half_extents": [0.2, 0.1, 0.3], "position": [1.0, 0.0999, 0.0]});
    let line = json!({"a": floor, "b": crate_}).to_string();
    let answer = ask(&["--question", "contact"], line).answer();
    near(&answer["depth"], 1e-4);
    near(&answer["gap"], -1e-4);
    let points = answer["points"].as_array().expect("a list");
    assert_eq!(points.len(), 4);
    let mut corners: Vec<[i64; 2]> = points
        .iter()
        .map(|p| {
            near(&p["depth"], 1e-4);
            let [x, _, z] = vector(&p["point"]);
            [x, z].map(|v| (v * 1e6).round() as i64)
        })
        .collect();
    corners.sort_unstable();
    let wanted = [
        [800_000, -300_000],
        [800_000, 300_000],
        [1_200_000, -300_000],
        [1_200_000, 300_000],
    ];
    assert_eq!(corners, wanted);
}

#[test]
fn a_cap_is_kept_and_said() {
    let pair = json!({
        "a": {"shape": "ellipsoid", "semi_axes": [1.0, 0.2, 0.5], "rotation": [0.1, 0.3, 0.2, 0.9]},
        "b": {"shape": "ellipsoid", "semi_axes": [0.3, 0.8, 0.5], "position": [1.2, 0.9, 0.4]},
    });
    let capped = ask(&["--cap", "1"], pair.to_string()).answer();
    let free = ask(&[], pair.to_string()).answer();
    assert_eq!(
        (&capped["capped"], &free["capped"]),
        (&json!(true), &json!(false))
    );
    assert!(number(&capped["iterations"]) <= 1.0 && number(&free["iterations"]) > 1.0);
    assert!(number(&capped["lower"]) < number(&free["gap"]));
    assert!(number(&free["gap"]) <= number(&capped["upper"]));
}

#[test]
fn a_tolerance_ends_a_search_early() {
    // Two thin ones: rounder pairs are found in so few normals that none is left to spare.
    let pair = json!({
        "a": {"shape": "ellipsoid", "semi_axes": [1.0, 0.02, 0.5], "rotation": [0.1, 0.3, 0.2, 0.9]},
        "b": {"shape": "ellipsoid", "semi_axes": [0.03, 0.8, 0.5], "position": [0.9, 0.5, 0.3],
              "rotation": [0.3, 0.1, 0.5, 0.8]},
    });
    let free = ask(&[], pair.to_string()).answer();
    let coarse = ask(&["--tolerance", "0.05"], pair.to_string()).answer();
    assert!(number(&coarse["iterations"]) < number(&free["iterations"]));
    assert!(number(&coarse["lower"]) <= number(&free["gap"]));
}
