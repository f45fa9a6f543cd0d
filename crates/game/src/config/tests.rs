use std::path::{Path, PathBuf};

use super::*;

/// The repository's configuration folder.
pub(crate) fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../config")
}

/// The shipped defaults.
pub(crate) fn default_config() -> Config {
    Config::load(&folder(), "alley", None, &[]).unwrap()
}

/// What a layer over the defaults is refused with.
fn refusal(text: &str) -> String {
    let default = Layer::file(&folder().join("default.toml")).unwrap();
    let layer = Layer::text(Path::new("config/blue.toml"), text);
    Config::from_layers(&[default, layer])
        .unwrap_err()
        .to_string()
}

#[test]
fn shipped_conditions_differ_in_friction_alone() {
    let load = |name| Config::load(&folder(), "alley", Some(name), &[]).unwrap();
    let (red, mut blue) = (load("red"), load("blue"));
    assert_eq!(red, default_config());
    assert_eq!(
        (red.objects.friction_rate, blue.objects.friction_rate),
        (0.7, 0.0)
    );
    blue.objects.friction_rate = red.objects.friction_rate;
    assert_eq!(red, blue);
}

#[test]
fn check_finds_recorded_settings_that_no_file_could_hold() {
    let mut config = default_config();
    assert_eq!(config.check(), Ok(()));
    config.objects.elasticity = 7.0;
    let error = config.check().unwrap_err().to_string();
    assert!(error.contains("objects.elasticity"), "{error}");
}

#[test]
fn a_condition_cannot_move_a_wall() {
    let lobby = default_config();
    let mut blue = lobby.clone();
    blue.room.half_width_m += 0.5;
    let conditions = crate::Conditions {
        red: lobby.clone(),
        blue,
        lobby,
    };
    let error = crate::Game::new(conditions, 1).err().unwrap();
    assert_eq!(error, crate::GameError::DifferingCondition("room"));
}

#[test]
fn stronger_layers_win() {
    let default = Layer::file(&folder().join("default.toml")).unwrap();
    let scene = Layer::text(
        Path::new("scene"),
        "[objects]\nelasticity = 0.1\nfriction_rate = 0.1\n[walking]\nspeed_mps = 0.9",
    );
    let condition = Layer::text(
        Path::new("condition"),
        "[objects]\nelasticity = 0.2\nfriction_rate = 0.2",
    );
    let argument = Layer::argument("objects.elasticity=0.3").unwrap();
    let config = Config::from_layers(&[default, scene, condition, argument]).unwrap();
    let objects = &config.objects;
    assert_eq!(
        (
            objects.elasticity,
            objects.friction_rate,
            config.walking.speed_mps
        ),
        (0.3, 0.2, 0.9)
    );
    assert_eq!(objects.shape, ObjectShape::True);
}

#[test]
fn an_unknown_key_is_named_with_file_and_line() {
    let message = refusal("# a comment\n[objects]\nelastcity = 1.0\n");
    assert!(
        message
            .starts_with("config/blue.toml, line 3: key `objects.elastcity`: there is no such key"),
        "{message}"
    );
    assert!(message.contains("`elasticity`"), "{message}");
    let message = refusal("[objcts]\nelasticity = 1.0\n");
    assert!(
        message.starts_with("config/blue.toml, line 1: key `objcts`: there is no such key"),
        "{message}"
    );
}

#[test]
fn a_value_out_of_range_is_named_with_file_and_line() {
    let message = refusal("\n[objects]\nfriction_rate = 1.5\n");
    let expected = "config/blue.toml, line 3: key `objects.friction_rate`: 1.5 is out of range; give a number from 0 to 1";
    assert_eq!(message, expected);
    let message = refusal("[objects]\nelasticity = nan\n");
    assert!(
        message
            .starts_with("config/blue.toml, line 2: key `objects.elasticity`: NaN is out of range"),
        "{message}"
    );
    let message =
        refusal("[[balls]]\ndiameter_m = 0.2\nmass_kg = inf\nrg_m = 0.06\ndrag_area_m2 = 0.02\n");
    assert!(
        message
            .starts_with("config/blue.toml, line 3: key `balls[0].mass_kg`: inf is out of range"),
        "{message}"
    );
}

#[test]
fn a_value_of_the_wrong_type_is_named_with_file_and_line() {
    let message = refusal("[objects]\nshape = \"cube\"\n");
    assert!(
        message.starts_with("config/blue.toml, line 2: key `objects.shape`: `cube` does not fit"),
        "{message}"
    );
    let message = refusal("[objects]\nelasticity = \"high\"\n");
    assert!(
        message.ends_with(
            "line 2: key `objects.elasticity`: the text \"high\" does not fit; give a number"
        ),
        "{message}"
    );
    let message = refusal("[gutter]\nfacets = -3\n");
    assert!(
        message.starts_with(
            "config/blue.toml, line 2: key `gutter.facets`: -3 does not fit; give a whole number"
        ),
        "{message}"
    );
}

#[test]
fn a_missing_key_is_named_with_its_table() {
    let message = refusal("[[balls]]\ndiameter_m = 0.2\nmass_kg = 4.0\n");
    assert!(
        message.starts_with("config/blue.toml, line 1: key `balls[0]`: `rg_m` is missing; add it"),
        "{message}"
    );
}

