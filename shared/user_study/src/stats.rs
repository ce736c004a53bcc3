//! Means and proportions with their 95 % intervals.

/// A 95 % interval.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Interval {
    /// Lower end.
    pub low: f64,
    /// Upper end.
    pub high: f64,
}

/// 97.5 % quantile of the standard normal distribution.
const Z: f64 = 1.959_963_984_540_054;

/// The Wilson score interval (Wilson 1927) of a proportion: it keeps to 0 … 1 and holds for few
/// trials and for none or all successes, for which the usual interval fails. 0 … 1 without any
/// trial.
pub fn wilson(successes: u64, trials: u64) -> Interval {
    if trials == 0 {
        return Interval { low: 0.0, high: 1.0 };
    }
    let n = trials as f64;
    let p = successes as f64 / n;
    let centre = p + Z * Z / (2.0 * n);
    let half = Z * (p * (1.0 - p) / n + Z * Z / (4.0 * n * n)).sqrt();
    let scale = 1.0 + Z * Z / n;
    let low = if successes == 0 { 0.0 } else { (centre - half) / scale };
    let high = if successes == trials { 1.0 } else { (centre + half) / scale };
    Interval { low, high }
}

/// A running mean: count, mean, and sum of squared differences from it (Welford 1962), merged as
/// Chan, Golub and LeVeque (1979) do, so that millions of like numbers lose no digits.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Mean {
    count: u64,
    mean: f64,
    squares: f64,
}

impl Mean {
    /// Adds a number.
    pub fn add(&mut self, x: f64) {
        self.count += 1;
        let before = x - self.mean;
        self.mean += before / self.count as f64;
        self.squares += before * (x - self.mean);
    }

    /// Adds all that `other` was given. The last bits depend on the order of merging.
    pub fn merge(&mut self, other: &Self) {
        if other.count == 0 {
            return;
        }
        let (a, b) = (self.count as f64, other.count as f64);
        let between = other.mean - self.mean;
        self.count += other.count;
        self.mean += between * b / (a + b);
        self.squares += other.squares + between * between * a * b / (a + b);
    }

    /// Number of values added.
    pub fn count(&self) -> u64 {
        self.count
    }

    /// The mean; 0 of nothing.
    pub fn mean(&self) -> f64 {
        self.mean
    }

    /// Standard deviation of the numbers, estimated without bias; 0 of fewer than two.
    pub fn deviation(&self) -> f64 {
        if self.count < 2 { 0.0 } else { (self.squares / (self.count - 1) as f64).sqrt() }
    }

    /// Standard error of the mean.
    pub fn error(&self) -> f64 {
        if self.count == 0 { 0.0 } else { self.deviation() / (self.count as f64).sqrt() }
    }

    /// The interval of the mean, by the normal distribution; for some thirty numbers or more.
    pub fn interval(&self) -> Interval {
        let half = Z * self.error();
        Interval { low: self.mean - half, high: self.mean + half }
    }

    /// The interval of the mean by Student's distribution, for few numbers, but at least two.
    pub fn student_interval(&self) -> Option<Interval> {
        let half =
            student(self.count.checked_sub(1).filter(|freedom| *freedom > 0)?) * self.error();
        Some(Interval { low: self.mean - half, high: self.mean + half })
    }
}

/// 97.5 % quantile of Student's distribution with that many degrees of freedom, at least 1: exact
/// for up to four, else by the expansion about the normal one (Abramowitz and Stegun 26.7.5), which
/// is off by less than 0.0003.
fn student(freedom: u64) -> f64 {
    const FEW: [f64; 4] = [12.706_205, 4.302_653, 3.182_446, 2.776_445];
    if let Some(exact) = FEW.get((freedom - 1) as usize) {
        return *exact;
    }
    let (z, n) = (Z, freedom as f64);
    let odd = |factors: &[f64]| factors.iter().rev().fold(0.0, |sum, f| sum * z * z + f) * z;
    z + odd(&[1.0, 1.0]) / (4.0 * n)
        + odd(&[3.0, 16.0, 5.0]) / (96.0 * n * n)
        + odd(&[-15.0, 17.0, 19.0, 3.0]) / (384.0 * n.powi(3))
        + odd(&[-945.0, -1_920.0, 1_482.0, 776.0, 79.0]) / (92_160.0 * n.powi(4))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn near(a: f64, b: f64) {
        assert!((a - b).abs() < 5e-5, "{a} is not {b}");
    }

    /// Newcombe (1998), table I, method 3.
    #[test]
    fn wilson_interval_matches_published_examples() {
        let cases = [
            ((81, 263), (0.2553, 0.3662)),
            ((15, 148), (0.0624, 0.1605)),
            ((0, 20), (0.0, 0.1611)),
            ((1, 29), (0.0061, 0.1718)),
        ];
        for ((successes, trials), (low, high)) in cases {
            let found = wilson(successes, trials);
            near(found.low, low);
            near(found.high, high);
        }
    }

    #[test]
    fn wilson_interval_is_right_at_0_and_1() {
        assert_eq!(wilson(0, 0), Interval { low: 0.0, high: 1.0 });
        assert_eq!(wilson(7, 7).high, 1.0);
        near(wilson(7, 7).low, 1.0 - wilson(0, 7).high);
    }

    #[test]
    fn mean_deviation_and_error_match_hand_calculations() {
        let mut mean = Mean::default();
        [2.0, 4.0, 4.0, 4.0, 5.0, 5.0, 7.0, 9.0].into_iter().for_each(|x| mean.add(x));
        assert_eq!((mean.count(), mean.mean()), (8, 5.0));
        near(mean.deviation(), (32.0_f64 / 7.0).sqrt());
        near(mean.interval().high - 5.0, 1.959_964 * (32.0_f64 / 56.0).sqrt());
        assert_eq!((Mean::default().error(), Mean::default().deviation()), (0.0, 0.0));
    }

    /// Published tables of the distribution.
    #[test]
    fn student_quantiles_match_the_tables() {
        let table =
            [(1, 12.7062), (4, 2.7764), (5, 2.5706), (9, 2.2622), (14, 2.1448), (44, 2.0154)];
        for (freedom, quantile) in table {
            assert!((student(freedom) - quantile).abs() < 4e-4, "{freedom}: {}", student(freedom));
        }
        assert!((student(1_000_000) - Z).abs() < 1e-5);
        let mut mean = Mean::default();
        mean.add(1.0);
        assert_eq!(mean.student_interval(), None);
        mean.add(3.0);
        near(mean.student_interval().unwrap().high, 2.0 + 12.706_205);
    }

    #[test]
    fn merged_means_equal_the_mean_of_all_values() {
        let numbers: Vec<f64> = (0..1_000).map(|k| 1e6 + f64::from(k % 17)).collect();
        let of = |numbers: &[f64]| {
            let mut mean = Mean::default();
            numbers.iter().for_each(|x| mean.add(*x));
            mean
        };
        let whole = of(&numbers);
        let mut merged = Mean::default();
        numbers.chunks(13).for_each(|chunk| merged.merge(&of(chunk)));
        assert_eq!(merged.count(), whole.count());
        assert!((merged.mean() - whole.mean()).abs() < 1e-9);
        assert!((merged.deviation() - whole.deviation()).abs() < 1e-9);
        merged.merge(&Mean::default());
        assert_eq!(merged.count(), 1_000);
    }
}
