//! The bridge to the controllers of an arm.

use std::process::ExitCode;

fn main() -> ExitCode {
    ros2::trajectory::bridge::run()
}
