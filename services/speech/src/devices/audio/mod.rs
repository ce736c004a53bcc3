//! Audio processing for recognition: noise reduction, and a noise floor for clean recordings.

mod denoise;
mod noise_floor;

pub use audio::{RATE_HZ, WavError, read_wav, seconds};
pub use denoise::denoised;
pub use noise_floor::with_noise_floor;
