//! Shared by the tests: real process groups that are driven through the command line and leave
//! nothing behind, simulated groups, and users who speak with real sound.

mod command;
pub mod console;
pub mod controllers;
pub mod fuzz;
pub mod gateway;
mod group;
pub mod hammer;
pub mod http_program;
mod interrupt;
pub mod isolated;
pub mod link;
pub mod markdown;
pub mod motion_watch;
pub mod openapi;
pub mod ros1;
pub mod ros2;
pub mod second_user;
pub mod shortage;
pub mod simulated_group;
pub mod slow_network;
pub mod spoken;

pub use command::{Ended, after, program, run};
pub use group::{EARS, Group};
pub use interrupt::end_with_groups;

use config::Settings;
use std::path::Path;
use std::time::{Duration, Instant};

/// The setting by which only yes/no questions are asked, for tests of answers that name nothing.
pub const YES_NO: &str = "dialogue.choice_questions=false";

/// The settings of the profile of the arm with six joints: a group has the profile for tests.
pub const UR5E: [&str; 4] = [
    "group.scene=blocks",
    "arm.robot=ur5e",
    "arm.hand_over_xyz=[0.45, 0.42, 0.25]",
    "arm.table_z_m=0.0",
];

/// Returns the settings of a profile of `robot import`: a group has the profile for tests.
///
/// # Panics
/// If there is no such file.
pub fn settings_of(profile: &Path) -> Vec<String> {
    let text =
        std::fs::read_to_string(profile).unwrap_or_else(|e| panic!("{}: {e}", profile.display()));
    let settings = text.lines().filter_map(|line| {
        let (key, value) = line.split_once(" = ")?;
        let table = if key == "scene" { "group" } else { "arm" };
        Some(format!("{table}.{key}={value}"))
    });
    settings.collect()
}

/// The shipped configuration with the profile for tests, and these settings over it.
///
/// # Panics
/// If a setting is invalid.
pub fn settings(over: &[(&str, &str)]) -> Settings {
    let config = Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../config"));
    let over: Vec<_> = over.iter().map(|(k, v)| ((*k).to_owned(), (*v).to_owned())).collect();
    preflight::load(config, Some("ci"), &over).unwrap_or_else(|e| panic!("{e}"))
}

/// Returns the number in an environment variable, by which tests take another seed or go on for longer.
///
/// # Panics
/// If it holds no number.
pub fn number(variable: &str) -> Option<u64> {
    let text = std::env::var(variable).ok()?;
    Some(text.parse().unwrap_or_else(|_| panic!("{variable}: expected a number, found {text}")))
}

/// How much longer than on an idle machine a fact may take: a deadline ends what hangs, and judges no speed.
const BUSY: f64 = 4.0;

/// Waits until `fact` returns a value, and returns it.
///
/// # Panics
/// If there is none after four times `seconds`, which are those of an idle machine.
pub fn wait_for<T>(what: &str, seconds: f64, fact: impl FnMut() -> Option<T>) -> T {
    wait_for_or_none(seconds, fact)
        .unwrap_or_else(|| panic!("{what}: not within {BUSY} × {seconds} s"))
}

/// As [`wait_for`]; none where that panics.
pub fn wait_for_or_none<T>(seconds: f64, mut fact: impl FnMut() -> Option<T>) -> Option<T> {
    let until = Instant::now() + Duration::from_secs_f64(BUSY * seconds);
    loop {
        let value = fact();
        if value.is_some() || Instant::now() > until {
            return value;
        }
        std::thread::sleep(Duration::from_millis(10));
    }
}

/// Channels of recordings and live views that have messages once an object was fetched.
pub const DIALOGUE_CHANNELS: [&str; 19] = [
    "/speech/inject",
    "/speech/receipt",
    "/speech/utterance",
    "/speech/presented",
    "/speech/activity",
    "/speech/hearing",
    "/grounding/observation",
    "/policy/mark",
    "/policy/act",
    "/policy/view",
    "/arm/status",
    "/arm/joints",
    "/arm/world",
    "/arm/trajectory",
    "/robot_description",
    "/joint_states",
    "/scene",
    "/tf",
    "/dialogue",
];
