//! What one normal proves over a stretch of time.
//!
//! For a fixed normal n the gap `s_n(t)` between the tangent planes is a lower bound of the distance at every time.
//! Each point of a body moves with an acceleration of at most c, so between two times with `s_n = s0, s1`
//! `s_n >= lerp(s0, s1) - c (t - t0) (t1 - t) / 2`, kinks of the shape included: a minimum of functions that bend up by
//! at most c bends up by at most c. Two evaluations so prove most pairs apart for a whole stretch; otherwise the root
//! of `s_n` is the next time to look, with a new n.

/// Most steps towards a root.
const STEPS: u32 = 60;

/// What the gap along one normal tells about a stretch of time.
pub(crate) enum Held {
    /// It is positive, and proven not to fall below zero in between by more than the dip that is allowed.
    Through,
    /// It is positive at both ends; half the time may tell more.
    Unclear,
    /// It falls to zero, or may; it is positive until this time [s].
    Until(f64),
}

/// How surfaces move, and how exact the answer is to be.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Grade {
    /// Bound of the acceleration of one surface against the other [m/s2].
    pub bend: f64,
    /// A fall below zero by less than this may go unseen [m].
    pub dip: f64,
    /// A gap that counts as closed [m].
    pub enough: f64,
}

/// Follows the gap `at(t)` along a normal from `(time, gap)` to `end` [s].
pub(crate) fn hold(at: &impl Fn(f64) -> f64, start: (f64, f64), end: f64, grade: &Grade) -> Held {
    let last = at(end);
    if last <= 0.0 {
        return Held::Until(fall(at, start, (end, last), grade));
    }
    if grade.proves(start, (end, last)) {
        Held::Through
    } else {
        Held::Unclear
    }
}

impl Grade {
    /// Whether the gap cannot have fallen, or not by more than the dip, between two times at which it is positive.
    fn proves(&self, (t0, s0): (f64, f64), (t1, s1): (f64, f64)) -> bool {
        let span = t1 - t0;
        0.125 * self.bend * span * span - s0.min(s1) < self.dip
    }
}

/// Latest time found up to which the gap `at` is positive: from `low`, where it is, towards its first fall before `high`.
///
/// Each step goes to the root of the parabola that bounds the gap from below, so it cannot skip a touch. (Regula falsi
/// alone can: of a rod that comes round it finds the second pass.) It aims a little above zero, where rounding does
/// not matter. Where the parabola is far below the gap, a second step brings the other end nearer.
fn fall(at: &impl Fn(f64) -> f64, low: (f64, f64), end: (f64, f64), grade: &Grade) -> f64 {
    let (mut low, mut high) = (low, end);
    let aim = 0.5 * grade.enough;
    for _ in 0..STEPS {
        let ((t0, s0), (t1, s1)) = (low, high);
        let span = t1 - t0;
        if s0 <= grade.enough || span < 1e-12 {
            break;
        }
        let steep = (s0 - s1) / span + 0.5 * grade.bend * span;
        let root = steep * steep - 2.0 * grade.bend * (s0 - aim);
        if s1 > 0.0 && (root < 0.0 || steep <= 0.0 || grade.proves(low, high)) {
            (low, high) = (high, end);
            continue;
        }
        let t = t0 + 2.0 * (s0 - aim) / (steep + root.max(0.0).sqrt());
        if s1 > 0.0 && t >= t1 {
            (low, high) = (high, end);
            continue;
        }
        if !(t > t0 && t < t1) {
            break;
        }
        let s = at(t);
        if s <= 0.0 {
            high = (t, s);
            continue;
        }
        low = (t, s);
        if 0.125 * grade.bend * (t1 - t) * (t1 - t) > s {
            let nearer = t + (t1 - t) * (s / (s - s1).abs()).clamp(0.01, 0.5);
            high = (nearer, at(nearer));
        }
    }
    low.0
}

#[cfg(test)]
mod tests {
    use super::*;

    fn grade(bend: f64) -> Grade {
        Grade {
            bend,
            dip: 1e-9,
            enough: 1e-10,
        }
    }

    #[test]
    fn fall_finds_the_first_of_several_roots() {
        // Falls again and again, and rises between; bends by at most 400.
        let at = |t: f64| 0.02 + 0.04 * libm::cos(100.0 * t) - 0.04 * t;
        let first = (0..).map(|i| f64::from(i) * 1e-6).find(|t| at(*t) <= 0.0);
        let first = first.unwrap();
        assert!(at(1.5) < 0.0);
        let Held::Until(t) = hold(&at, (0.0, at(0.0)), 1.5, &grade(400.0)) else {
            panic!("it falls");
        };
        assert!((t - first).abs() < 2e-6, "{t} instead of {first}");
    }

    #[test]
    fn hold_never_goes_beyond_a_fall() {
        // All parabolas that bend by the bound or less: the first root in closed form.
        for k in 0..=40 {
            let bend = 50.0 * (f64::from(k) / 20.0 - 1.0);
            for speed in [-1.0, 0.0, 0.01, 1.0, 8.0] {
                let at = |t: f64| 1e-3 - speed * t + 0.5 * bend * t * t;
                let root = speed * speed - 2.0 * bend * 1e-3;
                let first = 2.0 * 1e-3 / (speed + root.max(0.0).sqrt());
                let falls = root >= 0.0 && first > 0.0 && first <= 0.1;
                match hold(&at, (0.0, 1e-3), 0.1, &grade(50.0)) {
                    Held::Until(t) => {
                        assert!(falls && t <= first + 1e-15, "{t} beyond {first}");
                        assert!(
                            at(t) <= 1e-10 || first - t < 1e-12,
                            "{} is left, bend {bend} speed {speed} t {t} first {first}",
                            at(t)
                        );
                    }
                    Held::Through => assert!(!falls, "it falls at {first}"),
                    Held::Unclear => {}
                }
            }
        }
    }
}
