//! The grounding service.

use std::process::ExitCode;

fn main() -> ExitCode {
    runtime::driver::run::<grounding::shell::GroundingProgram>()
}
