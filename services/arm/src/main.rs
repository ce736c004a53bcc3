//! The arm service.

use std::process::ExitCode;

fn main() -> ExitCode {
    runtime::driver::run::<arm::shell::ArmProgram>()
}
