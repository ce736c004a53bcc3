//! The console service.

use std::process::ExitCode;

fn main() -> ExitCode {
    console::service::run()
}
