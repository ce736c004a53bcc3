//! The grounding service.

use std::process::ExitCode;

fn main() -> ExitCode {
    grounding::run()
}
