//! Exact tests of small tables and intervals of proportions: who noticed which change (Table 4).

use super::tails::{self, NORMAL_95, beta_below, bisect};

/// Two tables count as equally probable within this share, as in R's `fisher.test`.
const TIE: f64 = 1e-7;
/// Level of the intervals' tails.
const TAIL: f64 = 0.025;

/// Logarithm of a factorial.
fn ln_factorial(n: u32) -> f64 {
    libm::lgamma(f64::from(n) + 1.0)
}

/// Fisher's exact test of a table with two columns and any number of rows, by Freeman and Halton (1951): the probability
/// of all tables with these margins that are no more probable than this one.
pub fn freeman_halton(rows: &[[u32; 2]]) -> f64 {
    let sizes: Vec<u32> = rows.iter().map(|row| row[0] + row[1]).collect();
    let yes: u32 = rows.iter().map(|row| row[1]).sum();
    let all: u32 = sizes.iter().sum();
    let total = ln_factorial(all) - ln_factorial(yes) - ln_factorial(all - yes);
    let weight = |size: u32, k: u32| ln_factorial(size) - ln_factorial(k) - ln_factorial(size - k);
    let observed: f64 = rows
        .iter()
        .zip(&sizes)
        .map(|(row, &size)| weight(size, row[1]))
        .sum::<f64>()
        - total;
    let limit = observed + libm::log1p(TIE);
    let mut sum = 0.0;
    visit(&sizes, yes, -total, &weight, &mut |log_probability| {
        if log_probability <= limit {
            sum += libm::exp(log_probability);
        }
    });
    sum.min(1.0)
}

/// Calls `each` with the logarithm of the probability of every table with these row sizes and `yes` in all.
fn visit(
    sizes: &[u32],
    yes: u32,
    so_far: f64,
    weight: &impl Fn(u32, u32) -> f64,
    each: &mut impl FnMut(f64),
) {
    let Some((&size, rest)) = sizes.split_first() else {
        if yes == 0 {
            each(so_far);
        }
        return;
    };
    let room: u32 = rest.iter().sum();
    for k in yes.saturating_sub(room)..=yes.min(size) {
        visit(rest, yes - k, so_far + weight(size, k), weight, each);
    }
}

/// Pearson's chi-squared of a table with two columns, with its degrees of freedom; `None` where a margin is empty.
pub fn pearson(rows: &[[u32; 2]]) -> Option<(f64, usize)> {
    let columns = [0, 1].map(|c| rows.iter().map(|row| f64::from(row[c])).sum::<f64>());
    let all = columns[0] + columns[1];
    let mut sum = 0.0;
    for row in rows {
        for (count, column) in row.iter().zip(columns) {
            let expected = f64::from(row[0] + row[1]) * column / all;
            sum += (f64::from(*count) - expected).powi(2) / expected;
        }
    }
    (sum.is_finite() && rows.len() > 1).then_some((sum, rows.len() - 1))
}

/// Fisher's test of two rows against each other.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Pair {
    /// Two-sided probability.
    pub p: f64,
    /// The same, with half of what is as probable as the table itself.
    pub mid_p: f64,
    /// Conditional maximum-likelihood odds ratio of the first column, first row over second.
    pub odds_ratio: f64,
    /// Its exact 95 % interval.
    pub odds_low: f64,
    /// Its exact 95 % interval.
    pub odds_high: f64,
}

/// Compares two rows of a table, as R's `fisher.test` does.
pub fn pair(a: [u32; 2], b: [u32; 2]) -> Pair {
    let table = Conditional::of(a, b);
    let null = table.probabilities(1.0);
    let own = null[table.place];
    let p: f64 = null.iter().filter(|p| **p <= own * (1.0 + TIE)).sum();
    let ties: f64 = null
        .iter()
        .filter(|p| **p <= own * (1.0 + TIE) && **p >= own * (1.0 - TIE))
        .sum();
    let at_least = |odds: f64| table.probabilities(odds)[table.place..].iter().sum::<f64>();
    let at_most = |odds: f64| {
        table.probabilities(odds)[..=table.place]
            .iter()
            .sum::<f64>()
    };
    let (is_lowest, is_highest) = (table.place == 0, table.place + 1 == null.len());
    Pair {
        p: p.min(1.0),
        mid_p: (p - 0.5 * ties).min(1.0),
        odds_ratio: match (is_lowest, is_highest) {
            (true, true) => f64::NAN,
            (true, false) => 0.0,
            (false, true) => f64::INFINITY,
            _ => odds_where(|odds| table.mean(odds) < table.place as f64),
        },
        odds_low: if is_lowest {
            0.0
        } else {
            odds_where(|odds| at_least(odds) < TAIL)
        },
        odds_high: if is_highest {
            f64::INFINITY
        } else {
            odds_where(|odds| at_most(odds) > TAIL)
        },
    }
}

/// The odds at which `is_below` turns false, found on a logarithmic scale.
fn odds_where(is_below: impl Fn(f64) -> bool) -> f64 {
    libm::exp(bisect(-60.0, 60.0, |log_odds| {
        is_below(libm::exp(log_odds))
    }))
}

/// The first cell of a 2 x 2 table, given the margins.
struct Conditional {
    /// Logarithms of the numbers of ways, from the smallest possible count on.
    ways: Vec<f64>,
    /// The observed count less the smallest possible one.
    place: usize,
}

