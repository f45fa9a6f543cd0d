//! What is fitted: for each row its explanatory values, how many answers were high, and of how many.

use std::ops::Range;

/// Rows that are summed as one piece; sums are added piece by piece, so that their order never depends on threads.
const PIECE: usize = 16_384;

/// Rows of a binomial regression.
#[derive(Debug, Clone, Default)]
pub struct Rows {
    /// Number of explanatory columns.
    pub columns: usize,
    /// The explanatory values, row by row.
    pub x: Vec<f64>,
    /// High answers of each row, 0 to its `asked`.
    pub high: Vec<f64>,
    /// Answers of each row, above zero.
    pub asked: Vec<f64>,
}

/// What one pass over the rows adds up, at some coefficients.
#[derive(Debug, Clone, Default)]
pub struct Sums {
    /// Sum of y eta - n log(1 + exp eta).
    pub kernel: f64,
    /// X'(y - n p).
    pub gradient: Vec<f64>,
    /// X'WX with W = n p (1 - p): its upper triangle, rows one after the other.
    pub information: Vec<f64>,
}

impl Sums {
    fn reset(&mut self, columns: usize) {
        self.kernel = 0.0;
        self.gradient.clear();
        self.gradient.resize(columns, 0.0);
        self.information.clear();
        self.information.resize(columns * columns, 0.0);
    }

    fn add(&mut self, other: &Sums) {
        self.kernel += other.kernel;
        add_to(&mut self.gradient, &other.gradient);
        add_to(&mut self.information, &other.information);
    }
}

/// Adds the rows, each times its residual, to the gradient, and their squares, each times its weight, to the information.
#[inline]
fn add_weighted<const N: usize>(rows: [&[f64]; N], each: [(f64, f64); N], sums: &mut Sums) {
    let columns = sums.gradient.len();
    let rows = rows.map(|row| &row[..columns]);
    for j in 0..columns {
        let weighted: [f64; N] = std::array::from_fn(|k| each[k].1 * rows[k][j]);
        for k in 0..N {
            sums.gradient[j] += each[k].0 * rows[k][j];
        }
        let target = &mut sums.information[j * columns + j..(j + 1) * columns];
        let parts = rows.map(|row| &row[j..]);
        for (l, sum) in target.iter_mut().enumerate() {
            let mut more = 0.0;
            for k in 0..N {
                more += weighted[k] * parts[k][l];
            }
            *sum += more;
        }
    }
}

fn add_to(sums: &mut [f64], others: &[f64]) {
    for (sum, other) in sums.iter_mut().zip(others) {
        *sum += other;
    }
}

/// What a row's linear predictor says: log(1 + exp eta), p and p (1 - p), without overflow or cancellation.
#[derive(Debug, Clone, Copy)]
pub struct Chance {
    /// log(1 + exp eta).
    pub log_sum: f64,
    /// 1 / (1 + exp -eta).
    pub p: f64,
    /// p (1 - p).
    pub spread: f64,
}

/// The chance of a high answer at a linear predictor (Appendix B, Eq. (2)).
pub fn chance(eta: f64) -> Chance {
    let small = libm::exp(-eta.abs());
    let share = 1.0 / (1.0 + small);
    Chance {
        log_sum: eta.max(0.0) + libm::log1p(small),
        p: if eta >= 0.0 { share } else { small * share },
        spread: small * share * share,
    }
}

impl Rows {
    /// How many rows there are.
    pub fn len(&self) -> usize {
        self.high.len()
    }

    /// Whether there is no row.
    pub fn is_empty(&self) -> bool {
        self.high.is_empty()
    }

    /// The explanatory values of row `i`.
    pub fn row(&self, i: usize) -> &[f64] {
        &self.x[i * self.columns..(i + 1) * self.columns]
    }

    /// The largest size of a value of each column.
    pub fn largest(&self) -> Vec<f64> {
        let mut largest = vec![0.0_f64; self.columns];
        for row in self.x.chunks_exact(self.columns.max(1)) {
            for (most, x) in largest.iter_mut().zip(row) {
                *most = most.max(x.abs());
            }
        }
        largest
    }

    /// These columns of these rows.
    pub fn part(&self, columns: &[usize], rows: impl Iterator<Item = usize>) -> Rows {
        let mut part = Rows {
            columns: columns.len(),
            ..Rows::default()
        };
        for i in rows {
            let row = self.row(i);
            part.x.extend(columns.iter().map(|&j| row[j]));
            part.high.push(self.high[i]);
            part.asked.push(self.asked[i]);
        }
        part
    }

    /// These columns of all rows.
    pub fn with_columns(&self, columns: &[usize]) -> Rows {
        self.part(columns, 0..self.len())
    }

