//! Firth's penalised likelihood (1993): finite estimates where maximum likelihood has none.
//!
//! What is maximised is the kernel plus half the logarithm of the determinant of X'WX. Heinze and Schemper (2002) is
//! the source of the tests: the coefficients tested are held, the penalty stays that of the full model.

use super::linear::Cholesky;
use super::newton::{Start, free_part};
use super::rows::{Rows, Sums, chance, dot};

/// Up to so many rows the exact second derivatives are used: their cost grows with the square of the rows.
const EXACT_ROWS: usize = 48;
/// Steps after which a fit gives up.
const MOST_STEPS: usize = 200;
/// Halvings of a step that does not gain.
const HALVINGS: usize = 12;
/// Farthest that a step moves a predictor through one column: the penalised likelihood is not concave everywhere.
const LONGEST: f64 = 2.0;

/// The penalised maximum that was found.
#[derive(Debug, Clone)]
pub struct Penalised {
    /// The coefficients.
    pub beta: Vec<f64>,
    /// Kernel plus penalty.
    pub objective: f64,
    /// X'WX there: its upper triangle.
    pub information: Vec<f64>,
    /// The score with the penalty's part, also of what is held.
    pub score: Vec<f64>,
    /// Whether the score has come to zero.
    pub converged: bool,
}

/// Maximises the penalised likelihood over the coefficients in `free`; the others stay as they begin (0 when cold).
pub fn maximise(rows: &Rows, free: &[usize], start: Start<'_>, exact: f64) -> Penalised {
    let mut state = State::new(rows);
    let mut trial = State::new(rows);
    state.begin(rows, free, start);
    let mut converged = free.is_empty();
    let mut scratch = Scratch::default();
    for _ in 0..MOST_STEPS {
        if converged || !scratch.direction(rows, &state, free) {
            break;
        }
        if scratch.decrement() < exact {
            converged = true;
        } else if !climb(rows, free, &scratch.direction, &mut state, &mut trial) {
            converged = scratch.decrement() < 1e-12;
            break;
        }
    }
    Penalised {
        beta: state.beta,
        objective: state.objective,
        information: state.sums.information,
        score: state.score,
        converged,
    }
}

/// The better of two searches that hold what is not `free` as in `begin`: one from there, one with the rest at 0.
///
/// With coefficients held the penalised likelihood of few rows may have several maxima.
pub fn maximise_held(rows: &Rows, free: &[usize], begin: &[f64], exact: f64) -> Penalised {
    let mut middle = begin.to_vec();
    free.iter().for_each(|&j| middle[j] = 0.0);
    let near = maximise(rows, free, Start::At(begin), exact);
    let far = maximise(rows, free, Start::At(&middle), exact);
    if far.objective > near.objective {
        far
    } else {
        near
    }
}

fn climb(
    rows: &Rows,
    free: &[usize],
    direction: &[f64],
    state: &mut State,
    trial: &mut State,
) -> bool {
    let slack = 1e-13 * (1.0 + state.objective.abs());
    let mut factor = 1.0;
    for _ in 0..HALVINGS {
        trial.beta.copy_from_slice(&state.beta);
        for (&j, step) in free.iter().zip(direction) {
            trial.beta[j] += factor * step;
        }
        if trial.evaluate(rows) && trial.objective >= state.objective - slack {
            std::mem::swap(state, trial);
            return true;
        }
        factor *= 0.5;
    }
    false
}

/// All that is known at some coefficients.
struct State {
    beta: Vec<f64>,
    sums: Sums,
    /// Probability and leverage of each row.
    p: Vec<f64>,
    leverage: Vec<f64>,
    inverse: Vec<f64>,
    cholesky: Cholesky,
    /// The largest size of each column.
    largest: Vec<f64>,
    score: Vec<f64>,
    objective: f64,
}

impl State {
    fn new(rows: &Rows) -> Self {
        State {
            beta: vec![0.0; rows.columns],
            sums: Sums::default(),
            p: vec![0.0; rows.len()],
            leverage: vec![0.0; rows.len()],
            inverse: Vec::new(),
            cholesky: Cholesky::default(),
            largest: rows.largest(),
            score: vec![0.0; rows.columns],
            objective: f64::NEG_INFINITY,
        }
    }

    fn begin(&mut self, rows: &Rows, free: &[usize], start: Start<'_>) {
        if let Start::At(beta) = start {
            self.beta.copy_from_slice(beta);
        } else {
            // One cycle of R's start draws to the middle, as the penalty does.
            rows.first_cycle(&mut self.sums);
            let mut part = Vec::new();
            free_part(&self.sums.information, rows.columns, free, &mut part);
            if self.cholesky.factor(&part, free.len()) {
                let mut step: Vec<f64> = free.iter().map(|&j| self.sums.gradient[j]).collect();
                self.cholesky.solve(&mut step);
                free.iter()
                    .zip(step)
                    .for_each(|(&j, step)| self.beta[j] = step);
            }
        }
        if !self.evaluate(rows) {
            self.beta.iter_mut().for_each(|b| *b = 0.0);
            self.evaluate(rows);
        }
    }

