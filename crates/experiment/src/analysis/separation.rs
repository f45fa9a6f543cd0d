//! Separation: directions in which the likelihood rises for ever, so that estimates are infinite.
//!
//! A direction d separates when no row with only low answers gets a larger predictor along it, none with only high
//! answers a smaller one, and none with both changes. Such directions form a cone. A linear programme finds a point in
//! its relative interior (Konis 2007): with a_i the row, turned so that a_i d >= 0 is asked, maximise the sum of
//! t_i with t_i <= a_i d and 0 <= t_i <= 1. In a cone every t_i ends at 0 or 1, and the rows with 1 are those that any
//! direction separates. It is solved through its dual, whose equations are as many as directions that are left over.

use super::linear::aliases;
use super::rows::{Rows, dot};
use super::simplex::{Programme, Variable};

/// Rows that are tried first: if these leave no direction, more cannot.
const FIRST_ROWS: usize = 2_000;
/// A component of a direction below this share of the largest is rounding.
const ZERO: f64 = 1e-8;

/// Whether any direction separates.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Kind {
    /// None: the estimates are finite.
    None,
    /// Some rows, not all.
    Quasi,
    /// Every row.
    Complete,
}

/// Where the estimate of a column goes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Reach {
    /// To a number.
    Finite,
    /// To plus infinity.
    Plus,
    /// To minus infinity.
    Minus,
    /// To infinity, in some directions with one sign, in others with the other.
    Either,
}

/// What separation does to a fit.
#[derive(Debug, Clone)]
pub struct Separation {
    /// None, some or all rows.
    pub kind: Kind,
    /// Where each column's estimate goes.
    pub per_column: Vec<Reach>,
    /// Which rows are fitted exactly, with probability 0 or 1, in the limit.
    pub is_separated: Vec<bool>,
}

/// Finds what separates `rows`, whose columns are independent of each other.
pub fn separation(rows: &Rows) -> Separation {
    let scales: Vec<f64> = rows
        .largest()
        .iter()
        .map(|&s| if s > 0.0 { s } else { 1.0 })
        .collect();
    let is_mixed: Vec<bool> = rows
        .high
        .iter()
        .zip(&rows.asked)
        .map(|(y, n)| *y > 0.0 && y < n)
        .collect();
    let mixed: Vec<f64> = scaled(rows, &scales, (0..rows.len()).filter(|&i| is_mixed[i]));
    let directions = aliases(&mixed, rows.columns).null_space;
    let one_sided: Vec<usize> = (0..rows.len()).filter(|&i| !is_mixed[i]).collect();
    let mut found = Separation {
        kind: Kind::None,
        per_column: vec![Reach::Finite; rows.columns],
        is_separated: vec![false; rows.len()],
    };
    if directions.is_empty() || one_sided.is_empty() {
        return found;
    }
    let few = &one_sided[..one_sided.len().min(FIRST_ROWS)];
    if few.len() < one_sided.len() {
        let cone = Cone::of(rows, &scales, &directions, few);
        if cone.spans() && cone.interior().is_none() {
            return found;
        }
    }
    let cone = Cone::of(rows, &scales, &directions, &one_sided);
    let Some(separated) = cone.interior() else {
        return found;
    };
    for (&i, is) in one_sided.iter().zip(separated) {
        found.is_separated[i] = is;
    }
    let rest = (0..rows.len()).filter(|&i| !found.is_separated[i]);
    // All directions along which the rest stays: the span of the cone.
    let loose = aliases(&scaled(rows, &scales, rest), rows.columns).null_space;
    for (j, reach) in found.per_column.iter_mut().enumerate() {
        let moves = |vector: &Vec<f64>| {
            vector[j].abs() > ZERO * vector.iter().fold(0.0, |m, v| v.abs().max(m))
        };
        if loose.iter().any(moves) {
            *reach = cone.reach(j);
        }
    }
    let all = found.is_separated.iter().all(|is| *is);
    found.kind = if all { Kind::Complete } else { Kind::Quasi };
    found
}

fn scaled(rows: &Rows, scales: &[f64], which: impl Iterator<Item = usize>) -> Vec<f64> {
    which
        .flat_map(|i| rows.row(i).iter().zip(scales).map(|(x, s)| x / s))
        .collect()
}

/// The cone of separating directions, in coordinates along the directions that the mixed rows leave.
struct Cone<'a> {
    directions: &'a [Vec<f64>],
    /// For each one-sided row what must not become negative, of size 1; `None` where nothing moves it.
    sides: Vec<Option<usize>>,
    columns: Vec<Vec<f64>>,
}

impl<'a> Cone<'a> {
    fn of(rows: &Rows, scales: &[f64], directions: &'a [Vec<f64>], one_sided: &[usize]) -> Self {
        let mut cone = Cone {
            directions,
            sides: Vec::new(),
            columns: Vec::new(),
        };
        for &i in one_sided {
            let row: Vec<f64> = rows.row(i).iter().zip(scales).map(|(x, s)| x / s).collect();
            let sign = if rows.high[i] > 0.0 { 1.0 } else { -1.0 };
            let mut side: Vec<f64> = directions.iter().map(|d| sign * dot(d, &row)).collect();
            let size = side.iter().fold(0.0_f64, |most, s| most.max(s.abs()));
            if size < ZERO {
                cone.sides.push(None);
                continue;
            }
            side.iter_mut().for_each(|s| *s /= size);
            cone.sides.push(Some(cone.columns.len()));
            cone.columns.push(side);
        }
        cone
    }

