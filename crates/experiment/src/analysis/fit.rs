//! A binomial regression as it should be reported: aliased columns out, separation found, and what is infinite said so.

use super::linear::{Aliases, Cholesky, aliases};
use super::newton::{EXACT, Start, maximise};
use super::rows::{Rows, chance, dot};
use super::separation::{Kind, Reach, Separation, separation};

/// A maximum-likelihood fit, or its limit where some estimates are infinite.
#[derive(Debug, Clone)]
pub struct Fit {
    /// Which columns were fitted and which are aliased with them.
    pub aliases: Aliases,
    /// The rows with the fitted columns alone.
    pub rows: Rows,
    /// What separates them.
    pub separation: Separation,
    /// Estimate of each fitted column; infinite, or `NAN` where the sign is not determined.
    pub estimate: Vec<f64>,
    /// Converged standard error of each fitted column; `NAN` where the estimate is infinite.
    pub error: Vec<f64>,
    /// Sum of y eta - n log(1 + exp eta): its supremum.
    pub kernel: f64,
    /// The deviance: its infimum.
    pub deviance: f64,
    /// The linear predictor of each row, infinite where it is separated.
    pub predictors: Vec<f64>,
    /// Upper triangle of X'WX of the rows that are not separated, over `estimable`.
    pub information: Vec<f64>,
    /// The fitted columns that are independent on the rows that are not separated.
    pub estimable: Vec<usize>,
    /// Whether the iterations ended as they should.
    pub converged: bool,
}

impl Fit {
    /// Fits `rows`.
    pub fn of(rows: &Rows) -> Fit {
        let aliases = aliases(&rows.x, rows.columns);
        let kept = rows.with_columns(&aliases.kept);
        let separation = separation(&kept);
        let rest: Vec<usize> = (0..kept.len())
            .filter(|&i| !separation.is_separated[i])
            .collect();
        if separation.kind == Kind::None {
            let estimable = (0..kept.columns).collect();
            return Fit::finish(aliases, None, kept, separation, estimable);
        }
        // In the limit the separated rows are fitted exactly; the others decide what stays finite (Geyer 2009).
        let all: Vec<usize> = (0..kept.columns).collect();
        let left = kept.part(&all, rest.into_iter());
        let estimable = super::linear::aliases(&left.x, left.columns).kept;
        let left = left.with_columns(&estimable);
        Fit::finish(aliases, Some(left), kept, separation, estimable)
    }

    /// Fits `left`, or all of `rows`, over the columns `estimable`.
    fn finish(
        aliases: Aliases,
        left: Option<Rows>,
        rows: Rows,
        separation: Separation,
        estimable: Vec<usize>,
    ) -> Fit {
        let target = left.as_ref().unwrap_or(&rows);
        let free: Vec<usize> = (0..target.columns).collect();
        let maximum = maximise(target, &free, Start::Cold, EXACT);
        let mut estimate = vec![0.0; rows.columns];
        let mut error = vec![f64::NAN; rows.columns];
        let mut cholesky = Cholesky::default();
        let is_regular = cholesky.factor(&maximum.sums.information, target.columns);
        let inverse = if is_regular {
            cholesky.inverse()
        } else {
            vec![f64::NAN; target.columns * target.columns]
        };
        for (a, &j) in estimable.iter().enumerate() {
            estimate[j] = maximum.beta[a];
            error[j] = inverse[a * target.columns + a].sqrt();
        }
        let mut fit = Fit {
            aliases,
            predictors: rows.predictors(&estimate),
            rows,
            estimate,
            error,
            kernel: maximum.sums.kernel,
            deviance: 0.0,
            information: maximum.sums.information,
            estimable,
            converged: maximum.converged && is_regular,
            separation,
        };
        fit.put_infinities();
        fit.deviance = 2.0 * (saturated(&fit.rows) - fit.kernel);
        fit
    }

    fn put_infinities(&mut self) {
        for (j, reach) in self.separation.per_column.iter().enumerate() {
            let infinite = match reach {
                Reach::Finite => continue,
                Reach::Plus => f64::INFINITY,
                Reach::Minus => f64::NEG_INFINITY,
                Reach::Either => f64::NAN,
            };
            (self.estimate[j], self.error[j]) = (infinite, f64::NAN);
        }
        for (i, is) in self.separation.is_separated.iter().enumerate() {
            if *is {
                self.predictors[i] = if self.rows.high[i] > 0.0 {
                    f64::INFINITY
                } else {
                    f64::NEG_INFINITY
                };
            }
        }
    }

