//! The arm service.

use std::process::ExitCode;

fn main() -> ExitCode {
    arm::run::<drivers::Shipped>()
}
