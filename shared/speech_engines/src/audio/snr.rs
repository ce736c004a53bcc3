//! Level of speech above the noise around it.

use std::ops::Range;

/// The detector's edges are some 50 ms wide: samples this close to the speech count as neither.
const EDGE: usize = 1_600;
/// Beyond it the noise is that of rounding.
const LARGEST_DB: f64 = 60.0;

/// Returns the power of the speech over its surroundings within `range`, decibels, at most 60.
pub fn snr_db(samples: &[i16], range: &Range<usize>, speech: &Range<usize>) -> f32 {
    let power = |parts: [&[i16]; 2]| {
        let len = parts.iter().map(|part| part.len()).sum::<usize>().max(1) as f64;
        let squares = parts.into_iter().flatten().map(|&s| f64::from(s) * f64::from(s));
        squares.sum::<f64>() / len
    };
    let before = range.start..speech.start.saturating_sub(EDGE).max(range.start);
    let after = (speech.end + EDGE).min(range.end)..range.end;
    // Half a step of the samples' scale: digital silence.
    let noise = power([&samples[before], &samples[after]]).max(0.25);
    let signal = (power([&samples[speech.clone()], &[]]) - noise).max(noise);
    (10.0 * (signal / noise).log10()).min(LARGEST_DB) as f32
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn snr_compares_the_speech_with_the_noise_around_it() {
        let noise = |n: usize| if n.is_multiple_of(2) { 100 } else { -100 };
        let mut samples: Vec<i16> = (0..32_000).map(noise).collect();
        let speech = 12_000..20_000;
        for n in speech.clone() {
            samples[n] = if n.is_multiple_of(2) { 1_000 } else { -1_000 };
        }
        // The speech has 100 times the power of the noise, which is part of it.
        let snr = snr_db(&samples, &(4_000..28_000), &speech);
        assert!((snr - 10.0 * 99_f32.log10()).abs() < 0.1, "{snr}");
        assert_eq!(snr_db(&samples, &speech, &speech), 60.0);
        assert_eq!(snr_db(&[0; 1_000], &(0..1_000), &(200..800)), 0.0);
    }
}
