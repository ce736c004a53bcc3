//! A line of the robot on its way to mirrors: its sound, at a quarter of the file's size.
//!
//! A question's file takes 0.25 s at 2 Mbit/s. IMA ADPCM (IMA Digital Audio Focus and Technical
//! Working Groups, Recommended Practices 3.00, 1992): four bits a sample, no look-ahead.

use std::io::Cursor;
use std::ops::RangeInclusive;

use audio_codec_algorithms::{AdpcmImaState, decode_adpcm_ima, encode_adpcm_ima};
use hound::{SampleFormat, WavReader, WavSpec, WavWriter};
use messages::SoundFile;
use serde::{Deserialize, Serialize};

/// Version of the codes: the other end reads those of its own version alone.
const VERSION: u8 = 3;
/// Sample rates, hertz. Others, 0 among them, are of no sound.
const RATES_HZ: RangeInclusive<u32> = 1_000..=192_000;
/// Largest line, bytes: more than five minutes of speech.
const BYTES_MAX: usize = 4 << 20;

/// A line as sent.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Line {
    /// Name of the line's file.
    pub file: String,
    /// Sound of the line.
    pub sound: Packed,
}

/// The sound in a WAV file.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub enum Packed {
    /// One channel of 16 bits.
    Adpcm {
        /// Samples per second.
        rate_hz: u32,
        /// Two samples a byte, the earlier one in its low half.
        codes: Vec<u8>,
    },
    /// Any other file, unchanged.
    File(Vec<u8>),
}

impl Line {
    /// Returns the bytes that travel; `None` for more than a mirror takes.
    pub fn encode(&self) -> Option<Vec<u8>> {
        postcard::to_stdvec(&(VERSION, self)).ok().filter(|bytes| bytes.len() <= BYTES_MAX)
    }

    /// Returns the file with the line's sound. Another version, or a key thief, may have sent it.
    pub fn decode(bytes: &[u8]) -> Option<(SoundFile, Vec<u8>)> {
        let bytes = Some(bytes).filter(|bytes| bytes.len() <= BYTES_MAX)?;
        let (version, Self { file, sound }) = postcard::from_bytes::<(u8, Self)>(bytes).ok()?;
        if version != VERSION {
            return None;
        }
        Some((SoundFile::parse(&file)?, sound.file()?))
    }
}

impl Packed {
    /// Packs a file.
    pub fn of(file: Vec<u8>) -> Self {
        Self::adpcm(&file).unwrap_or(Self::File(file))
    }

    fn adpcm(file: &[u8]) -> Option<Self> {
        let reader = WavReader::new(Cursor::new(file)).ok()?;
        let rate_hz = reader.spec().sample_rate;
        if reader.spec() != plain(rate_hz) || !RATES_HZ.contains(&rate_hz) {
            return None;
        }
        let samples: Vec<i16> = reader.into_samples().collect::<Result<_, _>>().ok()?;
        let mut state = AdpcmImaState::new();
        let byte = |pair: &[i16]| {
            let mut code = |n: usize| pair.get(n).map_or(0, |it| encode_adpcm_ima(*it, &mut state));
            code(0) | code(1) << 4
        };
        Some(Self::Adpcm { rate_hz, codes: samples.chunks(2).map(byte).collect() })
    }

    /// Returns the file; `None` if it is not a sound.
    fn file(self) -> Option<Vec<u8>> {
        match self {
            Self::Adpcm { rate_hz, codes } if RATES_HZ.contains(&rate_hz) => {
                let mut state = AdpcmImaState::new();
                let codes = codes.iter().flat_map(|byte| [byte & 15, byte >> 4]);
                wav(rate_hz, codes.map(|code| decode_adpcm_ima(code, &mut state))).ok()
            }
            Self::Adpcm { .. } => None,
            Self::File(file) => Some(file),
        }
    }
}

/// The file that is packed and unpacked: one channel of 16 bits.
fn plain(sample_rate: u32) -> WavSpec {
    let (channels, bits_per_sample, sample_format) = (1, 16, SampleFormat::Int);
    WavSpec { channels, sample_rate, bits_per_sample, sample_format }
}

