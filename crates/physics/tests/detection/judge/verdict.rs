//! Judges an answer of the solver.

use glam::DVec3;
use physics::Pose;
use physics::query::Separation;

use super::cases::Case;
use super::oracle::{Best, Field, Oracle};

/// Rounding that is nobody's fault, relative to the size.
const ROUNDING: f64 = 1e-13;

/// What the judge found about one answer; lengths in metres.
#[derive(Clone, Copy, Debug)]
pub struct Verdict {
    /// Lower and upper bound of the true signed gap, as far as the judge knows.
    pub truth: (f64, f64),
    /// How far the answer's gap is off, at most; infinite if the answer is not a finite gap along a unit vector.
    pub gap_error: f64,
    /// Angle between the answer's normal and a better one [rad]; zero where there is none.
    pub normal_error: f64,
    /// How far the answer's interval misses the truth; zero if it holds.
    pub outside: f64,
    /// Width of the answer's interval, where it gave one.
    pub width: Option<f64>,
}

/// What is known beforehand: gap [m] and unit normal.
pub type Truth = (f64, DVec3);

/// Angle between two vectors [rad], also where it is tiny.
pub fn angle(a: DVec3, b: DVec3) -> f64 {
    a.cross(b).length().atan2(a.dot(b))
}

/// An upper bound of the signed gap: the distance of the answer's points, and how far they lie outside [m].
fn primal(case: &Case, answer: &Separation) -> f64 {
    let outside = |shape: &super::known::Known, pose: &Pose, p: DVec3| {
        shape.outside(pose.rotation.conjugate() * (p - pose.position))
    };
    let way = answer.point_a.distance(answer.point_b)
        + outside(&case.a, &case.pose_a, answer.point_a)
        + outside(&case.b, &case.pose_b, answer.point_b);
    if way.is_finite() { way } else { f64::INFINITY }
}

/// Judges `answer`. Without a known truth two bounds decide where they meet; where they do not, the oracle does.
pub fn judge(case: &Case, answer: &Separation, known: Option<Truth>, oracle: &Oracle) -> Verdict {
    let field = Field::new(case);
    let (size, n) = (case.size(), answer.normal);
    let own = field.gap(n);
    let (mut low, mut high) = (own, primal(case, answer));
    let mut normal_error = (2.0 * (1.0 - low / high).max(0.0)).sqrt();
    if let Some((gap, normal)) = known {
        (low, high) = (gap, gap);
        normal_error = angle(n, normal);
    } else if low <= 0.0 || high - low > 1e-9 * size {
        let here = Best {
            gap: own,
            normal: n,
        };
        low = oracle.better(case, here).map_or(own, |best| best.gap);
    }
    // An overlap, or a certificate that is too coarse for angles: does a better normal lie close by?
    if known.is_none() && !(own > 0.0 && normal_error < 1e-6) {
        let local = if own > -1e-3 * size {
            field.refine(n, 1e-3)
        } else {
            field.climb(n, 1e-3, 1e-6)
        };
        let gained = local.gap > own + ROUNDING * size;
        normal_error = if gained { angle(n, local.normal) } else { 0.0 };
        low = low.max(local.gap);
    }
    if known.is_none() && low <= 0.0 {
        // Nothing but the search bounds an overlap from above.
        high = low;
    }
    high = high.max(low);
    let slack = ROUNDING * size + 4.0 * f64::EPSILON * case.pose_b.position.length();
    let over = answer.gap - high - slack;
    let under = answer.upper.map_or(0.0, |upper| low - upper - slack);
    let sound = answer.gap.is_finite() && (n.length() - 1.0).abs() <= 1e-12;
    Verdict {
        truth: (low, high),
        gap_error: if sound {
            (answer.gap - low).abs().max((answer.gap - high).abs())
        } else {
            f64::INFINITY
        },
        normal_error,
        outside: over.max(under).max(0.0),
        width: answer.upper.map(|upper| upper - answer.gap),
    }
}
