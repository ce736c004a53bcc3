//! Audio as the speech service and its clients handle it: 16-bit samples of one channel at
//! [`RATE_HZ`], read from WAV files and dated by a clock of samples.

mod clock;
mod resample;
mod wav;

pub use clock::{SampleClock, shifted};
pub use resample::resample;
pub use wav::{WavError, read_wav};

/// Samples per second. The acoustic model and the voice detector require this rate.
pub const RATE_HZ: u32 = 16_000;

/// Returns the duration of a number of samples, seconds.
pub fn seconds(samples: usize) -> f64 {
    samples as f64 / f64::from(RATE_HZ)
}
