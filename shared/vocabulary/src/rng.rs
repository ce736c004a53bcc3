//! A small deterministic random generator, so that a replay draws the same numbers everywhere.

/// SplitMix64 (Steele, Lea and Flood 2014): 64 bits of state, every seed a good one.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Rng {
    state: u64,
}

const GOLDEN_GAMMA: u64 = 0x9e37_79b9_7f4a_7c15;

impl Rng {
    /// Returns a generator with the given seed.
    pub fn new(seed: u64) -> Self {
        Self { state: seed }
    }

    /// The next 64 random bits.
    #[inline]
    pub fn next_u64(&mut self) -> u64 {
        self.state = self.state.wrapping_add(GOLDEN_GAMMA);
        let mut z = self.state;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// Uniform in `[0, 1)`, with 53 random bits.
    #[inline]
    pub fn uniform(&mut self) -> f64 {
        const STEP: f64 = 1.0 / (1_u64 << 53) as f64;
        (self.next_u64() >> 11) as f64 * STEP
    }

    /// Uniform between two numbers.
    #[inline]
    pub fn between(&mut self, (low, high): (f64, f64)) -> f64 {
        low + (high - low) * self.uniform()
    }

    /// Standard normal (Box and Muller 1958).
    pub fn normal(&mut self) -> f64 {
        // In (0, 1], so that the logarithm is finite.
        let radius = (-2.0 * (1.0 - self.uniform()).ln()).sqrt();
        radius * (std::f64::consts::TAU * self.uniform()).cos()
    }

    /// Log-normal with that median and standard deviation of the logarithm.
    pub fn log_normal(&mut self, median: f64, log_sd: f64) -> f64 {
        median * (log_sd * self.normal()).exp()
    }

    /// Uniform in `0..bound`; the bias of the multiply-and-shift is below `bound / 2^64`.
    ///
    /// # Panics
    /// If `bound` is 0.
    #[inline]
    pub fn below(&mut self, bound: usize) -> usize {
        assert!(bound > 0, "nothing to draw from");
        ((u128::from(self.next_u64()) * bound as u128) >> 64) as usize
    }

    /// Draws an index with these probabilities; `None` with the remainder if their sum is below 1.
    #[inline]
    pub fn index(&mut self, probabilities: impl IntoIterator<Item = f64>) -> Option<usize> {
        let mut left = self.uniform();
        probabilities.into_iter().position(|probability| {
            left -= probability;
            left < 0.0
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_published_sequence_of_seed_1234567() {
        let mut rng = Rng::new(1_234_567);
        let first: Vec<_> = (0..3).map(|_| rng.next_u64()).collect();
        assert_eq!(
            first,
            [6_457_827_717_110_365_317, 3_203_168_211_198_807_973, 9_817_491_932_198_370_423]
        );
    }

    #[test]
    fn index_has_the_probabilities_given() {
        let mut rng = Rng::new(9);
        let mut seen = [0_u32; 4];
        for _ in 0..10_000 {
            seen[rng.index([0.5, 0.0, 0.3]).unwrap_or(3)] += 1;
        }
        assert!(seen[1] == 0 && (4_800..5_200).contains(&seen[0]), "{seen:?}");
        assert!((2_800..3_200).contains(&seen[2]), "{seen:?}");
    }

    #[test]
    fn uniform_and_below_stay_in_range_and_average_out() {
        let mut rng = Rng::new(7);
        let mut sum = 0.0;
        let mut seen = [0_u32; 6];
        for _ in 0..6_000 {
            let u = rng.uniform();
            assert!((0.0..1.0).contains(&u));
            sum += u;
            seen[rng.below(6)] += 1;
        }
        assert!((sum / 6_000.0 - 0.5).abs() < 0.02, "mean {}", sum / 6_000.0);
        assert!(seen.iter().all(|&count| (900..1_100).contains(&count)), "{seen:?}");
    }

    #[test]
    fn log_normal_numbers_have_their_moments() {
        let mut rng = Rng::new(11);
        let logs: Vec<f64> = (0..20_000).map(|_| rng.log_normal(0.9, 0.55).ln()).collect();
        let mean = logs.iter().sum::<f64>() / 20_000.0;
        let variance = logs.iter().map(|x| (x - mean).powi(2)).sum::<f64>() / 20_000.0;
        assert!((mean - 0.9_f64.ln()).abs() < 0.02, "{mean}");
        assert!((variance.sqrt() - 0.55).abs() < 0.02, "{variance}");
    }
}
