//! Noise reduction for speech.
//!
//! The noise spectrum is estimated before and after the voice. Each frequency is attenuated by the
//! gain that minimises the expected error of its log amplitude (Ephraim and Malah 1985, equation 20,
//! with the decision-directed estimate of 1984), because the recogniser's features are log
//! amplitudes. Noise that changes during the speech remains.

use std::borrow::Cow;
use std::f32::consts::PI;
use std::ops::Range;

use realfft::num_complex::Complex;
use realfft::{FftError, RealFftPlanner};

use super::RATE_HZ;

/// Samples per frame: 32 ms.
const FRAME: usize = 512;
/// Step between frames: 8 ms. Four frames overlap everywhere.
const HOP: usize = 128;
/// Frequencies of a frame, from 0 to half the rate.
const BINS: usize = FRAME / 2 + 1;
/// Samples this close to the voice count as voice: the detector's edges are some 50 ms wide, and
/// consonants lie before them.
const EDGE: usize = RATE_HZ as usize / 10;
/// Frames without voice required for a noise estimate.
const FRAMES_MIN: usize = 8;
/// Weight of the previous frame in the estimate of the signal-to-noise ratio. Lower values leave
/// musical noise.
const SMOOTHING: f32 = 0.98;
/// Signal-to-noise ratio from which nothing is removed, decibels in the recogniser's band. Removing
/// more than necessary costs voice: at 25 dB it breaks more words than it repairs.
const CLEAR_DB: f32 = 30.0;
/// Lower limit of the gain, -26 dB: what looks like noise may be voice.
const GAIN_MIN: f32 = 0.05;
/// The recogniser's band, 130 to 6800 Hz.
const BAND: Range<usize> = 4..218;
/// Lower limit of the a-priori signal-to-noise ratio, -25 dB.
const PRIOR_MIN: f32 = 0.003;
/// A-posteriori signal-to-noise ratio beyond which the gain no longer changes.
const POSTERIOR_MAX: f32 = 1_000.0;

type Spectrum = Vec<Complex<f32>>;

/// Returns the samples with the noise around `speech` reduced to [`CLEAR_DB`] below the voice.
/// Returns them unchanged where the noise is lower already, or where too little surrounds the voice
/// to estimate it.
pub fn denoised<'s>(samples: &'s [i16], speech: &Range<usize>) -> Cow<'s, [i16]> {
    // The transforms fail only on buffers of the wrong length, and all of them are made here.
    let output = reduce_noise(samples, speech).ok().flatten();
    output.map_or(Cow::Borrowed(samples), Cow::Owned)
}

fn reduce_noise(samples: &[i16], speech: &Range<usize>) -> Result<Option<Vec<i16>>, FftError> {
    let mut planner = RealFftPlanner::new();
    let window: Vec<f32> =
        (0..FRAME).map(|n| (PI * (n as f32 + 0.5) / FRAME as f32).sin()).collect();
    let mut spectra = analyse(samples, &window, &mut planner)?;
    let Some(noise) = noise(&spectra, samples.len(), speech) else { return Ok(None) };
    let gain_min = gain_min(&spectra, &noise, speech);
    if gain_min >= 1.0 {
        return Ok(None);
    }
    suppress(&mut spectra, &noise, gain_min);
    synthesise(&mut spectra, samples.len(), &window, &mut planner).map(Some)
}

/// First sample of frame `n`; the first frames begin before the audio.
fn start(n: usize) -> isize {
    (n * HOP) as isize - (FRAME - HOP) as isize
}

fn analyse(
    samples: &[i16],
    window: &[f32],
    planner: &mut RealFftPlanner<f32>,
) -> Result<Vec<Spectrum>, FftError> {
    let transform = planner.plan_fft_forward(FRAME);
    let frames = (samples.len() + FRAME - HOP).div_ceil(HOP);
    let sample = |at: isize| {
        usize::try_from(at).ok().and_then(|at| samples.get(at)).map_or(0.0, |&s| f32::from(s))
    };
    (0..frames)
        .map(|n| {
            let windowed = |(i, w): (usize, &f32)| sample(start(n) + i as isize) * w;
            let mut frame: Vec<f32> = window.iter().enumerate().map(windowed).collect();
            let mut spectrum = transform.make_output_vec();
            transform.process(&mut frame, &mut spectrum).map(|()| spectrum)
        })
        .collect()
}