    /// The linear predictor of each row.
    pub fn predictors(&self, beta: &[f64]) -> Vec<f64> {
        (0..self.len()).map(|i| dot(self.row(i), beta)).collect()
    }

    /// Kernel, gradient and information at `beta`.
    pub fn sums(&self, beta: &[f64], sums: &mut Sums) {
        sums.reset(self.columns);
        self.in_pieces(sums, |range, sums| {
            self.add_rows(range, sums, |i, sums| {
                let eta = dot(self.row(i), beta);
                let at = chance(eta);
                sums.kernel += self.high[i] * eta - self.asked[i] * at.log_sum;
                let residual = self.high[i] - self.asked[i] * at.p;
                (residual, self.asked[i] * at.spread)
            });
        });
    }

    /// The weighted least squares of R's first cycle: at p = (y + 1/2) / (n + 1), as if nothing were known.
    ///
    /// The gradient holds X'Wz with z the logit of that p, corrected to first order; columns whose coefficient is held
    /// are expected to be held at zero.
    pub fn first_cycle(&self, sums: &mut Sums) {
        sums.reset(self.columns);
        self.in_pieces(sums, |range, sums| {
            self.add_rows(range, sums, |i, _| {
                let (y, n) = (self.high[i], self.asked[i]);
                let p = (y + 0.5) / (n + 1.0);
                let weight = n * p * (1.0 - p);
                (weight * libm::log(p / (1.0 - p)) + y - n * p, weight)
            });
        });
    }

    /// Adds these rows to gradient and information, with the residual and weight that `of` gives for each.
    ///
    /// Four rows at a time, so that each sum is loaded and stored once for them.
    fn add_rows(
        &self,
        range: Range<usize>,
        sums: &mut Sums,
        mut of: impl FnMut(usize, &mut Sums) -> (f64, f64),
    ) {
        let fours = range.start..range.end - range.len() % 4;
        for first in fours.clone().step_by(4) {
            let each = [0, 1, 2, 3].map(|k| of(first + k, sums));
            let rows = [0, 1, 2, 3].map(|k| self.row(first + k));
            add_weighted(rows, each, sums);
        }
        for i in fours.end..range.end {
            let each = [of(i, sums)];
            add_weighted([self.row(i)], each, sums);
        }
    }

    /// Adds up `add` over all rows: in one piece, or in pieces that the threads share, in the order of the pieces.
    fn in_pieces(&self, sums: &mut Sums, add: impl Fn(Range<usize>, &mut Sums) + Sync) {
        let pieces = self.len().div_ceil(PIECE);
        let range = |piece: usize| piece * PIECE..((piece + 1) * PIECE).min(self.len());
        if pieces <= 1 {
            return add(0..self.len(), sums);
        }
        let parts = super::parallel::map(pieces, |piece| {
            let mut part = Sums::default();
            part.reset(self.columns);
            add(range(piece), &mut part);
            part
        });
        for part in &parts {
            sums.add(part);
        }
    }
}

/// The inner product.
#[inline]
pub fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn chance_is_right_far_out_and_at_zero() {
        let middle = chance(0.0);
        assert_eq!((middle.p, middle.spread), (0.5, 0.25));
        assert!((middle.log_sum - std::f64::consts::LN_2).abs() < 1e-15);
        let (low, high) = (chance(-800.0), chance(800.0));
        assert_eq!((low.p, low.log_sum), (0.0, 0.0));
        assert_eq!((high.p, high.log_sum), (1.0, 800.0));
        assert!((chance(-30.0).spread / 9.357_622_968_839_3e-14 - 1.0).abs() < 1e-12);
    }

    /// A chunked sum over many rows is the sum over few of them, as often.
    #[test]
    fn sums_do_not_depend_on_how_many_pieces_there_are() {
        let few = Rows {
            columns: 2,
            x: vec![1.0, 0.5, 1.0, -2.0, 1.0, 3.0],
            high: vec![1.0, 0.0, 5.0],
            asked: vec![6.0; 3],
        };
        let times = 2 * PIECE;
        let many = few.part(&[0, 1], (0..3 * times).map(|i| i % 3));
        let (mut one, mut all) = (Sums::default(), Sums::default());
        few.sums(&[0.3, -0.7], &mut one);
        many.sums(&[0.3, -0.7], &mut all);
        let mut pairs = one
            .gradient
            .iter()
            .zip(&all.gradient)
            .chain(one.information.iter().zip(&all.information));
        assert!(pairs.all(|(a, b)| (a * times as f64 - b).abs() <= 1e-9 * b.abs()));
        assert!((one.kernel * times as f64 / all.kernel - 1.0).abs() < 1e-12);
    }
}
