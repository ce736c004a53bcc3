//! The recorder.

use std::process::ExitCode;

fn main() -> ExitCode {
    recorder::run()
}
