//! What tests share: real processes in a group of their own that leaves nothing behind, with the
//! command line that their users would type; reducers in simulated processes; people who speak.

mod command;
pub mod console;
mod group;
mod host;
pub mod spoken;
pub mod turns;

pub use command::{Ended, program, run};
pub use group::Group;
pub use host::{Crash, Host, configured};

use config::Settings;
use std::path::Path;

/// The shipped configuration with the profile for tests, and these settings over it.
///
/// # Panics
/// Where a setting is none.
pub fn settings(over: &[(&str, &str)]) -> Settings {
    let config = Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../config"));
    let over: Vec<_> = over.iter().map(|(k, v)| ((*k).to_owned(), (*v).to_owned())).collect();
    preflight::load(config, Some("ci"), &over).unwrap_or_else(|e| panic!("{e}"))
}

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
