//! The arm service.

use std::process::ExitCode;

fn main() -> ExitCode {
    service::service_loop::run::<arm::shell::ArmProgram>()
}
