//! A simulated bus of servos like those of an SO-101, for tests without hardware. It shares no code with the driver:
//! what both take from the manual is written down twice.
//!
//! [`Bus`] lives in a time that the caller sets; the program `servo_bus` serves one behind a pseudo-terminal in real
//! time.
//! Modelled are registers with lock and power-off, a position loop with limits of speed and acceleration, obstacles,
//! overload, heat, voltage, dead servos, other baud rates, and answers that are lost, late, damaged, truncated,
//! doubled, preceded by noise, or another servo's. Not modelled are echo, inertia, backlash and firmware versions.

mod bus;
mod faults;
mod servo;
mod terminal;

pub use bus::Bus;
pub use faults::{Faults, KINDS};
pub use servo::Servo;
pub use terminal::Terminal;

/// The seed of a random test: `WHICHONE_SEED`, or another one in each process. It is printed with the test's output.
#[allow(clippy::print_stderr, reason = "a test that fails shows it")]
pub fn seed() -> u64 {
    let set = std::env::var("WHICHONE_SEED").ok().and_then(|seed| seed.parse().ok());
    let seed = set.unwrap_or_else(|| u64::from(std::process::id()));
    eprintln!("WHICHONE_SEED={seed}");
    seed
}