    /// Objective, score and leverages at `beta`; false where the information is singular.
    fn evaluate(&mut self, rows: &Rows) -> bool {
        rows.sums(&self.beta, &mut self.sums);
        if !self.cholesky.factor(&self.sums.information, rows.columns) {
            return false;
        }
        self.objective = self.sums.kernel + 0.5 * self.cholesky.log_determinant();
        self.inverse = self.cholesky.inverse();
        self.score.copy_from_slice(&self.sums.gradient);
        for i in 0..rows.len() {
            let row = rows.row(i);
            let at = chance(dot(row, &self.beta));
            let h = rows.asked[i] * at.spread * quadratic(&self.inverse, row);
            (self.p[i], self.leverage[i]) = (at.p, h);
            let extra = h * (0.5 - at.p);
            self.score
                .iter_mut()
                .zip(row)
                .for_each(|(s, x)| *s += extra * x);
        }
        true
    }
}

/// x' A x of a symmetric A.
fn quadratic(matrix: &[f64], x: &[f64]) -> f64 {
    let rows = matrix.chunks_exact(x.len().max(1)).enumerate();
    rows.map(|(j, row)| x[j] * (row[j] * x[j] + 2.0 * dot(&row[j + 1..], &x[j + 1..])))
        .sum()
}

/// The step, and what it is made from.
#[derive(Default)]
struct Scratch {
    curvature: Vec<f64>,
    part: Vec<f64>,
    gradient: Vec<f64>,
    direction: Vec<f64>,
    cholesky: Cholesky,
}

impl Scratch {
    /// Newton's step over the free coefficients; false if there is none.
    fn direction(&mut self, rows: &Rows, state: &State, free: &[usize]) -> bool {
        self.gradient.clear();
        self.gradient.extend(free.iter().map(|&j| state.score[j]));
        let mut is_definite = false;
        if rows.len() <= EXACT_ROWS {
            self.exact(rows, state);
            is_definite = self.factor(rows.columns, free);
        }
        if !is_definite {
            self.augmented(rows, state);
            is_definite = self.factor(rows.columns, free);
        }
        self.direction.clear();
        self.direction.extend(&self.gradient);
        if is_definite {
            self.cholesky.solve(&mut self.direction);
            self.shorten(state, free);
        }
        is_definite
    }

    fn factor(&mut self, columns: usize, free: &[usize]) -> bool {
        free_part(&self.curvature, columns, free, &mut self.part);
        self.cholesky.factor(&self.part, free.len())
    }

    /// The squared length of the step, in standard errors.
    fn decrement(&self) -> f64 {
        dot(&self.direction, &self.gradient)
    }

    fn shorten(&mut self, state: &State, free: &[usize]) {
        let moves = free
            .iter()
            .zip(&self.direction)
            .map(|(&j, step)| step.abs() * state.largest[j]);
        let longest = moves.fold(0.0, f64::max);
        if longest > LONGEST {
            self.direction
                .iter_mut()
                .for_each(|step| *step *= LONGEST / longest);
        }
    }

    /// The information of data to which each row's leverage is added as answers, half of them high: what the score
    /// would have as its derivative if leverages did not change.
    fn augmented(&mut self, rows: &Rows, state: &State) {
        self.weigh(rows, |i| {
            let p = state.p[i];
            (rows.asked[i] + state.leverage[i]) * p * (1.0 - p)
        });
    }

    /// The exact second derivatives, with their sign turned.
    fn exact(&mut self, rows: &Rows, state: &State) {
        let (many, columns) = (rows.len(), rows.columns);
        self.weigh(rows, |i| {
            let spread = state.p[i] * (1.0 - state.p[i]);
            rows.asked[i] * spread - 0.5 * state.leverage[i] * (1.0 - 6.0 * spread)
        });
        // The part in which the inverse of the information changes: half of X' S X, S_ij = w_i' w_j' (x_i' I^-1 x_j)^2.
        let slope = |i: usize| {
            let p = state.p[i];
            rows.asked[i] * p * (1.0 - p) * (1.0 - 2.0 * p)
        };
        let mut turned = vec![0.0; columns];
        let mut product = vec![0.0; columns];
        for i in 0..many {
            for (t, inverse) in turned.iter_mut().zip(state.inverse.chunks_exact(columns)) {
                *t = dot(inverse, rows.row(i));
            }
            product.fill(0.0);
            for k in 0..many {
                let between = dot(&turned, rows.row(k));
                let share = slope(k) * between * between;
                product
                    .iter_mut()
                    .zip(rows.row(k))
                    .for_each(|(t, x)| *t += share * x);
            }
            let weight = 0.5 * slope(i);
            for (j, x) in rows.row(i).iter().enumerate() {
                let target = &mut self.curvature[j * columns + j..(j + 1) * columns];
                target
                    .iter_mut()
                    .zip(&product[j..])
                    .for_each(|(sum, t)| *sum += weight * x * t);
            }
        }
    }

    fn weigh(&mut self, rows: &Rows, weight: impl Fn(usize) -> f64) {
        let columns = rows.columns;
        self.curvature.clear();
        self.curvature.resize(columns * columns, 0.0);
        for i in 0..rows.len() {
            let (row, weight) = (rows.row(i), weight(i));
            for j in 0..columns {
                let weighted = weight * row[j];
                let target = &mut self.curvature[j * columns + j..(j + 1) * columns];
                target
                    .iter_mut()
                    .zip(&row[j..])
                    .for_each(|(sum, x)| *sum += weighted * x);
            }
        }
    }
}
