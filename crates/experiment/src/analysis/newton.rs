//! Maximum likelihood by Newton's method, which for the logit is iteratively reweighted least squares.

use super::linear::Cholesky;
use super::rows::{Rows, Sums};

/// Steps after which a fit gives up; a fit whose maximum exists takes 5 to 10.
const MOST_STEPS: usize = 60;
/// Farthest that a step moves a predictor through one column: beyond, a row may be lost where nothing weighs any more.
const LONGEST: f64 = 6.0;
/// Halvings of a step that does not gain.
const HALVINGS: usize = 12;

/// Where a fit begins.
#[derive(Debug, Clone, Copy)]
pub enum Start<'a> {
    /// With R's first cycle, where every count is drawn to the middle by half an answer.
    Cold,
    /// At these coefficients.
    At(&'a [f64]),
}

/// How exact a fit has to be: the squared length of the last step, in standard errors.
pub const EXACT: f64 = 1e-20;

/// How exact a fit has to be where thousands of data sets are simulated.
pub const LOOSE: f64 = 1e-7;

/// The supremum of the kernel over the coefficients in `free`, others at zero, to within about [`LOOSE`]: also where
/// columns are aliased or estimates infinite. Begins at `begin`, if given.
pub fn supremum(rows: &Rows, free: &[usize], begin: Option<&[f64]>) -> Maximum {
    let start = begin.map_or(Start::Cold, Start::At);
    let maximum = maximise(rows, free, start, LOOSE);
    if maximum.converged {
        return maximum;
    }
    let part = rows.with_columns(free);
    let aliases = super::linear::aliases(&part.x, part.columns);
    if aliases.aliased.is_empty() {
        return maximum;
    }
    let kept: Vec<usize> = aliases.kept.iter().map(|&k| free[k]).collect();
    maximise(rows, &kept, Start::Cold, LOOSE)
}

/// The maximum that was found.
#[derive(Debug, Clone)]
pub struct Maximum {
    /// The coefficients.
    pub beta: Vec<f64>,
    /// Kernel, gradient and information there.
    pub sums: Sums,
    /// Whether the last step was short enough; false where there is no maximum.
    pub converged: bool,
}

/// Maximises the likelihood over the coefficients in `free`; the others stay as they begin (0 when cold).
pub fn maximise(rows: &Rows, free: &[usize], start: Start<'_>, exact: f64) -> Maximum {
    let mut work = Work::new(rows, free);
    let mut beta = vec![0.0; rows.columns];
    match start {
        Start::At(begin) => beta.copy_from_slice(begin),
        Start::Cold => {
            rows.first_cycle(&mut work.sums);
            if work.direction() {
                work.step(&mut beta, 1.0);
            }
        }
    }
    rows.sums(&beta, &mut work.sums);
    let mut converged = free.is_empty();
    for _ in 0..MOST_STEPS {
        if converged || !work.direction() {
            break;
        }
        let decrement = work.decrement;
        if decrement < exact {
            converged = true;
        } else if !climb(rows, &mut work, &mut beta) {
            // Rounding alone is left to gain.
            converged = decrement < 1e-12;
            break;
        }
    }
    Maximum {
        beta,
        sums: work.sums,
        converged,
    }
}

/// Goes along the step as far as the likelihood does not fall; false if it falls on all of it.
fn climb(rows: &Rows, work: &mut Work<'_>, beta: &mut Vec<f64>) -> bool {
    let before = work.sums.kernel;
    let slack = 1e-13 * (1.0 + before.abs());
    let mut factor = 1.0;
    for _ in 0..HALVINGS {
        work.trial.copy_from_slice(beta);
        for (&j, step) in work.free.iter().zip(&work.direction) {
            work.trial[j] += factor * step;
        }
        rows.sums(&work.trial, &mut work.trial_sums);
        if work.trial_sums.kernel >= before - slack {
            std::mem::swap(beta, &mut work.trial);
            std::mem::swap(&mut work.sums, &mut work.trial_sums);
            return true;
        }
        factor *= 0.5;
    }
    false
}

