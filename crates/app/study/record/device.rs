//! What a device said of itself, for the tables: what it is, how often it shows a picture, when the game waited for it.

use experiment::record::{EventRow, Provenance, TrialType};

use crate::journal::{DeviceLine, Header};

/// What the session was recorded with.
pub fn provenance(header: &Header, device: &[DeviceLine]) -> Provenance {
    let mut made = Provenance {
        version: header.program.clone(),
        commit: header.commit.clone(),
        seed: header.seed,
        device: header.device.clone(),
        refresh_hz: header.rate_hz,
        settings_digest: header.settings_digest.clone().unwrap_or_default(),
        ..Provenance::default()
    };
    let words =
        |line: &DeviceLine, key: &str| line.said["headset"][key].as_str().map(str::to_owned);
    for line in device {
        if let Some(system) = words(line, "system") {
            made.model = system;
        }
        if let Some(runtime) = words(line, "runtime") {
            made.runtime = runtime;
        }
        if let Some(vendor) = line.said["headset"]["vendor_id"].as_u64() {
            // OpenXR has no name: who makes it says so by the number of its USB devices.
            made.manufacturer = format!("USB vendor {vendor:#06x}");
        }
        // Of several the last: a session taken up may have another.
        if let Some(rate) = line.said["refresh_rate_hz"].as_f64() {
            made.refresh_hz = rate;
        }
    }
    made
}

/// When the game waited: after how many inputs, and how long by the runtime's clock [s], where that is known.
pub fn pauses(device: &[DeviceLine]) -> Vec<(usize, Option<f64>)> {
    let mut state = State::default();
    let mut begun: Option<&DeviceLine> = None;
    let mut pauses = Vec::new();
    for line in device {
        state.hear(line);
        match (begun, state.waits()) {
            (None, true) => begun = Some(line),
            (Some(from), false) => {
                let seconds = from.time_s.zip(line.time_s).map(|(from, to)| to - from);
                pauses.push((from.at, seconds));
                begun = None;
            }
            _ => {}
        }
    }
    // One that lasted to the end has no known length.
    pauses.extend(begun.map(|from| (from.at, None)));
    pauses
}

/// The row of a pause that began at `onset_s` [s].
pub fn pause(onset_s: f64, seconds: Option<f64>) -> EventRow {
    EventRow {
        duration_s: seconds,
        ..EventRow::new(onset_s, TrialType::Pause)
    }
}

/// What keeps a game waiting.
#[derive(Debug, Default)]
struct State {
    is_off: bool,
    is_paused: bool,
    is_elsewhere: bool,
    has_been_here: bool,
}

impl State {
    fn hear(&mut self, line: &DeviceLine) {
        if let Some(is_worn) = line.said["worn"].as_bool() {
            self.is_off = !is_worn;
        }
        if let Some(is_paused) = line.said["paused"].as_bool() {
            self.is_paused = is_paused;
        }
        if let Some(focus) = line.said["focus"].as_str() {
            self.is_elsewhere = focus != "focused";
            self.has_been_here |= !self.is_elsewhere;
        }
        self.is_elsewhere |= line.said.get("lost").is_some();
    }

    /// A device that has only been switched on keeps nobody waiting.
    fn waits(&self) -> bool {
        self.has_been_here && (self.is_off || self.is_paused || self.is_elsewhere)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    fn line(at: usize, time_s: f64, said: serde_json::Value) -> DeviceLine {
        let time_s = Some(time_s);
        DeviceLine { at, time_s, said }
    }

    #[test]
    fn a_pause_is_from_the_first_reason_to_the_last() {
        let lines = [
            line(0, 1.0, json!({"focus": "visible"})),
            line(0, 2.0, json!({"focus": "focused"})),
            line(90, 10.0, json!({"worn": false})),
            line(90, 11.0, json!({"focus": "visible"})),
            line(90, 13.0, json!({"worn": true})),
            line(90, 14.5, json!({"focus": "focused"})),
            line(95, 15.0, json!({"refresh_rate_hz": 72.0})),
            line(100, 20.0, json!({"paused": true})),
        ];
        assert_eq!(pauses(&lines), [(90, Some(4.5)), (100, None)]);
    }

    #[test]
    fn provenance_has_what_the_device_said_last() {
        let header = Header {
            schema: 1,
            program: "1.2.3".to_owned(),
            commit: "abc".to_owned(),
            device: "headset".to_owned(),
            seed: 5,
            rate_hz: 90.0,
            display: "modern".to_owned(),
            frames: 10,
            scene: "alley".to_owned(),
            conditions: None,
            settings_digest: Some("d".to_owned()),
            continues: None,
        };
        assert_eq!(provenance(&header, &[]).refresh_hz, 90.0);
        let said = json!({"headset": {"system": "A One", "runtime": "R 2", "vendor_id": 10291}});
        let lines = [
            line(0, 0.0, said),
            line(0, 0.0, json!({"refresh_rate_hz": 120.0})),
            line(9, 1.0, json!({"refresh_rate_hz": 72.0})),
        ];
        let made = provenance(&header, &lines);
        assert_eq!(
            (made.model.as_str(), made.runtime.as_str()),
            ("A One", "R 2")
        );
        assert_eq!(made.manufacturer, "USB vendor 0x2833");
        assert_eq!(made.refresh_hz, 72.0);
        assert_eq!((made.seed, made.settings_digest.as_str()), (5, "d"));
    }
}
