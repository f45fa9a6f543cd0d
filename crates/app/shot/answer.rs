//! A throw in words and in JSON.

use std::fmt::{self, Display, Formatter};

use serde::Serialize;

use super::throw::{Outcome, Release, Velocities};
use crate::journal::hash_text;

/// A throw and what came of it.
#[derive(Clone, Debug)]
pub struct Shot {
    /// Its number, from 0.
    pub index: u64,
    /// How the ball was let go.
    pub release: Release,
    /// Pins that stood.
    pub pins: usize,
    /// What came of it.
    pub outcome: Outcome,
}

/// The JSON object of a throw.
#[derive(Serialize)]
struct Line<'a> {
    shot: u64,
    offset: f64,
    angle: f64,
    speed: f64,
    fallen: &'a [u8],
    first_pin: Option<u8>,
    first_hit_s: Option<f64>,
    ball_after: Option<Velocities>,
    pin_after: Option<Velocities>,
    energy_before_j: f64,
    energy_after_j: f64,
    momentum_before: [f64; 3],
    momentum_after: [f64; 3],
    hash: String,
    ms_per_simulated_second: f64,
}

impl Shot {
    /// One JSON object without a line end.
    pub fn json(&self) -> String {
        let (outcome, hit) = (&self.outcome, self.outcome.first_hit);
        let line = Line {
            shot: self.index,
            offset: self.release.offset,
            angle: self.release.angle,
            speed: self.release.speed,
            fallen: &outcome.fallen,
            first_pin: hit.map(|hit| hit.pin),
            first_hit_s: hit.map(|hit| hit.seconds),
            ball_after: hit.map(|hit| hit.ball),
            pin_after: hit.map(|hit| hit.pin_after),
            energy_before_j: outcome.energy[0],
            energy_after_j: outcome.energy[1],
            momentum_before: outcome.momentum[0].to_array(),
            momentum_after: outcome.momentum[1].to_array(),
            hash: hash_text(outcome.hash),
            ms_per_simulated_second: outcome.ms_per_second,
        };
        serde_json::to_string(&line).expect("plain numbers and texts are JSON")
    }
}

impl Display for Shot {
    fn fmt(&self, f: &mut Formatter) -> fmt::Result {
        let outcome = &self.outcome;
        let fallen: Vec<String> = outcome.fallen.iter().map(u8::to_string).collect();
        let row = |f: &mut Formatter, name: &str, text: String| writeln!(f, "{name:<12}{text}");
        let count = format!("{} of {}", fallen.len(), self.pins);
        let fell = format!("{count}  {}", fallen.join(" "));
        row(f, "fallen", fell.trim_end().to_owned())?;
        match outcome.first_hit {
            None => row(f, "first hit", "none: the ball met no pin".to_owned())?,
            Some(hit) => {
                let text = format!("pin {} after {:.4} s", hit.pin, hit.seconds);
                row(f, "first hit", text)?;
                row(f, "ball then", moving(&hit.ball))?;
                row(f, "pin then", moving(&hit.pin_after))?;
            }
        }
        let [before, after] = outcome.energy;
        let text = format!("{before:.3} J before, {after:.3} J after");
        row(f, "energy", text)?;
        let [before, after] = outcome.momentum.map(|m| vector(m.to_array()));
        row(f, "momentum", format!("{before} N s before, {after} after"))?;
        row(f, "state hash", hash_text(outcome.hash))?;
        let cost = outcome.ms_per_second;
        let text = format!("{cost:.3} ms of one core per simulated second");
        row(f, "cost", text)
    }
}

fn moving(velocities: &Velocities) -> String {
    let (linear, angular) = (vector(velocities.linear), vector(velocities.angular));
    format!("{linear} m/s, turning {angular} rad/s")
}

fn vector(v: [f64; 3]) -> String {
    // Adding zero takes the minus from a zero.
    let [x, y, z] = v.map(|x| (x * 1e3).round() / 1e3 + 0.0);
    format!("({x:.3}, {y:.3}, {z:.3})")
}
