//! Probabilities beyond a value, and the values that leave a probability beyond them.

use statrs::function::beta::beta_reg;
use statrs::function::gamma::gamma_ur;

/// The probability that chi-squared with `df` degrees of freedom exceeds `value`; `None` without degrees of freedom.
pub fn chi_squared(value: f64, df: usize) -> Option<f64> {
    if df == 0 || value.is_nan() {
        return None;
    }
    Some(if value <= 0.0 {
        1.0
    } else {
        gamma_ur(0.5 * df as f64, 0.5 * value)
    })
}

/// The probability that a standard normal variable is farther from 0 than `z`.
pub fn normal_both(z: f64) -> f64 {
    libm::erfc(z.abs() * std::f64::consts::FRAC_1_SQRT_2)
}

/// The probability that Student's t with `df` degrees of freedom is farther from 0 than `t`.
pub fn student_both(t: f64, df: f64) -> f64 {
    beta_reg(0.5 * df, 0.5, df / (df + t * t))
}

/// The probability that F with these degrees of freedom exceeds `value`.
pub fn fisher(value: f64, upper: f64, lower: f64) -> f64 {
    if value <= 0.0 {
        return 1.0;
    }
    beta_reg(0.5 * lower, 0.5 * upper, lower / (lower + upper * value))
}

/// The value that chi-squared with `df` degrees of freedom exceeds with probability `p`.
pub fn chi_squared_beyond(p: f64, df: usize) -> f64 {
    let exceeds = |value: f64| chi_squared(value, df).unwrap_or(0.0);
    let mut high = 1.0;
    while exceeds(high) > p {
        high *= 2.0;
    }
    bisect(0.0, high, |value| exceeds(value) > p)
}

/// The value that a Beta variable with parameters `a` and `b` stays below with probability `p`.
pub fn beta_below(p: f64, a: f64, b: f64) -> f64 {
    bisect(0.0, 1.0, |value| beta_reg(a, b, value) < p)
}

/// The value that Student's t with `df` degrees of freedom exceeds with probability `p`, below one half.
pub fn student_beyond(p: f64, df: f64) -> f64 {
    let exceeds = |t: f64| 0.5 * student_both(t, df);
    let mut high = 1.0;
    while exceeds(high) > p {
        high *= 2.0;
    }
    bisect(0.0, high, |t| exceeds(t) > p)
}

/// The normal quantile of 95 % intervals.
pub const NORMAL_95: f64 = 1.959_963_984_540_054;

/// The place where `is_below` turns false, to the last bit or two.
pub fn bisect(mut low: f64, mut high: f64, is_below: impl Fn(f64) -> bool) -> f64 {
    // Halving a range of any two numbers ends below rounding long before.
    for _ in 0..200 {
        let middle = 0.5 * (low + high);
        if middle <= low || middle >= high {
            break;
        }
        if is_below(middle) {
            low = middle;
        } else {
            high = middle;
        }
    }
    0.5 * (low + high)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Closed forms: chi-squared with 2 degrees of freedom is exponential, t with 1 is Cauchy, F(2, 2) is 1 / (1 + F).
    #[test]
    fn tails_agree_with_closed_forms() {
        for x in [0.1, 3.0, 50.0, 600.0] {
            assert!(
                (chi_squared(x, 2).unwrap() / (-0.5 * x).exp() - 1.0).abs() < 1e-11,
                "{x}"
            );
            let cauchy = 1.0 - 2.0 / std::f64::consts::PI * x.atan();
            assert!((student_both(x, 1.0) - cauchy).abs() < 1e-12, "{x}");
            assert!((fisher(x, 2.0, 2.0) - 1.0 / (1.0 + x)).abs() < 1e-12, "{x}");
        }
        assert!((normal_both(NORMAL_95) - 0.05).abs() < 1e-15);
        assert!((chi_squared_beyond(0.10, 8) - 13.361_566_136_511_7).abs() < 1e-9);
        assert!((student_beyond(0.025, 1.0) - 12.706_204_736_174_7).abs() < 1e-9);
    }
}
