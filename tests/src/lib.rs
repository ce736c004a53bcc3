//! What the tests with real processes share: a group of their own that leaves nothing behind, and
//! the command line that their users would type.

mod command;
mod group;

pub use command::{Ended, program, run};
pub use group::Group;

/// Waits until `fact` gives a value.
///
/// # Panics
/// When `seconds` have passed without one: a test that would hang fails instead.
pub fn wait_for<T>(what: &str, seconds: f64, mut fact: impl FnMut() -> Option<T>) -> T {
    let until = std::time::Instant::now() + std::time::Duration::from_secs_f64(seconds);
    loop {
        if let Some(value) = fact() {
            return value;
        }
        assert!(std::time::Instant::now() < until, "{what}: not within {seconds} s");
        std::thread::sleep(std::time::Duration::from_millis(10));
    }
}
