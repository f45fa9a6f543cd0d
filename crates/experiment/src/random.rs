//! The program's own random numbers, so that a seed means the same in every version.
//!
//! SplitMix64: G. L. Steele, D. Lea, C. H. Flood, *Fast Splittable Pseudorandom Number Generators*,
//! OOPSLA 2014, Figure 17. A crate's generator may change between versions; this one cannot.

/// A SplitMix64 stream.
#[derive(Debug, Clone)]
pub struct SplitMix64 {
    state: u64,
}

impl SplitMix64 {
    /// A stream that is fixed by `seed`; every seed is good, also zero.
    pub fn new(seed: u64) -> Self {
        SplitMix64 { state: seed }
    }

    /// The stream of piece `index` of something that `seed` fixes: pieces may be drawn in any order.
    pub fn for_index(seed: u64, index: u64) -> Self {
        let start = SplitMix64::new(seed).next_u64();
        // Streams of neighbours would overlap if only their states were a step apart.
        SplitMix64::new(SplitMix64::new(start ^ index).next_u64())
    }

    /// The next 64 random bits.
    pub fn next_u64(&mut self) -> u64 {
        self.state = self.state.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.state;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// Uniform in [0, 1), 53 bits.
    pub fn uniform(&mut self) -> f64 {
        (self.next_u64() >> 11) as f64 * (1.0 / 9_007_199_254_740_992.0)
    }

    /// Nearly normal with mean 0 and standard deviation 1, never beyond 6: the sum of twelve
    /// uniforms less 6. It needs no logarithm or sine, so it is the same bits on every system, and
    /// a human's scatter has no far tails either.
    pub fn normal(&mut self) -> f64 {
        (0..12).map(|_| self.uniform()).sum::<f64>() - 6.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Reference values: the public-domain C implementation by Sebastiano Vigna, seed 1234567.
    #[test]
    fn next_u64_agrees_with_the_reference() {
        let mut random = SplitMix64::new(1_234_567);
        let expected = [
            6_457_827_717_110_365_317,
            3_203_168_211_198_807_973,
            9_817_491_932_198_370_423,
        ];
        for value in expected {
            assert_eq!(random.next_u64(), value);
        }
    }

    #[test]
    fn normal_has_mean_zero_and_unit_deviation() {
        let mut random = SplitMix64::new(7);
        let samples: Vec<f64> = (0..20_000).map(|_| random.normal()).collect();
        let mean = samples.iter().sum::<f64>() / 20_000.0;
        let variance = samples.iter().map(|x| (x - mean).powi(2)).sum::<f64>() / 20_000.0;
        // Four standard errors of mean (0.0071) and variance (0.01).
        assert!(
            mean.abs() < 0.03 && (variance - 1.0).abs() < 0.04,
            "{mean} {variance}"
        );
    }
}
