//! Noise with a fixed seed, so that the same contacts make the same sound.

/// A stream of white noise.
///
/// SplitMix64 (G. L. Steele, D. Lea, C. H. Flood, *Fast Splittable Pseudorandom Number Generators*, OOPSLA 2014,
/// Figure 17). The experiment's crate has the same ten lines; a mixer that pulled in plans, tables and statistics for
/// them would be odd.
#[derive(Debug, Clone)]
pub(crate) struct Noise {
    state: u64,
}

impl Noise {
    pub fn new(seed: u64) -> Self {
        Noise { state: seed }
    }

    /// Uniform in [-1, 1), mean 0, variance 1/3.
    pub fn next(&mut self) -> f32 {
        self.state = self.state.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.state;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^= z >> 31;
        // The upper 24 bits, all that an f32 holds exactly.
        (z >> 40) as f32 * (2.0 / 16_777_216.0) - 1.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn next_is_white_with_the_variance_of_a_uniform() {
        let mut noise = Noise::new(1);
        let samples: Vec<f64> = (0..100_000).map(|_| f64::from(noise.next())).collect();
        let mean = samples.iter().sum::<f64>() / 1e5;
        let power = samples.iter().map(|x| x * x).sum::<f64>() / 1e5;
        let neighbours = samples.windows(2).map(|w| w[0] * w[1]).sum::<f64>() / 1e5;
        // Five standard errors: 0.0018 of the mean, 0.001 of the power and of the product.
        assert!(mean.abs() < 0.01 && neighbours.abs() < 0.006);
        assert!((power - 1.0 / 3.0).abs() < 0.006);
    }
}
