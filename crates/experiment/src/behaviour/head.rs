//! What the head did, against its own sway.

use super::object::{Approach, position_at};
use super::{Body, HeadResponse, HeadSample, Settings, dot, length, minus};

/// Sway is a slow thing: samples closer than this are one and the same [s].
const SWAY_S: f64 = 0.1;
/// Part of the baseline in which the head has to be tracked.
const TRACKED: f64 = 0.7;
/// Samples in a row that have to be off: one may be a tracker's.
const IN_A_ROW: usize = 3;
/// An answer begins where the head last was within so many standard deviations.
const STILL: f64 = 1.5;
/// Speeds are taken over this time [s].
const SPEED_S: f64 = 0.04;

/// Where the head would be if it went on as before.
struct Baseline {
    middle_s: f64,
    place: [f64; 3],
    /// Zero for who stands.
    velocity: [f64; 3],
    /// Standard deviation of a coordinate [m].
    sway_m: f64,
    /// Independent samples, and the sum of their squared times from the middle.
    samples: f64,
    spread_s2: f64,
}

/// The head's answer; `None` when too little of the head is known.
pub(super) fn response(
    head: &[HeadSample],
    body: &Body,
    approach: &Approach,
    settings: &Settings,
) -> Option<HeadResponse> {
    let baseline = Baseline::before(head, approach.onset_s, settings)?;
    let end = approach.end_s + settings.after_s;
    let tracked: Vec<(f64, [f64; 3])> = head
        .iter()
        .filter(|sample| (approach.onset_s..=end).contains(&sample.time_s))
        .filter_map(|sample| Some((sample.time_s, baseline.off(sample.time_s, sample.position?))))
        .collect();
    if tracked.len() < IN_A_ROW {
        return None;
    }
    let score = |(time_s, off): &(f64, [f64; 3])| length(*off) / baseline.deviation(*time_s);
    let scores: Vec<f64> = tracked.iter().map(score).collect();
    let displacement_m = tracked
        .iter()
        .map(|(_, off)| length(*off))
        .fold(0.0, f64::max);
    let is_off = |index: usize| {
        scores[index] >= settings.answer_score && length(tracked[index].1) >= settings.answer_m
    };
    let runs = 0..=tracked.len() - IN_A_ROW;
    let crossing = runs
        .into_iter()
        .find(|first| (*first..first + IN_A_ROW).all(is_off));
    let onset = crossing.map(|crossing| {
        let still = (0..crossing).rev().find(|index| scores[*index] <= STILL);
        tracked[still.unwrap_or(0)].0 - approach.onset_s
    });
    Some(HeadResponse {
        time_to_contact_s: approach.time_to_contact_s,
        miss_distance_m: approach.miss_distance_m,
        onset_s: onset,
        displacement_m,
        speed_mps: speed(&tracked),
        gain_m: gain(head, body, approach, &baseline, settings).unwrap_or(0.0),
        score: scores.into_iter().fold(0.0, f64::max),
    })
}

impl Baseline {
    fn before(head: &[HeadSample], onset_s: f64, settings: &Settings) -> Option<Baseline> {
        let window = head
            .iter()
            .filter(|sample| (onset_s - settings.baseline_s..onset_s).contains(&sample.time_s));
        let total = window.clone().count();
        let samples: Vec<(f64, [f64; 3])> = window
            .filter_map(|sample| Some((sample.time_s, sample.position?)))
            .collect();
        let covered = samples.last()?.0 - samples.first()?.0;
        if (samples.len() as f64) < TRACKED * total as f64
            || covered < TRACKED * settings.baseline_s
        {
            return None;
        }
        let count = samples.len() as f64;
        let middle_s = samples.iter().map(|(time_s, _)| time_s).sum::<f64>() / count;
        let place: [f64; 3] =
            std::array::from_fn(|axis| samples.iter().map(|(_, at)| at[axis]).sum::<f64>() / count);
        let spread = samples
            .iter()
            .map(|(time_s, _)| (time_s - middle_s).powi(2))
            .sum::<f64>();
        let slope = |axis: usize| {
            samples
                .iter()
                .map(|(time_s, at)| (time_s - middle_s) * at[axis])
                .sum::<f64>()
                / spread
        };
        // Walking is on the floor; a height that changes is a bob or a bow.
        let walking = [slope(0), 0.0, slope(2)];
        let velocity = if length(walking) >= settings.walking_mps {
            walking
        } else {
            [0.0; 3]
        };
        let independent = covered / SWAY_S;
        let mut baseline = Baseline {
            middle_s,
            place,
            velocity,
            sway_m: 0.0,
            samples: independent,
            spread_s2: spread / count * independent,
        };
        let squares: f64 = samples
            .iter()
            .map(|(time_s, at)| length(baseline.off(*time_s, *at)).powi(2))
            .sum();
        baseline.sway_m = (squares / (3.0 * count)).sqrt().max(settings.least_sway_m);
        Some(baseline)
    }

    /// How far the head is off; for who walks, across the way alone, because slowing down is no dodging.
    fn off(&self, time_s: f64, position: [f64; 3]) -> [f64; 3] {
        let off = minus(position, self.expected(time_s));
        let speed = length(self.velocity);
        if speed == 0.0 {
            return off;
        }
        let along = dot(off, self.velocity) / (speed * speed);
        std::array::from_fn(|axis| off[axis] - along * self.velocity[axis])
    }

    fn expected(&self, time_s: f64) -> [f64; 3] {
        std::array::from_fn(|axis| {
            self.place[axis] + (time_s - self.middle_s) * self.velocity[axis]
        })
    }

    /// Standard deviation of a distance off at a time: three coordinates of sway, and for who walks the uncertainty of the line.
    fn deviation(&self, time_s: f64) -> f64 {
        let line = if self.velocity == [0.0; 3] {
            0.0
        } else {
            (time_s - self.middle_s).powi(2) / self.spread_s2
        };
        self.sway_m * (3.0 * (1.0 + 1.0 / self.samples + line)).sqrt()
    }
}

/// Largest speed off the baseline.
fn speed(tracked: &[(f64, [f64; 3])]) -> f64 {
    let mut largest = 0.0_f64;
    let mut from = 0;
    for (time_s, off) in tracked {
        while from < tracked.len() && time_s - tracked[from].0 > SPEED_S {
            from += 1;
        }
        let (earlier_s, earlier) = tracked[from.saturating_sub(1)];
        if time_s - earlier_s >= SPEED_S {
            largest = largest.max(length(minus(*off, earlier)) / (time_s - earlier_s));
        }
    }
    largest
}

/// How much farther the body passed than it would have passed a head that went on as before.
fn gain(
    head: &[HeadSample],
    body: &Body,
    approach: &Approach,
    baseline: &Baseline,
    settings: &Settings,
) -> Option<f64> {
    let times = approach.onset_s..=approach.end_s + settings.after_s;
    let samples = body
        .samples
        .iter()
        .filter(|sample| times.contains(&sample.time_s));
    let pairs = samples.filter_map(|sample| {
        let actual = length(minus(sample.centre, position_at(head, sample.time_s)?));
        Some((
            actual,
            length(minus(sample.centre, baseline.expected(sample.time_s))),
        ))
    });
    let closest = pairs.fold(None, |least: Option<(f64, f64)>, (actual, expected)| {
        let (least_actual, least_expected) = least.unwrap_or((f64::INFINITY, f64::INFINITY));
        Some((least_actual.min(actual), least_expected.min(expected)))
    });
    closest.map(|(actual, expected)| actual - expected)
}
