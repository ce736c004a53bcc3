//! Change of sampling rate.

use rubato::audioadapter_buffers::owned::InterleavedOwned;
use rubato::{Fft, FixedSync, Resampler, WindowFunction};

/// Input samples of a block at least. Longer blocks have a steeper filter: this one passes 0.95 of
/// the lower rate's band.
const BLOCK_MIN: usize = 2_048;

/// Returns samples at `to_hz` that sound as `samples` at `from_hz` do. The first samples coincide;
/// silence is assumed before and after the input.
///
/// # Errors
/// If a rate is 0.
pub fn resample(samples: &[f32], from_hz: u32, to_hz: u32) -> Result<Vec<f32>, String> {
    if from_hz == to_hz || samples.is_empty() {
        return Ok(samples.to_vec());
    }
    let (from, to) = (from_hz as usize, to_hz as usize);
    // An even number of periods, so that the filter's delay is a whole number of samples.
    let period = 2 * from / gcd(from, to).max(1);
    let block = BLOCK_MIN.next_multiple_of(period.max(1));
    let window = WindowFunction::BlackmanHarris2;
    let mut resampler = Fft::<f32>::new_custom(from, to, block, 1, 1, window, FixedSync::Both)
        .map_err(|error| error.to_string())?;
    let input = InterleavedOwned::new_from(samples.to_vec(), 1, samples.len())
        .map_err(|error| error.to_string())?;
    let output = resampler.process_all(&input, samples.len(), None);
    Ok(output.map_err(|error| error.to_string())?.take_data())
}

fn gcd(a: usize, b: usize) -> usize {
    if b == 0 { a } else { gcd(b, a % b) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::TAU;

    fn resampled(samples: &[f32], from_hz: u32) -> Vec<f32> {
        resample(samples, from_hz, 16_000).unwrap()
    }

    fn sine(hz: f64, rate_hz: u32, len: usize) -> Vec<f32> {
        let step = TAU * hz / f64::from(rate_hz);
        (0..len).map(|n| (0.5 * (step * n as f64).sin()) as f32).collect()
    }

    /// Power relative to a sine of amplitude 0.5, in decibels, away from the ends.
    fn level_db(samples: impl Iterator<Item = f32>, len: usize) -> f64 {
        let middle = samples.skip(len / 4).take(len / 2);
        let power = middle.map(|x| f64::from(x) * f64::from(x)).sum::<f64>() / (len / 2) as f64;
        10.0 * (power / 0.125).log10()
    }

    #[test]
    fn resampling_preserves_a_sine() {
        for from_hz in [8_000, 11_025, 22_050, 24_000, 32_000, 44_100, 48_000, 96_000, 192_000] {
            for hz in [100.0, 1_000.0, 3_500.0] {
                let output = resampled(&sine(hz, from_hz, from_hz as usize / 2), from_hz);
                let ideal = sine(hz, 16_000, output.len());
                assert_eq!(output.len(), 8_000, "{from_hz}");
                let error = output.iter().zip(&ideal).map(|(a, b)| a - b);
                let noise_db = level_db(error, output.len());
                assert!(noise_db < -90.0, "{hz} Hz from {from_hz} Hz: noise at {noise_db:.1} dB");
            }
        }
    }

    #[test]
    fn resampling_suppresses_aliases() {
        for hz in [8_200.0, 10_000.0, 15_000.0, 20_000.0] {
            let output = resampled(&sine(hz, 44_100, 44_100), 44_100);
            let level = level_db(output.iter().copied(), output.len());
            assert!(level < -80.0, "{hz} Hz folds back at {level:.1} dB");
        }
    }

    #[test]
    fn resampling_handles_constants_odd_lengths_and_equal_rates() {
        let output = resampled(&[0.25; 8_820], 44_100);
        let middle = output[output.len() / 2];
        assert!((middle - 0.25).abs() < 1e-5, "{middle}");
        assert_eq!(resampled(&[0.1, 0.2], 16_000), [0.1, 0.2]);
        for (samples, from_hz, expected) in
            [(0, 44_100, 0), (1, 48_000, 1), (441, 44_100, 160), (7, 12_345, 10)]
        {
            assert_eq!(resampled(&vec![0.0; samples], from_hz).len(), expected, "{from_hz}");
        }
        assert!(resample(&[1.0], 0, 16_000).is_err());
    }
}
