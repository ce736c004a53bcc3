//! WAV files of any usual format, read as samples at the service's rate.

use std::io::{self, Cursor, Read as _};
use std::path::{Path, PathBuf};

use hound::{SampleFormat, WavReader};

use super::{RATE_HZ, resample};

/// Error of reading a WAV file, with its path.
#[derive(Debug, thiserror::Error)]
#[error("{} {problem}", path.display())]
pub struct WavError {
    path: PathBuf,
    problem: String,
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
    samples(path, longest_s).map_err(|problem| WavError { path: path.to_owned(), problem })
}

fn samples(path: &Path, longest_s: f64) -> Result<Vec<i16>, String> {
    let too_long = || format!("is longer than {longest_s} s");
    let mut bytes = read(path)?.ok_or_else(too_long)?;
    repair_streamed_length(&mut bytes);
    let not_wav = |error: hound::Error| match error {
        hound::Error::Unsupported => unsupported("expected PCM or float samples"),
        hound::Error::IoError(_) => "is not a valid WAV file: its header is truncated".to_owned(),
        error => format!("is not a valid WAV file: {error}"),
    };
    let mut wav = WavReader::new(Cursor::new(bytes)).map_err(not_wav)?;
    let (spec, frames) = (wav.spec(), wav.duration());
    let rate = f64::from(spec.sample_rate);
    if frames == 0 {
        return Err("contains no audio".to_owned());
    }
    if !(RATE_MIN_HZ..=RATE_MAX_HZ).contains(&spec.sample_rate) {
        return Err(unsupported(&format!("expected 8 to 192 kHz, found {rate} Hz")));
    }
    if f64::from(frames) / rate > longest_s {
        return Err(too_long());
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
        return Err(format!("is truncated: expected {announced_s:.1} s, found {found_s:.1} s"));
    }
    if samples.iter().any(|s| !s.is_finite()) {
        return Err(unsupported("it contains samples that are not numbers"));
    }
    let channels = usize::from(spec.channels);
    let frames = samples.chunks_exact(channels);
    // Clipped to full scale here: a filter cannot add numbers close to the largest there are.
    let mean = |f: &[f32]| f.iter().map(|s| s.clamp(-1.0, 1.0)).sum::<f32>() / channels as f32;
    let mono: Vec<f32> = frames.map(mean).collect();
    let samples = resample(&mono, spec.sample_rate, RATE_HZ).map_err(|e| unsupported(&e))?;
    // The cast saturates: the filter may swing beyond full scale.
    Ok(samples.iter().map(|s| (s * 32_768.0).round() as i16).collect())
}

fn unsupported(what: &str) -> String {
    format!("is not supported: {what}; help: convert it to 16 kHz, 16 bit, mono PCM")
}

/// Returns the content of a file; `None` if it is too long.
fn read(path: &Path) -> Result<Option<Vec<u8>>, String> {
    let unreadable = |error: io::Error| format!("cannot be read: {error}");
    let mut bytes = Vec::new();
    // Reading a device or a pipe could block forever.
    let file = safe_files::open_regular(path).map_err(unreadable)?;
    file.take(BYTES_MAX + 1).read_to_end(&mut bytes).map_err(unreadable)?;
    Ok((bytes.len() as u64 <= BYTES_MAX).then_some(bytes))
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

#[cfg(test)]
#[path = "wav_tests.rs"]
mod tests;
