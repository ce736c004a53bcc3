//! The console service.

use std::process::ExitCode;

fn main() -> ExitCode {
    runtime::exit::Exit::Ok.code()
}
