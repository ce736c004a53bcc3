//! The sound of a user in a room: synthesised voices, and noise under them.

use std::path::Path;

use speech_engines::voice::{Program, Synthesiser, VoiceOptions};
use vocabulary::Rng;

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
        let squares: f64 = (0..n).map(|_| noise.sample().powi(2)).sum();
        noise.gain = rms / (squares / f64::from(n)).sqrt();
        noise
    }

    fn sample(&mut self) -> f64 {
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

/// Noise never ends.
impl Iterator for Pink {
    type Item = f64;

    fn next(&mut self) -> Option<f64> {
        Some(self.sample())
    }
}

/// Returns samples of other speakers at once, repeated from random places on, of power 1.
pub fn babble(len: usize, speakers: &[Vec<i16>], seed: u64) -> Vec<f64> {
    let mut rng = Rng::new(seed);
    let mut sum = vec![0.0; len];
    for voice in speakers.iter().filter(|voice| !voice.is_empty()) {
        let level = rms(voice.iter().map(|&s| f64::from(s)));
        let from = (rng.uniform() * voice.len() as f64) as usize;
        let cycle = voice.iter().cycle().skip(from);
        sum.iter_mut().zip(cycle).for_each(|(sum, s)| *sum += f64::from(*s) / level);
    }
    let level = rms(sum.iter().copied());
    sum.into_iter().map(|s| s / level).collect()
}

fn rms(samples: impl ExactSizeIterator<Item = f64>) -> f64 {
    let n = samples.len().max(1) as f64;
    (samples.map(|s| s * s).sum::<f64>() / n).sqrt().max(f64::MIN_POSITIVE)
}

/// What sounds in a room beside its user.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Noise {
    /// Steady pink noise.
    Steady,
    /// Six people who talk to each other.
    Babble,
}

/// People who talk beside the user, and about what. None is a user's voice.
const TALKERS: [(Speaker, &str); 6] = [
    (
        Speaker::espeak("en-us+m3", 160),
        "did you see the match last night they played so badly in the second half that my brother \
         switched it off and went for a walk with the dog",
    ),
    (
        Speaker::espeak("en-gb+f3", 170),
        "we wanted to take the early train but the whole line was closed and nobody at the station \
         could tell us when it would open again",
    ),
    (
        Speaker::espeak("en-us+f5", 155),
        "my sister has moved to another town and she says that the flats there cost half as much \
         although the office is an hour away",
    ),
    (
        Speaker::flite("awb"),
        "the doctor told him to sleep more and to work less which is easy to say when you have three \
         children and a garden",
    ),
    (
        Speaker::flite("kal16"),
        "I read that book twice and still do not understand why she goes back to the island in the \
         last chapter",
    ),
    (
        Speaker::espeak("en-gb-scotland+m2", 150),
        "if it rains on saturday we could go to the museum and eat something afterwards in that small \
         place behind the theatre",
    ),
];
/// Length after which their talk repeats, samples: one minute.
const TALK: usize = 60 * 16_000;

impl Noise {
    /// Returns its samples, 16 kHz, of this root mean square. Voices are synthesised in `work`.
    ///
    /// # Panics
    /// If a voice is not installed.
    pub fn sound(self, rms: f64, seed: u64, work: &Path) -> Box<dyn Iterator<Item = f64> + Send> {
        match self {
            Self::Steady => Box::new(Pink::new(rms, seed)),
            Self::Babble => {
                let mut speak = |(speaker, text): &(Speaker, &str)| {
                    speaker.synthesiser(work).samples(text).expect("a synthesised voice")
                };
                let talk: Vec<Vec<i16>> = TALKERS.iter().map(&mut speak).collect();
                let sum = babble(TALK, &talk, seed);
                Box::new(sum.into_iter().cycle().map(move |s| s * rms))
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pink_noise_has_its_level_and_falls_by_three_decibels_per_octave() {
        let seed = 3;
        let noise = Pink::new(250.0, seed);
        let n = 1 << 16;
        let samples: Vec<f64> = noise.take(n).collect();
        let rms = |s: &[f64]| (s.iter().map(|x| x * x).sum::<f64>() / s.len() as f64).sqrt();
        assert!((rms(&samples) / 250.0 - 1.0).abs() < 0.15, "seed {seed}: {}", rms(&samples));
        // Differences weigh high tones by their frequency: white noise would give √2.
        let differences: Vec<f64> = samples.windows(2).map(|w| w[1] - w[0]).collect();
        let ratio = rms(&differences) / rms(&samples);
        assert!((0.3..1.0).contains(&ratio), "seed {seed}: {ratio}");
    }

    #[test]
    fn babble_has_power_one_and_every_voice_its_share() {
        let voice = |period: usize, level: i16| -> Vec<i16> {
            (0..16_000).map(|n| if n % period < period / 2 { level } else { -level }).collect()
        };
        let seed = 4;
        let [loud, quiet] = [voice(40, 9_000), voice(64, 90)];
        let samples = babble(16_000, &[loud, quiet, Vec::new()], seed);
        assert!((rms(samples.iter().copied()) - 1.0).abs() < 1e-9);
        // Two square waves of the same level: their sum is 0 or twice that level.
        let top = samples.iter().fold(0.0_f64, |top, s| top.max(s.abs()));
        let silent = samples.iter().filter(|s| s.abs() < 1e-9).count();
        assert!(top > 1.3 && silent > 4_000, "seed {seed}: {top}, {silent}");
        assert!(babble(9, &[], seed).iter().all(|s| *s == 0.0));
    }

    #[test]
    fn every_voice_has_the_same_level() {
        let quiet: Vec<i16> = (0..16_000).map(|n| if n % 2 == 0 { 40 } else { -40 }).collect();
        assert!(levelled(&quiet).iter().all(|s| s.unsigned_abs() == SPEECH_RMS as u16));
        assert_eq!(levelled(&[]), Vec::<i16>::new());
    }
}
