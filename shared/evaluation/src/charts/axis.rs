//! Axes: where a number lies, and at which numbers it is marked.

/// A linear axis from 0.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Linear {
    /// Its end.
    pub end: f64,
    /// Between two marks.
    pub step: f64,
}

impl Linear {
    /// An axis that holds `largest`, marked at four to eight round numbers.
    pub fn up_to(largest: f64) -> Self {
        let largest = if largest.is_finite() && largest > 0.0 { largest } else { 1.0 };
        let rough = largest / 7.0;
        let power = 10.0_f64.powf(rough.log10().floor());
        let round = [1.0, 2.0, 5.0, 10.0].into_iter().find(|m| m * power >= rough);
        let step = round.unwrap_or(10.0) * power;
        Self { end: step * (largest / step).ceil(), step }
    }

    /// Where on the axis, 0 to 1.
    pub fn place(&self, x: f64) -> f64 {
        (x / self.end).clamp(0.0, 1.0)
    }

    /// The numbers that are marked.
    pub fn marks(&self) -> Vec<f64> {
        let count = (self.end / self.step).round() as usize;
        (0..=count).map(|k| k as f64 * self.step).collect()
    }
}

/// An axis on which equal factors are equally long.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Logarithmic {
    /// Its ends, both above 0.
    pub ends: (f64, f64),
}

impl Logarithmic {
    /// An axis from `least` to `largest`, both above 0, with some room at either end.
    pub fn over(least: f64, largest: f64) -> Self {
        Self { ends: (least / 1.3, largest * 1.3) }
    }

    /// Where on the axis, 0 to 1.
    pub fn place(&self, x: f64) -> f64 {
        let (low, high) = self.ends;
        ((x / low).ln() / (high / low).ln()).clamp(0.0, 1.0)
    }

    /// The numbers that are marked: powers of ten, and where these are few, twice and five times
    /// them as well.
    pub fn marks(&self) -> Vec<f64> {
        let (low, high) = self.ends;
        let powers = low.log10().floor() as i32..=high.log10().ceil() as i32;
        let factors: &[f64] = if high / low > 300.0 { &[1.0] } else { &[1.0, 2.0, 5.0] };
        let all = powers.flat_map(|power| factors.iter().map(move |f| f * 10.0_f64.powi(power)));
        all.filter(|mark| (low..=high).contains(mark)).collect()
    }
}

/// An axis for shares near 1: the logarithm of what is missing, so that 99 % is as far from 90 %
/// as that is from 0.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Missing {
    /// Least share that is shown as missing.
    least: f64,
}

/// Shares at which it is marked.
const SHARES: [f64; 11] = [0.0, 0.5, 0.8, 0.9, 0.95, 0.98, 0.99, 0.995, 0.998, 0.999, 0.9999];

impl Missing {
    /// An axis on which these shares differ; those of 1 lie at its end.
    pub fn holding(shares: impl Iterator<Item = f64>) -> Self {
        let least = shares.map(|share| 1.0 - share).filter(|missing| *missing > 1e-5);
        Self { least: 0.6 * least.fold(0.02, f64::min) }
    }

    /// Where on the axis, 0 to 1.
    pub fn place(&self, share: f64) -> f64 {
        (1.0 - share).clamp(self.least, 1.0).log10() / self.least.log10()
    }

    /// The shares that are marked, the last of them 1.
    pub fn marks(&self) -> Vec<f64> {
        let marked = SHARES.into_iter().filter(|share| 1.0 - share > 1.3 * self.least);
        marked.chain([1.0]).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn linear_axes_are_marked_at_round_numbers() {
        let axis = Linear::up_to(41.6);
        assert_eq!((axis.end, axis.step), (50.0, 10.0));
        assert_eq!(axis.marks(), [0.0, 10.0, 20.0, 30.0, 40.0, 50.0]);
        assert_eq!((axis.place(25.0), axis.place(99.0)), (0.5, 1.0));
        assert_eq!(Linear::up_to(0.0).end, 1.0);
        for largest in [0.003, 0.7, 1.0, 7.0, 19.0, 123.0, 9_999.0] {
            let axis = Linear::up_to(largest);
            assert!(axis.end >= largest && (4..=9).contains(&axis.marks().len()), "{axis:?}");
        }
    }

    #[test]
    fn logarithmic_axes_are_marked_at_powers() {
        let wide = Logarithmic::over(3.0, 20_000.0);
        assert_eq!(wide.marks(), [10.0, 100.0, 1_000.0, 10_000.0]);
        let narrow = Logarithmic::over(0.02, 0.3);
        let marks: Vec<String> = narrow.marks().iter().map(|m| format!("{m:.2}")).collect();
        assert_eq!(marks, ["0.02", "0.05", "0.10", "0.20"]);
        let middle = wide.place((wide.ends.0 * wide.ends.1).sqrt());
        assert!((middle - 0.5).abs() < 1e-12);
        assert_eq!((wide.place(wide.ends.0), wide.place(1e9)), (0.0, 1.0));
    }

    #[test]
    fn shares_near_one_are_told_apart() {
        let axis = Missing::holding([0.9, 0.999, 1.0].into_iter());
        let (low, high, all) = (axis.place(0.9), axis.place(0.99), axis.place(1.0));
        assert!((high - 2.0 * low).abs() < 1e-12 && high < all);
        assert_eq!((axis.place(0.0), all), (0.0, 1.0));
        assert_eq!(axis.marks()[axis.marks().len() - 2..], [0.999, 1.0]);
    }
}