fn wav(rate_hz: u32, samples: impl Iterator<Item = i16>) -> Result<Vec<u8>, hound::Error> {
    let mut file = Cursor::new(Vec::new());
    let mut writer = WavWriter::new(&mut file, plain(rate_hz))?;
    for sample in samples {
        writer.write_sample(sample)?;
    }
    writer.finalize()?;
    Ok(file.into_inner())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn file(samples: &[i16]) -> Vec<u8> {
        wav(22_050, samples.iter().copied()).unwrap()
    }

    fn samples(file: &[u8]) -> Vec<i16> {
        let reader = WavReader::new(file).unwrap();
        assert_eq!(reader.spec().sample_rate, 22_050);
        reader.into_samples().map(Result::unwrap).collect()
    }

    /// A vowel: harmonics of 120 Hz up to 3 kHz that become weaker, in syllables.
    fn voice() -> Vec<i16> {
        let at = |n: i32| {
            let t = f64::from(n) / 22_050.0;
            let of =
                |k: i32| (t * std::f64::consts::TAU * 120.0 * f64::from(k)).sin() / f64::from(k);
            let syllable = (t * std::f64::consts::TAU * 4.0).sin().max(0.0);
            (8_000.0 * syllable * (1..=25).map(of).sum::<f64>()) as i16
        };
        (0..22_050).map(at).collect()
    }

    #[test]
    fn a_line_is_a_quarter_of_its_file_and_sounds_as_it() {
        let said = voice();
        let packed = Packed::of(file(&said));
        let bytes = postcard::to_stdvec(&packed).unwrap().len();
        assert!(bytes * 100 < file(&said).len() * 26, "{bytes}");
        let heard = samples(&packed.file().unwrap());
        assert_eq!(heard.len(), said.len());
        let power = |of: &mut dyn Iterator<Item = f64>| of.map(|it| it * it).sum::<f64>();
        let signal = power(&mut said.iter().map(|it| f64::from(*it)));
        let noise = power(&mut said.iter().zip(&heard).map(|(a, b)| f64::from(*a) - f64::from(*b)));
        let db = 10.0 * (signal / noise).log10();
        assert!(db > 20.0, "{db} dB");
    }

    #[test]
    fn the_loudest_sounds_stay_in_range() {
        let said: Vec<i16> =
            (0..999).map(|n| if n % 7 < 3 { i16::MIN } else { i16::MAX }).collect();
        let heard = samples(&Packed::of(file(&said)).file().unwrap());
        assert_eq!(heard.len(), 1_000, "two a byte");
        let signs = said.iter().zip(&heard).filter(|(a, b)| a.signum() == b.signum()).count();
        assert!(signs > 950, "{signs}");
        assert!(samples(&Packed::of(file(&[])).file().unwrap()).is_empty());
        assert_eq!(samples(&Packed::of(file(&[0])).file().unwrap()).len(), 2);
    }

    #[test]
    fn what_is_no_line_is_none() {
        let line = |file: &str, sound| Line { file: file.to_owned(), sound }.encode();
        let sound = |rate_hz| Packed::Adpcm { rate_hz, codes: vec![0x17; 9] };
        let file = Line::decode(&line("line-1-1.wav", sound(16_000)).unwrap()).unwrap();
        assert_eq!(file.0.to_string(), "line-1-1.wav");
        for rate_hz in [0, 999, 192_001, u32::MAX] {
            assert_eq!(Line::decode(&line("line-1-1.wav", sound(rate_hz)).unwrap()), None);
        }
        assert_eq!(Line::decode(&line("../x", sound(16_000)).unwrap()), None);
        assert_eq!(Line::decode(b"RIFF and so on"), None);
        let of_another_version = (VERSION - 1, "line-1-1.wav", sound(16_000));
        assert_eq!(Line::decode(&postcard::to_stdvec(&of_another_version).unwrap()), None);
        let long = Packed::File(vec![0; BYTES_MAX]);
        assert_eq!(line("line-1-1.wav", long.clone()), None);
        let long = postcard::to_stdvec(&(VERSION, "line-1-1.wav", long));
        assert_eq!(Line::decode(&long.unwrap()), None);
    }

    #[test]
    fn other_files_travel_as_they_are() {
        for other in [b"RIFF".to_vec(), Vec::new(), [&file(&[1, 2])[..30], &[9]].concat()] {
            assert_eq!(Packed::of(other.clone()), Packed::File(other.clone()));
            assert_eq!(Packed::of(other.clone()).file(), Some(other));
        }
    }
}
