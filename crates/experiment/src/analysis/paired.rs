//! Presence asked after each game: every subject is their own control, so the difference of two counts is tested.

use serde_json::{Value, json};

use super::json::number;
use super::subjects::{PARAMETERS, Subjects};
use super::tails;

/// The differences, high level less low, of those whose parameter changed.
#[derive(Debug, Clone, PartialEq)]
pub struct Paired {
    /// Index of the parameter.
    pub parameter: usize,
    /// Subjects with both answers.
    pub subjects: usize,
    /// Mean difference of the shares of high answers.
    pub mean: f64,
    /// Its standard error.
    pub error: f64,
    /// Student's t.
    pub t: f64,
    /// The two-sided probability.
    pub p: f64,
}

/// The tests, a parameter each; empty where presence was asked once.
pub fn paired(subjects: &Subjects) -> Vec<Paired> {
    let column = |name: &str| subjects.table.column(&[name]);
    let Some(((y_low, n_low), (y_high, n_high))) = column("y_low")
        .zip(column("n_low"))
        .zip(column("y_high").zip(column("n_high")))
    else {
        return Vec::new();
    };
    let mut tests = Vec::new();
    for parameter in 0..PARAMETERS.len() {
        let of =
            (0..subjects.list.len()).filter(|&row| subjects.list[row].change == Some(parameter));
        let share = |row: usize, y: usize, n: usize| {
            let value = |column: usize| subjects.table.number(row, column).ok().flatten();
            value(y)
                .zip(value(n))
                .filter(|(_, n)| *n > 0.0)
                .map(|(y, n)| y / n)
        };
        let differences: Vec<f64> = of
            .filter_map(|row| Some(share(row, y_high, n_high)? - share(row, y_low, n_low)?))
            .collect();
        if let Some((mean, error, t, p)) = student(&differences) {
            tests.push(Paired {
                parameter,
                subjects: differences.len(),
                mean,
                error,
                t,
                p,
            });
        }
    }
    tests
}

/// Mean, standard error, t and two-sided probability of differences; `None` for fewer than two.
///
/// Differences that are all alike have no error: the probability is 0, or 1 where they are zero.
pub fn student(differences: &[f64]) -> Option<(f64, f64, f64, f64)> {
    if differences.len() < 2 {
        return None;
    }
    let n = differences.len() as f64;
    let mean = differences.iter().sum::<f64>() / n;
    let variance = differences.iter().map(|d| (d - mean).powi(2)).sum::<f64>() / (n - 1.0);
    let error = (variance / n).sqrt();
    if error == 0.0 {
        return Some((mean, 0.0, f64::NAN, if mean == 0.0 { 1.0 } else { 0.0 }));
    }
    Some((
        mean,
        error,
        mean / error,
        tails::student_both(mean / error, n - 1.0),
    ))
}

/// Every number.
pub fn json(tests: &[Paired]) -> Value {
    let test = |test: &Paired| {
        json!({
            "changed": PARAMETERS[test.parameter],
            "subjects": test.subjects,
            "mean_difference_of_shares": test.mean,
            "se": test.error,
            "t": number(test.t),
            "p": test.p,
        })
    };
    tests.iter().map(test).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Student's own ten patients (1908), as in R's `sleep`: t = -4.0621, 9 degrees of freedom, p = 0.002833.
    #[test]
    fn student_agrees_with_the_sleep_of_ten_patients() {
        let differences = [-1.2, -2.4, -1.3, -1.3, 0.0, -1.0, -1.8, -0.8, -4.6, -1.4];
        let (mean, _, t, p) = student(&differences).unwrap();
        assert!((mean + 1.58).abs() < 1e-12 && (t + 4.062_127_683_382_037).abs() < 1e-10);
        assert!((p - 0.002_832_890_197_384_72).abs() < 1e-10);
    }
}
