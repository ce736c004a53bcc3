//! The policy service.

use std::process::ExitCode;

fn main() -> ExitCode {
    policy::run()
}
