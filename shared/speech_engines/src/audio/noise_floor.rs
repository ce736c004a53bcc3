//! Noise added to audio that is too clean for the recogniser.

use std::borrow::Cow;

use super::RATE_HZ;
use crate::random::{Rng, signed};

/// Highest signal-to-noise ratio, decibels. The acoustic model was trained on microphones in rooms:
/// it understands 63 % of espeak-ng's requests in digital silence, 95 % with noise at 28 dB.
const FLOOR_DB: f32 = 28.0;
/// Samples of a block whose power is compared: 20 ms.
const BLOCK: usize = RATE_HZ as usize / 50;
/// Power relative to the loudest block below which a block is a pause.
const PAUSE: f32 = 0.01;

/// Returns the samples with pink noise that limits the signal-to-noise ratio to [`FLOOR_DB`]; a
/// recording from a room is returned unchanged. Equal samples get equal noise.
pub fn with_noise_floor(samples: &[i16]) -> Cow<'_, [i16]> {
    let mut powers: Vec<f32> = samples.chunks(BLOCK).map(power).collect();
    powers.sort_by(f32::total_cmp);
    let Some(&loudest) = powers.last() else { return Cow::Borrowed(samples) };
    let speech: Vec<f32> = powers.iter().copied().filter(|p| *p > loudest * PAUSE).collect();
    let level = speech.iter().sum::<f32>() / speech.len().max(1) as f32;
    let floor = powers[powers.len() / 10];
    let lack = level / 10_f32.powf(FLOOR_DB / 10.0) - floor;
    if lack <= 0.0 {
        return Cow::Borrowed(samples);
    }
    let noise = pink(samples.len());
    let gain = (lack / (noise.iter().map(|n| n * n).sum::<f32>() / noise.len() as f32)).sqrt();
    // The cast saturates: values beyond full scale are clipped.
    let with_noise = |(&s, n): (&i16, &f32)| (f32::from(s) + gain * n).round() as i16;
    Cow::Owned(samples.iter().zip(&noise).map(with_noise).collect())
}

fn power(samples: &[i16]) -> f32 {
    samples.iter().map(|&s| f32::from(s) * f32::from(s)).sum::<f32>() / samples.len() as f32
}

/// Returns noise whose power falls by 3 dB per octave: white noise through Kellet's three one-pole
/// filters.
fn pink(len: usize) -> Vec<f32> {
    let mut rng = Rng::new(0x0A15E);
    let (mut low, mut middle, mut high) = (0.0, 0.0, 0.0);
    (0..len)
        .map(|_| {
            let white = signed(&mut rng);
            low = 0.997_65 * low + 0.099_046 * white;
            middle = 0.963 * middle + 0.296_516_4 * white;
            high = 0.57 * high + 1.052_691_3 * white;
            low + middle + high + 0.184_8 * white
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::voice;

    fn in_silence(speech: &[i16]) -> Vec<i16> {
        let quiet = vec![0; 8_000];
        [&quiet, speech, &quiet].concat()
    }

    #[test]
    fn noise_floor_adds_noise_below_clean_speech() {
        let speech = voice(1.0);
        let clean = in_silence(&speech);
        let heard = with_noise_floor(&clean);
        let db = 10.0 * (power(&speech) / power(&heard[..8_000])).log10();
        assert!((25.0..31.0).contains(&db), "{db} dB");
        assert_eq!(heard, with_noise_floor(&clean));
    }

    #[test]
    fn noise_floor_leaves_a_noisy_recording_unchanged() {
        let mut rng = Rng::new(3);
        let mut noisy = in_silence(&voice(1.0));
        noisy.iter_mut().for_each(|s| *s = s.saturating_add((signed(&mut rng) * 600.0) as i16));
        assert!(matches!(with_noise_floor(&noisy), Cow::Borrowed(same) if same == noisy));
    }

    #[test]
    fn noise_floor_leaves_silence_unchanged() {
        assert!(with_noise_floor(&[]).is_empty());
        assert!(with_noise_floor(&[0; 1_000]).iter().all(|s| *s == 0));
    }
}