#[test]
fn text_that_is_no_toml_is_named_with_its_line() {
    let message = refusal("[objects]\nelasticity 0.5\n");
    assert!(
        message.starts_with("config/blue.toml, line 2: is not valid TOML"),
        "{message}"
    );
    assert_eq!(message.lines().count(), 1, "{message}");
}

#[test]
fn relations_between_keys_are_checked() {
    let message = refusal("[hand]\ntrigger_open = 0.7\n");
    assert!(
        message.contains("line 2: key `hand.trigger_open`: must be less than hand.trigger_close"),
        "{message}"
    );
    let message = refusal("[tracking]\nrate_hz = 75\n");
    assert!(
        message.contains("line 2: key `tracking.rate_hz`: must divide physics.step_hz"),
        "{message}"
    );
}

#[test]
fn arguments_are_toml_or_strings_and_errors_quote_them() {
    let load =
        |argument: &str| Config::load(&folder(), "alley", Some("blue"), &[argument.to_owned()]);
    assert_eq!(
        load("objects.shape=ellipsoid").unwrap().objects.shape,
        ObjectShape::Ellipsoid
    );
    assert_eq!(
        load("display.profile=1996").unwrap().display.profile,
        DisplayProfileName::Of1996
    );
    assert_eq!(
        load("objects.shape=true").unwrap().objects.shape,
        ObjectShape::True
    );
    assert_eq!(
        load("objects.friction_rate = 0.25")
            .unwrap()
            .objects
            .friction_rate,
        0.25
    );
    let message = load("objects.friction_rate=2").unwrap_err().to_string();
    assert!(
        message.starts_with(
            "--set objects.friction_rate=2: key `objects.friction_rate`: 2 is out of range"
        ),
        "{message}"
    );
    for bad in ["objects.friction_rate", "=1", "a..b=1", "a=1\nb=2"] {
        let message = load(bad).unwrap_err().to_string();
        assert!(
            message.contains("is not of the form key=value"),
            "{message}"
        );
    }
}

#[test]
fn no_type_of_the_program_is_named() {
    let refused = |argument: &str| {
        let layer = [argument.to_owned()];
        Config::load(&folder(), "alley", None, &layer)
            .unwrap_err()
            .to_string()
    };
    for argument in [
        "lane.boards=true",
        "lane.boards=2.5",
        "lane.boards=99999999999",
        "objects=3",
        "objects.elasticity=[1]",
        "objects.elasticity={a=1}",
        "objects.shape={a=1}",
        "balls=3",
        "balls=[3]",
        "physics.effects=1",
        "physics.effects=[\"magnetism\"]",
    ] {
        let message = refused(argument);
        assert!(message.contains(" does not fit; give "), "{message}");
        for word in [
            "struct", "f64", "u32", "expected", "invalid", "variant", "Config",
        ] {
            assert!(!message.contains(word), "`{word}` in: {message}");
        }
    }
    for value in ["1e301", &"1".repeat(301), &format!("{}.0", "1".repeat(301))] {
        let message = refused(&format!("lane.width_m={value}"));
        assert!(message.len() < 200, "{message}");
    }
}

#[test]
fn a_relation_blames_the_value_that_was_set_last() {
    for (argument, key) in [
        ("lane.pin_spacing_m=0.4", "lane.width_m"),
        ("lane.row_pitch_m=0.9", "lane.deck_end_z_m"),
        ("desk.button_radius_m=0.2", "desk.button_spacing_m"),
        ("hand.trigger_close=0.2", "hand.trigger_open"),
        (
            "pin.parts.belly_height_m=0.19",
            "pin.parts.shoulder_height_m",
        ),
        ("room.depth_m=3", "room.approach_length_m"),
        ("physics.step_hz=700", "tracking.rate_hz"),
    ] {
        let arguments = [argument.to_owned()];
        let message = Config::load(&folder(), "alley", None, &arguments)
            .unwrap_err()
            .to_string();
        let expected = format!("--set {argument}: key `{key}`: ");
        assert!(message.starts_with(&expected), "{message}");
    }
    // The key itself is to blame where nothing stronger is.
    let message = refusal("[lane]\nwidth_m = 0.6\n");
    assert!(
        message.starts_with("config/blue.toml, line 2: "),
        "{message}"
    );
}

#[test]
fn text_that_is_not_utf_8_is_named_with_its_line() {
    let path = std::env::temp_dir().join(format!("not-utf-8-{}.toml", std::process::id()));
    std::fs::write(&path, b"[objects]\n# \xff\n").unwrap();
    let message = Layer::file(&path).unwrap_err().to_string();
    std::fs::remove_file(&path).unwrap();
    assert!(
        message.ends_with(".toml, line 2: is not UTF-8 text; save the file in UTF-8"),
        "{message}"
    );
}

#[test]
fn a_scene_that_is_not_there_is_refused_with_those_that_are() {
    for scene in ["no-such-scene", "../red", "sub/alley", "", "."] {
        let message = Config::load(&folder(), scene, None, &[])
            .unwrap_err()
            .to_string();
        assert!(
            message.starts_with(&format!("--scene {scene}: ")),
            "{message}"
        );
        assert!(
            message.ends_with("there are: alley, plain-1996, test"),
            "{message}"
        );
    }
}

#[test]
fn numbers_round_trip_through_json() {
    let config = default_config();
    let text = serde_json::to_string(&config).unwrap();
    assert_eq!(serde_json::from_str::<Config>(&text).unwrap(), config);
}
