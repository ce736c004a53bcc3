//! Audio processing for recognition: noise reduction, and a noise floor for clean recordings.

mod denoise;
mod noise_floor;
mod snr;

use std::path::Path;

pub use audio::{RATE_HZ, read_wav, seconds};
pub use denoise::{VoiceEvidence, denoised};
pub use noise_floor::with_noise_floor;
pub use snr::snr_db;

/// Writes samples at [`RATE_HZ`] as a WAV file.
///
/// # Errors
/// If the file cannot be written.
pub fn write_wav(path: &Path, samples: &[i16]) -> Result<(), hound::Error> {
    let spec = hound::WavSpec {
        channels: 1,
        sample_rate: RATE_HZ,
        bits_per_sample: 16,
        sample_format: hound::SampleFormat::Int,
    };
    let mut wav = hound::WavWriter::create(path, spec)?;
    samples.iter().try_for_each(|&sample| wav.write_sample(sample))?;
    wav.finalize()
}
