//! Shared test data: scenes and a synthetic voice.

use std::f64::consts::{PI, TAU};

use messages::{RequestKey, Source};
use scene::Scene;
use service::Time;

use crate::devices::audio::RATE_HZ;
use crate::stream_events::{Began, LIVE_FROM};

/// Returns the six bowls.
pub(crate) fn bowls() -> Scene {
    let text = include_str!("../../../../config/scenes/bowls.toml");
    Scene::from_toml("bowls.toml", text).expect("a valid scene")
}

/// Returns the ten tools.
pub(crate) fn tools() -> Scene {
    let text = include_str!("../../../../config/scenes/tools.toml");
    Scene::from_toml("tools.toml", text).expect("a valid scene")
}

/// Returns the beginning of an utterance at a time.
pub(crate) fn began(at: Time) -> Began {
    Began {
        sound: LIVE_FROM,
        at,
        stream: RequestKey([7; 16]),
        segment: None,
        source: Source::Microphone,
        interrupts: false,
    }
}

/// Returns a buzz with falling pitch and formants that glide from vowel to vowel, four syllables per
/// second, which a detector classifies as voice.
pub(crate) fn voice(seconds: f64) -> Vec<i16> {
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
