//! Oil on a lane: friction that varies with the place on a surface.

use glam::DVec3;
use thiserror::Error;

use crate::pose::Pose;

/// Factors on the friction of a surface, on a grid across (x) and along (z) in the body's frame.
///
/// Between the grid's nodes the factor is bilinear, outside the grid it is 1. It multiplies what the pair has:
/// Coulomb's coefficient, or the friction rate of the paper's laws, which stays at 1 or below.
#[derive(Clone, Debug, PartialEq)]
pub struct OilPattern {
    from: [f64; 2],
    to: [f64; 2],
    counts: [usize; 2],
    factors: Vec<f64>,
}

/// A pattern that no surface can have.
#[derive(Clone, Debug, Error, PartialEq)]
pub enum OilError {
    /// The corners must be finite and differ in x and in z.
    #[error(
        "an oil pattern needs two corners in metres that differ in x and in z, not {0:?} and {1:?}"
    )]
    Corners([f64; 2], [f64; 2]),
    /// Every node has one factor, and a grid at least two nodes each way.
    #[error(
        "an oil pattern of {across} x {along} nodes, at least 2 each way, needs a factor for each, not {given}"
    )]
    Count {
        /// Nodes across.
        across: usize,
        /// Nodes along.
        along: usize,
        /// Factors.
        given: usize,
    },
    /// A factor is positive or zero, and finite.
    #[error("factor {0} of an oil pattern must be a finite number of 0 or more, not {1}")]
    Factor(usize, f64),
}

impl OilPattern {
    /// A pattern from the corner `from` to the corner `to`, each (x, z) [m] in the body's frame.
    ///
    /// `factors` are row by row: first those across at the z of `from`, left to right as the x of the corners go,
    /// last those at the z of `to`; `counts` are the nodes across and along.
    ///
    /// # Errors
    /// On corners that span nothing, on a number of factors that does not fit, and on a factor below zero or not finite.
    pub fn new(
        from: [f64; 2],
        to: [f64; 2],
        counts: [usize; 2],
        factors: Vec<f64>,
    ) -> Result<OilPattern, OilError> {
        let spans = |i: usize| from[i].is_finite() && to[i].is_finite() && from[i] != to[i];
        if !(spans(0) && spans(1)) {
            return Err(OilError::Corners(from, to));
        }
        let count = counts[0].checked_mul(counts[1]);
        if counts[0] < 2 || counts[1] < 2 || count != Some(factors.len()) {
            return Err(OilError::Count {
                across: counts[0],
                along: counts[1],
                given: factors.len(),
            });
        }
        let bad = |factor: &f64| !(factor.is_finite() && *factor >= 0.0);
        if let Some(place) = factors.iter().position(bad) {
            return Err(OilError::Factor(place, factors[place]));
        }
        Ok(OilPattern {
            from,
            to,
            counts,
            factors,
        })
    }

    /// Factor on the friction at (x, z) [m] in the body's frame.
    pub fn factor(&self, at: [f64; 2]) -> f64 {
        let share = |i: usize| (at[i] - self.from[i]) / (self.to[i] - self.from[i]);
        let (across, along) = (share(0), share(1));
        if !((0.0..=1.0).contains(&across) && (0.0..=1.0).contains(&along)) {
            return 1.0;
        }
        let cell = |share: f64, count: usize| {
            let place = share * (count - 1) as f64;
            let node = (place as usize).min(count - 2);
            (node, place - node as f64)
        };
        let (column, right) = cell(across, self.counts[0]);
        let (row, far) = cell(along, self.counts[1]);
        let between = |row: usize| {
            let node = row * self.counts[0] + column;
            // So that equal nodes give their factor to the bit.
            self.factors[node] + (self.factors[node + 1] - self.factors[node]) * right
        };
        let (near, next) = (between(row), between(row + 1));
        near + (next - near) * far
    }

    /// Factor at a point [m] in the world's frame, on a body at `pose`.
    pub(crate) fn factor_at(&self, pose: &Pose, point: DVec3) -> f64 {
        let local = pose.rotation.conjugate() * (point - pose.position);
        self.factor([local.x, local.z])
    }

    /// Whether it changes nothing anywhere.
    pub(crate) fn is_neutral(&self) -> bool {
        self.factors.iter().all(|factor| *factor == 1.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn pattern() -> OilPattern {
        // Down a lane: from the foul line at z = 0 to z = -12, from x = -0.5 to 0.5.
        let factors = vec![0.2, 0.4, 0.2, 0.4, 0.8, 0.4];
        OilPattern::new([-0.5, 0.0], [0.5, -12.0], [3, 2], factors).unwrap()
    }

    #[test]
    fn nodes_have_their_factors_and_places_between_them_the_mean() {
        let oil = pattern();
        for (at, want) in [
            ([-0.5, 0.0], 0.2),
            ([0.0, 0.0], 0.4),
            ([0.5, -12.0], 0.4),
            ([0.0, -12.0], 0.8),
            ([0.0, -6.0], 0.6),
            ([0.25, 0.0], 0.3),
            ([-0.25, -6.0], 0.45),
        ] {
            let factor = oil.factor(at);
            assert!((factor - want).abs() < 1e-15, "{factor} at {at:?}");
        }
    }

    #[test]
    fn outside_the_grid_nothing_changes() {
        for at in [[0.501, -3.0], [0.0, 0.001], [0.0, -12.001], [f64::NAN, 0.0]] {
            assert_eq!(pattern().factor(at), 1.0);
        }
    }

    #[test]
    fn bad_patterns_are_refused_in_a_sentence() {
        let refused = |from, to, counts, factors| {
            OilPattern::new(from, to, counts, factors)
                .unwrap_err()
                .to_string()
        };
        let ones = || vec![1.0; 4];
        let (from, to) = ([-0.5, 0.0], [0.5, -12.0]);
        assert!(refused(from, [-0.5, 1.0], [2, 2], ones()).contains("two corners"));
        assert!(refused(from, [f64::NAN, 1.0], [2, 2], ones()).contains("two corners"));
        assert!(refused(from, to, [2, 3], ones()).contains("2 x 3 nodes"));
        assert!(refused(from, to, [4, 1], ones()).contains("at least 2"));
        let negative = vec![1.0, 1.0, -0.1, 1.0];
        assert!(refused(from, to, [2, 2], negative).contains("factor 2"));
    }
}
