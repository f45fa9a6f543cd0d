//! Keeps what is too loud below full scale without the crackle of clipping.

/// Below this share of full scale nothing is changed.
pub const KNEE: f32 = 0.7;

/// `sample` with its size below 1: unchanged up to [`KNEE`], then ever flatter, without a corner.
///
/// It has no memory, so that a loud impact does not turn down what follows.
pub fn limit(sample: f32) -> f32 {
    let size = sample.abs();
    if size <= KNEE {
        return sample;
    }
    let room = 1.0 - KNEE;
    let over = (size - KNEE) / room;
    // Not quite 1 even where `over` is infinite, and silence where a number is none.
    let limited = KNEE + room * (1.0 - 1.0 / (1.0 + over)) * 0.999;
    if limited.is_finite() {
        limited.copysign(sample)
    } else {
        0.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn limit_leaves_quiet_alone_bends_without_a_corner_and_never_reaches_one() {
        assert_eq!(limit(-0.3), -0.3);
        let (below, above) = (limit(KNEE - 1e-3), limit(KNEE + 1e-3));
        assert!((above - below - 2e-3).abs() < 2e-5, "{below} {above}");
        let mut last = 0.0;
        for i in 0..100_000 {
            let out = limit(i as f32 * 0.01);
            assert!(out >= last && out < 1.0);
            last = out;
        }
        assert!(limit(f32::INFINITY) < 1.0);
        assert_eq!(limit(f32::NAN), 0.0);
    }
}
