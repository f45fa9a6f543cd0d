//! The signed gap of two placed shapes without the search that is measured: by sampling the sphere and nested line searches.
//!
//! It asks the shapes for nothing but support points. What it shares with the query is therefore the shapes alone.

use std::f64::consts::FRAC_PI_4;

use glam::DVec3;
use physics::{Pose, Shape};

/// Inverse of the golden ratio.
const GOLDEN: f64 = 0.618_033_988_749_894_9;
/// Half the square that line searches look at about a normal [rad], and how precisely [rad].
const WINDOW: f64 = 0.03;
const PRECISION: f64 = 1e-10;
/// Samples whose normals are closer than this are one start, as a cosine.
const APART: f64 = 0.985;

/// A placed shape.
pub type Placed<'a> = (&'a Shape, &'a Pose);

/// Largest gap between two tangent planes [m], and their unit normal from a to b.
#[derive(Clone, Copy, Debug)]
pub struct Gap {
    /// Signed gap [m].
    pub gap: f64,
    /// Unit normal.
    pub normal: DVec3,
}

/// The farthest point of a placed shape along a direction [m].
pub fn support((shape, pose): Placed, direction: DVec3) -> DVec3 {
    let local = pose.rotation.conjugate() * direction;
    pose.transform_point(shape.support(local))
}

/// Gap between the tangent planes of a unit normal [m].
pub fn along(a: Placed, b: Placed, n: DVec3) -> f64 {
    n.dot(support(b, -n) - support(a, n))
}

/// The largest gap, from the best of so many samples, so many of which are followed up.
pub fn largest(a: Placed, b: Placed, samples: u32, starts: usize) -> Gap {
    let at = |normal: DVec3| Gap {
        gap: along(a, b, normal),
        normal,
    };
    let mut all: Vec<Gap> = (0..samples).map(|i| at(spread(i, samples))).collect();
    all.extend(axes(a, b).into_iter().map(at));
    all.sort_by(|x, y| y.gap.total_cmp(&x.gap));
    let mut chosen: Vec<Gap> = Vec::new();
    for sample in all {
        if chosen.len() < starts && chosen.iter().all(|c| c.normal.dot(sample.normal) < APART) {
            chosen.push(sample);
        }
    }
    let tops = chosen.into_iter().map(|start| climb(start, &at));
    let mut tops: Vec<Gap> = tops.collect();
    tops.sort_by(|x, y| y.gap.total_cmp(&x.gap));
    tops.truncate(2);
    let settled = tops.into_iter().map(|top| settle(top, &at));
    settled
        .max_by(|x, y| x.gap.total_cmp(&y.gap))
        .expect("there is at least one start")
}

/// Normals at which faces and edges meet: the axes of both, and square to two of them.
fn axes(a: Placed, b: Placed) -> Vec<DVec3> {
    let of = |(_, pose): Placed| [DVec3::X, DVec3::Y, DVec3::Z].map(|axis| pose.rotation * axis);
    let (of_a, of_b) = (of(a), of(b));
    let crossed = of_a.iter().flat_map(|u| of_b.iter().map(|v| u.cross(*v)));
    let line = b.1.position - a.1.position;
    let all = of_a.into_iter().chain(of_b).chain(crossed).chain([line]);
    all.filter_map(DVec3::try_normalize)
        .flat_map(|n| [n, -n])
        .collect()
}

/// Point `i` of so many that cover the sphere evenly.
fn spread(i: u32, count: u32) -> DVec3 {
    let y = 1.0 - (2.0 * f64::from(i) + 1.0) / f64::from(count);
    let across = (1.0 - y * y).sqrt();
    let turn = 2.399_963_229_728_653 * f64::from(i);
    DVec3::new(across * libm::cos(turn), y, across * libm::sin(turn))
}

/// Climbs by looking in eight directions, with a step that shrinks where none leads up.
fn climb(mut best: Gap, at: &impl Fn(DVec3) -> Gap) -> Gap {
    let (mut step, mut turn) = (0.05, 0.0);
    while step > 1e-5 {
        let (u, v) = best.normal.any_orthonormal_pair();
        turn += 0.7;
        let tried = (0..8).map(|k| {
            let angle = turn + f64::from(k) * FRAC_PI_4;
            let by = (u * libm::cos(angle) + v * libm::sin(angle)) * step;
            at((best.normal + by) / (best.normal + by).length())
        });
        let next = tried.max_by(|x, y| x.gap.total_cmp(&y.gap)).expect("eight");
        if next.gap > best.gap {
            best = next;
            step *= 1.3;
        } else {
            step *= 0.5;
        }
    }
    best
}

/// Two nested line searches about a normal, again and again while that gains anything.
///
/// On the plane that touches the sphere there, the gap over the length of the normal rises to one top along every line,
/// kinks and ridges included: everywhere where the shapes are apart, and near a top where they overlap.
fn settle(mut best: Gap, at: &impl Fn(DVec3) -> Gap) -> Gap {
    for _ in 0..6 {
        let (u, v) = best.normal.any_orthonormal_pair();
        let place = |x: f64, y: f64| {
            let n = best.normal + u * x + v * y;
            at(n / n.length())
        };
        let row = |x: f64| top(|y| place(x, y).gap);
        let (x, _) = top(|x| row(x).1);
        let found = place(x, row(x).0);
        if found.gap <= best.gap + 1e-15 {
            break;
        }
        best = found;
    }
    best
}

/// Where a function with one top is largest within the window, and how large (golden section).
fn top(of: impl Fn(f64) -> f64) -> (f64, f64) {
    let (mut low, mut high) = (-WINDOW, WINDOW);
    let (mut left, mut right) = (high - GOLDEN * (high - low), low + GOLDEN * (high - low));
    let (mut at_left, mut at_right) = (of(left), of(right));
    while high - low > PRECISION {
        if at_left >= at_right {
            (high, right, at_right) = (right, left, at_left);
            left = high - GOLDEN * (high - low);
            at_left = of(left);
        } else {
            (low, left, at_left) = (left, right, at_right);
            right = low + GOLDEN * (high - low);
            at_right = of(right);
        }
    }
    if at_left >= at_right {
        (left, at_left)
    } else {
        (right, at_right)
    }
}
