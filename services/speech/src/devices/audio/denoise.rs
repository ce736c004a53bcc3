//! Noise taken out of speech.
//!
//! The noise is learnt where nobody speaks, before and behind the voice, and each part of the
//! spectrum is turned down by what minimises the expected error of its log amplitude (Ephraim and
//! Malah 1985, equation 20, with the decision-directed estimate of 1984). The recogniser's features
//! are log amplitudes. Noise that changes while somebody speaks stays in.

use std::borrow::Cow;
use std::f32::consts::PI;
use std::ops::Range;

use super::RATE_HZ;
use super::spectrum::{Complex, Fourier};

/// Samples of a frame: 32 ms.
const FRAME: usize = 512;
/// From frame to frame: 8 ms. Four frames overlap everywhere.
const HOP: usize = 128;
/// Frequencies of a frame, from 0 to half the rate.
const BINS: usize = FRAME / 2 + 1;
/// What is as near to the voice as this counts as voice: the detector's edges are some 50 ms wide,
/// and consonants lie before them.
const EDGE: usize = RATE_HZ as usize / 10;
/// Frames without voice from which the noise can be told.
const FRAMES_MIN: usize = 8;
/// Share of the frame before in the estimate of how far the voice stands above the noise. Lower
/// values leave tones that come and go.
const MEMORY: f32 = 0.98;
/// How far the voice stands above the noise where no noise has to be taken out, decibels in the
/// recogniser's band. Taking out more than is needed costs voice: at 25 dB it turns more words wrong
/// than it turns right.
const CLEAR_DB: f32 = 30.0;
/// The least that is left of anything, 26 dB down: what is taken for noise may be voice.
const GAIN_MIN: f32 = 0.05;
/// The recogniser's band, 130 to 6800 Hz.
const BAND: Range<usize> = 4..218;
/// The least estimate of the power of voice over that of noise, 25 dB down.
const PRIOR_MIN: f32 = 0.003;
/// Power over that of the noise beyond which more makes no difference.
const POSTERIOR_MAX: f32 = 1_000.0;

/// The samples with as much less of the noise that lies around `speech` as they lack of
/// [`CLEAR_DB`]. Unchanged where they lack nothing, and where there is too little around the voice to
/// learn the noise from.
pub fn denoised<'s>(samples: &'s [i16], speech: &Range<usize>) -> Cow<'s, [i16]> {
    let fourier = Fourier::new(FRAME);
    let window: Vec<f32> =
        (0..FRAME).map(|n| (PI * (n as f32 + 0.5) / FRAME as f32).sin()).collect();
    let mut spectra = analyse(samples, &window, &fourier);
    let Some(noise) = noise(&spectra, samples.len(), speech) else {
        return Cow::Borrowed(samples);
    };
    let gain_min = gain_min(&spectra, &noise, speech);
    if gain_min >= 1.0 {
        return Cow::Borrowed(samples);
    }
    suppress(&mut spectra, &noise, gain_min);
    Cow::Owned(synthesise(spectra, samples.len(), &window, &fourier))
}

/// Where frame `n` begins; the first ones begin before the sound.
fn start(n: usize) -> isize {
    (n * HOP) as isize - (FRAME - HOP) as isize
}

fn analyse(samples: &[i16], window: &[f32], fourier: &Fourier) -> Vec<Vec<Complex>> {
    let frames = (samples.len() + FRAME - HOP).div_ceil(HOP);
    let sample = |at: isize| {
        usize::try_from(at).ok().and_then(|at| samples.get(at)).map_or(0.0, |&s| f32::from(s))
    };
    (0..frames)
        .map(|n| {
            let windowed = |(i, w): (usize, &f32)| (sample(start(n) + i as isize) * w, 0.0);
            let mut frame: Vec<Complex> = window.iter().enumerate().map(windowed).collect();
            fourier.forward(&mut frame);
            frame
        })
        .collect()
}

/// The mean power of each frequency where nobody speaks.
fn noise(spectra: &[Vec<Complex>], len: usize, speech: &Range<usize>) -> Option<Vec<f32>> {
    let (from, to) = (speech.start.saturating_sub(EDGE) as isize, (speech.end + EDGE) as isize);
    let quiet = |n: &usize| {
        let (first, end) = (start(*n), start(*n) + FRAME as isize);
        first >= 0 && end <= len as isize && (end <= from || first >= to)
    };
    let quiet: Vec<usize> = (0..spectra.len()).filter(quiet).collect();
    if quiet.len() < FRAMES_MIN {
        return None;
    }
    let mean =
        |k: usize| quiet.iter().map(|&n| power(spectra[n][k])).sum::<f32>() / quiet.len() as f32;
    let means: Vec<f32> = (0..BINS).map(mean).collect();
    // Some frames make a rough estimate; neighbouring frequencies have much the same noise.
    let smooth = |k: usize| {
        let (below, above) = (means[k.saturating_sub(1)], means[(k + 1).min(BINS - 1)]);
        // Digital silence still has the power of rounding.
        ((below + 2.0 * means[k] + above) / 4.0).max(1.0)
    };
    Some((0..BINS).map(smooth).collect())
}

