//! Noise reduction for speech by a recurrent network that was trained to keep voices: RNNoise
//! (Valin 2018). It follows noise that begins or changes during the speech.

use std::borrow::Cow;
use std::ops::Range;

use audio::{RATE_HZ, resample};
use nnnoiseless::DenoiseState;

use super::snr_db;

/// The network's sampling rate.
const NETWORK_HZ: u32 = 48_000;
/// Samples that the network processes at a time; its output is late by as many.
const FRAME: usize = DenoiseState::FRAME_SIZE;
/// Audio from which the network learns the noise before it hears the first sample: 0.1 s. After
/// half a second or more it removes more noise, and more of the voice: less is understood.
const WARM_UP: usize = 10 * FRAME;
/// Signal-to-noise ratio from which nothing is removed, decibels. Removing noise costs voice: at 25
/// dB that breaks more words than it repairs.
const CLEAR_DB: f32 = 18.0;

/// Returns the samples with the noise reduced, and the evidence of a voice in `speech`, which the
/// network finds on the way. Returns them unchanged, without evidence, if the noise around `speech`
/// is low, or too little surrounds it to estimate the noise.
pub fn denoised<'s>(
    samples: &'s [i16],
    speech: &Range<usize>,
) -> (Cow<'s, [i16]>, Option<VoiceEvidence>) {
    if snr_db(samples, &(0..samples.len()), speech) >= CLEAR_DB {
        return (Cow::Borrowed(samples), None);
    }
    // Resampling fails only at a rate of 0.
    reduce_noise(samples).map_or((Cow::Borrowed(samples), None), |(clear, probabilities)| {
        (Cow::Owned(clear), Some(VoiceEvidence::of(&probabilities, speech)))
    })
}

/// Sound behind the speech that is judged with it: 0.1 s.
const BEHIND: usize = RATE_HZ as usize / 10;
/// Probability from which on a frame is voiced.
const VOICED: f32 = 0.5;
/// Frames that must sound like a voice: 0.08 s, as in the shortest "no".
const SUREST: usize = 8;

/// How much of a sound is a voice.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct VoiceEvidence {
    /// Probability of a voice in the surest 0.08 s, 0 to 1. The detector of speech takes knocks for
    /// a voice; they have a lower one.
    pub probability: f32,
    /// Length of the voiced parts, seconds.
    pub voiced_s: f32,
}

impl VoiceEvidence {
    /// Judges `speech` by the probabilities that the network gives each frame, after it has heard
    /// the preceding audio.
    pub fn in_speech(samples: &[i16], speech: &Range<usize>) -> Self {
        let end = samples.len().min(speech.end + BEHIND);
        Self::of(&voice_probabilities(&samples[..end]), speech)
    }

    /// Judges `speech` by the probabilities of all frames of the sound around it.
    fn of(probabilities: &[f32], speech: &Range<usize>) -> Self {
        let frame = |sample: usize| {
            (sample * (NETWORK_HZ / RATE_HZ) as usize / FRAME).min(probabilities.len())
        };
        let mut frames = probabilities[frame(speech.start)..frame(speech.end + BEHIND)].to_vec();
        frames.sort_by(|a, b| b.total_cmp(a));
        let voiced = frames.iter().take_while(|&&probability| probability > VOICED).count();
        Self {
            probability: frames.get(SUREST - 1).copied().unwrap_or_default(),
            voiced_s: (voiced * FRAME) as f32 / NETWORK_HZ as f32,
        }
    }
}

/// Returns the probability of a voice in each frame.
fn voice_probabilities(samples: &[i16]) -> Vec<f32> {
    let samples: Vec<f32> = samples.iter().map(|&s| f32::from(s)).collect();
    // Resampling fails only at a rate of 0.
    let samples = resample(&samples, RATE_HZ, NETWORK_HZ).unwrap_or_default();
    let (mut network, mut output) = (DenoiseState::new(), [0.0; FRAME]);
    samples.chunks_exact(FRAME).map(|frame| network.process_frame(&mut output, frame)).collect()
}

