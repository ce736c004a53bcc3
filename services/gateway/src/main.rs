//! The gateway's program: `whichone gateway …`.

use std::process::ExitCode;

fn main() -> ExitCode {
    gateway::cli::run()
}