    /// How many columns are independent.
    pub fn rank(&self) -> usize {
        self.aliases.kept.len()
    }

    /// Residual degrees of freedom.
    pub fn df(&self) -> usize {
        self.rows.len() - self.rank()
    }

    /// Whether every estimate is finite.
    pub fn is_valid(&self) -> bool {
        self.separation.kind == Kind::None && self.converged
    }

    /// Fitted probability of each row.
    pub fn probabilities(&self) -> Vec<f64> {
        self.predictors
            .iter()
            .map(|&eta| probability(eta))
            .collect()
    }

    /// Diagonal of the hat matrix; 0 for separated rows, which no longer weigh.
    pub fn leverage(&self) -> Vec<f64> {
        let mut cholesky = Cholesky::default();
        if !cholesky.factor(&self.information, self.estimable.len()) {
            return vec![f64::NAN; self.rows.len()];
        }
        let mut part = vec![0.0; self.estimable.len()];
        let leverage = |(i, &eta): (usize, &f64)| {
            if eta.is_infinite() {
                return 0.0;
            }
            let row = self.rows.row(i);
            part.iter_mut()
                .zip(&self.estimable)
                .for_each(|(p, &j)| *p = row[j]);
            cholesky.half_solve(&mut part);
            self.rows.asked[i] * chance(eta).spread * dot(&part, &part)
        };
        self.predictors.iter().enumerate().map(leverage).collect()
    }

    /// (y - n p) / sqrt(n p (1 - p)) of each row; 0 where the limit is exact.
    pub fn pearson_residuals(&self) -> Vec<f64> {
        let residual = |(i, &eta): (usize, &f64)| {
            if eta.is_infinite() {
                return 0.0;
            }
            let at = chance(eta);
            (self.rows.high[i] - self.rows.asked[i] * at.p)
                / (self.rows.asked[i] * at.spread).sqrt()
        };
        self.predictors.iter().enumerate().map(residual).collect()
    }

    /// The signed root of each row's part of the deviance.
    pub fn deviance_residuals(&self) -> Vec<f64> {
        let residual = |(i, &eta): (usize, &f64)| {
            let (y, n) = (self.rows.high[i], self.rows.asked[i]);
            let mean = n * probability(eta);
            let part = 2.0 * (term(y, mean) + term(n - y, n - mean));
            part.max(0.0).sqrt().copysign(y - mean)
        };
        self.predictors.iter().enumerate().map(residual).collect()
    }

    /// Pearson's chi-squared.
    pub fn pearson(&self) -> f64 {
        self.pearson_residuals().iter().map(|r| r * r).sum()
    }

    /// The logarithm of the likelihood, with the binomial coefficients.
    pub fn log_likelihood(&self) -> f64 {
        self.kernel + log_coefficients(&self.rows)
    }
}

fn probability(eta: f64) -> f64 {
    if eta.is_infinite() {
        f64::from(eta > 0.0)
    } else {
        chance(eta).p
    }
}

/// y log(y / mean), 0 at y = 0.
fn term(y: f64, mean: f64) -> f64 {
    if y > 0.0 {
        y * libm::log(y / mean)
    } else {
        0.0
    }
}

/// The kernel of a model with a parameter for each row.
pub fn saturated(rows: &Rows) -> f64 {
    let pairs = rows.high.iter().zip(&rows.asked);
    pairs.map(|(&y, &n)| term(y, n) + term(n - y, n)).sum()
}

/// The sum of the logarithms of the binomial coefficients.
pub fn log_coefficients(rows: &Rows) -> f64 {
    let ln_factorial = |x: f64| libm::lgamma(x + 1.0);
    let pairs = rows.high.iter().zip(&rows.asked);
    pairs
        .map(|(&y, &n)| ln_factorial(n) - ln_factorial(y) - ln_factorial(n - y))
        .sum()
}

/// Deviance of a model with a constant alone.
pub fn null_deviance(rows: &Rows) -> f64 {
    let (high, asked) = (
        rows.high.iter().sum::<f64>(),
        rows.asked.iter().sum::<f64>(),
    );
    2.0 * (saturated(rows) - term(high, asked) - term(asked - high, asked))
}
