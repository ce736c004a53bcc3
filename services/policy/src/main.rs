//! The policy service.

use std::process::ExitCode;

fn main() -> ExitCode {
    runtime::driver::run::<policy::shell::PolicyProgram>()
}
