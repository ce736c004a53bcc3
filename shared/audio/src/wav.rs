//! WAV files of any usual format, read as samples at the service's rate.

use std::fs::File;
use std::io::{self, Cursor, Read as _};
use std::path::{Path, PathBuf};

use hound::{SampleFormat, WavReader};

use super::{RATE_HZ, resample};

/// Error of reading a WAV file.
#[derive(Debug, thiserror::Error)]
pub enum WavError {
    /// Missing, or not readable.
    #[error("{} cannot be read: {source}", path.display())]
    Unreadable {
        /// The file.
        path: PathBuf,
        /// The system's reason.
        source: io::Error,
    },
    /// A folder, a device or a pipe: reading it could block forever.
    #[error("{} is not a regular file", path.display())]
    NotAFile {
        /// The path.
        path: PathBuf,
    },
    /// Not a WAV file, or damaged.
    #[error("{} is not a valid WAV file: {reason}", path.display())]
    NotWav {
        /// The file.
        path: PathBuf,
        /// Reason.
        reason: String,
    },
    /// An unsupported encoding.
    #[error("{}: {what}; help: convert it to 16 kHz, 16 bit, mono PCM", path.display())]
    Unsupported {
        /// The file.
        path: PathBuf,
        /// Unsupported property.
        what: String,
    },
    /// Shorter than its header says.
    #[error("{} is truncated: expected {announced_s:.1} s, found {found_s:.1} s", path.display())]
    Truncated {
        /// The file.
        path: PathBuf,
        /// Seconds according to its header.
        announced_s: f64,
        /// Seconds in the file.
        found_s: f64,
    },
    /// Without samples.
    #[error("{} contains no audio", path.display())]
    Empty {
        /// The file.
        path: PathBuf,
    },
    /// Longer than allowed.
    #[error("{} is longer than {longest_s} s", path.display())]
    TooLong {
        /// The file.
        path: PathBuf,
        /// The limit, seconds.
        longest_s: f64,
    },
}

/// Largest file: 64 MiB are 43 s of 192 kHz stereo float.
const BYTES_MAX: u64 = 64 << 20;
/// Lowest rate: below it consonants are lost.
const RATE_MIN_HZ: u32 = 8_000;
const RATE_MAX_HZ: u32 = 192_000;

/// Reads a WAV file of at most `longest_s` seconds as mono samples at [`RATE_HZ`]: 8 to 32 bit
/// integers or 32 bit floats, 8 to 192 kHz, any number of channels (their mean is taken).
///
/// # Errors
/// If the file is missing, not WAV, truncated, empty, too long, or of an unsupported encoding.
pub fn read_wav(path: &Path, longest_s: f64) -> Result<Vec<i16>, WavError> {
    let mut bytes = read(path, longest_s)?;
    repair_streamed_length(&mut bytes);
    let not_wav = |error: hound::Error| match error {
        hound::Error::Unsupported => WavError::Unsupported {
            path: path.to_owned(),
            what: "expected PCM or float samples".to_owned(),
        },
        hound::Error::IoError(_) => {
            WavError::NotWav { path: path.to_owned(), reason: "its header is truncated".to_owned() }
        }
        error => WavError::NotWav { path: path.to_owned(), reason: error.to_string() },
    };
    let mut wav = WavReader::new(Cursor::new(bytes)).map_err(not_wav)?;
    let (spec, frames) = (wav.spec(), wav.duration());
    if frames == 0 {
        return Err(WavError::Empty { path: path.to_owned() });
    }
    let unsupported = |what| Err(WavError::Unsupported { path: path.to_owned(), what });
    if !(RATE_MIN_HZ..=RATE_MAX_HZ).contains(&spec.sample_rate) {
        return unsupported(format!("expected 8 to 192 kHz, found {} Hz", spec.sample_rate));
    }
    let rate = f64::from(spec.sample_rate);
    if f64::from(frames) / rate > longest_s {
        return Err(WavError::TooLong { path: path.to_owned(), longest_s });
    }
    let wanted = wav.len() as usize;
    let samples: Vec<f32> = match spec.sample_format {
        SampleFormat::Int => {
            let full = (1_u64 << (spec.bits_per_sample - 1)) as f32;
            wav.samples::<i32>().map_while(Result::ok).map(|s| s as f32 / full).collect()
        }
        SampleFormat::Float => wav.samples::<f32>().map_while(Result::ok).collect(),
    };
    if samples.len() < wanted {
        let in_s = |n: usize| n as f64 / f64::from(spec.channels) / rate;
        let (announced_s, found_s) = (in_s(wanted), in_s(samples.len()));
        return Err(WavError::Truncated { path: path.to_owned(), announced_s, found_s });
    }
    if samples.iter().any(|s| !s.is_finite()) {
        return unsupported("it contains samples that are not numbers".to_owned());
    }
    let mono = mix_down(&samples, usize::from(spec.channels));
    match resample(&mono, spec.sample_rate, RATE_HZ) {
        Ok(samples) => Ok(quantise(&samples)),
        Err(reason) => unsupported(reason),
    }
}

fn read(path: &Path, longest_s: f64) -> Result<Vec<u8>, WavError> {
    let unreadable = |source| WavError::Unreadable { path: path.to_owned(), source };
    if !path.metadata().map_err(unreadable)?.is_file() {
        return Err(WavError::NotAFile { path: path.to_owned() });
    }
    let mut bytes = Vec::new();
    let file = File::open(path).map_err(unreadable)?;
    file.take(BYTES_MAX + 1).read_to_end(&mut bytes).map_err(unreadable)?;
    if bytes.len() as u64 > BYTES_MAX {
        return Err(WavError::TooLong { path: path.to_owned(), longest_s });
    }
    Ok(bytes)
}

/// Replaces the placeholder length that programs write into a pipe by the actual one.
fn repair_streamed_length(bytes: &mut [u8]) {
    const STREAMED_MIN: u32 = 0x7FFF_0000;
    let le = |bytes: &[u8], at: usize| -> Option<u32> {
        Some(u32::from_le_bytes(bytes.get(at..at + 4)?.try_into().ok()?))
    };
    let (mut at, mut frame_bytes) = (12, 1);
    while let Some(len) = le(bytes, at + 4) {
        let name = &bytes[at..at + 4];
        if name == b"fmt " {
            frame_bytes = le(bytes, at + 20).map_or(1, |block| (block & 0xFFFF).max(1) as usize);
        }
        if name == b"data" {
            let follows = bytes.len() - (at + 8);
            if len >= STREAMED_MIN
                && let Ok(whole) = u32::try_from(follows / frame_bytes * frame_bytes)
            {
                bytes[at + 4..at + 8].copy_from_slice(&whole.to_le_bytes());
            }
            return;
        }
        // Chunks begin at even offsets.
        at += 8 + len as usize + (len & 1) as usize;
    }
}

fn mix_down(samples: &[f32], channels: usize) -> Vec<f32> {
    samples
        .chunks_exact(channels)
        .map(|frame| frame.iter().sum::<f32>() / channels as f32)
        .collect()
}

fn quantise(samples: &[f32]) -> Vec<i16> {
    // The cast saturates: values beyond full scale are clipped.
    samples.iter().map(|s| (s * 32_768.0).round() as i16).collect()
}

#[cfg(test)]
#[path = "wav_tests.rs"]
mod tests;
