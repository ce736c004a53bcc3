//! The grounding service.

use std::process::ExitCode;

fn main() -> ExitCode {
    service::service_loop::run::<grounding::shell::GroundingProgram>()
}
