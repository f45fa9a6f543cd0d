//! Intervals from the profile of a likelihood: the values of a coefficient that the rest can make up for.

use super::fit::Fit;
use super::newton::{EXACT, Start, maximise};
use super::rows::Rows;
use super::separation::Reach;
use super::tails::NORMAL_95;
use super::{firth, linear::Cholesky};

/// Doublings of the distance in which a bound is looked for; beyond them it counts as infinite.
const DOUBLINGS: usize = 12;
/// Steps in which a bound is closed in.
const STEPS: usize = 60;

/// An interval; an infinite bound is infinite.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Interval {
    /// Lower bound.
    pub low: f64,
    /// Upper bound.
    pub high: f64,
}

/// A point of a profile: twice what is lost there, and its derivative.
#[derive(Debug, Clone, Copy)]
struct Loss {
    loss: f64,
    slope: f64,
}

/// 95 % profile-likelihood intervals of every fitted column; where an estimate is infinite, the bound on its other side.
pub fn likelihood_intervals(fit: &Fit) -> Vec<Interval> {
    let columns = fit.rows.columns;
    let scale = fit.rows.largest();
    let free = |j: usize| (0..columns).filter(|&k| k != j).collect::<Vec<_>>();
    let finite: Vec<f64> = fit
        .estimate
        .iter()
        .map(|b| if b.is_finite() { *b } else { 0.0 })
        .collect();
    let interval = |j: usize| {
        let others = free(j);
        let mut begin = finite.clone();
        let mut profile = |value: f64| {
            begin[j] = value;
            let mut maximum = maximise(&fit.rows, &others, Start::At(&begin), EXACT);
            if !maximum.converged {
                // A far start may lead nowhere; the middle always leads on.
                let mut cold = vec![0.0; columns];
                cold[j] = value;
                let again = maximise(&fit.rows, &others, Start::At(&cold), EXACT);
                if again.sums.kernel > maximum.sums.kernel {
                    maximum = again;
                }
            }
            begin.copy_from_slice(&maximum.beta);
            Loss {
                loss: 2.0 * (fit.kernel - maximum.sums.kernel),
                slope: -2.0 * maximum.sums.gradient[j],
            }
        };
        match fit.separation.per_column[j] {
            Reach::Finite => {
                let low = bound(&mut profile, finite[j], -fit.error[j]);
                Interval {
                    low,
                    high: bound(&mut profile, finite[j], fit.error[j]),
                }
            }
            Reach::Plus => Interval {
                low: from_infinity(&mut profile, -1.0 / scale[j]),
                high: f64::INFINITY,
            },
            Reach::Minus => Interval {
                low: f64::NEG_INFINITY,
                high: from_infinity(&mut profile, 1.0 / scale[j]),
            },
            Reach::Either => Interval {
                low: f64::NEG_INFINITY,
                high: f64::INFINITY,
            },
        }
    };
    (0..columns).map(interval).collect()
}

/// 95 % profile intervals of the penalised likelihood, with the penalty of the full model.
pub fn penalised_intervals(rows: &Rows, full: &firth::Penalised) -> Vec<Interval> {
    let columns = rows.columns;
    let mut cholesky = Cholesky::default();
    if !cholesky.factor(&full.information, columns) {
        return vec![
            Interval {
                low: f64::NAN,
                high: f64::NAN
            };
            columns
        ];
    }
    let inverse = cholesky.inverse();
    let interval = |j: usize| {
        let others: Vec<usize> = (0..columns).filter(|&k| k != j).collect();
        let mut begin = full.beta.clone();
        let mut profile = |value: f64| {
            begin[j] = value;
            let maximum = firth::maximise_held(rows, &others, &begin, EXACT);
            begin.copy_from_slice(&maximum.beta);
            Loss {
                loss: 2.0 * (full.objective - maximum.objective),
                slope: -2.0 * maximum.score[j],
            }
        };
        let error = inverse[j * columns + j].sqrt();
        let low = bound(&mut profile, full.beta[j], -error);
        Interval {
            low,
            high: bound(&mut profile, full.beta[j], error),
        }
    };
    (0..columns).map(interval).collect()
}

/// Where the loss reaches the 95 % quantile, on the side of `error`'s sign; infinite if it never does.
fn bound(profile: &mut impl FnMut(f64) -> Loss, middle: f64, error: f64) -> f64 {
    let mut inside = middle;
    let mut distance = NORMAL_95 * error;
    for _ in 0..DOUBLINGS {
        let outside = middle + distance;
        let here = profile(outside);
        if !here.loss.is_finite() {
            break;
        }
        if here.loss >= NORMAL_95 * NORMAL_95 {
            return close_in(profile, inside, outside, here);
        }
        inside = outside;
        distance *= 2.0;
    }
    f64::INFINITY.copysign(error)
}

/// As [`bound`], for an estimate at infinity: the loss grows along `step`.
fn from_infinity(profile: &mut impl FnMut(f64) -> Loss, step: f64) -> f64 {
    let target = NORMAL_95 * NORMAL_95;
    let mut place = 0.0;
    let mut here = profile(place);
    let is_outside = here.loss >= target;
    let mut stride = if is_outside { -step } else { step };
    for _ in 0..2 * DOUBLINGS {
        let before = (place, here);
        place += stride;
        here = profile(place);
        if (here.loss >= target) != is_outside {
            let (inside, outside) = if is_outside {
                ((place, here), before)
            } else {
                (before, (place, here))
            };
            return close_in(profile, inside.0, outside.0, outside.1);
        }
        stride *= 2.0;
    }
    f64::INFINITY.copysign(step)
}

/// Newton's method on the root of the loss, which is nearly linear, kept between an inside and an outside.
fn close_in(
    profile: &mut impl FnMut(f64) -> Loss,
    mut inside: f64,
    mut outside: f64,
    at_outside: Loss,
) -> f64 {
    let (mut place, mut here) = (outside, at_outside);
    for _ in 0..STEPS {
        let root = here.loss.max(0.0).sqrt();
        let newton = place - (root - NORMAL_95) * 2.0 * root / here.slope;
        let (low, high) = (inside.min(outside), inside.max(outside));
        let next = if newton > low && newton < high {
            newton
        } else {
            0.5 * (low + high)
        };
        let is_settled = (next - place).abs() <= 1e-11 * (next.abs() + (high - low).abs());
        place = next;
        if is_settled {
            break;
        }
        here = profile(place);
        if here.loss >= NORMAL_95 * NORMAL_95 {
            outside = place;
        } else {
            inside = place;
        }
    }
    place
}
