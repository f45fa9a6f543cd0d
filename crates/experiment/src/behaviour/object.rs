//! When something is about to come near the head.

use super::{Body, BodySample, HeadSample, Settings, between, dot, length, minus};

/// Samples that the way is foreseen from.
const WINDOW: usize = 5;
/// Largest distance of a sample from the parabola through the window [m]; beyond, the body was struck in between.
const STRUCK_M: f64 = 0.004;
/// Samples in a row that have to say the same: one may be a fluke.
const IN_A_ROW: usize = 3;
/// A longer pause between samples parts two ways [s].
const GAP_S: f64 = 0.1;
/// The closest approach is looked for in steps of this [s].
const STEP_S: f64 = 0.005;

/// A body on its way to the head.
#[derive(Debug, Clone, Copy)]
pub(super) struct Approach {
    pub(super) onset_s: f64,
    pub(super) end_s: f64,
    pub(super) time_to_contact_s: f64,
    pub(super) miss_distance_m: f64,
}

/// What is foreseen at one sample.
#[derive(Clone, Copy)]
struct Foreseen {
    time_s: f64,
    /// From surface to head centre [m].
    miss_m: f64,
}

/// The approaches of a body, in the order of time.
pub(super) fn approaches(head: &[HeadSample], body: &Body, settings: &Settings) -> Vec<Approach> {
    let mut approaches: Vec<Approach> = Vec::new();
    let mut threats: Vec<(f64, Foreseen)> = Vec::new();
    let mut open: Option<Approach> = None;
    for end in WINDOW..=body.samples.len() {
        let window = &body.samples[end - WINDOW..end];
        let now = window[WINDOW - 1].time_s;
        let is_one_way = window
            .windows(2)
            .all(|pair| pair[1].time_s - pair[0].time_s <= GAP_S);
        let Some(position) = position_at(head, now) else {
            continue;
        };
        let foreseen = if is_one_way {
            foresee(window, position, body.radius_m, settings)
        } else {
            None
        };
        match (foreseen, open.as_mut()) {
            (Some(_), Some(approach)) => approach.end_s = now,
            (Some(foreseen), None) => {
                threats.push((now, foreseen));
                if threats.len() == IN_A_ROW {
                    let (onset_s, first) = threats[0];
                    open = Some(Approach {
                        onset_s,
                        end_s: now,
                        time_to_contact_s: first.time_s,
                        miss_distance_m: first.miss_m,
                    });
                }
            }
            (None, _) => {
                threats.clear();
                approaches.extend(open.take());
            }
        }
    }
    approaches.extend(open);
    merged(approaches, settings)
}

/// One body that wavers at the limit is one approach.
fn merged(approaches: Vec<Approach>, settings: &Settings) -> Vec<Approach> {
    let mut merged: Vec<Approach> = Vec::new();
    for approach in approaches {
        match merged.last_mut() {
            Some(last) if approach.onset_s - last.end_s < settings.after_s => {
                last.end_s = approach.end_s
            }
            _ => merged.push(approach),
        }
    }
    merged
}

/// The closest approach that the window's parabola leads to; `None` when it is no threat.
fn foresee(
    window: &[BodySample],
    head: [f64; 3],
    radius_m: f64,
    settings: &Settings,
) -> Option<Foreseen> {
    let [position, velocity, acceleration] = parabola(window)?;
    let offset = minus(position, head);
    let distance = length(offset);
    // Already inside the head or not closing in.
    if distance <= radius_m || -dot(offset, velocity) / distance < settings.closing_mps {
        return None;
    }
    let distance_at = |t: f64| {
        let there: [f64; 3] = std::array::from_fn(|axis| {
            offset[axis] + t * (velocity[axis] + t * acceleration[axis] / 2.0)
        });
        length(there)
    };
    let steps = (settings.horizon_s / STEP_S).ceil() as usize;
    let times = (0..=steps).map(|step| step as f64 * STEP_S);
    let (time_s, closest) = times
        .map(|t| (t, distance_at(t)))
        .min_by(|a, b| a.1.total_cmp(&b.1))?;
    let miss_m = (closest - radius_m).max(0.0);
    // A minimum at the horizon is not the closest approach yet.
    let is_threat = miss_m <= settings.miss_m && time_s < settings.horizon_s;
    is_threat.then_some(Foreseen { time_s, miss_m })
}