impl Conditional {
    fn of(a: [u32; 2], b: [u32; 2]) -> Self {
        let (m, n, k) = (a[0] + a[1], b[0] + b[1], a[0] + b[0]);
        let low = k.saturating_sub(n);
        let choose = |n: u32, k: u32| ln_factorial(n) - ln_factorial(k) - ln_factorial(n - k);
        Conditional {
            ways: (low..=k.min(m))
                .map(|x| choose(m, x) + choose(n, k - x))
                .collect(),
            place: (a[0] - low) as usize,
        }
    }

    /// Probabilities of the counts where the odds ratio is `odds`.
    fn probabilities(&self, odds: f64) -> Vec<f64> {
        let log_odds = libm::log(odds);
        let logs: Vec<f64> = self
            .ways
            .iter()
            .enumerate()
            .map(|(x, way)| way + x as f64 * log_odds)
            .collect();
        let most = logs.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        let weights: Vec<f64> = logs.iter().map(|log| libm::exp(log - most)).collect();
        let sum: f64 = weights.iter().sum();
        weights.iter().map(|weight| weight / sum).collect()
    }

    fn mean(&self, odds: f64) -> f64 {
        self.probabilities(odds)
            .iter()
            .enumerate()
            .map(|(x, p)| x as f64 * p)
            .sum()
    }
}

/// Holm's correction (1979): each probability times the number of those that are no smaller, never below one before it.
pub fn holm(probabilities: &[f64]) -> Vec<f64> {
    let mut order: Vec<usize> = (0..probabilities.len()).collect();
    order.sort_by(|&a, &b| probabilities[a].total_cmp(&probabilities[b]));
    let mut corrected = vec![0.0; probabilities.len()];
    let mut most = 0.0_f64;
    for (rank, &i) in order.iter().enumerate() {
        most = most.max((probabilities[i] * (order.len() - rank) as f64).min(1.0));
        corrected[i] = most;
    }
    corrected
}

/// Bonferroni's correction.
pub fn bonferroni(probabilities: &[f64]) -> Vec<f64> {
    probabilities
        .iter()
        .map(|p| (p * probabilities.len() as f64).min(1.0))
        .collect()
}

/// Clopper and Pearson's exact 95 % interval (1934) of a proportion.
pub fn clopper_pearson(yes: u32, of: u32) -> [f64; 2] {
    let (x, n) = (f64::from(yes), f64::from(of));
    let low = if yes == 0 {
        0.0
    } else {
        beta_below(TAIL, x, n - x + 1.0)
    };
    [
        low,
        if yes == of {
            1.0
        } else {
            beta_below(1.0 - TAIL, x + 1.0, n - x)
        },
    ]
}

/// Wilson's 95 % interval (1927) of a proportion.
pub fn wilson(yes: u32, of: u32) -> [f64; 2] {
    let (n, z2) = (f64::from(of), NORMAL_95 * NORMAL_95);
    let p = f64::from(yes) / n;
    let middle = p + z2 / (2.0 * n);
    let half = NORMAL_95 * (p * (1.0 - p) / n + z2 / (4.0 * n * n)).sqrt();
    [middle - half, middle + half].map(|bound| (bound / (1.0 + z2 / n)).clamp(0.0, 1.0))
}

/// Jeffreys' equal-tailed 95 % interval of a proportion.
pub fn jeffreys(yes: u32, of: u32) -> [f64; 2] {
    let (a, b) = (f64::from(yes) + 0.5, f64::from(of - yes) + 0.5);
    let low = if yes == 0 {
        0.0
    } else {
        beta_below(TAIL, a, b)
    };
    [
        low,
        if yes == of {
            1.0
        } else {
            beta_below(1.0 - TAIL, a, b)
        },
    ]
}

/// The exact two-sided test of a proportion of one half.
pub fn against_half(yes: u32, of: u32) -> f64 {
    let log = |k: u32| {
        ln_factorial(of)
            - ln_factorial(k)
            - ln_factorial(of - k)
            - f64::from(of) * std::f64::consts::LN_2
    };
    let limit = log(yes) + libm::log1p(TIE);
    (0..=of)
        .map(log)
        .filter(|p| *p <= limit)
        .map(libm::exp)
        .sum::<f64>()
        .min(1.0)
}

/// The probability of a larger Pearson chi-squared.
pub fn pearson_p(value: f64, df: usize) -> Option<f64> {
    tails::chi_squared(value, df)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Fisher's lady: 3 of 4 cups right has 17 / 35 on either side together.
    #[test]
    fn pair_and_freeman_halton_agree_on_the_lady() {
        let expected = 17.0 / 35.0;
        assert!((pair([3, 1], [1, 3]).p - expected).abs() < 1e-13);
        assert!((freeman_halton(&[[3, 1], [1, 3]]) - expected).abs() < 1e-13);
    }

    #[test]
    fn holm_never_falls() {
        let corrected = holm(&[0.04, 0.01, 0.03]);
        for (found, expected) in corrected.iter().zip([0.06, 0.03, 0.06]) {
            assert!((found - expected).abs() < 1e-15);
        }
        assert_eq!(holm(&[0.9, 0.8]), [1.0, 1.0]);
    }

    #[test]
    fn intervals_hold_their_closed_forms_at_the_ends() {
        // Of none in n the upper bound is 1 - 0.025^(1/n).
        let [low, high] = clopper_pearson(0, 10);
        assert!(low == 0.0 && (high - (1.0 - 0.025_f64.powf(0.1))).abs() < 1e-13);
        let [low, high] = wilson(10, 10);
        let z2 = NORMAL_95 * NORMAL_95;
        assert!((low - 10.0 / (10.0 + z2)).abs() < 1e-14 && (high - 1.0).abs() < 1e-14);
        assert!((against_half(0, 6) - 0.03125).abs() < 1e-15);
    }
}
