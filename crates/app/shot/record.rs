//! A throw kept in a file: JSON lines that say themselves what they hold (docs/shot.md).

use std::io::Write;
use std::path::Path;

use anyhow::{Context, Result};
use serde::Serialize;
use serde_json::json;

use super::answer::Shot;
use super::throw::{Flight, Release};
use crate::output::Draft;

/// What the first line calls the format.
pub const FORMAT: &str = "bowling-throw";
/// Changed when a reader of the last version would misread a file.
pub const VERSION: u32 = 1;

/// A file that grows by a line a step, and appears when the throw is over.
pub struct Record {
    draft: Draft,
    name: String,
}

/// The state of one body.
#[derive(Serialize)]
struct BodyState {
    position: [f64; 3],
    rotation: [f64; 4],
    linear: [f64; 3],
    angular: [f64; 3],
}

impl Record {
    /// Starts the file with what is thrown, and the state at the release.
    ///
    /// # Errors
    /// When the file cannot be written.
    pub fn begin(path: &Path, flight: &Flight, release: &Release) -> Result<Self> {
        let mut record = Self {
            draft: Draft::at(path)?,
            name: path.display().to_string(),
        };
        let config = flight.alley.config();
        let pins = flight.alley.pins().iter();
        let names: Vec<String> = std::iter::once("ball".to_owned())
            .chain(pins.map(|(number, _)| format!("pin {number}")))
            .collect();
        record.line(&json!({
            "format": FORMAT,
            "version": VERSION,
            "steps_per_s": config.physics.step_hz,
            "bodies": names,
            "units": {
                "time": "s", "position": "m, world frame", "rotation": "quaternion x y z w, world from body",
                "linear": "m/s, world frame", "angular": "rad/s, world frame",
            },
            "release": release,
            "settings": config,
        }))?;
        record.state(flight)?;
        Ok(record)
    }

    /// Adds the state of ball and pins.
    ///
    /// # Errors
    /// When the disk is full or gone.
    pub fn state(&mut self, flight: &Flight) -> Result<()> {
        let world = &flight.alley.world;
        let pins = flight.alley.pins().iter().map(|(_, id)| *id);
        let states: Vec<BodyState> = std::iter::once(flight.ball)
            .chain(pins)
            .map(|id| {
                let body = world.body(id);
                BodyState {
                    position: body.pose().position.to_array(),
                    rotation: body.pose().rotation.to_array(),
                    linear: body.linear_velocity().to_array(),
                    angular: body.angular_velocity().to_array(),
                }
            })
            .collect();
        self.line(&json!({ "step": world.steps(), "time": world.time(), "states": states }))
    }

    /// Adds what came of it, and gives the file its name.
    ///
    /// # Errors
    /// When the disk is full or gone.
    pub fn end(mut self, shot: &Shot) -> Result<()> {
        let result = format!("{{\"result\":{}}}\n", shot.json());
        let written = self.draft.write_all(result.as_bytes());
        written.with_context(|| format!("cannot write {}", self.name))?;
        self.draft.finish()?;
        Ok(())
    }

    fn line(&mut self, value: &serde_json::Value) -> Result<()> {
        writeln!(self.draft, "{value}").with_context(|| format!("cannot write {}", self.name))
    }
}