/// What a fit needs beside its coefficients, made once.
struct Work<'a> {
    free: &'a [usize],
    columns: usize,
    sums: Sums,
    trial: Vec<f64>,
    trial_sums: Sums,
    direction: Vec<f64>,
    gradient: Vec<f64>,
    /// The squared length of the step before it was shortened, in standard errors.
    decrement: f64,
    /// The largest size of each column.
    largest: Vec<f64>,
    cholesky: Cholesky,
    information: Vec<f64>,
}

impl<'a> Work<'a> {
    fn new(rows: &Rows, free: &'a [usize]) -> Self {
        Work {
            free,
            columns: rows.columns,
            sums: Sums::default(),
            trial: vec![0.0; rows.columns],
            trial_sums: Sums::default(),
            direction: vec![0.0; free.len()],
            gradient: vec![0.0; free.len()],
            decrement: 0.0,
            largest: rows.largest(),
            cholesky: Cholesky::default(),
            information: Vec::new(),
        }
    }

    /// Newton's step over the free coefficients; false where the information is singular.
    fn direction(&mut self) -> bool {
        let size = self.free.len();
        for (to, &j) in self.gradient.iter_mut().zip(self.free) {
            *to = self.sums.gradient[j];
        }
        let definite = if size == self.columns {
            self.cholesky.factor(&self.sums.information, size)
        } else {
            free_part(
                &self.sums.information,
                self.columns,
                self.free,
                &mut self.information,
            );
            self.cholesky.factor(&self.information, size)
        };
        self.direction.copy_from_slice(&self.gradient);
        if definite {
            self.cholesky.solve(&mut self.direction);
            self.decrement = super::rows::dot(&self.direction, &self.gradient);
            let moves = self
                .free
                .iter()
                .zip(&self.direction)
                .map(|(&j, step)| step.abs() * self.largest[j]);
            let longest = moves.fold(0.0, f64::max);
            if longest > LONGEST {
                self.direction
                    .iter_mut()
                    .for_each(|step| *step *= LONGEST / longest);
            }
        }
        definite
    }

    fn step(&self, beta: &mut [f64], factor: f64) {
        for (&j, step) in self.free.iter().zip(&self.direction) {
            beta[j] += factor * step;
        }
    }
}

/// The upper triangle of the rows and columns `free` of a symmetric matrix whose upper triangle is given.
pub fn free_part(matrix: &[f64], columns: usize, free: &[usize], part: &mut Vec<f64>) {
    part.clear();
    part.resize(free.len() * free.len(), 0.0);
    for (a, &i) in free.iter().enumerate() {
        for (b, &j) in free.iter().enumerate().skip(a) {
            let (low, high) = (i.min(j), i.max(j));
            part[a * free.len() + b] = matrix[low * columns + high];
        }
    }
}

/// One cycle of R's `glm`: its coefficients, and the standard errors that it would print.
#[derive(Debug, Clone)]
pub struct Cycle {
    /// Coefficients after the cycle.
    pub beta: Vec<f64>,
    /// Standard errors from the weights that the cycle began with, as R (and GLIM) print them.
    pub errors: Vec<f64>,
}

/// The cycles of iteratively reweighted least squares from R's start, at most `most` of them: R prints the standard
/// errors of the weights *before* its last cycle, so those of an early cycle differ from the converged ones.
pub fn cycles(rows: &Rows, most: usize) -> Vec<Cycle> {
    let all: Vec<usize> = (0..rows.columns).collect();
    let mut work = Work::new(rows, &all);
    let mut beta = vec![0.0; rows.columns];
    let mut cycles = Vec::new();
    for number in 0..most {
        if number == 0 {
            rows.first_cycle(&mut work.sums);
        } else {
            rows.sums(&beta, &mut work.sums);
        }
        if !work.direction() {
            break;
        }
        // R does not shorten its steps.
        let mut step = work.gradient.clone();
        work.cholesky.solve(&mut step);
        beta.iter_mut().zip(step).for_each(|(b, step)| *b += step);
        let inverse = work.cholesky.inverse();
        let errors = (0..rows.columns)
            .map(|j| inverse[j * rows.columns + j].sqrt())
            .collect();
        cycles.push(Cycle {
            beta: beta.clone(),
            errors,
        });
    }
    cycles
}