/// Returns the samples with the noise reduced, and the probability of a voice in each frame.
fn reduce_noise(samples: &[i16]) -> Result<(Vec<i16>, Vec<f32>), String> {
    let samples: Vec<f32> = samples.iter().map(|&s| f32::from(s)).collect();
    let noisy = resample(&samples, RATE_HZ, NETWORK_HZ)?;
    // The beginning played backwards, which is noise of the same kind.
    let mut input: Vec<f32> = noisy.iter().take(WARM_UP).rev().copied().collect();
    let warm_up = input.len();
    input.extend_from_slice(&noisy);
    input.resize((input.len() + FRAME).next_multiple_of(FRAME), 0.0);
    let mut network = DenoiseState::new();
    let mut output = vec![0.0; input.len()];
    let frames = input.chunks_exact(FRAME).zip(output.chunks_exact_mut(FRAME));
    let mut probabilities: Vec<f32> =
        frames.map(|(noisy, clear)| network.process_frame(clear, noisy)).collect();
    probabilities.drain(..warm_up / FRAME);
    // The output is late by a frame.
    let start = warm_up + FRAME;
    let clear = resample(&output[start..start + noisy.len()], NETWORK_HZ, RATE_HZ)?;
    // The cast saturates: values beyond full scale are clipped.
    let clear = clear.into_iter().take(samples.len()).map(|s| s.round() as i16).collect();
    Ok((clear, probabilities))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::{Rng, signed};
    use crate::testing::voice;

    const QUIET: usize = 8_000;

    /// Returns a second of voice with half a second around it, clean and with noise.
    fn spoken(noise: f32) -> (Vec<i16>, Vec<i16>, Range<usize>) {
        let voice = voice(1.0);
        let clean = [&vec![0; QUIET][..], &voice, &vec![0; QUIET]].concat();
        let mut rng = Rng::new(11);
        let noisy = clean.iter().map(|&s| s.saturating_add((noise * signed(&mut rng)) as i16));
        (clean.clone(), noisy.collect(), QUIET..QUIET + voice.len())
    }

    fn error(output: &[i16], clean: &[i16], within: Range<usize>) -> f64 {
        let pairs = output[within.clone()].iter().zip(&clean[within]);
        pairs.map(|(&a, &b)| (f64::from(a) - f64::from(b)).powi(2)).sum()
    }

    #[test]
    fn denoise_removes_noise_and_keeps_the_voice() {
        let (clean, noisy, speech) = spoken(3_000.0);
        let (output, voice) = denoised(&noisy, &speech);
        assert_eq!(output.len(), noisy.len());
        assert!(voice.is_some());
        // Before the speech the network is still learning.
        let after = speech.end + 4_800..clean.len();
        let before = error(&noisy, &clean, after.clone());
        assert!(error(&output, &clean, after) < before / 10.0);
        let before = error(&noisy, &clean, speech.clone());
        assert!(error(&output, &clean, speech) < before);
    }

    #[test]
    fn denoise_leaves_clear_speech_unchanged() {
        for noise in [0.0, 300.0] {
            let (_, noisy, speech) = spoken(noise);
            let output = denoised(&noisy, &speech);
            assert!(matches!(output, (Cow::Borrowed(same), None) if same == noisy), "{noise}");
        }
    }

    #[test]
    fn denoise_leaves_speech_without_surrounding_quiet_unchanged() {
        let (_, noisy, speech) = spoken(3_000.0);
        let samples = &noisy[speech];
        let output = denoised(samples, &(0..samples.len()));
        assert!(matches!(output, (Cow::Borrowed(same), None) if same == samples));
    }

    #[test]
    fn knocks_and_silence_are_no_voice() {
        let mut rng = Rng::new(13);
        let decay = |n: usize| 20_000.0 * (-(n as f32) / 300.0).exp();
        let knock: Vec<i16> = (0..4_000).map(|n| (decay(n) * signed(&mut rng)) as i16).collect();
        let knocks = [&[0; QUIET][..], &knock, &knock, &knock, &[0; QUIET]].concat();
        let heard = VoiceEvidence::in_speech(&knocks, &(QUIET..QUIET + 3 * knock.len()));
        assert!(heard.probability < 0.99, "{heard:?}");
        for len in [0, 100, QUIET] {
            let heard = VoiceEvidence::in_speech(&vec![0; len], &(len / 2..len));
            assert!(heard.probability < 0.5 && heard.voiced_s == 0.0, "{len}: {heard:?}");
        }
    }

    #[test]
    fn denoise_keeps_the_length_of_what_is_shorter_than_a_frame() {
        for len in [0, 1, 5, 159, 161] {
            assert_eq!(denoised(&vec![1; len], &(0..len / 2)).0.len(), len);
        }
    }
}
