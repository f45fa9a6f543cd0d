//! Getting out of the way: what the paper noticed and did not measure (its section 5, future work).
//!
//! An **episode** begins when a ball or pin is about to come near the head, by where its last samples lead. The head's **answer** is
//! how far it then leaves the place, or the straight way, that it was on before, held against its own sway. `docs/behaviour.md` has
//! the definition, its reasons and how often it errs.

mod head;
mod object;

use crate::record::{EventRow, HeadResponse, TrialType};

/// The head at one instant.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct HeadSample {
    /// Time [s].
    pub time_s: f64,
    /// Centre of the head, world frame [m]; `None` while not tracked.
    pub position: Option<[f64; 3]>,
}

/// A ball or pin at one instant.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BodySample {
    /// Time [s], on the head's clock.
    pub time_s: f64,
    /// Centre, world frame [m].
    pub centre: [f64; 3],
}

/// A ball or pin while nobody holds it; a gap in its samples parts its ways.
#[derive(Debug, Clone, Copy)]
pub struct Body<'a> {
    /// Radius of a ball around it [m].
    pub radius_m: f64,
    /// Its samples in the order of time.
    pub samples: &'a [BodySample],
}

/// What counts as coming towards the head, and as an answer.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Settings {
    /// Longest time to the closest approach [s].
    pub horizon_s: f64,
    /// Largest distance of the closest approach, from surface to the head's centre [m].
    pub miss_m: f64,
    /// Smallest speed towards the head [m/s].
    pub closing_mps: f64,
    /// Time before the onset from which the head's own sway is taken [s].
    pub baseline_s: f64,
    /// Time after the closest approach that still belongs to the answer [s].
    pub after_s: f64,
    /// Speed of the head in the baseline from which on it is taken to walk [m/s].
    pub walking_mps: f64,
    /// Least sway that is assumed [m]: trackers are no better.
    pub least_sway_m: f64,
    /// An answer is at least so many standard deviations of the sway.
    pub answer_score: f64,
    /// An answer is at least so far [m].
    pub answer_m: f64,
}

impl Default for Settings {
    fn default() -> Self {
        Settings {
            horizon_s: 1.0,
            miss_m: 0.5,
            closing_mps: 1.0,
            baseline_s: 1.0,
            after_s: 0.3,
            walking_mps: 0.25,
            least_sway_m: 0.005,
            answer_score: 4.0,
            answer_m: 0.08,
        }
    }
}

/// Something came towards the head.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Episode {
    /// When it was first on such a way [s].
    pub onset_s: f64,
    /// When it was closest, or was turned away [s].
    pub end_s: f64,
    /// What the head did.
    pub response: HeadResponse,
}

impl Episode {
    /// As a row of the events table; `object` names the body.
    pub fn event(&self, object: &str) -> EventRow {
        EventRow {
            duration_s: Some(self.end_s - self.onset_s),
            object: Some(object.to_owned()),
            response: Some(self.response),
            ..EventRow::new(self.onset_s, TrialType::TowardHead)
        }
    }
}

/// The episodes of one body, and how many could not be scored because the head was not tracked.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Episodes {
    /// Those with an answer or without.
    pub scored: Vec<Episode>,
    /// Those that say nothing.
    pub unscored: usize,
}

/// Finds and scores the episodes of one body.
pub fn episodes(head: &[HeadSample], body: &Body, settings: &Settings) -> Episodes {
    let mut episodes = Episodes::default();
    for approach in object::approaches(head, body, settings) {
        match head::response(head, body, &approach, settings) {
            Some(response) => episodes.scored.push(Episode {
                onset_s: approach.onset_s,
                end_s: approach.end_s,
                response,
            }),
            None => episodes.unscored += 1,
        }
    }
    episodes
}

/// A point on the way between two samples.
fn between(a: [f64; 3], b: [f64; 3], part: f64) -> [f64; 3] {
    std::array::from_fn(|axis| a[axis] + (b[axis] - a[axis]) * part)
}

fn minus(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    std::array::from_fn(|axis| a[axis] - b[axis])
}

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn length(a: [f64; 3]) -> f64 {
    dot(a, a).sqrt()
}

#[cfg(test)]
mod tests;