/// Returns the mean power of each frequency outside the speech.
fn noise(spectra: &[Spectrum], len: usize, speech: &Range<usize>) -> Option<Vec<f32>> {
    let (from, to) = (speech.start.saturating_sub(EDGE) as isize, (speech.end + EDGE) as isize);
    let quiet = |n: &usize| {
        let (first, end) = (start(*n), start(*n) + FRAME as isize);
        first >= 0 && end <= len as isize && (end <= from || first >= to)
    };
    let quiet: Vec<usize> = (0..spectra.len()).filter(quiet).collect();
    if quiet.len() < FRAMES_MIN {
        return None;
    }
    let mean = |k: usize| {
        quiet.iter().map(|&n| spectra[n][k].norm_sqr()).sum::<f32>() / quiet.len() as f32
    };
    let means: Vec<f32> = (0..BINS).map(mean).collect();
    // Few frames make a rough estimate; neighbouring frequencies have similar noise.
    let smooth = |k: usize| {
        let (below, above) = (means[k.saturating_sub(1)], means[(k + 1).min(BINS - 1)]);
        // Digital silence still has the power of rounding.
        ((below + 2.0 * means[k] + above) / 4.0).max(1.0)
    };
    Some((0..BINS).map(smooth).collect())
}

/// Returns the gain that puts the noise [`CLEAR_DB`] below the voice.
fn gain_min(spectra: &[Spectrum], noise: &[f32], speech: &Range<usize>) -> f32 {
    let spoken = |n: &usize| {
        let first = start(*n);
        first >= speech.start as isize && first + FRAME as isize <= speech.end as isize
    };
    let frames: Vec<usize> = (0..spectra.len()).filter(spoken).collect();
    let band = |n: usize| spectra[n][BAND].iter().map(Complex::norm_sqr).sum::<f32>();
    let noise: f32 = noise[BAND].iter().sum();
    let loud = frames.iter().map(|&n| band(n)).sum::<f32>() / frames.len().max(1) as f32;
    let voice = (loud - noise).max(noise * 0.1);
    (10_f32.powf(-CLEAR_DB / 20.0) * (voice / noise).sqrt()).max(GAIN_MIN)
}

fn suppress(spectra: &mut [Spectrum], noise: &[f32], gain_min: f32) {
    let mut clean_before = vec![0.0; BINS];
    for spectrum in spectra {
        for (k, clean_before) in clean_before.iter_mut().enumerate() {
            let power = spectrum[k].norm_sqr();
            let posterior = (power / noise[k]).min(POSTERIOR_MAX);
            let now = (posterior - 1.0).max(0.0);
            let prior = SMOOTHING * *clean_before / noise[k] + (1.0 - SMOOTHING) * now;
            let gain = log_amplitude_gain(prior.max(PRIOR_MIN), posterior);
            *clean_before = gain * gain * power;
            spectrum[k] *= gain.max(gain_min);
        }
    }
}

fn synthesise(
    spectra: &mut [Spectrum],
    len: usize,
    window: &[f32],
    planner: &mut RealFftPlanner<f32>,
) -> Result<Vec<i16>, FftError> {
    let transform = planner.plan_fft_inverse(FRAME);
    let mut audio = vec![0.0_f32; len];
    let mut frame = transform.make_output_vec();
    // The squares of four overlapping sine windows sum to two; the transform is not normalised.
    let scale = HOP as f32 * 2.0 / FRAME as f32 / FRAME as f32;
    for (n, spectrum) in spectra.iter_mut().enumerate() {
        transform.process(spectrum, &mut frame)?;
        for (i, (value, w)) in frame.iter().zip(window).enumerate() {
            let at = usize::try_from(start(n) + i as isize).ok();
            if let Some(sample) = at.and_then(|at| audio.get_mut(at)) {
                *sample += value * w * scale;
            }
        }
    }
    // The cast saturates: values beyond full scale are clipped.
    Ok(audio.into_iter().map(|s| s.round() as i16).collect())
}

