//! The little linear algebra that the fits need: Cholesky, and orthogonal columns by R's rule for aliases.

/// A column whose part outside of the columns before it is smaller than this share of it is aliased.
///
/// R's `glm` uses `min(1e-7, epsilon / 1000)`, which is 1e-11 at its default epsilon of 1e-8.
const ALIAS: f64 = 1e-11;
/// A pivot below this share of its diagonal element counts as lost to rounding.
const LOST: f64 = 1e-14;

/// The factor L of a symmetric positive definite matrix A = L L', row by row.
#[derive(Debug, Clone, Default)]
pub struct Cholesky {
    size: usize,
    factor: Vec<f64>,
}

impl Cholesky {
    /// Factors `matrix` (rows one after the other, of which the upper triangle is read), or says that it is not
    /// positive definite within rounding.
    pub fn factor(&mut self, matrix: &[f64], size: usize) -> bool {
        self.size = size;
        self.factor.clear();
        self.factor.resize(size * size, 0.0);
        for i in 0..size {
            for j in 0..=i {
                let (above, below) = self.factor.split_at(i * size);
                let row_j = if j == i {
                    &below[..j]
                } else {
                    &above[j * size..j * size + j]
                };
                let product: f64 = below[..j].iter().zip(row_j).map(|(a, b)| a * b).sum();
                let rest = matrix[j * size + i] - product;
                let value = if i == j {
                    if rest.is_nan() || rest <= LOST * matrix[i * size + i] {
                        return false;
                    }
                    rest.sqrt()
                } else {
                    rest / self.factor[j * size + j]
                };
                self.factor[i * size + j] = value;
            }
        }
        true
    }

    /// Overwrites b with the z of L z = b.
    pub fn half_solve(&self, b: &mut [f64]) {
        for i in 0..self.size {
            let row = &self.factor[i * self.size..i * self.size + i];
            let product: f64 = row.iter().zip(&*b).map(|(l, z)| l * z).sum();
            b[i] = (b[i] - product) / self.factor[i * self.size + i];
        }
    }

    /// Overwrites b with the x of A x = b.
    pub fn solve(&self, b: &mut [f64]) {
        self.half_solve(b);
        for i in (0..self.size).rev() {
            let mut rest = b[i];
            for (k, x) in b.iter().enumerate().skip(i + 1) {
                rest -= self.factor[k * self.size + i] * x;
            }
            b[i] = rest / self.factor[i * self.size + i];
        }
    }

    /// The inverse of A, row by row.
    pub fn inverse(&self) -> Vec<f64> {
        let mut inverse = vec![0.0; self.size * self.size];
        for (i, row) in inverse.chunks_exact_mut(self.size.max(1)).enumerate() {
            row[i] = 1.0;
            self.solve(row);
        }
        inverse
    }

    /// The logarithm of the determinant of A.
    pub fn log_determinant(&self) -> f64 {
        let diagonal = (0..self.size).map(|i| self.factor[i * self.size + i]);
        2.0 * diagonal.map(libm::log).sum::<f64>()
    }

    /// The smallest ratio of a pivot to its diagonal element in A: 1 for orthogonal columns, 0 for aliased ones.
    pub fn smallest_pivot(&self, matrix: &[f64]) -> f64 {
        let ratios = (0..self.size).map(|i| {
            let pivot = self.factor[i * self.size + i];
            pivot * pivot / matrix[i * self.size + i]
        });
        ratios.fold(1.0, f64::min)
    }
}

/// Which columns of a matrix depend on columns before them, and how.
#[derive(Debug, Clone, Default)]
pub struct Aliases {
    /// The columns that are independent of those before them, in their order.
    pub kept: Vec<usize>,
    /// The columns that depend on those before them, in their order.
    pub aliased: Vec<usize>,
    /// For each aliased column a vector over all columns that the matrix takes to zero; its entry at that column is -1.
    pub null_space: Vec<Vec<f64>>,
}

