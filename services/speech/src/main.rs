//! The speech service.

use std::process::ExitCode;

fn main() -> ExitCode {
    service::service_loop::run::<speech::shell::SpeechProgram>()
}
