//! A small linear programme: few equations, many bounded variables. Primal simplex, the basis factored anew at each step.

use nalgebra::{DMatrix, DVector};

/// A reduced cost, or an element of a pivot's column, smaller than this is zero; the coefficients are of order one.
const ZERO: f64 = 1e-9;
/// Steps on the spot by the steepest cost before the first improving variable is taken, which cannot cycle (Bland 1977).
const ON_THE_SPOT: usize = 50;
/// Steps for each variable and equation, which no programme needs; a variable moves from bound to bound about once.
const MOST_STEPS: usize = 50;

/// Minimise the cost of x subject to A x = b and 0 <= x <= upper.
///
/// Beside the variables there is an artificial one for each equation, with which the search begins: it has the sign of b.
pub struct Programme<'a> {
    /// The columns of A; each may be used by several variables.
    pub columns: &'a [Vec<f64>],
    /// Which column of A a variable has, its cost, and its upper bound.
    pub variables: &'a [Variable],
    /// The right sides.
    pub right: &'a [f64],
    /// Cost and upper bound of the artificial variables.
    pub artificial: (f64, f64),
}

/// A variable of a [`Programme`].
#[derive(Debug, Clone, Copy)]
pub struct Variable {
    /// Index of its column.
    pub column: usize,
    /// Cost of one unit.
    pub cost: f64,
    /// Upper bound; may be infinite.
    pub upper: f64,
}

/// The end of the search.
#[derive(Debug, Clone)]
pub struct Optimum {
    /// Value of each variable, without the artificial ones.
    pub values: Vec<f64>,
    /// The multiplier of each equation.
    pub duals: Vec<f64>,
    /// Sum of the artificial variables.
    pub artificial: f64,
}

/// The state of the search: who is in the basis, and who of the others is at its upper bound.
struct Search<'a> {
    programme: &'a Programme<'a>,
    basis: Vec<usize>,
    values: Vec<f64>,
    at_upper: Vec<bool>,
    is_basic: Vec<bool>,
}

impl Programme<'_> {
    /// The optimum.
    pub fn solve(&self) -> Optimum {
        let (many, equations) = (self.variables.len(), self.right.len());
        let mut search = Search {
            programme: self,
            basis: (many..many + equations).collect(),
            values: self.right.iter().map(|b| b.abs()).collect(),
            at_upper: vec![false; many],
            is_basic: vec![false; many],
        };
        let mut duals = DVector::zeros(equations);
        let mut on_the_spot = 0;
        for _ in 0..MOST_STEPS * (many + equations) {
            let basis = search.matrix();
            let costs =
                DVector::from_iterator(equations, search.basis.iter().map(|&k| self.cost(k)));
            let solved = basis.transpose().lu().solve(&costs);
            duals = solved.expect("a pivot is never near zero, so the basis stays regular");
            let Some(entering) = search.entering(&duals, on_the_spot > ON_THE_SPOT) else {
                break;
            };
            let is_moving = search.pivot(entering, &basis) > 0.0;
            on_the_spot = if is_moving { 0 } else { on_the_spot + 1 };
        }
        search.end(duals)
    }

    fn cost(&self, k: usize) -> f64 {
        self.variables
            .get(k)
            .map_or(self.artificial.0, |variable| variable.cost)
    }

    fn upper(&self, k: usize) -> f64 {
        self.variables
            .get(k)
            .map_or(self.artificial.1, |variable| variable.upper)
    }

    fn column(&self, k: usize) -> DVector<f64> {
        let equations = self.right.len();
        match self.variables.get(k) {
            Some(variable) => DVector::from_column_slice(&self.columns[variable.column]),
            None => {
                let mut unit = DVector::zeros(equations);
                let row = k - self.variables.len();
                unit[row] = if self.right[row] < 0.0 { -1.0 } else { 1.0 };
                unit
            }
        }
    }
}

