//! The speech service.

use std::process::ExitCode;

fn main() -> ExitCode {
    speech::run()
}
