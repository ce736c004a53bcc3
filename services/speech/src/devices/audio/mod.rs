//! Sound as every part of this service takes it: 16-bit samples of one channel at [`RATE_HZ`].

mod denoise;
mod noise_floor;
mod resample;
mod spectrum;
mod wav;

pub use denoise::denoised;
pub use noise_floor::with_noise_floor;
pub use resample::resample;
pub use wav::{WavError, read_wav};

/// Samples a second. The acoustic model and the voice detector are made for this rate.
pub const RATE_HZ: u32 = 16_000;

/// The time of a number of samples, in seconds.
pub fn seconds(samples: usize) -> f64 {
    samples as f64 / f64::from(RATE_HZ)
}
