//! All normal impulses of a group at once: where passes over its contacts would end, if those that press now are those
//! that press then.

use arrayvec::ArrayVec;

use super::row::{Mover, Row};

/// Most contacts that press, of a group that leaps.
const MOST: usize = 32;
/// Share of its own stiffness that a contact must add to what those before it hold, or it is left as it is.
///
/// Of four points of a box on a floor three hold it, and the fourth shares the load in no definite way.
const DEFINITE: f64 = 1e-5;

/// The change of velocity per impulse between contacts, lower half, and what the factorisation makes of it.
struct Matrix<const N: usize>([[f64; N]; N]);

impl<const N: usize> Matrix<N> {
    /// Makes it `L D L^T` in place, `D` on the diagonal; what is not definite becomes zero there.
    fn factorise(&mut self, count: usize) {
        for i in 0..count {
            let (before, rest) = self.0.split_at_mut(i);
            let row = &mut rest[0];
            let own = row[i];
            for (j, other) in before.iter().enumerate() {
                let known: f64 = (0..j).map(|k| row[k] * other[k]).sum();
                row[j] = if other[j] > 0.0 { row[j] - known } else { 0.0 };
            }
            for (j, other) in before.iter().enumerate() {
                if other[j] > 0.0 {
                    let scaled = row[j] / other[j];
                    row[i] -= scaled * row[j];
                    row[j] = scaled;
                }
            }
            if row[i] <= DEFINITE * own {
                row[i] = 0.0;
            }
        }
    }

    /// Solves for the factorised matrix, in place.
    fn solve(&self, x: &mut [f64]) {
        for i in 0..x.len() {
            x[i] -= (0..i).map(|j| self.0[i][j] * x[j]).sum::<f64>();
        }
        for (i, x) in x.iter_mut().enumerate() {
            let pivot = self.0[i][i];
            *x = if pivot > 0.0 { *x / pivot } else { 0.0 };
        }
        for i in (0..x.len()).rev() {
            let now = x[i];
            for (x, share) in x[..i].iter_mut().zip(&self.0[i]) {
                *x -= share * now;
            }
        }
    }
}

/// Gives the contacts that press what stops all their approaches at once, or the part of it at which the first lets go.
///
/// Every such step brings the impulses nearer to those that suit all contacts, as a pass does.
pub(crate) fn leap(rows: &mut [Row], all: &mut [Mover]) {
    let mut pressing = ArrayVec::<usize, MOST>::new();
    for (i, row) in rows.iter().enumerate() {
        if row.pressed() > 0.0 && pressing.try_push(i).is_err() {
            return;
        }
    }
    match pressing.len() {
        0 | 1 => {}
        2 => leap_within::<2>(&pressing, rows, all),
        3..=6 => leap_within::<6>(&pressing, rows, all),
        7..=12 => leap_within::<12>(&pressing, rows, all),
        _ => leap_within::<MOST>(&pressing, rows, all),
    }
}

/// The leap of up to `N` contacts: small groups need not clear a large matrix.
fn leap_within<const N: usize>(pressing: &[usize], rows: &mut [Row], all: &mut [Mover]) {
    let mut matrix = Matrix([[0.0; N]; N]);
    for (i, own) in pressing.iter().enumerate() {
        for (j, other) in pressing[..=i].iter().enumerate() {
            matrix.0[i][j] = rows[*own].coupling(&rows[*other], all);
        }
    }
    matrix.factorise(pressing.len());
    let mut changes = [0.0; N];
    let changes = &mut changes[..pressing.len()];
    for (change, i) in changes.iter_mut().zip(pressing) {
        *change = rows[*i].excess(all);
    }
    matrix.solve(changes);
    let mut part: f64 = 1.0;
    for (change, i) in changes.iter().zip(pressing) {
        let pressed = rows[*i].pressed();
        if pressed + *change < 0.0 {
            part = part.min(pressed / -change);
        }
    }
    for (change, i) in changes.iter().zip(pressing) {
        rows[*i].press_by(part * change, all);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_definite_is_solved_and_the_rest_left() {
        // Rows 0, 2, 3 are definite; row 1 is row 0 once more.
        let full = [
            [4.0, 4.0, 1.0, 0.5],
            [4.0, 4.0, 1.0, 0.5],
            [1.0, 1.0, 3.0, -1.0],
            [0.5, 0.5, -1.0, 2.0],
        ];
        let wanted = [1.5, 0.0, -2.0, 0.25];
        let mut x = full.map(|row: [f64; 4]| row.iter().zip(wanted).map(|(a, b)| a * b).sum());
        let mut matrix = Matrix::<4>(full);
        matrix.factorise(4);
        matrix.solve(&mut x);
        for (got, wanted) in x.iter().zip(wanted) {
            assert!((got - wanted).abs() < 1e-14, "{x:?}");
        }
    }
}
