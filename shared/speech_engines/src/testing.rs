//! Test data, also of the speech service: scenes and a synthetic voice.

use std::f64::consts::{PI, TAU};
use std::ops::Range;
use std::path::Path;

use messages::{RequestKey, Source};
use scene::Scene;
use vocabulary::time::Time;

use crate::audio::RATE_HZ;
use crate::stream::{Began, LIVE_FROM};
use crate::voice::{Program, Synthesiser, VoiceOptions};

/// Returns the six bowls.
pub fn bowls() -> Scene {
    let text = include_str!("../../../config/scenes/bowls.toml");
    Scene::from_toml("bowls.toml", text).expect("a valid scene")
}

/// Returns the ten tools.
pub fn tools() -> Scene {
    let text = include_str!("../../../config/scenes/tools.toml");
    Scene::from_toml("tools.toml", text).expect("a valid scene")
}

/// Returns the beginning of an utterance at a time.
pub fn began(at: Time) -> Began {
    Began {
        sound: LIVE_FROM,
        at,
        stream: RequestKey([7; 16]),
        segment: None,
        source: Source::Microphone,
        interrupts: false,
    }
}

/// Returns a buzz with falling pitch and formants that glide from vowel to vowel, four syllables
/// per second, which a detector classifies as voice.
pub fn voice(seconds: f64) -> Vec<i16> {
    const VOWELS: [[f64; 3]; 4] = [
        [730.0, 1_090.0, 2_440.0],
        [270.0, 2_290.0, 3_010.0],
        [570.0, 840.0, 2_410.0],
        [530.0, 1_840.0, 2_480.0],
    ];
    let rate = f64::from(RATE_HZ);
    let mut phase = 0.0;
    (0..(seconds * rate) as usize)
        .map(|n| {
            let t = n as f64 / rate;
            let pitch_hz = 130.0 - 20.0 * t + 8.0 * (TAU * 2.3 * t).sin();
            phase += TAU * pitch_hz / rate;
            let (vowel, glide) = ((t * 4.0) as usize, (t * 4.0).fract());
            let (from, to) = (VOWELS[vowel % 4], VOWELS[(vowel + 1) % 4]);
            let harmonic = |k: f64| {
                let formant = |f: usize| {
                    let centre = from[f] + (to[f] - from[f]) * glide;
                    1.0 / (1.0 + ((pitch_hz * k - centre) / 60.0).powi(2)) / (1 + f) as f64
                };
                (0..3).map(formant).sum::<f64>() + 0.02
            };
            let buzz: f64 = (1..=30)
                .map(|k| {
                    harmonic(f64::from(k)) * (phase * f64::from(k)).sin() / f64::from(k).sqrt()
                })
                .sum();
            let syllable = 0.15 + 0.85 * (PI * glide).sin();
            (buzz * syllable * 6_000.0) as i16
        })
        .collect()
}

/// A sentence with quiet on either side.
pub struct Said {
    /// Samples, 16 kHz mono.
    pub samples: Vec<i16>,
    /// Range of the voice.
    pub speech: Range<usize>,
}

/// Quiet before and after a sentence, samples.
const QUIET: usize = RATE_HZ as usize / 2;

/// Says a sentence, with files in `work`. A human voice is flite's, which is cut from recordings,
/// if that is installed; otherwise espeak-ng speaks.
pub fn say(text: &str, human: bool, work: &Path) -> Said {
    let flite = VoiceOptions {
        program: Program::Flite("flite".into()),
        voice: "slt".to_owned(),
        words_per_minute: 165,
        ..VoiceOptions::new(work)
    };
    let voice = |options: &VoiceOptions| Synthesiser::new(options).samples(text);
    let espeak_ng = || voice(&VoiceOptions::new(work)).expect("espeak-ng is installed");
    let voice = if human { voice(&flite).unwrap_or_else(|_| espeak_ng()) } else { espeak_ng() };
    let speech = QUIET..QUIET + voice.len();
    Said { samples: [&[0; QUIET][..], &voice, &[0; QUIET]].concat(), speech }
}