impl Search<'_> {
    fn matrix(&self) -> DMatrix<f64> {
        let columns: Vec<_> = self
            .basis
            .iter()
            .map(|&k| self.programme.column(k))
            .collect();
        DMatrix::from_columns(&columns)
    }

    /// A variable outside of the basis that would lower the cost.
    fn entering(&self, duals: &DVector<f64>, first: bool) -> Option<usize> {
        let columns = self.programme.columns.iter();
        let products: Vec<f64> = columns
            .map(|a| super::rows::dot(a, duals.as_slice()))
            .collect();
        let mut best = (ZERO, None);
        for (k, variable) in self.programme.variables.iter().enumerate() {
            if self.is_basic[k] {
                continue;
            }
            let reduced = variable.cost - products[variable.column];
            let gain = if self.at_upper[k] { reduced } else { -reduced };
            if gain > best.0 {
                best = (gain, Some(k));
                if first {
                    break;
                }
            }
        }
        best.1
    }

    /// Moves `entering` from its bound until it or a basic variable meets one; returns how far.
    fn pivot(&mut self, entering: usize, basis: &DMatrix<f64>) -> f64 {
        let solved = basis.clone().lu().solve(&self.programme.column(entering));
        let mut change = solved.expect("a pivot is never near zero, so the basis stays regular");
        if self.at_upper[entering] {
            change.neg_mut();
        }
        let mut longest = self.programme.upper(entering);
        let mut leaving = None;
        for (i, &rate) in change.iter().enumerate() {
            let room = if rate > ZERO {
                self.values[i].max(0.0) / rate
            } else if rate < -ZERO {
                (self.programme.upper(self.basis[i]) - self.values[i]).max(0.0) / -rate
            } else {
                continue;
            };
            // Among equals the lowest number leaves, which Bland's rule asks for.
            let is_tie =
                leaving.is_some_and(|l: usize| room == longest && self.basis[i] < self.basis[l]);
            if room < longest || is_tie {
                (longest, leaving) = (room, Some(i));
            }
        }
        for (value, rate) in self.values.iter_mut().zip(change.iter()) {
            *value -= longest * rate;
        }
        let Some(i) = leaving else {
            self.at_upper[entering] = !self.at_upper[entering];
            return longest;
        };
        let left = self.basis[i];
        if left < self.is_basic.len() {
            self.is_basic[left] = false;
            self.at_upper[left] = change[i] < 0.0;
        }
        let start = if self.at_upper[entering] {
            self.programme.upper(entering) - longest
        } else {
            longest
        };
        self.at_upper[entering] = false;
        self.basis[i] = entering;
        self.values[i] = start;
        self.is_basic[entering] = true;
        longest
    }

    fn end(&self, duals: DVector<f64>) -> Optimum {
        let variables = self.programme.variables;
        let at_bound = variables.iter().zip(&self.at_upper);
        let mut values: Vec<f64> = at_bound
            .map(|(v, &up)| if up { v.upper } else { 0.0 })
            .collect();
        let mut artificial = 0.0;
        for (&k, &value) in self.basis.iter().zip(&self.values) {
            match values.get_mut(k) {
                Some(slot) => *slot = value,
                None => artificial += value,
            }
        }
        Optimum {
            values,
            duals: duals.as_slice().to_vec(),
            artificial,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Maximise 3a + 5b with a <= 4, 2b <= 12, 3a + 2b <= 18: 36 at (2, 6) (Hillier and Lieberman's Wyndor example).
    #[test]
    fn solve_finds_the_textbook_corner() {
        let columns = [
            vec![3.0, 0.0],
            vec![2.0, 2.0],
            vec![1.0, 0.0],
            vec![0.0, 1.0],
        ];
        let free = |column, cost| Variable {
            column,
            cost,
            upper: f64::INFINITY,
        };
        let bounded = Variable {
            column: 0,
            cost: -3.0,
            upper: 4.0,
        };
        let variables = [bounded, free(1, -5.0), free(2, 0.0), free(3, 0.0)];
        let right = [18.0, 12.0];
        let programme = Programme {
            columns: &columns,
            variables: &variables,
            right: &right,
            artificial: (1e3, f64::INFINITY),
        };
        let optimum = programme.solve();
        assert!((optimum.values[0] - 2.0).abs() < 1e-12 && (optimum.values[1] - 6.0).abs() < 1e-12);
        assert!(optimum.artificial.abs() < 1e-12);
    }

    #[test]
    fn solve_leaves_artificials_where_nothing_is_feasible() {
        let columns = [vec![1.0], vec![2.0]];
        let variables: Vec<_> = (0..2)
            .map(|column| Variable {
                column,
                cost: 0.0,
                upper: f64::INFINITY,
            })
            .collect();
        let programme = Programme {
            columns: &columns,
            variables: &variables,
            right: &[-1.0],
            artificial: (1.0, f64::INFINITY),
        };
        assert_eq!(programme.solve().artificial, 1.0);
    }
}
