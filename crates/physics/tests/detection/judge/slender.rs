//! The largest gap of shapes a thousand times as long as they are thick.
//!
//! Their gap as a function of the normal has ridges and tops as narrow as the ratio: near normals square to a needle,
//! near a plate's own, and where two such circles cross. Samples are strewn there at all scales.

use std::f64::consts::TAU;

use glam::DVec3;

use super::cases::{Case, between, direction};
use super::oracle::{Best, Field};
use crate::support::Random;

/// Normals tried.
const SAMPLES: usize = 6000;
/// The best of them are climbed from.
const CLIMBED: usize = 24;
/// The best of the tops are refined.
const REFINED: usize = 3;

/// The largest gap found, and its normal: a lower bound of the truth, and nearly always the truth.
pub fn best(case: &Case, random: &mut Random) -> Best {
    let field = Field::new(case);
    let mut samples: Vec<Best> = (0..SAMPLES)
        .map(|_| {
            let normal = strewn(case, random);
            Best {
                gap: field.gap(normal),
                normal,
            }
        })
        .collect();
    let downwards = |x: &Best, y: &Best| y.gap.total_cmp(&x.gap);
    samples.sort_by(downwards);
    let mut tops: Vec<Best> = Vec::new();
    for sample in samples {
        let is_new = |top: &Best| top.normal.distance(sample.normal) > 0.02;
        if tops.iter().all(is_new) {
            tops.push(sample);
        }
        if tops.len() == CLIMBED {
            break;
        }
    }
    let mut tops: Vec<Best> = tops
        .into_iter()
        .map(|top| {
            let top = field.climb(top.normal, 0.03, 1e-7);
            field.climb(top.normal, 1e-3, 1e-8)
        })
        .collect();
    tops.sort_by(downwards);
    tops.truncate(REFINED);
    let refined = tops.into_iter().map(|top| {
        let windows = [0.03, 1e-3, 1e-5];
        windows
            .into_iter()
            .fold(top, |top, window| field.refine(top.normal, window))
    });
    refined
        .max_by(|x, y| x.gap.total_cmp(&y.gap))
        .expect("there are tops")
}

/// A normal near one of those at which gaps tend to be largest, at a random scale.
fn strewn(case: &Case, random: &mut Random) -> DVec3 {
    let axis = |pose: &physics::Pose, random: &mut Random| {
        let pick = between(random, 0.0, 3.0) as usize;
        pose.rotation * [DVec3::X, DVec3::Y, DVec3::Z][pick.min(2)]
    };
    let (u, v) = (axis(&case.pose_a, random), axis(&case.pose_b, random));
    let one = if random.next() < 0.0 { u } else { v };
    let middle = match between(random, 0.0, 4.0) as u32 {
        0 => one * random.next().signum(),
        1 => {
            let (p, q) = one.any_orthonormal_pair();
            let (sin, cos) = between(random, 0.0, TAU).sin_cos();
            p * cos + q * sin
        }
        2 => u.cross(v).normalize_or(u) * random.next().signum(),
        _ => return direction(random),
    };
    let aside = direction(random) * 10f64.powf(between(random, -6.0, 0.0));
    (middle + aside).normalize_or(middle)
}
