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

    /// Uniform on the whole numbers below `bound`, which is above zero, by rejection: a remainder alone favours the small ones.
    ///
    /// # Panics
    /// When `bound` is zero.
    pub fn below(&mut self, bound: u64) -> u64 {
        assert!(bound > 0, "there is no whole number below zero");
        // The first 2^64 mod bound values would be one too many of the small remainders.
        let surplus = bound.wrapping_neg() % bound;
        loop {
            let bits = self.next_u64();
            if bits >= surplus {
                return bits % bound;
            }
        }
    }

    /// Every order of `items` equally likely.
    ///
    /// R. Durstenfeld, *Algorithm 235: Random permutation*, CACM 1964, after Fisher and Yates: from the last place down.
    pub fn shuffle<T>(&mut self, items: &mut [T]) {
        for last in (1..items.len()).rev() {
            let chosen = self.below(last as u64 + 1) as usize;
            items.swap(chosen, last);
        }
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

    #[test]
    fn below_refuses_the_surplus_of_small_remainders() {
        // A bound of 3/4 of 2^64: without rejection the lowest third would come up twice as often.
        let bound = 3 << 62;
        let mut random = SplitMix64::new(11);
        let low = (0..30_000)
            .filter(|_| random.below(bound) < bound / 3)
            .count();
        // A third of 30,000, and four standard errors (82).
        assert!((9_670..10_330).contains(&low), "{low}");
        assert!((0..100).all(|_| random.below(1) == 0));
    }

    #[test]
    fn shuffle_gives_every_order_as_often() {
        let mut random = SplitMix64::new(5);
        let mut counts = std::collections::BTreeMap::new();
        for _ in 0..24_000 {
            let mut items = [0, 1, 2, 3];
            random.shuffle(&mut items);
            *counts.entry(items).or_insert(0) += 1;
        }
        assert_eq!(counts.len(), 24);
        // 1000 each; four and a half standard errors (31).
        assert!(counts.values().all(|count| (860..1140).contains(count)));
    }
}
