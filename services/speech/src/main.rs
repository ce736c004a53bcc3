//! The speech service.

use std::process::ExitCode;

fn main() -> ExitCode {
    runtime::driver::run::<speech::shell::SpeechProgram>()
}
