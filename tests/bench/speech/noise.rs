//! Sounds that are not the voice: steady noise, bursts, hum and music.
//!
//! All have power 1 unless stated otherwise, and are the same for the same seed.

use ::speech_engines::audio::RATE_HZ;
use realfft::RealFftPlanner;
use realfft::num_complex::Complex;
use std::f64::consts::TAU;
use vocabulary::Rng;

/// Returns noise that falls by 3 dB an octave, as that of most rooms does. Every frequency gets a
/// random amplitude and phase (Box and Muller), divided by the root of the frequency.
pub(super) fn pink(len: usize, seed: u64) -> Vec<f64> {
    let transform = RealFftPlanner::new().plan_fft_inverse(len.next_power_of_two());
    let (mut spectrum, mut noise) = (transform.make_input_vec(), transform.make_output_vec());
    let mut rng = Rng::new(seed);
    let [_, bins @ .., _] = &mut spectrum[..] else { unreachable!("a spectrum has two ends") };
    for (bin, k) in bins.iter_mut().zip(1..) {
        let radius = (-2.0 * (1.0 - rng.uniform()).ln()).sqrt();
        *bin = Complex::from_polar(radius / f64::from(k).sqrt(), TAU * rng.uniform());
    }
    transform.process(&mut spectrum, &mut noise).expect("vectors of the transform's own lengths");
    noise.truncate(len);
    levelled(noise)
}

/// Bursts per second.
const BURSTS: f64 = 2.0;

/// Returns knocks (resonances that decay in 50 ms) and clatter (noise that decays in 100 ms). Power 1 is
/// that of a burst's first 50 ms.
pub(super) fn bursts(len: usize, seed: u64) -> Vec<f64> {
    let mut rng = Rng::new(seed);
    let mut sum = vec![0.0; len];
    for n in 0..(len as f64 / f64::from(RATE_HZ) * BURSTS) as usize {
        let at = (rng.uniform() * len as f64) as usize;
        let burst = if n % 2 == 0 { knock(&mut rng) } else { clatter(&mut rng) };
        sum[at..].iter_mut().zip(burst).for_each(|(sum, sample)| *sum += sample);
    }
    sum
}

fn knock(rng: &mut Rng) -> Vec<f64> {
    let tones: Vec<f64> = (0..4).map(|_| 150.0 + 900.0 * rng.uniform()).collect();
    let sample = |t: f64| tones.iter().map(|hz| (TAU * hz * t).sin()).sum::<f64>();
    burst(0.05, sample)
}

fn clatter(rng: &mut Rng) -> Vec<f64> {
    let mut before = 0.0;
    let mut sample = |_| {
        let white = rng.uniform() - 0.5;
        // A difference: clatter is bright.
        white - std::mem::replace(&mut before, white)
    };
    burst(0.1, &mut sample)
}

/// Returns a sound that begins at once and falls by 60 dB in seven times `decay_s`.
fn burst(decay_s: f64, mut sample: impl FnMut(f64) -> f64) -> Vec<f64> {
    let len = samples(7.0 * decay_s);
    let time = |n: usize| n as f64 / f64::from(RATE_HZ);
    let sound: Vec<f64> = (0..len).map(|n| sample(time(n)) * (-time(n) / decay_s).exp()).collect();
    let loud = rms(&sound[..samples(0.05)]);
    sound.into_iter().map(|s| s / loud).collect()
}

/// Returns the hum of mains with its harmonics.
pub(super) fn hum(len: usize, hz: f64) -> Vec<f64> {
    let time = |n: usize| n as f64 / f64::from(RATE_HZ);
    let harmonic = |t: f64, k: i32| (TAU * hz * f64::from(k) * t).sin() / f64::from(k);
    let sample = |n: usize| (1..=9).map(|k| harmonic(time(n), k)).sum();
    levelled((0..len).map(sample).collect())
}

/// Length of a note, seconds.
const NOTE_S: f64 = 0.3;

/// Returns a melody of plucked notes with harmonics.
pub(super) fn melody(len: usize, seed: u64) -> Vec<f64> {
    const SCALE: [i32; 7] = [0, 2, 4, 5, 7, 9, 11];
    let mut rng = Rng::new(seed);
    let mut sum = Vec::with_capacity(len);
    while sum.len() < len {
        let step = SCALE[(rng.uniform() * 7.0) as usize];
        let hz = 261.6 * 2_f64.powf(f64::from(step) / 12.0 + (rng.uniform() * 2.0).floor());
        let note = (0..samples(NOTE_S)).map(|n| {
            let t = n as f64 / f64::from(RATE_HZ);
            let tone = |k: i32| (TAU * hz * f64::from(k) * t).sin() / f64::from(k);
            (1..=5).map(tone).sum::<f64>() * (-t / 0.2).exp()
        });
        sum.extend(note);
    }
    sum.truncate(len);
    levelled(sum)
}

/// Returns the samples at power 1; silence remains silence.
pub(super) fn levelled(samples: Vec<f64>) -> Vec<f64> {
    let level = rms(&samples).max(f64::MIN_POSITIVE);
    samples.into_iter().map(|s| s / level).collect()
}

pub(super) fn rms(samples: &[f64]) -> f64 {
    (samples.iter().map(|s| s * s).sum::<f64>() / samples.len().max(1) as f64).sqrt()
}

pub(super) fn samples(seconds: f64) -> usize {
    (seconds * f64::from(RATE_HZ)) as usize
}
