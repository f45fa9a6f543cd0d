//! Settings that recordings made before them do not have: what was so then, said in their place.
//!
//! Files of settings must be complete; only what was recorded is completed, so that it plays as it did. A setting that is added
//! to the configuration is added here too, with the value that leaves an old recording as it was.

use game::Conditions;
use serde::de::{Deserialize, Deserializer, Error};
use serde_json::{Value, json};

/// What is put where a recording says nothing.
fn since_then() -> Value {
    json!({
        // Before these lists there was one look: shadows, textures, one lane, no image in the floor.
        "shows": {
            "shadows": true,
            "reflection": false,
            "ambient_occlusion": false,
            "neighbouring_lanes": false,
            "furnishings": false,
            "materials": true,
            "smooth_edges": true,
            "low_polygon": false,
            "replay": false,
            // Nothing was heard, unless the list of a scene has it.
            "sound": false,
        },
        "markings": {
            "arrow_boards": [5, 10, 15, 20, 25, 30, 35],
            "arrow_z_m": [-3.81, -4.1148, -4.4196, -4.7244, -4.4196, -4.1148, -3.81],
            "lane_dot_boards": [3, 5, 8, 11, 14, 26, 29, 32, 35, 37],
            "lane_dots_z_m": -2.1336,
            "approach_dot_boards": [5, 10, 15, 20, 25, 30, 35],
            "approach_dots_z_m": [0.0762, 3.6576, 4.522],
        },
        "room": { "lane_pitch_m": 1.8 },
        "release": { "assist_share": 0.0 },
        "sound": {
            "full_scale_pa": 6.0,
            "hall_width_m": 20.0,
            "hall_height_m": 4.0,
            "hall_length_m": 30.0,
            "reverberation_s": 0.8,
            "lookahead_s": 0.015,
            "is_delayed_by_distance": false,
        },
        // What the hand could take has always glowed; of a release the window alone told.
        "calibration": {
            "gesture": false,
            "hold_s": 1.5,
            "still_m": 0.06,
            "seated_below_m": 1.35,
            "eye_height_m": 1.62,
        },
        "practice": { "only": false, "leave": [], "shows_lane": false },
        "comfort": {
            "fence": false,
            "fence_from_m": 0.4,
            "space_m": [0.0, 0.0],
            "vignette": false,
            "vignette_clear_deg": 20.0,
        },
        "guidance": { "words": "words.toml", "glow": true, "hints": false, "feedback": false },
    })
}

/// Puts what `missing` has and `settings` has not into `settings`.
fn complete(settings: &mut Value, missing: &Value) {
    let (Value::Object(settings), Value::Object(missing)) = (settings, missing) else {
        return;
    };
    for (key, value) in missing {
        match settings.get_mut(key) {
            Some(known) => complete(known, value),
            None => {
                settings.insert(key.clone(), value.clone());
            }
        }
    }
}

/// For a while a list of its own told whether a scene is heard: its place is among what a scene shows.
fn take_scene(settings: &mut Value) {
    let Some(table) = settings.as_object_mut() else {
        return;
    };
    let Some(scene) = table.remove("scene") else {
        return;
    };
    let effects = scene["effects"].as_array();
    let is_heard = effects.is_some_and(|effects| effects.iter().any(|effect| effect == "sound"));
    if let Some(shows) = table.get_mut("shows").and_then(Value::as_object_mut) {
        shows.insert("sound".to_owned(), json!(is_heard));
    }
}

/// Recorded settings, of this program or of an older one.
///
/// # Errors
/// When they are not settings.
pub fn conditions(mut recorded: Value) -> serde_json::Result<Conditions> {
    let missing = since_then();
    for name in ["lobby", "red", "blue"] {
        if let Some(settings) = recorded.get_mut(name) {
            take_scene(settings);
            complete(settings, &missing);
        }
    }
    serde_json::from_value(recorded)
}

/// The same, of a header that may have none.
pub(super) fn of_header<'de, D: Deserializer<'de>>(
    deserializer: D,
) -> Result<Option<Conditions>, D::Error> {
    let recorded = Option::<Value>::deserialize(deserializer)?;
    recorded
        .map(conditions)
        .transpose()
        .map_err(D::Error::custom)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::convert::tests::config;

    #[test]
    fn what_is_recorded_stays_and_what_is_missing_is_as_it_was() {
        let config = config();
        let now = Conditions {
            lobby: config.clone(),
            red: config.clone(),
            blue: config,
        };
        let whole = serde_json::to_value(&now).expect("plain numbers");
        assert_eq!(conditions(whole.clone()).expect("complete"), now);
        let mut old = whole;
        for name in ["lobby", "red", "blue"] {
            let settings = old[name].as_object_mut().expect("a table");
            for table in ["shows", "markings", "sound", "guidance"] {
                settings.remove(table);
            }
            settings["room"]["half_width_m"] = json!(2.5);
            settings["room"]
                .as_object_mut()
                .expect("a table")
                .remove("lane_pitch_m");
        }
        let read = conditions(old).expect("completed");
        for settings in [&read.lobby, &read.red, &read.blue] {
            assert_eq!(settings.check(), Ok(()));
            assert_eq!(settings.room.half_width_m, 2.5);
            assert!(settings.shows.shadows && !settings.shows.neighbouring_lanes);
            assert!(!settings.shows.sound && !settings.shows.replay);
            assert_eq!(settings.markings, now.lobby.markings);
        }
    }

    #[test]
    fn a_scene_that_listed_sound_is_heard() {
        for (effects, is_heard) in [(json!(["sound"]), true), (json!([]), false)] {
            let mut settings = serde_json::to_value(config()).expect("plain numbers");
            settings["scene"] = json!({ "effects": effects });
            let shows = settings["shows"].as_object_mut().expect("a table");
            shows.remove("sound");
            let all = json!({ "lobby": settings, "red": settings, "blue": settings });
            let read = conditions(all).expect("completed");
            assert_eq!(read.red.shows.sound, is_heard);
        }
    }

    #[test]
    fn a_setting_that_nobody_knew_is_refused() {
        let mut odd = serde_json::to_value(config()).expect("plain numbers");
        odd["room"]["colour"] = json!("green");
        let all = json!({ "lobby": odd, "red": odd, "blue": odd });
        let error = conditions(all).expect_err("unknown").to_string();
        assert!(error.contains("colour"), "{error}");
    }
}
