//! The policy service.

use std::process::ExitCode;

fn main() -> ExitCode {
    service::service_loop::run::<policy::shell::PolicyProgram>()
}