    /// Whether no direction is left that moves no row at all.
    fn spans(&self) -> bool {
        let size = self.directions.len();
        aliases(&self.columns.concat(), size).aliased.is_empty()
    }

    /// Which rows some direction separates; `None` if there is no such row.
    fn interior(&self) -> Option<Vec<bool>> {
        // Each row's multiplier is worth a unit up to 1, nothing above.
        let count = self.columns.len();
        let bounded = (0..count).map(|column| Variable {
            column,
            cost: -1.0,
            upper: 1.0,
        });
        let free = (0..count).map(|column| Variable {
            column,
            cost: 0.0,
            upper: f64::INFINITY,
        });
        let variables: Vec<Variable> = bounded.chain(free).collect();
        let right = vec![0.0; self.directions.len()];
        let programme = Programme {
            columns: &self.columns,
            variables: &variables,
            right: &right,
            artificial: (0.0, 0.0),
        };
        let optimum = programme.solve();
        let is_separated = |side: &Option<usize>| side.is_some_and(|k| optimum.values[k] < 0.5);
        let separated: Vec<bool> = self.sides.iter().map(is_separated).collect();
        separated.contains(&true).then_some(separated)
    }

    /// Where a column goes that some direction of the cone moves.
    fn reach(&self, j: usize) -> Reach {
        let component: Vec<f64> = self.directions.iter().map(|d| d[j]).collect();
        // By Farkas' lemma no direction of the cone lowers the component if it is a sum of rows with weights above zero.
        let never_falls = self.generates(&component);
        let opposite: Vec<f64> = component.iter().map(|c| -c).collect();
        match (never_falls, self.generates(&opposite)) {
            (true, false) => Reach::Plus,
            (false, true) => Reach::Minus,
            (true, true) => Reach::Finite,
            (false, false) => Reach::Either,
        }
    }

    /// Whether `target` is a sum of rows with weights that are not negative.
    fn generates(&self, target: &[f64]) -> bool {
        let size = target.iter().fold(0.0_f64, |most, t| most.max(t.abs()));
        let right: Vec<f64> = target.iter().map(|t| t / size).collect();
        let free = (0..self.columns.len()).map(|column| Variable {
            column,
            cost: 0.0,
            upper: f64::INFINITY,
        });
        let variables: Vec<Variable> = free.collect();
        let artificial = (1.0, f64::INFINITY);
        let programme = Programme {
            columns: &self.columns,
            variables: &variables,
            right: &right,
            artificial,
        };
        programme.solve().artificial < ZERO
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn rows(x: &[&[f64]], high: &[f64], asked: f64) -> Rows {
        Rows {
            columns: x[0].len(),
            x: x.concat(),
            high: high.to_vec(),
            asked: vec![asked; high.len()],
        }
    }

    #[test]
    fn separation_overlap_is_none() {
        let found = separation(&rows(
            &[&[1.0, 1.0], &[1.0, 2.0], &[1.0, 3.0], &[1.0, 4.0]],
            &[0.0, 1.0, 0.0, 1.0],
            1.0,
        ));
        assert_eq!(
            (found.kind, found.per_column),
            (Kind::None, vec![Reach::Finite; 2])
        );
    }

    #[test]
    fn separation_threshold_is_complete_and_has_its_sign() {
        // All above 2.5 are high: the slope goes up, the constant down.
        let found = separation(&rows(
            &[&[1.0, 1.0], &[1.0, 2.0], &[1.0, 3.0], &[1.0, 4.0]],
            &[0.0, 0.0, 1.0, 1.0],
            1.0,
        ));
        assert_eq!(
            (found.kind, found.per_column),
            (Kind::Complete, vec![Reach::Minus, Reach::Plus])
        );
    }

    #[test]
    fn separation_shared_point_is_quasi() {
        // At 2 both answers occur; the rest is separated there.
        let x: [&[f64]; 4] = [&[1.0, 1.0], &[1.0, 2.0], &[1.0, 2.0], &[1.0, 3.0]];
        let found = separation(&rows(&x, &[0.0, 0.0, 1.0, 1.0], 1.0));
        assert_eq!(
            (found.kind, found.is_separated),
            (Kind::Quasi, vec![true, false, false, true])
        );
        assert_eq!(found.per_column, [Reach::Minus, Reach::Plus]);
    }

    #[test]
    fn separation_group_with_only_high_answers_leaves_the_other_columns() {
        let x: [&[f64]; 4] = [
            &[1.0, 0.0, 0.3],
            &[1.0, 0.0, -0.2],
            &[1.0, 0.0, 0.9],
            &[1.0, 1.0, 0.1],
        ];
        let found = separation(&rows(&x, &[2.0, 3.0, 1.0, 6.0], 6.0));
        assert_eq!(found.kind, Kind::Quasi);
        assert_eq!(
            found.per_column,
            [Reach::Finite, Reach::Plus, Reach::Finite]
        );
    }

    /// Among more rows than are tried first, one decides.
    #[test]
    fn separation_sees_the_last_of_many_rows() {
        let x: Vec<f64> = (0..5_000).flat_map(|i| [1.0, f64::from(i)]).collect();
        let mut high: Vec<f64> = (0..5_000)
            .map(|i| if i < 2_500 { 0.0 } else { 1.0 })
            .collect();
        let all = |high: &[f64]| Rows {
            columns: 2,
            x: x.clone(),
            high: high.to_vec(),
            asked: vec![1.0; 5_000],
        };
        assert_eq!(separation(&all(&high)).kind, Kind::Complete);
        high[4_999] = 0.0;
        assert_eq!(separation(&all(&high)).kind, Kind::None);
    }
}
