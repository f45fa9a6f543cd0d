//! How far two courses of one throw part, as a ruler tells and as the participant sees it.

use super::course::Course;
use super::thrown::Thrown;

/// Paths are apart from here on [m].
pub const APART_M: f64 = 0.01;
/// Apart to the participant's eye from here on [degrees].
pub const SEEN_DEG: f64 = 5.0;

/// How the balls of two courses part.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Divergence {
    /// When the balls' centres were a centimetre apart at first, after the release [s].
    pub apart: Option<f64>,
    /// When they were five degrees apart for the participant's eye [s].
    pub seen: Option<f64>,
    /// The largest angle between them for the eye [degrees].
    pub most_deg: f64,
    /// When that was [s].
    pub most_at: f64,
}

impl Divergence {
    /// Compares two courses of one throw with equal steps.
    pub fn of(thrown: &Thrown, a: &Course, b: &Course) -> Self {
        let mut divergence = Self {
            apart: None,
            seen: None,
            most_deg: 0.0,
            most_at: 0.0,
        };
        for (step, (a_at, b_at)) in a.ball.iter().zip(&b.ball).enumerate() {
            let time = a.dt * step as f64;
            if a_at.distance(*b_at) > APART_M {
                divergence.apart.get_or_insert(time);
            }
            let eye = thrown.head(time).position;
            let degrees = (*a_at - eye).angle_between(*b_at - eye).to_degrees();
            if degrees > SEEN_DEG {
                divergence.seen.get_or_insert(time);
            }
            if degrees > divergence.most_deg {
                (divergence.most_deg, divergence.most_at) = (degrees, time);
            }
        }
        divergence
    }
}
