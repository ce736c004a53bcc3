//! Audio as every part of this service handles it: 16-bit samples of one channel at [`RATE_HZ`].

mod denoise;
mod noise_floor;
mod resample;
mod wav;

pub use denoise::denoised;
pub use noise_floor::with_noise_floor;
pub use resample::resample;
pub use wav::{WavError, read_wav};

/// Samples per second. The acoustic model and the voice detector require this rate.
pub const RATE_HZ: u32 = 16_000;

/// Returns the duration of a number of samples, seconds.
pub fn seconds(samples: usize) -> f64 {
    samples as f64 / f64::from(RATE_HZ)
}