/// Position, velocity and acceleration at the window's last sample, by least squares; `None` when the body was struck in between.
fn parabola(window: &[BodySample]) -> Option<[[f64; 3]; 3]> {
    let last = window.last()?.time_s;
    let times: Vec<f64> = window.iter().map(|sample| sample.time_s - last).collect();
    let axis = |axis: usize| {
        let values: Vec<f64> = window.iter().map(|sample| sample.centre[axis]).collect();
        let [c0, c1, c2] = quadratic(&times, &values)?;
        let off = |(t, value): (&f64, &f64)| (c0 + t * (c1 + t * c2) - value).abs();
        let is_one_way = times.iter().zip(&values).all(|pair| off(pair) <= STRUCK_M);
        is_one_way.then_some([c0, c1, 2.0 * c2])
    };
    let axes = [axis(0)?, axis(1)?, axis(2)?];
    Some(std::array::from_fn(|order| {
        axes.map(|of_axis| of_axis[order])
    }))
}

/// Coefficients of the parabola through points, by the normal equations and Cramer's rule.
fn quadratic(times: &[f64], values: &[f64]) -> Option<[f64; 3]> {
    // Times in units of the window, so that the sums are of one size.
    let scale = times
        .iter()
        .fold(0.0_f64, |largest, t| largest.max(t.abs()));
    if scale == 0.0 {
        return None;
    }
    let mut power = [0.0; 5];
    let mut moment = [0.0; 3];
    for (t, value) in times.iter().zip(values) {
        let t = t / scale;
        let mut product = 1.0;
        for sum in &mut power {
            *sum += product;
            product *= t;
        }
        moment[0] += value;
        moment[1] += value * t;
        moment[2] += value * t * t;
    }
    let rows = |replaced: Option<usize>| -> [[f64; 3]; 3] {
        std::array::from_fn(|row| {
            std::array::from_fn(|column| {
                if replaced == Some(column) {
                    moment[row]
                } else {
                    power[row + column]
                }
            })
        })
    };
    let whole = determinant(rows(None));
    if whole.abs() < 1e-12 {
        return None;
    }
    let [c0, c1, c2] = [0, 1, 2].map(|column| determinant(rows(Some(column))) / whole);
    Some([c0, c1 / scale, c2 / (scale * scale)])
}

fn determinant(m: [[f64; 3]; 3]) -> f64 {
    m[0][0] * (m[1][1] * m[2][2] - m[1][2] * m[2][1])
        - m[0][1] * (m[1][0] * m[2][2] - m[1][2] * m[2][0])
        + m[0][2] * (m[1][0] * m[2][1] - m[1][1] * m[2][0])
}

/// The head at a time, between its samples; `None` where it is not tracked.
pub(super) fn position_at(head: &[HeadSample], time_s: f64) -> Option<[f64; 3]> {
    let after = head.partition_point(|sample| sample.time_s < time_s);
    let next = head.get(after).or(head.last())?;
    let before = &head[after.saturating_sub(1)];
    let (from, to) = (before.position?, next.position?);
    let span = next.time_s - before.time_s;
    let is_outside = time_s > next.time_s + GAP_S || time_s < before.time_s - GAP_S;
    if span > GAP_S || is_outside {
        return None;
    }
    let part = if span > 0.0 {
        ((time_s - before.time_s) / span).clamp(0.0, 1.0)
    } else {
        0.0
    };
    Some(between(from, to, part))
}
