//! The sound of a user in a room: synthesised voices, and pink noise under them.

use std::path::Path;

use dialogue::Rng;
use speech::devices::voice::{Program, Synthesiser, VoiceOptions};

/// Level of every voice: root mean square of its samples.
pub const SPEECH_RMS: f64 = 2_000.0;

/// A synthesised voice.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Speaker {
    /// The program's name of the voice.
    pub name: &'static str,
    /// True if flite speaks; else espeak-ng.
    flite: bool,
    words_per_minute: u16,
}

/// Voices of both kinds: formants (harder to recognise than people) and cuts of recorded people.
pub const SPEAKERS: [Speaker; 5] = [
    Speaker::espeak("en-us", 150),
    Speaker::espeak("en-us+f2", 165),
    Speaker::espeak("en-gb", 145),
    Speaker::flite("slt"),
    Speaker::flite("rms"),
];

impl Speaker {
    /// A voice of espeak-ng.
    pub const fn espeak(name: &'static str, words_per_minute: u16) -> Self {
        Self { name, flite: false, words_per_minute }
    }

    /// A voice of flite at its own pace.
    pub const fn flite(name: &'static str) -> Self {
        Self { name, flite: true, words_per_minute: 165 }
    }

    /// The voice at `factor` times its pace.
    pub fn at_pace(self, factor: f64) -> Self {
        let words_per_minute = (f64::from(self.words_per_minute) * factor).round() as u16;
        Self { words_per_minute, ..self }
    }

    /// Program and name: `espeak-ng en-gb`.
    pub fn title(&self) -> String {
        format!("{} {}", if self.flite { "flite" } else { "espeak-ng" }, self.name)
    }

    /// The voice, working in a folder of its own.
    pub fn synthesiser(&self, work: &Path) -> Synthesiser {
        let (flite, espeak_ng) = ("flite".into(), "espeak-ng".into());
        let program = if self.flite { Program::Flite(flite) } else { Program::EspeakNg(espeak_ng) };
        let (voice, words_per_minute) = (self.name.to_owned(), self.words_per_minute);
        let options = VoiceOptions { program, voice, words_per_minute, ..VoiceOptions::new(work) };
        Synthesiser::new(&options)
    }
}

/// Scales speech to [`SPEECH_RMS`].
pub fn levelled(samples: &[i16]) -> Vec<i16> {
    let squares: f64 = samples.iter().map(|&s| f64::from(s) * f64::from(s)).sum();
    let rms = (squares / samples.len().max(1) as f64).sqrt().max(1.0);
    let limit = f64::from(i16::MAX);
    let loud = |s: &i16| (f64::from(*s) * SPEECH_RMS / rms).clamp(-limit, limit) as i16;
    samples.iter().map(loud).collect()
}

/// Pink noise: white noise through Kellet's filter, within half a decibel of 1/f from 10 Hz on.
#[derive(Clone, Debug)]
pub struct Pink {
    rng: Rng,
    state: [f64; 7],
    gain: f64,
}

/// The filter's decays and weights.
const POLES: [(f64, f64); 6] = [
    (0.998_86, 0.055_517_9),
    (0.993_32, 0.075_075_9),
    (0.969, 0.153_852),
    (0.866_5, 0.310_485_6),
    (0.55, 0.532_952_2),
    (-0.761_6, -0.016_898),
];

impl Pink {
    /// Noise of this root mean square.
    pub fn new(rms: f64, seed: u64) -> Self {
        let mut noise = Self { rng: Rng::new(seed), state: [0.0; 7], gain: 1.0 };
        let n = 65_536;
        let squares: f64 = (0..n).map(|_| noise.next().powi(2)).sum();
        noise.gain = rms / (squares / f64::from(n)).sqrt();
        noise
    }

    /// The next sample.
    #[allow(clippy::should_implement_trait, reason = "noise never ends")]
    pub fn next(&mut self) -> f64 {
        let white = 2.0 * self.rng.uniform() - 1.0;
        let [poles @ .., last] = &mut self.state;
        let mut sum = *last + white * 0.536_2;
        for (state, (decay, weight)) in poles.iter_mut().zip(POLES) {
            *state = decay * *state + weight * white;
            sum += *state;
        }
        *last = white * 0.115_926;
        self.gain * sum
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pink_noise_has_its_level_and_falls_by_three_decibels_per_octave() {
        let seed = 3;
        let mut noise = Pink::new(250.0, seed);
        let n = 1 << 16;
        let samples: Vec<f64> = (0..n).map(|_| noise.next()).collect();
        let rms = |s: &[f64]| (s.iter().map(|x| x * x).sum::<f64>() / s.len() as f64).sqrt();
        assert!((rms(&samples) / 250.0 - 1.0).abs() < 0.15, "seed {seed}: {}", rms(&samples));
        // Differences weigh high tones by their frequency: white noise would give √2.
        let differences: Vec<f64> = samples.windows(2).map(|w| w[1] - w[0]).collect();
        let ratio = rms(&differences) / rms(&samples);
        assert!((0.3..1.0).contains(&ratio), "seed {seed}: {ratio}");
    }

    #[test]
    fn every_voice_has_the_same_level() {
        let quiet: Vec<i16> = (0..16_000).map(|n| if n % 2 == 0 { 40 } else { -40 }).collect();
        assert!(levelled(&quiet).iter().all(|s| s.unsigned_abs() == SPEECH_RMS as u16));
        assert_eq!(levelled(&[]), Vec::<i16>::new());
    }
}