/// Finds the aliased columns of a matrix with `columns` columns, its rows one after the other, by R's rule: a column
/// goes when columns before it span it, whatever comes after.
///
/// Gram-Schmidt, each projection done twice, which is as orthogonal as Householder's reflections.
pub fn aliases(x: &[f64], columns: usize) -> Aliases {
    let mut found = Aliases::default();
    if is_plainly_regular(x, columns) {
        found.kept = (0..columns).collect();
        return found;
    }
    let mut basis: Vec<Vec<f64>> = Vec::new();
    // Coefficients of kept columns on the basis: a triangle.
    let mut triangle: Vec<Vec<f64>> = Vec::new();
    for j in 0..columns {
        let mut rest: Vec<f64> = x.iter().skip(j).step_by(columns).copied().collect();
        let length = norm(&rest);
        let mut coefficients = vec![0.0; basis.len()];
        for _ in 0..2 {
            for (direction, coefficient) in basis.iter().zip(&mut coefficients) {
                let along: f64 = direction.iter().zip(&rest).map(|(a, b)| a * b).sum();
                *coefficient += along;
                for (r, d) in rest.iter_mut().zip(direction) {
                    *r -= along * d;
                }
            }
        }
        let left = norm(&rest);
        if left > ALIAS * length {
            rest.iter_mut().for_each(|r| *r /= left);
            basis.push(rest);
            coefficients.push(left);
            triangle.push(coefficients);
            found.kept.push(j);
        } else {
            found.null_space.push(combination(
                &found.kept,
                &triangle,
                &coefficients,
                j,
                columns,
            ));
            found.aliased.push(j);
        }
    }
    found
}

/// How the kept columns add up to column `j`, which has these coefficients on the basis.
fn combination(
    kept: &[usize],
    triangle: &[Vec<f64>],
    coefficients: &[f64],
    j: usize,
    columns: usize,
) -> Vec<f64> {
    let mut vector = vec![0.0; columns];
    let mut rest = coefficients.to_vec();
    for i in (0..kept.len()).rev() {
        let share = rest[i] / triangle[i][i];
        vector[kept[i]] = share;
        for (r, t) in rest.iter_mut().zip(&triangle[i]) {
            *r -= share * t;
        }
    }
    vector[j] = -1.0;
    vector
}

/// Whether the normal equations alone prove that no column is aliased: far cheaper with a million rows.
fn is_plainly_regular(x: &[f64], columns: usize) -> bool {
    if columns == 0 || x.len() < columns * columns {
        return false;
    }
    let mut products = vec![0.0; columns * columns];
    for row in x.chunks_exact(columns) {
        for i in 0..columns {
            for j in i..columns {
                products[i * columns + j] += row[i] * row[j];
            }
        }
    }
    let mut cholesky = Cholesky::default();
    // Rounding in the products is below 1e-9 of the diagonal for any number of rows that fits in memory.
    cholesky.factor(&products, columns) && cholesky.smallest_pivot(&products) > 1e-6
}

/// Euclidean length.
fn norm(vector: &[f64]) -> f64 {
    vector.iter().map(|v| v * v).sum::<f64>().sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cholesky_solves_what_it_factored() {
        let a = [4.0, 2.0, 0.5, 2.0, 5.0, 1.0, 0.5, 1.0, 3.0];
        let mut cholesky = Cholesky::default();
        assert!(cholesky.factor(&a, 3));
        let mut x = [1.0, -2.0, 3.0];
        cholesky.solve(&mut x);
        for (row, b) in a.chunks_exact(3).zip([1.0, -2.0, 3.0]) {
            let product: f64 = row.iter().zip(&x).map(|(a, x)| a * x).sum();
            assert!((product - b).abs() < 1e-14);
        }
        // 4 (15 - 1) - 2 (6 - 0.5) + 0.5 (2 - 2.5)
        assert!((cholesky.log_determinant() - 44.75_f64.ln()).abs() < 1e-14);
    }

    #[test]
    fn factor_refuses_a_matrix_that_is_not_definite() {
        assert!(!Cholesky::default().factor(&[1.0, 2.0, 2.0, 1.0], 2));
        assert!(!Cholesky::default().factor(&[f64::NAN], 1));
    }

    #[test]
    fn aliases_blames_the_later_column_and_says_what_it_is_made_of() {
        // Column 2 is twice column 0 less column 1; column 3 is zero; column 4 is independent.
        let rows = [
            [1.0, 0.0, 2.0, 0.0, 1.0],
            [1.0, 1.0, 1.0, 0.0, 4.0],
            [1.0, 2.0, 0.0, 0.0, 9.0],
            [1.0, 3.0, -1.0, 0.0, 1.0],
            [1.0, 5.0, -3.0, 0.0, 2.0],
        ];
        let found = aliases(rows.as_flattened(), 5);
        assert_eq!((found.kept, found.aliased), (vec![0, 1, 4], vec![2, 3]));
        let expected = [[2.0, -1.0, -1.0, 0.0, 0.0], [0.0, 0.0, 0.0, -1.0, 0.0]];
        for (vector, expected) in found.null_space.iter().zip(expected) {
            for (v, e) in vector.iter().zip(expected) {
                assert!((v - e).abs() < 1e-12, "{vector:?}");
            }
        }
    }
}