/// Returns the gain of equation 20 of Ephraim and Malah 1985 for the signal-to-noise ratios `prior`
/// and `posterior`.
fn log_amplitude_gain(prior: f32, posterior: f32) -> f32 {
    let share = prior / (1.0 + prior);
    (share * (0.5 * exponential_integral(share * posterior)).exp()).min(1.0)
}

/// Returns `E1(x)`, the integral of `e^-t / t` from `x` to infinity, to 2 % (Abramowitz and Stegun
/// 1964, 5.1.53 below 1 and 5.1.54 above).
fn exponential_integral(x: f32) -> f32 {
    let x = x.max(1e-6);
    if x < 1.0 {
        let series = [-0.577_22, 0.999_99, -0.249_91, 0.055_20, -0.009_76, 0.001_08];
        return series.iter().rev().fold(0.0, |sum, c| sum * x + c) - x.ln();
    }
    let above = x * x + 2.334_733 * x + 0.250_621;
    let below = x * x + 3.330_657 * x + 1.681_534;
    above / below * (-x).exp() / x
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::devices::random::{Rng, signed};
    use crate::devices::testing::voice;

    const QUIET: usize = 8_000;

    /// Returns a second of voice with half a second around it, clean and with noise.
    fn spoken(noise: f32) -> (Vec<i16>, Vec<i16>, Range<usize>) {
        let voice = voice(1.0);
        let clean = [&vec![0; QUIET][..], &voice, &vec![0; QUIET]].concat();
        let mut rng = Rng::new(11);
        let noisy = clean.iter().map(|&s| s.saturating_add((noise * signed(&mut rng)) as i16));
        (clean.clone(), noisy.collect(), QUIET..QUIET + voice.len())
    }

    fn power_of(samples: impl IntoIterator<Item = f32>) -> f32 {
        let (mut sum, mut len) = (0.0, 0.0_f32);
        for sample in samples {
            sum += sample * sample;
            len += 1.0;
        }
        sum / len.max(1.0)
    }

    fn error(output: &[i16], clean: &[i16], within: &Range<usize>) -> f32 {
        let of = |samples: &[i16]| samples[within.clone()].to_vec();
        power_of(of(output).into_iter().zip(of(clean)).map(|(a, b)| f32::from(a) - f32::from(b)))
    }

    #[test]
    fn denoise_removes_noise_and_keeps_the_voice() {
        let (clean, noisy, speech) = spoken(1_500.0);
        let output = denoised(&noisy, &speech);
        assert_eq!(output.len(), noisy.len());
        let quiet = 1_000..QUIET - EDGE;
        assert!(error(&output, &clean, &quiet) < error(&noisy, &clean, &quiet) / 10.0);
        assert!(error(&output, &clean, &speech) < error(&noisy, &clean, &speech) / 2.0);
    }

    #[test]
    fn denoise_leaves_clean_speech_unchanged() {
        let (clean, _, speech) = spoken(0.0);
        let output = denoised(&clean, &speech);
        assert!(matches!(output, Cow::Borrowed(same) if same == clean));
    }

    #[test]
    fn denoise_leaves_speech_without_surrounding_quiet_unchanged() {
        let (_, noisy, speech) = spoken(1_500.0);
        for samples in [&noisy[speech.clone()], &[], &[1; 5]] {
            let output = denoised(samples, &(0..samples.len()));
            assert!(matches!(output, Cow::Borrowed(same) if same == samples));
        }
    }

    #[test]
    fn exponential_integral_matches_the_tables() {
        for (x, e1) in [(0.01, 4.037_93), (0.1, 1.822_92), (1.0, 0.219_384), (5.0, 0.001_148_3)] {
            assert!((exponential_integral(x) / e1 - 1.0).abs() < 0.02, "E1({x})");
        }
    }
}
