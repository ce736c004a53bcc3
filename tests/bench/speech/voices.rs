//! Synthesised sentences.

use super::conditions::Condition;
use ::speech_engines::audio::RATE_HZ;
use std::path::PathBuf;
use std::process::{Command, Stdio};
use std::sync::{Mutex, PoisonError};
use whichone_tests::spoken::Speaker;

/// Speaks, and keeps what was spoken in `target/bench/speech`.
pub(super) struct Voices {
    folder: PathBuf,
    /// Held while a sentence is synthesised: the programs write to files of the same name.
    speaking: Mutex<()>,
}

/// Loudest sample of a sentence: 6 dB below full scale.
const PEAK: f32 = 32_767.0 * 0.501;
/// Power of what counts as voice: programs pad with silence of their own.
const VOICE_RMS: f64 = 200.0;
/// Over which that power is taken: 10 ms.
const STRETCH: usize = RATE_HZ as usize / 100;

impl Voices {
    pub(super) fn new() -> std::io::Result<Self> {
        let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/../target/bench/speech");
        std::fs::create_dir_all(folder)?;
        Ok(Self { folder: folder.into(), speaking: Mutex::default() })
    }

    /// The first of the programs that is not installed.
    pub(super) fn missing() -> Option<&'static str> {
        let starts = |program: &str| {
            let mut asked = Command::new(program);
            asked.arg("--version").stdout(Stdio::null()).stderr(Stdio::null()).status().is_ok()
        };
        ["espeak-ng", "flite"].into_iter().find(|program| !starts(program))
    }

    /// The sentence in a condition's manner of speaking, without silence around it, as 16 kHz samples.
    pub(super) fn speak(&self, speaker: &Speaker, manner: &Condition, text: &str) -> Vec<i16> {
        // What is played faster is higher: it is spoken the slower before.
        let spoken = self.speak_at(speaker, manner.pace / manner.pitch, text);
        if manner.pitch == 1.0 {
            return spoken;
        }
        let samples: Vec<f32> = spoken.iter().map(|&s| f32::from(s)).collect();
        let played_hz = (f64::from(RATE_HZ) * manner.pitch) as u32;
        let higher = audio::resample(&samples, played_hz, RATE_HZ).expect("rates above zero");
        higher.into_iter().map(|s| s as i16).collect()
    }

    fn speak_at(&self, speaker: &Speaker, pace: f64, text: &str) -> Vec<i16> {
        let letters = |c: char| if c.is_ascii_alphanumeric() { c } else { '-' };
        let pace_name = if pace == 1.0 { String::new() } else { format!(" {pace:.2}") };
        let name = format!("{}{pace_name} {text}", speaker.title());
        let mut name: String = name.chars().map(letters).collect();
        // What is longer may share its beginning with another sentence; so its length stands there.
        if name.len() > 150 {
            name.truncate(150);
            name += &text.len().to_string();
        }
        let cached = self.folder.join(name).with_extension("s16");
        let _speaking = self.speaking.lock().unwrap_or_else(PoisonError::into_inner);
        if let Ok(bytes) = std::fs::read(&cached) {
            return bytes.chunks_exact(2).map(|b| i16::from_le_bytes([b[0], b[1]])).collect();
        }
        let spoken = speaker.at_pace(pace).synthesiser(&self.folder).samples(text);
        let spoken = spoken.unwrap_or_else(|error| panic!("{text:?}: {error}"));
        let samples = trimmed(&normalised(&spoken));
        let bytes: Vec<u8> = samples.iter().flat_map(|s| s.to_le_bytes()).collect();
        std::fs::write(&cached, bytes).expect("room for a sentence");
        samples
    }
}

fn normalised(samples: &[i16]) -> Vec<i16> {
    let peak = samples.iter().map(|s| s.unsigned_abs()).max().unwrap_or(0).max(1);
    let gain = PEAK / f32::from(peak);
    samples.iter().map(|&s| (f32::from(s) * gain) as i16).collect()
}

fn trimmed(samples: &[i16]) -> Vec<i16> {
    let power = |at: usize| {
        let from = at.saturating_sub(STRETCH / 2);
        let stretch = &samples[from..(from + STRETCH).min(samples.len())];
        stretch.iter().map(|&s| f64::from(s) * f64::from(s)).sum::<f64>() / STRETCH as f64
    };
    let loud = |at: &usize| power(*at) > VOICE_RMS * VOICE_RMS;
    let first = (0..samples.len()).find(loud).unwrap_or(0);
    let last = (0..samples.len()).rev().find(loud).unwrap_or(0);
    samples[first..=last.max(first).min(samples.len().saturating_sub(1))].to_vec()
}