/// What the noise is to be multiplied with to lie [`CLEAR_DB`] below the voice.
fn gain_min(spectra: &[Vec<Complex>], noise: &[f32], speech: &Range<usize>) -> f32 {
    let spoken = |n: &usize| {
        let first = start(*n);
        first >= speech.start as isize && first + FRAME as isize <= speech.end as isize
    };
    let frames: Vec<usize> = (0..spectra.len()).filter(spoken).collect();
    let band = |n: usize| spectra[n][BAND].iter().copied().map(power).sum::<f32>();
    let noise: f32 = noise[BAND].iter().sum();
    let loud = frames.iter().map(|&n| band(n)).sum::<f32>() / frames.len().max(1) as f32;
    let voice = (loud - noise).max(noise * 0.1);
    (10_f32.powf(-CLEAR_DB / 20.0) * (voice / noise).sqrt()).max(GAIN_MIN)
}

fn suppress(spectra: &mut [Vec<Complex>], noise: &[f32], gain_min: f32) {
    let mut clean_before = vec![0.0; BINS];
    for spectrum in spectra {
        for (k, clean_before) in clean_before.iter_mut().enumerate() {
            let power = power(spectrum[k]);
            let posterior = (power / noise[k]).min(POSTERIOR_MAX);
            let now = (posterior - 1.0).max(0.0);
            let prior = MEMORY * *clean_before / noise[k] + (1.0 - MEMORY) * now;
            let gain = log_amplitude_gain(prior.max(PRIOR_MIN), posterior);
            *clean_before = gain * gain * power;
            let gain = gain.max(gain_min);
            spectrum[k] = (spectrum[k].0 * gain, spectrum[k].1 * gain);
            if k > 0 && k < BINS - 1 {
                spectrum[FRAME - k] = (spectrum[k].0, -spectrum[k].1);
            }
        }
    }
}

fn synthesise(
    spectra: Vec<Vec<Complex>>,
    len: usize,
    window: &[f32],
    fourier: &Fourier,
) -> Vec<i16> {
    let mut sound = vec![0.0_f32; len];
    // The squares of four overlapping sine windows sum to two.
    let scale = HOP as f32 * 2.0 / FRAME as f32;
    for (n, mut frame) in spectra.into_iter().enumerate() {
        fourier.inverse(&mut frame);
        for (i, ((re, _), w)) in frame.into_iter().zip(window).enumerate() {
            let at = usize::try_from(start(n) + i as isize).ok();
            if let Some(sample) = at.and_then(|at| sound.get_mut(at)) {
                *sample += re * w * scale;
            }
        }
    }
    // The cast saturates: what exceeds full scale is clipped.
    sound.into_iter().map(|s| s.round() as i16).collect()
}

fn power((re, im): Complex) -> f32 {
    re * re + im * im
}

/// Ephraim and Malah 1985, equation 20: what an amplitude is multiplied with, for the voice's
/// power over the noise's before (`prior`) and after (`posterior`) the amplitude is seen.
fn log_amplitude_gain(prior: f32, posterior: f32) -> f32 {
    let share = prior / (1.0 + prior);
    (share * (0.5 * exponential_integral(share * posterior)).exp()).min(1.0)
}

/// `E1(x)`, the integral of `e^-t / t` from `x` on, to 2 % (Abramowitz and Stegun 1964, 5.1.53 below
/// 1 and 5.1.54 above).
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
    use crate::devices::random::SplitMix;
    use crate::devices::testing::voice;

    const QUIET: usize = 8_000;

    /// A second of voice with half a second around it, and the same with noise.
    fn spoken(noise: f32) -> (Vec<i16>, Vec<i16>, Range<usize>) {
        let voice = voice(1.0);
        let clean = [&vec![0; QUIET][..], &voice, &vec![0; QUIET]].concat();
        let mut random = SplitMix::new(11);
        let noisy = clean.iter().map(|&s| s.saturating_add((noise * random.signed()) as i16));
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

    fn error(heard: &[i16], clean: &[i16], within: &Range<usize>) -> f32 {
        let of = |samples: &[i16]| samples[within.clone()].to_vec();
        power_of(of(heard).into_iter().zip(of(clean)).map(|(a, b)| f32::from(a) - f32::from(b)))
    }

    #[test]
    fn noise_goes_and_the_voice_stays() {
        let (clean, noisy, speech) = spoken(1_500.0);
        let heard = denoised(&noisy, &speech);
        assert_eq!(heard.len(), noisy.len());
        let quiet = 1_000..QUIET - EDGE;
        assert!(error(&heard, &clean, &quiet) < error(&noisy, &clean, &quiet) / 10.0);
        assert!(error(&heard, &clean, &speech) < error(&noisy, &clean, &speech) / 2.0);
    }

    #[test]
    fn clean_speech_stays_as_it_is() {
        let (clean, _, speech) = spoken(0.0);
        let heard = denoised(&clean, &speech);
        assert!(matches!(heard, Cow::Borrowed(same) if same == clean));
    }

    #[test]
    fn without_quiet_around_it_nothing_is_changed() {
        let (_, noisy, speech) = spoken(1_500.0);
        for samples in [&noisy[speech.clone()], &[], &[1; 5]] {
            let heard = denoised(samples, &(0..samples.len()));
            assert!(matches!(heard, Cow::Borrowed(same) if same == samples));
        }
    }

    #[test]
    fn the_exponential_integral_is_that_of_the_tables() {
        for (x, e1) in [(0.01, 4.037_93), (0.1, 1.822_92), (1.0, 0.219_384), (5.0, 0.001_148_3)] {
            assert!((exponential_integral(x) / e1 - 1.0).abs() < 0.02, "E1({x})");
        }
    }
}
