//! Change of sampling rate by a windowed-sinc filter bank.

use std::f64::consts::PI;

/// Zero crossings of the sinc on either side. With the window below, the filter passes up to
/// 0.90 of the lower rate's band and keeps 99 dB from beyond it (Kaiser's estimate: transition
/// width = (99 - 8) / (2.285 * 2 pi * 128 taps) = 0.05 of the rate).
const ZERO_CROSSINGS: f64 = 64.0;
/// Where the filter has fallen to half, as a share of the lower rate's band: half the transition
/// inside it, so that nothing folds back.
const CUTOFF: f64 = 0.95;
/// Kaiser's window parameter for 99 dB.
const BETA: f64 = 10.0;

/// Samples at `to_hz` that sound as `samples` at `from_hz` do. The first samples coincide; what
/// lies before and after the input counts as silence.
///
/// # Panics
/// If a rate is 0.
pub fn resample(samples: &[f32], from_hz: u32, to_hz: u32) -> Vec<f32> {
    assert!(from_hz > 0 && to_hz > 0, "a sampling rate is not 0");
    if from_hz == to_hz {
        return samples.to_vec();
    }
    let bank = FilterBank::new(from_hz, to_hz);
    let len = (samples.len() as u64 * bank.up).div_ceil(bank.down);
    (0..len).map(|n| bank.sample(samples, n)).collect()
}

/// One filter for each position that an output sample can have between two input samples.
struct FilterBank {
    /// Rates divided by their greatest common divisor: output sample `n` stands at input time
    /// `n * down / up`.
    up: u64,
    down: u64,
    /// Input samples on either side that a filter reaches.
    reach: usize,
    /// `up` filters of `2 * reach` taps.
    taps: Vec<f32>,
}

impl FilterBank {
    fn new(from_hz: u32, to_hz: u32) -> Self {
        let divisor = gcd(from_hz, to_hz);
        let (up, down) = (u64::from(to_hz / divisor), u64::from(from_hz / divisor));
        // The band of the lower rate, as a share of the input's own.
        let band = (f64::from(to_hz) / f64::from(from_hz)).min(1.0) * CUTOFF;
        let reach = (ZERO_CROSSINGS / band).ceil() as usize;
        let taps =
            (0..up).flat_map(|phase| filter(phase as f64 / up as f64, band, reach)).collect();
        Self { up, down, reach, taps }
    }

    fn sample(&self, samples: &[f32], n: u64) -> f32 {
        let at = n * self.down;
        let (whole, phase) = ((at / self.up) as usize, (at % self.up) as usize);
        let taps = &self.taps[phase * 2 * self.reach..][..2 * self.reach];
        // Tap 0 belongs to input sample `whole + 1 - reach`.
        let skipped = (self.reach - 1).saturating_sub(whole);
        let first = (whole + 1).saturating_sub(self.reach);
        let heard = samples.get(first..).unwrap_or_default();
        taps[skipped..].iter().zip(heard).map(|(tap, x)| tap * x).sum()
    }
}

/// The taps for an output sample `offset` (0 to 1) behind an input sample. They sum to 1, so that
/// a constant stays what it is at every position.
fn filter(offset: f64, band: f64, reach: usize) -> Vec<f32> {
    let taps: Vec<f64> = (0..2 * reach)
        .map(|k| {
            let time = k as f64 + 1.0 - reach as f64 - offset;
            band * sinc(band * time) * kaiser(time / reach as f64)
        })
        .collect();
    let sum: f64 = taps.iter().sum();
    taps.into_iter().map(|tap| (tap / sum) as f32).collect()
}

fn sinc(x: f64) -> f64 {
    if x.abs() < 1e-9 { 1.0 } else { (PI * x).sin() / (PI * x) }
}

/// Kaiser's window over -1 to 1.
fn kaiser(x: f64) -> f64 {
    bessel_i0(BETA * (1.0 - x * x).max(0.0).sqrt()) / bessel_i0(BETA)
}

/// The modified Bessel function of order 0 by its power series, which for the window's arguments
/// (0 to 10) has converged to double precision after 30 terms.
fn bessel_i0(x: f64) -> f64 {
    let quarter = x * x / 4.0;
    let terms = (1..40).scan(1.0, |term, k| {
        *term *= quarter / f64::from(k * k);
        Some(*term)
    });
    1.0 + terms.sum::<f64>()
}

fn gcd(a: u32, b: u32) -> u32 {
    if b == 0 { a } else { gcd(b, a % b) }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sine(hz: f64, rate_hz: u32, len: usize) -> Vec<f32> {
        let step = 2.0 * PI * hz / f64::from(rate_hz);
        (0..len).map(|n| (0.5 * (step * n as f64).sin()) as f32).collect()
    }

    /// Power relative to a sine of amplitude 0.5, in decibels, away from the ends.
    fn level_db(samples: impl Iterator<Item = f32>, len: usize) -> f64 {
        let middle = samples.skip(len / 4).take(len / 2);
        let power = middle.map(|x| f64::from(x) * f64::from(x)).sum::<f64>() / (len / 2) as f64;
        10.0 * (power / 0.125).log10()
    }

    #[test]
    fn a_sine_stays_the_same_sine() {
        for from_hz in [8_000, 11_025, 22_050, 24_000, 32_000, 44_100, 48_000, 96_000] {
            for hz in [100.0, 1_000.0, 3_500.0] {
                let heard = resample(&sine(hz, from_hz, from_hz as usize / 2), from_hz, 16_000);
                let ideal = sine(hz, 16_000, heard.len());
                assert_eq!(heard.len(), 8_000, "{from_hz}");
                let error = heard.iter().zip(&ideal).map(|(a, b)| a - b);
                let noise_db = level_db(error, heard.len());
                assert!(noise_db < -90.0, "{hz} Hz from {from_hz} Hz: noise at {noise_db:.1} dB");
            }
        }
    }

    #[test]
    fn what_the_new_rate_cannot_hold_is_gone() {
        for hz in [8_200.0, 10_000.0, 15_000.0, 20_000.0] {
            let heard = resample(&sine(hz, 44_100, 44_100), 44_100, 16_000);
            let level = level_db(heard.iter().copied(), heard.len());
            assert!(level < -80.0, "{hz} Hz folds back at {level:.1} dB");
        }
    }

    #[test]
    fn a_constant_stays_constant_and_ends_are_silence() {
        let heard = resample(&[0.25; 4_410], 44_100, 16_000);
        let middle = heard[heard.len() / 2];
        assert!((middle - 0.25).abs() < 1e-5, "{middle}");
        // Half of the filter looks at the silence before the first sample.
        assert!((0.1..0.2).contains(&heard[0]), "{}", heard[0]);
    }

    #[test]
    fn odd_lengths_and_equal_rates() {
        assert_eq!(resample(&[0.1, 0.2], 16_000, 16_000), [0.1, 0.2]);
        assert!(resample(&[], 44_100, 16_000).is_empty());
        assert_eq!(resample(&[1.0], 48_000, 16_000).len(), 1);
        assert_eq!(resample(&[0.0; 441], 44_100, 16_000).len(), 160);
        assert_eq!(resample(&[0.0; 7], 12_345, 16_000).len(), 10);
    }
}
